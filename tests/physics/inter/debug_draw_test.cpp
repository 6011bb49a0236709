// SPDX-License-Identifier: MIT
#include "physics/inter/debug_draw.h"
#include "make_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

struct Drawn : DebugDraw {
    struct Line {
        Vec3 from, to;
        DebugColor color;
    };
    struct Point {
        Vec3 at;
        DebugColor color;
    };
    std::vector<Line> lines;
    std::vector<Point> points;
    DebugDrawCount count;

    void line(Vec3 from, Vec3 to, DebugColor color) override { lines.push_back({from, to, color}); }
    void point(Vec3 at, DebugColor color) override { points.push_back({at, color}); }
    [[nodiscard]] std::vector<Line> of(DebugMeaning meaning) const {
        std::vector<Line> found;
        for (const Line& line : lines) {
            if (line.color.meaning == meaning) found.push_back(line);
        }
        return found;
    }
};

Drawn drawn(const World& world, std::initializer_list<DebugDrawFlag> flags, DebugDrawOptions options = {}) {
    for (const DebugDrawFlag flag : flags) options.flags |= static_cast<std::uint32_t>(flag);
    Drawn result;
    const std::uint64_t before = world.state_hash();
    result.count = world.debug_draw(result, options);
    EXPECT_EQ(world.state_hash(), before);
    EXPECT_EQ(result.count.lines, result.lines.size());
    EXPECT_EQ(result.count.points, result.points.size());
    return result;
}

std::unique_ptr<World> empty_world() { return make_world(); }

BodyHandle add_static(World& world, const ShapeDefinition& shape, const Transform& pose = {}) {
    return world
        .create_body({.kind = BodyKind::static_body,
                      .shape = world.create_shape(shape).value(),
                      .position = pose.position,
                      .rotation = pose.rotation})
        .value();
}
BodyHandle add_box(World& world, Vec3 half, Vec3 position) {
    return world.create_body({.shape = world.create_shape(BoxShape{half}).value(), .position = position}).value();
}

double length_xz(Vec3 p) { return std::hypot(p.x, p.z); }

// How far a point is from the surface, by each shape's own formula; 0 on it.
using Distance = std::function<double(Vec3)>;
double from_box(Vec3 p, Vec3 half) {
    return std::max({std::fabs(p.x) - half.x, std::fabs(p.y) - half.y, std::fabs(p.z) - half.z});
}
double from_capsule(Vec3 p, double radius, double half_height) {
    return length(p - Vec3{0, std::clamp(p.y, -half_height, half_height), 0}) - radius;
}
double from_cylinder(Vec3 p, double radius, double half_height) {
    return std::max(length_xz(p) - radius, std::fabs(p.y) - half_height);
}
double from_cone(Vec3 p, double radius, double half_height) {
    return std::max(length_xz(p) - radius * (half_height - p.y) / (2 * half_height), -half_height - p.y);
}
const std::vector<Vec3> corner_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // x, y, z >= 0, x + y + z <= 1
double from_corner(Vec3 p) { return std::max({-p.x, -p.y, -p.z, p.x + p.y + p.z - 1}); }

struct ShapeCase {
    const char* name;
    ShapeDefinition shape;
    std::size_t lines;
    Distance distance;
};

constexpr std::size_t circle = 24;
const MeshShape two_triangles{{{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}}, {{0, 1, 2}, {0, 2, 3}}};
const MeshShape closed_mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

