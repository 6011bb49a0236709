// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

TEST(Stack, PaperStackWithRestitutionPointEightSettlesAsAColumn) {
    const auto world = make_world({});
    const Material material{.restitution = 0.8};
    add_plane(*world, material);
    const auto box = world->create_shape(BoxShape{}).value();
    std::vector<BodyHandle> boxes;
    for (int i = 0; i < 10; ++i) {
        boxes.push_back(
            world->create_body({.shape = box, .position = {0, 1 + 1.5 * i, 0}, .material = material}).value());
    }
    const double start = energy(*world);
    for (int i = 0; i < 60 * 20; ++i) {
        world->step();
        ASSERT_LE(energy(*world), start * (1 + 1e-3)) << "step " << i;
    }
    for (int i = 0; i < 10; ++i) {
        const Vec3 p = world->pose(boxes[static_cast<std::size_t>(i)]).position;
        EXPECT_NEAR(p.y, 0.5 + i, 0.01);
        EXPECT_LT(std::hypot(p.x, p.z), 0.3);
        EXPECT_EQ(world->sleep_state(boxes[static_cast<std::size_t>(i)]), SleepState::asleep);
    }
}

TEST(Stack, FloorBearsTheWeightOfAHeavyBoxOnALightOne) {
    const auto world = make_world({});
    add_plane(*world, {});
    const auto box = world->create_shape(BoxShape{}).value();
    ASSERT_TRUE(world->create_body({.shape = box, .position = {0, 0.5, 0}, .mass = {.mass = 1}}));
    ASSERT_TRUE(world->create_body({.shape = box, .position = {0, 1.5, 0}, .mass = {.mass = 1000}}));
    run(*world, 3);
    double force = 0;
    for (const ContactView& contact : world->contacts()) {
        if (contact.a.index == 0) force += contact.impulse.y / world->settings().time_step;
    }
    EXPECT_NEAR(force, 1001 * gravity, 0.02 * 1001 * gravity);
}

TEST(Stack, PyramidOfTenRowsStandsAndSleeps) {
    const auto world = make_world({});
    add_plane(*world, {});
    const auto box = world->create_shape(BoxShape{}).value();
    std::vector<std::pair<BodyHandle, Vec3>> boxes;
    for (int row = 0; row < 10; ++row) {
        for (int i = 0; i < 10 - row; ++i) {
            const Vec3 place{(i - (9 - row) * 0.5) * 1.1, 0.5 + row, 0};
            boxes.emplace_back(world->create_body({.shape = box, .position = place}).value(), place);
        }
    }
    run(*world, 10);
    for (const auto& [body, place] : boxes) {
        EXPECT_LT(length(world->pose(body).position - place), 0.02);
        EXPECT_EQ(world->sleep_state(body), SleepState::asleep);
    }
}

}  // namespace
}  // namespace embody::physics
