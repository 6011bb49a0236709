// SPDX-License-Identifier: MIT
#include "attributes/to_physics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/surfaces.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

constexpr double min_yield = 1e-6;  // 1/m: of bends that stay

// Combine rule of a word of the registry; the default where a file left it out.
physics::CombineRule combine_rule(const std::string& name) {
    constexpr std::array<std::pair<std::string_view, physics::CombineRule>, 7> rules{
        {{"pair_table", physics::CombineRule::pair_table},
         {"own", physics::CombineRule::own},
         {"average", physics::CombineRule::average},
         {"geometric_mean", physics::CombineRule::geometric_mean},
         {"minimum", physics::CombineRule::minimum},
         {"maximum", physics::CombineRule::maximum},
         {"multiply", physics::CombineRule::multiply}}};
    for (const auto& [word, rule] : rules) {
        if (word == name) return rule;
    }
    return physics::CombineRule::pair_table;
}

// The value, or the registry's default for a set that a person or a file left incomplete.
double number_or_standard(const AttributeSet& set, const char* name) {
    return set.number(name, std::get<double>(describe(name)->standard));
}

// The pair table holds for things with the numbers of their material. A number of a thing's own, from its category or a
// person, would be lost in it: then friction is combined by the geometric mean, and the thing's own restitution counts.
void put_surface_id(const AttributeSet& set, const Taxonomy& taxonomy, physics::Material& material) {
    const std::string name = set.word("surface_material", "");
    material.surface = taxonomy.surfaces().surface_of(name);
    const MaterialData* usual = taxonomy.data().material(name);
    if (usual == nullptr || material.surface == 0) return;
    const bool has_usual_friction = material.friction_static == usual->friction_static.typical &&
                                    material.friction_dynamic == usual->friction_dynamic.typical;
    if (!has_usual_friction && material.friction_combine == physics::CombineRule::pair_table)
        material.friction_combine = physics::CombineRule::geometric_mean;
    const bool has_bounce = set.find("restitution") != nullptr;  // cloth, say, has none
    if (has_bounce && material.restitution != usual->restitution.typical &&
        material.restitution_combine == physics::CombineRule::pair_table)
        material.restitution_combine = physics::CombineRule::own;
}

physics::Material material_from(const AttributeSet& set, const Taxonomy* taxonomy) {
    physics::Material material;
    material.friction_static = number_or_standard(set, "friction_static");
    material.friction_dynamic = std::min(number_or_standard(set, "friction_dynamic"), material.friction_static);
    material.friction_rolling = number_or_standard(set, "friction_rolling");
    material.friction_torsional = number_or_standard(set, "friction_torsional");
    material.restitution = number_or_standard(set, "restitution");
    material.restitution_threshold = number_or_standard(set, "restitution_threshold");
    material.friction_combine = combine_rule(set.word("friction_combine", ""));
    material.restitution_combine = combine_rule(set.word("restitution_combine", ""));
    if (taxonomy != nullptr) put_surface_id(set, *taxonomy, material);
    return material;
}

physics::MassDefinition mass_from(const AttributeSet& set) {
    physics::MassDefinition mass;
    if (set.find("mass") != nullptr) mass.mass = set.number("mass", 1);
    mass.density = number_or_standard(set, "density");
    if (const AttributeEntry* center = set.find("center_of_mass")) {
        if (const auto* value = std::get_if<Vec3>(&center->value)) mass.center_of_mass = *value;
    }
    if (const AttributeEntry* inertia = set.find("inertia")) {
        if (const auto* value = std::get_if<Mat3>(&inertia->value)) mass.inertia = *value;
    }
    return mass;
}

// A primitive at its fitted place; a compound of one where that is not the origin.
template <class Primitive>
physics::ShapeDefinition placed(const Primitive& primitive, const Transform& pose) {
    if (pose == Transform{}) return primitive;
    physics::CompoundShape compound;
    compound.children.push_back({primitive, pose});
    return compound;
}

Vec3 safe_size(const GeometryFacts& facts) { return form_of(facts, {0.5, 0.5, 0.5}).size; }
Transform box_pose(Vec3 size) { return {{0, size.y / 2, 0}, {}}; }

