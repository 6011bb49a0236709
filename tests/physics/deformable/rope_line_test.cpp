// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/deformable_scene.h"

namespace embody::physics::deformable {
namespace {

constexpr double pi = 3.14159265358979323846;
using Scene = DeformableScene<RopeLine>;

TEST(RopeLine, HangingRopeStretchesByItsWeight) {
    // dL = w g L² / (2 EA), at any stiffness; the top carries the whole weight but that of its half segment.
    for (const double stiffness : {50.0, 1e4, 1e8}) {
        auto definition = rope_between({0, 0, 0}, {0, -2, 0}, 0.05,
                                       {.linear_density = 0.5, .axial_stiffness = stiffness, .rayleigh_damping = 0.05});
        definition.pinned = {0};
        Scene scene(definition);
        scene.run(5);
        const double right = 0.5 * gravity * 4 / (2 * stiffness);
        EXPECT_NEAR(-scene.at(40).y - 2, right, 0.01 * right);
        EXPECT_NEAR(scene.deformable.tensions()[0], 0.5 * gravity * 2 * (1 - 0.5 / 40), 1e-3);
    }
}

TEST(RopeLine, HangsInACatenary) {
    // Reference case "catenary": length 2.2 m over 2 m.
    auto definition =
        rope_between({-1.1, 0, 0}, {1.1, 0, 0}, 0.022,
                     {.linear_density = 1, .axial_stiffness = 1e6, .bend_rigidity = 1e-6, .rayleigh_damping = 0.02});
    const std::size_t count = definition.nodes.size();
    // It begins as two straight legs.
    const double depth = std::sqrt(1.1 * 1.1 - 1);
    definition.pinned = {0, static_cast<std::uint32_t>(count - 1)};
    Scene scene(definition);
    for (Vec3& node : scene.deformable.nodes().position)
        node = {node.x / 1.1, -depth * (1 - std::fabs(node.x) / 1.1), 0};
    scene.run(20);
    EXPECT_NEAR(-scene.at(count / 2).y, 0.400601581472, 0.01 * 0.4006);
    EXPECT_NEAR(scene.deformable.tensions()[0], 16.7802941669, 0.03 * 16.78);
    EXPECT_NEAR(scene.deformable.tensions()[count / 2], 12.8503926526, 0.03 * 12.85);
    EXPECT_LT(scene.fastest(), 1e-3);
}

TEST(RopeLine, ClampedRodBendsAsABeam) {
    // w L⁴ / (8 EI) while it is small. Two pinned nodes clamp half way between them: the bend at the second is that of
    // half a segment on either side.
    for (const int parts : {10, 20, 40}) {
        const double segment = 1.0 / parts, rigidity = 2, density = 0.1;
        auto definition = rope_between(
            {-segment, 0, 0}, {1, 0, 0}, segment * 1.000001,
            {.linear_density = density, .axial_stiffness = 1e5, .bend_rigidity = rigidity, .rayleigh_damping = 0.05});
        definition.pinned = {0, 1};
        Scene scene(definition);
        scene.run(4);
        const double right = density * gravity * std::pow(1 + segment / 2, 4) / (8 * rigidity);
        const double bent = -scene.at(definition.nodes.size() - 1).y;
        RecordProperty("tip_over_beam_" + std::to_string(parts), std::to_string(bent / right));
        EXPECT_NEAR(bent, right, 0.02 * right);
    }
}

TEST(RopeLine, FreeRopeKeepsItsMomenta) {
    auto definition = rope_between({-0.5, 0, 0}, {0.5, 0.2, 0.1}, 0.04, {.axial_stiffness = 1e4});
    definition.linear_velocity = {1, 2, 3};
    definition.angular_velocity = {2, 5, 1};
    Scene scene(definition);
    const Vec3 linear = scene.momentum(), angular = scene.angular_momentum();
    scene.run(5);
    const Vec3 fall = scene.mass() * 5 * Vec3{0, -gravity, 0};
    EXPECT_LT(length(scene.momentum() - linear - fall), 1e-9 * length(fall));
    EXPECT_LT(length(scene.angular_momentum() - angular), 1e-3 * length(angular));
}

TEST(RopeLine, WeightOnARopeSwingsAsAPendulum) {
    // A ball of 1 kg, 1 m below its pin: T = 2π √(L/g) (1 + θ²/16); the rope weighs next to nothing.
    for (const double mass : {1.0, 100.0}) {
        const double start = 0.2;
        const Vec3 hang{std::sin(start), -std::cos(start), 0};
        auto definition = rope_between({}, hang, 0.05, {.linear_density = 1e-3, .axial_stiffness = 1e6});
        definition.pinned = {0};
        definition.attachments = {{.node = 20, .anchor = {}}};
        Scene scene(definition);
        scene.substep.h = 1.0 / 120;
        LooseBody ball(SphereShape{0.01}, {hang, {}}, 0.5);
        ball.make_ball(mass, 0.01);
        scene.bodies.push_back(ball.body);
        scene.attachments = {0};
        double crossed = 0, before = 1, period = 0;
        for (int i = 1; i < 600; ++i) {
            scene.step();
            const double x = scene.bodies[0].start_center.x, time = i * scene.substep.h;
            if (before > 0 && x <= 0) {
                const double at = time - scene.substep.h * x / (x - before);
                if (crossed > 0) period = at - crossed;
                crossed = at;
            }
            before = x;
        }
        EXPECT_NEAR(period, 2 * pi / std::sqrt(gravity) * (1 + start * start / 16), 0.01 * 2.006);
        EXPECT_NEAR(length(scene.bodies[0].start_center), 1, 0.005);
        EXPECT_NEAR(length(scene.at(20) - scene.bodies[0].start_center), 0, 1e-3);
    }
}

TEST(RopeLine, BreaksWhereTheTensionIsTooLarge) {
    // The top carries the weight; a load above the break tension parts it there and the rest falls.
    auto definition =
        rope_between({0, 0, 0}, {0, -1, 0}, 0.1,
                     {.linear_density = 1, .axial_stiffness = 1e4, .rayleigh_damping = 0.02, .break_tension = 9});
    definition.pinned = {0};
    Scene scene(definition);
    scene.run(1);
    EXPECT_TRUE(scene.deformable.is_broken(0));
    for (std::size_t s = 1; s < 10; ++s) EXPECT_FALSE(scene.deformable.is_broken(s));
    EXPECT_LT(scene.at(10).y, -3);
    std::get<Rope>(definition.matter).break_tension = 20;
    Scene strong(definition);
    strong.run(1);
    EXPECT_FALSE(strong.deformable.is_broken(0));
}

TEST(RopeLine, GripsADrumAsACapstan) {
    // Reference case "capstan": 1.5 turns, μ = 0.3, T2 / T1 = exp(μ φ) while it slips.
    const double radius = 0.1, thickness = 2e-3, mu = 0.3, segment = 0.005, travel = radius + thickness;
    const double turn = 3 * pi, slack = 0.4, pulled = 0.2;
    std::vector<Vec3> nodes;
    const double whole = slack + turn * travel + pulled;
    const int count = static_cast<int>(std::ceil(whole / segment));
    for (int i = 0; i <= count; ++i) {
        const double s = whole * i / count - slack, angle = s / travel;
        if (s < 0)
            nodes.push_back({travel, s, 0});
        else if (angle < turn)
            nodes.push_back({travel * std::cos(angle), travel * std::sin(angle), 0});
        else
            nodes.push_back({-travel, -(s - turn * travel), 0});
    }
    DeformableDefinition definition = rope_between(
        {}, {whole, 0, 0}, whole / count,
        {.linear_density = 0.01, .axial_stiffness = 2e4, .bend_rigidity = 1e-7, .rayleigh_damping = 0.005});
    definition.nodes = nodes;
    definition.material = sliding(mu);
    definition.contact_radius = thickness;
    const auto last = static_cast<std::uint32_t>(nodes.size() - 1);
    definition.attachments = {{.node = 0}, {.node = last}};
    Scene scene(definition);
    LooseBody drum(CylinderShape{radius, 0.2}, {{}, from_axis_angle({1, 0, 0}, pi / 2)}, mu);
    LooseBody weight(SphereShape{0.01}, {nodes.front(), {}}, mu), hand(SphereShape{0.01}, {nodes.back(), {}}, mu);
    weight.make_ball(0.1, 0.01);
    hand.body.path_velocity = {0, -0.02, 0};  // pulls
    scene.bodies = {drum.body, weight.body, hand.body};
    scene.attachments = {1, 2};
    scene.run(2);
    const auto tensions = scene.deformable.tensions();
    double low = 0, high = 0;
    for (int i = 0; i < 60; ++i) {
        scene.step();
        // Where the rope comes to the drum and leaves it.
        std::size_t first = 0, end = last;
        while (scene.at(first + 1).y < 0) ++first;
        while (scene.at(end - 1).y < 0) --end;
        low += tensions[first];
        high += tensions[end];
    }
    RecordProperty("ratio", std::to_string(high / low));
    EXPECT_NEAR(high / low, std::exp(mu * turn), 0.1 * std::exp(mu * turn));
}

}  // namespace
}  // namespace embody::physics::deformable
