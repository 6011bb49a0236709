// SPDX-License-Identifier: MIT
#include "attributes/form.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "attributes/registry.h"
#include "physics/definitions/mass_properties.h"

namespace embody::attributes {
namespace {

bool is_positive(double value) { return std::isfinite(value) && value > 0; }

Mat3 box_inertia(Vec3 size, double mass) {
    const geometry::MassProperties box = physics::mass_properties(physics::BoxShape{size * 0.5});
    return box.inertia * (mass / box.volume);
}

// Volume from the most exact source, never more than that of the box.
void choose_volume(const GeometryFacts& facts, Form& form) {
    const double max_volume = form.box_volume * (1 + 1e-3);
    const double min_volume = std::max(form.box_volume * 1e-6, min_extent * min_extent * min_extent);
    if (is_positive(facts.volume) && facts.volume <= max_volume && facts.volume >= min_volume) {
        form.volume = std::min(facts.volume, form.box_volume);
        form.volume_is_own = true;
        form.volume_level = facts.closed ? AttributeLevel::measured : AttributeLevel::model;
        form.volume_source = facts.closed ? "closed surface" : "surface that is not closed";
        if (!facts.volume_method.empty()) form.volume_source += ", " + facts.volume_method;
    } else if (is_positive(facts.hull_volume) && facts.hull_volume <= max_volume && facts.hull_volume >= min_volume) {
        form.volume = std::min(facts.hull_volume, form.box_volume);
        form.volume_level = AttributeLevel::model;
        form.volume_source = "convex hull, since the surface has no volume of its own";
    } else {
        form.volume = form.box_volume;
        form.volume_level = form.size_known ? AttributeLevel::model : AttributeLevel::category;
        form.volume_source = form.size_known ? "bounding box, since the surface has no volume of its own"
                                             : "usual size of the category, since the model has none";
    }
}

}  // namespace

std::string short_number(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", value);
    return buffer;
}

Form form_of(const GeometryFacts& facts, Vec3 usual_size) {
    Form form;
    const Vec3 given = facts.size;
    const double largest = std::max({given.x, given.y, given.z});
    form.size_known = is_finite(given) && largest > 0 && largest <= max_extent;
    const Vec3 size = form.size_known ? given : usual_size;
    form.size = max(size, Vec3{min_extent, min_extent, min_extent});
    form.box_volume = form.size.x * form.size.y * form.size.z;
    form.face_area = std::max({form.size.x * form.size.y, form.size.y * form.size.z, form.size.z * form.size.x});
    choose_volume(facts, form);
    return form;
}

CenterAndInertia center_and_inertia(const GeometryFacts& facts, const Form& form, double mass,
                                    const std::optional<CenterAndInertia>& of_parts) {
    const Vec3 half = form.size * 0.5;
    const Vec3 lower{-half.x, 0, -half.z};
    const Vec3 upper{half.x, form.size.y, half.z};

    // Moments of a real body in this box, with the centre (which rounding may put just outside) inside it.
    const auto possible = [&](CenterAndInertia moments) -> std::optional<CenterAndInertia> {
        if (!is_finite(moments.center)) return std::nullopt;
        const Vec3 center = min(max(moments.center, lower), upper);
        // No mass is farther from the centre than the diagonal of the box.
        const bool fits = trace(moments.inertia) <= 2 * mass * length_squared(form.size);
        const bool centered = distance(center, moments.center) < 0.05 * length(form.size);
        if (!validate("inertia", moments.inertia) || !fits || !centered) return std::nullopt;
        moments.center = center;
        return moments;
    };

    if (of_parts) {
        if (const auto parts = possible(*of_parts)) return *parts;
    }
    if (form.volume_is_own) {
        const auto solid = possible({facts.center_of_volume, facts.unit_inertia * (mass / facts.volume),
                                     "homogeneous solid inside the " + form.volume_source + ", scaled to the mass",
                                     form.volume_level});
        if (solid) return *solid;
    }
    const AttributeLevel level = form.size_known ? AttributeLevel::model : AttributeLevel::category;
    return {{0, half.y, 0}, box_inertia(form.size, mass), "homogeneous bounding box", level};
}

ShapeChoice choose_collision_shape(const GeometryFacts& facts, bool is_static) {
    if (is_static) return {"trimesh", "static things collide with their own triangles", AttributeLevel::kind};

    // A primitive that fits the hull would fill the hollow.
    if (facts.hull_concavity > negligible_concavity(facts.size)) {
        return {"decomposition",
                "the convex hull would fill hollows up to " + short_number(facts.hull_concavity * 1000) + " mm deep",
                AttributeLevel::measured};
    }

    // A primitive may be up to 2 % of the diagonal away from the hull: less than one sees.
    const bool is_primitive = validate("collision_shape", facts.fitted_shape).ok() &&
                              facts.fitted_shape != "convex_hull" && facts.fitted_shape != "trimesh" &&
                              facts.fitted_shape != "decomposition";
    const double allowed = unseen_fraction * length(facts.size);
    if (is_primitive && facts.fitted_error >= 0 && facts.fitted_error <= allowed) {
        return {facts.fitted_shape, "fits the convex hull within " + short_number(facts.fitted_error * 1000) + " mm",
                AttributeLevel::measured};
    }
    return {"convex_hull",
            is_primitive ? "no primitive fits the hull within 2 % of the diagonal" : "convex hull of the model",
            AttributeLevel::model};
}

}  // namespace embody::attributes
