// SPDX-License-Identifier: MIT
// What shapes weigh, beside counts of points inside them, and beside what the solver makes of them.
#include "physics/definitions/mass_properties.h"
#include "make_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "foundation/random.h"
#include "physics/definitions/shape_bounds.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

using geometry::MassProperties;

const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}};

// Eight corners, each triangle counter-clockwise from outside.
MeshShape box_of_triangles(Vec3 half) {
    MeshShape mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(to_vec3f(scale(half, {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0})));
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

HullShape box_of_points(Vec3 half, Vec3 center = {}) {
    HullShape hull;
    for (const Vec3f corner : box_of_triangles({1, 1, 1}).positions)
        hull.points.push_back(center + scale(half, to_vec3(corner)));
    return hull;
}

double difference(const MassProperties& a, const MassProperties& b) {
    double largest = std::fabs(a.volume - b.volume) / b.volume;
    const double size = std::cbrt(b.volume);
    largest = std::max(largest, distance(a.center, b.center) / size);
    for (int k = 0; k < 3; ++k)
        largest = std::max(largest, distance(a.inertia.column(k), b.inertia.column(k)) / trace(b.inertia));
    return largest;
}

TEST(ShapeMass, RefusesWhatIsNoShapeByField) {
    struct Wrong {
        ShapeDefinition shape;
        const char* where;
    };
    const Wrong wrongs[] = {{SphereShape{0}, "radius"},
                            {BoxShape{{1, -1, 1}}, "half_extents.y"},
                            {ConeShape{1, std::numeric_limits<double>::quiet_NaN()}, "half_height"},
                            {HullShape{{{0, 0, 0}, {1, 0, 0}}}, "points"},
                            {HullShape{flat}, "points"},
                            {CompoundShape{}, "children"},
                            {CompoundShape{{{SphereShape{1}, {}}, {HullShape{flat}, {}}}}, "children[1].points"}};
    for (const Wrong& wrong : wrongs) {
        const auto mass = mass_properties(wrong.shape);
        ASSERT_FALSE(mass.ok()) << wrong.where;
        EXPECT_EQ(mass.error().where, wrong.where);
    }
}

TEST(ShapeMass, OfWhatEnclosesNothingIsZero) {
    const MeshShape sheet{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}};
    for (const ShapeDefinition& shape :
         {ShapeDefinition{PlaneShape{}}, ShapeDefinition{HeightfieldShape{2, 2, 1, 1, {0, 1, 2, 3}}},
          ShapeDefinition{sheet}}) {
        const auto mass = mass_properties(shape);
        ASSERT_TRUE(mass.ok()) << shape_name(shape);
        EXPECT_EQ(mass->volume, 0) << shape_name(shape);
        EXPECT_FALSE(body_mass({.density = 1000}, *mass).ok()) << shape_name(shape);
    }
}

// The sums over the middles of small cubes inside.
MassProperties counted(const Bounds& bounds, const std::function<bool(Vec3)>& is_inside) {
    constexpr int count = 60;
    const Vec3 cell = bounds.size() / count;
    const double volume = cell.x * cell.y * cell.z;
    MassProperties sum;
    Vec3 first;
    Mat3 second = Mat3::zero();
    for (int i = 0; i < count * count * count; ++i) {
        const Vec3 steps{i % count + 0.5, i / count % count + 0.5, i / (count * count) + 0.5};
        const Vec3 point = bounds.lower + scale(cell, steps);
        if (!is_inside(point)) continue;
        sum.volume += volume;
        first += point * volume;
        second += outer(point, point) * volume;
    }
    sum.center = first / sum.volume;
    const Mat3 central = second - outer(sum.center, sum.center) * sum.volume;
    sum.inertia = Mat3::identity() * trace(central) - central;
    return sum;
}

TEST(ShapeMass, OfRoundShapesIsThatOfThePointsInside) {
    Random random(7);
    for (int i = 0; i < 8; ++i) {
        const double r = random.between(0.1, 2), h = random.between(0.1, 2);
        const auto flat_distance = [](Vec3 p) { return std::sqrt(p.x * p.x + p.z * p.z); };
        const auto compare = [&](const ShapeDefinition& shape, const std::function<bool(Vec3)>& is_inside) {
            EXPECT_LT(difference(*mass_properties(shape), counted(bounds_of(shape), is_inside)), 0.01)
                << shape_name(shape) << " " << r << " " << h;
        };
        compare(SphereShape{r}, [&](Vec3 p) { return length(p) <= r; });
        compare(CylinderShape{r, h}, [&](Vec3 p) { return flat_distance(p) <= r; });
        compare(CapsuleShape{r, h}, [&](Vec3 p) { return length(p - Vec3{0, std::clamp(p.y, -h, h), 0}) <= r; });
        compare(ConeShape{r, h}, [&](Vec3 p) { return flat_distance(p) <= r * (h - p.y) / (2 * h); });
    }
}

