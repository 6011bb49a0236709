// SPDX-License-Identifier: MIT
// Chains of many light links, at the default settings: 60 Hz, nothing tuned.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "validation/reference.h"

namespace embody::physics {
namespace {

/// Thin rods with ball joints from end to end; the first one hangs on the world.
struct Chain {
    double length;  ///< of a link, m
    std::vector<BodyHandle> links;
    std::vector<JointHandle> joints;
};

Transform end_of(double length, double sign) { return {{sign * length / 2, 0, 0}, {}}; }

void add_joint(World& world, Chain& chain, BodyHandle a, const Transform& frame_a, BodyHandle b,
               const Transform& frame_b) {
    chain.joints.push_back(
        world.create_joint({.joint = BallJoint{}, .body_a = a, .body_b = b, .frame_a = frame_a, .frame_b = frame_b})
            .value());
}

void add_link(World& world, Chain& chain, double mass, Vec3 from, Vec3 direction, double damping = 0) {
    const double radius = chain.length / 10, across = mass * chain.length * chain.length / 12;
    const Quat rotation = from_axis_angle({0, 0, 1}, std::atan2(direction.y, direction.x));
    const auto link =
        world
            .create_body(
                {.position = from + direction * (chain.length / 2),
                 .rotation = rotation,
                 .mass = {.mass = mass, .inertia = Mat3::diagonal({mass * radius * radius / 2, across, across})},
                 .linear_damping = damping,
                 .angular_damping = damping,
                 .allow_sleep = false})
            .value();
    const bool is_first = chain.links.empty();
    add_joint(world, chain, is_first ? BodyHandle{} : chain.links.back(),
              is_first ? Transform{from, {}} : end_of(chain.length, 1), link, end_of(chain.length, -1));
    chain.links.push_back(link);
}

Vec3 lower_end(const World& world, const Chain& chain, std::size_t link) {
    return transform_point(world.pose(chain.links[link]), {chain.length / 2, 0, 0});
}

double tension(const World& world, const Chain& chain, std::size_t joint) {
    return length(world.joint_reaction(chain.joints[joint]).force);
}

TEST(Chain, HangsAsACatenary) {
    const auto reference = reference_case("catenary");
    const auto& setup = reference["setup"];
    const double span = setup["span"], whole = setup["length"];
    const std::size_t count = setup["links"];
    const auto world = make_world({});

    // From a V whose arms have the chain's length, until damping has brought it to rest.
    Chain chain{.length = whole / static_cast<double>(count)};
    const double mass = setup["mass_per_m"].get<double>() * chain.length;
    const double depth = std::sqrt(whole * whole - span * span) / 2;
    const Vec3 down = normalized(Vec3{span / 2, -depth, 0}), up{down.x, -down.y, 0};
    Vec3 place;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 direction = i < count / 2 ? down : up;
        add_link(*world, chain, mass, place, direction, 1);
        place += direction * chain.length;
    }
    add_joint(*world, chain, {}, {{span, 0, 0}, {}}, chain.links.back(), end_of(chain.length, 1));
    run(*world, 20);

    // sinh(x)/x = S/D, sag = c (cosh x − 1), c = D/2x; tension w c in the middle, w (c + sag) at the ends.
    const auto& expected = reference["expected"];
    const auto& tolerance = reference["tolerance"];
    const double sag = expected["sag"], at_end = expected["end_tension"], in_middle = expected["mid_tension"];
    EXPECT_NEAR(-lower_end(*world, chain, count / 2 - 1).y, sag, tolerance["sag_rel"].get<double>() * sag);
    EXPECT_NEAR(tension(*world, chain, 0), at_end, tolerance["tension_rel"].get<double>() * at_end);
    EXPECT_NEAR(tension(*world, chain, count / 2), in_middle, tolerance["tension_rel"].get<double>() * in_middle);

    // Lengths from joint to joint.
    double stretched = 0;
    Vec3 last;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 next = lower_end(*world, chain, i);
        stretched += length(next - last);
        last = next;
    }
    EXPECT_NEAR(stretched / whole, 1, tolerance["stretch_rel"].get<double>());
}

// Energy of a chain that falls from the horizontal without any damping, over that of the fall to the vertical: the
// largest so far.
double largest_energy(World& world, const Chain& chain, double mass, double seconds) {
    const double count = static_cast<double>(chain.links.size());
    const double fall = mass * count * gravity * chain.length * count / 2;
    double most = 0;
    const int steps = static_cast<int>(std::lround(seconds * 60));
    for (int i = 0; i < steps; ++i) {
        world.step();
        most = std::max(most, energy(world) / fall);
    }
    return most;
}

