// SPDX-License-Identifier: MIT
// Hands of clients in a session: who holds what, when it is let go, and what touching hands push.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/session/session_state.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using nlohmann::json;
using physics::BoxShape;
using physics::CapsuleShape;
using physics::ShapeDefinition;
using samples::thing;

constexpr ClientId ann = 1, ben = 2;

class HandsSession : public samples::LiveSession {
protected:
    // A floor and boxes of 20 cm and a kilogram, side by side.
    void open_boxes(int count, double mass = 1) {
        Document document = samples::floor_and_box(0.1);
        document.entities.resize(1);
        for (int i = 0; i < count; ++i) {
            Entity& box = samples::add(document, "Box", BoxShape{{0.1, 0.1, 0.1}}, {i - 0.5, 0.1, 0});
            box.index = thing + static_cast<EntityIndex>(i);
            box.attributes["mass"] = mass;
        }
        document.next_index = thing + static_cast<EntityIndex>(count);
        open(document);
        run("simulation.play");
    }
    json as(ClientId client, const std::string& command, const json& params = json::object()) {
        auto result = session_->execute(command, params, client);
        EXPECT_TRUE(result.ok()) << command << ": " << (result.ok() ? "" : result.error().message());
        return result.ok() ? result.value() : json();
    }
    std::string error_of(const std::string& command, const json& params, ClientId client = ann) {
        const auto result = session_->execute(command, params, client);
        return result.ok() ? "accepted" : result.error().message();
    }
    void step(int count) {
        for (int i = 0; i < count; ++i) session_->step();
    }
    Vec3 at(EntityIndex index) { return state(index).pose.position; }
    void hold(ClientId client, EntityIndex index, Vec3 target, const json& more = json::object()) {
        const Vec3 p = at(index);
        json params = {{"index", index}, {"point", {p.x, p.y, p.z}}, {"target", {target.x, target.y, target.z}}};
        params.update(more);
        as(client, "simulation.grab", params);
    }
    void touch(ClientId client, Vec3 position, const json& more = json::object()) {
        json params = {{"hand", "left"}, {"position", {position.x, position.y, position.z}}};
        params.update(more);
        as(client, "simulation.touch", params);
    }
    // Moves a touching hand along a line with this speed, m/s.
    void sweep(Vec3 from, Vec3 to, double speed, const json& more = json::object()) {
        const int steps = static_cast<int>(std::ceil(length(to - from) / speed * 60));
        for (int i = 0; i <= steps; ++i) {
            touch(ann, from + (to - from) * (static_cast<double>(i) / steps), more);
            session_->step();
        }
    }
    std::vector<Vec3> points(EntityIndex index = thing) {
        std::vector<Vec3> found;
        if (const EntityState now = state(index); now.points) now.points->read(found);
        return found;
    }
    std::vector<json> told_to(ClientId client, const std::string& name) {
        std::vector<json> found;
        for (const auto& [recipient, event] : session_->take_events().directed)
            if (recipient == client && event.at("event") == name) found.push_back(event);
        return found;
    }
};

TEST_F(HandsSession, TwoClientsHoldTheirOwnThingsAndALeavingOneLetsGo) {
    open_boxes(2);
    hold(ann, 2, {-0.5, 1, 0});
    hold(ben, 3, {0.5, 1, 0});
    step(90);
    EXPECT_NEAR(at(2).y, 1, 0.01);
    EXPECT_NEAR(at(3).y, 1, 0.01);
    as(ben, "simulation.move_grab", {{"target", {0.5, 1.5, 0}}});
    step(60);
    EXPECT_NEAR(at(2).y, 1, 0.01) << "Ben moves what he holds";
    EXPECT_NEAR(at(3).y, 1.5, 0.01);
    as(ben, "simulation.release");
    step(60);
    EXPECT_NEAR(at(2).y, 1, 0.01) << "Ben lets go of what he holds";
    EXPECT_LT(at(3).y, 0.2);
    session_->forget_client(ann);
    step(60);
    EXPECT_LT(at(2).y, 0.2) << "nobody is there to hold it";
    EXPECT_NE(error_of("simulation.move_grab", {{"target", {0, 0, 0}}}).find("holds nothing"), std::string::npos);
}

