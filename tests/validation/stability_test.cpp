// SPDX-License-Identifier: MIT
// Where standing ends: closed forms and limit analysis of tests/validation/reference-cases.json.
#include <gtest/gtest.h>

#include "foundation/random.h"
#include "scenes/structures/building.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// Angle between a body's Y axis and the vertical, rad.
double lean_of(const World& world, BodyHandle body) {
    const Vec3 up = rotate(world.pose(body).rotation, {0, 1, 0});
    return std::atan2(std::hypot(up.x, up.z), up.y);
}

TEST(Stability, BoxOnATiltingPlaneTipsAtTheAngleOfItsDiagonal) {
    const auto reference = reference_case("topple_tilt");
    const double rate = reference["setup"]["tilt_rate_deg_s"].get<double>() * pi / 180;
    const double half_base = reference["setup"]["base"].get<double>() / 2;
    const double half_height = reference["setup"]["height"].get<double>() / 2;
    const Material rough = friction(reference["setup"]["mu"]);
    const auto world = make_world({});

    // A thick plate that turns about the middle of its upper side.
    const auto plate = world->create_shape(BoxShape{{5, 5, 5}}).value();
    const auto ground = world
                            ->create_body({.kind = BodyKind::kinematic_body,
                                           .shape = plate,
                                           .position = {0, -5, 0},
                                           .angular_velocity = {0, 0, -rate},
                                           .mass = {.center_of_mass = Vec3{0, 5, 0}},
                                           .material = rough})
                            .value();
    const auto shape = world->create_shape(BoxShape{{half_base, half_height, half_base}}).value();
    const auto box = world->create_body({.shape = shape, .position = {0, half_height, 0}, .material = rough}).value();
    const double expected = reference["expected"]["tip_deg"];
    while (world->last_report().time < 40) {
        world->step();
        const double tilt = lean_of(*world, ground) * 180 / pi, lean = lean_of(*world, box) * 180 / pi;
        if (lean < tilt + 0.1) continue;
        EXPECT_NEAR(tilt, expected, reference["tolerance"]["abs_deg"].get<double>());
        return;
    }
    FAIL() << "the box never tipped";
}

// What a box does first under a slowly growing horizontal force at the height `z`.
struct Push {
    bool tips = false;
    double force = 0;  // N
};
Push push_box(const nlohmann::json& setup, double z) {
    const double half_base = setup["base"].get<double>() / 2, half_height = setup["height"].get<double>() / 2;
    const Material rough = friction(setup["mu"]);
    const auto world = make_world({});
    add_plane(*world, rough);
    const auto shape = world->create_shape(BoxShape{{half_base, half_height, half_base}}).value();
    const auto box = world
                         ->create_body({.shape = shape,
                                        .position = {0, half_height, 0},
                                        .mass = {.mass = setup["mass"].get<double>()},
                                        .material = rough})
                         .value();
    run(*world, 0.5);
    for (Push push{.force = 30}; push.force < 50; push.force += 0.02) {
        const Transform pose = world->pose(box);
        const Vec3 foot = pose.position + rotate(pose.rotation, {0, -half_height, 0});
        push.tips = lean_of(*world, box) > 0.01;
        if (push.tips || foot.x > 0.005) return push;
        EXPECT_TRUE(world->apply_force(box, {push.force, 0, 0}, Vec3{pose.position.x, z, 0}));
        world->step();
    }
    return {};
}

TEST(Stability, PushedBoxSlidesBelowTheCriticalHeightAndTipsAbove) {
    const auto reference = reference_case("topple_push");
    const double critical = reference["expected"]["z_crit"], tolerance = reference["tolerance"]["rel"];
    const double slide_force = reference["expected"]["F_slide"];
    const Push low = push_box(reference["setup"], critical * (1 - tolerance));
    EXPECT_FALSE(low.tips);
    EXPECT_NEAR(low.force, slide_force, tolerance * slide_force);
    const Push high = push_box(reference["setup"], critical * (1 + tolerance));
    EXPECT_TRUE(high.tips);
    EXPECT_NEAR(high.force, slide_force / (1 + tolerance), tolerance * slide_force);
}

// Whether no piece leaves its place for the time, s.
bool stands(const scenes::Structure& structure, double seconds) {
    run(*structure.world, seconds);
    for (const scenes::Piece& piece : structure.pieces) {
        const Vec3 at = structure.world->center_of_mass(piece.body);
        if (!(length(at - piece.place) <= structure.fallen)) return false;
    }
    return true;
}

TEST(Stability, LeaningCardsStandIffFrictionIsHalfTheTangent) {
    const auto reference = reference_case("card_pair");
    const double needed = reference["expected"]["mu_min"], tolerance = reference["tolerance"]["mu_rel"];
    const double seconds = reference["tolerance"]["stands_s"];
    EXPECT_TRUE(stands(scenes::build_card_pair({.sleeping = false}, needed * (1 + tolerance)), seconds));
    EXPECT_FALSE(stands(scenes::build_card_pair({.sleeping = false}, needed * (1 - tolerance)), seconds));
}

