// SPDX-License-Identifier: MIT
//
// The hull of a real bed whose merged faces are planar to a micrometre only: an edge pair once claimed a gap of more
// than the margin where the bed lay on the floor, and it fell through.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/collision/shapes/collision_shape.h"

namespace embody::physics::collision {
namespace {

const HullShape bed{{{-0.5254526734352112, 0.6372571587562561, -0.9890000224113464},
                     {-0.5254531502723694, 5.998987830935221e-07, -0.9889994859695435},
                     {-0.5229411125183105, 0.6466285586357117, -0.9889960885047913},
                     {-0.5160794854164124, 0.6534888744354248, -0.9889854192733765},
                     {-0.5067063570022583, 0.6559998989105225, -0.988970935344696},
                     {0.41602227091789246, 0.655999481678009, -0.9880133867263794},
                     {0.5097537636756897, 0.6559993624687195, -0.9878683090209961},
                     {0.5259884595870972, 0.6466279625892639, -0.9878431558609009},
                     {0.5285000205039978, 0.6372565031051636, -0.9878392815589905},
                     {0.519126832485199, 0.6534883975982666, -0.9878537654876709},
                     {0.5284994840621948, 0.0, -0.9878387451171875},
                     {-0.5254817008972168, 0.6372571587562561, -0.9702532291412354},
                     {-0.5229701399803162, 0.6466285586357117, -0.970249354839325},
                     {-0.516108512878418, 0.6534889936447144, -0.9702386856079102},
                     {-0.5067353844642639, 0.656000018119812, -0.970224142074585},
                     {-0.41300395131111145, 0.6559998989105225, -0.9700791239738464},
                     {0.5097247362136841, 0.6559993624687195, -0.969121515750885},
                     {0.5284709930419922, 0.6372565031051636, -0.9690925478935242},
                     {0.5259594321250916, 0.6466279625892639, -0.9690964221954346},
                     {0.5190978646278381, 0.6534883975982666, -0.9691070318222046},
                     {0.4160217344760895, 8.998478051580605e-08, -0.9880128502845764},
                     {-0.5285000205039978, 2.1796322471345775e-06, 0.9878392815589905},
                     {-0.5284996628761292, 0.4498303234577179, 0.9878389239311218},
                     {-0.5097532868385315, 0.46857312321662903, 0.9878678917884827},
                     {-0.5191264748573303, 0.46606209874153137, 0.9878534078598022},
                     {-0.5259881019592285, 0.45920175313949585, 0.9878427982330322},
                     {0.5067066550254822, 0.46857255697250366, 0.9889705777168274},
                     {-0.4347681701183319, 0.46857309341430664, 0.9879839420318604},
                     {0.516079843044281, 0.4660615026950836, 0.9889850616455078},
                     {0.5229414105415344, 0.4592011570930481, 0.9889957308769226},
                     {0.5254529714584351, 0.44982972741127014, 0.988999605178833},
                     {0.5254526138305664, 1.5797334071976366e-06, 0.9890000224113464},
                     {-0.43476855754852295, 2.0996458260924555e-06, 0.9879843592643738},
                     {-0.526783287525177, 0.23911119997501373, -0.539566695690155}}};

TEST(HullOnFloor, ATiltOfMergedFacesIsNoGap) {
    const auto floor = std::move(*CollisionShape::create(BoxShape{{15, 0.25, 15}}));
    const auto hull = std::move(*CollisionShape::create(bed));
    for (const double x : {0.3, 0.5, 0.54976, 0.55}) {
        for (const double depth : {-0.0001, 0.001, 0.01, 0.1}) {
            std::vector<Manifold> manifolds;
            collide(*floor, {{0, -0.25, 0}, {}}, *hull, {{x, -depth, 0.2}, {}}, 0.01, manifolds);
            ASSERT_EQ(manifolds.size(), 1u) << "at x = " << x << " m, " << depth << " m deep";
            EXPECT_EQ(manifolds[0].count, 4);
            EXPECT_NEAR(manifolds[0].normal.y, 1, 1e-9);
            for (int i = 0; i < manifolds[0].count; ++i)
                EXPECT_NEAR(manifolds[0].points[static_cast<std::size_t>(i)].separation, -depth, 1e-5);
        }
    }
}

// Two corners a foot, the outer one of the hind feet higher. Four points chosen for area took the high outer corner and
// left out the low one beside it: each chair of the furnished room rocked from foot to foot for ever.
TEST(HullOnFloor, EveryFootOfAChairIsSeen) {
    HullShape chair;
    for (const double side : {-1.0, 1.0}) {
        chair.points.push_back({side * 0.199, 0, 0.22});
        chair.points.push_back({side * 0.185, 0, -0.21});       // hind, inner
        chair.points.push_back({side * 0.207, 0.0018, -0.22});  // hind, outer
        chair.points.push_back({side * 0.2, 0.8, -0.25});
        chair.points.push_back({side * 0.2, 0.45, 0.25});
    }
    const auto floor = std::move(*CollisionShape::create(BoxShape{{5, 0.25, 5}}));
    const auto hull = std::move(*CollisionShape::create(chair));

    // Leaning a little to each side.
    for (const double lean : {-1e-3, -3e-4, 0.0, 3e-4, 1e-3}) {
        std::vector<Manifold> manifolds;
        const Quat tilt{0, 0, lean / 2, 1};
        collide(*floor, {{0, -0.25, 0}, {}}, *hull, {{}, normalized(tilt)}, 0.01, manifolds);
        for (const Vec3& foot : {chair.points[0], chair.points[1], chair.points[5], chair.points[6]}) {
            const Vec3 place = rotate(normalized(tilt), foot);
            bool is_seen = false;
            for (const Manifold& manifold : manifolds) {
                for (int i = 0; i < manifold.count; ++i) {
                    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
                    is_seen |= distance(point.position, place) < 2e-3 && std::fabs(point.separation - place.y) < 1e-4;
                }
            }
            EXPECT_TRUE(is_seen) << "the foot at x = " << foot.x << ", z = " << foot.z << ", leaning by " << lean;
        }
    }
}

}  // namespace
}  // namespace embody::physics::collision
