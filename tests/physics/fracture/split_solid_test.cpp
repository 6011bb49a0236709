// SPDX-License-Identifier: MIT
// Solids cut along Voronoi cells: nothing is lost, nothing is there twice, equal inputs are cut alike.
#include "physics/fracture/split_solid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/convex_hull.h"
#include "physics/definitions/mass_properties.h"

namespace embody::physics::fracture {
namespace {

Vec3 random_point(Random& random, double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

HullShape random_hull(Random& random, double size) {
    HullShape hull;
    for (std::uint64_t i = 0; i < 8 + random.below(20); ++i) hull.points.push_back(random_point(random, size));
    return hull;
}

// One of the shapes that can break, of sizes from millimetres to metres, and flat ones.
ShapeDefinition random_shape(Random& random) {
    const double size = std::pow(10, random.between(-2, 0.5));
    const double thin = size * std::pow(10, random.between(-2, 0));
    switch (random.below(7)) {
        case 0:
            return BoxShape{{size, thin, size * 0.7}};
        case 1:
            return SphereShape{size};
        case 2:
            return CylinderShape{size, thin};
        case 3:
            return ConeShape{size, thin};
        case 4:
            return CapsuleShape{thin, size};
        case 5:
            return CompoundShape{{{BoxShape{{size, thin, thin}}, {}},
                                  {BoxShape{{thin, size, thin}}, {{size - thin, size + thin, 0}, {}}},
                                  {BoxShape{{thin, size, thin}}, {{-size + thin, size + thin, 0}, {}}}}};
        default:
            return random_hull(random, size);
    }
}

struct Broken {
    std::vector<ConvexCell> solids;
    Split split;
};

Broken break_at_random(std::uint64_t seed) {
    Random random(seed);
    Broken broken{cells_of(random_shape(random)).value(), {}};
    const Bounds box = broken.solids.front().bounds();
    const Vec3 place = box.center() + scale(box.half_extents(), random_point(random, 1));
    const int count = 2 + static_cast<int>(random.below(30));
    broken.split = split_solid(broken.solids, choose_seeds(broken.solids, place, count, random));
    return broken;
}

geometry::MassProperties sum_of(const std::vector<geometry::MassProperties>& solids) {
    geometry::MassProperties sum = solids.front();
    for (std::size_t i = 1; i < solids.size(); ++i) sum = geometry::combined(sum, solids[i]);
    return sum;
}

// Whether something of the hull of `a` is deeper inside that of `b` than `depth` (m).
bool are_overlapping(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double depth) {
    ConvexCell common = cells_of(HullShape{a}).value().front();
    const auto hull = geometry::build_convex_hull(b).value();
    for (const auto& face : hull.faces) common.cut({face.normal, face.offset - depth}, 0);
    return !common.is_empty();
}

TEST(SplitSolid, PiecesAddUpToTheWhole) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        const Broken broken = break_at_random(seed);
        std::vector<geometry::MassProperties> wholes, pieces;
        for (const ConvexCell& solid : broken.solids) wholes.push_back(solid.mass_properties());
        for (const Piece& piece : broken.split.pieces) pieces.push_back(piece.solid);
        ASSERT_FALSE(pieces.empty()) << seed;
        const auto whole = sum_of(wholes), sum = sum_of(pieces);
        const Bounds box = broken.solids.front().bounds();
        const double size = length(box.size());
        worst = std::max(worst, std::fabs(sum.volume / whole.volume - 1));
        EXPECT_LT(length(sum.center - whole.center), 1e-9 * size) << seed;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LT(length(sum.inertia.column(axis) - whole.inertia.column(axis)), 1e-9 * trace(whole.inertia))
                << seed;
    }
    RecordProperty("volume_error", std::to_string(worst));
    EXPECT_LT(worst, 1e-9);
}

TEST(SplitSolid, NoPieceIsInsideAnother) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        const Broken broken = break_at_random(seed);
        const Bounds box = broken.solids.front().bounds();
        const auto& pieces = broken.split.pieces;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                for (const auto& a : pieces[i].hulls)
                    for (const auto& b : pieces[j].hulls)
                        ASSERT_FALSE(are_overlapping(a, b, 1e-6 * length(box.size())))
                            << seed << ": " << i << ", " << j;
            }
        }
    }
}

TEST(SplitSolid, EqualInputsGiveEqualBits) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        const Broken once = break_at_random(seed), again = break_at_random(seed);
        ASSERT_EQ(once.split.pieces.size(), again.split.pieces.size());
        EXPECT_EQ(once.split.crack_area, again.split.crack_area);
        for (std::size_t i = 0; i < once.split.pieces.size(); ++i)
            EXPECT_EQ(once.split.pieces[i].hulls, again.split.pieces[i].hulls);
    }
}

