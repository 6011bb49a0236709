// SPDX-License-Identifier: MIT
#include <cmath>
#include <map>

#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;
using samples::thing;
constexpr double g = 9.81;

class TimeSession : public samples::LiveSession {
protected:
    void play(int steps) {
        run("simulation.play");
        for (int i = 0; i < steps; ++i) session_->step();
        run("simulation.pause");
    }
    double time() { return session_->simulated_time(); }
    double height(EntityIndex index = thing) { return state(index).pose.position.y; }
    std::string error_of(const std::string& command, const json& params = json::object()) {
        const auto result = session_->execute(command, params);
        return result.ok() ? "accepted" : result.error().message();
    }
    std::vector<json> told(const std::string& name) {
        std::vector<json> found;
        for (const json& event : session_->take_events().messages)
            if (event.at("event") == name) found.push_back(event);
        return found;
    }
    json take() { return run("hello")["take"]; }
};

TEST_F(TimeSession, ShowsEverybodyAMomentAndGoesOnFromItsEnd) {
    open(samples::floor_and_box(5));
    EXPECT_NE(error_of("time.seek", {{"time", 0}}).find("play first"), std::string::npos);
    play(45);
    const double end = height(), end_time = time();
    (void)session_->take_events();

    run("time.seek", {{"time", 0.5}});
    EXPECT_NEAR(time(), 0.5, 1e-9);
    // Explicit steps: y = h − g t (t + dt) / 2, and the kick between two half steps of a substep.
    EXPECT_NEAR(height(), 5 - g * 0.25 / 2, 0.05);
    const auto shown = told("take");
    ASSERT_FALSE(shown.empty());
    EXPECT_NEAR(shown.back()["shown"].get<double>(), 0.5, 1e-9);
    EXPECT_EQ(take()["shown"], shown.back()["shown"]) << "who connects now sees the same";

    // A step goes to the next sample, play through the take and on.
    run("simulation.step");
    EXPECT_NEAR(time(), 0.5 + 1.0 / 60, 1e-9);
    run("simulation.play");
    for (int i = 0; i < 14; ++i) session_->step();
    EXPECT_TRUE(take()["shown"].is_null());
    EXPECT_NEAR(time(), end_time, 1e-9);
    EXPECT_NEAR(height(), end, 1e-12) << "the present is untouched";
    session_->step();
    EXPECT_GT(time(), end_time + 0.01);
}

TEST_F(TimeSession, TheWorldIsNotTouchedByLookingBack) {
    const auto bits = [this](bool looks) {
        open(samples::floor_and_box(2));
        play(50);
        if (looks)
            for (const double when : {0.1, 0.6, 0.3}) run("time.seek", {{"time", when}});
        if (looks) run("time.seek", {{"time", 99}});
        play(50);
        return state(thing).pose;
    };
    EXPECT_EQ(bits(false), bits(true));
}

TEST_F(TimeSession, HandsAreRefusedAndAnEditEndsLookingBack) {
    open(samples::floor_and_box(2));
    play(30);
    run("time.seek", {{"time", 0.1}});
    const json grab = {{"index", thing}, {"point", {0, 2, 0}}, {"target", {0, 3, 0}}};
    EXPECT_NE(error_of("simulation.grab", grab).find("time.branch"), std::string::npos);
    EXPECT_NE(error_of("simulation.touch", {{"position", {0, 1, 0}}}).find("time.branch"), std::string::npos);
    run("entity.set_attribute", {{"indices", {thing}}, {"name", "friction_dynamic"}, {"value", 0.1}});
    EXPECT_TRUE(take()["shown"].is_null());
    EXPECT_NEAR(time(), 0.5, 1e-9);
}

TEST_F(TimeSession, KeepsAMomentInOneStepOfUndo) {
    open(samples::floor_and_box(5));
    play(40);
    run("time.seek", {{"time", 0.5}});
    const double shown = height();
    run("simulation.keep");
    EXPECT_NEAR(session_->document().find(thing)->pose.position.y, shown, 1e-12);
    EXPECT_EQ(session_->document().find(1)->pose.position.y, -0.5);
    EXPECT_EQ(take()["samples"], 0) << "the run is over";
    run("edit.undo");
    EXPECT_EQ(session_->document().find(thing)->pose.position.y, 5);
}

