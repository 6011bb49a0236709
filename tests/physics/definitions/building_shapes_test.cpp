// SPDX-License-Identifier: MIT
// Walls and floors: what is left between random openings and mitred ends, by points and by volume.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "geometry/convex_hull.h"
#include "geometry/flat_polygon.h"
#include "math/bounds.h"
#include "physics/definitions/mass_properties.h"
#include "physics/definitions/shape_bounds.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics {
namespace {

using geometry::FlatPoint;
using geometry::FlatPolygon;

/// Half spaces of a convex part.
struct Solid {
    std::vector<std::pair<Vec3, double>> faces;

    explicit Solid(const CompoundChild& part) {
        if (const auto* box = std::get_if<BoxShape>(&part.shape)) {
            for (int k = 0; k < 3; ++k)
                for (const double sign : {-1.0, 1.0}) {
                    Vec3 normal;
                    normal[k] = sign;
                    faces.emplace_back(normal, box->half_extents[k] + sign * part.local.position[k]);
                }
            return;
        }
        const auto hull = geometry::build_convex_hull(std::get<HullShape>(part.shape).points, max_hull_vertices);
        for (const auto& face : hull->faces) faces.emplace_back(face.normal, face.offset);
    }
    [[nodiscard]] double depth(Vec3 p) const {
        double least = 1e9;
        for (const auto& [normal, offset] : faces) least = std::min(least, offset - dot(normal, p));
        return least;
    }
};

bool is_inside(const FlatPolygon& polygon, FlatPoint p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const FlatPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a[1] > p[1]) == (b[1] > p[1])) continue;
        if (p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1])) inside = !inside;
    }
    return inside;
}

WallShape random_wall(Random& random) {
    WallShape wall;
    wall.length = random.between(1, 8);
    wall.height = random.between(2, 4);
    wall.thickness = random.between(0.05, 0.5);
    if (random.below(3) == 0) wall.rise = random.between(-1, 2);
    for (auto* cut : {&wall.start_cut, &wall.end_cut})
        for (double& each : *cut) each = random.below(2) == 0 ? 0 : random.between(-0.3, 0.3);
    const std::uint64_t count = random.below(5);
    for (std::uint64_t i = 0; i < count; ++i) {
        WallOpening opening;
        opening.offset = random.between(-0.5, wall.length);
        opening.width = random.between(0.3, 2);
        opening.height = random.between(0.3, 2.2);
        opening.sill = random.below(2) == 0 ? 0 : random.between(0, 1.5);
        wall.openings.push_back(opening);
    }
    return wall;
}

TEST(Walls, AreSolidWhereNoOpeningIsAndFreeWhereOneIs) {
    Random random(7);
    int tried = 0, solid = 0;
    for (int i = 0; i < 400; ++i) {
        const WallShape wall = random_wall(random);
        if (!validate(wall).ok()) continue;
        std::vector<Solid> parts;
        for (const CompoundChild& part : wall.parts()) parts.emplace_back(part);
        const FlatPolygon footprint = wall.footprint();
        const auto [first, last] = wall.straight_part();
        const Bounds around = bounds_of(wall);
        for (int k = 0; k < 200; ++k) {
            const Vec3 p{random.between(around.lower.x - 0.05, around.upper.x + 0.05),
                         random.between(-0.05, around.upper.y + 0.05),
                         random.between(-0.6 * wall.thickness, 0.6 * wall.thickness)};
            const double top = wall.height + wall.rise * p.x / wall.length;
            const bool is_in_opening =
                std::any_of(wall.openings.begin(), wall.openings.end(), [&](const WallOpening& o) {
                    return p.x > std::max(o.offset, first) && p.x < std::min(o.offset + o.width, last) &&
                           p.y > o.sill && p.y < o.sill + o.height;
                });
            const bool expected = is_inside(footprint, {p.x, p.z}) && p.y > 0 && p.y < top && !is_in_opening;
            int in = 0;
            bool is_near = false;
            for (const Solid& part : parts) {
                const double depth = part.depth(p);
                is_near = is_near || std::fabs(depth) < 2e-3;
                in += depth > 0 ? 1 : 0;
            }
            if (is_near) continue;
            ++tried;
            solid += in;
            ASSERT_EQ(in, expected ? 1 : 0) << "wall " << i << " at " << p.x << " " << p.y << " " << p.z;
        }
    }
    EXPECT_GT(tried, 30000);
    EXPECT_GT(solid, 10000);
}

