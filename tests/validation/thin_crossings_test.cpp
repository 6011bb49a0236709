// SPDX-License-Identifier: MIT
// Sheets and ropes that are twisted and thrown: no edge is ever in a triangle, and no energy comes from nowhere
// (docs/physics/thin-contact.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(cross(b - a, c - a), d - a); }

bool passes(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
    if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
    const bool side = volume(p, q, a, b) > 0;
    return side == (volume(p, q, b, c) > 0) && side == (volume(p, q, c, a) > 0);
}

const Triangles& triangles_of(const World& world, DeformableHandle sheet) {
    return std::get<Cloth>(world.deformable(sheet)->matter).triangles;
}

// Edges of the one in triangles of the other, which may be itself.
int crossings(const World& world, DeformableHandle one, DeformableHandle other) {
    const auto x = world.node_positions(one), y = world.node_positions(other);
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : triangles_of(world, one)) {
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({std::minmax(t[k], t[(k + 1) % 3]).first, std::minmax(t[k], t[(k + 1) % 3]).second});
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    int count = 0;
    for (const auto& t : triangles_of(world, other)) {
        Bounds box;
        for (const std::uint32_t node : t) box.add(y[node]);
        for (const auto& [p, q] : edges) {
            if (!overlaps(box, Bounds{min(x[p], x[q]), max(x[p], x[q])})) continue;
            if (one == other && (std::ranges::count(t, p) > 0 || std::ranges::count(t, q) > 0)) continue;
            count += passes(x[p], x[q], y[t[0]], y[t[1]], y[t[2]]) ? 1 : 0;
        }
    }
    return count;
}

// A strip whose ends are held by bodies that turn against each other, a turn a second.
void twist(double turns, double width, double edge, double stiffness) {
    const auto world = make_world({});
    constexpr double length = 0.6;
    auto strip = cloth_rectangle(length, width, edge,
                                 {.area_density = 0.2,
                                  .stretch_stiffness = stiffness,
                                  .shear_stiffness = stiffness / 10,
                                  .rayleigh_damping = 0.01});
    strip.contact_radius = 1e-3;
    std::array<BodyHandle, 2> ends;
    for (const int side : {0, 1}) {
        const double sign = side == 0 ? -1 : 1;
        BodyDefinition end{.kind = BodyKind::kinematic_body,
                           .shape = world->create_shape(SphereShape{1e-3}).value(),
                           .position = {sign * length / 2, 0, 0},
                           .angular_velocity = {-sign * pi, 0, 0},
                           .collision_mask = 0};
        ends[static_cast<std::size_t>(side)] = world->create_body(end).value();
        for (std::uint32_t i = 0; i < strip.nodes.size(); ++i) {
            const Vec3 node = strip.nodes[i];
            if (std::fabs(node.x - end.position.x) < 1e-6)
                strip.attachments.push_back({i, ends[static_cast<std::size_t>(side)], node - end.position});
        }
    }
    const DeformableHandle sheet = world->create_deformable(strip).value();
    const int steps = static_cast<int>(std::lround(60 * turns));
    for (int step = 0; step < steps + 30; ++step) {
        if (step == steps) {
            for (const BodyHandle end : ends) ASSERT_TRUE(world->set_velocity(end, {}, {}));
        }
        world->step();
        if (step % 6 > 0) continue;
        ASSERT_EQ(crossings(*world, sheet, sheet), 0) << "after " << step << " steps, width " << width;
    }
}

TEST(ThinCrossings, AStripTwistedByTwoTurnsStaysOutOfItself) {
    Random random(1);
    for (int i = 0; i < 3; ++i)
        twist(2, random.between(0.1, 0.25), random.between(0.02, 0.03), random.between(1000, 4000));
}

TEST(ThinCrossings, AStripTwistedByFiveTurnsStaysOutOfItself) { twist(5, 0.2, 0.026, 2000); }

// At a sheet that is held at its corners, without weight.
TEST(ThinCrossings, ThrownSheetsPassThroughNothingAndGainNothing) {
    Random random(2);
    for (int i = 0; i < 4; ++i) {
        const auto world = make_world({.gravity = {}});
        auto net = cloth_rectangle(1, 1, 0.06, {.area_density = 0.2});
        for (std::uint32_t k = 0; k < net.nodes.size(); ++k) {
            if (std::fabs(net.nodes[k].x) > 0.499 && std::fabs(net.nodes[k].z) > 0.499) net.pinned.push_back(k);
        }
        auto thrown = cloth_rectangle(0.4, 0.4, random.between(0.03, 0.08), {.area_density = random.between(0.1, 1)});
        thrown.pose = {{0, 0.5, 0}, random_rotation(random)};
        thrown.linear_velocity = {random.between(-2, 2), -random.between(5, 20), random.between(-2, 2)};
        const DeformableHandle one = world->create_deformable(net).value();
        const DeformableHandle two = world->create_deformable(thrown).value();
        const double start = energy(*world);
        for (int step = 0; step < 60; ++step) {
            world->step();
            EXPECT_LE(energy(*world), 1.001 * start) << i << " step " << step;
            const int count = crossings(*world, one, two) + crossings(*world, two, one) + crossings(*world, one, one) +
                              crossings(*world, two, two);
            ASSERT_EQ(count, 0) << i << " step " << step;
        }
    }
}