TEST(Chain, SwingingUndampedNeverGainsEnergyAndStaysWhole) {
    for (const std::size_t count : {2, 10, 100}) {
        const auto world = make_world({});
        Chain chain{.length = 2.0 / static_cast<double>(count)};
        const double mass = chain.length;
        for (std::size_t i = 0; i < count; ++i) {
            add_link(*world, chain, mass, Vec3{chain.length, 0, 0} * static_cast<double>(i), {1, 0, 0});
        }
        EXPECT_LT(largest_energy(*world, chain, mass, 10), 1e-3) << count;
        EXPECT_EQ(world->last_report().limits, 0u) << count;
        EXPECT_LT(length(lower_end(*world, chain, count - 1)), 2 * (1 + 1e-9)) << count;
    }
}

TEST(Chain, WithFewLinksSwingsForLong) {
    // What a large pendulum of three rods loses in 10 s is the velocities' misfit with the joints of order h³ a
    // substep.
    const auto world = make_world({});
    Chain chain{.length = 2.0 / 3};
    for (int i = 0; i < 3; ++i) add_link(*world, chain, 1, Vec3{chain.length * i, 0, 0}, {1, 0, 0});
    run(*world, 10);
    EXPECT_NEAR(energy(*world) / (3 * gravity), 0, 0.02);
}

TEST(Chain, OfLightLinksHoldsAThousandKilograms) {
    // Links of 0.1 kg; the load hangs still, or swings from the horizontal.
    for (const Vec3 direction : {Vec3{0, -1, 0}, Vec3{1, 0, 0}}) {
        const auto world = make_world({});
        Chain chain{.length = 0.02};
        for (int i = 0; i < 100; ++i) {
            add_link(*world, chain, 0.1, direction * (chain.length * i), direction);
        }
        const double radius = 0.3, inertia = 0.4 * 1000 * radius * radius;
        const auto load =
            world
                ->create_body({.position = direction * (2 + radius),
                               .mass = {.mass = 1000, .inertia = Mat3::diagonal({inertia, inertia, inertia})},
                               .allow_sleep = false})
                .value();
        add_joint(*world, chain, chain.links.back(), end_of(chain.length, 1), load, {direction * -radius, {}});
        for (int i = 0; i < 180; ++i) {
            world->step();
            const Vec3 hook = transform_point(world->pose(load), direction * -radius);
            ASSERT_LT(length(lower_end(*world, chain, 99) - hook), 1e-6) << "step " << i;
            ASSERT_NEAR(length(hook) / 2, 1, 0.005) << "step " << i;
        }
        const bool hangs = direction.y < 0;
        const double fall = (1000 * 2.3 + 10 * 1) * gravity;
        EXPECT_LT(energy(*world), (hangs ? -fall : 0) + 1e-3 * fall);
        if (hangs) {
            EXPECT_NEAR(tension(*world, chain, 0), (1000 + 10) * gravity, 1);
        }
    }
}

// Turns a door of 2 kg and 1 m by a motor, against a limit, or both: what a hinge must do at once with its other rows.
TEST(Chain, HingesOfADoorDriveAndStopIt) {
    const Quat up = from_axis_angle({0, 0, 1}, pi / 2);  // turns the hinge's X axis to Y
    const auto world = make_world({.gravity = {}});
    const Vec3 half{0.5, 1, 0.02};
    const auto board = world->create_shape(BoxShape{half}).value();
    const auto door =
        world->create_body({.shape = board, .position = {0.5, 0, 0}, .mass = {.mass = 2}, .allow_sleep = false})
            .value();
    const auto hinge = world
                           ->create_joint({.joint = HingeJoint{.limit = JointLimit{-0.1, 1},
                                                               .motor = JointMotor{.speed = 0.5, .max_force = 3}},
                                           .body_b = door,
                                           .frame_a = {{}, up},
                                           .frame_b = {{-0.5, 0, 0}, up}})
                           .value();

    // With 3 N m on m l²/3 the speed is there within a substep or two; it stays so until the limit.
    run(*world, 1);
    EXPECT_NEAR(world->angular_velocity(door).y, 0.5, 1e-6);
    run(*world, 3);
    EXPECT_NEAR(world->joint_coordinate(hinge), 1, 1e-6);
    EXPECT_NEAR(world->angular_velocity(door).y, 0, 1e-6);

    // The motor's moment is what the limit answers: their sum is nothing.
    EXPECT_NEAR(length(world->joint_reaction(hinge).torque), 0, 0.01);
}

}  // namespace
}  // namespace embody::physics
