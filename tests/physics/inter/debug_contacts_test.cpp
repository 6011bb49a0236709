// SPDX-License-Identifier: MIT
// Contacts of what bends and flows are drawn where they are, and their arrows together hold what they carry.
#include "physics/inter/debug_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/debug_draw.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

struct Drawn : DebugDraw {
    struct Mark {
        Vec3 at, to;
        DebugColor color;
    };
    std::vector<Mark> lines, points;
    void line(Vec3 from, Vec3 to, DebugColor color) override { lines.push_back({from, to, color}); }
    void point(Vec3 at, DebugColor color) override { points.push_back({at, at, color}); }
};

Drawn drawn(const World& world, DebugDrawFlag flag, DebugDrawOptions options = {}) {
    options.flags = static_cast<std::uint32_t>(flag);
    Drawn result;
    world.debug_draw(result, options);
    return result;
}

// Of arrows of this kind, each a shaft and a head of two lines; in the scale that all share.
Vec3 sum_of_arrows(const Drawn& drawing, TouchKind kind) {
    Vec3 sum;
    for (std::size_t i = 0; i < drawing.lines.size(); i += 3) {
        const Drawn::Mark& shaft = drawing.lines[i];
        if (shaft.color.number == static_cast<std::uint16_t>(kind)) sum += shaft.to - shaft.at;
    }
    return sum;
}

struct Scene {
    std::unique_ptr<World> world = std::move(World::create({.sleeping = false})).value();
    BodyHandle add(const ShapeDefinition& shape, Vec3 position, BodyKind kind = BodyKind::dynamic_body,
                   MassDefinition mass = {}) const {
        const ShapeHandle handle = world->create_shape(shape).value();
        return world->create_body({.kind = kind, .shape = handle, .position = position, .mass = mass}).value();
    }
    DeformableHandle add(DeformableDefinition definition, Vec3 position) const {
        definition.pose.position = position;
        definition.contact_radius = 2e-3;
        return world->create_deformable(definition).value();
    }
    void run(int steps) const {
        for (int i = 0; i < steps; ++i) world->step();
    }
};

DeformableDefinition slab() {
    return tetrahedral_brick({0.4, 0.1, 0.4}, {4, 1, 4},
                             {.density = 300, .youngs_modulus = 1e5, .rayleigh_damping = 0.02});
}
DeformableDefinition sheet(double edge) {
    return cloth_rectangle(edge, edge, 0.05, {.area_density = 0.5, .rayleigh_damping = 0.02});
}

// A rigid box beside each tells the arrows' scale.
TEST(DebugContacts, ArrowsOfWhatBendsHoldItsWeight) {
    const std::vector<std::pair<const char*, DeformableDefinition>> things{
        {"slab", slab()}, {"sheet", sheet(0.3)}, {"rope", rope_between({-0.25, 0, 0}, {0.25, 0, 0}, 0.05)}};
    for (const auto& [name, definition] : things) {
        SCOPED_TRACE(name);
        const Scene scene;
        scene.add(PlaneShape{}, {}, BodyKind::static_body);
        const double half = std::string_view(name) == "slab" ? 0.05 : 0;
        const DeformableHandle soft = scene.add(definition, {0, half + 2e-3, 0});
        const double mass = scene.world->mass(soft);
        scene.add(BoxShape{{0.1, 0.1, 0.1}}, {2, 0.1, 0}, BodyKind::dynamic_body, {.mass = mass});
        scene.run(180);

        const Drawn contacts = drawn(*scene.world, DebugDrawFlag::contacts, {.mark_length = 0.2});
        ASSERT_EQ(contacts.points.size(), contacts.lines.size());
        std::size_t count = 0;
        for (std::size_t i = 0; i < contacts.points.size(); ++i) {
            if (contacts.points[i].color.number != static_cast<std::uint16_t>(TouchKind::deformable)) continue;
            ++count;
            EXPECT_NEAR(contacts.points[i].at.y, 0, 1e-3);
            EXPECT_EQ(contacts.lines[i].at, contacts.points[i].at);
            EXPECT_LT(distance(contacts.lines[i].to - contacts.lines[i].at, {0, 0.2, 0}), 1e-6);
        }
        EXPECT_GT(count, 5u);

        const Drawn arrows = drawn(*scene.world, DebugDrawFlag::impulses);
        const Vec3 of_soft = sum_of_arrows(arrows, TouchKind::deformable),
                   of_box = sum_of_arrows(arrows, TouchKind::bodies);
        EXPECT_GT(of_box.y, 0);
        EXPECT_LT(distance(of_soft, of_box), 0.05 * of_box.y);
    }
}

