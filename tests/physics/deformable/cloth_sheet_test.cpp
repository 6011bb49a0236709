// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/deformable_scene.h"

namespace embody::physics::deformable {
namespace {

using Bench = DeformableScene<ClothSheet>;
using Scene = DeformableScene<ClothSheet>;

// Nodes within the distance of where x is least.
std::vector<std::uint32_t> pin_low_x(const DeformableDefinition& definition, double distance) {
    double least = 1e9;
    for (const Vec3 node : definition.nodes) least = std::min(least, node.x);
    std::vector<std::uint32_t> pinned;
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        if (definition.nodes[i].x < least + distance) pinned.push_back(i);
    }
    return pinned;
}

std::uint32_t farthest_x(const DeformableDefinition& definition) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        const Vec3 a = definition.nodes[i], b = definition.nodes[best];
        if (a.x > b.x + 1e-9 || (a.x > b.x - 1e-9 && std::fabs(a.z) < std::fabs(b.z))) best = i;
    }
    return best;
}

TEST(ClothBending, EnergyOfACylinderIsThatOfThePlateOnAnyMeshInAnyDirection) {
    // ½ k κ² per area, for a small curvature of any direction.
    for (const auto& definition : {cloth_rectangle(0.4, 0.3, 0.02), cloth_disc(0.2, 0.02)}) {
        const auto& cloth = std::get<Cloth>(definition.matter);
        const ScalarRows rows = make_bending_rows(make_bend_elements(definition.nodes, cloth), definition.nodes.size());
        double area = 0;
        for (const ClothTriangle& triangle : make_cloth_triangles(definition.nodes, cloth)) area += triangle.area;
        for (double angle = 0; angle < 3.1; angle += 0.3) {
            const double curvature = 0.1;
            std::vector<double> w;
            for (const Vec3 node : definition.nodes) {
                const double along = std::cos(angle) * node.x + std::sin(angle) * node.z;
                w.push_back(curvature * along * along / 2);
            }
            double energy = 0;
            for (std::size_t i = 0; i < w.size(); ++i) {
                for (std::uint32_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
                    energy += rows.value[k] / 2 * w[i] * w[rows.column[k]];
            }
            EXPECT_NEAR(energy / (0.5 * curvature * curvature * area), 1, 0.07) << angle;
        }
    }
}

TEST(ClothSheet, HangingStripStretchesByItsWeight) {
    // dL = ρ g L² / (2 k)
    auto definition =
        cloth_rectangle(1, 0.1, 0.05, {.area_density = 0.5, .stretch_stiffness = 200, .rayleigh_damping = 0.05});
    definition.pinned = pin_low_x(definition, 1e-3);
    definition.pose.rotation = from_axis_angle({0, 0, 1}, -std::acos(-1.0) / 2);  // x downwards
    Bench bench(definition);
    const std::uint32_t end = farthest_x(definition);
    bench.run(5);
    EXPECT_NEAR(-bench.at(end).y - 0.5, 0.5 * gravity / (2 * 200), 0.01 * 0.5 * gravity / 400);
    EXPECT_LT(bench.fastest(), 2e-3);
}

// What holds two rows of nodes clamps half way between them: there the curvature that both tell begins.
// Tip of a heavy elastica clamped horizontally: B θ'' = w (L - s) cos θ, θ(0) = 0, θ'(L) = 0, by shooting.
Vec3 heavy_elastica(double stiffness, double weight, double length) {
    constexpr int parts = 4000;
    const double ds = length / parts;
    const auto shoot = [&](double curvature, Vec3& tip) {
        double angle = 0;
        tip = {};
        for (int i = 0; i < parts; ++i) {
            const double s = (i + 0.5) * ds;
            const double middle = angle + curvature * ds / 2;
            tip += ds * Vec3{std::cos(middle), -std::sin(middle), 0};
            const double change = -weight * (length - s) * std::cos(middle) / stiffness;
            angle += curvature * ds + change * ds * ds / 2;
            curvature += change * ds;
        }
        return curvature;
    };
    double low = 0, high = 100 / length;
    Vec3 tip;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (shoot(middle, tip) > 0 ? high : low) = middle;
    }
    return tip;
}

