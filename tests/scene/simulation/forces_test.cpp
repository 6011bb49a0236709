// SPDX-License-Identifier: MIT
// A force on an entity is one force, whatever the entity is made of: its momentum is F t.
#include <gtest/gtest.h>

#include <cmath>

#include "attributes/physical_kind.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using physics::BoxShape;
using physics::ShapeDefinition;
using samples::make;
using samples::step;
using samples::thing;

constexpr Vec3 force{12, 3, -4};  // N
constexpr int steps = 12;         // of 1/60 s
constexpr double seconds = 0.2;

class ForceOnAKind : public testing::TestWithParam<PhysicalKind> {
protected:
    // A document with one thing alone in empty space.
    static Document a_thing() {
        Document document = samples::floor_and_box(1);
        document.entities.erase(document.entities.begin());
        document.settings.gravity = {};
        document.settings.air_density = 0;
        Entity& entity = document.entities[0];
        const PhysicalKind kind = GetParam();
        const bool is_cloth = kind == PhysicalKind::cloth, is_rope = kind == PhysicalKind::rope;
        entity.geometry = ShapeDefinition{BoxShape{is_cloth  ? Vec3{0.3, 0.001, 0.3}
                                                   : is_rope ? Vec3{0.5, 0.01, 0.01}
                                                             : Vec3{0.1, 0.1, 0.1}}};
        entity.attributes = {{"kind", to_value(kind)}, {"linear_damping", 0.0}};
        if (kind == PhysicalKind::granular) entity.attributes["grain_budget"] = 100.0;
        if (kind == PhysicalKind::fluid) entity.attributes["particle_budget"] = 1000.0;
        if (kind == PhysicalKind::soft) entity.attributes["youngs_modulus"] = 1e5;
        return document;
    }
    static void expect_momentum_of(const Simulation& simulation) {
        const Vec3 expected = seconds * force, momentum = simulation.world().conserved().linear_momentum;
        // Leapfrog integration has half a step more or less.
        EXPECT_LT(length(momentum - expected), 0.51 / steps * length(expected))
            << momentum.x << " " << momentum.y << " " << momentum.z;
        EXPECT_LT(length(cross(momentum, expected)), 1e-3 * length_squared(expected)) << "along the force";
    }
};

TEST_P(ForceOnAKind, OfItsOwnGivesItsMomentum) {
    Document document = a_thing();
    document.entities[0].force = force;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, steps);
    expect_momentum_of(*simulation);

    // Without force it keeps its velocity.
    Entity without = *simulation->definition(thing);
    without.force = {};
    ASSERT_TRUE(simulation->update(without, true));
    step(*simulation, steps);
    expect_momentum_of(*simulation);
}

TEST_P(ForceOnAKind, OfAnActionGivesItsMomentum) {
    Document document = a_thing();
    Action push;
    push.id = 1;
    push.receiver = {Target::By::index, thing, {}};
    push.trigger = AtTime{0, {}};
    push.effect = ApplyForce{force, seconds};
    document.actions = {push};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, steps);
    expect_momentum_of(*simulation);
}

TEST_P(ForceOnAKind, WithoutBoundsIsRefused) {
    Document document = a_thing();
    document.entities[0].force = {1e300, 0, 0};
    const auto made = Simulation::create(document, nullptr);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message().find("force"), std::string::npos) << made.error().message();
}

INSTANTIATE_TEST_SUITE_P(Kinds, ForceOnAKind,
                         testing::Values(PhysicalKind::rigid, PhysicalKind::soft, PhysicalKind::cloth,
                                         PhysicalKind::rope, PhysicalKind::granular, PhysicalKind::fluid),
                         [](const auto& kind) { return to_text(kind.param); });

TEST(Torque, DoesNotTurnWhatIsNoRigidBodyAndSaysSo) {
    Document document = samples::floor_and_box(1);
    document.settings.gravity = {};
    document.entities[1].attributes = {{"kind", to_value(PhysicalKind::granular)}, {"grain_budget", 100.0}};
    document.entities[1].torque = {0, 1, 0};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("torque"), std::string::npos);
    step(*simulation, 2);
    EXPECT_LT(length(simulation->world().conserved().angular_momentum), 1e-9);
}

}  // namespace
}  // namespace embody::scene
