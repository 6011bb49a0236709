// SPDX-License-Identifier: MIT
// The invariants of a world's state: they hold after every step of random worlds, and each one that is broken is named.
#include "physics/state/validate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "foundation/random.h"
#include "physics/stages/access.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/event_state.h"
#include "physics/state/fluid_record.h"
#include "physics/state/fluid_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/world_state.h"
#include "physics/step/step.h"

namespace embody::physics::state {
namespace {

using namespace stages;
using step::step;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// As World does between steps, but with the state at hand.
ShapeHandle add_shape(WorldState& world, const ShapeDefinition& definition) {
    return world.rigid.shapes.insert({CollisionShape::create(definition).value(), 0});
}

BodyHandle add_body(WorldState& world, const BodyDefinition& definition) {
    auto setup = set_up_body(world.rigid, definition);
    EXPECT_TRUE(setup.ok());
    const BodyHandle body = world.rigid.bodies.insert({});
    place_body(WakeAccess(world), world.impacts, body.index, std::move(setup).value());
    return body;
}

void remove_body(WorldState& world, std::uint32_t body) {
    lift_bodies(WakeAccess(world), {&body, 1});
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        const Joint& joint = world.joints.records.at(slot).constraint;
        const bool holds = joint.b == body || (!joint.a_is_world && joint.a == body);
        if (holds) world.joints.records.remove(world.joints.records.handle_at(slot));
    }
    list_jointed_pairs(world.joints);
    world.rigid.motion[body] = {};
    world.rigid.bodies.remove(world.rigid.bodies.handle_at(body));
}

void add_joint(WorldState& world, const JointDefinition& definition) {
    auto joint = set_up_joint(world.rigid, definition);
    ASSERT_TRUE(joint.ok());
    world.joints.records.insert({definition, std::move(joint).value()});
    add_jointed_pair(world.joints, definition);
    wake_touching(WakeAccess(world), definition.body_b.index);
    if (!definition.body_a.is_null()) wake_later(world.activity, definition.body_a.index);
}

std::string broken(const WorldState& world) {
    const auto result = validate(world);
    return result ? std::string() : result.error().message();
}

/// Two stacks of cubes that sleep, two cubes that fall, a pendulum, a rope, a sheet and water; a floor below.
struct SmallWorld {
    SmallWorld() {
        cube = add_shape(state, BoxShape{{0.5, 0.5, 0.5}});
        const ShapeHandle plane = add_shape(state, PlaneShape{});
        add_body(state, {.kind = BodyKind::static_body, .shape = plane});
        for (int i = 0; i < 4; ++i) add_body(state, {.shape = cube, .position = {(i / 2) * 4.0, 0.5 + i % 2, 0}});
        for (int i = 0; i < 120; ++i) step(state);
        EXPECT_EQ(state.activity.sleepers.size(), 2u);
        for (int i = 0; i < 2; ++i) {
            add_body(state, {.shape = cube, .position = {8.0, 0.5 + i * 0.999, 0}, .allow_sleep = false});
        }
        const BodyHandle swing = add_body(state, {.shape = cube, .position = {12, 4, 0}, .allow_sleep = false});
        add_joint(state,
                  {.joint = BallJoint{}, .body_b = swing, .frame_a = {{12, 6, 0}, {}}, .frame_b = {{0, 2, 0}, {}}});
        FluidDefinition water{.boxes = {{{20, 0, 0}, {20.2, 0.2, 0.2}}}, .cell_size = 0.05};
        state.fluids.records.insert(set_up_fluid(ObstacleAccess(state), water).value());
        state.deformables.records.insert(make_deformable_record(make_rope()).value());
        for (int i = 0; i < 3; ++i) step(state);
    }
    static DeformableDefinition make_rope() {
        DeformableDefinition rope;
        for (int i = 0; i < 6; ++i) rope.nodes.push_back({30, 2, 0.1 * i});
        rope.matter = Rope{};
        return rope;
    }
    WorldState state;
    ShapeHandle cube;
};

TEST(ValidateWorld, AnEmptyWorldIsInOrder) {
    WorldState world;
    EXPECT_EQ(broken(world), "");
    step(world);
    EXPECT_EQ(broken(world), "");
}

TEST(ValidateWorld, NamesEachInvariantThatIsBroken) {
    struct Damage {
        const char* named;
        std::function<void(WorldState&)> make;
    };
    // Slots: 0 the floor, 1 to 4 asleep, 5 and 6 awake with a contact, 7 the pendulum.
    const Damage damages[] = {
        {"bodies[5].center", [](WorldState& w) { w.rigid.motion[5].center.y = nan; }},
        {"bodies[5].rotation", [](WorldState& w) { w.rigid.motion[5].rotation.w *= 1.001; }},
        {"bodies[0].rotation", [](WorldState& w) { w.rigid.motion[0].rotation.w = nan; }},
        {"bodies[6].linear_velocity", [](WorldState& w) { w.rigid.motion[6].linear_velocity.x = nan; }},
        {"bodies[6].angular_velocity", [](WorldState& w) { w.rigid.motion[6].angular_velocity.x = nan; }},
        {"bodies[5].inverse_mass", [](WorldState& w) { w.rigid.motion[5].inverse_mass = -1; }},
        {"bodies[0].inverse_mass", [](WorldState& w) { w.rigid.motion[0].inverse_mass = 1; }},
        {"bodies[5].inverse_inertia", [](WorldState& w) { w.rigid.motion[5].inverse_inertia.x.x = nan; }},
        {"bodies[5].mass", [](WorldState& w) { w.rigid.constants[5].mass = nan; }},
        {"bodies[5].shape", [](WorldState& w) { w.rigid.record(5).shape = w.rigid.record(0).shape; }},
        {"bodies[3].shape", [](WorldState& w) { w.contacts.broad_phase.remove(3); }},
        {"bodies[3].shape", [](WorldState& w) { w.rigid.motion[3].center.x += 3; }},
        {"bodies: have", [](WorldState& w) { w.activity.sleep.pop_back(); }},
        {"awake", [](WorldState& w) { std::ranges::reverse(w.activity.awake); }},
        {"awake", [](WorldState& w) { w.activity.awake.push_back(w.activity.awake.back()); }},
        {"bodies[7]: is awake", [](WorldState& w) { std::erase(w.activity.awake, 7u); }},
        {"bodies[2]: sleeps", [](WorldState& w) { w.activity.awake.insert(w.activity.awake.begin(), 2u); }},
        {"bodies[0]: is listed", [](WorldState& w) { w.activity.awake.insert(w.activity.awake.begin(), 0u); }},
        {"contacts[0]", [](WorldState& w) { std::swap(w.contacts.list[0].a, w.contacts.list[0].b); }},
        {"contacts[0]", [](WorldState& w) { w.contacts.list[0].b = 77; }},
        {"contacts[0]", [](WorldState& w) { w.contacts.list[0].count = 0; }},
        {"contacts[0].normal",
         [](WorldState& w) {
             w.contacts.list[0].normal = {0, 2, 0};
         }},
        {"contacts[0].points", [](WorldState& w) { w.contacts.list[0].points[0].impulse = -1; }},
        {"contacts[0].points",
         [](WorldState& w) { w.contacts.list[0].points[0].separation = std::numeric_limits<float>::infinity(); }},
        {"contacts[1]", [](WorldState& w) { w.contacts.list[1] = w.contacts.list[0]; }},
        {"contacts: have", [](WorldState& w) { w.contacts.summaries.pop_back(); }},
        {"contacts[0]", [](WorldState& w) { w.contacts.summaries[0].b = 6; }},
        {"sleepers[1].bodies: 1", [](WorldState& w) { w.activity.sleep[1].group = 2; }},
        {"sleepers[2].bodies: 1", [](WorldState& w) { w.activity.sleepers[2].bodies.push_back(1); }},
        {"sleepers[1]", [](WorldState& w) { w.activity.sleepers[1].bodies.clear(); }},
        {"bodies[1]: sleeps", [](WorldState& w) { std::erase(w.activity.sleepers[1].bodies, 1u); }},
        {"sleepers[99]", [](WorldState& w) { w.activity.sleepers[99].bodies.push_back(1); }},
        {"sleepers[1].contacts[0]", [](WorldState& w) { w.activity.sleepers[1].contacts[0].b = 88; }},
        {"islands", [](WorldState& w) { w.islands.bodies[1] = w.islands.bodies[0]; }},
        {"islands[0]", [](WorldState& w) { w.islands.list[0].body_count = 0; }},
        {"islands[1]", [](WorldState& w) { w.islands.list[1].body_count = 9; }},
        {"joints[0]", [](WorldState& w) { w.joints.records.at(0).definition.body_b.generation = 9; }},
        {"joints[0]", [](WorldState& w) { w.joints.records.at(0).constraint.b = 2; }},
        {"joints[0]", [](WorldState& w) { w.joints.records.at(0).constraint.total_linear.z = nan; }},
        {"joints", [](WorldState& w) { w.joints.active_slots.push_back(0); }},
        {"deformables[0].nodes[2]",
         [](WorldState& w) {
             DeformableRecord& rope = w.deformables.records.at(0);
             std::vector<Vec3> places = rope.nodes().position;
             places[2].y = nan;
             const std::vector<Vec3> velocities(places.size());
             rope.set_motion(places, velocities, {});
         }},
        {"fluids[0].particles[3]",
         [](WorldState& w) { w.fluids.records.at(0).positions[3].x = std::numeric_limits<float>::quiet_NaN(); }},
        {"fluids[0]", [](WorldState& w) { w.fluids.records.at(0).velocities.pop_back(); }},
        {"fluids[0]", [](WorldState& w) { w.fluids.records.at(0).ids[1] = w.fluids.records.at(0).ids[0]; }},
        {"touching[0]", [](WorldState& w) { w.events.touching[0].b.generation = 9; }},
        {"touching[2]", [](WorldState& w) { w.events.touching.push_back(w.events.touching[0]); }},
    };
    for (const Damage& damage : damages) {
        SmallWorld small;
        ASSERT_EQ(broken(small.state), "");
        ASSERT_GE(small.state.contacts.list.size(), 2u);
        ASSERT_GE(small.state.islands.list.size(), 2u);
        damage.make(small.state);
        EXPECT_EQ(broken(small.state).substr(0, std::string(damage.named).size()), damage.named) << broken(small.state);
    }
}

// A body that left the finite numbers is switched off; its joints keep nothing of it, and hold again once it is back.
TEST(ValidateWorld, HoldsWithJointsOfABodyThatWasFrozen) {
    for (const bool with_contact : {false, true}) {
        SCOPED_TRACE(with_contact);
        WorldState world;
        const ShapeHandle cube = add_shape(world, BoxShape{{0.5, 0.5, 0.5}});
        if (with_contact) add_body(world, {.kind = BodyKind::static_body, .shape = add_shape(world, PlaneShape{})});
        std::vector<BodyHandle> chain;
        for (int i = 0; i < 3; ++i) {
            chain.push_back(add_body(world, {.shape = cube, .position = {1.5 * i, 0.5, 0}, .allow_sleep = false}));
            JointDefinition joint{.joint = BallJoint{}, .body_b = chain.back(), .frame_b = {{-0.75, 0, 0}, {}}};
            if (i > 0) joint.body_a = chain[static_cast<std::size_t>(i) - 1];
            joint.frame_a = i > 0 ? Transform{{0.75, 0, 0}, {}} : Transform{{-0.75, 0.5, 0}, {}};
            add_joint(world, joint);
        }
        for (int i = 0; i < 3; ++i) step(world);
        world.rigid.motion[chain[1].index].angular_velocity.x = nan;
        step(world);
        EXPECT_NE(world.report.limits & static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen), 0u);
        EXPECT_EQ(broken(world), "");
        for (std::uint32_t slot = 0; slot < 3; ++slot) {
            const Joint& joint = world.joints.records.at(slot).constraint;
            EXPECT_TRUE(embody::is_finite(joint.total_linear) && embody::is_finite(joint.total_angular)) << slot;
            for (const JointImpulses& phase : {joint.position_phase, joint.velocity_phase}) {
                for (const double impulse : phase.rows) EXPECT_TRUE(std::isfinite(impulse)) << slot;
            }
        }
        for (const BodyHandle body : chain) {
            BodyDefinition back = world.rigid.record(body.index).definition;
            const Transform pose = world.rigid.pose(body.index);
            back.position = pose.position;
            back.rotation = pose.rotation;
            back.enabled = true;
            lift_bodies(WakeAccess(world), {&body.index, 1});
            place_body(WakeAccess(world), world.impacts, body.index, set_up_body(world.rigid, back).value());
        }
        for (int i = 0; i < 3; ++i) {
            step(world);
            EXPECT_EQ(world.report.limits & static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen), 0u);
            EXPECT_EQ(broken(world), "");
        }
    }
}

