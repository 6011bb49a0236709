// SPDX-License-Identifier: MIT
// Taps and drains in a session: placing, undo, copies, groups, and what is changed while it runs.
#include <algorithm>

#include "scene/live_scene.h"
#include "scene/session/session_fixture.h"

namespace embody::scene {
namespace {

using nlohmann::json;

class PortSession : public SessionTest {
protected:
    static json tap_json(EntityIndex liquid = 0) {
        return {{"name", "Tap"},
                {"shape", {{"type", "cylinder"}, {"radius", 0.02}, {"half_height", 0.02}}},
                {"pose", {{"position", {0, 1, 0}}}},
                {"attributes", {{"kind", "static"}}},
                {"tap", {{"litres_per_minute", 120}, {"position", {0, -0.05, 0}}, {"liquid", liquid}}}};
    }
    EntityIndex add_tap(EntityIndex liquid = 0) { return run("entity.add", {{"entity", tap_json(liquid)}})["index"]; }
    const Entity* entity(const std::string& name) {
        const auto& entities = session_->document().entities;
        const auto found = std::ranges::find(entities, name, &Entity::name);
        return found == entities.end() ? nullptr : &*found;
    }
    std::size_t drops(EntityIndex index) {
        std::vector<EntityState> states;
        session_->read_states(states);
        std::vector<Vec3> places;
        for (const EntityState& state : states)
            if (state.entity == index && state.points != nullptr) state.points->read(places);
        return places.size();
    }
    void play(int steps) {
        run("simulation.play");
        for (int i = 0; i < steps; ++i) session_->step();
        run("simulation.pause");
    }
};

TEST_F(PortSession, ATapBringsWaterWhereThereIsNoLiquidAndOneUndoTakesBothAway) {
    const json before = document();
    const EntityIndex tap = add_tap();
    ASSERT_NE(entity("Water"), nullptr);
    const EntityIndex water = entity("Water")->index;
    EXPECT_TRUE(entity("Water")->starts_empty);
    add_tap();
    EXPECT_EQ(document()["entities"].size(), before["entities"].size() + 3) << "there is a liquid now";
    play(30);
    EXPECT_GT(drops(water), 0u);
    run("simulation.reset");
    EXPECT_EQ(drops(water), 0u);
    const json after = document();
    run("edit.undo");
    run("edit.undo");
    EXPECT_EQ(document()["entities"], before["entities"]);
    run("edit.redo");
    run("edit.redo");
    EXPECT_EQ(document(), after);
    EXPECT_EQ(session_->document().find(tap)->tap.litres_per_minute, 120);
}

TEST_F(PortSession, CopiesFeedTheCopyOfTheirLiquid) {
    add_tap();
    const EntityIndex water = entity("Water")->index;
    const EntityIndex tap = add_tap(water);
    const json copies = run("entity.duplicate", {{"indices", {tap, water}}})["indices"];
    std::set<EntityIndex> made(copies.begin(), copies.end());
    for (const EntityIndex copy : made) {
        const Tap& its = session_->document().find(copy)->tap;
        if (its.litres_per_minute > 0) EXPECT_TRUE(made.contains(its.liquid));
    }
    const json alone = run("entity.duplicate", {{"indices", {tap}}})["indices"];
    EXPECT_EQ(session_->document().find(alone[0])->tap.liquid, water);

    // In a part of the scene the liquid is another one's number.
    const json both = run("entity.copy", {{"indices", {tap, water}}})["part"];
    const json pasted = run("entity.paste", {{"part", both}, {"offset", {0, 0, 1}}})["indices"];
    std::set<EntityIndex> in(pasted.begin(), pasted.end());
    for (const EntityIndex copy : in) {
        const Tap& its = session_->document().find(copy)->tap;
        if (its.litres_per_minute > 0) EXPECT_TRUE(in.contains(its.liquid));
    }
    const json part = run("entity.copy", {{"indices", {tap}}})["part"];
    const json one = run("entity.paste", {{"part", part}, {"offset", {0, 0, 2}}})["indices"];
    EXPECT_EQ(session_->document().find(one[0])->tap.liquid, 0u);
    run("entity.group", {{"indices", {tap, water}}});
    play(5);
}

TEST_F(PortSession, WhileItRunsLiquidsGoAndComeAndTapsAreShut) {
    const EntityIndex tap = add_tap();
    const EntityIndex water = entity("Water")->index;
    play(30);
    const std::size_t poured = drops(water);
    EXPECT_GT(poured, 0u);
    run("entity.update", {{"index", tap}, {"entity", {{"tap", {{"open", false}}}}}});
    EXPECT_EQ(session_->document().find(tap)->tap.litres_per_minute, 120) << "other fields stay";
    play(30);
    EXPECT_EQ(drops(water), poured);
    run("entity.update", {{"index", tap}, {"entity", {{"tap", {{"open", true}}}}}});
    run("entity.remove", {{"indices", {water}}});
    const auto messages = session_->take_events().messages;
    EXPECT_TRUE(std::ranges::any_of(messages, [](const json& told) {
        return told["event"] == "message" && told["text"].get<std::string>().find("tap.liquid") != std::string::npos;
    }));
    play(30);
    run("edit.undo");
    play(30);
    EXPECT_GT(drops(water), 0u);
    run("entity.remove", {{"indices", {tap}}});
    play(30);
    EXPECT_NE(error_of("entity.update", {{"index", water}, {"entity", {{"tap", {{"litres_per_minute", -1}}}}}})
                  .find("tap.litres_per_minute"),
              std::string::npos);
}

// A liquid without a drop is arranged, copied and put down as the shape that it is to fill.
TEST_F(PortSession, AnEmptyLiquidIsPlacedAsItsShape) {
    const EntityIndex tap = add_tap();
    const EntityIndex water = entity("Water")->index;
    const auto bounds = [&] {
        const auto simulation = samples::make(session_->document());
        return simulation ? simulation->bounds(water) : Bounds{};
    };
    const Bounds before = bounds();
    EXPECT_NEAR(before.size().x, 0.5, 0.1);
    EXPECT_NEAR(before.upper.y, 0.95, 0.05);
    run("entity.align", {{"indices", {tap, water}}, {"axis", "x"}, {"at", "low"}});
    const EntityIndex copy = run("entity.duplicate", {{"indices", {water}}})["indices"][0];
    run("entity.drop_to_floor", {{"indices", {water, copy}}});
    run("entity.move", {{"indices", {water}}, {"offset", {0, 1, 0}}});
    EXPECT_NEAR(bounds().center().y, before.center().y + 1, 0.1);
    for (const Entity& each : session_->document().entities) EXPECT_TRUE(is_finite(each.pose.position)) << each.name;
    play(30);
}

TEST_F(PortSession, ATapThatWaitsIsNamedOnce) {
    json tap = tap_json();
    tap["name"] = "Kitchen tap";
    tap["tap"]["litres_per_minute"] = 6000;
    tap["tap"]["radius"] = 0.1;
    run("entity.add", {{"entity", tap}});
    add_tap();
    run("entity.set_attribute", {{"indices", {entity("Water")->index}}, {"name", "particle_budget"}, {"value", 200}});
    (void)session_->take_events();
    play(240);
    int told = 0;
    for (const json& event : session_->take_events().messages)
        if (event["event"] == "message" && event["text"].get<std::string>().starts_with("Kitchen tap: the tap waits"))
            ++told;
    EXPECT_EQ(told, 1);
}

}  // namespace
}  // namespace embody::scene
