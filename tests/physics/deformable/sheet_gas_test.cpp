// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/sheet_gas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"

namespace embody::physics::deformable {
namespace {

Vec3 draw_vector(Random& random, double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

DeformableDefinition random_ball(Random& random) {
    const double radius = random.between(0.05, 0.5);
    DeformableDefinition ball =
        cloth_ball(radius, radius / random.between(2, 5), {.internal_pressure = random.between(100, 5e4)});
    for (Vec3& node : ball.nodes) node += draw_vector(random, 0.02 * radius) + Vec3{1, 2, 3};
    return ball;
}

TEST(SheetGas, ABallIsClosedAndHasItsVolume) {
    for (const double edge : {0.02, 0.05, 0.1}) {
        const DeformableDefinition ball = cloth_ball(0.3, edge, {.internal_pressure = 1000});
        const Cloth& cloth = std::get<Cloth>(ball.matter);
        EXPECT_TRUE(is_closed(cloth));
        EXPECT_TRUE(validate(ball).ok());
        const double share = edge / 0.3;  // chords lie within the sphere
        EXPECT_NEAR(enclosed_volume(ball.nodes, cloth.triangles) / (4 * std::numbers::pi / 3 * 0.027), 1,
                    share * share);
        EXPECT_EQ(ball.nodes.size() * 2, cloth.triangles.size() + 4);  // Euler
    }
}

TEST(SheetGas, IsRefusedInAnOpenOrTurnedSheetAndOutOfRange) {
    DeformableDefinition sheet = cloth_rectangle(1, 1, 0.2, {.internal_pressure = 1});
    EXPECT_EQ(validate(sheet).error().where, "internal_pressure");
    std::get<Cloth>(sheet.matter).internal_pressure = 0;
    EXPECT_TRUE(validate(sheet).ok());
    DeformableDefinition ball = cloth_ball(0.2, 0.1, {.internal_pressure = 1});
    EXPECT_TRUE(validate(ball).ok());
    Cloth& cloth = std::get<Cloth>(ball.matter);
    for (const double wrong : {-1.0, 1.1e8, std::nan(""), std::numeric_limits<double>::infinity()}) {
        cloth.internal_pressure = wrong;
        ASSERT_FALSE(validate(ball).ok()) << wrong;
        EXPECT_EQ(validate(ball).error().where, "internal_pressure") << wrong;
    }
    cloth.internal_pressure = 1;
    for (auto& triangle : cloth.triangles) std::swap(triangle[0], triangle[1]);
    ASSERT_FALSE(validate(ball).ok());
    EXPECT_EQ(validate(ball).error().where, "internal_pressure");
    std::swap(cloth.triangles[5][0], cloth.triangles[5][1]);
    ASSERT_FALSE(validate(ball).ok());
    EXPECT_EQ(validate(ball).error().where, "internal_pressure");
}

TEST(SheetGas, PressureTimesVolumeStaysTheSame) {
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const DeformableDefinition ball = random_ball(random);
        const SheetGas gas(ball);
        const double rest = gas.volume(ball.nodes), pressure = std::get<Cloth>(ball.matter).internal_pressure;
        EXPECT_NEAR(gas.pressure(rest), pressure, 1e-6 * pressure);
        const double volume = random.between(0.3, 3) * rest;
        EXPECT_NEAR((gas.pressure(volume) + air_pressure) * volume, (pressure + air_pressure) * rest,
                    1e-9 * air_pressure * volume);
        const double step = 1e-5 * rest;
        EXPECT_NEAR(-(gas.energy(volume + step) - gas.energy(volume - step)) / (2 * step), gas.pressure(volume), 1);
        EXPECT_NEAR(gas.energy(rest), 0, 1e-9);
    }
    // Folded through itself, a sheet encloses less than nothing: all stays finite, and pushes it out.
    const SheetGas gas(random_ball(random));
    EXPECT_GT(gas.pressure(-1), 0);
    EXPECT_TRUE(std::isfinite(gas.pressure(0)) && std::isfinite(gas.energy(-1)));
    EXPECT_GT(gas.energy(-1), gas.energy(0));
}

TEST(SheetGas, NeitherPushesNorTurnsTheWhole) {
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        const DeformableDefinition ball = random_ball(random);
        SheetGas gas(ball);
        std::vector<Vec3> moves;
        for (std::size_t k = 0; k < ball.nodes.size(); ++k) moves.push_back(draw_vector(random, 0.05));
        for (const auto& offset : {std::vector<Vec3>{}, moves}) {
            gas.linearize(ball.nodes, offset);
            Vec3 push, turn;
            double all = 0;
            for (std::size_t k = 0; k < ball.nodes.size(); ++k) {
                const Vec3 place = offset.empty() ? ball.nodes[k] : ball.nodes[k] + offset[k];
                push += gas.gradient()[k];
                turn += cross(place, gas.gradient()[k]);
                all += length(gas.gradient()[k]);
            }
            EXPECT_LT(length(push), 1e-13 * all);
            EXPECT_LT(length(turn), 1e-12 * all);
        }
    }
}

// Of random moves e: the energy's change by the equations, to second order, is that by the volume.
TEST(SheetGas, EquationsAreTheEnergysDerivatives) {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        const DeformableDefinition ball = random_ball(random);
        const Cloth& cloth = std::get<Cloth>(ball.matter);
        SheetGas gas(ball);
        const double size = length(ball.nodes[cloth.triangles[0][0]] - ball.nodes[cloth.triangles[0][1]]);
        std::vector<Vec3> offset, end = ball.nodes, small;
        for (std::size_t k = 0; k < ball.nodes.size(); ++k) {
            offset.push_back(draw_vector(random, 0.2 * size));
            small.push_back(draw_vector(random, 1e-4 * size));
        }
        gas.linearize(ball.nodes, offset);
        // force_on() is what the equations say at the start: theirs at the place of `offset` is that less K offset.
        const auto stiffness_times = [&](const std::vector<Vec3>& e) {
            double pull = 0;
            std::vector<Vec3> force(e.size());
            for (std::size_t k = 0; k < e.size(); ++k) pull += dot(gas.gradient()[k], e[k]);
            for (std::size_t k = 0; k < e.size(); ++k) force[k] = gas.compression() * pull * gas.gradient()[k];
            for (const auto& corners : cloth.triangles) {
                for (std::size_t k = 0; k < 3; ++k) {
                    force[corners[k]] += gas.block(corners, k, true) * e[corners[(k + 1) % 3]];
                    force[corners[k]] += gas.block(corners, k, false) * e[corners[(k + 2) % 3]];
                }
            }
            return force;
        };
        const std::vector<Vec3> back = stiffness_times(offset), change = stiffness_times(small);
        for (std::size_t k = 0; k < end.size(); ++k) end[k] += offset[k];
        const double pressure = gas.pressure(gas.volume(end));
        double foreseen = 0, curved = 0;
        for (std::size_t k = 0; k < end.size(); ++k) {
            const Vec3 force = gas.force_on(k) - back[k];
            foreseen -= dot(force, small[k]);
            curved += dot(change[k], small[k]) / 2;
            EXPECT_LT(length(force - pressure * gas.gradient()[k]), 1e-6 * length(gas.force_on(k)) + 1e-6);
        }
        const auto energy_at = [&](double sign) {
            std::vector<Vec3> at = end;
            for (std::size_t k = 0; k < at.size(); ++k) at[k] += sign * small[k];
            return gas.energy(gas.volume(at));
        };
        const double middle = gas.energy(gas.volume(end));
        EXPECT_NEAR((energy_at(1) - energy_at(-1)) / 2, foreseen, 1e-5 * std::fabs(foreseen) + 1e-9);
        EXPECT_NEAR((energy_at(1) + energy_at(-1)) / 2 - middle, curved, 0.01 * std::fabs(curved) + 1e-9);
        // At the moves that the equations are about nothing is unforeseen.
        EXPECT_LT(gas.unforeseen_energy(ball.nodes, offset), 1e-9 * air_pressure);
    }
}

}  // namespace
}  // namespace embody::physics::deformable