// Bodies of all shapes and kinds that come, go, are pushed, jointed, put elsewhere and fall asleep.
TEST(ValidateWorld, HoldsAfterEachStepOfRandomWorlds) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        WorldState world;
        world.settings.time_to_sleep = 0.2;
        add_body(world, {.kind = BodyKind::static_body, .shape = add_shape(world, PlaneShape{})});
        const ShapeHandle shapes[] = {
            add_shape(world, BoxShape{{0.3, 0.2, 0.4}}),
            add_shape(world, SphereShape{0.3}),
            add_shape(world, CapsuleShape{0.15, 0.3}),
            add_shape(world, CylinderShape{0.3, 0.2}),
            add_shape(world, ConeShape{0.3, 0.3}),
            add_shape(world, CompoundShape{{{SphereShape{0.2}, {{-0.2, 0, 0}, {}}},
                                            {BoxShape{{0.2, 0.2, 0.2}}, {{0.2, 0, 0}, {}}}}})};
        const auto any = [&](double reach) {
            return Vec3{random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
        };
        std::vector<BodyHandle> bodies;
        const auto remove = [&](std::size_t i) {
            remove_body(world, bodies[i].index);
            bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
        };
        for (int i = 0; i < 200; ++i) {
            const std::uint64_t choice = random.below(20);
            if (bodies.size() < 4 || (choice < 6 && bodies.size() < 30)) {
                BodyDefinition definition{.shape = shapes[random.below(6)], .position = any(2) + Vec3{0, 2.5, 0}};
                definition.rotation = normalized(Quat{any(1).x, any(1).y, any(1).z, 1});
                definition.linear_velocity = any(random.unit() < 0.1 ? 50 : 2);
                definition.start_asleep = random.unit() < 0.2;
                if (random.unit() < 0.1) definition.kind = BodyKind::kinematic_body;
                if (random.unit() < 0.1) definition.enabled = false;
                bodies.push_back(add_body(world, definition));
            } else if (choice == 6) {
                remove(random.below(bodies.size()));
            } else if (choice == 7) {
                const std::uint32_t body = bodies[random.below(bodies.size())].index;
                if (world.rigid.record(body).definition.enabled) wake_group_of(WakeAccess(world), body);
                if (!world.activity.is_asleep(body)) world.rigid.motion[body].linear_velocity += any(3);
            } else if (choice == 8) {
                const std::size_t a = random.below(bodies.size()), b = random.below(bodies.size());
                const JointDefinition joint{
                    .joint = BallJoint{}, .body_a = bodies[a], .body_b = bodies[b], .frame_a = {any(0.5), {}}};
                if (a != b) add_joint(world, joint);
            }
            step(world);
            ASSERT_EQ(broken(world), "") << "seed " << seed << ", step " << i;
        }
        // Left alone, they come to rest.
        for (int i = 0; i < 200; ++i) step(world);
        ASSERT_EQ(broken(world), "") << "seed " << seed;
        while (!bodies.empty()) remove(bodies.size() - 1);
        step(world);
        EXPECT_EQ(broken(world), "");
        EXPECT_EQ(world.rigid.bodies.count(), 1u);
    }
}

}  // namespace
}  // namespace embody::physics::state