// A cube of 2 m cut by one plane half way: 4 m² of crack, 4 m³ each.
TEST(SplitSolid, CountsACrackOnce) {
    const auto cube = cells_of(BoxShape{{1, 1, 1}}).value();
    const std::vector<Vec3> seeds{{-0.5, 0, 0}, {0.5, 0, 0}};
    const Split split = split_solid(cube, seeds);
    ASSERT_EQ(split.pieces.size(), 2u);
    EXPECT_NEAR(split.crack_area, 4, 1e-12);
    for (const Piece& piece : split.pieces) EXPECT_NEAR(piece.solid.volume, 4, 1e-12);
}

// A corner of 5e-6 m³ of a cube of 8 is no piece: the rest carries it.
TEST(SplitSolid, DustIsNoPiece) {
    const auto cube = cells_of(BoxShape{{1, 1, 1}}).value();
    const Split split = split_solid(cube, std::vector<Vec3>{{0.98, 0.98, 0.98}, {1, 1, 1}});
    ASSERT_EQ(split.pieces.size(), 1u);
    EXPECT_NEAR(split.pieces[0].solid.volume, 8, 1e-12);
}

// Cut along its diagonal a cube becomes two prisms of six corners, however it is turned: rounding makes no others.
TEST(SplitSolid, ACutThroughCornersAddsNone) {
    Random random(4);
    for (int run = 0; run < 50; ++run) {
        const Quat turn = from_axis_angle(normalized(random_point(random, 1)), random.between(0, 3));
        HullShape cube;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 at{corner & 1 ? 0.1 : -0.1, corner & 2 ? 0.1 : -0.1, corner & 4 ? 0.1 : -0.1};
            cube.points.push_back(rotate(turn, at));
        }
        const std::vector<Vec3> seeds{rotate(turn, {0.05, -0.05, 0}), rotate(turn, {-0.05, 0.05, 0})};
        const Split split = split_solid(cells_of(cube).value(), seeds);
        ASSERT_EQ(split.pieces.size(), 2u);
        for (const Piece& piece : split.pieces) EXPECT_EQ(piece.hulls.at(0).size(), 6u) << run;
    }
}

// A table whose top is one cell's: its legs, cut off from each other, are pieces of their own.
TEST(SplitSolid, WhatIsNotConnectedInACellIsSeparatePieces) {
    CompoundShape table{{{BoxShape{{1, 0.1, 0.1}}, {{0, 1.1, 0}, {}}},
                         {BoxShape{{0.1, 0.5, 0.1}}, {{-0.9, 0.5, 0}, {}}},
                         {BoxShape{{0.1, 0.5, 0.1}}, {{0.9, 0.5, 0}, {}}}}};
    const auto solids = cells_of(table).value();
    const Split split = split_solid(solids, std::vector<Vec3>{{0, 1.5, 0}, {0, 0, 0}});
    ASSERT_EQ(split.pieces.size(), 3u);
    EXPECT_EQ(split.pieces[0].hulls.size(), 3u) << "the top with the upper ends of both legs";
    EXPECT_EQ(split.pieces[1].hulls.size(), 1u);
    EXPECT_EQ(split.pieces[2].hulls.size(), 1u);
}

// What is round is cut as its hull, which is a little smaller.
TEST(SplitSolid, RoundShapesLoseLittle) {
    for (const ShapeDefinition& shape :
         {ShapeDefinition{SphereShape{0.3}}, ShapeDefinition{CylinderShape{0.3, 0.01}},
          ShapeDefinition{CapsuleShape{0.1, 0.2}}, ShapeDefinition{ConeShape{0.2, 0.2}}}) {
        const double whole = mass_properties(shape)->volume;
        const double cut = cells_of(shape).value().front().mass_properties().volume;
        EXPECT_LT(cut, whole);
        EXPECT_GT(cut, 0.95 * whole) << shape_name(shape);
    }
}

TEST(SplitSolid, ShapesWithoutAnInsideAreRefused) {
    for (const ShapeDefinition& shape :
         {ShapeDefinition{PlaneShape{}}, ShapeDefinition{HeightfieldShape{2, 2, 1, 1, {0, 0, 0, 0}}},
          ShapeDefinition{MeshShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}}}) {
        const auto cells = cells_of(shape);
        ASSERT_FALSE(cells.ok());
        EXPECT_EQ(cells.error().where, "shape");
    }
}

TEST(ConvexCell, HalvesAddUpAndShareTheirCut) {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const auto whole = cells_of(random_hull(random, 1)).value().front();
        const Vec3 normal = normalized(random_point(random, 1), {0, 1, 0});
        const double offset = random.between(-0.8, 0.8);
        ConvexCell below = whole, above = whole;
        below.cut({normal, offset}, 1e-12);
        above.cut({-normal, -offset}, 1e-12);
        EXPECT_NEAR(below.mass_properties().volume + above.mass_properties().volume, whole.mass_properties().volume,
                    1e-11);
        EXPECT_NEAR(below.cut_area(), above.cut_area(), 1e-11);
    }
}

}  // namespace
}  // namespace embody::physics::fracture