TEST_F(HandsSession, AHandThatGrabsAnewLetsGoFirst) {
    open_boxes(2);
    hold(ann, 2, {-0.5, 1, 0});
    hold(ann, 3, {0.5, 1, 0}, {{"hand", "right"}});
    step(60);
    hold(ann, 3, {0.5, 1, 0});
    step(60);
    EXPECT_LT(at(2).y, 0.2);
    EXPECT_NEAR(at(3).y, 1, 0.01) << "both hands";
    as(ann, "simulation.release", {{"hand", "right"}});
    step(60);
    EXPECT_NEAR(at(3).y, 1, 0.01) << "the mouse still has it";
}

TEST_F(HandsSession, TwoHandsLiftWhatIsTooHeavyForOne) {
    open_boxes(1, 60);
    hold(ann, 2, {-0.5, 1, 0});
    step(90);
    EXPECT_LT(at(2).y, 0.15) << "600 N by 400 N";
    hold(ben, 2, {-0.5, 1, 0});
    step(90);
    EXPECT_NEAR(at(2).y, 1, 0.02);
    session_->forget_client(ben);
    step(90);
    EXPECT_LT(at(2).y, 0.15);
    hold(ann, 2, {-0.5, 1, 0}, {{"strength", 1000}});
    step(90);
    EXPECT_NEAR(at(2).y, 1, 0.02);
}

TEST_F(HandsSession, AHeldThingTurnsAsTheHandTurns) {
    open_boxes(1);
    const Quat first = from_axis_angle({1, 0, 0}, 0.4), turn = from_axis_angle({0, 0, 1}, 1.2), last = turn * first;
    hold(ann, 2, {-0.5, 1, 0}, {{"rotation", {first.x, first.y, first.z, first.w}}});
    step(90);
    EXPECT_GT(std::fabs(state(2).pose.rotation.w), 0.9999) << "it is held as it lay";
    as(ann, "simulation.move_grab", {{"target", {-0.5, 1, 0}}, {"rotation", {last.x, last.y, last.z, last.w}}});
    step(90);
    EXPECT_GT(std::fabs(dot(state(2).pose.rotation, turn)), 0.9999);
}

TEST_F(HandsSession, ResetRemovalAndAnotherDocumentLetGo) {
    const json place = {{"target", {0, 1, 0}}};
    open_boxes(2);
    hold(ann, 2, {-0.5, 1, 0});
    run("entity.remove", {{"indices", {2}}});
    EXPECT_NE(error_of("simulation.move_grab", place).find("removed"), std::string::npos);
    run("edit.undo");
    step(60);
    EXPECT_LT(at(2).y, 0.2) << "what comes back is held by nobody";
    hold(ann, 3, {0.5, 1, 0});
    run("simulation.reset");
    EXPECT_NE(error_of("simulation.move_grab", place).find("holds nothing"), std::string::npos);
    run("simulation.play");
    step(60);
    EXPECT_LT(at(3).y, 0.2);
    hold(ann, 3, {0.5, 1, 0});
    run("scene.new");
    EXPECT_NE(error_of("simulation.move_grab", place).find("holds nothing"), std::string::npos);
}