std::vector<ShapeCase> shape_cases() {
    const HeightfieldShape field{3, 3, 0.5, 0.25, {0, 1, 0, 0, 2, 0, 0, 1, 0}};
    const auto from_field = [field](Vec3 p) {  // ends are samples
        const long c = std::lround(p.x / 0.5), r = std::lround(p.z / 0.25);
        const double height = field.heights[static_cast<std::size_t>(r * 3 + c)];
        return std::fabs(p.x - 0.5 * static_cast<double>(c)) + std::fabs(p.y - height) +
               std::fabs(p.z - 0.25 * static_cast<double>(r));
    };
    const Transform place{{2, 0, 0}, from_axis_angle({0, 0, 1}, 0.5)};
    const CompoundShape compound{{{SphereShape{0.3}, {}}, {BoxShape{{0.1, 0.2, 0.3}}, place}}};
    const auto from_compound = [place](Vec3 p) {
        const double a = length(p) - 0.3, b = from_box(inverse_transform_point(place, p), {0.1, 0.2, 0.3});
        return std::fabs(a) < std::fabs(b) ? a : b;
    };
    const Vec3 normal = normalized(Vec3{1, 2, 3});
    return {
        {"sphere", SphereShape{0.7}, 3 * circle, [](Vec3 p) { return length(p) - 0.7; }},
        {"box", BoxShape{{0.1, 0.2, 0.3}}, 12,
         [](Vec3 p) {
             return from_box(p, {0.1, 0.2, 0.3});
         }},
        {"capsule", CapsuleShape{0.2, 0.5}, 4 * circle + 4, [](Vec3 p) { return from_capsule(p, 0.2, 0.5); }},
        {"cylinder", CylinderShape{0.4, 0.3}, 2 * circle + 4, [](Vec3 p) { return from_cylinder(p, 0.4, 0.3); }},
        {"cone", ConeShape{0.4, 0.6}, circle + 4, [](Vec3 p) { return from_cone(p, 0.4, 0.6); }},
        {"hull", HullShape{corner_points}, 6, from_corner},
        {"mesh", two_triangles, 5, [](Vec3 p) { return p.y; }},
        {"closed mesh", closed_mesh, 6, from_corner},
        // Rows of 2 edges, columns of 2, a diagonal in each of 4 cells.
        {"heightfield", field, 3 * 2 + 3 * 2 + 4, from_field},
        {"plane", PlaneShape{{2, 4, 6}, 1.5}, 22, [normal](Vec3 p) { return dot(normal, p) - 1.5; }},
        {"compound", compound, 3 * circle + 12, from_compound},
    };
}

TEST(DebugDraw, LinesOfShapesEndOnTheirSurfaces) {
    const Transform pose{{1, -2, 3}, from_axis_angle(normalized(Vec3{1, 1, -2}), 0.8)};
    for (const ShapeCase& shape : shape_cases()) {
        const auto world = empty_world();
        add_static(*world, shape.shape, pose);
        const Drawn result = drawn(*world, {DebugDrawFlag::shapes});
        EXPECT_EQ(result.lines.size(), shape.lines) << shape.name;
        EXPECT_TRUE(result.points.empty());
        std::set<std::array<double, 6>> seen;
        for (const Drawn::Line& line : result.lines) {
            EXPECT_EQ(line.color.meaning, DebugMeaning::static_shape);
            EXPECT_GT(length(line.to - line.from), 1e-6) << shape.name;
            for (const Vec3 end : {line.from, line.to})
                EXPECT_NEAR(shape.distance(inverse_transform_point(pose, end)), 0, 1e-6) << shape.name;
            const auto [a, b] = std::minmax(line.from, line.to, [](Vec3 p, Vec3 q) {
                return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
            });
            EXPECT_TRUE(seen.insert({a.x, a.y, a.z, b.x, b.y, b.z}).second) << shape.name << ": a line twice";
        }
    }
}

TEST(DebugDraw, ShapesTellHowTheirBodiesAre) {
    const auto world = empty_world();
    const ShapeHandle ball = world->create_shape(SphereShape{0.5}).value();
    const auto meaning_of = [&](const BodyDefinition& definition) {
        const BodyHandle body = world->create_body(definition).value();
        const DebugMeaning meaning = drawn(*world, {DebugDrawFlag::shapes}).lines.front().color.meaning;
        EXPECT_TRUE(world->destroy_body(body));
        return meaning;
    };
    EXPECT_EQ(meaning_of({.kind = BodyKind::static_body, .shape = ball}), DebugMeaning::static_shape);
    EXPECT_EQ(meaning_of({.kind = BodyKind::kinematic_body, .shape = ball}), DebugMeaning::kinematic_shape);
    EXPECT_EQ(meaning_of({.shape = ball}), DebugMeaning::active_shape);
    EXPECT_EQ(meaning_of({.shape = ball, .start_asleep = true}), DebugMeaning::asleep_shape);
}