// On their edge or a corner, where they fold over themselves.
TEST(ThinCrossings, SheetsThatFallOnAFloorFoldAndStayOutOfThemselves) {
    Random random(3);
    for (int i = 0; i < 3; ++i) {
        const auto world = make_world({});
        add_plane(*world, friction(random.between(0.2, 0.8)));
        auto sheet = cloth_rectangle(0.5, 0.4, 0.03, {.area_density = random.between(0.1, 0.4)});
        sheet.pose = {{0, 0.6, 0}, random_rotation(random)};
        sheet.angular_velocity = {random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)};
        const DeformableHandle fallen = world->create_deformable(sheet).value();
        for (int step = 0; step < 120; ++step) {
            world->step();
            ASSERT_EQ(crossings(*world, fallen, fallen), 0) << i << " step " << step;
        }
    }
}

// A sheet on a sheet that lies on a slope, held at its ends: down by g (sin θ - µ cos θ), as a body does. Contacts with
// triangles beside the nearest one held it back until it crept (0.29 of 2.45 m).
TEST(ThinCrossings, ASheetSlidesOnASheetByCoulombsLaw) {
    Random random(5);
    for (int i = 0; i < 6; ++i) {
        const double angle = random.between(0.3, 0.8), friction = random.between(0, 0.5) * std::tan(angle);
        const auto world = make_world({.air_density = 0});
        const Quat turn = from_axis_angle({0, 0, 1}, angle);
        BodyDefinition slope{.kind = BodyKind::static_body,
                             .shape = world->create_shape(BoxShape{{3, 0.1, 1}}).value()};
        slope.position = rotate(turn, {0, -0.1, 0});
        slope.rotation = turn;
        ASSERT_TRUE(world->create_body(slope).ok());
        const auto add = [&](double width, double depth, double edge, Vec3 place) {
            auto sheet = cloth_rectangle(width, depth, edge,
                                         {.area_density = random.between(0.1, 0.6),
                                          .stretch_stiffness = 5000,
                                          .shear_stiffness = 500,
                                          .rayleigh_damping = 0.01});
            sheet.material = {.friction_static = friction, .friction_dynamic = friction};
            sheet.contact_radius = 1e-3;
            sheet.pose = {rotate(turn, place), turn};
            for (std::uint32_t k = 0; place.x == 0 && k < sheet.nodes.size(); ++k) {
                if (std::fabs(sheet.nodes[k].x) > width / 2 - 1e-6) sheet.pinned.push_back(k);
            }
            return world->create_deformable(sheet).value();
        };
        const DeformableHandle lower = add(5, 1, random.between(0.05, 0.07), {0, 1e-3, 0});
        const DeformableHandle upper = add(0.6, 0.4, random.between(0.03, 0.07), {1.5, 3e-3, 0});
        const Vec3 start = world->center_of_mass(upper);
        run(*world, 0.8);
        const double moved = length(world->center_of_mass(upper) - start);
        const double expected = 0.5 * 0.8 * 0.8 * gravity * (std::sin(angle) - friction * std::cos(angle));
        EXPECT_NEAR(moved / expected, 1, 0.05) << i << ": " << angle << " rad, µ " << friction;
        EXPECT_EQ(crossings(*world, upper, lower), 0);
    }
}

// At a rope that is held at both ends, without weight.
TEST(ThinCrossings, ThrownRopesGainNothing) {
    Random random(4);
    for (int i = 0; i < 12; ++i) {
        const auto world = make_world({.gravity = {}});
        const auto cord = [&](Vec3 from, Vec3 to, double linear_density) {
            auto rope =
                rope_between(from, to, random.between(0.02, 0.05),
                             {.linear_density = linear_density, .axial_stiffness = 2e4, .rayleigh_damping = 0.01});
            rope.contact_radius = 0.005;
            return rope;
        };
        auto held = cord({-0.5, 0, 0}, {0.5, 0, 0}, 0.1);
        held.pinned = {0, static_cast<std::uint32_t>(held.nodes.size() - 1)};
        const Vec3 half = 0.4 * normalized(Vec3{random.between(-0.5, 0.5), random.between(-0.3, 0.3), 1});
        const Vec3 middle{random.between(-0.3, 0.3), 0.1, 0};
        auto thrown = cord(middle - half, middle + half, random.between(0.02, 0.5));
        thrown.linear_velocity = {0, -random.between(1, 20), 0};
        ASSERT_TRUE(world->create_deformable(held).ok());
        ASSERT_TRUE(world->create_deformable(thrown).ok());
        const double start = energy(*world);
        for (int step = 0; step < 120; ++step) {
            world->step();
            ASSERT_LE(energy(*world), 1.001 * start) << i << " step " << step;
        }
    }
}

}  // namespace
}  // namespace embody::physics