TEST_F(HandsSession, RefusalsSayWhatToDo) {
    open_boxes(1);
    const auto grab = [](EntityIndex index, const json& more = json::object()) {
        json params = {{"index", index}, {"point", {0, 0, 0}}, {"target", {0, 0, 0}}};
        params.update(more);
        return params;
    };
    EXPECT_NE(error_of("simulation.grab", grab(1)).find("Floor does not move"), std::string::npos);
    EXPECT_NE(error_of("simulation.grab", grab(9)).find("is not in the world"), std::string::npos);
    EXPECT_NE(error_of("simulation.grab", grab(2, {{"strength", 0}})).find("strength"), std::string::npos);
    EXPECT_NE(error_of("simulation.grab", grab(2, {{"hand", std::string(33, 'h')}})).find("32 bytes"),
              std::string::npos);
    EXPECT_NE(error_of("simulation.grab", grab(2, {{"hand", ""}})).find("hand"), std::string::npos);
    EXPECT_NE(error_of("simulation.touch", {{"position", {0, 0, 0}}, {"radius", 2}}).find("radius"), std::string::npos);
    EXPECT_NE(error_of("simulation.listen", json::object()).find("impacts"), std::string::npos);
    for (int i = 0; i < 16; ++i) touch(ann, {0, 5, 0}, {{"hand", "finger " + std::to_string(i)}});
    EXPECT_NE(error_of("simulation.grab", grab(2)).find("at most 16 hands"), std::string::npos);
    run("simulation.reset");
    EXPECT_NE(error_of("simulation.grab", grab(2)).find("stopped"), std::string::npos);
    EXPECT_NE(error_of("simulation.touch", {{"position", {0, 0, 0}}}).find("stopped"), std::string::npos);
    as(ann, "simulation.touch");
}

TEST_F(HandsSession, ATouchingHandPushesAndIsNoPartOfTheScene) {
    open_boxes(1);
    step(30);
    const std::size_t entities = run("hello").value("spawned", json::array()).size();
    touch(ann, {-0.9, 0.1, 0});
    step(1);
    std::vector<EntityState> states;
    session_->read_states(states);
    EXPECT_EQ(states.size(), 2u);
    EXPECT_EQ(session_->statistics().at("bodies"), 2);
    EXPECT_EQ(run("hello").value("spawned", json::array()).size(), entities);
    const json ray = {{"origin", {-2, 0.1, 0}}, {"direction", {1, 0, 0}}};
    EXPECT_EQ(run("scene.pick", ray).at("hit").at("index"), 2) << "through the hand";
    sweep({-0.9, 0.1, 0}, {-0.2, 0.1, 0}, 0.5);
    EXPECT_NEAR(at(2).x, -0.05, 0.06) << "pushed before the hand";

    // Put elsewhere, a hand sweeps nothing away.
    const double pushed = at(2).x;
    touch(ann, {-2, 0.1, 0});
    step(30);
    touch(ann, {2, 0.1, 0});
    step(30);
    EXPECT_NEAR(at(2).x, pushed, 0.05);
    as(ann, "simulation.touch", {{"hand", "left"}});
    EXPECT_NEAR(at(2).x, pushed, 0.05);
}

TEST_F(HandsSession, ATouchingHandIsNoStrongerThanItsStrength) {
    open_boxes(1, 300);
    step(30);
    sweep({-0.9, 0.1, 0}, {-0.1, 0.1, 0}, 1);
    step(60);
    EXPECT_NEAR(at(2).x, -0.5, 0.01) << "400 N do not push 300 kg";
}

TEST_F(HandsSession, AHandThatPressesThroughAThingStaysOnItAndNothingFlies) {
    for (const double mass : {0.05, 1.0, 30.0}) {
        open_boxes(1, mass);
        step(30);
        sweep({-0.5, 0.5, 0}, {-0.5, -0.3, 0}, 2);
        double fastest = 0;
        for (int i = 0; i < 120; ++i) {
            const Vec3 before = at(2);
            step(1);
            fastest = std::max(fastest, 60 * length(at(2) - before));
        }
        EXPECT_LT(fastest, 0.5) << mass;
        EXPECT_NEAR(at(2).y, 0.1, 0.02) << mass << " kg neither sink into the floor nor leave it";
    }
}

