// SPDX-License-Identifier: MIT
// Sheets and ropes that touch other sheets and ropes.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

double mass_of(const DeformableDefinition& sheet, double width, double depth) {
    return std::get<Cloth>(sheet.matter).area_density * width * depth;
}

/// A sheet whose corners hang on a heavy body that nothing else moves: its momentum tells what it carries.
struct Frame {
    BodyHandle body;
    DeformableHandle sheet;
    double mass = 1e5;

    Frame(World& world, DeformableDefinition definition, double half) {
        BodyDefinition body_definition{.kind = BodyKind::dynamic_body,
                                       .shape = world.create_shape(SphereShape{0.01}).value(),
                                       .position = {0, 5, 0},
                                       .gravity_factor = 0};
        body_definition.mass.mass = mass;
        body = world.create_body(body_definition).value();
        for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
            const Vec3 node = definition.nodes[i];
            if (std::fabs(std::fabs(node.x) - half) > 1e-6 || std::fabs(std::fabs(node.z) - half) > 1e-6) continue;
            definition.attachments.push_back({i, body, definition.pose.position + node - body_definition.position});
        }
        EXPECT_EQ(definition.attachments.size(), 4u);
        sheet = world.create_deformable(definition).value();
    }
    // Mean force on it over a while, N, downwards.
    double load(World& world, double seconds) const {
        const double before = world.linear_velocity(body).y;
        run(world, seconds);
        return -mass * (world.linear_velocity(body).y - before) / seconds;
    }
};

// Height of a sheet of straight edges over the point: the highest of its triangles there, or far below.
double height_at(const World& world, DeformableHandle sheet, const Cloth& cloth, Vec3 at) {
    double height = -1e9;
    const auto x = world.node_positions(sheet);
    for (const auto& [a, b, c] : cloth.triangles) {
        const Vec3 p = x[a], u = x[b] - p, v = x[c] - p, w = at - p;
        const double area = u.x * v.z - u.z * v.x;
        if (std::fabs(area) < 1e-12) continue;
        const double s = (w.x * v.z - w.z * v.x) / area, t = (u.x * w.z - u.z * w.x) / area;
        if (s < 0 || t < 0 || s + t > 1) continue;
        height = std::max(height, p.y + s * u.y + t * v.y);
    }
    return height;
}

// How many edges of the one pass through triangles of the other.
int crossings(const World& world, DeformableHandle one, const Cloth& edges, DeformableHandle other,
              const Cloth& triangles) {
    const auto x = world.node_positions(one), y = world.node_positions(other);
    const auto side = [](Vec3 a, Vec3 b, Vec3 c, Vec3 p) { return dot(cross(b - a, c - a), p - a) > 0; };
    int count = 0;
    for (const auto& triangle : edges.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = x[triangle[k]], q = x[triangle[(k + 1) % 3]];
            for (const auto& [i, j, l] : triangles.triangles) {
                const Vec3 a = y[i], b = y[j], c = y[l];
                const bool first = side(p, q, a, b), second = side(p, q, b, c), third = side(p, q, c, a);
                count += side(a, b, c, p) != side(a, b, c, q) && first == second && second == third;
            }
        }
    }
    return count;
}

Vec3 momentum(const World& world) { return world.conserved().linear_momentum; }

TEST(ThinContact, AClothOnAPinnedClothIsCarriedByItsPins) {
    for (const double upper_density : {0.1, 0.3, 2.0}) {
        const auto world = make_world({.sleeping = false});
        auto lower = cloth_rectangle(1, 1, 0.07, {.area_density = 0.3, .rayleigh_damping = 0.02});
        lower.pose.position = {0, 1, 0};
        auto upper = cloth_rectangle(0.5, 0.5, 0.06, {.area_density = upper_density, .rayleigh_damping = 0.02});
        upper.pose.position = {0, 1.3, 0};
        const Frame frame(*world, lower, 0.5);
        const DeformableHandle cloth = world->create_deformable(upper).value();
        run(*world, 6);
        const double weight = gravity * (mass_of(lower, 1, 1) + mass_of(upper, 0.5, 0.5));
        EXPECT_NEAR(frame.load(*world, 2) / weight, 1, 0.02) << upper_density;
        for (const Vec3 node : world->node_positions(cloth)) {
            const double below = height_at(*world, frame.sheet, std::get<Cloth>(lower.matter), node);
            EXPECT_GT(node.y, below - 1e-3) << upper_density;
            EXPECT_LT(node.y, below + 0.2) << upper_density;
        }
    }
}

