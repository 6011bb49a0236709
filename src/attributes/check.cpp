// SPDX-License-Identifier: MIT
#include "attributes/check.h"

#include <cmath>
#include <utility>

#include "attributes/assemble.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"

namespace embody::attributes {
namespace {

constexpr double rounding = 1e-6;

void check_entries(const AttributeSet& set, std::vector<Issue>& issues) {
    for (const AttributeEntry& entry : set.entries()) {
        if (const auto valid = validate(entry.name, entry.value); !valid)
            issues.push_back({entry.name, valid.error().why});
        if (entry.source.empty()) issues.push_back({entry.name, "has no source"});
        const double* value = std::get_if<double>(&entry.value);
        if (value == nullptr) continue;
        const double slack = rounding * std::fabs(*value);
        if ((entry.low && *entry.low > *value + slack) || (entry.high && *entry.high < *value - slack)) {
            issues.push_back({entry.name, "lies outside its own interval"});
        }
    }
    const PhysicalKind kind = kind_of(set);
    for (const AttributeDescription& description : registry()) {
        if (applies_to(description, kind) && set.find(description.name) == nullptr) {
            issues.push_back({description.name, "is missing"});
        }
    }
}

void check_mass(const AttributeSet& set, std::vector<Issue>& issues) {
    if (set.find("mass") == nullptr || set.find("density") == nullptr || set.find("fill_fraction") == nullptr) return;
    const double mass = set.number("mass", 0);
    const double density = set.number("density", 0);
    const double product = density * set.number("fill_fraction", 0) * set.number("volume", 0);
    if (!(std::fabs(product - mass) <= 0.01 * mass)) {
        issues.push_back({"mass", "is " + short_number(mass) + " kg, but density x fill x volume is " +
                                      short_number(product) + " kg"});
    }
    if (set.number("bulk_density", 0) > density * (1 + 0.01)) {
        issues.push_back({"bulk_density", "exceeds the density of the material"});
    }
}

void check_moments(const AttributeSet& set, const Form& form, std::vector<Issue>& issues) {
    const AttributeEntry* center = set.find("center_of_mass");
    const Vec3* c = center != nullptr ? std::get_if<Vec3>(&center->value) : nullptr;
    const double slack = rounding * length(form.size);
    if (c != nullptr && form.size_known) {
        const bool inside = std::fabs(c->x) <= form.size.x / 2 + slack && std::fabs(c->z) <= form.size.z / 2 + slack &&
                            c->y >= -slack && c->y <= form.size.y + slack;
        if (!inside) issues.push_back({"center_of_mass", "lies outside the model's box"});
    }
    // No mass is farther from the centre than the diagonal: the trace is at most 2 m d².
    const AttributeEntry* inertia = set.find("inertia");
    const Mat3* i = inertia != nullptr ? std::get_if<Mat3>(&inertia->value) : nullptr;
    if (i != nullptr && form.size_known &&
        trace(*i) > 2 * set.number("mass", 0) * length_squared(form.size) * (1 + rounding)) {
        issues.push_back({"inertia", "is more than a body of this mass and size can have"});
    }
}

}  // namespace

std::vector<Issue> check(const AttributeSet& set, const ModelFacts& facts) {
    std::vector<Issue> issues;
    const Form form = form_of(facts.geometry, {1, 1, 1});
    check_entries(set, issues);
    check_mass(set, issues);
    check_moments(set, form, issues);
    if (set.number("friction_dynamic", 0) > set.number("friction_static", 0)) {
        issues.push_back({"friction_dynamic", "exceeds the static friction"});
    }
    if (set.word("collision_shape", "") == "trimesh" && !is_static(kind_of(set))) {
        issues.push_back({"collision_shape", "only static things collide with their triangles"});
    }
    return issues;
}

}  // namespace embody::attributes