TEST(Walls, WeighWhatTheirOpeningsLeave) {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        WallShape wall;
        wall.length = random.between(6, 12);
        wall.height = random.between(2.6, 4);
        wall.thickness = random.between(0.05, 0.5);
        for (auto* cut : {&wall.start_cut, &wall.end_cut})
            for (double& each : *cut) each = random.between(0, 0.4);
        wall.rise = random.between(-0.2, 1);
        // The footprint is a rectangle without two triangles at each end, or by way of the tip.
        double volume = 0;
        const FlatPolygon seen = wall.footprint();
        for (std::size_t k = 1; k + 1 < seen.size(); ++k) {
            const double area = std::fabs((seen[k][0] - seen[0][0]) * (seen[k + 1][1] - seen[0][1]) -
                                          (seen[k][1] - seen[0][1]) * (seen[k + 1][0] - seen[0][0])) /
                                2;
            const double x = (seen[0][0] + seen[k][0] + seen[k + 1][0]) / 3;
            volume += area * (wall.height + wall.rise * x / wall.length);
        }
        for (int k = 0; k < 3; ++k) {
            const WallOpening opening{0.8 + 1.8 * k, random.between(0.3, 1.5), random.between(0.5, 1.2),
                                      random.between(0.1, 1)};
            wall.openings.push_back(opening);
            volume -= opening.width * opening.height * wall.thickness;
        }
        const auto mass = mass_properties(wall);
        ASSERT_TRUE(mass.ok()) << mass.error().message();
        EXPECT_NEAR(mass->volume, volume, 1e-6 * volume);
    }
}

TEST(Walls, OfWindowsHavePanes) {
    WallShape wall;
    wall.length = 4;
    wall.openings = {{1, 1, 1, 1, OpeningKind::window}};
    const double glass = 1 * 1 * pane_thickness;
    EXPECT_NEAR(mass_properties(wall)->volume, (4 * 2.5 - 1) * 0.1 + glass, 1e-9);
    EXPECT_EQ(wall.parts().size(), 5U);  // left, right, below, above, and the pane
}

TEST(Walls, RefuseWhatIsNoWall) {
    const auto where = [](const WallShape& wall) {
        const auto valid = validate(wall);
        return valid.ok() ? std::string() : valid.error().where;
    };
    WallShape wall;
    EXPECT_EQ(where(wall), "");
    wall.openings = {{-1, 10, 10, 0}};
    EXPECT_EQ(where(wall), "openings");
    wall.openings = {{0, 1, 1, -1}};
    EXPECT_EQ(where(wall), "openings[0].sill");
    wall.openings = {{std::nan(""), 1, 1, 0}};
    EXPECT_EQ(where(wall), "openings[0].offset");
    wall.openings.clear();
    wall.start_cut = {1.5, 0};
    wall.end_cut = {0, 1.5};
    EXPECT_EQ(where(wall), "end_cut");
    wall = {};
    wall.rise = -2.5;
    EXPECT_EQ(where(wall), "rise");
}

