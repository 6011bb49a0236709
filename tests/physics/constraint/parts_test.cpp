// SPDX-License-Identifier: MIT
// Parts of the constraints by themselves: contacts and joints solved by passes, rolling balls and bodies, spins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/constraint/contact/contact.h"
#include "physics/constraint/contact/contact_work.h"
#include "physics/constraint/impact/impact_joints.h"
#include "physics/constraint/joint/joint.h"
#include "physics/constraint/joint/joint_system.h"
#include "physics/constraint/joint/own_spin.h"
#include "physics/constraint/rolling/rolling_ball.h"
#include "physics/constraint/rolling/rolling_body.h"
#include "physics/constraint/sweeps/contact_solver.h"
#include "physics/constraint/sweeps/substep_solver.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {
namespace {

constexpr double pi = 3.14159265358979323846;

Vec3 any_vector(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
Quat any_rotation(Random& random) {
    return normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

struct Bodies {
    std::vector<BodyState> state;
    std::vector<BodyConstants> constants;

    std::uint32_t add(double mass, Vec3 moments, Vec3 center, Quat rotation = {}) {
        BodyState s;
        BodyConstants c;
        s.center = s.start_center = center;
        s.rotation = s.start_rotation = rotation;
        s.inverse_mass = mass > 0 ? 1 / mass : 0;
        c.mass = mass;
        if (mass > 0) {
            c.inertia = Mat3{{moments.x, 0, 0}, {0, moments.y, 0}, {0, 0, moments.z}};
            c.inverse_inertia = inverse_or_zero(c.inertia);
            const Mat3 r = to_matrix(rotation);
            s.inverse_inertia = r * c.inverse_inertia * transpose(r);
        }
        c.is_isotropic = moments.x == moments.y && moments.y == moments.z;
        state.push_back(s);
        constants.push_back(c);
        return static_cast<std::uint32_t>(state.size() - 1);
    }
    Vec3 momentum() const {
        Vec3 sum;
        for (std::size_t i = 0; i < state.size(); ++i) sum += state[i].linear_velocity * constants[i].mass;
        return sum;
    }
    Vec3 angular_momentum() const {
        Vec3 sum;
        for (std::size_t i = 0; i < state.size(); ++i) {
            const Mat3 r = to_matrix(state[i].rotation);
            sum += cross(state[i].center, state[i].linear_velocity * constants[i].mass) +
                   r * (constants[i].inertia * (transpose(r) * state[i].angular_velocity));
        }
        return sum;
    }
    double energy() const {
        double sum = 0;
        for (std::size_t i = 0; i < state.size(); ++i) {
            const Mat3 r = to_matrix(state[i].rotation);
            const Vec3 spin = transpose(r) * state[i].angular_velocity;
            sum += constants[i].mass / 2 * length_squared(state[i].linear_velocity) +
                   dot(spin, constants[i].inertia * spin) / 2;
        }
        return sum;
    }
};

TEST(BodyStates, ImpulsesChangeMomentaByWhatTheyAre) {
    Random random(1);
    for (int trial = 0; trial < 50; ++trial) {
        Bodies bodies;
        bodies.add(3, {0.2, 0.3, 0.4}, any_vector(random, 2), any_rotation(random));
        BodyState& body = bodies.state[0];
        body.linear_velocity = any_vector(random, 3);
        body.angular_velocity = any_vector(random, 3);
        const Vec3 linear = bodies.momentum(), angular = bodies.angular_momentum();
        const Vec3 impulse = any_vector(random, 2), arm = any_vector(random, 1), turn = any_vector(random, 1);
        apply_impulse(body, impulse, arm);
        apply_angular_impulse(body, turn);
        EXPECT_LT(length(bodies.momentum() - linear - impulse), 1e-12);
        EXPECT_LT(length(bodies.angular_momentum() - angular - cross(body.center + arm, impulse) - turn), 1e-12);
        EXPECT_LT(length(velocity_at(body, arm) - body.linear_velocity - cross(body.angular_velocity, arm)), 1e-12);
        const Transform pose = body_pose(body, {0.1, 0.2, 0.3});
        EXPECT_LT(length(transform_point(pose, {0.1, 0.2, 0.3}) - body.center), 1e-12);
    }
}

// Two bodies that touch at up to four points: passes keep momenta, end the approach, push only and take energy.
TEST(ContactSolver, PassesEndTheApproachAndKeepMomenta) {
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        Bodies bodies;
        bodies.add(random.between(1, 5), {0.2, 0.3, 0.4}, {0, 0, 0}, any_rotation(random));
        bodies.add(random.between(1, 5), {0.3, 0.3, 0.2}, {0, 1, 0}, any_rotation(random));
        bodies.state[0].linear_velocity = any_vector(random, 0.3) + Vec3{0, 1, 0};
        bodies.state[1].linear_velocity = any_vector(random, 0.3) - Vec3{0, 1, 0};
        collision::Manifold manifold;
        manifold.normal = {0, 1, 0};
        manifold.count = 4;
        for (int i = 0; i < 4; ++i) {
            manifold.points[static_cast<std::size_t>(i)] = {
                .position = {i & 1 ? 0.3 : -0.3, 0.5, i & 2 ? 0.3 : -0.3}, .separation = 0, .feature = 1u + i};
        }
        Contact contact = make_contact(0, 1, manifold, bodies.state);
        Material material;
        material.friction_static = material.friction_dynamic = 0.4;
        set_material(contact, material);
        EXPECT_EQ(contact.count, 4);
        EXPECT_EQ(contact_key(contact)[1], 1u);
        EXPECT_EQ(summary_of(contact, 0.05F).count, 4);
        for (int i = 0; i < 4; ++i) {
            const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            EXPECT_LT(length(position_of(contact, point, bodies.state) -
                             manifold.points[static_cast<std::size_t>(i)].position),
                      1e-6);
            EXPECT_NEAR(current_separation(contact, point, bodies.state), 0, 1e-6);
        }
        const Mat3 response = inverse_mass_at(bodies.state[0], {0, 0.5, 0}, bodies.state[1], {0, -0.5, 0});
        EXPECT_GT(dot(response * Vec3{0, 1, 0}, {0, 1, 0}),
                  bodies.state[0].inverse_mass + bodies.state[1].inverse_mass - 1e-9);
        const PreparedContact prepared = prepare_contact(contact, bodies.state);
        const ContactSoftness rigid{.substep = 1.0 / 240};
        const Vec3 linear = bodies.momentum(), angular = bodies.angular_momentum();
        const double energy = bodies.energy();
        for (int pass = 0; pass < 200; ++pass) {
            solve_contact(contact, prepared, SolvePhase::velocity, 1.0 / 240, rigid, bodies.state);
        }
        EXPECT_LT(length(bodies.momentum() - linear), 1e-5);
        EXPECT_LT(length(bodies.angular_momentum() - angular), 1e-5);
        EXPECT_LT(bodies.energy(), energy);
        double pressed = 0;
        for (int i = 0; i < 4; ++i) {
            const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            EXPECT_GT(dot(relative_velocity(contact, point, bodies.state), contact.normal), -1e-3);
            EXPECT_GE(point.impulse, 0);
            pressed += static_cast<double>(point.impulse);
        }
        EXPECT_GT(pressed, 0);
        EXPECT_NEAR(load_of(contact), pressed, 1e-5 * pressed);
        EXPECT_TRUE(is_pressed(contact));
        EXPECT_LE(std::hypot(contact.friction.along_1, contact.friction.along_2), 0.4 * pressed * (1 + 1e-4));
    }
}

TEST(ContactSolver, LongListsAreSolvedInFinerStepsAndShortOnesInMorePasses) {
    const ContactPlan few = contact_plan(4, 4, {}), many = contact_plan(5000, 4, {});
    EXPECT_LT(few.substeps, many.substeps);
    EXPECT_GT(few.passes, many.passes);
    EXPECT_EQ(jointed_contact_plan(4, 4, {}).substeps, 4);
    const ContactSoftness softness = many.softness(1.0 / 60, {});
    EXPECT_NEAR(softness.substep * many.substeps, 1.0 / 60, 1e-12);
    EXPECT_GT(softness.sag(1, 1), 0);
    EXPECT_EQ(ContactSoftness{}.sag(1, 1), 0);
    Contact contact;
    EXPECT_FALSE(resists_rolling(contact));
}

TEST(ContactWorks, AreTheChangeOfTheKineticEnergy) {
    Random random(3);
    for (int trial = 0; trial < 100; ++trial) {
        Bodies bodies;
        bodies.add(2, {0.2, 0.3, 0.4}, {}, any_rotation(random));
        const VelocityPair free{any_vector(random, 2), any_vector(random, 2)},
            change{any_vector(random, 1), any_vector(random, 1)};
        const auto energy_at = [&](double fraction) {
            bodies.state[0].linear_velocity = free.linear + change.linear * fraction;
            bodies.state[0].angular_velocity = free.angular + change.angular * fraction;
            return bodies.energy();
        };
        const ContactWork work = contact_work(bodies.constants[0], bodies.state[0].rotation, free, change);
        for (const double fraction : {0.3, 1.0}) {
            EXPECT_NEAR(work.linear * fraction + work.quadratic * fraction * fraction,
                        energy_at(fraction) - energy_at(0), 1e-9);
        }
        const double fraction = fraction_without_gain(work);
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        EXPECT_LE(energy_at(fraction), energy_at(0) + 1e-9);
        if (energy_at(1) <= energy_at(0)) {
            EXPECT_EQ(fraction, 1);
        }
    }
}

Joint joint_of(const decltype(Joint::kind)& kind, Transform local_a, Transform local_b) {
    Joint joint;
    joint.kind = kind;
    joint.a = 0;
    joint.b = 1;
    joint.local_a = local_a;
    joint.local_b = local_b;
    return joint;
}

// Passes over one joint bring its rows' speeds to nothing and leave both momenta.
TEST(Joints, PassesHoldTheRowsAndKeepMomenta) {
    Random random(4);
    const decltype(Joint::kind) kinds[] = {FixedJoint{}, BallJoint{}, HingeJoint{}, SliderJoint{}};
    const int rows[] = {6, 3, 5, 5};
    for (int trial = 0; trial < 80; ++trial) {
        const std::size_t k = static_cast<std::size_t>(trial % 4);
        Bodies bodies;
        bodies.add(random.between(1, 5), {0.2, 0.3, 0.4}, {0, 0, 0}, any_rotation(random));
        bodies.add(random.between(1, 5), {0.3, 0.3, 0.2}, any_vector(random, 1), any_rotation(random));
        for (BodyState& body : bodies.state) {
            body.linear_velocity = any_vector(random, 1);
            body.angular_velocity = any_vector(random, 1);
        }
        // Frames that are at one place, turned alike.
        const Vec3 place = any_vector(random, 1);
        const Quat axes = any_rotation(random);
        const auto frame_in = [&](const BodyState& body) {
            return Transform{rotate_inverse(body.rotation, place - body.center), conjugate(body.rotation) * axes};
        };
        Joint joint = joint_of(kinds[k], frame_in(bodies.state[0]), frame_in(bodies.state[1]));
        EXPECT_NEAR(joint_coordinate(joint, bodies.state), 0, 1e-9);
        EXPECT_FALSE(has_motor(joint));
        EXPECT_FALSE(has_limit(joint));
        prepare_joint(joint, bodies.state);
        EXPECT_EQ(joint.row_count, rows[k]);
        for (int row = 0; row < joint.row_count; ++row)
            EXPECT_NEAR(joint.errors[static_cast<std::size_t>(row)], 0, 1e-9);
        const Vec3 linear = bodies.momentum(), angular = bodies.angular_momentum();
        const double energy = bodies.energy();
        factor_joint(joint, bodies.state);
        double left = 1;
        for (int pass = 0; pass < 20; ++pass) {
            left = solve_joint(joint, {SolvePhase::velocity, 1.0 / 240, {}}, bodies.state);
        }
        EXPECT_LT(left, 1e-9);
        for (int row = 0; row < joint.row_count; ++row) {
            EXPECT_NEAR(row_speed(joint, joint.rows[static_cast<std::size_t>(row)], bodies.state), 0, 1e-9);
        }
        EXPECT_LT(length(bodies.momentum() - linear), 1e-9);
        EXPECT_LT(length(bodies.angular_momentum() - angular), 1e-9);
        EXPECT_LE(bodies.energy(), energy + 1e-9);
        EXPECT_GT(length(bodies.state[0].linear_velocity), 0);
    }
}

// A pendulum on a joint of the world, by the direct solver: its energy and length stay.
TEST(JointSystem, SwingsWithoutLoss) {
    Bodies bodies;
    const std::uint32_t bob = bodies.add(2, {0.1, 0.1, 0.1}, {1, 0, 0});
    bodies.constants[bob].acceleration = {0, -9.81, 0};
    std::vector<Joint> joints{joint_of(BallJoint{}, {}, {{-1, 0, 0}, {}})};
    joints[0].a_is_world = true;
    joints[0].b = bob;
    const std::uint32_t list[] = {bob}, numbers[] = {0};
    const JointedList jointed{list, numbers};
    EXPECT_TRUE(JointSystem::fits(jointed));
    const JointSettings settings;
    JointSystem system;
    const JointSystem::View view{bodies.state, bodies.constants, joints, settings};
    system.set(jointed, view);
    EXPECT_NEAR(system.mass(view), 2, 1e-12);
    double fastest = 0;
    for (int i = 0; i < 240; ++i) {
        system.advance(1.0 / 240, view);
        const BodyState& state = bodies.state[bob];
        const Vec3 held = state.center + rotate(state.rotation, {-1, 0, 0});
        EXPECT_LT(length(held), 1e-6);
        const double energy = bodies.energy() + 2 * 9.81 * state.center.y;
        EXPECT_NEAR(energy, 0, 0.02);
        EXPECT_NEAR(system.kinetic_energy(view), bodies.energy(), 0.02);
        fastest = std::max(fastest, length(state.linear_velocity));
    }
    // At the bottom, with the moment of inertia of the bob: v² = 2 g r m r² / (m r² + I).
    EXPECT_NEAR(fastest, std::sqrt(2 * 9.81 * 2 / 2.1), 0.05);
}

// A movable body that the list lacks (it sleeps) is held on to like an immovable one, whatever its slot.
TEST(JointSystem, TakesABodyThatItsListLacksAsImmovable) {
    for (const bool lacks_first : {true, false}) {
        SCOPED_TRACE(lacks_first ? "the first slot" : "the last slot");
        Bodies bodies;
        std::uint32_t asleep = 0;
        if (lacks_first) asleep = bodies.add(3, {0.2, 0.2, 0.2}, {0, 0, 0});
        const std::uint32_t bob = bodies.add(2, {0.1, 0.1, 0.1}, {1, 0, 0});
        if (!lacks_first) asleep = bodies.add(3, {0.2, 0.2, 0.2}, {0, 0, 0});
        bodies.constants[bob].acceleration = {0, -9.81, 0};
        std::vector<Joint> joints{joint_of(BallJoint{}, {}, {{-1, 0, 0}, {}})};
        joints[0].a = asleep;
        joints[0].b = bob;
        const std::uint32_t list[] = {bob}, numbers[] = {0};
        JointSystem system;
        const JointSettings settings;
        const JointSystem::View view{bodies.state, bodies.constants, joints, settings};
        system.set({list, numbers}, view);
        std::vector<std::pair<std::uint32_t, BodyState>> carriers;
        system.list_carriers(view, carriers);
        ASSERT_EQ(carriers.size(), 1u);
        EXPECT_EQ(carriers[0].first, asleep);
        for (int i = 0; i < 240; ++i) {
            system.advance(1.0 / 240, view);
            const BodyState& state = bodies.state[bob];
            EXPECT_LT(length(state.center + rotate(state.rotation, {-1, 0, 0})), 1e-6);
            EXPECT_EQ(bodies.state[asleep].center, Vec3{});
            EXPECT_EQ(bodies.state[asleep].linear_velocity, Vec3{});
        }
    }
}

TEST(ImpactJoints, PassAnImpactOnAndKeepMomentumAndJoint) {
    Random random(5);
    for (int trial = 0; trial < 30; ++trial) {
        Bodies bodies;
        bodies.add(2, {0.2, 0.3, 0.4}, {-0.5, 0, 0}, any_rotation(random));
        bodies.add(3, {0.3, 0.2, 0.2}, {0.5, 0, 0}, any_rotation(random));
        const auto frame_in = [&](const BodyState& body) {
            return Transform{rotate_inverse(body.rotation, -body.center), conjugate(body.rotation)};
        };
        std::vector<Joint> joints{joint_of(BallJoint{}, frame_in(bodies.state[0]), frame_in(bodies.state[1]))};
        for (Joint& joint : joints) prepare_joint(joint, bodies.state);
        const JointSettings settings;
        const JointSystem::View view{bodies.state, bodies.constants, joints, settings};
        ImpactJoints impact;
        const std::uint32_t list[] = {0, 1}, numbers[] = {0};
        impact.set({list, numbers}, view);
        EXPECT_EQ(impact.number_of(1), 1);
        EXPECT_EQ(impact.number_of(7), -1);
        const ImpactJoints::Push push{.body = 0, .impulse = any_vector(random, 1), .arm = any_vector(random, 0.3)};
        const auto changes = impact.respond(std::span(&push, 1));
        ASSERT_EQ(changes.size(), 2u);
        for (std::size_t i = 0; i < 2; ++i) {
            bodies.state[i].linear_velocity = changes[i].linear();
            bodies.state[i].angular_velocity = changes[i].angular();
        }
        EXPECT_LT(length(bodies.momentum() - push.impulse), 1e-9);
        EXPECT_LT(length(bodies.angular_momentum() - cross(bodies.state[0].center + push.arm, push.impulse)), 1e-9);
        // Both move alike at the joint.
        const Vec3 a = velocity_at(bodies.state[0], -bodies.state[0].center),
                   b = velocity_at(bodies.state[1], -bodies.state[1].center);
        EXPECT_LT(length(a - b), 1e-9);
        impact.clear();
        EXPECT_TRUE(impact.bodies().empty());
    }
}

TEST(OwnSpin, IsAboutAnAxisOfSymmetryOnly) {
    BodyConstants top;
    top.inertia = {{0.2, 0, 0}, {0, 0.3, 0}, {0, 0, 0.2}};
    top.inverse_inertia = inverse_or_zero(top.inertia);
    EXPECT_LT(length(symmetry_axis_along({0, 5, 0}, top) - Vec3{0, 1, 0}), 1e-12);
    EXPECT_EQ(symmetry_axis_along({1, 0, 0}, top), Vec3{});
    EXPECT_EQ(symmetry_axis_along({}, top), Vec3{});
    EXPECT_TRUE(is_on_axis({0, -2, 0}, {0, 1, 0}));
    EXPECT_FALSE(is_on_axis({0.1, -2, 0}, {0, 1, 0}));
    BodyState state;
    state.angular_velocity = {0, 7, 0};
    const OwnSpin spin = own_spin_of(state, top, {0, 1, 0}, 0.1);
    EXPECT_NEAR(spin.rate, 7, 1e-12);
    EXPECT_LT(length(spin.momentum - Vec3{0, 2.1, 0}), 1e-12);
    EXPECT_NEAR(std::fabs(dot(spin.turn, from_axis_angle({0, 1, 0}, 0.7))), 1, 1e-9);
    EXPECT_EQ(own_spin_of(state, top, {}, 0.1).rate, 0);
}

TEST(RollingBall, SlidesUntilItRollsByFiveSevenths) {
    constexpr double mu = 0.3, g = 9.81, speed = 2;
    const double until = 2 * speed / (7 * mu * g);
    BallMotion ball{.velocity = {speed, 0, 0}, .radius = 0.1};
    const BallFriction friction{mu, mu, 0, 0};
    EXPECT_LT(length(ball.slip({0, 1, 0}) - Vec3{speed, 0, 0}), 1e-12);
    BallPush push = push_along(ball, {0, 1, 0}, {}, g, friction, until / 2);
    EXPECT_FALSE(push.sticks);
    EXPECT_NEAR(ball.velocity.x, speed - mu * g * until / 2, 1e-9);
    push = push_along(ball, {0, 1, 0}, {}, g, friction, until);
    EXPECT_NEAR(ball.velocity.x, speed * 5 / 7, 1e-9);
    EXPECT_LT(length(ball.slip({0, 1, 0})), 1e-9);
    EXPECT_LE(push.work, 0);
    const double energy = ball.energy();
    EXPECT_NEAR(energy, 0.5 * ball.velocity.x * ball.velocity.x * 1.4, 1e-9);
    // From then on nothing takes any; on a slope it gains 5/7 of what slides.
    push = push_along(ball, {0, 1, 0}, {1, 0, 0}, g, friction, 0.1);
    EXPECT_TRUE(push.sticks);
    EXPECT_NEAR(ball.velocity.x, speed * 5 / 7 + 0.1 * 5 / 7, 1e-9);
}

TEST(RollingBall, TurnsWithTheGroundWithoutWork) {
    Random random(6);
    for (int trial = 0; trial < 50; ++trial) {
        BallMotion ball{.velocity = {1, 0, 0.5}, .radius = 0.1};
        ball.spin = cross(Vec3{0, 1, 0}, ball.velocity) / ball.radius + Vec3{0, random.between(-5, 5), 0};
        const double energy = ball.energy();
        const Vec3 to = normalized(Vec3{random.between(-0.1, 0.1), 1, random.between(-0.1, 0.1)});
        turn_with_normal(ball, {0, 1, 0}, to, true);
        EXPECT_NEAR(ball.energy(), energy, 1e-6 * energy);
        EXPECT_NEAR(dot(ball.velocity, to), 0, 1e-9);
        EXPECT_TRUE(set_energy(ball, to, 2 * energy, true));
        EXPECT_NEAR(ball.energy(), 2 * energy, 1e-6 * energy);
        EXPECT_FALSE(set_energy(ball, to, -1, true));
    }
}

TEST(RollingBall, TwoThatCollideHeadOnKeepMomentumAndExchangeSpeeds) {
    BallMotion a{.velocity = {1, 0, 0}, .radius = 0.1}, b{.radius = 0.1};
    const auto impulse = collide_balls({a, 2, {0, 1, 0}}, {b, 2, {0, 1, 0}}, {{1, 0, 0}, 1, 0});
    ASSERT_TRUE(impulse);
    EXPECT_NEAR(impulse->x, 2, 1e-9);
    EXPECT_NEAR(a.velocity.x, 0, 1e-9);
    EXPECT_NEAR(b.velocity.x, 1, 1e-9);
}

TEST(RollingBody, ACylinderRollsDownASlopeByTwoThirds) {
    constexpr double angle = 0.3, g = 9.81, radius = 0.2, half = 0.3, mass = 3, time = 0.1;
    // Seen along the slope: gravity leans, the ground is level.
    BodyState state;
    state.rotation = from_axis_angle({1, 0, 0}, pi / 2);  // its axis along Z
    state.center = {0, radius, 0};
    state.inverse_mass = 1 / mass;
    BodyConstants constants;
    constants.mass = mass;
    const double about = mass * radius * radius / 2, across = mass * (3 * radius * radius + 4 * half * half) / 12;
    constants.inertia = {{across, 0, 0}, {0, about, 0}, {0, 0, across}};
    constants.inverse_inertia = inverse_or_zero(constants.inertia);
    constants.acceleration = {g * std::sin(angle), -g * std::cos(angle), 0};
    const Mat3 r = to_matrix(state.rotation);
    state.inverse_inertia = r * constants.inverse_inertia * transpose(r);
    state.linear_velocity = {2, 0, 0};  // slower, the contact solver does as well
    state.angular_velocity = {0, 0, -2 / radius};
    RollingBody cylinder{.axis = {0, 1, 0}};
    for (const double y : {-half, half}) cylinder.add({{0, y, 0}, radius, 0});
    cylinder.size = std::hypot(radius, half);
    BodyState rolled = state;
    const auto impulse = roll(rolled, constants, cylinder, {{0, 1, 0}, {0, 0, 0}, 1, true}, {time, {}});
    ASSERT_TRUE(impulse);
    EXPECT_NEAR(rolled.linear_velocity.x, 2 + g * std::sin(angle) * 2 / 3 * time, 1e-6);
    EXPECT_NEAR(rolled.center.y, radius, 1e-9);
    EXPECT_NEAR(impulse->y, mass * g * std::cos(angle) * time, 1e-6);
    EXPECT_NEAR(rolled.angular_velocity.z, -rolled.linear_velocity.x / radius, 1e-6);
    // On ice it does not roll like that, and nothing is changed.
    rolled = state;
    EXPECT_FALSE(roll(rolled, constants, cylinder, {{0, 1, 0}, {0, 0, 0}, 0.01, true}, {time, {}}));
    EXPECT_EQ(rolled.center, state.center);
}

}  // namespace
}  // namespace embody::physics::constraint