TEST(DebugDraw, BoundsAreBoxesAroundShapes) {
    const auto world = empty_world();
    add_static(*world, PlaneShape{});
    const BodyHandle body = add_box(*world, {0.1, 0.2, 0.3}, {1, 2, 3});
    ASSERT_TRUE(world->set_pose(body, {{1, 2, 3}, from_axis_angle({0, 0, 1}, 0.7)}));
    const Bounds box = world->bounds(body);
    const Drawn result = drawn(*world, {DebugDrawFlag::bounds});
    ASSERT_EQ(result.lines.size(), 12u);
    double sum = 0;
    for (const Drawn::Line& line : result.lines) {
        EXPECT_EQ(line.color.meaning, DebugMeaning::bounds);
        sum += length(line.to - line.from);
        for (const Vec3 end : {line.from, line.to}) {
            for (int k = 0; k < 3; ++k) EXPECT_TRUE(end[k] == box.lower[k] || end[k] == box.upper[k]);
        }
    }
    const Vec3 size = box.size();
    EXPECT_NEAR(sum, 4 * (size.x + size.y + size.z), 1e-12);
}

// Two stacks on the ground, of two boxes and of one.
struct Stacks {
    std::unique_ptr<World> world = empty_world();
    BodyHandle ground = add_static(*world, PlaneShape{});
    BodyHandle lower = add_box(*world, {0.5, 0.5, 0.5}, {0, 0.5, 0});
    BodyHandle upper = add_box(*world, {0.5, 0.5, 0.5}, {0, 1.5, 0});
    BodyHandle other = add_box(*world, {0.5, 0.5, 0.5}, {5, 0.5, 0});

    void run(int steps) const {
        for (int i = 0; i < steps; ++i) world->step();
    }
};

TEST(DebugDraw, ContactsAreThoseOfTheWorld) {
    const Stacks stacks;
    stacks.run(3);
    const std::vector<ContactView> views = stacks.world->contacts();
    ASSERT_EQ(views.size(), 12u);
    const Drawn result = drawn(*stacks.world, {DebugDrawFlag::contacts}, {.mark_length = 0.25});
    ASSERT_EQ(result.points.size(), views.size());
    ASSERT_EQ(result.lines.size(), views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(result.points[i].at, views[i].position);
        EXPECT_EQ(result.points[i].color.meaning, DebugMeaning::contact);
        EXPECT_EQ(result.lines[i].from, views[i].position);
        EXPECT_NEAR(length(result.lines[i].to - views[i].position - 0.25 * views[i].normal), 0, 1e-12);
        EXPECT_EQ(result.lines[i].color.meaning, DebugMeaning::contact_normal);
    }
}

TEST(DebugDraw, ImpulsesAreArrowsInProportion) {
    const Stacks stacks;
    stacks.run(3);
    const std::vector<ContactView> views = stacks.world->contacts();
    double largest = 0;
    for (const ContactView& view : views) largest = std::max(largest, length(view.impulse));
    ASSERT_GT(largest, 0);
    const Drawn result = drawn(*stacks.world, {DebugDrawFlag::impulses}, {.longest_arrow = 0.8});
    ASSERT_EQ(result.lines.size(), 3 * views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Drawn::Line& shaft = result.lines[3 * i];
        EXPECT_EQ(shaft.from, views[i].position);
        EXPECT_NEAR(length(shaft.to - shaft.from - 0.8 / largest * views[i].impulse), 0, 1e-12);
        for (std::size_t k = 1; k < 3; ++k) EXPECT_EQ(result.lines[3 * i + k].from, shaft.to);
    }
}

