// SPDX-License-Identifier: MIT
#include "validation/random_matter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/definitions/grain_material.h"
#include "validation/random_bodies.h"

namespace embody::physics {
namespace {

constexpr double most_speed = 3, most_spin = 10;  // m/s along each axis, rad/s about each

/// Places things one over the other.
class ThrownMatter {
public:
    ThrownMatter(World& world, double& height, std::uint64_t seed) : world_(world), height_(height), random_(seed) {}

    void add(MatterKind kind) {
        switch (kind) {
            case MatterKind::rigid:
                return add_rigid();
            case MatterKind::jointed:
                return add_jointed();
            case MatterKind::cloth:
                return add_deformable(random_cloth());
            case MatterKind::rope:
                return add_deformable(random_rope());
            case MatterKind::solid:
                return add_deformable(random_solid());
            case MatterKind::liquid:
                return add_liquid();
            case MatterKind::grains:
                return add_grains();
        }
    }

private:
    double scaled(double low, double high) { return std::exp(random_.between(std::log(low), std::log(high))); }
    double random_mass() { return scaled(0.1, 50); }
    double random_damping() { return random_.below(2) == 0 ? 0 : scaled(1e-4, 0.1); }

    /// Where the origin of something with these bounds about it goes, so that it is above all so far.
    Vec3 place_for(const Bounds& bounds) {
        const double gap = random_.between(0.02, 0.2);
        const Vec3 place{random_.between(-0.05, 0.05), height_ + gap - bounds.lower.y, random_.between(-0.05, 0.05)};
        height_ = place.y + bounds.upper.y;
        return place;
    }

    void add_rigid() {
        const ShapeHandle shape = world_.create_shape(random_shape(random_, 0.2)).value();
        const Quat rotation = random_rotation(random_);
        EXPECT_TRUE(world_.create_body({.shape = shape,
                                        .position = place_for(world_.bounds(shape, {{}, rotation})),
                                        .rotation = rotation,
                                        .linear_velocity = random_vector(random_, most_speed),
                                        .angular_velocity = random_vector(random_, most_spin),
                                        .mass = {.mass = random_mass()},
                                        .material = random_material(random_)}));
    }

    /// Two to four balls side by side, each on a ball joint with the last one; in half of the scenes the first one is
    /// hung on the world.
    void add_jointed() {
        const int count = 2 + static_cast<int>(random_.below(3));
        const double radius = random_.between(0.03, 0.08), mass = random_mass() / count, reach = 1.1 * radius;
        const Quat rotation = random_rotation(random_);
        const Vec3 along = rotate(rotation, {1, 0, 0});
        Bounds bounds;
        for (const int i : {0, count - 1}) {
            const Vec3 center = (2 * i - count + 1) * reach * along;
            bounds.add(center - Vec3{reach, reach, reach});
            bounds.add(center + Vec3{reach, reach, reach});
        }
        const Vec3 middle = place_for(bounds), velocity = random_vector(random_, most_speed);
        const Material material = random_material(random_);
        const ShapeHandle shape = world_.create_shape(SphereShape{radius}).value();
        BodyHandle last;
        const bool hangs = random_.below(2) == 0;
        for (int i = 0; i < count; ++i) {
            const Vec3 center = middle + (2 * i - count + 1) * reach * along;
            const BodyHandle ball = world_
                                        .create_body({.shape = shape,
                                                      .position = center,
                                                      .rotation = rotation,
                                                      .linear_velocity = hangs ? Vec3{} : velocity,
                                                      .mass = {.mass = mass * random_.between(0.5, 1.5)},
                                                      .material = material})
                                        .value();
            JointDefinition joint{.joint = BallJoint{}, .body_a = last, .body_b = ball};
            joint.frame_a.position = last.is_null() ? center - reach * along : Vec3{reach, 0, 0};
            joint.frame_b.position = {-reach, 0, 0};
            if (hangs || !last.is_null()) {
                EXPECT_TRUE(world_.create_joint(joint));
            }
            last = ball;
        }
    }

