// SPDX-License-Identifier: MIT
// Parts of sheets, ropes and their contacts against plain loops and formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "foundation/random.h"
#include "foundation/task_pool.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/cloth/cloth_mesh.h"
#include "physics/deformable/cloth/patch_tree.h"
#include "physics/deformable/contact/body_features.h"
#include "physics/deformable/contact/box_grid.h"
#include "physics/deformable/contact/free_motion.h"
#include "physics/deformable/contact/node_contacts.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/substep.h"
#include "physics/deformable/contact/tie_springs.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/rope/rope_segment.h"
#include "physics/deformable/test_nodes.h"

namespace embody::physics::deformable {
namespace {

Vec3 any_vector(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

TEST(BoxGrid, WithoutBoxesVisitsNone) {
    BoxGrid grid;
    grid.fill({}, 0.1);
    grid.visit({{-1, -1, -1}, {1, 1, 1}}, [](std::uint32_t) { FAIL(); });
}

TEST(BoxGrid, VisitsAllThatOverlap) {
    Random random(1);
    for (const double reach : {0.3, 2.0, 500.0}) {
        std::vector<Bounds> boxes;
        for (int i = 0; i < 300; ++i) {
            const Vec3 center = any_vector(random, reach);
            boxes.push_back(enlarged(Bounds{center, center}, random.between(0.01, 0.1)));
        }
        BoxGrid grid;
        grid.fill(boxes, 0.1);
        for (int trial = 0; trial < 100; ++trial) {
            const Vec3 center = any_vector(random, reach);
            const Bounds box = enlarged(Bounds{center, center}, random.between(0.01, trial % 10 == 0 ? reach : 0.2));
            std::set<std::uint32_t> visited;
            grid.visit(box, [&](std::uint32_t other) { visited.insert(other); });
            for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                EXPECT_TRUE(!overlaps(box, boxes[i]) || visited.contains(i));
                EXPECT_TRUE(overlaps(enlarged(box, 1e-3), boxes[i]) || !visited.contains(i));
            }
        }
    }
}

TEST(BodyFeatures, LieOnTheirShapes) {
    EXPECT_EQ(find_features(BoxShape{{1, 2, 3}}).size(), 8u);
    for (const BodyFeature& corner : find_features(BoxShape{{1, 2, 3}})) {
        EXPECT_EQ(abs(corner.point), (Vec3{1, 2, 3}));
        EXPECT_EQ(corner.radius, 0);
    }
    ASSERT_EQ(find_features(SphereShape{0.4}).size(), 1u);
    EXPECT_EQ(find_features(SphereShape{0.4})[0].radius, 0.4);
    for (const BodyFeature& end : find_features(CapsuleShape{0.2, 0.5})) {
        EXPECT_LE(std::fabs(end.point.y), 0.5);
        EXPECT_EQ(end.radius, 0.2);
    }
    for (const BodyFeature& point : find_features(CylinderShape{0.2, 0.5})) {
        EXPECT_NEAR(std::hypot(point.point.x, point.point.z), 0.2, 1e-12);
    }
    EXPECT_TRUE(find_features(PlaneShape{}).empty());
    const auto both =
        find_features(CompoundShape{{{SphereShape{0.2}, {{1, 0, 0}, {}}}, {BoxShape{}, {{2, 0, 0}, {}}}}});
    EXPECT_EQ(both.size(), 9u);
}

TEST(FreeMotion, KeepsMomentaAndGivenDisplacements) {
    Random random(2);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Vec3> places, given;
        for (int i = 0; i < 20; ++i) {
            places.push_back(any_vector(random, 1));
            given.push_back(any_vector(random, 0.01));
        }
        Nodes nodes = nodes_at(places);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes.mass[i] = random.between(0.5, 2);
            nodes.mean_velocity[i] = nodes.velocity[i] = any_vector(random, 1);
        }
        constexpr double h = 0.01;
        std::vector<Vec3> moves;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            moves.push_back((nodes.mean_velocity[i] + any_vector(random, 0.2)) * h);
        }
        Vec3 linear, angular, wanted_linear, wanted_angular;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Vec3 p = nodes.mass[i] * nodes.mean_velocity[i] + given[i];
            wanted_linear += p;
            wanted_angular += cross(nodes.position[i], p);
        }
        const FreePart part{&nodes, given, moves};
        keep_momenta(std::span(&part, 1), h, {});
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            linear += nodes.mass[i] * moves[i] / h;
            angular += cross(nodes.position[i], nodes.mass[i] * moves[i] / h);
        }
        EXPECT_LT(length(linear - wanted_linear), 1e-6);
        EXPECT_LT(length(angular - wanted_angular), 0.05 * length(wanted_angular) + 0.05);
        set_velocities(nodes, moves, h);
        for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_LT(length(nodes.mean_velocity[i] - moves[i] / h), 1e-9);
    }
}

