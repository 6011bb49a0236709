// SPDX-License-Identifier: MIT
// Contacts whose place, depth and direction follow from the drawing.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

TEST(ContactPairs, spheres_touch_on_the_line_of_their_centres) {
    const auto a = make_shape(SphereShape{1}), b = make_shape(SphereShape{0.5});
    const auto manifolds = contacts(*a, {{0, 0, 0}, {}}, *b, {{0, 1.4, 0}, {}}, 0);
    ASSERT_EQ(manifolds.size(), 1u);
    ASSERT_EQ(manifolds[0].count, 1);
    EXPECT_NEAR(manifolds[0].points[0].separation, -0.1, 1e-14);
    EXPECT_NEAR(manifolds[0].normal.y, 1, 1e-15);
    EXPECT_NEAR(manifolds[0].points[0].position.y, 0.95, 1e-14);
}

TEST(ContactPairs, concentric_spheres_still_have_a_unit_normal) {
    const auto a = make_shape(SphereShape{1});
    const auto manifolds = contacts(*a, {}, *a, {}, 0);
    ASSERT_EQ(manifolds.size(), 1u);
    EXPECT_NEAR(length(manifolds[0].normal), 1, 1e-12);
    EXPECT_NEAR(manifolds[0].points[0].separation, -2, 1e-12);
}

TEST(ContactPairs, nothing_touches_beyond_the_margin) {
    const auto a = make_shape(SphereShape{1}), box = make_shape(BoxShape{});
    EXPECT_TRUE(contacts(*a, {}, *box, {{1.52, 0, 0}, {}}, 0.01).empty());
    EXPECT_EQ(contacts(*a, {}, *box, {{1.509, 0, 0}, {}}, 0.01).size(), 1u);
}

