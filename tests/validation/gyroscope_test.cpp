// SPDX-License-Identifier: MIT
// Tops on a ball joint against the steady precession of the heavy symmetric top, with l from the joint to the centre of
// mass, C and A the moments of inertia about the axis and across it at the joint, ω₃ the spin, θ the axis from upright:
//     m g l = C ω₃ Ω − A Ω² cos θ        (L. Landau, E. Lifshitz, "Mechanics", § 35; Ω ≈ m g l / (C ω₃) where fast)
#include <gtest/gtest.h>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

struct Top {
    ShapeDefinition rotor;
    double mass = 1, length = 0.15;  // kg; m from the joint to the centre of mass
    double spin = 300, angle = pi / 2;
};

struct Spinning {
    std::unique_ptr<World> world;
    BodyHandle body;
    Vec3 axis;        // of the rotor
    double rate = 0;  // of the steady precession, rad/s
};

// The slower root; no root: 0.
double steady_rate(const Top& top, double about, double across) {
    const double momentum = about * top.spin, moment = top.mass * gravity * top.length,
                 k = across * std::cos(top.angle);
    const double root = momentum * momentum - 4 * k * moment;
    return root > 0 ? 2 * moment / (momentum + std::sqrt(root)) : 0;
}

// The rotor's symmetry axis is its Y; it hangs on the joint by a massless rod of that length.
Spinning spin_up(const Top& top) {
    auto world = make_world({});
    const auto shape = world->create_shape(top.rotor).value();
    const Vec3 axis{std::sin(top.angle), std::cos(top.angle), 0}, center = axis * top.length;
    const BodyDefinition definition{.shape = shape,
                                    .position = center,
                                    .rotation = from_two_vectors({0, 1, 0}, axis),
                                    .mass = {.mass = top.mass},
                                    .allow_sleep = false};
    const auto body = world->create_body(definition).value();
    const Mat3 inertia = world->inertia(body);
    const double rate = steady_rate(top, inertia(1, 1), inertia(0, 0) + top.mass * top.length * top.length);
    const Vec3 up{0, 1, 0}, omega = axis * top.spin + (up - axis * dot(up, axis)) * rate;
    EXPECT_TRUE(world->set_velocity(body, cross(omega, center), omega));
    EXPECT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = body, .frame_b = {{0, -top.length, 0}, {}}}));
    return {std::move(world), body, axis, rate};
}

// Turns the top for so long; what came of it.
struct Outcome {
    double spin = 0, rate = 0;  // rad/s
    double farthest = 0;        // of the axis from its first angle to the vertical, rad
    double gain = 0;            // most energy above that at the start, over the kinetic energy, J/J
};

Outcome turn(Spinning& top, double seconds) {
    World& world = *top.world;
    const auto axis_now = [&] { return rotate(world.pose(top.body).rotation, {0, 1, 0}); };
    const auto angle_of = [](Vec3 axis) { return std::atan2(std::hypot(axis.x, axis.z), axis.y); };
    const double start = energy(world), kinetic = world.conserved().kinetic_energy;
    Outcome outcome;
    double way = 0;
    const int steps = static_cast<int>(std::lround(seconds / world.settings().time_step));
    for (int i = 0; i < steps; ++i) {
        const Vec3 before = axis_now();
        world.step();
        const Vec3 after = axis_now();
        way += std::atan2(before.z * after.x - before.x * after.z, before.x * after.x + before.z * after.z);
        outcome.farthest = std::max(outcome.farthest, std::fabs(angle_of(after) - angle_of(top.axis)));
        outcome.gain = std::max(outcome.gain, (energy(world) - start) / kinetic);
    }
    outcome.spin = dot(axis_now(), world.angular_velocity(top.body));
    outcome.rate = way / seconds;
    return outcome;
}

TEST(Gyroscope, KeepsItsSpinForAMinute) {
    for (const double spin : {30.0, 100.0, 300.0, 1000.0}) {
        Spinning top = spin_up({.rotor = CylinderShape{0.1, 0.01}, .spin = spin});
        const Outcome outcome = turn(top, 60);
        EXPECT_NEAR(outcome.spin, spin, 1e-6 * spin);
        EXPECT_NEAR(outcome.rate, top.rate, 0.002 * top.rate) << spin << " rad/s";
        EXPECT_LT(outcome.farthest, 0.001) << spin << " rad/s";
        EXPECT_LT(outcome.gain, 1e-8) << spin << " rad/s";
    }
}

