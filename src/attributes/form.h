// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"

namespace embody::attributes {

/// The part of a model's form that its mass depends on, made safe: every number is finite and positive, also for an
/// empty or flat model.
struct Form {
    Vec3 size;                  ///< extents of the box, each at least `min_extent`, m
    bool size_known = false;    ///< from the model, not the category
    double box_volume = 0;      ///< m³
    double face_area = 0;       ///< of the box's largest face, m²
    double volume = 0;          ///< inside the surface, the hull or the box, m³, at most the box's
    std::string volume_source;  ///< whether surface, hull or box, and how it was computed
    AttributeLevel volume_level = AttributeLevel::standard;
    bool volume_is_own = false;  ///< of the surface itself, so that its moments can be used
};

/// A box this thin in all directions still holds the smallest mass at the largest density. A model longer than
/// `max_extent` counts as broken.
inline constexpr double min_extent = 1e-3;
inline constexpr double max_extent = 1e4;

/// `usual_size` stands in for a model without one.
Form form_of(const GeometryFacts& facts, Vec3 usual_size);

struct CenterAndInertia {
    Vec3 center;   ///< in the model's frame, inside the box
    Mat3 inertia;  ///< about it, kg m², of a possible body
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// Moments of the parts where they are known (`of_parts`, see material_parts.h) and could be those of a real body of
/// this size; else of the surface's own volume scaled to the mass; else of the homogeneous box.
CenterAndInertia center_and_inertia(const GeometryFacts& facts, const Form& form, double mass,
                                    const std::optional<CenterAndInertia>& of_parts);

struct ShapeChoice {
    std::string shape;
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// Triangles for static things, a decomposition where hollows are deep, else the fitted primitive where its error is
/// small, else the hull.
ShapeChoice choose_collision_shape(const GeometryFacts& facts, bool is_static);

/// A number for people: three digits.
std::string short_number(double value);

}  // namespace embody::attributes