TEST(FreeMotion, OfARigidMotionIsThatMotion) {
    Random random(3);
    std::vector<Vec3> places;
    for (int i = 0; i < 20; ++i) places.push_back(any_vector(random, 1));
    Nodes nodes = nodes_at(places, 2);
    Vec3 center;
    for (const Vec3 p : places) center += p / 20;
    const Vec3 velocity{1, 2, 3}, spin{0.5, -1, 2};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes.velocity[i] = nodes.mean_velocity[i] = velocity + cross(spin, places[i] - center);
    }
    const WholeMotion whole = motion_of_whole(nodes);
    EXPECT_LT(length(whole.velocity - velocity), 1e-9);
    EXPECT_LT(length(whole.spin - spin), 1e-6);
}

// Against the places that a point in free fall had h seconds ago.
TEST(FreeMotion, OfTheSubstepBeforeIsThatOfAPoint) {
    constexpr Vec3 gravity{0, -9.81, 0};
    Random random(5);
    for (int trial = 0; trial < 100; ++trial) {
        Nodes nodes = nodes_at({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        std::vector<Vec3> given;
        for (Vec3& velocity : nodes.mean_velocity) given.push_back(velocity = any_vector(random, 3));
        nodes.inverse_mass[0] = 0;
        for (const double h : {random.between(1e-3, 0.02), random.between(1e-3, 0.02)}) {
            change_substep(nodes, h, gravity, true);
            EXPECT_EQ(nodes.mean_velocity[0], given[0]) << "pinned";
            for (std::size_t i : {1, 2})
                EXPECT_LT(length(nodes.mean_velocity[i] - (given[i] - h / 2 * gravity)), 1e-12) << trial;
        }
    }
}

TEST(FreeMotion, OfWhatIsHeldGoesOn) {
    constexpr Vec3 gravity{0, -9.81, 0};
    Nodes nodes = nodes_at({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const auto all_have = [&](Vec3 velocity) {
        return std::ranges::all_of(nodes.mean_velocity, [&](Vec3 v) { return length(v - velocity) < 1e-12; });
    };
    for (const bool is_free : {false, true}) {
        nodes.substep = 0;
        change_substep(nodes, 0.01, gravity, is_free);
        EXPECT_TRUE(all_have({})) << "it may be in balance";
    }
    std::ranges::fill(nodes.mean_velocity, Vec3{1, 2, 3});
    change_substep(nodes, 0.001, gravity, false);
    EXPECT_TRUE(all_have({1, 2, 3})) << "what holds it is not known";
    nodes.substep = 0;
    change_substep(nodes, 0.01, gravity, false);
    EXPECT_TRUE(all_have(Vec3{1, 2, 3} - 0.005 * gravity)) << "it was thrown";
    change_substep(nodes, 0.01, gravity, true);
    EXPECT_TRUE(all_have(Vec3{1, 2, 3} - 0.005 * gravity)) << "of the same length";
}

TEST(TouchedBody, GoesOnItsPathAndByWhatPushesIt) {
    Random random(4);
    for (int trial = 0; trial < 20; ++trial) {
        TouchedBody body;
        body.start_center = any_vector(random, 1);
        body.step_time = 1.0 / 60;
        body.path_velocity = any_vector(random, 2);
        body.inverse_mass = 0.5;
        body.inverse_inertia = Mat3::identity() * 3;
        EXPECT_LT(length(body.center_at(0) - body.start_center), 1e-12);
        EXPECT_LT(length(body.center_at(body.step_time) - body.start_center - body.path_velocity * body.step_time),
                  1e-12);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(length(body.rotation_at(0.01).column(c) - Mat3::identity().column(c)), 1e-12);
        }
        const double h = body.step_time / 2;
        const Vec3 impulse = any_vector(random, 1), arm = any_vector(random, 0.5), before = body.center_at(h);
        body.push(impulse, arm, h);
        EXPECT_LT(length(body.impulse - impulse), 1e-12);
        EXPECT_LT(length(body.angular_impulse - cross(arm, impulse)), 1e-12);
        EXPECT_LT(length(body.velocity - impulse * 0.5), 1e-12);
        EXPECT_LT(length(body.spin - cross(arm, impulse) * 3), 1e-12);
        EXPECT_LT(length(body.center_at(h) - before - body.velocity * h), 1e-12);
        const Vec3 turn = any_vector(random, 1);
        body.push_turn(turn, h);
        EXPECT_LT(length(body.angular_impulse - cross(arm, impulse) - turn), 1e-12);
        // Into the next substep it goes on with what it has.
        const Vec3 shift = body.shift;
        body.enter_substep(h);
        EXPECT_LT(length(body.shift - shift - body.velocity * h), 1e-12);
    }
}

TEST(NodeContacts, AreWithWhatANodeMayReach) {
    TaskPool workers(1);
    const auto box = CollisionShape::create(BoxShape{{1, 0.5, 1}}).value();
    constexpr double radius = 0.01;
    const auto ball = CollisionShape::create(SphereShape{radius}).value();
    std::vector<TouchedBody> bodies(1);
    bodies[0].shape = box.get();
    bodies[0].start_center = bodies[0].start.position = {0, -0.5, 0};
    bodies[0].step_time = 1.0 / 60;
    EXPECT_EQ(displacement_of(bodies[0], 1.0 / 60), 0);
    Nodes nodes = nodes_at({{0, 0.012, 0}, {0, 0.2, 0}, {0.3, 0.2, 0}, {5, 0.01, 0}});
    nodes.velocity[2] = nodes.mean_velocity[2] = {0, -20, 0};
    const std::vector<std::uint32_t> all{0, 1, 2, 3};
    std::vector<NodeContact> contacts;
    find_node_contacts(nodes, all, *ball, radius, bodies, 1.0 / 60, {0, -9.81, 0}, contacts, workers);
    std::vector<std::uint32_t> found;
    for (const NodeContact& contact : contacts) {
        found.push_back(contact.node);
        EXPECT_LT(length(contact.normal - Vec3{0, 1, 0}), 1e-9);
        EXPECT_NEAR(gap(contact, nodes.position[contact.node], radius, bodies[0], 0),
                    nodes.position[contact.node].y - radius, 1e-9);
    }
    EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 2}));  // near, and fast enough
    bodies[0].path_velocity = {0, 3, 0};
    EXPECT_NEAR(displacement_of(bodies[0], 1.0 / 60), 0.05, 0.01);
}

