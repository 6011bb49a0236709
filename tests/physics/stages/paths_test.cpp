// SPDX-License-Identifier: MIT
// The paths of bodies within a step, as the impact stage asks for them, and what the touch and report stages list.
#include "physics/stages/impact/body_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "foundation/random.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/stages/stages.h"
#include "physics/stages/touch/pair_watch.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/event_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/rigid_state.h"
#include "physics/state/touch_memory.h"
#include "physics/state/world_state.h"
#include "physics/step/report.h"
#include "physics/step/step.h"

namespace embody::physics::stages {
namespace {

using namespace state;

ShapeHandle add_shape(WorldState& world, const ShapeDefinition& definition) {
    return world.rigid.shapes.insert({CollisionShape::create(definition).value(), 0});
}
std::uint32_t add_body(WorldState& world, const BodyDefinition& definition) {
    auto setup = set_up_body(world.rigid, definition);
    EXPECT_TRUE(setup.ok());
    const BodyHandle body = world.rigid.bodies.insert({});
    place_body(WakeAccess(world), world.impacts, body.index, std::move(setup).value());
    return body.index;
}

// A brick that falls and spins about all axes.
struct FallingBrick {
    FallingBrick() {
        body = add_body(world, {.shape = add_shape(world, BoxShape{{0.1, 0.2, 0.4}}),
                                .position = {1, 2, 3},
                                .linear_velocity = {1, 5, 0},
                                .angular_velocity = {3, 4, 5}});
        wake_bodies(WakeAccess(world));
    }
    WorldState world;
    std::uint32_t body = 0;
};

TEST(BodyPaths, OfWhatFliesFreelyAreParabolas) {
    FallingBrick brick;
    BodyPaths paths{ImpactAccess(brick.world)};
    const Vec3 g = brick.world.settings.gravity;
    EXPECT_LT(length(paths.free_acceleration(brick.body) - g), 1e-12);
    const BodyState start = brick.world.rigid.motion[brick.body];
    const double step = brick.world.settings.time_step;
    for (const double fraction : {0.0, 0.1, 0.37, 0.5, 0.99, 1.0}) {
        const double t = fraction * step;
        const BodyState there = paths.state_at(brick.body, t);
        EXPECT_LT(length(there.center - (start.center + start.linear_velocity * t + g * (t * t / 2))), 1e-9);
        EXPECT_LT(length(there.linear_velocity - (start.linear_velocity + g * t)), 1e-9);
        EXPECT_NEAR(dot(there.rotation, there.rotation), 1, 1e-9);
        // Remembered or kept, it is the same.
        EXPECT_EQ(paths.kept_state_at(brick.body, t).center, there.center);
        EXPECT_LT(length(paths.pose_at(brick.body, t).position - there.center), 1e-9);
        EXPECT_LT(length(paths.motion_about(brick.body, t).velocity - there.linear_velocity), 0.2);
    }
    const BodyState before = paths.state_at(brick.body, 0.8 * step);
    const std::uint32_t list[] = {brick.body};
    paths.remember(list);
    EXPECT_LT(length(paths.state_at(brick.body, 0.8 * step).center - before.center), 1e-12);
}

TEST(BodyPaths, LeadThroughAStateAtItsTime) {
    FallingBrick brick;
    BodyPaths paths{ImpactAccess(brick.world)};
    const double time = 0.6 * brick.world.settings.time_step;
    BodyState hit = paths.state_at(brick.body, time);
    hit.linear_velocity += Vec3{2, -1, 0.5};
    hit.angular_velocity += Vec3{-1, 2, 1};
    paths.lead_through(brick.body, hit, time);
    const BodyState there = paths.state_at(brick.body, time);
    EXPECT_LT(length(there.center - hit.center), 1e-6);
    EXPECT_LT(length(there.linear_velocity - hit.linear_velocity), 1e-6);
    EXPECT_LT(length(there.angular_velocity - hit.angular_velocity), 1e-3);
    EXPECT_NEAR(std::fabs(dot(there.rotation, hit.rotation)), 1, 1e-6);

    BodyState anew = hit;
    anew.center = {7, 8, 9};
    paths.begin_anew(brick.body, anew);
    EXPECT_EQ(paths.state_at(brick.body, 0).center, anew.center);
}

TEST(BodyPaths, WhatIsHeldChangesItsVelocityFromTheStart) {
    FallingBrick brick;
    BodyPaths paths{ImpactAccess(brick.world)};
    const double time = 0.5 * brick.world.settings.time_step;
    const BodyState before = brick.world.rigid.motion[brick.body], there = paths.state_at(brick.body, time);
    paths.change_velocities(brick.body, {3, 0, 0}, {}, time);
    const BodyState& after = brick.world.rigid.motion[brick.body];
    EXPECT_LT(length(after.linear_velocity - before.linear_velocity - Vec3{3, 0, 0}), 1e-12);
    EXPECT_LT(length(paths.state_at(brick.body, time).center - there.center), 1e-6);
}

TEST(ForEachAwake, TellsEachAwakeBodyOnce) {
    for (const int workers : {1, 3}) {
        WorldState world;
        world.workers = std::make_unique<TaskPool>(workers);
        for (const std::uint32_t count : {0u, 1u, 499u, 500u, 2000u}) {
            world.activity.awake.clear();
            for (std::uint32_t i = 0; i < count; ++i) world.activity.awake.push_back(3 * i);
            std::vector<std::atomic<int>> told(3 * count + 1);
            for_each_awake(PairsAccess(world), [&](std::uint32_t body) { ++told[body]; });
            for (std::uint32_t i = 0; i < 3 * count; ++i) EXPECT_EQ(told[i], i % 3 == 0 ? 1 : 0);
        }
    }
}

// Pairs that are apart are left alone only as long as nothing can come of them: contacts are those of all pairs.
TEST(PairWatches, MissNoContact) {
    Random random(1);
    WorldState world;
    world.settings.sleeping = false;
    add_body(world, {.kind = BodyKind::static_body, .shape = add_shape(world, PlaneShape{})});
    const ShapeHandle shape = add_shape(world, BoxShape{{0.2, 0.2, 0.2}});
    for (int i = 0; i < 40; ++i) {
        add_body(world, {.shape = shape,
                         .position = {random.between(-1, 1), random.between(0.5, 4), random.between(-1, 1)},
                         .linear_velocity = {random.between(-2, 2), 0, random.between(-2, 2)}});
    }
    for (int i = 0; i < 60; ++i) {
        // As a step does up to the contacts; then what is apart is looked at again, all of it.
        wake_bodies(WakeAccess(world));
        find_pairs(PairsAccess(world));
        find_contacts(TouchAccess(world));
        const TouchMemory& memory = world.contacts.touch;
        EXPECT_EQ(memory.watches.size(), world.contacts.pairs->size());
        std::size_t live = 0;
        for_each_live_pair(TouchAccess(world), [&](const PairWatch&, std::uint32_t place) {
            EXPECT_LT(place, memory.watches.size());
            ++live;
        });
        EXPECT_EQ(live, memory.watches.size());
        std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
        for (const Contact& contact : world.contacts.list) touching.emplace_back(contact.a, contact.b);
        for (const BroadPhase::Pair& pair : *world.contacts.pairs) {
            std::vector<collision::Manifold> manifolds;
            collide(*world.rigid.record(pair.a).shape, world.rigid.pose(pair.a), *world.rigid.record(pair.b).shape,
                    world.rigid.pose(pair.b), 0, manifolds);
            const bool overlaps = std::ranges::any_of(manifolds, [](const collision::Manifold& manifold) {
                return manifold.count > 0 && manifold.points[0].separation < -1e-4;
            });
            EXPECT_TRUE(!overlaps || std::ranges::count(touching, std::pair(pair.a, pair.b)) > 0)
                << pair.a << " and " << pair.b << " in step " << i;
        }
        step::step(world);
    }
}

TEST(StepReport, TellsBeginAndEndOfTouchingOnce) {
    WorldState world;
    add_body(world, {.kind = BodyKind::static_body, .shape = add_shape(world, PlaneShape{})});
    const std::uint32_t ball = add_body(world, {.shape = add_shape(world, SphereShape{0.1}),
                                                .position = {0, 0.3, 0},
                                                .material = {.restitution = 0.9},
                                                .user_data = 5});
    int begins = 0, ends = 0;
    for (int i = 0; i < 60; ++i) {
        step::step(world);
        for (const ContactEvent& event : world.events.contacts) {
            EXPECT_EQ(event.b.index, ball);
            EXPECT_EQ(event.user_data_b, 5u);
            (event.kind == ContactEvent::Kind::begin ? begins : ends) += 1;
            EXPECT_GE(begins, ends);
            EXPECT_LE(begins, ends + 1);
        }
    }
    EXPECT_GE(begins, 2);
    // A report written again tells of no change.
    world.report.contacts = 0;
    step::write_report(ReportAccess(world));
    EXPECT_TRUE(world.events.contacts.empty());
}

}  // namespace
}  // namespace embody::physics::stages