// The primitive as fitted, or the one around the bounding box where a person chose another than was fitted.
physics::ShapeDefinition primitive_shape(const std::string& shape, const GeometryFacts& facts) {
    const bool fitted =
        facts.fitted_shape == shape && is_finite(facts.fitted_dimensions) && is_finite(facts.fitted_pose);
    const Vec3 size = safe_size(facts);
    const Transform pose = fitted ? facts.fitted_pose : box_pose(size);
    const Vec3 d = max(facts.fitted_dimensions, Vec3{min_extent / 2, min_extent / 2, min_extent / 2});
    const double radius = fitted ? d.x : std::max(size.x, size.z) / 2;
    if (shape == "box") return placed(physics::BoxShape{fitted ? d : size * 0.5}, pose);
    if (shape == "sphere") return placed(physics::SphereShape{fitted ? d.x : std::max(radius, size.y / 2)}, pose);
    if (shape == "cylinder") return placed(physics::CylinderShape{radius, fitted ? d.y : size.y / 2}, pose);
    const double half_height = fitted ? d.y : std::max(size.y / 2 - radius, min_extent / 2);
    return placed(physics::CapsuleShape{radius, half_height}, pose);
}

// Points that span no volume (a sheet of paper, a road marking) make a thin box.
Result<physics::ShapeDefinition> hull_shape(const GeometryFacts& facts, ModelGeometry& geometry) {
    const Vec3 s = facts.size;
    if (is_finite(s) && std::min({s.x, s.y, s.z}) < min_extent) return primitive_shape("box", facts);
    auto points = geometry.hull_points();
    if (!points) return points.error();
    if (points->size() < 4) return primitive_shape("box", facts);
    return physics::ShapeDefinition{physics::HullShape{std::move(*points)}};
}

// One hull for each convex part, all in the model's frame.
Result<physics::ShapeDefinition> decomposed_shape(const AttributeSet& attributes, const GeometryFacts& facts,
                                                  ModelGeometry& geometry) {
    const int max_hulls = static_cast<int>(number_or_standard(attributes, "max_hulls"));
    auto parts = geometry.convex_parts(max_hulls, number_or_standard(attributes, "hull_error"));
    if (!parts) return parts.error();
    if (parts->size() < 2) return hull_shape(facts, geometry);
    physics::CompoundShape compound;
    for (std::vector<Vec3>& points : *parts) compound.children.push_back({physics::HullShape{std::move(points)}, {}});
    return physics::ShapeDefinition{std::move(compound)};
}

// Enough digits to distinguish a value just beyond a limit from the limit.
std::string exact_number(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.7g", value);
    return buffer;
}

// The mass over the amount that it fills (m³, m² or m), where some matter has that density.
Result<double> spread(const AttributeSet& set, const char* name, double amount, const char* unit, const char* thing) {
    const AttributeDescription& range = *describe(name);
    const AttributeDescription& masses = *describe("mass");
    const AttributeEntry* held = set.find("mass");
    const double usual = number_or_standard(set, name) * amount;
    if ((held == nullptr || held->level == AttributeLevel::standard) &&
        !(usual >= *masses.low && usual <= *masses.high))
        return Error{"mass",
                     "would be " + short_number(usual) + " kg: " + short_number(number_or_standard(set, name)) + " " +
                         range.unit + " × " + short_number(amount) + " " + unit,
                     "make the thing " + std::string(usual > *masses.high ? "smaller" : "larger") + ": from " +
                         short_number(*masses.low) + " to " + short_number(*masses.high) + " kg can be simulated"};
    const double mass = number_or_standard(set, "mass"), density = mass / amount;
    if (density >= *range.low && density <= *range.high) return density;
    return Error{"mass",
                 exact_number(mass) + " kg in " + exact_number(amount) + " " + unit + " are " + exact_number(density) +
                     " " + range.unit,
                 std::string("a ") + thing + " needs " + exact_number(*range.low) + " to " + exact_number(*range.high) +
                     " " + range.unit};
}

// Without either limit as soda-lime glass.
Result<physics::Brittleness> brittleness_from(const AttributeSet& set) {
    // A limit of 0: the slightest blow.
    constexpr double min_limit = 1e-9;
    // J/kg: what glass of 45 MPa, 70 GPa and 2,500 kg/m³ stores before it breaks (docs/physics/fracture.md).
    constexpr double of_glass = 5.8;
    physics::Brittleness brittleness{.break_impulse = std::max(number_or_standard(set, "break_impulse"), min_limit),
                                     .break_energy = std::max(number_or_standard(set, "break_energy"), min_limit),
                                     .fracture_energy = number_or_standard(set, "fracture_energy"),
                                     .max_pieces = static_cast<int>(number_or_standard(set, "break_pieces"))};
    if (std::isinf(brittleness.break_impulse) && std::isinf(brittleness.break_energy))
        brittleness.break_energy = of_glass * number_or_standard(set, "mass");
    if (const auto checked = validate(brittleness); !checked) return checked.error();
    return brittleness;
}

double area_of(const SheetMesh& sheet) {
    double area = 0;
    for (const auto& [a, b, c] : sheet.triangles)
        area += length(cross(sheet.nodes[b] - sheet.nodes[a], sheet.nodes[c] - sheet.nodes[a])) / 2;
    return area;
}