TEST(Stability, ArchOfElevenBlocksStandsIffThickEnough) {
    const auto reference = reference_case("masonry_arch");
    const double thinnest = reference["expected"]["t_over_R_min"], seconds = reference["tolerance"]["stands_s"];
    const double thicker = reference["tolerance"]["stands_at"], thinner = reference["tolerance"]["falls_at"];
    EXPECT_TRUE(stands(scenes::build_arch({.sleeping = false}, thinnest * thicker, 1), seconds));
    EXPECT_FALSE(stands(scenes::build_arch({.sleeping = false}, thinnest * thinner, 1), seconds));
    const double needed = reference["expected"]["mu_min_at_t_over_R_0_15"];
    EXPECT_TRUE(stands(scenes::build_arch({.sleeping = false}, 0.15, 1.1 * needed), seconds));
    EXPECT_FALSE(stands(scenes::build_arch({.sleeping = false}, 0.15, 0.9 * needed), seconds));
}

// Sum of the squares of how deep the balls of radius r overlap each other and the floor, m².
double squared_penetration(const World& world, const std::vector<BodyHandle>& balls, double r) {
    double sum = 0;
    const auto add = [&](double depth) { sum += depth > 0 ? depth * depth : 0; };
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const Vec3 p = world.pose(balls[i]).position;
        add(r - p.y);
        for (std::size_t j = 0; j < i; ++j) add(2 * r - length(world.pose(balls[j]).position - p));
    }
    return sum;
}

TEST(Stability, SixBySixBySixFrictionlessBallsHardlyOverlap) {
    const auto reference = reference_case("666");
    const double r = reference["setup"]["R"], gap = reference["setup"]["gap"], height = reference["setup"]["H"];
    const double noise = reference["setup"]["perturbation"], step = reference["setup"]["dt"];
    const auto world = make_world({.time_step = step});
    add_plane(*world, friction(0));
    const auto shape = world->create_shape(SphereShape{r}).value();
    Random random(666);
    std::vector<BodyHandle> balls;
    for (int i = 0; i < 216; ++i) {
        const Vec3 place{gap * (i % 6) + random.between(0, noise), height + gap * (i / 36) + random.between(0, noise),
                         gap * (i / 6 % 6) + random.between(0, noise)};
        balls.push_back(
            world->create_body({.shape = shape, .position = place, .mass = {.mass = 10}, .material = friction(0)})
                .value());
    }
    const int steps = static_cast<int>(std::lround(reference["setup"]["T"].get<double>() / step));
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        world->step();
        sum += squared_penetration(*world, balls, r);
    }
    RecordProperty("mean_square", std::to_string(sum / steps));
    EXPECT_LT(sum / steps, reference["tolerance"]["max"].get<double>());
}

// Stones on hinges at their toes, as in the theory: they cannot slip, and touch each other without friction.
TEST(Stability, DominoesFallAtTheCollectiveSpeed) {
    const auto reference = reference_case("domino_speed");
    const auto& setup = reference["setup"];
    const double height = setup["h"], thickness = setup["d"], gap = setup["gap"];
    const int count = setup["n"];
    const auto world = make_world({.time_step = 1.0 / 240});
    const auto shape = world->create_shape(BoxShape{{thickness / 2, height / 2, height / 4}}).value();
    const Quat about_z = from_axis_angle({0, 1, 0}, pi / 2);  // turns the hinge's X axis to -Z
    std::vector<BodyHandle> stones;
    for (int i = 0; i < count; ++i) {
        const Vec3 toe{(thickness + gap) * i, 0, 0};
        stones.push_back(
            world
                ->create_body(
                    {.shape = shape, .position = toe + Vec3{-thickness / 2, height / 2, 0}, .material = friction(0)})
                .value());
        ASSERT_TRUE(world->create_joint({.joint = HingeJoint{.limit = JointLimit{0, pi}},
                                         .body_b = stones.back(),
                                         .frame_a = {toe, about_z},
                                         .frame_b = {{thickness / 2, -height / 2, 0}, about_z}}));
    }
    ASSERT_TRUE(world->set_velocity(stones[0], {0.1, 0, 0}, {0, 0, -0.1 / (height / 2)}));

    // When each stone begins to lean, and how fast that goes on once the wave is steady.
    std::vector<double> begun(stones.size(), 0);
    for (std::size_t next = 0; next < stones.size() && world->last_report().time < 10;) {
        world->step();
        while (next < stones.size() && lean_of(*world, stones[next]) > 0.02) begun[next++] = world->last_report().time;
    }
    ASSERT_GT(begun.back(), 0) << "the wave died";
    const double speed = (thickness + gap) * 25 / (begun[50] - begun[25]);
    const double expected = reference["expected"]["speed"];
    EXPECT_NEAR(speed, expected, reference["tolerance"]["rel"].get<double>() * expected);
}

}  // namespace
}  // namespace embody::physics
