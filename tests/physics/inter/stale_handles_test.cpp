// SPDX-License-Identifier: MIT
// What no longer is, or never was, is refused by every call of the face and told of as nothing; nothing changes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

/// A ball on a joint, a sheet, a rope and some liquid that stay, and one of each whose handle is stale.
class StaleHandles : public testing::Test {
protected:
    StaleHandles() {
        const auto add_body = [&](Vec3 position) {
            return world_->create_body({.shape = ball_, .position = position}).value();
        };
        const auto add_joint = [&](BodyHandle body) {
            return world_->create_joint({.joint = BallJoint{}, .body_b = body}).value();
        };
        body_ = add_body({0, 3, 0});
        gone_body_ = add_body({5, 3, 0});
        joint_ = add_joint(body_);
        gone_joint_ = add_joint(gone_body_);
        gone_shape_ = world_->create_shape(SphereShape{1}).value();
        sheet_ = world_->create_deformable(cloth_rectangle(1, 1, 0.5)).value();
        rope_ = world_->create_deformable(rope_between({3, 0, 0}, {4, 0, 0}, 0.25)).value();
        gone_sheet_ = world_->create_deformable(cloth_rectangle(1, 1, 0.5)).value();
        water_ = world_->create_fluid(drops_).value();
        gone_water_ = world_->create_fluid(drops_).value();
        EXPECT_TRUE(world_->destroy_body(gone_body_));
        EXPECT_TRUE(world_->destroy_shape(gone_shape_));
        EXPECT_TRUE(world_->destroy_deformable(gone_sheet_));
        EXPECT_TRUE(world_->destroy_fluid(gone_water_));
    }

    // One that a call refuses says where and why, and leaves the world as it is.
    void expect_refused(const std::string& where, const Result<void>& result) const {
        ASSERT_FALSE(result.ok()) << where;
        EXPECT_EQ(result.error().where, where) << result.error().why;
        EXPECT_FALSE(result.error().why.empty());
        EXPECT_EQ(world_->state_hash(), hash_) << where;
    }
    template <class T>
    void expect_refused(const std::string& where, const Result<T>& result) const {
        expect_refused(where, result.ok() ? Result<void>() : Result<void>(result.error()));
    }
    void note() { hash_ = world_->state_hash(); }

    std::unique_ptr<World> world_ = World::create().value();
    ShapeHandle ball_ = world_->create_shape(SphereShape{0.5}).value(), gone_shape_;
    FluidDefinition drops_{.points = {{9, 9, 9}, {9.1, 9, 9}}, .cell_size = 0.1};
    BodyHandle body_, gone_body_;
    JointHandle joint_, gone_joint_;
    DeformableHandle sheet_, rope_, gone_sheet_;
    FluidHandle water_, gone_water_;
    std::uint64_t hash_ = 0;
};

TEST_F(StaleHandles, OfBodiesAreRefused) {
    note();
    BodyDefinition definition = world_->body(body_).value();
    for (const BodyHandle body : {gone_body_, BodyHandle{}, BodyHandle{77, 1}}) {
        expect_refused("body", world_->destroy_body(body));
        expect_refused("body", world_->destroy_bodies(std::vector{body_, body}));
        expect_refused("body", world_->set_body(body, definition));
        expect_refused("body", world_->change_bodies(std::vector{body_, body}, [](BodyDefinition& d) {
            d.force = {9, 9, 9};
        }));
        expect_refused("body", world_->set_pose(body, {}));
        expect_refused("body", world_->set_velocity(body, {}, {}));
        expect_refused("body", world_->set_force(body, {}, {}));
        expect_refused("body", world_->apply_impulse(body, {1, 0, 0}));
        expect_refused("body", world_->apply_angular_impulse(body, {1, 0, 0}));
        expect_refused("body", world_->apply_force(body, {1, 0, 0}, Vec3{}));
        expect_refused("body", world_->set_enabled(body, false));
        expect_refused("body", world_->wake(body));
        EXPECT_FALSE(world_->contains(body));
        EXPECT_FALSE(world_->body(body).has_value());
        EXPECT_EQ(world_->pose(body), Transform{});
        EXPECT_EQ(world_->linear_velocity(body), Vec3{});
        EXPECT_EQ(world_->angular_velocity(body), Vec3{});
        EXPECT_EQ(world_->sleep_state(body), SleepState::asleep);
        EXPECT_TRUE(std::isinf(world_->mass(body)));
        EXPECT_EQ(world_->center_of_mass(body), Vec3{});
        EXPECT_EQ(trace(world_->inertia(body)), 0);
        EXPECT_TRUE(world_->bounds(body).is_empty());
        EXPECT_FALSE(world_->drop_distance(body, 10).has_value());
        EXPECT_EQ(world_->fluid_force(body).force, Vec3{});
    }
    EXPECT_EQ(world_->body(body_)->force, Vec3{}) << "nor is any of several changed";
    EXPECT_EQ(world_->bodies().size(), 1u);
}