TEST(DebugDraw, IslandsHaveABoxAndAColourEach) {
    const Stacks stacks;
    stacks.run(3);
    const auto check = [&](bool is_asleep) {
        const Drawn boxes = drawn(*stacks.world, {DebugDrawFlag::islands});
        ASSERT_EQ(boxes.lines.size(), 24u);
        std::map<int, Bounds> by_number;
        for (const Drawn::Line& line : boxes.lines) {
            EXPECT_EQ(line.color.is_dim, is_asleep);
            by_number[line.color.number].add(line.from);
            by_number[line.color.number].add(line.to);
        }
        ASSERT_EQ(by_number.size(), 2u);
        Bounds pair = stacks.world->bounds(stacks.lower);
        pair.add(stacks.world->bounds(stacks.upper));
        EXPECT_EQ(by_number.at(static_cast<int>(stacks.lower.index)).upper, pair.upper);
        EXPECT_EQ(by_number.at(static_cast<int>(stacks.lower.index)).lower, pair.lower);
        EXPECT_EQ(by_number.at(static_cast<int>(stacks.other.index)).upper, stacks.world->bounds(stacks.other).upper);

        const Drawn coloured = drawn(*stacks.world, {DebugDrawFlag::islands, DebugDrawFlag::shapes});
        EXPECT_EQ(coloured.of(DebugMeaning::static_shape).size(), 22u);  // the ground is in no island
        std::map<int, int> lines;
        for (const Drawn::Line& line : coloured.of(DebugMeaning::island)) ++lines[line.color.number];
        EXPECT_EQ(lines.at(static_cast<int>(stacks.lower.index)), 12 + 24);
        EXPECT_EQ(lines.at(static_cast<int>(stacks.other.index)), 12 + 12);
    };
    check(false);
    stacks.run(120);
    ASSERT_EQ(stacks.world->sleep_state(stacks.upper), SleepState::asleep);
    check(true);
}

// A door on a post, and a slider to the world.
TEST(DebugDraw, JointsShowFramesAxesAndLimits) {
    const auto world = empty_world();
    const BodyHandle post = add_static(*world, BoxShape{{0.1, 1, 0.1}}, {{1, 1, 0}, {}});
    const BodyHandle door = add_box(*world, {0.5, 1, 0.05}, {1.6, 1, 0});
    // X of the frames is the hinge's axis: upwards.
    const Quat upright = from_axis_angle({0, 0, 1}, std::acos(-1.0) / 2);
    HingeJoint hinge{.limit = JointLimit{-0.5, 1.5}};
    ASSERT_TRUE(world->create_joint({.joint = hinge,
                                     .body_a = post,
                                     .body_b = door,
                                     .frame_a = {{0.1, 0, 0}, upright},
                                     .frame_b = {{-0.5, 0, 0}, upright}}));
    const DebugDrawOptions options{.mark_length = 0.2};
    const Vec3 origin{1.1, 1, 0};
    Drawn result = drawn(*world, {DebugDrawFlag::joints}, options);
    ASSERT_EQ(result.of(DebugMeaning::joint).size(), 2u);
    EXPECT_NEAR(length(result.of(DebugMeaning::joint)[0].from - Vec3{1, 1, 0}), 0, 1e-12);
    EXPECT_NEAR(length(result.of(DebugMeaning::joint)[1].from - Vec3{1.6, 1, 0}), 0, 1e-12);
    const auto axes = result.of(DebugMeaning::joint_axis);
    ASSERT_EQ(axes.size(), 6u);
    for (const Drawn::Line& axis : axes) {
        const Vec3 expected[]{{0, 0.2, 0}, {-0.2, 0, 0}, {0, 0, 0.2}};
        EXPECT_NEAR(length(axis.from - origin), 0, 1e-12);
        EXPECT_NEAR(length(axis.to - origin - expected[axis.color.number]), 0, 1e-12);
    }
    const auto limits = result.of(DebugMeaning::joint_limit);
    ASSERT_EQ(limits.size(), 14u);
    for (const Drawn::Line& line : limits) {
        for (const Vec3 end : {line.from, line.to}) {
            EXPECT_NEAR(end.y, 1, 1e-12);
            const double radius = length(end - origin);
            EXPECT_TRUE(radius < 1e-12 || std::fabs(radius - 0.2) < 1e-12);
        }
    }
    // Turned by its upper limit the door's own Y axis ends where the sector ends.
    ASSERT_TRUE(world->set_pose(
        door, {origin + rotate(from_axis_angle({0, 1, 0}, 1.5), {0.5, 0, 0}), from_axis_angle({0, 1, 0}, 1.5)}));
    result = drawn(*world, {DebugDrawFlag::joints}, options);
    EXPECT_NEAR(length(result.of(DebugMeaning::joint_axis)[4].to - limits.back().from), 0, 1e-9);

    const auto other = empty_world();
    const BodyHandle block = add_box(*other, {0.1, 0.1, 0.1}, {0, 0, 0});
    ASSERT_TRUE(other->create_joint(
        {.joint = SliderJoint{.limit = JointLimit{-1, 2}}, .body_b = block, .frame_a = {{0, 0, 3}, {}}}));
    result = drawn(*other, {DebugDrawFlag::joints}, options);
    EXPECT_EQ(result.of(DebugMeaning::joint).size(), 1u);  // the world has no centre of mass
    ASSERT_EQ(result.of(DebugMeaning::joint_limit).size(), 1u);
    EXPECT_EQ(result.of(DebugMeaning::joint_limit)[0].from, (Vec3{-1, 0, 3}));
    EXPECT_EQ(result.of(DebugMeaning::joint_limit)[0].to, (Vec3{2, 0, 3}));
}

