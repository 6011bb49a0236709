// SPDX-License-Identifier: MIT
#include "physics/definitions/deformable_definition.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/topology.h"
#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

constexpr double flattest = 1e-6;  // volume or area of an element, of a cube or square over its longest edge

// Zero, or not a number, or infinite: for attributes where infinite means "never".
Result<void> check_limit(const char* field, double value) {
    if (value > 0) return {};
    return Error{field, "must be above 0", "leave it infinite where there is no such limit"};
}

Result<void> check_nodes(const DeformableDefinition& definition) {
    if (definition.nodes.empty()) return Error{"nodes", "are none", "give at least the corners of one element"};
    for (std::size_t i = 0; i < definition.nodes.size(); ++i) {
        if (auto result = check_vector(field_item("nodes", i), definition.nodes[i], largest_coordinate, "m"); !result)
            return result;
    }
    std::vector<bool> is_held(definition.nodes.size(), false);
    for (std::size_t i = 0; i < definition.pinned.size(); ++i) {
        if (definition.pinned[i] >= definition.nodes.size()) return Error{field_item("pinned", i), "is no node"};
        is_held[definition.pinned[i]] = true;
    }
    for (std::size_t i = 0; i < definition.attachments.size(); ++i) {
        const Attachment& attachment = definition.attachments[i];
        if (attachment.node >= definition.nodes.size()) return Error{field_item("attachments", i), "holds no node"};
        if (is_held[attachment.node])
            return Error{field_item("attachments", i), "holds a node that is pinned or attached already"};
        is_held[attachment.node] = true;
        if (auto result = check_vector(field_item("attachments", i), attachment.anchor, largest_coordinate, "m");
            !result)
            return result;
    }
    return {};
}

Result<void> check_clamps(const DeformableDefinition& definition) {
    if (definition.clamps.empty()) return {};
    if (!std::holds_alternative<Rope>(definition.matter))
        return Error{"clamps", "are of ropes alone", "pin or attach several nodes instead"};
    std::vector<bool> may_clamp(definition.nodes.size(), false);
    for (const std::uint32_t node : definition.pinned) may_clamp[node] = true;
    for (const Attachment& attachment : definition.attachments) may_clamp[attachment.node] = true;
    for (std::size_t i = 0; i < definition.clamps.size(); ++i) {
        const Clamp& clamp = definition.clamps[i];
        if (clamp.node >= definition.nodes.size()) return Error{field_item("clamps", i), "holds no node"};
        if (!may_clamp[clamp.node]) {
            return Error{field_item("clamps", i),
                         "holds a node that is neither pinned nor attached, or clamped already",
                         "pin the node, attach it, or leave the clamp out"};
        }
        may_clamp[clamp.node] = false;
        if (!(std::fabs(length_squared(clamp.direction) - 1) < 1e-6))
            return Error{field_item("clamps", i) + ".direction", "has not the length 1", "normalise it"};
    }
    return {};
}

// Corners that are nodes, and an extent that is more than rounding.
template <std::size_t corners>
Result<void> check_element(const DeformableDefinition& definition, const std::string& name,
                           const std::array<std::uint32_t, corners>& element) {
    for (const std::uint32_t corner : element) {
        if (corner >= definition.nodes.size()) return Error{name, "has a corner that is no node"};
    }
    double longest = 0;
    for (const std::uint32_t i : element) {
        for (const std::uint32_t k : element) {
            longest = std::max(longest, length(definition.nodes[i] - definition.nodes[k]));
        }
    }
    const Vec3 origin = definition.nodes[element[0]];
    const Vec3 normal = cross(definition.nodes[element[1]] - origin, definition.nodes[element[2]] - origin);
    double extent = length(normal) / (longest * longest);
    if constexpr (corners == 4)
        extent = std::fabs(dot(normal, definition.nodes[element[3]] - origin)) / (longest * longest * longest);
    if (!(extent > flattest)) return Error{name, "is flat", "leave it out, or mesh the model anew"};
    return {};
}

