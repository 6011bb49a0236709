// SPDX-License-Identifier: MIT
// Deformables whose numbers overflow are stopped and reported; all others go on as though they were not there.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

enum class Matter { solid, cloth, rope };

DeformableDefinition make(Matter matter, Vec3 position) {
    DeformableDefinition definition =
        matter == Matter::solid ? tetrahedral_brick({0.4, 0.2, 0.4}, {4, 2, 4}, {.density = 100, .youngs_modulus = 2e4})
        : matter == Matter::cloth ? cloth_rectangle(0.4, 0.4, 0.05)
                                  : rope_between({}, {0.5, 0, 0}, 0.05);
    definition.pose.position = position;
    return definition;
}

/// A floor, a box that falls on where the broken one lies, and one of each matter apart, with a box each.
struct Scene {
    std::unique_ptr<World> world = make_world();
    std::vector<DeformableHandle> healthy;
    std::vector<BodyHandle> boxes;
    Scene() {
        add(PlaneShape{{0, 1, 0}, 0}, {}, BodyKind::static_body);
        for (int i = 0; i < 3; ++i) {
            healthy.push_back(world->create_deformable(make(static_cast<Matter>(i), {2.0 * i, 0.01, 3})).value());
            boxes.push_back(add(BoxShape{{0.1, 0.1, 0.1}}, {2.0 * i + 0.2, 0.5, 3.2}, BodyKind::dynamic_body));
        }
        boxes.push_back(add(BoxShape{{0.1, 0.1, 0.1}}, {0.2, 0.8, 0.2}, BodyKind::dynamic_body));
    }
    BodyHandle add(const ShapeDefinition& shape, Vec3 position, BodyKind kind) const {
        return world->create_body({.kind = kind, .shape = world->create_shape(shape).value(), .position = position})
            .value();
    }
};

class DeformableFreeze : public testing::TestWithParam<Matter> {};

TEST_P(DeformableFreeze, OverflowStopsItAndNothingElse) {
    Scene scene, without;
    const DeformableHandle broken = scene.world->create_deformable(make(GetParam(), {0, 0.01, 0})).value();
    for (int i = 0; i < 10; ++i) {
        scene.world->step();
        without.world->step();
    }
    // Finite numbers whose squares are not.
    std::vector<Vec3> positions(scene.world->node_positions(broken).begin(), scene.world->node_positions(broken).end());
    std::vector<Vec3> velocities(positions.size());
    for (std::size_t i = 0; i < positions.size(); i += 2) positions[i] = (i % 4 == 0 ? 1e200 : -1e200) * Vec3{1, 1, 1};
    ASSERT_TRUE(scene.world->set_nodes(broken, positions, velocities).ok());

    std::uint32_t limits = 0;
    for (int i = 0; i < 60; ++i) {
        limits |= scene.world->step().limits;
        without.world->step();
    }
    EXPECT_NE(limits & static_cast<std::uint32_t>(StepLimit::not_finite_deformable_frozen), 0u);
    EXPECT_TRUE(std::ranges::equal(scene.world->node_positions(broken), positions));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(std::ranges::equal(scene.world->node_positions(scene.healthy[i]),
                                       without.world->node_positions(without.healthy[i])))
            << i;
    }
    for (std::size_t i = 0; i < scene.boxes.size(); ++i)
        EXPECT_EQ(scene.world->pose(scene.boxes[i]).position, without.world->pose(without.boxes[i]).position) << i;
}

TEST_P(DeformableFreeze, StepsWithAbsurdSpeedsEndWithFiniteNodes) {
    Scene scene;
    const DeformableHandle fast = scene.world->create_deformable(make(GetParam(), {0, 0.5, 0})).value();
    const auto start = scene.world->node_positions(fast);
    const std::vector<Vec3> positions(start.begin(), start.end());
    for (const double speed : {1e3, 1e6, 1e150}) {
        std::vector<Vec3> velocities(positions.size());
        for (std::size_t i = 0; i < velocities.size(); ++i)
            velocities[i] = (i % 2 == 0 ? speed : -speed) * normalized(Vec3{1, static_cast<double>(i % 3), 1});
        ASSERT_TRUE(scene.world->set_nodes(fast, positions, velocities).ok());
        for (int i = 0; i < 3; ++i) scene.world->step();
        for (const Vec3 p : scene.world->node_positions(fast)) EXPECT_TRUE(is_finite(p)) << speed;
        for (const BodyHandle box : scene.boxes) EXPECT_TRUE(is_finite(scene.world->pose(box).position)) << speed;
    }
}

std::string name_of(const testing::TestParamInfo<Matter>& info) {
    return info.param == Matter::solid ? "solid" : info.param == Matter::cloth ? "cloth" : "rope";
}
INSTANTIATE_TEST_SUITE_P(Matters, DeformableFreeze, testing::Values(Matter::solid, Matter::cloth, Matter::rope),
                         name_of);

}  // namespace
}  // namespace embody::physics
