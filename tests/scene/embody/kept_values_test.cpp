// SPDX-License-Identifier: MIT
// What is kept of values that entities had: a slider that is dragged makes others with each edit.
#include <gtest/gtest.h>

#include "scene/embody/entity_attributes.h"

namespace embody::scene {
namespace {

Entity box_with(double friction) {
    Entity box;
    box.index = 1;
    box.geometry = physics::ShapeDefinition{physics::BoxShape{}};
    box.attributes["friction_dynamic"] = friction;
    return box;
}

double friction_of(int i) { return 0.1 + 1e-4 * i; }

TEST(KeptValues, SetsThatNobodyHoldsGo) {
    KnownModels models(nullptr);
    EntityAttributes attributes(models);
    for (int i = 0; i < 5000; ++i) ASSERT_TRUE(attributes.shared(box_with(friction_of(i))).ok());
    EXPECT_LE(attributes.kept(), 1024U);
}

TEST(KeptValues, SetsThatEntitiesHoldStayShared) {
    KnownModels models(nullptr);
    EntityAttributes attributes(models);
    std::vector<SharedAttributes> held;
    for (int i = 0; i < 5000; ++i) held.push_back(attributes.shared(box_with(friction_of(i))).value());
    for (int i = 5000; i < 7000; ++i) ASSERT_TRUE(attributes.shared(box_with(friction_of(i))).ok());
    for (int i = 0; i < 5000; ++i) ASSERT_EQ(attributes.shared(box_with(friction_of(i))).value(), held[i]);
    EXPECT_LE(attributes.kept(), 10000U);
}

TEST(KeptValues, FactsOfPrimitivesAreFew) {
    PrimitiveFacts facts;
    for (int i = 1; i <= 5000; ++i) {
        const double size = 1e-3 * i;
        EXPECT_NEAR(facts.of(physics::BoxShape{{size, size, size}}).geometry.volume, 8 * size * size * size, 1e-9);
    }
    EXPECT_LE(facts.known(), PrimitiveFacts::max_known);
}

}  // namespace
}  // namespace embody::scene
