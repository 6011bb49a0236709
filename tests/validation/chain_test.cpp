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

// A rope of balls on thin rods, wound around a drum and drawn over it slowly.
TEST(Chain, SlidesOverADrumByTheCapstanEquation) {
    const auto reference = reference_case("capstan");
    const double angle = reference["setup"]["angle_rad"], drum_radius = 0.2, radius = 0.002, mass = 0.05;
    const Material material = friction(reference["setup"]["mu"]);
    const auto world = make_world({.gravity = {}});
    const auto drum = world->create_shape(CylinderShape{drum_radius, 1}).value();
    ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = drum, .material = material}));

    // The way along the rope: a helix around the drum, with straight ends.
    const double middle_line = drum_radius + radius, rise = 3 * radius / (2 * pi);
    const auto place = [&](double way) {
        const double turned = std::clamp(way / middle_line, 0.0, angle), beyond = way - turned * middle_line;
        const Vec3 on_drum{middle_line * std::cos(turned), rise * way / middle_line, middle_line * std::sin(turned)};
        return on_drum + Vec3{-std::sin(turned), 0, std::cos(turned)} * beyond;
    };
    const int links_on_drum = 63, links_beyond = 3;
    const double length_of_link = middle_line * angle / links_on_drum;
    const auto ball = world->create_shape(SphereShape{radius}).value();
    std::vector<BodyHandle> links;
    std::vector<JointHandle> joints;
    Vec3 last_end;
    for (int i = -links_beyond; i < links_on_drum + links_beyond; ++i) {
        const Vec3 from = place(i * length_of_link), to = place((i + 1) * length_of_link), along = to - from;
        const Quat rotation = normalized(Quat{0, -along.z, along.y, length(along) + along.x});
        const double across = mass * length_squared(along) / 12, around = across / 10;
        links.push_back(world
                            ->create_body({.shape = ball,
                                           .position = (from + to) * 0.5,
                                           .rotation = rotation,
                                           .mass = {.mass = mass, .inertia = Mat3::diagonal({around, across, across})},
                                           .material = material,
                                           .allow_sleep = false})
                            .value());
        const Vec3 half{length(along) / 2, 0, 0};
        if (links.size() > 1) {
            const JointDefinition joint{.joint = BallJoint{},
                                        .body_a = links[links.size() - 2],
                                        .body_b = links.back(),
                                        .frame_a = {last_end, {}},
                                        .frame_b = {-half, {}}};
            joints.push_back(world->create_joint(joint).value());
        }
        last_end = half;
    }

    // A constant pull on one end, a slow one on the other.
    const double whole = (links_on_drum + links_beyond) * length_of_link, pull = 2, speed = 0.03;
    const Vec3 forward = normalized(place(whole) - place(whole - length_of_link));
    const Vec3 backward = normalized(place(-length_of_link) - place(0));
    const auto hand = world->create_body({.kind = BodyKind::kinematic_body, .position = place(whole)}).value();
    joints.push_back(
        world->create_joint({.joint = BallJoint{}, .body_a = hand, .body_b = links.back(), .frame_b = {last_end, {}}})
            .value());
    double sum_low = 0, sum_high = 0;
    for (int i = 0; i < 150; ++i) {
        const Transform first = world->pose(links.front());
        ASSERT_TRUE(
            world->apply_force(links.front(), backward * pull, transform_point(first, {-length_of_link / 2, 0, 0})));
        ASSERT_TRUE(world->set_velocity(hand, forward * (speed * std::min(1.0, i / 60.0)), {}));
        world->step();
        if (i < 90) continue;
        sum_low += length(world->joint_reaction(joints.front()).force);
        sum_high += length(world->joint_reaction(joints.back()).force);
    }

    // T₂/T₁ = exp(μφ).
    const double ratio = reference["expected"]["ratio"];
    EXPECT_NEAR(sum_high / sum_low, ratio, reference["tolerance"]["rel"].get<double>() * ratio);
}

TEST(Chain, FallsOntoAFloorWithoutGainingEnergy) {
    // As it is, and with 1000 kg at its end. Where contacts come in, the whole kick goes before the drift: a body that
    // falls at v then has h v g/2 more energy a kilogram than a moment ago, a hundredth of this fall.
    for (const double load : {0.0, 1000.0}) {
        for (const int count : {8, 30, 100}) {
            const auto world = make_world({});
            add_plane(*world, {});
            const double length_of_link = 2.0 / count, height = 1.4, mass = 0.1;
            const auto box = world->create_shape(BoxShape{Vec3{0.45, 0.1, 0.1} * length_of_link}).value();
            BodyHandle last;
            const auto hang = [&](const BodyDefinition& definition, double half) {
                const auto body = world->create_body(definition).value();
                JointDefinition joint{
                    .joint = BallJoint{}, .body_a = last, .body_b = body, .frame_b = {{-half, 0, 0}, {}}};
                joint.frame_a = {last.is_null() ? Vec3{0, height, 0} : Vec3{length_of_link / 2, 0, 0}, {}};
                EXPECT_TRUE(world->create_joint(joint));
                last = body;
            };
            for (int i = 0; i < count; ++i) {
                const Vec3 place{length_of_link * (i + 0.5), height, 0};
                hang({.shape = box, .position = place, .mass = {.mass = mass}, .allow_sleep = false},
                     length_of_link / 2);
            }
            const auto ball = world->create_shape(SphereShape{0.2}).value();
            const Vec3 end{2.2, height, 0};
            if (load > 0) {
                hang({.shape = ball, .position = end, .mass = {.mass = load}, .allow_sleep = false}, 0.2);
            }
            const double start = energy(*world), fall = (load + mass * count / 2) * gravity * 2;
            for (int i = 0; i < 180; ++i) {
                world->step();
                ASSERT_LT(energy(*world), start + 1e-2 * fall)
                    << "load " << load << " links " << count << " step " << i;
            }
            // Links that the load presses on may be deep in the floor for a moment.
            const std::uint32_t limits = world->last_report().limits;
            EXPECT_EQ(limits & ~static_cast<std::uint32_t>(StepLimit::deep_penetration), 0u)
                << "load " << load << " links " << count;
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