TEST_F(StaleHandles, OfShapesAndJointsAreRefused) {
    note();
    JointDefinition definition = world_->joint(joint_).value();
    for (const JointHandle joint : {gone_joint_, JointHandle{}}) {
        expect_refused("joint", world_->destroy_joint(joint));
        expect_refused("joint", world_->set_joint(joint, definition));
        EXPECT_FALSE(world_->joint(joint).has_value());
        EXPECT_EQ(world_->joint_reaction(joint).force, Vec3{});
        EXPECT_EQ(world_->joint_coordinate(joint), 0);
    }
    definition.body_b = gone_body_;
    expect_refused("body_b", world_->set_joint(joint_, definition));
    expect_refused("body_b", world_->create_joint(definition));
    definition.body_b = body_;
    definition.body_a = gone_body_;
    expect_refused("body_a", world_->set_joint(joint_, definition));
    definition.body_a = body_;
    expect_refused("body_a", world_->create_joint(definition));
    EXPECT_EQ(world_->joint(joint_)->body_a, BodyHandle{});
    expect_refused("shape", world_->destroy_shape(gone_shape_));
    expect_refused("shape", world_->destroy_shape(ball_));
    EXPECT_FALSE(world_->volume(gone_shape_).has_value());
    expect_refused("shape", world_->create_body({.shape = gone_shape_}));
    expect_refused("surface_pairs", world_->set_surface_pairs({}));
}

TEST_F(StaleHandles, OfDeformablesAreRefused) {
    note();
    const DeformableDefinition definition = cloth_rectangle(1, 1, 0.5);
    const std::vector<Vec3> nodes(definition.nodes.size());
    for (const DeformableHandle gone : {gone_sheet_, DeformableHandle{}}) {
        expect_refused("deformable", world_->destroy_deformable(gone));
        expect_refused("deformable", world_->wake(gone));
        expect_refused("deformable", world_->set_nodes(gone, nodes, nodes));
        expect_refused("deformable", world_->set_deformable(gone, definition));
        expect_refused("deformable", world_->set_attachments(gone, {}));
        expect_refused("deformable", world_->set_lasting_deformation(gone, {}));
        EXPECT_TRUE(world_->lasting_deformation(gone).plastic_strain.empty() &&
                    world_->lasting_deformation(gone).broken_segments.empty());
        EXPECT_EQ(world_->deformable(gone), nullptr);
        EXPECT_TRUE(world_->node_positions(gone).empty() && world_->node_velocities(gone).empty() &&
                    world_->node_masses(gone).empty() && world_->rope_tensions(gone).empty() &&
                    world_->rope_twists(gone).empty() && world_->broken_segments(gone).empty());
        EXPECT_EQ(world_->pose(gone), Transform{});
        EXPECT_EQ(world_->mass(gone), 0);
        EXPECT_EQ(world_->center_of_mass(gone), Vec3{});
        EXPECT_TRUE(world_->is_asleep(gone));
        EXPECT_FALSE(world_->nearest_tie(0, gone, {}).has_value());
        // Nor may another be held by one.
        expect_refused("ties[0]", world_->set_attachments(rope_, {}, {}, {{.node = 0, .other = gone}}));
    }
    expect_refused("attachments[0]", world_->set_attachments(rope_, {{0, gone_body_, {}}}));
    expect_refused("ties[0]", world_->set_attachments(rope_, {}, {}, {{.node = 0, .other = rope_}}));
    expect_refused("ties[0].other_nodes",
                   world_->set_attachments(rope_, {}, {}, {{.node = 0, .other = sheet_, .other_nodes = {9999, 0, 0}}}));
    EXPECT_TRUE(world_->rope_tensions(sheet_).empty()) << "a sheet has no tensions of segments";
    EXPECT_EQ(world_->rope_tensions(rope_).size(), 4u);
    EXPECT_EQ(world_->deformables().size(), 2u);
}

TEST_F(StaleHandles, OfFluidsAreRefused) {
    note();
    const std::vector<Vec3> places{{9, 9.5, 9}};
    const FluidChange keep = [](std::uint32_t, Vec3&, Vec3&) { return true; };
    for (const FluidHandle gone : {gone_water_, FluidHandle{}}) {
        expect_refused("fluid", world_->destroy_fluid(gone));
        expect_refused("fluid", world_->set_fluid(gone, drops_));
        expect_refused("fluid", world_->add_to_fluid(gone, places));
        expect_refused("fluid", world_->change_fluid(gone, {0, 10}, keep));
        expect_refused("fluid", world_->wake(gone));
        expect_refused("from", world_->move_between_fluids(gone, {0, 1}, water_));
        EXPECT_EQ(world_->fluid(gone), nullptr);
        EXPECT_TRUE(world_->fluid_particles(gone).positions.empty());
        EXPECT_EQ(world_->fluid_pressure(gone, {9, 9, 9}), 0);
    }
    expect_refused("to", world_->move_between_fluids(water_, {0, 1}, gone_water_));
    expect_refused("to", world_->move_between_fluids(water_, {0, 1}, water_));
    EXPECT_EQ(world_->fluids().size(), 1u);
}

// Handles of one slot, again and again: the last alone is known.
TEST_F(StaleHandles, AreDistinguishedFromThoseThatReuseTheirSlot) {
    for (int i = 0; i < 20; ++i) {
        const BodyHandle body = world_->create_body({.shape = ball_, .position = {50, 0, 0}}).value();
        EXPECT_EQ(body.index, gone_body_.index);
        EXPECT_FALSE(world_->contains(gone_body_));
        EXPECT_TRUE(world_->contains(body));
        ASSERT_TRUE(world_->destroy_body(body));
        EXPECT_FALSE(world_->contains(body));
    }
}

}  // namespace
}  // namespace embody::physics
