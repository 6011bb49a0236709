// SPDX-License-Identifier: MIT
#include "world_definitions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/definitions/deformable_primitives.h"

namespace embody::fuzz {

using namespace physics;

namespace {

constexpr double small = 0.05, large = 0.6;  // sizes of shapes, m

HullShape read_hull(ByteReader& bytes) {
    HullShape hull;
    const std::size_t count = 3 + bytes.below(10);
    for (std::size_t i = 0; i < count; ++i) hull.points.push_back(bytes.vector(-large, large));
    return hull;
}

HeightfieldShape read_heightfield(ByteReader& bytes) {
    HeightfieldShape field;
    field.columns = static_cast<int>(bytes.below(6));
    field.rows = static_cast<int>(bytes.below(6));
    field.cell_x = bytes.number(small, 2);
    field.cell_z = bytes.number(small, 2);
    const auto count = static_cast<std::size_t>(field.columns * field.rows);
    for (std::size_t i = 0; i < count; ++i) field.heights.push_back(static_cast<float>(bytes.number(-large, large)));
    if (count > 0 && bytes.is_one_of(16)) field.heights.pop_back();
    return field;
}

MeshShape read_mesh(ByteReader& bytes) {
    MeshShape mesh;
    const std::size_t points = 3 + bytes.below(8), triangles = 1 + bytes.below(8);
    for (std::size_t i = 0; i < points; ++i) mesh.positions.push_back(to_vec3f(bytes.vector(-3, 3)));
    const auto corner = [&] { return static_cast<std::uint32_t>(bytes.below(points + bytes.is_one_of(64))); };
    for (std::size_t i = 0; i < triangles; ++i) {
        const std::uint32_t a = corner(), b = corner(), c = corner();
        mesh.triangles.push_back({a, b, c});
    }
    return mesh;
}

// All shapes that can be a child of a compound.
template <class Shape>
Shape read_convex(ByteReader& bytes) {
    const auto size = [&] { return bytes.number(small, large); };
    switch (bytes.below(6)) {
        case 0:
            return SphereShape{size()};
        case 1:
            return BoxShape{bytes.vector(small, large)};
        case 2: {
            const double radius = size();
            return CapsuleShape{radius, size()};
        }
        case 3: {
            const double radius = size();
            return CylinderShape{radius, size()};
        }
        case 4: {
            const double radius = size();
            return ConeShape{radius, size()};
        }
        default:
            return read_hull(bytes);
    }
}

CompoundShape read_compound(ByteReader& bytes) {
    CompoundShape compound;
    const std::size_t count = bytes.below(4);
    for (std::size_t i = 0; i < count; ++i) {
        auto shape = read_convex<decltype(CompoundChild::shape)>(bytes);
        const Vec3 place = bytes.vector(-large, large);
        compound.children.push_back({std::move(shape), {place, bytes.rotation()}});
    }
    return compound;
}

void change_material(ByteReader& bytes, Material& material) {
    switch (bytes.below(7)) {
        case 0:
            material.friction_static = material.friction_dynamic = bytes.number(0, 2);
            break;
        case 1:
            material.friction_dynamic = bytes.number(0, 1);
            break;
        case 2:
            material.friction_rolling = bytes.number(0, 0.05);
            break;
        case 3:
            material.friction_torsional = bytes.number(0, 0.1);
            break;
        case 4:
            material.restitution = bytes.number(0, 1);
            break;
        case 5:
            material.surface = static_cast<SurfaceId>(bytes.below(4));
            break;
        default:
            material.friction_combine = static_cast<CombineRule>(bytes.below(8));
            material.restitution_combine = static_cast<CombineRule>(bytes.below(8));
    }
}

void change_mass(ByteReader& bytes, MassDefinition& mass) {
    switch (bytes.below(4)) {
        case 0:
            mass.density = bytes.number(1, 10'000);
            break;
        case 1:
            mass.mass = bytes.number(0.01, 100);
            break;
        case 2:
            mass.center_of_mass = bytes.vector(-0.3, 0.3);
            break;
        default: {
            const Vec3 moments = bytes.vector(0.01, 2);
            mass.inertia = Mat3{{moments.x, 0, 0}, {0, moments.y, bytes.number(0, 0.01)}, {0, 0, moments.z}};
        }
    }
}

void change_body_field(ByteReader& bytes, BodyDefinition& body) {
    switch (bytes.below(16)) {
        case 0:
            body.kind = static_cast<BodyKind>(bytes.below(4));
            break;
        case 1:
            body.position = bytes.vector(-2, 2);
            break;
        case 2:
            body.rotation = bytes.rotation();
            break;
        case 3:
            body.linear_velocity = bytes.vector(-20, 20);
            break;
        case 4:
            body.angular_velocity = bytes.vector(-50, 50);
            break;
        case 5:
            change_mass(bytes, body.mass);
            break;
        case 6:
            change_material(bytes, body.material);
            break;
        case 7:
            body.linear_damping = bytes.number(0, 100);
            break;
        case 8:
            body.angular_damping = bytes.number(0, 100);
            break;
        case 9:
            body.drag_area = bytes.number(0, 10);
            break;
        case 10:
            body.gravity_factor = bytes.number(-10, 10);
            break;
        case 11:
            body.force = bytes.vector(-1000, 1000);
            body.torque = bytes.vector(-100, 100);
            break;
        case 12:
            body.sleep_energy_per_mass = bytes.number(0, 1);
            body.allow_sleep = !bytes.is_one_of(4);
            break;
        case 13:
            body.start_asleep = !body.start_asleep;
            body.enabled = !bytes.is_one_of(4);
            break;
        case 14:
            body.continuous = !body.continuous;
            break;
        default:
            body.collision_group = bytes.byte();
            body.collision_mask = bytes.byte();
    }
}

void change_matter(ByteReader& bytes, SoftSolid& solid) {
    const std::array<std::pair<double*, std::array<double, 2>>, 6> fields{{{&solid.density, {10, 5000}},
                                                                           {&solid.youngs_modulus, {100, 1e7}},
                                                                           {&solid.poisson_ratio, {-0.9, 0.495}},
                                                                           {&solid.rayleigh_damping, {0, 1}},
                                                                           {&solid.yield_stress, {1, 1e5}},
                                                                           {&solid.internal_pressure, {0, 1e5}}}};
    const auto& [field, range] = fields[bytes.below(fields.size())];
    *field = bytes.number(range[0], range[1]);
    if (bytes.is_one_of(32)) solid.tetrahedra[0][0] = bytes.byte();
}

void change_matter(ByteReader& bytes, Cloth& cloth) {
    const std::array<std::pair<double*, std::array<double, 2>>, 11> fields{{{&cloth.area_density, {0.01, 5}},
                                                                            {&cloth.thickness, {1e-6, 0.1}},
                                                                            {&cloth.stretch_stiffness, {1, 1e5}},
                                                                            {&cloth.shear_stiffness, {1, 1e4}},
                                                                            {&cloth.bend_stiffness, {1e-6, 1}},
                                                                            {&cloth.bend_friction, {0, 1e3}},
                                                                            {&cloth.bend_yield, {1, 1e3}},
                                                                            {&cloth.tear_strength, {1, 1e4}},
                                                                            {&cloth.tear_energy, {1e-3, 10}},
                                                                            {&cloth.rayleigh_damping, {0, 1}},
                                                                            {&cloth.drag_coefficient, {0, 10}}}};
    const auto& [field, range] = fields[bytes.below(fields.size())];
    *field = bytes.number(range[0], range[1]);
    if (bytes.is_one_of(32)) cloth.triangles[0][0] = bytes.byte();
}

void change_matter(ByteReader& bytes, Rope& rope) {
    const std::array<std::pair<double*, std::array<double, 2>>, 9> fields{{{&rope.diameter, {0.001, 0.2}},
                                                                           {&rope.linear_density, {0.001, 5}},
                                                                           {&rope.axial_stiffness, {1, 1e6}},
                                                                           {&rope.bend_rigidity, {1e-9, 1}},
                                                                           {&rope.twist_rigidity, {1e-9, 1}},
                                                                           {&rope.rayleigh_damping, {0, 1}},
                                                                           {&rope.break_tension, {0.1, 1000}},
                                                                           {&rope.bend_yield, {1, 1e3}},
                                                                           {&rope.slack, {0, 2}}}};
    const auto& [field, range] = fields[bytes.below(fields.size())];
    *field = bytes.number(range[0], range[1]);
}

void change_deformable_field(ByteReader& bytes, DeformableDefinition& deformable) {
    const std::size_t nodes = deformable.nodes.size();
    switch (bytes.below(11)) {
        case 0:
            std::visit([&](auto& matter) { change_matter(bytes, matter); }, deformable.matter);
            break;
        case 1:
            deformable.pinned.push_back(static_cast<std::uint32_t>(bytes.below(nodes + bytes.is_one_of(32))));
            break;
        case 2:
            deformable.pose = {bytes.vector(-1, 2), bytes.rotation()};
            break;
        case 3:
            deformable.linear_velocity = bytes.vector(-10, 10);
            break;
        case 4:
            deformable.angular_velocity = bytes.vector(-20, 20);
            break;
        case 5:
            deformable.gravity_factor = bytes.number(-10, 10);
            break;
        case 6:
            deformable.force = bytes.vector(-100, 100);
            break;
        case 7:
            change_material(bytes, deformable.material);
            break;
        case 8:
            deformable.contact_radius = bytes.number(1e-4, 0.05);
            break;
        case 9:
            deformable.enabled = !deformable.enabled;
            deformable.collision_mask = bytes.byte();
            break;
        default:
            // Rarely, because nearly all such changes are refused.
            if (bytes.is_one_of(4)) deformable.nodes[bytes.below(nodes)] = bytes.vector(-1, 1);
    }
}

void change_joint_field(ByteReader& bytes, JointDefinition& joint) {
    const auto make = [&](auto kind) {
        if (bytes.is_one_of(2)) {
            const double lower = bytes.number(-1, 0);
            kind.limit = JointLimit{lower, bytes.number(0, 1)};
        }
        if (bytes.is_one_of(2)) {
            const double speed = bytes.number(-5, 5);
            kind.motor = JointMotor{speed, bytes.number(0, 100)};
        }
        joint.joint = kind;
    };
    switch (bytes.below(7)) {
        case 0:
            joint.joint = FixedJoint{};
            break;
        case 1:
            joint.joint = BallJoint{};
            break;
        case 2:
            make(HingeJoint{});
            break;
        case 3:
            make(SliderJoint{});
            break;
        case 4:
            joint.frame_a = {bytes.vector(-1, 2), bytes.rotation()};
            break;
        case 5:
            joint.frame_b = {bytes.vector(-1, 1), bytes.rotation()};
            break;
        default:
            joint.bodies_collide = !joint.bodies_collide;
    }
}

// Number of particles of the boxes and hulls, if they did not overlap.
double particles_of(const FluidDefinition& fluid) {
    double volume = 0;
    const auto add = [&](const Bounds& box) {
        if (box.is_empty()) return;
        const Vec3 size = box.size();
        volume += size.x * size.y * size.z;
    };
    for (const Bounds& box : fluid.boxes) add(box);
    for (const auto& hull : fluid.hulls) {
        Bounds box;
        for (const Vec3 point : hull) box.add(point);
        add(box);
    }
    return 8 * volume / (fluid.cell_size * fluid.cell_size * fluid.cell_size);
}

}  // namespace

ShapeDefinition read_shape(ByteReader& bytes) {
    switch (bytes.below(10)) {
        case 0: {
            const Vec3 normal{bytes.number(0, 1), 1, bytes.number(0, 1)};
            return PlaneShape{bytes.is_one_of(8) ? bytes.vector(-1, 1) : normal, bytes.number(0, 1)};
        }
        case 1:
            return read_heightfield(bytes);
        case 2:
            return read_mesh(bytes);
        case 3:
            return read_compound(bytes);
        default:
            return read_convex<ShapeDefinition>(bytes);
    }
}

void change_body(ByteReader& bytes, BodyDefinition& body) {
    for (std::size_t times = bytes.below(4); times > 0; --times) change_body_field(bytes, body);
}

void change_joint(ByteReader& bytes, JointDefinition& joint) {
    for (std::size_t times = bytes.below(4); times > 0; --times) change_joint_field(bytes, joint);
}

void change_deformable(ByteReader& bytes, DeformableDefinition& deformable) {
    for (std::size_t times = bytes.below(4); times > 0; --times) change_deformable_field(bytes, deformable);
}

void change_settings(ByteReader& bytes, WorldSettings& settings) {
    switch (bytes.below(12)) {
        case 0:
            settings.gravity = bytes.vector(-20, 20);
            break;
        case 1:
            settings.time_step = bytes.number(1e-4, 0.1);
            break;
        case 2:
            settings.substeps = static_cast<int>(bytes.below(10));
            break;
        case 3:
            settings.wind = bytes.vector(-30, 30);
            break;
        case 4:
            settings.gustiness = bytes.number(0, 2);
            break;
        case 5:
            settings.gust_time = bytes.number(0.05, 10);
            break;
        case 6:
            settings.air_density = bytes.number(0, 100);
            break;
        case 7:
            settings.deformable_substeps = static_cast<int>(bytes.below(6));
            break;
        case 8:
            settings.time_to_sleep = bytes.number(0.05, 1);
            break;
        case 9:
            settings.sleeping = !settings.sleeping;
            break;
        case 10:
            settings.shock_propagation = !settings.shock_propagation;
            break;
        default:
            settings.max_linear_speed = bytes.number(1, 1e6);
            settings.max_angular_speed = bytes.number(1, 1e5);
    }
}

DeformableDefinition read_deformable(ByteReader& bytes) {
    const auto size = [&] { return 0.2 + bytes.byte() / 255.0; };
    DeformableDefinition made;
    switch (bytes.below(4)) {
        case 0: {
            const double x = size(), z = size();
            made = cloth_rectangle(x, z, std::max(x, z) / 4);
            break;
        }
        case 1: {
            const double radius = size();
            made = cloth_disc(radius, radius / 2);
            break;
        }
        case 2: {
            const double length = size();
            made = rope_between({}, {length, 0, 0}, length / static_cast<double>(1 + bytes.below(12)));
            break;
        }
        default: {
            const double x = size(), y = size(), z = size();
            const auto cells = [&] { return 1 + static_cast<int>(bytes.below(2)); };
            const int columns = cells(), rows = cells(), layers = cells();
            made = tetrahedral_brick({x, y, z}, {columns, rows, layers});
        }
    }
    made.pose.position = {0, 1, 0};
    change_deformable(bytes, made);
    return made;
}

FluidDefinition read_fluid(ByteReader& bytes) {
    FluidDefinition fluid;
    fluid.cell_size = bytes.number(0.05, 0.3);
    const auto place = [&] { return bytes.vector(-1, 1); };
    switch (bytes.below(3)) {
        case 0: {
            const Vec3 lower = place();
            fluid.boxes.push_back({lower, lower + bytes.vector(0.1, 0.8)});
            break;
        }
        case 1: {
            fluid.hulls.emplace_back();
            for (std::size_t i = bytes.below(8); i > 0; --i) fluid.hulls.back().push_back(place());
            break;
        }
        default:
            for (std::size_t i = bytes.below(30); i > 0; --i) fluid.points.push_back(place());
    }
    if (bytes.is_one_of(2)) change_fluid_matter(bytes, fluid);
    const double particles = particles_of(fluid);
    constexpr double quick = 600, refused = 10.0 * max_fluid_particles;
    if (particles > quick && !(particles > refused)) fluid.boxes.clear(), fluid.hulls.clear();
    return fluid;
}

void change_fluid_matter(ByteReader& bytes, FluidDefinition& fluid) {
    switch (bytes.below(7)) {
        case 0:
            fluid.velocity = bytes.vector(-5, 5);
            break;
        case 1:
            fluid.density = bytes.number(1, 20'000);
            break;
        case 2:
            fluid.viscosity = bytes.number(0, 100);
            break;
        case 3:
            fluid.yield_stress = bytes.number(0, 100);
            break;
        case 4:
            fluid.surface_tension = bytes.number(0, 1);
            break;
        case 5:
            fluid.gravity_factor = bytes.number(-10, 10);
            break;
        default:
            fluid.allow_sleep = !fluid.allow_sleep;
    }
}

}  // namespace embody::fuzz