// A box said in five ways.
TEST(ShapeMass, OfABoxIsTheSameAsOfItsPointsTrianglesAndParts) {
    Random random(8);
    for (int i = 0; i < 50; ++i) {
        const Vec3 half{random.between(0.01, 3), random.between(0.01, 3), random.between(0.01, 3)};
        const Vec3 size = 2.0 * half;
        const double volume = size.x * size.y * size.z;
        const Vec3 squares = scale(size, size) * (volume / 12);
        const MassProperties expected{
            volume, {}, Mat3::diagonal({squares.y + squares.z, squares.x + squares.z, squares.x + squares.y})};
        const Vec3 part{half.x / 2, half.y, half.z};
        const CompoundShape halves{
            {{BoxShape{part}, {{part.x, 0, 0}, {}}}, {box_of_points(part), {{-part.x, 0, 0}, {0, 1, 0, 0}}}}};
        EXPECT_LT(difference(*mass_properties(ShapeDefinition{BoxShape{half}}), expected), 1e-14);
        EXPECT_LT(difference(*mass_properties(ShapeDefinition{box_of_points(half)}), expected), 1e-13);
        EXPECT_LT(difference(*mass_properties(ShapeDefinition{halves}), expected), 1e-13);
        EXPECT_LT(difference(*mass_properties(ShapeDefinition{box_of_triangles(half)}), expected), 1e-6) << "floats";
        const Vec3 aside{5, -3, 2};
        MassProperties moved = expected;
        moved.center = aside;
        EXPECT_LT(difference(*mass_properties(ShapeDefinition{box_of_points(half, aside)}), moved), 1e-11);
    }
}

std::vector<ShapeDefinition> random_shapes(Random& random) {
    const auto size = [&] { return random.between(0.02, 2); };
    const auto place = [&]() -> Transform {
        return {{size(), size(), size()}, normalized(Quat{size() - 1, size() - 1, size() - 1, 1})};
    };
    HullShape cloud;
    for (int i = 0; i < 30; ++i) cloud.points.push_back({size(), size(), size()});
    const CompoundShape all{{{SphereShape{size()}, place()},
                             {BoxShape{{size(), size(), size()}}, place()},
                             {CapsuleShape{size(), size()}, place()},
                             {CylinderShape{size(), size()}, place()},
                             {ConeShape{size(), size()}, place()},
                             {cloud, place()}}};
    return {SphereShape{size()},
            BoxShape{{size(), size(), size()}},
            CapsuleShape{size(), size()},
            CylinderShape{size(), size()},
            ConeShape{size(), size()},
            cloud,
            all};
}

TEST(ShapeMass, AndBoundsAreThoseOfTheSolverToTheLastBit) {
    Random random(9);
    for (int i = 0; i < 20; ++i) {
        for (const ShapeDefinition& shape : random_shapes(random)) {
            SCOPED_TRACE(shape_name(shape));
            auto world = make_world();
            const auto handle = world->create_shape(shape);
            ASSERT_TRUE(handle.ok()) << handle.error().message();
            MassDefinition asked{.density = random.between(1, 20000)};
            if (i % 3 == 1) asked.mass = random.between(0.1, 100);
            if (i % 4 == 1) asked.center_of_mass = Vec3{0.1, 0.2, 0.3};
            const auto body = world->create_body({.shape = handle.value(), .mass = asked});
            ASSERT_TRUE(body.ok()) << body.error().message();
            const auto solid = mass_properties(shape);
            ASSERT_TRUE(solid.ok());
            EXPECT_EQ(world->volume(handle.value()), solid->volume);
            const auto expected = body_mass(asked, *solid);
            ASSERT_TRUE(expected.ok());
            EXPECT_EQ(world->mass(body.value()), expected->mass);
            EXPECT_EQ(world->center_of_mass(body.value()), expected->center);
            EXPECT_EQ(world->inertia(body.value()), expected->inertia);
            // Those of the solver are of what it stores; both are the smallest box.
            const Bounds own = bounds_of(shape), known = world->bounds(body.value());
            EXPECT_LT(distance(own.lower, known.lower) + distance(own.upper, known.upper), 1e-12 * length(own.size()));
        }
    }
}

TEST(ShapeBounds, OfWhatHasNoInside) {
    EXPECT_TRUE(bounds_of(PlaneShape{}).is_empty());
    const Bounds field = bounds_of(HeightfieldShape{3, 2, 0.5, 2, {0, 1, 2, -3, 4, 5}});
    EXPECT_EQ(field.lower, (Vec3{0, -3, 0}));
    EXPECT_EQ(field.upper, (Vec3{1, 5, 2}));
    EXPECT_EQ(bounds_of(box_of_triangles({1, 2, 4})).size(), (Vec3{2, 4, 8}));
}

}  // namespace
}  // namespace embody::physics