// A star-shaped polygon: simple, with as many corners turned in as out.
SlabShape random_slab(Random& random) {
    SlabShape slab;
    const std::uint64_t corners = 3 + random.below(20);
    for (std::uint64_t i = 0; i < corners; ++i) {
        const double angle =
            2 * std::numbers::pi * (static_cast<double>(i) + random.between(0, 0.7)) / static_cast<double>(corners);
        const double radius = random.between(0.5, 5);
        slab.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    if (random.below(2) == 0) std::reverse(slab.points.begin(), slab.points.end());
    return slab;
}

TEST(Slabs, HaveTheirPolygonsAreaAndNoPartTwice) {
    Random random(3);
    int tried = 0;
    for (int i = 0; i < 300; ++i) {
        const SlabShape slab = random_slab(random);
        if (!validate(slab).ok()) continue;
        double area = 0;
        for (std::size_t k = 0; k < slab.points.size(); ++k) {
            const FlatPoint a = slab.points[k], b = slab.points[(k + 1) % slab.points.size()];
            area += (a[0] * b[1] - a[1] * b[0]) / 2;
        }
        EXPECT_NEAR(mass_properties(slab)->volume, std::fabs(area) * slab.thickness, 1e-6);
        std::vector<Solid> parts;
        for (const CompoundChild& part : slab.parts()) parts.emplace_back(part);
        for (int k = 0; k < 100; ++k) {
            const Vec3 p{random.between(-5, 5), -slab.thickness / 2, random.between(-5, 5)};
            int in = 0;
            bool is_near = false;
            for (const Solid& part : parts) {
                is_near = is_near || std::fabs(part.depth(p)) < 1e-4;
                in += part.depth(p) > 0 ? 1 : 0;
            }
            if (is_near) continue;
            ++tried;
            ASSERT_EQ(in, is_inside(slab.points, {p.x, p.z}) ? 1 : 0) << "slab " << i;
        }
    }
    EXPECT_GT(tried, 15000);
}

// The corridor of a real home: corners nearly in line leave a sliver between the pieces, which is no solid.
TEST(Slabs, HaveNoPartThatIsNoSolid) {
    SlabShape slab{.points = {{0, 0},
                              {0, 0.03775},
                              {-1.0572632, 0.03775},
                              {-1.0572632, 0.277789},
                              {-1.0950132, 0.277789},
                              {-1.0950132, 1.2049887},
                              {-1.0572632, 1.2049887},
                              {-1.0572632, 1.4505145},
                              {-0.9686228, 1.45051},
                              {-0.9647, 1.4969163},
                              {-0.0462375, 1.5043295},
                              {-0.0479074, 1.4504633},
                              {0.0652328, 1.4504575},
                              {4.225237, 1.4502457},
                              {5.687737, 1.4502457},
                              {5.687737, 1.204989},
                              {5.725487, 1.204989},
                              {5.725487, 0.2777893},
                              {5.687737, 0.2777893},
                              {5.682884, 0.03775},
                              {5.169164, 0.03775},
                              {5.169164, 0},
                              {4.241964, 0},
                              {4.241964, 0.03775},
                              {4.041964, 0.03775},
                              {4.041964, 0.0004999},
                              {3.1345263, 0.0004999},
                              {3.1345263, 0.03775},
                              {0.9271997, 0.03775},
                              {0.9271997, 0}},
                   .thickness = 0.12};
    ASSERT_TRUE(validate(slab).ok());
    for (const CompoundChild& part : slab.parts()) {
        const auto* hull = std::get_if<HullShape>(&part.shape);
        if (hull == nullptr) continue;
        const auto built = geometry::build_convex_hull(hull->points, max_hull_vertices);
        ASSERT_TRUE(built) << built.error().message();
    }
    EXPECT_NEAR(mass_properties(slab)->volume, slab.thickness * std::fabs(geometry::signed_area(slab.points)), 1e-5);
}

TEST(Slabs, RefuseWhatCrossesItself) {
    EXPECT_EQ(validate(SlabShape{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.2}).error().where, "points");
    EXPECT_EQ(validate(SlabShape{{{0, 0}, {1, 0}, {2, 0}}, 0.2}).error().where, "points");
    EXPECT_TRUE(validate(SlabShape{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.2}).ok());
}

}  // namespace
}  // namespace embody::physics