TEST(ClothSheet, CantileveredStripHangsAsTheHeavyElastica) {
    // Peirce's test of bending length: an overhang whose chord falls by 41.5° is twice the bending length (B/w)^(1/3).
    const double density = 0.2, stiffness = 2e-5, overhang = 2 * std::cbrt(stiffness / (density * gravity));
    for (const int parts : {8, 16}) {
        const double edge = overhang / parts;
        auto definition = cloth_rectangle(overhang / 2, overhang + edge, edge / std::sqrt(0.75),
                                          {.area_density = density,
                                           .stretch_stiffness = 500,
                                           .shear_stiffness = 200,
                                           .bend_stiffness = stiffness,
                                           .rayleigh_damping = 0.02});
        const double clamp = -(overhang + edge) / 2 + edge;  // the two rows up to here are held
        for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
            if (definition.nodes[i].z < clamp + 1e-9) definition.pinned.push_back(i);
        }
        Bench bench(definition);
        bench.run(6);
        const auto tip = bench.at(definition.nodes.size() - 1) - Vec3{0, 0, clamp - edge / 2};
        const Vec3 right = heavy_elastica(stiffness, density * gravity, overhang + edge / 2);
        RecordProperty("tip_over_elastica_" + std::to_string(parts), std::to_string(tip.y / right.y));
        EXPECT_NEAR(tip.y, right.y, 0.01 * std::fabs(right.y));
    }
}

TEST(ClothSheet, FreeSheetKeepsItsMomenta) {
    auto definition = cloth_rectangle(0.5, 0.3, 0.05);
    definition.linear_velocity = {1, 2, 3};
    definition.angular_velocity = {2, 5, 1};
    Bench bench(definition);
    const Vec3 linear = bench.momentum(), angular = bench.angular_momentum();
    const double seconds = 5;
    bench.run(seconds);
    const Vec3 fall = bench.mass() * seconds * Vec3{0, -gravity, 0};
    EXPECT_LT(length(bench.momentum() - linear - fall), 1e-9 * length(fall));
    EXPECT_LT(length(bench.angular_momentum() - angular), 1e-3 * length(angular));
}

TEST(ClothSheet, SwingsAsAPendulum) {
    // A hanging sheet that is small beside its strings' length would be a point; here a strip 1 m long and stiff to
    // bending swings as a thin rod: T = 2π √(2 L / 3 g) for small angles.
    auto definition = cloth_rectangle(
        1, 0.1, 0.05, {.area_density = 0.5, .stretch_stiffness = 5000, .shear_stiffness = 1000, .bend_stiffness = 5});
    definition.pinned = pin_low_x(definition, 1e-3);
    const double start = 0.1;
    definition.pose.rotation = from_axis_angle({0, 0, 1}, start - std::acos(-1.0) / 2);
    Bench bench(definition);
    bench.substep.h = 1.0 / 240;
    const std::uint32_t end = farthest_x(definition);
    const Vec3 root = bench.at(definition.pinned[0]);
    double crossed = 0, before = 1, period = 0;
    for (int i = 1; i < 1200; ++i) {
        bench.step();
        const double x = bench.at(end).x - root.x, time = i * bench.substep.h;
        if (before > 0 && x <= 0) {
            const double at = time - bench.substep.h * x / (x - before);
            if (crossed > 0) period = at - crossed;
            crossed = at;
        }
        before = x;
    }
    const double right = 2 * std::acos(-1.0) * std::sqrt(2.0 / (3 * gravity));
    EXPECT_NEAR(period, right * (1 + start * start / 16), 0.01 * right);
}

TEST(ClothSheet, SlidesDownAnInclineByCoulombsLaw) {
    // Held below the angle of friction, else a = g (sin α - μ cos α).
    for (const double mu : {0.2, 0.6}) {
        const double angle = 0.4;
        auto definition = cloth_rectangle(0.2, 0.2, 0.04);
        definition.material = sliding(mu);
        definition.pose.rotation = from_axis_angle({0, 0, 1}, -angle);
        definition.pose.position = definition.contact_radius * Vec3{std::sin(angle), std::cos(angle), 0};
        Scene scene(definition);
        LooseBody plane(PlaneShape{{std::sin(angle), std::cos(angle), 0}, 0}, {}, mu);
        scene.bodies.push_back(plane.body);
        const Vec3 start = scene.at(0);
        scene.run(1);
        const double travel = dot(scene.at(0) - start, {std::cos(angle), -std::sin(angle), 0});
        // Backward Euler's way is longer by a substep's share.
        const double right =
            std::max(0.0, gravity * (std::sin(angle) - mu * std::cos(angle)) / 2) * (1 + scene.substep.h);
        EXPECT_NEAR(travel, right, 0.04 * right + 5e-4) << mu;
    }
}