TEST_F(TimeSession, ABranchIsCloseToTheRunForAShortTime) {
    Document document = samples::floor_and_box(3);
    for (int i = 0; i < 6; ++i) {
        Entity& box =
            samples::add(document, "Box", physics::BoxShape{{0.2, 0.1, 0.3}}, {0.3 * i, 1.0 + 0.5 * i, 0.1 * i});
        box.angular_velocity = {1.0 + i, 2, -i * 1.0};
        box.linear_velocity = {0.2 * i, 1, 0};
    }
    for (const attributes::PhysicalKind kind :
         {attributes::PhysicalKind::soft, attributes::PhysicalKind::granular, attributes::PhysicalKind::fluid})
        samples::add(document, "Points", physics::BoxShape{{0.08, 0.08, 0.08}},
                     {-3 - 0.7 * static_cast<int>(kind), 1, 0})
            .attributes = {{"kind", to_value(kind)}, {"grain_budget", 100.0}, {"particle_budget", 400.0}};
    open(document);
    play(30);
    const double from = 20.0 / 60;
    std::map<EntityIndex, Vec3> was;
    const auto centre = [this](EntityIndex index) {
        const EntityState now = state(index);
        if (!now.points) return now.pose.position;
        std::vector<Vec3> points;
        now.points->read(points);
        Vec3 sum;
        for (const Vec3 p : points) sum += p / static_cast<double>(points.size());
        return sum;
    };
    for (const Entity& entity : document.entities) was[entity.index] = centre(entity.index);

    run("time.seek", {{"time", from}});
    const json done = run("time.branch");
    EXPECT_NEAR(done["time"].get<double>(), from, 1e-9);
    EXPECT_TRUE(done["notes"].empty());
    EXPECT_NEAR(time(), from, 1e-9);
    EXPECT_NEAR(take()["end"].get<double>(), from, 1e-9) << "what came after is forgotten";
    play(10);
    EXPECT_NEAR(time(), 0.5, 1e-9);
    // Grains have landed meanwhile, and begin anew without their spins.
    const auto is_sand = [&](EntityIndex index) {
        const auto& attributes = document.find(index)->attributes;
        const auto kind = attributes.find("kind");
        return kind != attributes.end() && kind->second == to_value(attributes::PhysicalKind::granular);
    };
    for (const auto& [index, place] : was)
        EXPECT_LT(length(centre(index) - place), is_sand(index) ? 0.015 : 0.002) << index;
    run("time.seek", {{"time", 0.2}});
    EXPECT_NEAR(time(), 0.2, 1e-9) << "the take before the branch is still there";
}

TEST_F(TimeSession, ABranchKnowsWhatActionsHadDone) {
    Document document = samples::floor_and_box(30);
    Action action;
    action.id = 1;
    action.name = "Spawn";
    action.trigger = AtTime{0.2, {}};
    action.receiver = {Target::By::index, thing, {}};
    action.effect = Spawn{{{3, 9, 0}, {}}, {}};
    document.actions.push_back(action);
    action.id = 2;
    action.trigger = AtTime{0.3, {}};
    action.receiver = {Target::By::index, thing, {}};
    action.effect = Remove{};
    document.actions.push_back(action);
    open(document);
    play(30);
    (void)session_->take_events();
    const EntityIndex spawned = last_document_index + 1;

    // Before both: what was spawned is not there, what was removed is.
    run("time.seek", {{"time", 0.1}});
    EXPECT_EQ(state(spawned).entity, 0u);
    EXPECT_EQ(state(thing).entity, thing);
    auto messages = session_->take_events().messages;
    const auto is_told = [&](const char* name, EntityIndex index) {
        return std::ranges::any_of(messages, [&](const json& event) {
            const json told = event.value("index", event.value("entity", json::object()).value("index", json(0)));
            return event.at("event") == name && told == index;
        });
    };
    EXPECT_TRUE(is_told("despawned", spawned));
    EXPECT_TRUE(is_told("spawned", thing));

    // Between: both are there, and a run from there removes again but does not spawn again.
    run("time.seek", {{"time", 0.25}});
    run("time.branch");
    EXPECT_EQ(state(spawned).entity, spawned);
    EXPECT_NEAR(height(spawned), 9 - g * 0.05 * 0.05 / 2, 0.02);
    play(20);
    EXPECT_EQ(state(thing).entity, 0u) << "removed at 0.3 s again";
    EXPECT_EQ(state(spawned + 1).entity, 0u) << "spawned once";
}

