// SPDX-License-Identifier: MIT
// Things that break: pieces are entities, time goes back to before and after, a reset has the thing whole.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using nlohmann::json;
using samples::make;
using samples::thing;

/// A floor and a plate of 1 kg that falls on it with `speed`, breaking at 1 N s.
Document a_plate(double speed) {
    Document document = samples::floor_and_box(0.1);
    Entity& plate = document.entities[1];
    plate.name = "Plate";
    plate.geometry = physics::ShapeDefinition{physics::BoxShape{{0.15, 0.01, 0.15}}};
    plate.linear_velocity = {0, -speed, 0};
    plate.attributes = {{"mass", 1.0},         {"breaks", true},          {"break_impulse", 1.0},
                        {"break_pieces", 8.0}, {"friction_static", 0.61}, {"friction_dynamic", 0.47}};
    plate.color = std::array{0.9, 0.8, 0.7};
    return document;
}

TEST(ThingsThatBreak, BecomePiecesWithTheirMassColourAndSurface) {
    Random random(2);
    for (int run = 0; run < 10; ++run) {
        Document document = a_plate(random.between(2, 12));
        document.entities[1].pose.rotation =
            from_axis_angle({random.unit(), random.unit(), 1}, random.between(-0.3, 0.3));
        document.entities[1].pose.position.y = 0.3;
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        for (int i = 0; i < 120 && simulation->broke().empty(); ++i) simulation->step();
        ASSERT_EQ(simulation->broke().size(), 1u) << run;
        const ThingBroke broke = simulation->broke()[0];
        EXPECT_EQ(broke.entity, thing);
        EXPECT_EQ(broke.name, "Plate");
        EXPECT_GT(broke.impulse, 1);
        EXPECT_FALSE(simulation->contains(thing));
        EXPECT_EQ(simulation->despawned(), std::vector<EntityIndex>{thing});
        EXPECT_EQ(simulation->spawned().size(), broke.pieces);
        EXPECT_TRUE(simulation->problems().empty());
        double mass = 0;
        for (const EntityIndex index : simulation->spawned()) {
            mass += simulation->world().mass(simulation->body(index));
            const physics::BodyDefinition body = simulation->world().body(simulation->body(index)).value();
            EXPECT_EQ(body.material.friction_static, 0.61);
            EXPECT_EQ(body.user_data, index);
            EXPECT_EQ(simulation->definition(index)->color, document.entities[1].color);
        }
        EXPECT_NEAR(mass, 1, 1e-12);
        EXPECT_EQ(simulation->world().bodies().size(), 1 + broke.pieces) << "nothing is there twice";
        for (int i = 0; i < 60; ++i) simulation->step();
        for (const EntityIndex index : simulation->entities())
            EXPECT_TRUE(index <= last_document_index || simulation->pose(index).position.y > -0.01) << run;
    }
}

TEST(ThingsThatBreak, StayWholeWithoutAHardBlowOrTheWish) {
    const auto breaks = [](const Document& document) {
        const auto simulation = make(document);
        bool any = false;
        for (int i = 0; i < 60; ++i) {
            simulation->step();
            any = any || !simulation->broke().empty();
        }
        return any;
    };
    EXPECT_TRUE(breaks(a_plate(3)));
    Document strong = a_plate(3);
    strong.entities[1].attributes["break_impulse"] = 50.0;
    EXPECT_FALSE(breaks(strong));
    // Without a limit as glass, at 5.8 J/kg: at 3.4 m/s.
    for (const double speed : {3.0, 4.0}) {
        Document glass = a_plate(speed);
        glass.entities[1].attributes.erase("break_impulse");
        EXPECT_EQ(breaks(glass), speed > 3.4) << speed;
    }
    Document unwilling = a_plate(3);
    unwilling.entities[1].attributes["breaks"] = false;
    EXPECT_FALSE(breaks(unwilling));
    Document fixed = a_plate(3);
    fixed.entities[1].attributes["kind"] = std::string("static");
    EXPECT_FALSE(breaks(fixed));
}

TEST(ThingsThatBreak, BreakAlikeInEqualRuns) {
    const auto hash = [](int workers) {
        Document document = a_plate(8);
        document.settings.workers = workers;
        const auto simulation = make(document);
        for (int i = 0; i < 90; ++i) simulation->step();
        return simulation->world().state_hash();
    };
    EXPECT_EQ(hash(1), hash(1));
    EXPECT_EQ(hash(1), hash(3));
}

class BreakingSession : public samples::LiveSession {
protected:
    std::set<EntityIndex> shown() {
        std::set<EntityIndex> there;
        std::vector<EntityState> states;
        session_->read_states(states);
        for (const EntityState& state : states)
            if (state.entity != 1) there.insert(state.entity);
        return there;
    }
};

TEST_F(BreakingSession, TimeGoesBackToTheWholeAndToThePieces) {
    open(a_plate(8));
    (void)session_->take_events();
    run("simulation.step", {{"count", 40}});
    bool is_said = false;
    for (const json& event : session_->take_events().messages)
        if (event["event"] == "message")
            is_said = is_said || event["text"].get<std::string>().find("Plate broke into ") == 0;
    EXPECT_TRUE(is_said);
    const std::set<EntityIndex> pieces = shown();
    EXPECT_FALSE(pieces.contains(thing));
    EXPECT_GE(pieces.size(), 2u);
    run("time.seek", {{"time", 0.0}});
    EXPECT_EQ(shown(), std::set<EntityIndex>{thing});
    run("time.seek", {{"time", 40.0 / 60}});
    EXPECT_EQ(shown(), pieces);

    // A run goes on from a moment with pieces, which are where they were.
    const EntityIndex piece = *pieces.begin();
    const Vec3 was = state(piece).pose.position;
    run("time.branch");
    EXPECT_EQ(shown(), pieces);
    EXPECT_LT(length(state(piece).pose.position - was), 1e-9);
    run("simulation.step", {{"count", 10}});
    run("simulation.reset");
    EXPECT_EQ(shown(), std::set<EntityIndex>{thing});
}

}  // namespace
}  // namespace embody::scene
