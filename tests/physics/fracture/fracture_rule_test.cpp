// SPDX-License-Identifier: MIT
// When a blow breaks a solid, into how many pieces, and what breaks these.
#include "physics/fracture/fracture_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "foundation/random.h"
#include "physics/definitions/body_definition.h"

namespace embody::physics::fracture {
namespace {

TEST(FractureRule, BreaksAboveEitherLimitOnly) {
    const Brittleness brittleness{.break_impulse = 2, .break_energy = 8};
    EXPECT_FALSE(excess_of({{}, 2, 8}, brittleness));
    EXPECT_NEAR(excess_of({{}, 4, 1}, brittleness).value(), 0.5, 1e-12) << "the second half of the impulse";
    // A quarter of the energy is there after 1 - √(3/4) of the impulse.
    EXPECT_NEAR(excess_of({{}, 1, 32}, brittleness).value(), std::sqrt(0.75), 1e-12);
    EXPECT_NEAR(excess_of({{}, 40, 8.1}, brittleness).value(), 0.95, 1e-12) << "whichever is reached first";
}

// Grady: s³ = 12 G V L² / E. A pane of 0.4 × 0.4 m and 4 mm, hit with 36 J: pieces of 67 mm, 36 of them.
TEST(FractureRule, PiecesHaveGradysSize) {
    const BrokenSolid pane{{0.4, 0.4, 0.004}, 6.4e-4};
    EXPECT_EQ(piece_count(pane, 36, {.break_energy = 1, .fracture_energy = 8.8, .max_pieces = 100}), 36);
    EXPECT_EQ(piece_count(pane, 36, {.break_energy = 1, .fracture_energy = 8.8, .max_pieces = 10}), 10);
    EXPECT_EQ(piece_count(pane, 1e-6, {.break_energy = 1e-7}), 2);
}

TEST(FractureRule, MoreEnergyNeverMakesFewerPieces) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const BrokenSolid solid{{random.between(0.01, 2), random.between(0.01, 2), random.between(0.01, 2)}, 0.01};
        const double energy = std::pow(10, random.between(-3, 3));
        const Brittleness brittleness{.break_energy = 1, .fracture_energy = random.between(1, 100), .max_pieces = 200};
        EXPECT_LE(piece_count(solid, energy, brittleness), piece_count(solid, 2 * energy, brittleness));
    }
}

// Rumpf: half the length takes twice the energy by mass.
TEST(FractureRule, SmallerPiecesAreStronger) {
    const Brittleness whole{.break_impulse = 3, .break_energy = 5, .max_pieces = 100};
    const Brittleness piece = brittleness_of_piece(whole, 0.125).value();
    EXPECT_NEAR(piece.break_energy / 0.125, 2 * whole.break_energy, 1e-12);
    EXPECT_NEAR(piece.break_impulse / 0.125, std::sqrt(2) * whole.break_impulse, 1e-12);
    EXPECT_EQ(piece.max_pieces, 12);
    EXPECT_FALSE(brittleness_of_piece(whole, 0.0199)) << "too small to break again";
}

TEST(FractureRule, BadNumbersAreRefusedByField) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const auto field = [](const Brittleness& brittleness) {
        const auto checked = validate(BodyDefinition{.brittleness = brittleness});
        return checked.ok() ? std::string() : checked.error().where;
    };
    EXPECT_EQ(field({.break_impulse = 1}), "");
    EXPECT_EQ(field({.break_energy = 1}), "");
    EXPECT_EQ(field({}), "brittleness.break_impulse");
    for (const double bad : {nan, 0.0, -1.0, -infinity}) {
        EXPECT_EQ(field({.break_impulse = bad, .break_energy = 1}), "brittleness.break_impulse");
        EXPECT_EQ(field({.break_energy = bad}), "brittleness.break_energy");
        EXPECT_EQ(field({.break_energy = 1, .fracture_energy = bad}), "brittleness.fracture_energy");
    }
    EXPECT_EQ(field({.break_energy = 1, .fracture_energy = infinity}), "brittleness.fracture_energy");
    for (const int bad : {-1, 0, 1, 257})
        EXPECT_EQ(field({.break_energy = 1, .max_pieces = bad}), "brittleness.max_pieces");
}

}  // namespace
}  // namespace embody::physics::fracture
