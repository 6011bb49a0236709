// SPDX-License-Identifier: MIT
#include "validation/golden_scenes.h"

#include <gtest/gtest.h>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

GoldenScene begin(const WorldSettings& settings = {}) {
    GoldenScene scene{make_world(settings)};
    const auto plane = scene.world->create_shape(PlaneShape{}).value();
    EXPECT_TRUE(scene.world->create_body({.kind = BodyKind::static_body, .shape = plane}));
    return scene;
}

Quat random_rotation(Random& random) {
    return normalized({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

Vec3 random_point(Random& random, double half) {
    return {random.between(-half, half), random.between(-half, half), random.between(-half, half)};
}

// Drops `count` bodies of the shapes in turn, one above the other.
void drop(World& world, std::span<const ShapeDefinition> definitions, int count, const Material& material,
          std::uint64_t seed) {
    std::vector<ShapeHandle> shapes;
    for (const ShapeDefinition& definition : definitions) shapes.push_back(world.create_shape(definition).value());
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const Vec3 place{random.between(-1, 1), 1 + 0.35 * i, random.between(-1, 1)};
        ASSERT_TRUE(world.create_body({.shape = shapes[static_cast<std::size_t>(i) % shapes.size()],
                                       .position = place,
                                       .rotation = random_rotation(random),
                                       .linear_velocity = random_point(random, 1),
                                       .angular_velocity = random_point(random, 3),
                                       .material = material}));
    }
}

GoldenScene balls_and_boxes() {
    GoldenScene scene = begin();
    const ShapeDefinition shapes[] = {SphereShape{0.3}, BoxShape{{0.3, 0.2, 0.25}}};
    drop(*scene.world, shapes, 60, {.friction_rolling = 0.01, .friction_torsional = 0.01, .restitution = 0.3}, 1);
    return scene;
}

GoldenScene round_shapes() {
    GoldenScene scene = begin();
    const ShapeDefinition shapes[] = {CapsuleShape{0.15, 0.3}, CylinderShape{0.3, 0.2}, ConeShape{0.3, 0.3}};
    drop(*scene.world, shapes, 40, {.restitution = 0.2}, 2);
    return scene;
}

GoldenScene hulls() {
    GoldenScene scene = begin();
    Random random(3);
    std::vector<ShapeDefinition> shapes;
    for (int k = 0; k < 5; ++k) {
        HullShape hull;
        for (int i = 0; i < 8 + 6 * k; ++i) hull.points.push_back(random_point(random, 0.3));
        shapes.emplace_back(hull);
    }
    drop(*scene.world, shapes, 40, {}, 4);
    return scene;
}

GoldenScene compounds() {
    GoldenScene scene = begin();
    const CompoundShape dumbbell{{{SphereShape{0.2}, {{-0.4, 0, 0}, {}}},
                                  {SphereShape{0.2}, {{0.4, 0, 0}, {}}},
                                  {BoxShape{{0.4, 0.05, 0.05}}, {}}}};
    const CompoundShape angle{{{BoxShape{{0.4, 0.1, 0.1}}, {}}, {BoxShape{{0.1, 0.4, 0.1}}, {{-0.3, 0.5, 0}, {}}}}};
    const ShapeDefinition shapes[] = {dumbbell, angle};
    drop(*scene.world, shapes, 30, {.restitution = 0.4}, 5);
    return scene;
}

GoldenScene terrain() {
    GoldenScene scene{make_world({})};
    Random random(6);
    HeightfieldShape field{17, 17, 1, 1, {}};
    for (int i = 0; i < 17 * 17; ++i) field.heights.push_back(static_cast<float>(random.between(0, 0.6)));
    const auto hills = scene.world->create_shape(field).value();
    EXPECT_TRUE(scene.world->create_body({.kind = BodyKind::static_body, .shape = hills, .position = {-8, -1, -8}}));
    const ShapeDefinition shapes[] = {SphereShape{0.3}, BoxShape{{0.3, 0.2, 0.25}}, CapsuleShape{0.2, 0.3}};
    drop(*scene.world, shapes, 40, {.friction_rolling = 0.02}, 7);
    return scene;
}

GoldenScene column() {
    GoldenScene scene = begin();
    const auto box = scene.world->create_shape(BoxShape{}).value();
    for (int i = 0; i < 12; ++i)
        EXPECT_TRUE(scene.world->create_body({.shape = box, .position = {0.02 * i, 0.6 + 1.1 * i, 0}}));
    return scene;
}

// Large enough for one pass a sweep and for several workers; a ball flies into it.
GoldenScene pyramid() {
    GoldenScene scene = begin();
    const auto box = scene.world->create_shape(BoxShape{}).value();
    const auto ball = scene.world->create_shape(SphereShape{0.5}).value();
    for (int row = 0; row < 20; ++row) {
        for (int i = 0; i < 20 - row; ++i) {
            EXPECT_TRUE(scene.world->create_body({.shape = box, .position = {i - 0.5 * (19 - row), 0.5 + row, 0}}));
        }
    }
    EXPECT_TRUE(scene.world->create_body(
        {.shape = ball, .position = {0.3, 3.5, -8}, .linear_velocity = {0, 0, 20}, .mass = {.mass = 10000}}));
    return scene;
}

GoldenScene bouncing_tumblers() {
    GoldenScene scene = begin();
    const ShapeDefinition shapes[] = {BoxShape{{0.4, 0.1, 0.2}}, SphereShape{0.25}, CylinderShape{0.1, 0.5}};
    drop(*scene.world, shapes, 24, {.friction_static = 0.7, .friction_dynamic = 0.6, .restitution = 0.8}, 8);
    return scene;
}

// Chains with all kinds of joints, limits and a motor, that hit the floor.
GoldenScene mechanisms() {
    GoldenScene scene = begin();
    World& world = *scene.world;
    const auto rod = world.create_shape(CapsuleShape{0.1, 0.3}).value();
    for (int chain = 0; chain < 4; ++chain) {
        BodyHandle last;
        for (int i = 0; i < 5; ++i) {
            const Vec3 place{2.0 * chain, 4.3 - 0.9 * i, 0};
            const auto body = world
                                  .create_body({.shape = rod,
                                                .position = place,
                                                .linear_velocity = {0.3 * i, 0, 0.2 * chain},
                                                .material = {.restitution = 0.2}})
                                  .value();
            JointDefinition joint{.body_a = last, .body_b = body, .frame_b = {{0, 0.45, 0}, {}}};
            joint.frame_a = {i == 0 ? place + Vec3{0, 0.45, 0} : Vec3{0, -0.45, 0}, {}};
            if (chain == 0) joint.joint = BallJoint{};
            if (chain == 1) joint.joint = HingeJoint{.limit = JointLimit{-0.4, 0.5}};
            if (chain == 2) joint.joint = HingeJoint{.motor = JointMotor{2, 50}};
            if (chain == 3) joint.joint = SliderJoint{.limit = JointLimit{-0.2, 0.2}};
            EXPECT_TRUE(world.create_joint(joint));
            last = body;
        }
    }
    return scene;
}

// What users do while it runs: kinematic bodies, fast ones, deletions, teleports, forces.
void meddle(World& world, int step) {
    const std::vector<BodyHandle> bodies = world.bodies();
    Result<void> done;
    if (step == 40) done = world.destroy_body(bodies[5]);
    if (step == 60) done = world.set_pose(bodies[6], {{0, 6, 0}, {}});
    if (step == 80) done = world.apply_impulse(bodies[7], {500, 200, 0}, Vec3{0, 1, 0});
    if (step == 100) done = world.set_force(bodies[8], {0, 3000, 0}, {20, 0, 0});
    if (step == 120) done = world.set_enabled(bodies[9], false);
    if (step == 140) done = world.set_velocity(bodies[10], {40, 0, 0}, {0, 30, 0});
    if (step == 160) {
        BodyDefinition heavier = world.body(bodies[11]).value();
        heavier.mass.mass = 5000;
        done = world.set_body(bodies[11], heavier);
    }
    EXPECT_TRUE(done) << "before step " << step;
}

GoldenScene meddled_heap() {
    GoldenScene scene = begin();
    scene.before_step = meddle;
    const auto plate = scene.world->create_shape(BoxShape{{2, 0.1, 2}}).value();
    EXPECT_TRUE(scene.world->create_body({.kind = BodyKind::kinematic_body,
                                          .shape = plate,
                                          .position = {0, 0.5, 0},
                                          .linear_velocity = {0.2, 0, 0},
                                          .angular_velocity = {0, 0.5, 0}}));
    const auto bullet = scene.world->create_shape(SphereShape{0.05}).value();
    EXPECT_TRUE(scene.world->create_body(
        {.shape = bullet, .position = {-20, 1, 0}, .linear_velocity = {200, 0, 0}, .continuous = true}));
    const ShapeDefinition shapes[] = {BoxShape{{0.3, 0.3, 0.3}}, SphereShape{0.3}};
    drop(*scene.world, shapes, 30, {.friction_rolling = 0.01}, 9);
    return scene;
}

constexpr Golden scenes[] = {
    {"balls_and_boxes", balls_and_boxes},
    {"round_shapes", round_shapes},
    {"hulls", hulls},
    {"compounds", compounds},
    {"terrain", terrain},
    {"column", column},
    {"pyramid", pyramid},
    {"bouncing_tumblers", bouncing_tumblers},
    {"mechanisms", mechanisms},
    {"meddled_heap", meddled_heap},
};

}  // namespace

std::span<const Golden> golden_scenes() { return scenes; }

}  // namespace embody::physics