TEST(ThinContact, ARopeAcrossATautRopeHangsThere) {
    const auto world = make_world({});
    auto taut = rope_between({-1, 1, 0}, {1, 1, 0}, 0.05, {.axial_stiffness = 1e5, .rayleigh_damping = 0.01});
    taut.pinned = {0, static_cast<std::uint32_t>(taut.nodes.size() - 1)};
    taut.contact_radius = 5e-3;
    auto loose = rope_between({0.01, 1.03, -0.51}, {0.01, 1.03, 0.53}, 0.05, {.rayleigh_damping = 0.01});
    loose.contact_radius = 5e-3;
    loose.material = taut.material = {.friction_static = 1, .friction_dynamic = 1};
    const DeformableHandle line = world->create_deformable(taut).value();
    const DeformableHandle rope = world->create_deformable(loose).value();
    run(*world, 8);
    const auto x = world->node_positions(rope);
    EXPECT_LT(x.front().y, 0.8);
    EXPECT_LT(x.back().y, 0.8);
    double top = 0, lowest = 2;
    for (const Vec3 node : x) top = std::max(top, node.y);
    for (const Vec3 node : world->node_positions(line)) lowest = std::min(lowest, node.y);
    EXPECT_NEAR(top, lowest + 0.01, 0.01);
    // Two straight halves under the load of the rope that hangs there: tan(angle) = W / 2T, T = EA strain.
    const double weight = gravity * 0.07 * 1.04, half = 1 - lowest;
    const auto tension = world->rope_tensions(line);
    const double middle = tension[tension.size() / 2];
    EXPECT_NEAR(2 * middle * half / std::hypot(1, half) / (weight + gravity * 0.07), 1, 0.1);
}

TEST(ThinContact, ARopeLiesOnAPinnedCloth) {
    const auto world = make_world({.sleeping = false});
    auto sheet = cloth_rectangle(1, 1, 0.07, {.area_density = 0.3, .rayleigh_damping = 0.02});
    sheet.pose.position = {0, 1, 0};
    auto rope = rope_between({-0.3, 1.1, 0.05}, {0.3, 1.1, -0.02}, 0.05, {.rayleigh_damping = 0.02});
    rope.contact_radius = 5e-3;
    const Frame frame(*world, sheet, 0.5);
    const DeformableHandle line = world->create_deformable(rope).value();
    run(*world, 6);
    const double weight = gravity * (mass_of(sheet, 1, 1) + 0.07 * 0.6);
    EXPECT_NEAR(frame.load(*world, 2) / weight, 1, 0.02);
    for (const Vec3 node : world->node_positions(line))
        EXPECT_GT(node.y, height_at(*world, frame.sheet, std::get<Cloth>(sheet.matter), node));
}

TEST(ThinContact, ACollisionKeepsTheMomentum) {
    for (const double density : {0.1, 1.0, 20.0}) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        auto one = cloth_rectangle(0.5, 0.5, 0.06, {.area_density = 0.2});
        auto two = cloth_rectangle(0.4, 0.4, 0.05, {.area_density = density});
        one.pose.position = {0, 0.1, 0};
        one.linear_velocity = {0.3, -2, 0};
        two.pose.position = {0.03, 0, 0.02};
        two.linear_velocity = {0, 0.2, 0.1};
        const DeformableHandle first = world->create_deformable(one).value();
        const DeformableHandle second = world->create_deformable(two).value();
        const Vec3 before = momentum(*world);
        const double energy_before = energy(*world);
        run(*world, 1);
        EXPECT_LT(length(momentum(*world) - before), 1e-6 * length(before)) << density;
        EXPECT_LT(energy(*world), energy_before) << density;
        const Cloth &cloth_one = std::get<Cloth>(one.matter), &cloth_two = std::get<Cloth>(two.matter);
        EXPECT_EQ(crossings(*world, first, cloth_one, second, cloth_two), 0) << density;
        EXPECT_EQ(crossings(*world, second, cloth_two, first, cloth_one), 0) << density;
    }
}