TEST(ClothSheet, TableclothFallsOverATableAndStays) {
    auto definition =
        cloth_rectangle(1.2, 1.2, 0.05, {.area_density = 0.2, .stretch_stiffness = 500, .rayleigh_damping = 0.01});
    definition.pose.position = {0, 0.8, 0};
    Scene scene(definition);
    scene.substep.air_density = 1.2;
    LooseBody table(BoxShape{{0.4, 0.35, 0.4}}, {{0, 0.35, 0}, {}}, 0.5);
    scene.bodies.push_back(table.body);
    scene.run(4);
    const auto before = scene.deformable.nodes().position;
    scene.run(2);
    double drift = 0, lowest = 1, deepest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 x = scene.at(i);
        drift = std::max(drift, length(x - before[i]));
        lowest = std::min(lowest, x.y);
        const Vec3 inside = Vec3{0.4, 0.35, 0.4} - abs(x - Vec3{0, 0.35, 0});
        deepest = std::max(deepest, std::min({inside.x, inside.y, inside.z}));
    }
    EXPECT_LT(drift, 5e-3);
    EXPECT_NEAR(lowest, 0.7 - 0.2, 0.12);  // corners hang lower than the borders' 0.2 m
    EXPECT_LT(deepest, 2e-3);
}

TEST(ClothSheet, FacesThatLeaveItNoRoomPushItNoHarderFromStepToStep) {
    // Two faces come nearer to each other than a sheet is thick: none of its contacts can give way.
    std::mt19937 engine(7);
    const auto chance = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE(round);
        auto definition = cloth_rectangle(0.2, 0.2, 0.04, {.area_density = chance(0.1, 2)});
        const double radius = definition.contact_radius, speed = chance(0.05, 1), tilt = chance(0, 0.3);
        definition.pose.position = {0, radius, 0};
        Scene scene(definition);
        const double friction = chance(0, 1);
        LooseBody floor(PlaneShape{{0, 1, 0}, 0}, {}, friction);
        LooseBody press(PlaneShape{{std::sin(tilt), -std::cos(tilt), 0}, 0}, {{0, 0.05, 0}, {}}, friction);
        scene.bodies = {floor.body, press.body};
        for (std::uint32_t b = 0; b < 2; ++b) scene.bodies[b].body = b;
        const auto hardest = [&] {
            double most = 0;
            for (const TouchSpring& spring : scene.deformable.springs())
                most = std::max(most, spring.acts ? length(spring.felt) : 0.0);
            return most;
        };
        scene.bodies[1].path_velocity = {0, -speed, 0};
        const double room = chance(0.1, 1.8) * radius;
        scene.run((0.05 - room) / speed);
        scene.bodies[1].path_velocity = {};
        scene.run(0.5);
        const double early = hardest();
        EXPECT_GT(early, 0);
        scene.run(3);
        EXPECT_LE(hardest(), 1.01 * early);
        EXPECT_LT(scene.fastest(), 0.05);
    }
}

TEST(ClothSheet, BodiesThatOverlapInItGetWhatItLoses) {
    // Two boxes one in the other, with a sheet through both: its nodes have opposing contacts, and come in where the
    // solve had none.
    std::mt19937 engine(11);
    const auto chance = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
    const auto some = [&](double most) { return Vec3{chance(-most, most), chance(-most, most), chance(-most, most)}; };
    for (int round = 0; round < 30; ++round) {
        SCOPED_TRACE(round);
        Scene scene(cloth_rectangle(0.6, 0.6, 0.04, {.area_density = chance(0.5, 5), .stretch_stiffness = 1e5}));
        scene.substep.gravity = {};
        std::vector<LooseBody> boxes;
        const double mass = chance(1, 10);
        for (int b = 0; b < 2; ++b) {
            boxes.emplace_back(BoxShape{{0.1, chance(0.02, 0.2), 0.1}}, Transform{some(0.02), {}}, chance(0, 1));
            boxes.back().make_ball(mass, 0.15);
            boxes.back().body.body = static_cast<std::uint32_t>(b);
            boxes.back().body.path_velocity = some(0.5);
            scene.bodies.push_back(boxes.back().body);
        }
        for (int step = 0; step < 20; ++step) {
            const Vec3 before = scene.momentum();
            scene.step();
            Vec3 change = scene.momentum() - before;
            for (const TouchedBody& body : scene.bodies) change += body.impulse;
            EXPECT_LT(length(change), 0.02 * (mass + scene.mass()) * 0.5) << "kg m/s, in step " << step;
            for (const TouchedBody& body : scene.bodies) EXPECT_LT(length(body.path_velocity), 2);
        }
    }
}