// The box of equal inertia of a box is itself.
TEST(DebugDraw, MassesShowCentreAndAxesOfInertia) {
    const auto world = empty_world();
    add_static(*world, PlaneShape{});
    const BodyHandle body = add_box(*world, {0.1, 0.4, 0.2}, {1, 2, 3});
    const Quat turn = from_axis_angle(normalized(Vec3{1, 2, 0}), 0.4);
    ASSERT_TRUE(world->set_pose(body, {{1, 2, 3}, turn}));
    const Drawn result = drawn(*world, {DebugDrawFlag::masses});
    ASSERT_EQ(result.points.size(), 1u);
    EXPECT_NEAR(length(result.points[0].at - Vec3{1, 2, 3}), 0, 1e-12);
    ASSERT_EQ(result.lines.size(), 3u);
    const Vec3 halves[]{{0, 0.4, 0}, {0, 0, 0.2}, {0.1, 0, 0}};  // the least moment is about the longest edge
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 half = rotate_inverse(turn, result.lines[k].to - result.lines[k].from) / 2;
        EXPECT_NEAR(length(abs(half) - halves[k]), 0, 1e-9);
        EXPECT_NEAR(length((result.lines[k].to + result.lines[k].from) / 2 - Vec3{1, 2, 3}), 0, 1e-12);
        EXPECT_EQ(result.lines[k].color.number, k);
    }
}

TEST(DebugDraw, DeformablesShowNodesEdgesAndWhatHoldsThem) {
    const auto world = empty_world();
    const BodyHandle post = add_static(*world, BoxShape{{0.1, 0.1, 0.1}}, {{0, 2, 0}, {}});
    DeformableDefinition cloth = cloth_rectangle(1, 0.6, 0.2);
    cloth.pinned = {0};
    cloth.attachments = {{.node = 1, .body = post, .anchor = {0.1, 0, 0}}};
    const auto& triangles = std::get<Cloth>(cloth.matter).triangles;
    // Euler: V - E + F = 1 of a disc.
    const std::size_t cloth_edges = cloth.nodes.size() + triangles.size() - 1;
    const DeformableHandle sheet = world->create_deformable(cloth).value();
    Drawn result = drawn(*world, {DebugDrawFlag::deformables});
    ASSERT_EQ(result.points.size(), cloth.nodes.size());
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        EXPECT_EQ(result.points[i].at, world->node_positions(sheet)[i]);
        EXPECT_EQ(result.points[i].color.number, i == 0 ? 1 : 0);
    }
    EXPECT_EQ(result.of(DebugMeaning::edge).size(), cloth_edges);
    ASSERT_EQ(result.of(DebugMeaning::attachment).size(), 1u);
    EXPECT_EQ(result.of(DebugMeaning::attachment)[0].from, world->node_positions(sheet)[1]);
    EXPECT_EQ(result.of(DebugMeaning::attachment)[0].to, (Vec3{0.1, 2, 0}));
    ASSERT_TRUE(world->destroy_deformable(sheet));

    const DeformableHandle rope = world->create_deformable(rope_between({0, 0, 0}, {1, 0, 0}, 0.1)).value();
    EXPECT_EQ(drawn(*world, {DebugDrawFlag::deformables}).lines.size(), world->node_positions(rope).size() - 1);
    ASSERT_TRUE(world->destroy_deformable(rope));

    // A brick of two cells: 12 corners, all on the surface, of 20 triangles, and V - E + F = 2.
    ASSERT_TRUE(world->create_deformable(tetrahedral_brick({2, 1, 1}, {2, 1, 1})));
    result = drawn(*world, {DebugDrawFlag::deformables});
    EXPECT_EQ(result.points.size(), 12u);
    EXPECT_EQ(result.of(DebugMeaning::edge).size(), 12u + 20u - 2u);
}

