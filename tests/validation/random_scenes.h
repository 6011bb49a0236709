// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {

inline void add_ground(World& world, const ShapeDefinition& shape, Vec3 position, const Material& material) {
    const auto handle = world.create_shape(shape).value();
    ASSERT_TRUE(world.create_body(
        {.kind = BodyKind::static_body, .shape = handle, .position = position, .material = material}));
}

inline MeshShape bumpy_mesh(Random& random) {
    constexpr std::uint32_t cells = 24;
    constexpr double pitch = 0.8, height = 0.3;
    MeshShape mesh;
    for (std::uint32_t i = 0; i <= cells; ++i) {
        for (std::uint32_t j = 0; j <= cells; ++j) {
            mesh.positions.push_back(
                to_vec3f({(i - cells / 2.0) * pitch, height * random.unit(), (j - cells / 2.0) * pitch}));
        }
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t a = i * (cells + 1) + j, c = a + cells + 1;
            mesh.triangles.push_back({a, a + 1, c});
            mesh.triangles.push_back({a + 1, c + 1, c});
        }
    }
    return mesh;
}

/// A plane, a slab, a pen of planes or a bumpy mesh.
inline void add_random_ground(World& world, Random& random) {
    const Material material{.restitution = random.unit()};
    switch (random.below(4)) {
        case 0:
            return add_ground(world, PlaneShape{{0, 1, 0}, 0}, {}, material);
        case 1:
            return add_ground(world, BoxShape{{20, 1, 20}}, {0, -1, 0}, material);
        case 2:
            for (const Vec3 inward : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
                add_ground(world, PlaneShape{inward, inward.y > 0 ? 0.0 : -3.0}, {}, material);
            }
            return;
        default:
            return add_ground(world, bumpy_mesh(random), {}, material);
    }
}

// 2 to 20 bodies thrown into the air over a ground, none of them in another, fast and spinning in half of the scenes.
inline std::unique_ptr<World> random_scene(std::uint64_t seed) {
    Random random(seed);
    auto world = make_world({});
    add_random_ground(*world, random);
    const int count = 2 + static_cast<int>(random.below(19));
    const double spin = random.below(2) > 0 ? 5 : 50, speed = random.below(2) > 0 ? 3 : 15;
    for (int i = 0; i < count; ++i) {
        EXPECT_TRUE(world->create_body({.shape = world->create_shape(random_shape(random, 0.5)).value(),
                                        .position = {random.between(-1, 1), 1.5 + 1.8 * i, random.between(-1, 1)},
                                        .rotation = random_rotation(random),
                                        .linear_velocity = random_vector(random, speed),
                                        .angular_velocity = random_vector(random, spin),
                                        .mass = {.density = random.between(100, 5000)},
                                        .material = random_material(random)}));
    }
    return world;
}

inline MeshShape slab_of_triangles() {
    MeshShape mesh;
    constexpr std::uint32_t cells = 8;
    for (std::uint32_t i = 0; i <= cells; ++i) {
        for (std::uint32_t j = 0; j <= cells; ++j) mesh.positions.push_back(to_vec3f({i * 0.5 - 2, 0, j * 0.5 - 2}));
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t a = i * (cells + 1) + j, c = a + cells + 1;
            mesh.triangles.push_back({a, a + 1, c});
            mesh.triangles.push_back({a + 1, c + 1, c});
        }
    }
    return mesh;
}

/// What something is thrown at: a plane, a slab, a mesh or a ball that stand still, or any shape that floats freely and
/// spins.
inline void add_target(World& world, Random& random, const Material& material) {
    BodyDefinition target{.kind = BodyKind::static_body, .material = material};
    ShapeDefinition shape = PlaneShape{{0, 1, 0}, 0};
    switch (random.below(5)) {
        case 0:
            break;
        case 1:
            shape = BoxShape{{5, 1, 5}};
            target.position.y = -1;
            break;
        case 2:
            shape = slab_of_triangles();
            break;
        case 3:
            shape = SphereShape{0.5};
            target.position.y = -0.5;
            break;
        default:
            shape = random_shape(random, 0.5);
            target.kind = BodyKind::dynamic_body;
            target.position.y = -0.9;
            target.rotation = random_rotation(random);
            target.angular_velocity = random_direction(random) * random.between(0, 100);
            target.mass.mass = random.between(0.1, 100);
    }
    target.shape = world.create_shape(shape).value();
    EXPECT_TRUE(world.create_body(target));
}