// Fills a closed sheet, whose form is the one that it has under this pressure: its threads are stretched there by the
// tension Y (s - 1)/s = p r/2 of a ball of its volume V and area A, r = 3 V/A.
void inflate(physics::DeformableDefinition& deformable, double pressure) {
    constexpr double max_stretch = 2;
    auto& cloth = std::get<physics::Cloth>(deformable.matter);
    const double volume = physics::enclosed_volume(deformable.nodes, cloth.triangles);
    if (!(volume > 0)) return;
    const double radius = 3 * volume / area_of({deformable.nodes, cloth.triangles});
    const double tension = pressure * radius / 2 / cloth.stretch_stiffness;
    cloth.prestretch = tension < 1 - 1 / max_stretch ? 1 / (1 - tension) : max_stretch;
    cloth.internal_pressure = pressure;
}

}  // namespace

Result<physics::BodyDefinition> body_from_attributes(const AttributeSet& attributes, const Taxonomy* taxonomy) {
    const PhysicalKind kind = kind_of(attributes);
    if (traits_of(kind).matter == Matter::none) {
        return Error{"kind", "a thing that is only drawn has no body", "set kind to rigid or static"};
    }
    physics::BodyDefinition body;
    body.kind = physics::BodyKind::dynamic_body;
    if (attributes.truth("kinematic", false)) body.kind = physics::BodyKind::kinematic_body;
    if (is_static(kind)) body.kind = physics::BodyKind::static_body;
    body.mass = mass_from(attributes);
    body.material = material_from(attributes, taxonomy);
    body.linear_damping = number_or_standard(attributes, "linear_damping");
    body.angular_damping = number_or_standard(attributes, "angular_damping");
    body.drag_area = number_or_standard(attributes, "drag_coefficient") * attributes.number("drag_area", 0);
    body.gravity_factor = number_or_standard(attributes, "gravity_factor");
    body.sleep_energy_per_mass = number_or_standard(attributes, "sleep_energy_per_mass");
    body.continuous = attributes.truth("continuous", false);
    if (attributes.truth("breaks", false) && body.kind == physics::BodyKind::dynamic_body) {
        const auto brittleness = brittleness_from(attributes);
        if (!brittleness) return brittleness.error();
        body.brittleness = *brittleness;
    }
    body.collision_group = static_cast<std::uint32_t>(number_or_standard(attributes, "collision_group"));
    body.collision_mask = static_cast<std::uint32_t>(number_or_standard(attributes, "collision_mask"));
    return body;
}

Result<physics::ShapeDefinition> shape_from_attributes(const AttributeSet& attributes, const GeometryFacts& facts,
                                                       ModelGeometry& geometry) {
    const std::string shape = attributes.word("collision_shape", "convex_hull");
    if (shape == "trimesh") {
        if (!is_static(kind_of(attributes))) {
            return Error{"collision_shape", "only static things collide with their triangles",
                         "set kind to static or collision_shape to convex_hull"};
        }
        auto mesh = geometry.mesh();
        if (!mesh) return mesh.error();
        return physics::ShapeDefinition{std::move(*mesh)};
    }
    if (shape == "convex_hull") return hull_shape(facts, geometry);
    if (shape == "decomposition") return decomposed_shape(attributes, facts, geometry);
    if (auto valid = validate("collision_shape", shape); !valid) return valid.error();
    return primitive_shape(shape, facts);
}

physics::DeformableDefinition deformable_from_attributes(const AttributeSet& attributes, const Taxonomy* taxonomy) {
    physics::DeformableDefinition deformable;
    deformable.material = material_from(attributes, taxonomy);
    deformable.gravity_factor = number_or_standard(attributes, "gravity_factor");
    deformable.collision_group = static_cast<std::uint32_t>(number_or_standard(attributes, "collision_group"));
    deformable.collision_mask = static_cast<std::uint32_t>(number_or_standard(attributes, "collision_mask"));
    return deformable;
}

Result<physics::DeformableDefinition> soft_solid_from_attributes(const AttributeSet& attributes,
                                                                 const geometry::TetrahedralMesh& mesh,
                                                                 const Taxonomy* taxonomy) {
    constexpr double min_poisson = -0.9, max_poisson = 0.495, min_yield = 1;
    const Result<double> density = spread(attributes, "density", geometry::volume(mesh), "m³", "soft thing");
    if (!density) return density.error();
    physics::DeformableDefinition deformable = deformable_from_attributes(attributes, taxonomy);
    deformable.nodes = mesh.nodes;
    physics::SoftSolid solid;
    solid.tetrahedra = mesh.tetrahedra;
    solid.density = *density;
    solid.youngs_modulus = number_or_standard(attributes, "youngs_modulus");
    solid.poisson_ratio = std::clamp(number_or_standard(attributes, "poisson_ratio"), min_poisson, max_poisson);
    solid.rayleigh_damping = number_or_standard(attributes, "damping_rayleigh");
    solid.yield_stress = std::max(number_or_standard(attributes, "yield_stress"), min_yield);
    solid.internal_pressure = number_or_standard(attributes, "internal_pressure");
    deformable.matter = std::move(solid);
    return deformable;
}