TEST(ClothSheet, BallOnAPinnedSheetIsHeldWithItsWholeWeight) {
    auto definition = cloth_rectangle(
        1, 1, 0.05, {.area_density = 0.3, .stretch_stiffness = 2000, .shear_stiffness = 500, .rayleigh_damping = 0.02});
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        if (std::max(std::fabs(definition.nodes[i].x), std::fabs(definition.nodes[i].z)) > 0.499)
            definition.pinned.push_back(i);
    }
    for (const double mass : {0.5, 50.0}) {
        Scene scene(definition);
        const double radius = 0.15;
        LooseBody ball(SphereShape{radius}, {{0, radius + 0.05, 0}, {}}, 0.5);
        ball.make_ball(mass, radius);
        ball.body.path_velocity = {0, -0.5 * gravity * scene.substep.h, 0};
        scene.bodies.push_back(ball.body);
        scene.run(8);
        EXPECT_NEAR(scene.bodies[0].impulse.y, mass * gravity * scene.substep.h,
                    0.02 * mass * gravity * scene.substep.h);
        EXPECT_LT(std::fabs(scene.bodies[0].start_center.x), 0.01);
        EXPECT_GT(scene.bodies[0].start_center.y, -0.5);
    }
}

// A plate that hangs by an edge and swings: energy that the air takes of a swing of small amplitude, by the drag of
// plates in oscillating flow, 8 KC^(-1/3) (Graham 1980), a fourth of which is that of a steady stream's 2.
TEST(ClothSheet, AirTakesTheEnergyOfASwingThatYoungVorticesTake) {
    const double drop = 0.4, wide = 0.5, density = 0.5, air = 1.2;
    auto definition = cloth_rectangle(drop, wide, 0.04,
                                      {.area_density = density,
                                       .stretch_stiffness = 5000,
                                       .shear_stiffness = 5000,
                                       .bend_stiffness = 1,
                                       .drag_coefficient = 1.2});
    definition.pinned = pin_low_x(definition, 1e-3);
    const double width = drop * wide / (drop + wide);  // twice the area over the hems' length
    for (const double angle : {0.02, 0.05, 0.15}) {
        definition.pose.rotation = from_axis_angle({0, 0, 1}, -std::acos(-1.0) / 2 + angle);
        double lost[2] = {}, swing = 0;
        for (const bool has_air : {false, true}) {
            Bench bench(definition);
            bench.substep.h = 1.0 / 480;
            bench.substep.air_density = has_air ? air : 0;
            const std::uint32_t end = farthest_x(definition);
            // Amplitudes at the first turn on the other side, and a whole swing later.
            double amplitude[2] = {}, before = 0;
            Vec3 last = bench.at(end);
            for (int turns = 0; turns < 4;) {
                bench.step();
                const double way = bench.at(end).x - last.x;
                if (way * before < 0 && ++turns % 2 == 1 && turns < 4) {
                    amplitude[turns / 2] = std::fabs(last.x - bench.at(definition.pinned[0]).x);
                }
                if (way != 0) before = way;
                last = bench.at(end);
            }
            lost[has_air ? 1 : 0] = 1 - std::pow(amplitude[1] / amplitude[0], 2);
            if (has_air) swing = (amplitude[0] + amplitude[1]) / 2 / drop;
        }
        // Of each piece ½ ρ C 4 KC^(-1/3) (8/3) X³ ω² a swing, X = angle r, of ½ ρs X² ω².
        double taken = 0, energy = 0;
        for (double r = 0.0005; r < drop; r += 0.001) {
            const double x = swing * r;
            taken += air * 1.2 / 2 * 4 * std::cbrt(width / (2 * std::acos(-1.0) * x)) * 8 / 3 * x * x * x;
            energy += density / 2 * x * x;
        }
        const double by_air = 1 - (1 - lost[1]) / (1 - lost[0]);
        EXPECT_NEAR(by_air / (1 - std::exp(-taken / energy)), 1, 0.12) << angle << " " << by_air << " " << lost[0];
    }
}

}  // namespace
}  // namespace embody::physics::deformable
