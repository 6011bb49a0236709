// SPDX-License-Identifier: MIT
// Bodies that slide over meshes feel the ground, not its triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

constexpr Material smooth{.friction_static = 0, .friction_dynamic = 0};

BodyHandle add(World& world, const ShapeDefinition& shape, BodyDefinition body) {
    body.shape = world.create_shape(shape).value();
    return world.create_body(body).value();
}

/// A strip of `count` squares of `size` m along X, 8 m wide, whose height is that of `height` at each X.
template <class Height>
MeshShape strip(int count, double size, Height height) {
    MeshShape mesh;
    for (int x = 0; x <= count; ++x) {
        for (const double z : {-4.0, 4.0}) mesh.positions.push_back(to_vec3f({x * size, height(x * size), z}));
    }
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(count); ++x) {
        mesh.triangles.push_back({2 * x, 2 * x + 1, 2 * x + 3});
        mesh.triangles.push_back({2 * x, 2 * x + 3, 2 * x + 2});
    }
    return mesh;
}

const ShapeDefinition sliders[] = {
    BoxShape{{0.3, 0.2, 0.25}},
    HullShape{{{-0.3, -0.2, -0.25}, {0.3, -0.2, -0.25}, {0.3, -0.2, 0.25}, {-0.3, -0.2, 0.25}, {0, 0.3, 0}}}};

TEST(MeshSlide, a_smooth_flat_mesh_neither_brakes_nor_turns_nor_lifts) {
    for (const ShapeDefinition& slider : sliders) {
        auto world = make_world();
        add(*world, strip(120, 0.37, [](double) { return 0.0; }), {.kind = BodyKind::static_body, .material = smooth});
        const auto body =
            add(*world, slider, {.position = {1, 0.2, 0.1}, .linear_velocity = {4, 0, 0}, .material = smooth});
        for (int step = 0; step < 600; ++step) {
            world->step();
            ASSERT_NEAR(world->pose(body).position.y, 0.2, 2e-4) << "step " << step;
        }
        EXPECT_NEAR(world->linear_velocity(body).x, 4, 1e-4);
        EXPECT_NEAR(world->linear_velocity(body).z, 0, 1e-4);
        EXPECT_LT(length(world->angular_velocity(body)), 1e-3);
    }
}

TEST(MeshSlide, friction_on_a_mesh_stops_after_v2_over_2_mu_g_with_one_begin_of_contact) {
    for (const ShapeDefinition& slider : sliders) {
        auto world = make_world();
        const Material rough{.friction_static = 0.4, .friction_dynamic = 0.4};
        add(*world, strip(120, 0.37, [](double) { return 0.0; }), {.kind = BodyKind::static_body, .material = rough});
        const auto body =
            add(*world, slider, {.position = {1, 0.2, 0.1}, .linear_velocity = {6, 0, 0}, .material = rough});
        int begins = 0;
        for (int step = 0; step < 180; ++step) {
            world->step();
            for (const ContactEvent& event : world->contact_events()) begins += event.kind == ContactEvent::Kind::begin;
        }
        EXPECT_NEAR(world->pose(body).position.x, 1 + 36 / (2 * 0.4 * 9.81), 0.05);
        EXPECT_EQ(begins, 1);
    }
}

// Over a round hill of facets that bend away by two degrees each, nothing ever stands in the way of what slides down.
TEST(MeshSlide, down_a_faceted_hill_it_only_gets_faster) {
    const auto hill = [](double x) { return -x * x / 60; };
    for (const ShapeDefinition& slider : sliders) {
        auto world = make_world();
        add(*world, strip(60, 0.5, hill), {.kind = BodyKind::static_body, .material = smooth});
        const auto body =
            add(*world, slider, {.position = {1, 0.2, 0}, .linear_velocity = {1, 0, 0}, .material = smooth});
        double fastest = 0;
        for (int step = 0; step < 150; ++step) {
            world->step();
            const double speed = world->linear_velocity(body).x;
            ASSERT_GT(speed, fastest - 2e-3) << "step " << step;
            fastest = std::fmax(fastest, speed);
        }
        EXPECT_GT(fastest, 2);
        EXPECT_NEAR(world->linear_velocity(body).z, 0, 0.02);
    }
}

}  // namespace
}  // namespace embody::physics::stages