TEST_F(TimeSession, MarksTellWhatMetAndHowHard) {
    const double drop = 2 - 0.25;
    open(samples::floor_and_box(2));
    play(60);
    const json marks = run("time.marks")["marks"];
    ASSERT_FALSE(marks.empty());
    const json& first = marks.front();
    EXPECT_EQ(first["kind"], "contact");
    EXPECT_EQ((std::set<int>{first["a"], first["b"]}), (std::set<int>{1, 2}));
    EXPECT_NEAR(first["time"].get<double>(), std::sqrt(2 * drop / g), 1.5 / 60);
    // 125 kg that fall 1.75 m: at least m v, with restitution up to twice that.
    const double momentum = 125 * std::sqrt(2 * g * drop);
    EXPECT_GT(first["impulse"].get<double>(), 0.9 * momentum);
    EXPECT_LT(first["impulse"].get<double>(), 2.1 * momentum);
}

TEST_F(TimeSession, CurvesAreWhatPhysicsSays) {
    open(samples::floor_and_box(5));
    play(48);
    const json told = run("time.curves", {{"curves",
                                           {{{"index", thing}, {"quantity", "height"}},
                                            {{"index", thing}, {"quantity", "speed"}},
                                            {{"index", thing}, {"quantity", "kinetic_energy"}},
                                            {{"index", 77}, {"quantity", "height"}}}},
                                          {"samples", 25}});
    ASSERT_EQ(told["times"].size(), 25u);
    EXPECT_NEAR(told["times"].back().get<double>(), 0.8, 1e-9);
    for (std::size_t i = 0; i < 25; ++i) {
        const double t = told["times"][i];
        EXPECT_NEAR(told["curves"][0]["values"][i].get<double>(), 5 - g * t * t / 2, 0.01);
        // The air slows it by 3 cm/s in 0.8 s.
        EXPECT_NEAR(told["curves"][1]["values"][i].get<double>(), g * t, 0.04);
        EXPECT_NEAR(told["curves"][2]["values"][i].get<double>(), 125 * g * g * t * t / 2, 0.005 * 125 * g * g);
        EXPECT_TRUE(told["curves"][3]["values"][i].is_null());
    }
    EXPECT_EQ(told["curves"][2]["unit"], "J");
    EXPECT_NE(error_of("time.curves", {{"curves", {{{"index", 2}, {"quantity", "colour"}}}}}).find("quantity"),
              std::string::npos);
    EXPECT_NE(error_of("time.curves", {{"curves", json::array()}, {"samples", 1}}).find("samples"), std::string::npos);
}

TEST_F(TimeSession, RefusesBadNumbersAndClearsWithTheRun) {
    open(samples::floor_and_box(2));
    for (const json& rate : {json(0), json(-1), json(5), json("fast")})
        EXPECT_NE(error_of("simulation.set_rate", {{"rate", rate}}).find("rate"), std::string::npos);
    run("simulation.set_rate", {{"rate", 0.1}});
    EXPECT_EQ(session_->rate(), 0.1);
    play(10);
    EXPECT_NE(error_of("time.seek", {{"time", -1}}).find("time"), std::string::npos);
    EXPECT_NE(error_of("time.seek").find("time"), std::string::npos);
    EXPECT_EQ(take()["samples"], 11);
    run("simulation.reset");
    EXPECT_EQ(take()["samples"], 0);
    EXPECT_NE(error_of("time.branch").find("play first"), std::string::npos);
    EXPECT_EQ(session_->rate(), 0.1) << "the rate is the user's, not the run's";
}

}  // namespace
}  // namespace embody::scene