TEST(DebugDraw, ParticlesAreThoseOfTheFluids) {
    const auto world = empty_world();
    const FluidHandle fluid = world->create_fluid({.boxes = {{{0, 1, 0}, {0.2, 1.1, 0.2}}}}).value();
    const FluidParticles particles = world->fluid_particles(fluid);
    ASSERT_GT(particles.positions.size(), 100u);
    const Drawn result = drawn(*world, {DebugDrawFlag::particles});
    ASSERT_EQ(result.points.size(), particles.positions.size());
    for (std::size_t i = 0; i < result.points.size(); ++i)
        EXPECT_EQ(result.points[i].at, particles.origin + Vec3(particles.positions[i]));
}

// Each body's bounds lie in a box of the deepest level, and each box in one of the level above.
TEST(DebugDraw, TreesAreBoxesWithinBoxes) {
    const auto world = empty_world();
    std::vector<BodyHandle> bodies;
    for (int i = 0; i < 100; ++i)
        bodies.push_back(add_box(*world, {0.2, 0.2, 0.2}, {1.0 * (i % 10), 5, 1.0 * (i / 10)}));
    world->step();
    const Drawn result = drawn(*world, {DebugDrawFlag::trees});
    ASSERT_EQ(result.lines.size() % 12, 0u);
    std::map<int, std::vector<Bounds>> levels;
    for (std::size_t i = 0; i < result.lines.size(); i += 12) {
        Bounds box;
        for (std::size_t k = i; k < i + 12; ++k) {
            box.add(result.lines[k].from);
            box.add(result.lines[k].to);
        }
        levels[result.lines[i].color.number].push_back(box);
    }
    ASSERT_GE(levels.size(), 2u);
    const int deepest = levels.rbegin()->first;
    EXPECT_EQ(levels.at(deepest).size(), bodies.size());
    const auto is_within = [&](int depth, const Bounds& box) {
        return std::any_of(levels.at(depth).begin(), levels.at(depth).end(),
                           [&](const Bounds& outer) { return contains(outer, box); });
    };
    for (const BodyHandle body : bodies) EXPECT_TRUE(is_within(deepest, world->bounds(body)));
    for (int depth = 1; depth <= deepest; ++depth) {
        for (const Bounds& box : levels.at(depth)) EXPECT_TRUE(is_within(depth - 1, box));
    }
}

TEST(DebugDraw, WhatIsTooMuchIsLeftOutAndCounted) {
    const Stacks stacks;
    stacks.run(3);
    const auto all = {DebugDrawFlag::shapes, DebugDrawFlag::bounds, DebugDrawFlag::contacts};
    const Drawn whole = drawn(*stacks.world, all);
    EXPECT_EQ(whole.count.lines_left_out + whole.count.points_left_out, 0u);
    const Drawn part = drawn(*stacks.world, all, {.max_lines = 20, .max_points = 5});
    EXPECT_EQ(part.count.lines, 20u);
    EXPECT_EQ(part.count.points, 5u);
    EXPECT_EQ(part.count.lines_left_out, whole.count.lines - 20);
    EXPECT_EQ(part.count.points_left_out, whole.count.points - 5);
    EXPECT_TRUE(drawn(*stacks.world, {}).lines.empty());
}

// A world that is looked at after each step goes on as one that is not.
// A box of 8 kg that slides on the ground, and a ball that falls beside it.
std::unique_ptr<World> sliding_and_falling() {
    auto made = make_world({.substeps = 1});
    World& world = *made;
    const auto add = [&world](const ShapeDefinition& shape, Vec3 position, Vec3 velocity, BodyKind kind, int user) {
        BodyDefinition body;
        body.kind = kind;
        body.shape = world.create_shape(shape).value();
        body.position = position;
        body.linear_velocity = velocity;
        body.user_data = static_cast<std::uint64_t>(user);
        if (user == 2) body.force = {0, 0, 20};
        EXPECT_TRUE(world.create_body(body).ok());
    };
    add(BoxShape{{10, 1, 10}}, {0, -1, 0}, {}, BodyKind::static_body, 1);
    add(BoxShape{{0.1, 0.1, 0.1}}, {0, 0.1, 0}, {2, 0, 0}, BodyKind::dynamic_body, 2);
    add(SphereShape{0.1}, {3, 5, 0}, {0, 1, 0}, BodyKind::dynamic_body, 3);
    world.step();
    return made;
}