TEST_F(HandsSession, ATouchGoesWithItsClientAndWithAReset) {
    open_boxes(1);
    const auto is_blocked = [&] {
        // A box falls on the hand, or past it.
        run("entity.transform", {{"poses", {{{"index", 2}, {"position", {3, 1.2, 0}}}}}});
        step(60);
        return at(2).y > 0.5;
    };
    touch(ann, {3, 0.8, 0}, {{"radius", 0.3}});
    EXPECT_TRUE(is_blocked());
    session_->forget_client(ann);
    EXPECT_FALSE(is_blocked());
    touch(ann, {3, 0.8, 0}, {{"radius", 0.3}});
    EXPECT_TRUE(is_blocked());
    run("simulation.reset");
    run("simulation.play");
    EXPECT_FALSE(is_blocked());
}

TEST_F(HandsSession, AHandPassesThroughWhatItHoldsUntilItHasLeftIt) {
    open_boxes(1);
    step(30);
    touch(ann, {-0.5, 0.5, 0});
    hold(ann, 2, {-0.5, 0.6, 0}, {{"hand", "left"}});
    touch(ann, {-0.5, 0.6, 0});
    step(60);
    EXPECT_NEAR(at(2).y, 0.6, 0.01) << "the ball within it does not push it away";
    as(ann, "simulation.release", {{"hand", "left"}});
    step(3);
    EXPECT_NEAR(at(2).x, -0.5, 0.005);
    EXPECT_NEAR(at(2).y, 0.6 - 0.5 * 9.81 * 0.05 * 0.05, 0.01) << "it falls freely";
    step(60);
    EXPECT_LT(at(2).y, 0.15) << "away from under the hand";
}

// Cloth, soft things, ropes, grains and liquids are pushed aside by a hand at 2 m/s, and none of them comes through.
class TouchedMatter : public HandsSession {
protected:
    double moved(const std::vector<Vec3>& before) {
        double sum = 0;
        const std::vector<Vec3> now = points();
        EXPECT_EQ(now.size(), before.size());
        for (std::size_t i = 0; i < std::min(now.size(), before.size()); ++i) sum += length(now[i] - before[i]);
        return sum / static_cast<double>(std::max<std::size_t>(before.size(), 1));
    }
    void open_thing(const ShapeDefinition& shape, Vec3 position, PhysicalKind kind, const json& more = {}) {
        Document document = samples::floor_and_box(position.y);
        Entity& entity = document.entities[1];
        entity.geometry = shape;
        entity.pose.position = position;
        entity.attributes["kind"] = to_value(kind);
        for (const auto& [name, value] : more.items()) entity.attributes[name] = value.get<double>();
        open(document);
    }
    // The deepest point within the ball of 8 cm.
    double depth_in(Vec3 ball) {
        double deepest = 0;
        for (const Vec3 p : points()) deepest = std::max(deepest, 0.08 - length(p - ball));
        return deepest;
    }
};

TEST_F(TouchedMatter, ClothIsPushedAside) {
    open_thing(BoxShape{{0.5, 0.5, 0.001}}, {0, 1.6, 0}, PhysicalKind::cloth, {{"cloth_nodes", 600.0}});
    run("entity.update",
        {{"index", thing}, {"entity", {{"pins", {{{"position", {-0.5, 0.5, 0}}}, {{"position", {0.5, 0.5, 0}}}}}}}});
    run("simulation.play");
    step(60);
    sweep({0, 1.5, 0.4}, {0, 1.5, -0.3}, 2, {{"radius", 0.08}});
    double nearest = -1;
    for (const Vec3 p : points())
        if (std::hypot(p.x, p.y - 1.5) < 0.06) nearest = std::max(nearest, p.z);
    EXPECT_GT(nearest, -1) << "there is cloth before the hand";
    EXPECT_LT(nearest, -0.25) << "none of it is behind the hand";
}