TEST(TouchSprings, UnitMovesAreThoseOfARigidBody) {
    const Vec3 arm{1, 2, 3};
    for (std::size_t c = 0; c < 6; ++c) {
        Vec3 axis;
        axis[static_cast<int>(c % 3)] = 1;
        EXPECT_EQ(unit_move(c, arm), c < 3 ? axis : cross(axis, arm));
    }
    EXPECT_EQ(across({1, 2, 3}, {0, 1, 0}), (Vec3{1, 0, 3}));
    std::vector<TouchedBody> bodies(2);
    bodies[0].inverse_mass = 0.5;
    bodies[0].inverse_inertia = Mat3::identity();
    bodies[1].is_dynamic = false;
    const auto inertias = inertias_of(bodies, 0.1);
    EXPECT_TRUE(inertias[0].moves);
    EXPECT_NEAR(inertias[0].mass, 2 / 0.01, 1e-9);
    EXPECT_FALSE(inertias[1].moves);
    EXPECT_NEAR(energy_of(inertias[0], {{0.1, 0, 0}, {}}), 0.5 * 200 * 0.01, 1e-9);
    EXPECT_GT(contact_stiffness(1, 0, 0.01, 9.81, {}), 0);
    EXPECT_GE(contact_stiffness(1, 100, 0.01, 9.81, {}), contact_stiffness(1, 0, 0.01, 9.81, {}));
}