/// Something thrown at a target, spinning fast, in free space; and the steps until it has come, and gone or come to
/// rest.
struct RandomImpact {
    std::unique_ptr<World> world;
    int steps = 0;
};
inline RandomImpact random_impact(std::uint64_t seed) {
    Random random(seed);
    auto world = make_world({.gravity = {}});
    const Material material = random_material(random);
    add_target(*world, random, material);
    const double size = random.between(0.05, 0.5), speed = random.between(0.1, 10);
    const double height = 1.8 * size + random.between(0, speed * world->settings().time_step);
    EXPECT_TRUE(world->create_body({.shape = world->create_shape(random_shape(random, size)).value(),
                                    .position = {0, height, 0},
                                    .rotation = random_rotation(random),
                                    .linear_velocity = {random.between(-speed, speed), -speed, 0},
                                    .angular_velocity = random_direction(random) * random.between(0, 100),
                                    .mass = {.mass = random.between(0.1, 10)},
                                    .material = material}));
    const int steps = std::min(400, 20 + static_cast<int>(4 * height / speed / world->settings().time_step));
    return {std::move(world), steps};
}

// 3 to 12 bodies that fly at each other in free space, without ground; spins up to 20 rad/s in half of the scenes.
inline std::unique_ptr<World> random_swarm(std::uint64_t seed) {
    Random random(seed);
    auto world = make_world({.gravity = {}});
    const int count = 3 + static_cast<int>(random.below(10));
    const double spin = random.below(2) > 0 ? 1 : 20;
    for (int i = 0; i < count; ++i) {
        const Vec3 place{2.5 * (i % 3 - 1), 2.5 * (i / 3 % 2), 2.5 * (i / 6)};
        EXPECT_TRUE(world->create_body({.shape = world->create_shape(random_shape(random, 0.6)).value(),
                                        .position = place,
                                        .rotation = random_rotation(random),
                                        .linear_velocity = (Vec3{0, 1, 1} - place) * random.between(0.3, 3),
                                        .angular_velocity = random_vector(random, spin),
                                        .mass = {.density = random.between(100, 5000)},
                                        .material = random_material(random)}));
    }
    return world;
}

// A chain of 2 to 8 bodies on ball joints and hinges, from the ceiling or in the air, over a floor or without.
inline std::unique_ptr<World> random_chain(std::uint64_t seed, bool has_floor) {
    Random random(seed);
    auto world = make_world({});
    const int count = 2 + static_cast<int>(random.below(7));
    const bool hangs = random.below(2) > 0;
    const double bounce = random.unit();
    if (has_floor) add_ground(*world, PlaneShape{{0, 1, 0}, -1.5}, {}, {.restitution = bounce});
    BodyHandle last;
    for (int i = 0; i < count; ++i) {
        const Vec3 end{0.4 * i, 0, 0};
        const double half = random.between(0.03, 0.1);
        const auto body = world->create_body({.shape = world->create_shape(BoxShape{{0.15, half, half}}).value(),
                                              .position = end + Vec3{0.2, 0, 0},
                                              .linear_velocity = hangs ? Vec3{} : random_vector(random, 2),
                                              .mass = {.density = random.between(100, 5000)},
                                              .material = random_material(random)});
        EXPECT_TRUE(body);
        JointDefinition joint{.body_a = last, .body_b = *body};
        joint.frame_a.position = last.is_null() ? end : Vec3{0.2, 0, 0};
        joint.frame_b.position = {-0.2, 0, 0};
        if (random.below(3) == 0) {
            // About Z, across the chain.
            const Quat axis = normalized(Quat{0, -1, 0, 1});
            joint.frame_a.rotation = joint.frame_b.rotation = axis;
            joint.joint = HingeJoint{};
        } else {
            joint.joint = BallJoint{};
        }
        if (!last.is_null() || hangs) {
            EXPECT_TRUE(world->create_joint(joint));
        }
        last = *body;
    }
    return world;
}

}  // namespace embody::physics