// Let go without precession it nods, and goes round at the rate of a fast top all the same.
TEST(Gyroscope, LetGoAtRestItNodsAndKeepsItsSpin) {
    Spinning top = spin_up({.rotor = CylinderShape{0.1, 0.01}});
    EXPECT_TRUE(top.world->set_velocity(top.body, {}, top.axis * 300));
    const Outcome outcome = turn(top, 60);
    EXPECT_NEAR(outcome.spin, 300, 1e-4 * 300);
    EXPECT_NEAR(outcome.rate, top.rate, 0.01 * top.rate);
    EXPECT_LT(outcome.farthest, 0.05);
    EXPECT_LT(outcome.gain, 1e-8);
}

// A flywheel on a hinge at the end of a light rod, which a ball joint holds.
TEST(Gyroscope, FlywheelOnAHingeOfARodKeepsItsSpin) {
    for (const bool rotor_is_a : {false, true}) {
        const double length = 0.15, spin = 300, rod_mass = 0.01, mass = 1;
        auto world = make_world({});
        const auto shape = world->create_shape(CylinderShape{0.1, 0.01}).value();
        const Vec3 axis{1, 0, 0};
        const Quat along_x = from_two_vectors({0, 1, 0}, axis), hinge_in_rotor = from_two_vectors(axis, {0, 1, 0});
        const double rate = (mass * length + rod_mass * length / 2) * gravity / (mass * 0.1 * 0.1 / 2 * spin);
        const Vec3 turning{0, rate, 0};
        const auto rotor = world
                               ->create_body({.shape = shape,
                                              .position = axis * length,
                                              .rotation = along_x,
                                              .linear_velocity = cross(turning, axis * length),
                                              .angular_velocity = axis * spin + turning,
                                              .mass = {.mass = mass},
                                              .allow_sleep = false})
                               .value();
        const Mat3 small = Mat3::diagonal({1e-5, 1e-5, 1e-5});
        const auto rod = world
                             ->create_body({.position = axis * (length / 2),
                                            .linear_velocity = cross(turning, axis * (length / 2)),
                                            .angular_velocity = turning,
                                            .mass = {.mass = rod_mass, .inertia = small},
                                            .allow_sleep = false})
                             .value();
        const Transform at_end{axis * (length / 2), {}}, at_rotor{{}, hinge_in_rotor};
        EXPECT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = rod, .frame_b = {axis * (-length / 2), {}}}));
        EXPECT_TRUE(world->create_joint({.joint = HingeJoint{},
                                         .body_a = rotor_is_a ? rotor : rod,
                                         .body_b = rotor_is_a ? rod : rotor,
                                         .frame_a = rotor_is_a ? at_rotor : at_end,
                                         .frame_b = rotor_is_a ? at_end : at_rotor}));
        Spinning top{std::move(world), rotor, axis, rate};
        const Outcome outcome = turn(top, 60);
        EXPECT_NEAR(outcome.spin, spin, 1e-4 * spin) << rotor_is_a;
        EXPECT_NEAR(outcome.rate, rate, 0.005 * rate) << rotor_is_a;
        EXPECT_LT(outcome.farthest, 0.005) << rotor_is_a;
        EXPECT_LT(outcome.gain, 1e-8) << rotor_is_a;
    }
}

ShapeDefinition random_rotor(Random& random) {
    const double r = random.between(0.03, 0.3), h = r * random.between(0.05, 1);
    HullShape prism;
    switch (random.below(4)) {
        case 0:
            return SphereShape{r};
        case 1:
            return CylinderShape{r, h};
        case 2:
            return BoxShape{{r, h, r}};
        default:
            for (int i = 0; i < 12; ++i) {
                const double angle = i * pi / 6;
                for (const double y : {-h, h}) prism.points.push_back({r * std::cos(angle), y, r * std::sin(angle)});
            }
            return prism;
    }
}

TEST(Gyroscope, AnySymmetricRotorPrecessesAtItsRate) {
    Random random(19);
    int count = 0;
    while (count < 40) {
        const Top top{.rotor = random_rotor(random),
                      .mass = random.between(0.05, 50),
                      .length = random.between(0.05, 0.4),
                      .spin = 10 * std::exp(random.between(0, std::log(100.0))),
                      .angle = random.between(30, 150) * pi / 180};
        Spinning spinning = spin_up(top);
        // Beyond that a substep of the precession itself is coarse.
        if (spinning.rate == 0 || spinning.rate > 15 || spinning.rate > top.spin / 4) continue;
        ++count;
        const Outcome outcome = turn(spinning, 10);
        EXPECT_NEAR(outcome.spin, top.spin, 1e-6 * top.spin) << count;
        EXPECT_NEAR(outcome.rate, spinning.rate, 0.01 * spinning.rate) << count;
        EXPECT_LT(outcome.farthest, 0.01) << count;
        EXPECT_LT(outcome.gain, 1e-8) << count;
    }
}

}  // namespace
}  // namespace embody::physics