TEST(DebugDraw, VelocitiesLeadToWhereACentreWillBe) {
    const auto made = sliding_and_falling();
    const World& world = *made;
    const auto arrows = drawn(world, {DebugDrawFlag::velocities}).of(DebugMeaning::velocity);
    ASSERT_EQ(arrows.size(), 6u);  // a shaft and two lines of a head each
    for (const BodyHandle body : world.bodies()) {
        if (world.linear_velocity(body) == Vec3{}) continue;
        const Vec3 end = world.center_of_mass(body) + 0.2 * world.linear_velocity(body);
        EXPECT_TRUE(std::ranges::any_of(arrows, [&](const Drawn::Line& line) {
            return distance(line.from, world.center_of_mass(body)) < 1e-12 && distance(line.to, end) < 1e-12;
        }));
    }
}

TEST(DebugDraw, ForcesAreWeightConstantForceAndContacts) {
    const auto made = sliding_and_falling();
    const World& world = *made;
    DebugDrawOptions options;
    options.only = {2};
    std::map<int, std::vector<Drawn::Line>> shafts;
    const auto lines = drawn(world, {DebugDrawFlag::forces}, options).of(DebugMeaning::force);
    for (std::size_t i = 0; i < lines.size(); i += 3) shafts[lines[i].color.number].push_back(lines[i]);
    ASSERT_EQ(shafts[0].size(), 1u);
    ASSERT_EQ(shafts[1].size(), 1u);
    const auto along = [](const Drawn::Line& line) { return line.to - line.from; };
    const Vec3 weight = along(shafts[0].front());
    EXPECT_LT(std::fabs(weight.x) + std::fabs(weight.z), 1e-12);
    const double newton = length(weight) / (8 * 9.81);
    EXPECT_LT(distance(along(shafts[1].front()), {0, 0, 20 * newton}), 1e-9);
    Vec3 of_contacts;
    for (const Drawn::Line& line : shafts[2]) of_contacts += along(line);
    Vec3 expected;
    for (const ContactView& contact : world.contacts()) expected += contact.impulse * (60 * newton);
    // Whichever of the two bodies comes first.
    EXPECT_NEAR(length(of_contacts), length(expected), 1e-6);
    EXPECT_GT(of_contacts.y, 0);
    EXPECT_LT(of_contacts.x, 0);
}

TEST(DebugDraw, OnlyWhatIsMeantIsDrawn) {
    const auto made = sliding_and_falling();
    const World& world = *made;
    const auto flags = {DebugDrawFlag::masses, DebugDrawFlag::velocities, DebugDrawFlag::contacts};
    DebugDrawOptions options;
    options.only = {3};
    const Drawn ball = drawn(world, flags, options);
    EXPECT_EQ(ball.points.size(), 1u);
    EXPECT_EQ(ball.of(DebugMeaning::velocity).size(), 3u);
    EXPECT_TRUE(ball.of(DebugMeaning::contact_normal).empty());
    options.only = {2};
    EXPECT_EQ(drawn(world, flags, options).of(DebugMeaning::contact_normal).size(), world.contacts().size());
    options.only = {7};
    const Drawn nothing = drawn(world, flags, options);
    EXPECT_TRUE(nothing.lines.empty() && nothing.points.empty());
}

TEST(DebugDraw, ChangesNothing) {
    const Stacks seen, unseen;
    for (int i = 0; i < 30; ++i) {
        seen.run(1);
        unseen.run(1);
        drawn(*seen.world, {}, {.flags = 0xFFFFFFFFu});
        ASSERT_EQ(seen.world->state_hash(), unseen.world->state_hash());
    }
}

}  // namespace
}  // namespace embody::physics