Result<physics::DeformableDefinition> cloth_from_attributes(const AttributeSet& attributes, const SheetMesh& sheet,
                                                            const Taxonomy* taxonomy) {
    constexpr double min_strength = 1e-6, min_tear = 1e-9;  // N/m, J/m
    const double area = area_of(sheet);
    const Result<double> area_density = spread(attributes, "area_density", area, "m²", "cloth");
    if (!area_density) return area_density.error();
    physics::DeformableDefinition deformable = deformable_from_attributes(attributes, taxonomy);
    deformable.nodes = sheet.nodes;
    physics::Cloth cloth;
    cloth.triangles = sheet.triangles;
    cloth.area_density = *area_density;
    // Layers further apart than the distance of the nodes could not fold.
    const double edge = std::sqrt(area / static_cast<double>(sheet.triangles.size()) * 4 / std::sqrt(3));
    cloth.thickness = std::min(number_or_standard(attributes, "thickness"), edge);
    cloth.stretch_stiffness = number_or_standard(attributes, "stretch_stiffness");
    cloth.shear_stiffness = number_or_standard(attributes, "shear_stiffness");
    cloth.bend_stiffness = number_or_standard(attributes, "bend_stiffness");
    cloth.bend_friction = number_or_standard(attributes, "bend_friction");
    cloth.bend_yield = std::max(number_or_standard(attributes, "bend_yield"), min_yield);
    cloth.tear_strength = std::max(number_or_standard(attributes, "tear_strength"), min_strength);
    cloth.tear_energy = std::max(number_or_standard(attributes, "tear_energy"), min_tear);
    cloth.rayleigh_damping = number_or_standard(attributes, "damping_rayleigh");
    cloth.drag_coefficient = number_or_standard(attributes, "drag_coefficient");
    const double pressure = is_closed(cloth) ? number_or_standard(attributes, "internal_pressure") : 0;
    deformable.matter = std::move(cloth);
    if (pressure > 0) inflate(deformable, pressure);
    return deformable;
}

Result<physics::DeformableDefinition> rope_from_attributes(const AttributeSet& attributes,
                                                           const std::vector<Vec3>& nodes, double diameter,
                                                           const Taxonomy* taxonomy) {
    constexpr double min_diameter = 1e-4, max_diameter = 1, min_break = 1e-6;
    double along = 0;
    for (std::size_t i = 1; i < nodes.size(); ++i) along += length(nodes[i] - nodes[i - 1]);
    const double slack = number_or_standard(attributes, "slack");
    along *= 1 + slack;
    const Result<double> linear_density = spread(attributes, "linear_density", along, "m", "rope");
    if (!linear_density) return linear_density.error();
    physics::DeformableDefinition deformable = deformable_from_attributes(attributes, taxonomy);
    deformable.nodes = nodes;
    physics::Rope rope;
    rope.diameter = std::clamp(diameter, min_diameter, max_diameter);
    rope.linear_density = *linear_density;
    rope.axial_stiffness = number_or_standard(attributes, "axial_stiffness");
    rope.bend_rigidity = number_or_standard(attributes, "bend_rigidity");
    rope.bend_yield = std::max(number_or_standard(attributes, "bend_yield"), min_yield);
    rope.twist_rigidity = number_or_standard(attributes, "twist_rigidity");
    rope.rayleigh_damping = number_or_standard(attributes, "damping_rayleigh");
    rope.break_tension = std::max(number_or_standard(attributes, "break_tension"), min_break);
    rope.slack = slack;
    deformable.matter = rope;
    return deformable;
}

physics::FluidDefinition fluid_from_attributes(const AttributeSet& attributes) {
    constexpr double min_density = 1, max_viscosity = 1e4, max_yield_stress = 1e4;
    physics::FluidDefinition fluid;
    fluid.density = std::max(number_or_standard(attributes, "rest_density"), min_density);
    fluid.viscosity = std::min(number_or_standard(attributes, "dynamic_viscosity"), max_viscosity);
    fluid.yield_stress = std::min(number_or_standard(attributes, "yield_stress_fluid"), max_yield_stress);
    fluid.surface_tension = number_or_standard(attributes, "surface_tension");
    fluid.cell_size = number_or_standard(attributes, "fluid_cell_size");
    return fluid;
}

}  // namespace embody::attributes