TEST_F(TouchedMatter, ASoftThingIsPushedAside) {
    open_thing(BoxShape{{0.2, 0.1, 0.2}}, {0, 0.11, 0}, PhysicalKind::soft,
               {{"mass", 1.0}, {"youngs_modulus", 2e4}, {"damping_rayleigh", 0.02}});
    run("simulation.play");
    step(30);
    sweep({-0.6, 0.1, 0}, {0.2, 0.1, 0}, 2, {{"radius", 0.08}});
    EXPECT_GT(state(thing).pose.position.x, 0.3) << "it is before the hand";
    EXPECT_LT(depth_in({0.2, 0.1, 0}), 0.03);
}

TEST_F(TouchedMatter, ARopeIsPushedAside) {
    open_thing(CapsuleShape{0.01, 0.5}, {0, 1, 0}, PhysicalKind::rope, {{"mass", 0.5}});
    run("entity.update", {{"index", thing}, {"entity", {{"pins", {{{"position", {0, 0.5, 0}}}}}}}});
    run("simulation.play");
    step(30);
    const std::vector<Vec3> before = points();
    sweep({-0.4, 0.8, 0}, {0.3, 0.8, 0}, 2, {{"radius", 0.08}});
    EXPECT_GT(moved(before), 0.05);
    double farthest = -1;
    for (const Vec3 p : points())
        if (std::fabs(p.y - 0.8) < 0.08) farthest = std::max(farthest, p.x);
    EXPECT_GT(farthest, 0.3) << "the rope is before the hand";
}

TEST_F(TouchedMatter, GrainsArePushedAside) {
    open_thing(BoxShape{{0.1, 0.06, 0.1}}, {0, 0.061, 0}, PhysicalKind::granular, {{"grain_budget", 300.0}});
    run("simulation.play");
    step(30);
    const std::vector<Vec3> before = points();
    sweep({-0.4, 0.09, 0}, {0.05, 0.09, 0}, 2, {{"radius", 0.08}});
    EXPECT_GT(moved(before), 0.02);
    EXPECT_LT(depth_in({0.05, 0.09, 0}), 0.03) << "where the grains jam, the hand gives way a little";
}

TEST_F(TouchedMatter, ALiquidIsPushedAsideAndNoHandHoldsIt) {
    Document document = samples::floor_and_box(0.1);
    document.entities[1].name = "Water";
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.2, 0.1, 0.2}}};
    document.entities[1].attributes = {{"kind", to_value(PhysicalKind::fluid)}, {"particle_budget", 1500.0}};
    for (const double side : {-1.0, 1.0}) {
        for (Entity* wall : {&samples::add(document, "Wall", BoxShape{{0.025, 0.3, 0.25}}, {side * 0.225, 0.3, 0}),
                             &samples::add(document, "Wall", BoxShape{{0.2, 0.3, 0.025}}, {0, 0.3, side * 0.225})})
            wall->attributes["kind"] = to_value(PhysicalKind::static_body);
    }
    open(document);
    run("simulation.play");
    step(20);
    EXPECT_NE(error_of("simulation.grab", {{"index", thing}, {"point", {0, 0, 0}}, {"target", {0, 0, 0}}})
                  .find("Water is a liquid"),
              std::string::npos);
    sweep({0, 0.5, 0}, {0, 0.1, 0}, 2, {{"radius", 0.08}});
    step(10);
    EXPECT_LT(depth_in({0, 0.1, 0}), 0.03) << "the water flows around the hand";
}

TEST_F(TouchedMatter, TwoHandsCarryACloth) {
    open_thing(BoxShape{{0.5, 0.001, 0.5}}, {0, 0.1, 0}, PhysicalKind::cloth, {{"cloth_nodes", 300.0}});
    run("simulation.play");
    step(60);
    for (const double side : {-0.4, 0.4}) {
        as(ann, "simulation.grab",
           {{"index", thing},
            {"hand", side < 0 ? "left" : "right"},
            {"point", {side, 0, 0}},
            {"target", {side, 1, 0}}});
    }
    step(90);
    const auto highest = [&](double side) {
        double height = -1;
        for (const Vec3 p : points())
            if (p.x * side > 0.2) height = std::max(height, p.y);
        return height;
    };
    EXPECT_NEAR(highest(-1), 1, 0.1);
    EXPECT_NEAR(highest(1), 1, 0.1);
    as(ann, "simulation.release", {{"hand", "left"}});
    step(60);
    EXPECT_NEAR(highest(1), 1, 0.1) << "the right hand still has it";
    EXPECT_LT(highest(-1), 0.95);
    session_->forget_client(ann);
    step(90);
    EXPECT_LT(highest(1), 0.5) << "it lies on the floor in folds, which hold themselves up";
}