Result<void> check_ties(const DeformableDefinition& definition) {
    if (definition.ties.empty()) return {};
    if (std::holds_alternative<SoftSolid>(definition.matter))
        return Error{"ties", "are of sheets and ropes alone", "tie the sheet or rope to the solid"};
    std::vector<bool> is_held(definition.nodes.size(), false);
    for (const std::uint32_t node : definition.pinned) is_held[node] = true;
    for (const Attachment& attachment : definition.attachments) is_held[attachment.node] = true;
    for (std::size_t i = 0; i < definition.ties.size(); ++i) {
        const Tie& tie = definition.ties[i];
        if (tie.node >= definition.nodes.size()) return Error{field_item("ties", i), "holds no node"};
        if (is_held[tie.node])
            return Error{field_item("ties", i), "holds a node that is pinned, attached or tied already"};
        is_held[tie.node] = true;
        double sum = 0;
        for (const double weight : tie.weight) {
            if (!(weight >= 0 && weight <= 1)) return Error{field_item("ties", i) + ".weight", "is not 0 to 1"};
            sum += weight;
        }
        if (!(std::fabs(sum - 1) < 1e-6)) return Error{field_item("ties", i) + ".weight", "is not 1 together"};
    }
    return {};
}

template <std::size_t corners>
Result<void> check_elements(const DeformableDefinition& definition, const char* field,
                            const std::vector<std::array<std::uint32_t, corners>>& elements) {
    if (elements.empty()) return Error{field, "are none", "a deformable needs elements"};
    std::vector<bool> is_used(definition.nodes.size(), false);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (auto result = check_element(definition, field_item(field, i), elements[i]); !result) return result;
        for (const std::uint32_t corner : elements[i]) is_used[corner] = true;
    }
    const auto free = std::find(is_used.begin(), is_used.end(), false);
    if (free != is_used.end()) {
        return Error{field_item("nodes", static_cast<std::size_t>(free - is_used.begin())), "belongs to no element",
                     "leave it out"};
    }
    return {};
}

Result<void> check_matter(const DeformableDefinition& definition, const SoftSolid& solid) {
    if (auto result = check_elements(definition, "tetrahedra", solid.tetrahedra); !result) return result;
    return first_error(check_number("density", solid.density, 0.1, 22600, "kg/m3"),
                       check_number("youngs_modulus", solid.youngs_modulus, 100, 1e12, "Pa"),
                       check_number("poisson_ratio", solid.poisson_ratio, -0.9, 0.495),
                       check_number("rayleigh_damping", solid.rayleigh_damping, 0, 100, "s"),
                       check_limit("yield_stress", solid.yield_stress),
                       check_number("internal_pressure", solid.internal_pressure, 0, 1e8, "Pa"));
}

Result<void> check_gas(const DeformableDefinition& definition, const Cloth& cloth) {
    const char* field = "internal_pressure";
    if (auto result = check_number(field, cloth.internal_pressure, 0, 1e8, "Pa"); !result) return result;
    if (cloth.internal_pressure == 0) return {};
    if (!is_closed(cloth))
        return Error{field, "is that of a sheet with holes, through which gas escapes",
                     "close the sheet: each edge between two triangles that are turned the same way; or set it to 0"};
    if (!(enclosed_volume(definition.nodes, cloth.triangles) > 0))
        return Error{field, "is that of a sheet that encloses nothing, or is turned inside out",
                     "turn its triangles: their corners run counterclockwise seen from outside"};
    return {};
}

Result<void> check_matter(const DeformableDefinition& definition, const Cloth& cloth) {
    if (auto result = check_elements(definition, "triangles", cloth.triangles); !result) return result;
    return first_error(check_number("area_density", cloth.area_density, 1e-4, 1000, "kg/m2"),
                       check_number("thickness", cloth.thickness, 1e-6, 0.1, "m"),
                       check_number("stretch_stiffness", cloth.stretch_stiffness, 1e-3, 1e9, "N/m"),
                       check_number("shear_stiffness", cloth.shear_stiffness, 1e-3, 1e9, "N/m"),
                       check_number("bend_stiffness", cloth.bend_stiffness, 1e-9, 1e6, "N m"),
                       check_number("rayleigh_damping", cloth.rayleigh_damping, 0, 100, "s"),
                       check_number("drag_coefficient", cloth.drag_coefficient, 0, 10),
                       check_number("bend_friction", cloth.bend_friction, 0, 1e6, "1/m"),
                       check_limit("bend_yield", cloth.bend_yield), check_number("prestretch", cloth.prestretch, 1, 2),
                       check_limit("tear_strength", cloth.tear_strength), check_limit("tear_energy", cloth.tear_energy),
                       check_gas(definition, cloth));
}