TEST(ThinContact, FrictionHoldsAStackOfSheetsOnASlope) {
    const double mu = 0.5;
    for (const double share : {0.8, 1.25}) {
        const double angle = std::atan(share * mu);
        const auto world = make_world({.air_density = 0, .sleeping = false});
        add_plane(*world, friction(mu), angle);
        std::vector<DeformableHandle> sheets;
        for (const double height : {0.003, 0.008}) {
            auto sheet = cloth_rectangle(0.3, 0.3, 0.05, {.area_density = 0.3, .rayleigh_damping = 0.01});
            sheet.contact_radius = 2e-3;
            sheet.material = {.friction_static = mu, .friction_dynamic = mu};
            sheet.pose.rotation = from_axis_angle({0, 0, 1}, -angle);
            sheet.pose.position = rotate(sheet.pose.rotation, {0, height, 0});
            sheets.push_back(world->create_deformable(sheet).value());
        }
        run(*world, 1);
        std::vector<Vec3> before;
        for (const DeformableHandle sheet : sheets) before.push_back(world->center_of_mass(sheet));
        run(*world, 1);
        for (std::size_t i = 0; i < sheets.size(); ++i) {
            const double way = length(world->center_of_mass(sheets[i]) - before[i]);
            if (share < 1)
                EXPECT_LT(way, 1e-3) << i;
            else
                EXPECT_GT(way, 0.3) << i;
        }
    }
}

TEST(ThinContact, ASheetThatFallsOnASleepingOneWakesItAndBothSleep) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    auto sheet = cloth_rectangle(0.6, 0.6, 0.06, {.area_density = 0.3, .rayleigh_damping = 0.02});
    sheet.pose.position = {0, 0.01, 0};
    const DeformableHandle lower = world->create_deformable(sheet).value();
    run(*world, 3);
    ASSERT_TRUE(world->is_asleep(lower));
    sheet.pose.position = {0.05, 0.15, 0.03};
    const DeformableHandle upper = world->create_deformable(sheet).value();
    bool has_woken = false;
    for (int i = 0; i < 30; ++i) {
        world->step();
        has_woken |= !world->is_asleep(lower);
    }
    EXPECT_TRUE(has_woken);
    run(*world, 8);
    EXPECT_TRUE(world->is_asleep(lower));
    EXPECT_TRUE(world->is_asleep(upper));
    for (const Vec3 node : world->node_positions(upper)) {
        const bool is_over = std::fabs(node.x) < 0.29 && std::fabs(node.z) < 0.29;
        EXPECT_GT(node.y, is_over ? 2.5e-3 : 0.5e-3);
    }
    const Cloth& cloth = std::get<Cloth>(sheet.matter);
    EXPECT_EQ(crossings(*world, upper, cloth, lower, cloth), 0);
}

TEST(ThinContact, SameBitsForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 4}) {
        const auto world = make_world({.workers = workers});
        add_plane(*world, friction(0.5));
        auto sheet = cloth_rectangle(1, 1, 0.045, {.area_density = 0.3});  // more than 1,000 nodes in two
        sheet.pose.position = {0, 0.02, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
        sheet.pose.position = {0.1, 0.03, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
        ASSERT_TRUE(world->create_deformable(rope_between({-0.3, 0.04, 0}, {0.3, 0.04, 0.1}, 0.05)).ok());
        run(*world, 0.2);
        hashes.push_back(world->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace embody::physics