// Slab on slab, a rope on a sheet: where the upper one touches the lower.
TEST(DebugContacts, OfTwoThatBendAreWhereTheyTouch) {
    struct Pair {
        const char* name;
        DeformableDefinition lower, upper;
        double lower_at, upper_at, touch_at;
    };
    const std::vector<Pair> pairs{
        {"slab on slab", slab(), slab(), 0.052, 0.158, 0.104},
        {"rope on sheet", sheet(0.6), rope_between({-0.2, 0, 0}, {0.2, 0, 0}, 0.05), 2e-3, 7e-3, 4e-3},
    };
    for (const Pair& pair : pairs) {
        SCOPED_TRACE(pair.name);
        const Scene scene;
        scene.add(PlaneShape{}, {}, BodyKind::static_body);
        scene.add(pair.lower, {0, pair.lower_at, 0});
        scene.add(pair.upper, {0.01, pair.upper_at, 0.01});
        scene.run(120);
        std::size_t between = 0;
        for (const Drawn::Mark& point : drawn(*scene.world, DebugDrawFlag::contacts).points) {
            EXPECT_EQ(point.color.number, static_cast<std::uint16_t>(TouchKind::deformable));
            const bool is_on_ground = std::fabs(point.at.y) < 1.5e-3;
            if (!is_on_ground) {
                EXPECT_NEAR(point.at.y, pair.touch_at, 6e-3);
                ++between;
            }
        }
        EXPECT_GT(between, 3u);
    }
}

// Water in a box of walls with a raft in it: its lowest layer touches the floor, and it carries the raft.
TEST(DebugContacts, DropsTouchWallsAndCarryARaft) {
    const Scene scene;
    const double wall = 0.1, half = 0.3;
    scene.add(BoxShape{{half + wall, wall / 2, half + wall}}, {0, -wall / 2, 0}, BodyKind::static_body);
    for (const double side : {-1.0, 1.0}) {
        scene.add(BoxShape{{wall / 2, half, half + wall}}, {side * (half + wall / 2), half, 0}, BodyKind::static_body);
        scene.add(BoxShape{{half + wall, half, wall / 2}}, {0, half, side * (half + wall / 2)}, BodyKind::static_body);
    }
    const double cell = 0.05;
    ASSERT_TRUE(scene.world->create_fluid({.boxes = {{{-half, 0, -half}, {half, 0.3, half}}}, .cell_size = cell}));
    const BodyHandle raft =
        scene.add(BoxShape{{0.1, 0.05, 0.1}}, {0, 0.32, 0}, BodyKind::dynamic_body, {.density = 400});
    scene.run(90);

    const Drawn contacts = drawn(*scene.world, DebugDrawFlag::contacts);
    std::size_t on_floor = 0;
    ASSERT_EQ(contacts.points.size(), contacts.lines.size());
    for (std::size_t i = 0; i < contacts.points.size(); ++i) {
        const Vec3 at = contacts.points[i].at, normal = contacts.lines[i].to - at;
        EXPECT_EQ(contacts.points[i].color.number, static_cast<std::uint16_t>(TouchKind::fluid));
        if (std::fabs(at.y) > 1e-6 || std::fabs(at.x) > half || std::fabs(at.z) > half) continue;
        if (normal.y > 0.99 * length(normal)) ++on_floor;
    }
    // A layer has four particles a cell's face.
    const double layer = 4 * std::pow(2 * half / cell, 2);
    EXPECT_GT(static_cast<double>(on_floor), 0.5 * layer);
    EXPECT_LT(static_cast<double>(on_floor), 2 * layer);

    const Drawn arrows = drawn(*scene.world, DebugDrawFlag::impulses, {.longest_arrow = 0.4});
    ASSERT_EQ(arrows.lines.size(), 3u);
    EXPECT_EQ(arrows.lines[0].at, scene.world->center_of_mass(raft));
    EXPECT_NEAR(distance(arrows.lines[0].at, arrows.lines[0].to), 0.4, 1e-9);
    EXPECT_GT(sum_of_arrows(arrows, TouchKind::fluid).y, 0.3);
}

}  // namespace
}  // namespace embody::physics