    DeformableDefinition random_cloth() {
        const double x = random_.between(0.2, 0.45), z = random_.between(0.2, 0.45), stretch = scaled(300, 1e4);
        return cloth_rectangle(x, z, std::max(x, z) / random_.between(5, 11),
                               {.area_density = random_mass() / (x * z),
                                .stretch_stiffness = stretch,
                                .shear_stiffness = stretch * random_.between(0.1, 0.5),
                                .bend_stiffness = scaled(1e-6, 1e-2),
                                .rayleigh_damping = random_damping()});
    }

    DeformableDefinition random_rope() {
        const double length = random_.between(0.2, 0.6);
        DeformableDefinition rope =
            rope_between({-length / 2, 0, 0}, {length / 2, 0, 0}, length / random_.between(5, 28),
                         {.linear_density = random_mass() / length,
                          .axial_stiffness = scaled(1e3, 1e6),
                          .bend_rigidity = scaled(1e-5, 1e-1),
                          .rayleigh_damping = random_damping()});
        rope.contact_radius = 5e-3;
        return rope;
    }

    DeformableDefinition random_solid() {
        const Vec3 size{random_.between(0.1, 0.3), random_.between(0.1, 0.3), random_.between(0.1, 0.3)};
        const auto cells = [&] { return 1 + static_cast<int>(random_.below(3)); };
        return tetrahedral_brick(size, {cells(), cells(), cells()},
                                 {.density = random_mass() / (size.x * size.y * size.z),
                                  .youngs_modulus = scaled(1e4, 1e7),
                                  .poisson_ratio = random_.between(0, 0.45),
                                  .rayleigh_damping = random_damping()});
    }

    /// Free, pinned at its first node or at that and its last one, or with a ball on its last node.
    void add_deformable(DeformableDefinition definition) {
        const auto last = static_cast<std::uint32_t>(definition.nodes.size() - 1);
        const double weight_radius = random_.below(4) == 0 ? random_.between(0.03, 0.08) : 0;
        if (weight_radius == 0 && random_.below(3) == 0) {
            definition.pinned.push_back(0);
            if (random_.below(2) == 0) definition.pinned.push_back(last);
        }
        definition.pose.rotation = random_rotation(random_);
        Bounds bounds;
        const double around = 2 * weight_radius;
        for (const Vec3 node : definition.nodes) {
            const Vec3 place = rotate(definition.pose.rotation, node);
            bounds.add(place - Vec3{around, around, around});
            bounds.add(place + Vec3{around, around, around});
        }
        definition.pose.position = place_for(bounds);
        definition.linear_velocity = random_vector(random_, most_speed);
        definition.angular_velocity = random_vector(random_, most_spin);
        definition.material = random_material(random_);
        const DeformableHandle handle = world_.create_deformable(definition).value();
        if (weight_radius == 0) return;
        const Vec3 middle = world_.center_of_mass(handle), node = world_.node_positions(handle)[last];
        const Vec3 arm = node - middle, center = node + weight_radius * normalized(arm, {1, 0, 0});
        const BodyHandle ball =
            world_
                .create_body({.shape = world_.create_shape(SphereShape{weight_radius}).value(),
                              .position = center,
                              .linear_velocity =
                                  definition.linear_velocity + cross(definition.angular_velocity, center - middle),
                              .angular_velocity = definition.angular_velocity,
                              .mass = {.mass = random_mass()},
                              .material = random_material(random_)})
                .value();
        EXPECT_TRUE(world_.set_attachments(handle, {{last, ball, node - center}}));
    }

    void add_liquid() {
        const double cell = random_.between(0.03, 0.04);
        const auto half = [&] { return cell * random_.between(1.5, 3); };
        const Vec3 halves{half(), half(), half()};
        const Vec3 center = place_for({-halves, halves});
        EXPECT_TRUE(world_.create_fluid({.boxes = {{center - halves, center + halves}},
                                         .velocity = random_vector(random_, most_speed),
                                         .density = random_.between(700, 2000),
                                         .viscosity = scaled(1e-3, 10),
                                         .cell_size = cell}));
    }

