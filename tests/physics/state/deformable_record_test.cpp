// SPDX-License-Identifier: MIT
// A deformable as the world keeps it, whatever its matter is.
#include "physics/state/deformable_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/definitions/deformable_primitives.h"
#include "physics/state/deformable_state.h"

namespace embody::physics::state {
namespace {

std::vector<DeformableDefinition> one_of_each() {
    return {tetrahedral_brick({0.3, 0.2, 0.2}, {2, 1, 1}), cloth_rectangle(0.4, 0.3, 0.1),
            rope_between({0, 0, 0}, {0, 0, 1}, 0.2)};
}

TEST(DeformableRecord, HoldsTheMatterOfItsDefinition) {
    const auto definitions = one_of_each();
    for (std::size_t i = 0; i < definitions.size(); ++i) {
        const DeformableRecord record = make_deformable_record(definitions[i]).value();
        EXPECT_EQ(record.solid() != nullptr, i == 0);
        EXPECT_EQ(record.cloth() != nullptr, i == 1);
        EXPECT_EQ(record.rope() != nullptr, i == 2);
        EXPECT_EQ(record.nodes().size(), definitions[i].nodes.size());
        EXPECT_EQ(record.segment_capsule.size(), i == 2 ? definitions[i].nodes.size() - 1 : 0);
        EXPECT_NE(record.node_ball, nullptr);
        EXPECT_TRUE(record.is_finite());
        const Bounds box = record.bounds();
        for (const Vec3 p : record.nodes().position) {
            EXPECT_TRUE(contains(enlarged(box, 1e-9), Bounds{p, p}));
        }
    }
}

TEST(DeformableRecord, MovesAndStopsAsItIsTold) {
    for (const DeformableDefinition& definition : one_of_each()) {
        DeformableRecord record = make_deformable_record(definition).value();
        std::vector<Vec3> places = record.nodes().position, velocities(places.size(), Vec3{1, 2, 3});
        for (Vec3& p : places) p += Vec3{5, 6, 7};
        record.set_motion(places, velocities, {});
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_LT(length(record.nodes().position[i] - places[i]), 1e-9);
            EXPECT_LT(length(record.nodes().velocity[i] - velocities[i]), 1e-9);
        }
        double mass = 0;
        for (const double m : record.nodes().mass) mass += m;
        const Conserved moving = record.conserved({});
        EXPECT_LT(length(moving.linear_momentum - Vec3{1, 2, 3} * mass), 1e-9 * mass);
        EXPECT_NEAR(moving.kinetic_energy, mass * 7, 1e-6 * mass);
        record.rest();
        EXPECT_EQ(record.conserved({}).kinetic_energy, 0);
        places[0].y = std::numeric_limits<double>::quiet_NaN();
        record.set_motion(places, velocities, {});
        // Sheets and ropes tell what their last step came to.
        EXPECT_EQ(record.is_finite(), record.solid() == nullptr);
        places[0].y = 6;
        record.stop_at(places);
        EXPECT_TRUE(record.is_finite());
        EXPECT_EQ(record.conserved({}).kinetic_energy, 0);
    }
}

TEST(DeformableRecord, IsAcceleratedByGravityAndItsForce) {
    for (DeformableDefinition definition : one_of_each()) {
        definition.gravity_factor = 0.5;
        const DeformableRecord light = make_deformable_record(definition).value();
        EXPECT_LT(length(light.acceleration({0, -10, 0}) - Vec3{0, -5, 0}), 1e-12);
        double mass = 0;
        for (const double m : light.nodes().mass) mass += m;
        definition.force = {2, 0, 0};
        const DeformableRecord pushed = make_deformable_record(definition).value();
        EXPECT_LT(length(pushed.acceleration({0, -10, 0}) - Vec3{2 / mass, -5, 0}), 1e-9 / mass);
    }
}

TEST(DeformableRecord, KnowsWhoseTetrahedraAreItsOwn) {
    const DeformableDefinition brick = tetrahedral_brick({0.3, 0.2, 0.2}, {2, 1, 1});
    const DeformableRecord one = make_deformable_record(brick).value(), same = make_deformable_record(brick).value(),
                           finer = make_deformable_record(tetrahedral_brick({0.3, 0.2, 0.2}, {3, 1, 1})).value(),
                           sheet = make_deformable_record(cloth_rectangle(0.4, 0.3, 0.1)).value();
    EXPECT_TRUE(one.has_tetrahedra_of(same));
    EXPECT_FALSE(one.has_tetrahedra_of(finer));
    EXPECT_FALSE(one.has_tetrahedra_of(sheet));
    EXPECT_FALSE(sheet.has_tetrahedra_of(one));
}

TEST(DeformableRecord, KnowsHowTheWholeIsTurned) {
    DeformableDefinition brick = tetrahedral_brick({0.3, 0.2, 0.2}, {2, 1, 1});
    brick.pose.rotation = from_axis_angle({0, 0, 1}, 0.7);
    const DeformableRecord record = make_deformable_record(brick).value();
    EXPECT_GT(std::fabs(dot(record.rotation(), brick.pose.rotation)), 0.99);
}

TEST(DeformableState, RecordsComeAndGoByHandles) {
    DeformableState state;
    const auto rope = state.records.insert(make_deformable_record(rope_between({0, 0, 0}, {0, 0, 1}, 0.2)).value());
    EXPECT_EQ(state.records.count(), 1u);
    EXPECT_TRUE(state.records.remove(rope));
    EXPECT_EQ(state.records.find(rope), nullptr);
}

}  // namespace
}  // namespace embody::physics::state