// A spring's energy falls by its force, whatever its nodes do.
TEST(TouchSprings, ForcesAreMinusTheSlopeOfTheirEnergy) {
    Random random(6);
    for (int trial = 0; trial < 50; ++trial) {
        TouchSpring spring;
        spring.node = {0, 1, 2, 0};
        spring.weight = {0.2, 0.5, 0.3, 0};
        spring.count = 3;
        spring.acts = true;
        const Vec3 n = normalized(any_vector(random, 1));
        spring.normal = n;
        spring.matrix = outer(n, n) * 100 + Mat3::identity() * 10;
        spring.load = any_vector(random, 5);
        std::vector<Vec3> moves{any_vector(random, 0.1), any_vector(random, 0.1), any_vector(random, 0.1)};
        const Vec3 lead = spring.lead(moves, {});
        EXPECT_LT(length(lead - (moves[0] * 0.2 + moves[1] * 0.5 + moves[2] * 0.3)), 1e-12);
        const Vec3 force = spring.force(lead);
        for (std::size_t node = 0; node < 3; ++node) {
            for (int a = 0; a < 3; ++a) {
                constexpr double step = 1e-6;
                const double before = moves[node][a];
                moves[node][a] = before + step;
                const double more = energy_of(spring, moves, {});
                moves[node][a] = before - step;
                const double less = energy_of(spring, moves, {});
                moves[node][a] = before;
                EXPECT_NEAR(-(more - less) / (2 * step), force[a] * spring.weight[node], 1e-4);
            }
        }
    }
}