TEST(ContactPairs, caps_meet_in_the_common_part_of_two_discs) {
    // Two discs of radius 0.5 whose centres are 0.6 m apart: the lens is 0.4 m wide and 0.8 m long.
    const auto cylinder = make_shape(CylinderShape{0.5, 0.5});
    const auto manifolds = contacts(*cylinder, {}, *cylinder, {{0.6, 0.999, 0}, {}}, 0);
    ASSERT_EQ(manifolds.size(), 1u);
    ASSERT_EQ(manifolds[0].count, 4);
    const Vec3 corners[] = {{0.1, 0, 0}, {0.5, 0, 0}, {0.3, 0, 0.4}, {0.3, 0, -0.4}};
    for (const Vec3& corner : corners) {
        double nearest = HUGE_VAL;
        for (const ManifoldPoint& p : manifolds[0].points) {
            nearest = std::min(nearest, distance(p.position, corner + Vec3{0, 0.4995, 0}));
        }
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(ContactPairs, a_cap_over_a_boxs_edge_keeps_its_whole_rim) {
    // All corners of the common part lie on the rim: two of them on the edge, 0.2 m from the axis.
    const auto box = make_shape(BoxShape{{0.5, 0.5, 0.5}}), cylinder = make_shape(CylinderShape{0.4, 0.3});
    const auto manifolds = contacts(*box, {}, *cylinder, {{0.3, 0.799, 0}, {}}, 0);
    ASSERT_EQ(manifolds.size(), 1u);
    ASSERT_EQ(manifolds[0].count, 4);
    double farthest = 0;
    for (const ManifoldPoint& p : manifolds[0].points) {
        EXPECT_NEAR(std::hypot(p.position.x - 0.3, p.position.z), 0.4, 1e-12);
        EXPECT_NEAR(p.separation, -0.001, 1e-12);
        farthest = std::max(farthest, p.position.x);
    }
    EXPECT_NEAR(farthest, 0.5, 1e-12);
}

// Every solid lying on a plane and on a big box: the corners of its region.
struct Standing {
    const char* name;
    ShapeDefinition shape;
    Quat rotation;
    double height;  ///< of the origin over the ground when touching
    int corners;    ///< of the contact region
    double reach;   ///< largest distance between two of them, m
};

class StandingOn : public testing::TestWithParam<Standing> {};

TEST_P(StandingOn, touches_with_its_whole_face) {
    const Standing& s = GetParam();
    const auto solid = make_shape(s.shape);
    const auto plane = make_shape(PlaneShape{});
    const auto slab = make_shape(BoxShape{{5, 0.5, 5}});
    const auto hull = make_shape(HullShape{corner_points({5, 0.5, 5})});
    const auto mesh = make_shape(flat_mesh(4, 2.5, {-5, 0, -5}));
    const auto field = make_shape(HeightfieldShape{9, 9, 1.25, 1.25, std::vector<float>(81, 0.0F)});
    struct Ground {
        const char* name;
        const CollisionShape* shape;
        Transform pose;
    };
    const Ground grounds[] = {{"plane", plane.get(), {}},
                              {"box", slab.get(), {{0, -0.5, 0}, {}}},
                              {"hull", hull.get(), {{0, -0.5, 0}, {}}},
                              {"mesh", mesh.get(), {}},
                              {"heightfield", field.get(), {{-5, 0, -5}, {}}}};
    for (const double gap : {-0.002, 0.0, 0.003}) {
        for (const Ground& ground : grounds) {
            SCOPED_TRACE(std::string(s.name) + " on " + ground.name + ", gap " + std::to_string(gap));
            const Transform pose{{0.13, s.height + gap, -0.21}, s.rotation};
            const auto manifolds = contacts(*ground.shape, ground.pose, *solid, pose, 0.01);
            ASSERT_EQ(manifolds.size(), 1u);
            const Manifold& m = manifolds[0];
            EXPECT_EQ(m.count, s.corners);
            EXPECT_LT(distance(m.normal, {0, 1, 0}), 1e-12);
            double reach = 0;
            for (int i = 0; i < m.count; ++i) {
                EXPECT_NEAR(m.points[static_cast<std::size_t>(i)].separation, gap, 1e-9);
                EXPECT_NEAR(m.points[static_cast<std::size_t>(i)].position.y, gap / 2, 1e-9);
                for (int j = 0; j < i; ++j) {
                    reach = std::max(reach, distance(m.points[static_cast<std::size_t>(i)].position,
                                                     m.points[static_cast<std::size_t>(j)].position));
                }
            }
            EXPECT_NEAR(reach, s.reach, 0.02 * s.reach + 1e-9);
        }
    }
}

const Quat lying = from_axis_angle({0, 0, 1}, 1.5707963267948966);
const double cone_half_angle = std::atan2(0.5, 1.0);
INSTANTIATE_TEST_SUITE_P(
    AllSolids, StandingOn,
    testing::Values(Standing{"sphere", SphereShape{0.5}, {}, 0.5, 1, 0},
                    Standing{"box", BoxShape{{0.5, 0.25, 0.5}}, {}, 0.25, 4, std::sqrt(2.0)},
                    Standing{"hull", HullShape{corner_points({0.5, 0.25, 0.5})}, {}, 0.25, 4, std::sqrt(2.0)},
                    Standing{"lying capsule", CapsuleShape{0.25, 0.5}, lying, 0.25, 2, 1},
                    Standing{"standing capsule", CapsuleShape{0.25, 0.5}, {}, 0.75, 1, 0},
                    Standing{"standing cylinder", CylinderShape{0.5, 0.5}, {}, 0.5, 4, 1},
                    Standing{"lying cylinder", CylinderShape{0.5, 0.5}, lying, 0.5, 2, 1},
                    Standing{"standing cone", ConeShape{0.5, 0.5}, {}, 0.5, 4, 1},
                    Standing{"lying cone", ConeShape{0.5, 0.5},
                             from_axis_angle({0, 0, 1}, 1.5707963267948966 + cone_half_angle),
                             0.5 * std::sin(cone_half_angle), 2, std::sqrt(1.25)}),
    [](const auto& chosen) {
        std::string name = chosen.param.name;
        std::replace(name.begin(), name.end(), ' ', '_');
        return name;
    });

}  // namespace
}  // namespace embody::physics::collision
