// SPDX-License-Identifier: MIT
// The counts in the status bar: things, whatever they are made of.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using physics::BoxShape;

Entity& add(Document& document, const char* kind, const physics::ShapeDefinition& shape, Vec3 position) {
    Entity& entity = samples::add(document, kind, shape, position);
    entity.attributes = {{"kind", std::string(kind)},
                         {"grain_budget", 100.0},
                         {"particle_budget", 500.0},
                         {"cloth_nodes", 100.0},
                         {"rope_segments", 10.0}};
    return entity;
}

/// A floor, a box, and one of each kind that is no single body, well apart and half a metre above the floor.
Document one_of_each() {
    Document document = samples::floor_and_box(0.75);
    add(document, "soft", BoxShape{{0.1, 0.1, 0.1}}, {2, 0.6, 0});
    add(document, "cloth", BoxShape{{0.2, 0.002, 0.2}}, {4, 0.5, 0});
    add(document, "rope", physics::CapsuleShape{0.01, 0.3}, {6, 0.5, 0});
    add(document, "granular", BoxShape{{0.1, 0.1, 0.1}}, {-2, 0.6, 0});
    add(document, "fluid", BoxShape{{0.1, 0.1, 0.1}}, {-4, 0.6, 0});
    add(document, "rigid", BoxShape{{0.1, 0.1, 0.1}}, {-6, 0.6, 0}).enabled = false;
    return document;
}

TEST(Activity, CountsAThingOnceWhateverItIsMadeOf) {
    const auto made = samples::make(one_of_each());
    ASSERT_TRUE(made);
    Simulation& simulation = *made;
    samples::step(simulation, 6);
    const Activity activity = simulation.activity();
    EXPECT_EQ(activity.things, 6u) << "neither the floor nor what is switched off";
    EXPECT_EQ(activity.active, 6u);
    EXPECT_EQ(activity.active + activity.wants_to_sleep + activity.asleep, activity.things);
    std::size_t points = 0;
    for (const EntityIndex index : simulation.entities()) points += samples::points_of(simulation, index).size();
    EXPECT_GT(points, 500u);
    EXPECT_EQ(activity.points, points);
}

TEST(Activity, IsToldToClientsAndFollowsWhatComesToRest) {
    auto session = Session::create(nullptr, {}).value();
    Document document = one_of_each();
    // Things that come to rest at once: the box, the pile's hundred balls, the cushion.
    std::erase_if(document.entities, [](const Entity& entity) {
        return entity.name == "cloth" || entity.name == "rope" || entity.name == "fluid";
    });
    ASSERT_TRUE(session->execute("scene.load", {{"scene", document_to_json(document)}}).ok());
    ASSERT_TRUE(session->execute("simulation.step", {{"count", 6}}).ok());
    EXPECT_EQ(session->statistics()["things"], 3);
    EXPECT_EQ(session->statistics()["active"], 3);
    EXPECT_EQ(session->statistics()["bodies"], 5) << "entities, the floor too";
    ASSERT_TRUE(session->execute("simulation.step", {{"count", 600}}).ok());
    EXPECT_EQ(session->statistics()["asleep"], 3);
    EXPECT_EQ(session->statistics()["active"], 0);
}

}  // namespace
}  // namespace embody::scene
