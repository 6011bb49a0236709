// SPDX-License-Identifier: MIT
// Friction and restitution by pair of surfaces.
#include "physics/definitions/surface_pairs.h"
#include "make_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "physics/inter/world.h"

namespace embody::physics {
namespace {

constexpr SurfaceId wood = 1, ice = 2, rubber = 3;
constexpr double g = 9.81;

SurfacePairs sample_pairs() {
    SurfacePairs pairs;
    EXPECT_TRUE(pairs.set(wood, ice, {0.1, 0.05, 0.2}).ok());
    EXPECT_TRUE(pairs.set(wood, wood, {0.5, 0.35, 0.6}).ok());
    return pairs;
}

Material of(SurfaceId surface) {
    return {.friction_static = 0.9,
            .friction_dynamic = 0.8,
            .restitution = 0.1,
            .surface = surface,
            .friction_combine = CombineRule::pair_table,
            .restitution_combine = CombineRule::pair_table};
}

TEST(SurfacePairs, AreSymmetricAndRefuseBadNumbers) {
    SurfacePairs pairs = sample_pairs();
    ASSERT_NE(pairs.find(ice, wood), nullptr);
    EXPECT_EQ(pairs.find(ice, wood), pairs.find(wood, ice));
    EXPECT_EQ(pairs.find(ice, wood)->friction_dynamic, 0.05);
    EXPECT_EQ(pairs.find(ice, ice), nullptr);
    EXPECT_EQ(pairs.find(0, wood), nullptr);
    EXPECT_EQ(pairs.find(255, 255), nullptr);

    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(pairs.set(0, wood, {}).error().where, "surface");
    EXPECT_EQ(pairs.set(wood, wood, {nan, 0.1, 0}).error().where, "friction_static");
    EXPECT_EQ(pairs.set(wood, wood, {0.1, 0.2, 0}).error().where, "friction_static");
    EXPECT_EQ(pairs.set(wood, wood, {0.1, -0.2, 0}).error().where, "friction_dynamic");
    EXPECT_EQ(pairs.set(wood, wood, {0.1, 0.1, 1.5}).error().where, "restitution");
    EXPECT_EQ(pairs.find(wood, wood)->friction_static, 0.5) << "what is refused changes nothing";
    EXPECT_TRUE(pairs.set(255, 255, {}).ok());
}

TEST(SurfacePairs, TheTableIsUsedWhereBothMaterialsChooseIt) {
    const SurfacePairs pairs = sample_pairs();
    const Material known = combine(of(wood), of(ice), pairs);
    EXPECT_EQ(known.friction_static, 0.1);
    EXPECT_EQ(known.friction_dynamic, 0.05);
    EXPECT_EQ(known.restitution, 0.2);

    // What the table does not know: geometric mean and the larger.
    Material other = of(rubber);
    other.friction_static = other.friction_dynamic = 0.4;
    other.restitution = 0.7;
    const Material unknown = combine(of(wood), other, pairs);
    EXPECT_DOUBLE_EQ(unknown.friction_dynamic, std::sqrt(0.8 * 0.4));
    EXPECT_EQ(unknown.restitution, 0.7);

    // A rule of one of the two goes before the table, each for its own coefficient.
    Material own = of(ice);
    own.friction_combine = CombineRule::minimum;
    EXPECT_EQ(combine(of(wood), own, pairs).friction_dynamic, 0.8);
    EXPECT_EQ(combine(of(wood), own, pairs).restitution, 0.2);
    EXPECT_EQ(combine(own, of(wood), pairs).friction_dynamic, combine(of(wood), own, pairs).friction_dynamic);

    // A number of one's own counts alone; of two, their geometric mean.
    Material dead = of(wood), lively = of(ice);
    dead.restitution_combine = lively.restitution_combine = CombineRule::own;
    dead.restitution = 0.1;
    lively.restitution = 0.9;
    EXPECT_EQ(combine(dead, of(wood), pairs).restitution, 0.1);
    EXPECT_EQ(combine(of(wood), dead, pairs).restitution, 0.1);
    EXPECT_EQ(combine(of(ice), lively, pairs).restitution, 0.9);
    EXPECT_DOUBLE_EQ(combine(dead, lively, pairs).restitution, 0.3);
}

// A box that slides on a floor stops after v² / (2 μ g), with the μ of the pair.
TEST(SurfacePairs, ASlidingBoxStopsWhereThePairSays) {
    auto world = make_world();
    ASSERT_TRUE(world->set_surface_pairs(sample_pairs()).ok());
    const auto plane = world->create_shape(PlaneShape{{0, 1, 0}, 0});
    const auto box = world->create_shape(BoxShape{{0.2, 0.1, 0.2}});
    ASSERT_TRUE(plane.ok() && box.ok());
    BodyDefinition floor{.kind = BodyKind::static_body, .shape = *plane};
    floor.material = of(wood);
    ASSERT_TRUE(world->create_body(floor).ok());
    BodyDefinition sliding{.shape = *box, .position = {0, 0.1, 0}, .linear_velocity = {3, 0, 0}};
    sliding.material = of(wood);
    const auto body = world->create_body(sliding);
    ASSERT_TRUE(body.ok());
    EXPECT_FALSE(world->set_surface_pairs({}).ok()) << "not under the feet of bodies";

    for (int i = 0; i < 180; ++i) world->step();
    EXPECT_NEAR(world->pose(*body).position.x, 3 * 3 / (2 * 0.35 * g), 0.02);
    EXPECT_EQ(world->linear_velocity(*body), Vec3{});
}

}  // namespace
}  // namespace embody::physics