    /// A block of balls that do not touch, each with a spin of its own.
    void add_grains() {
        const double diameter = random_.between(0.02, 0.04);
        Material material = grain_material(random_.between(20, 45), diameter);
        if (random_.below(2) == 0) material.restitution = random_.unit();
        const std::array<int, 3> counts{2 + static_cast<int>(random_.below(5)), 1 + static_cast<int>(random_.below(8)),
                                        2 + static_cast<int>(random_.below(5))};
        const double pitch = 1.1 * diameter, mass = random_mass() / (counts[0] * counts[1] * counts[2]);
        const Vec3 halves = pitch / 2 * Vec3{1.0 * counts[0], 1.0 * counts[1], 1.0 * counts[2]};
        const Vec3 lowest = place_for({-halves, halves}) - halves;
        const Vec3 velocity = random_vector(random_, most_speed);
        const ShapeHandle shape = world_.create_shape(SphereShape{diameter / 2}).value();
        for (int i = 0; i < counts[0] * counts[1] * counts[2]; ++i) {
            const Vec3 cell{0.5 + i % counts[0], 0.5 + i / counts[0] % counts[1], 0.5 + i / counts[0] / counts[1]};
            EXPECT_TRUE(world_.create_body({.shape = shape,
                                            .position = lowest + pitch * cell,
                                            .linear_velocity = velocity,
                                            .angular_velocity = random_vector(random_, most_spin),
                                            .mass = {.mass = mass},
                                            .material = material}));
        }
    }

    World& world_;
    double& height_;  // of the highest point of all so far, m
    Random random_;
};

/// A floor, or with walls around it, too.
void add_tub(World& world, Random& random, bool has_walls) {
    const Material material = random_material(random);
    const double half = random.between(0.55, 0.8);
    for (const Vec3 inward : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        if (inward.y == 0 && !has_walls) continue;
        const auto shape = world.create_shape(PlaneShape{inward, inward.y > 0 ? 0.0 : -half}).value();
        EXPECT_TRUE(world.create_body({.kind = BodyKind::static_body, .shape = shape, .material = material}));
    }
}

}  // namespace

std::string name_of(MatterKind kind) {
    static constexpr std::array names{"rigid", "jointed", "cloth", "rope", "solid", "liquid", "grains"};
    return names.at(static_cast<std::size_t>(kind));
}

std::string MatterScene::kinds_together() const {
    std::string text;
    for (const MatterKind kind : std::set(kinds.begin(), kinds.end()))
        text += (text.empty() ? "" : "+") + name_of(kind);
    return text;
}

MatterScene random_matter(std::uint64_t seed, std::uint32_t kept) {
    Random random(seed);
    MatterScene scene{.world = make_world({.air_density = 0}), .kinds = {}};
    const std::uint64_t count = 1 + random.below(4);
    std::vector<MatterKind> drawn;
    while (drawn.size() < count) {
        const auto kind = static_cast<MatterKind>(random.below(7));
        // Fluids pass through each other; and many particles or grains take long.
        const bool is_single = kind == MatterKind::liquid || kind == MatterKind::grains;
        if (is_single && std::ranges::find(drawn, kind) != drawn.end()) continue;
        drawn.push_back(kind);
    }
    const bool has_liquid = std::ranges::find(drawn, MatterKind::liquid) != drawn.end();
    add_tub(*scene.world, random, random.below(2) == 0 || has_liquid);
    double height = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t own_seed = random.next();
        if ((kept >> i & 1u) == 0) {
            // It is made elsewhere, so that the height is as with it.
            const auto other = make_world({});
            ThrownMatter(*other, height, own_seed).add(drawn[i]);
            continue;
        }
        ThrownMatter(*scene.world, height, own_seed).add(drawn[i]);
        scene.kinds.push_back(drawn[i]);
    }
    return scene;
}

}  // namespace embody::physics