Result<void> check_matter(const DeformableDefinition& definition, const Rope& rope) {
    if (definition.nodes.size() < 2) return Error{"nodes", "are too few", "give a rope two ends at least"};
    for (std::size_t i = 1; i < definition.nodes.size(); ++i) {
        if (!(length(definition.nodes[i] - definition.nodes[i - 1]) > 1e-6))
            return Error{field_item("nodes", i), "lies on the one before it", "leave it out"};
    }
    return first_error(check_number("diameter", rope.diameter, 1e-4, 1, "m"),
                       check_number("linear_density", rope.linear_density, 1e-6, 1e4, "kg/m"),
                       check_number("axial_stiffness", rope.axial_stiffness, 1e-3, 1e12, "N"),
                       check_number("bend_rigidity", rope.bend_rigidity, 1e-12, 1e9, "N m2"),
                       check_number("twist_rigidity", rope.twist_rigidity, 1e-12, 1e9, "N m2"),
                       check_number("rayleigh_damping", rope.rayleigh_damping, 0, 100, "s"),
                       check_limit("break_tension", rope.break_tension), check_limit("bend_yield", rope.bend_yield),
                       check_number("slack", rope.slack, 0, 10));
}

}  // namespace

Result<void> tear(DeformableDefinition& definition, std::span<const TornCorner> corners) {
    if (corners.empty()) return {};
    if (!std::holds_alternative<Cloth>(definition.matter))
        return Error{"torn_corners", "are of sheets alone", "leave them out"};
    DeformableDefinition torn = definition;
    Cloth& cloth = std::get<Cloth>(torn.matter);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto [corner, from, node] = corners[i];
        const std::string field = field_item("torn_corners", i);
        if (corner / 3 >= cloth.triangles.size()) return Error{field, "is of a triangle that the sheet has not"};
        std::uint32_t& now = cloth.triangles[corner / 3][corner % 3];
        if (now != from) return Error{field, "was not at node " + std::to_string(from)};
        const Vec3 place = torn.nodes[now];
        if (node == torn.nodes.size()) torn.nodes.push_back(place);
        if (node == from || node > torn.nodes.size() || torn.nodes[node] != place)
            return Error{field, "has a node that is neither the next new one nor at the corner's place"};
        now = node;
    }
    if (!is_closed(cloth)) cloth.internal_pressure = 0;
    definition = std::move(torn);
    return {};
}

bool is_closed(const Cloth& cloth) { return geometry::find_topology({{}, cloth.triangles}).is_closed(); }

double enclosed_volume(std::span<const Vec3> nodes, std::span<const std::array<std::uint32_t, 3>> triangles) {
    if (triangles.empty()) return 0;
    const Vec3 origin = nodes[triangles.front()[0]];
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += dot(nodes[a] - origin, cross(nodes[b] - origin, nodes[c] - origin)) / 6;
    return sum;
}

Result<void> validate(const DeformableDefinition& definition) {
    if (auto result = check_nodes(definition); !result) return result;
    if (auto result = check_clamps(definition); !result) return result;
    if (auto result = check_ties(definition); !result) return result;
    const auto check = [&](const auto& matter) { return check_matter(definition, matter); };
    if (auto result = std::visit(check, definition.matter); !result) return result;
    return first_error(check_vector("pose.position", definition.pose.position, largest_coordinate, "m"),
                       check_rotation("pose.rotation", definition.pose.rotation),
                       check_vector("linear_velocity", definition.linear_velocity, largest_linear_speed, "m/s"),
                       check_vector("angular_velocity", definition.angular_velocity, largest_angular_speed, "rad/s"),
                       check_number("gravity_factor", definition.gravity_factor, -10, 10),
                       check_vector("force", definition.force, largest_force, "N"), validate(definition.material),
                       check_number("contact_radius", definition.contact_radius, 1e-5, 1, "m"));
}

}  // namespace embody::physics