TEST(TieSprings, PullEquallyAndTogether) {
    Nodes own = nodes_at({{0, 1, 0}}), other = nodes_at({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
    Tie tie;
    tie.node = 0;
    tie.other_nodes = {0, 1, 2};
    tie.weight = {0.5, 0.25, 0.25};
    Vec3 pull;
    const PlacedTie placed{&own, &other, 0, 1, &tie, &pull};
    TieSprings springs;
    springs.begin(std::span(&placed, 1), 0.01, 9.81, {});
    ASSERT_EQ(springs.springs().size(), 1u);
    double sum = 0;
    for (const double weight : springs.springs()[0].weight) sum += weight;
    EXPECT_NEAR(sum, 0, 1e-12);
    const std::vector<Vec3> moves(4);
    springs.finish(moves);
    EXPECT_LT(pull.y, 0);
}

TEST(RopeSegments, DirectionsAndHowTheyChange) {
    Random random(7);
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 edge = any_vector(random, 1);
        const SegmentDirection direction = direction_of(edge, 0.5);
        EXPECT_NEAR(length(direction.displacement), 1, 1e-12);
        for (int a = 0; a < 3; ++a) {
            constexpr double step = 1e-6;
            Vec3 more = edge, less = edge;
            more[a] += step;
            less[a] -= step;
            const Vec3 slope =
                (direction_of(more, 0.5).displacement - direction_of(less, 0.5).displacement) / (2 * step);
            EXPECT_LT(length(direction.by_end.column(a) - slope), 1e-6 / length_squared(edge));
        }
    }
    EXPECT_LT(length(direction_of({1e-9, 0, 0}, 1).displacement), 1e-6);  // next to no length
    const Mat3 damping = damping_of_growth({0.5, 0, 0}, 3);
    EXPECT_NEAR(dot(damping * Vec3{1, 0, 0}, {1, 0, 0}), 3, 1e-9);
    EXPECT_LT(length(damping * Vec3{0, 1, 0}), 0.01);
}

TEST(ClothMesh, DeformationOfALinearMapIsThatMap) {
    const DeformableDefinition sheet = cloth_rectangle(0.4, 0.3, 0.05);
    const auto triangles = make_cloth_triangles(sheet.nodes, std::get<Cloth>(sheet.matter));
    double area = 0;
    for (const ClothTriangle& t : triangles) {
        area += t.area;
        const auto map = [](Vec3 p) { return Vec3{1.1 * p.x + 0.2 * p.z, 0.3 * p.x, 0.9 * p.z}; };
        Vec3 warp, weft;
        for (std::size_t k = 0; k < 3; ++k) {
            warp += map(sheet.nodes[t.node[k]]) * t.warp[k];
            weft += map(sheet.nodes[t.node[k]]) * t.weft[k];
        }
        EXPECT_LT(length(warp - Vec3{1.1, 0.3, 0}), 1e-9);
        EXPECT_NEAR(std::fabs(dot(weft, Vec3{0.2, 0, 0.9})), 0.85, 1e-9);
    }
    EXPECT_NEAR(area, 0.12, 1e-9);
    const ScalarRows rows =
        make_bending_rows(make_bend_elements(sheet.nodes, std::get<Cloth>(sheet.matter)), sheet.nodes.size());
    ASSERT_EQ(rows.start.size(), sheet.nodes.size() + 1);
    for (std::size_t i = 0; i < sheet.nodes.size(); ++i) {
        EXPECT_EQ(rows.column[rows.start[i]], i);
        // Rows leave a plane as it is.
        double sum = 0, along = 0;
        for (std::uint32_t k = rows.start[i]; k < rows.start[i + 1]; ++k) {
            sum += rows.value[k];
            along += rows.value[k] * sheet.nodes[rows.column[k]].x;
        }
        EXPECT_NEAR(sum, 0, 1e-6 * std::fabs(rows.value[rows.start[i]]));
        EXPECT_NEAR(along, 0, 1e-6 * std::fabs(rows.value[rows.start[i]]));
    }
}

TEST(PatchTree, FindsPatchesThatLieOverEachOther) {
    const DeformableDefinition sheet = cloth_rectangle(1, 1, 0.05);
    const auto& triangles = std::get<Cloth>(sheet.matter).triangles;
    PatchTree tree(triangles, sheet.nodes.size());
    std::vector<std::uint32_t> all;
    for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
        for (const std::uint32_t t : tree.triangles_of(leaf)) {
            all.push_back(t);
            EXPECT_EQ(tree.leaf_of(t), leaf);
        }
    }
    std::ranges::sort(all);
    ASSERT_EQ(all.size(), triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) EXPECT_EQ(all[t], t);
    EXPECT_EQ(leans_of({}), 0u);
    EXPECT_NE(leans_of({0, 1, 0}), 0u);
    EXPECT_EQ(leans_of({0, 1, 0}) & leans_of({0, -1, 0}), 0u);

    const auto update = [&](const std::vector<Vec3>& places) {
        std::vector<Bounds> boxes(triangles.size());
        std::vector<LeanMask> leans(triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (const std::uint32_t node : triangles[t]) boxes[t].add(places[node]);
            boxes[t] = enlarged(boxes[t], 0.005);
            leans[t] = leans_of(cross(places[triangles[t][1]] - places[triangles[t][0]],
                                      places[triangles[t][2]] - places[triangles[t][0]]));
        }
        tree.update(boxes, leans);
        return boxes;
    };
    // Flat it touches itself nowhere; folded in half, everywhere.
    std::vector<std::array<std::uint32_t, 2>> pairs;
    (void)update(sheet.nodes);
    tree.find_pairs(pairs);
    EXPECT_TRUE(pairs.empty());
    std::vector<Vec3> folded = sheet.nodes;
    for (Vec3& p : folded) p = p.x > 0 ? Vec3{-p.x, 0.004, p.z} : p;
    const std::vector<Bounds> boxes = update(folded);
    tree.find_pairs(pairs);
    const std::set<std::array<std::uint32_t, 2>> listed(pairs.begin(), pairs.end());
    for (std::uint32_t a = 0; a < triangles.size(); ++a) {
        for (std::uint32_t b = a + 1; b < triangles.size(); ++b) {
            bool fraction = false;
            for (const std::uint32_t node : triangles[a])
                fraction = fraction || std::ranges::count(triangles[b], node) > 0;
            // Far from the fold, one over the other.
            const double x = sheet.nodes[triangles[a][0]].x, y = sheet.nodes[triangles[b][0]].x;
            const bool is_opposite = std::min(x, y) < -0.2 && std::max(x, y) > 0.2;
            if (fraction || !is_opposite || !overlaps(boxes[a], boxes[b])) continue;
            const std::uint32_t one = tree.leaf_of(a), other = tree.leaf_of(b);
            EXPECT_TRUE(listed.contains({std::min(one, other), std::max(one, other)}));
        }
    }
    EXPECT_FALSE(pairs.empty());
}

}  // namespace
}  // namespace embody::physics::deformable