// Events ------------------------------------------------------------------------------------------------------------

TEST_F(HandsSession, TheHolderAloneIsToldWhatStrikesWhatItHolds) {
    open_boxes(2);
    hold(ann, 2, {0.4, 0.5, 0});
    step(90);
    (void)session_->take_events();
    as(ann, "simulation.move_grab", {{"target", {0.5, 0.1, 0}}});
    int seen = 0;
    for (int i = 0; i < 120 && seen == 0; ++i) {
        session_->step();
        for (const auto& [recipient, event] : session_->take_events().directed) {
            ++seen;
            EXPECT_EQ(recipient, ann);
            EXPECT_EQ(event.at("event"), "hand");
            EXPECT_EQ(event.at("hand"), "mouse");
            EXPECT_EQ(event.at("index"), 2);
            EXPECT_EQ(event.at("other"), 3);
            EXPECT_GT(event.at("impulse").get<double>(), 0.05);
            EXPECT_NEAR(event.at("position")[1].get<double>(), 0.2, 0.1);
        }
    }
    EXPECT_EQ(seen, 1);
}

TEST_F(HandsSession, ATouchingHandIsToldWhatItStrikes) {
    open_boxes(1);
    step(30);
    (void)session_->take_events();
    sweep({-0.9, 0.1, 0}, {-0.4, 0.1, 0}, 1);
    const std::vector<json> told = told_to(ann, "hand");
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told[0].at("hand"), "left");
    EXPECT_TRUE(told[0].at("index").is_null());
    EXPECT_EQ(told[0].at("other"), 2);
    EXPECT_GT(told[0].at("impulse").get<double>(), 0.1);
}

TEST_F(HandsSession, ImpactsAreToldToThoseWhoListenStrongestFirstAndNotTooOften) {
    open_boxes(12);
    as(ben, "simulation.listen", {{"impacts", true}});
    json poses = json::array();
    for (int i = 0; i < 12; ++i) poses.push_back({{"index", 2 + i}, {"position", {i - 0.5, 0.6 + 0.001 * i, 0}}});
    run("entity.transform", {{"poses", poses}});
    (void)session_->take_events();
    int events = 0;
    double heard = 0;
    for (int i = 0; i < 60; ++i) {
        session_->step();
        for (const auto& [recipient, event] : session_->take_events().directed) {
            EXPECT_EQ(recipient, ben);
            ASSERT_EQ(event.at("event"), "impacts");
            ++events;
            const json& impacts = event.at("impacts");
            EXPECT_LE(impacts.size(), 8u);
            for (std::size_t k = 0; k < impacts.size(); ++k) {
                if (k > 0) EXPECT_GE(impacts[k - 1].at("impulse"), impacts[k].at("impulse"));
                EXPECT_TRUE(impacts[k].at("a") == 1 || impacts[k].at("b") == 1) << "on the floor";
                heard = std::max(heard, impacts[k].at("impulse").get<double>());
            }
        }
    }
    EXPECT_GE(events, 1);
    EXPECT_LE(events, 20) << "of a second";
    EXPECT_NEAR(heard, std::sqrt(2 * 9.81 * 0.5), 1) << "1 kg that fell 0.5 m";

    as(ben, "simulation.listen", {{"impacts", false}});
    run("entity.transform", {{"poses", poses}});
    step(60);
    EXPECT_TRUE(session_->take_events().directed.empty());
}

}  // namespace
}  // namespace embody::scene
