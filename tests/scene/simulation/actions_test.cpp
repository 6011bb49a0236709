// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scene/sample_documents.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

constexpr EntityIndex box = 2, other = 3;

// A box that falls on the floor from 0.5 m, lands after about a third of a second, and then sleeps; a ball at rest far
// away on the floor, and a signal in the tenth step.
Document scene_with(const Trigger& trigger, const Effect& effect, const Target& receiver) {
    Document document = samples::floor_and_box(0.75);
    samples::add(document, "Ball", physics::SphereShape{0.2}, {4, 0.2, 0}).category = "toy";
    Action action;
    action.id = 1;
    action.name = "test";
    action.sender = {Target::By::index, box, {}};
    action.receiver = receiver;
    action.trigger = trigger;
    action.effect = effect;
    document.actions.push_back(action);
    return document;
}

struct Outcome {
    int fired_at = -1;  // step
    int times = 0;
    bool paused = false;
    std::unique_ptr<Simulation> simulation;
};

Outcome run(const Document& document, int steps = 240) {
    Outcome outcome;
    auto made = Simulation::create(document, nullptr);
    if (!made.ok()) {
        ADD_FAILURE() << made.error().message();
        return outcome;
    }
    outcome.simulation = std::move(made).value();
    for (int i = 1; i <= steps; ++i) {
        if (i == 10) outcome.simulation->signal("k", "");
        outcome.simulation->step();
        EXPECT_TRUE(outcome.simulation->problems().empty())
            << (outcome.simulation->problems().empty() ? "" : outcome.simulation->problems()[0].message());
        outcome.paused = outcome.paused || outcome.simulation->pause_requested();
        if (!outcome.simulation->fired().empty() && outcome.fired_at < 0) outcome.fired_at = i;
        outcome.times += static_cast<int>(outcome.simulation->fired().size());
        if (outcome.fired_at == i) break;
    }
    return outcome;
}

struct NamedTrigger {
    const char* name;
    Trigger trigger;
    int earliest, latest;  // step in which it must fire
};
// Free fall of 0.5 m takes 0.32 s: 19 steps. The box comes to rest soon after and sleeps half a second later.
const NamedTrigger triggers[] = {
    {"time", AtTime{1, {}}, 61, 61},
    {"contact begin", OnContactBegin{{Target::By::name, 0, "Floor"}, 1}, 18, 22},
    {"contact end", OnContactEnd{{Target::By::any, 0, {}}}, 18, 240},
    {"enter volume", OnEnterVolume{{{-1, 0, -1}, {1, 0.5, 1}}}, 12, 16},
    {"fall asleep", OnFallAsleep{}, 40, 160},
    {"signal", OnSignal{"k", {}}, 10, 10},
};

struct NamedEffect {
    const char* name;
    Effect effect;
    std::function<bool(const Outcome&)> is_done;  // right after the step in which it fired
};
Vec3 velocity(const Outcome& o, EntityIndex index) {
    return o.simulation->world().linear_velocity(o.simulation->body(index));
}
const NamedEffect effects[] = {
    {"set attribute", SetAttribute{"mass", 5.0},
     [](const Outcome& o) { return std::fabs(o.simulation->world().mass(o.simulation->body(other)) - 5) < 1e-9; }},
    {"impulse", ApplyImpulse{{0, 100, 0}, {}},
     [](const Outcome& o) {
         o.simulation->step();
         return velocity(o, other).y > 1;
     }},
    {"impulse at a point", ApplyImpulse{{0, 0, 5}, Vec3{4, 0.4, 0}},
     [](const Outcome& o) {
         return std::fabs(o.simulation->world().angular_velocity(o.simulation->body(other)).x) > 0.1;
     }},
    {"force", ApplyForce{{0, 2000, 0}, 0.1},
     [](const Outcome& o) {
         for (int i = 0; i < 8; ++i) o.simulation->step();
         return velocity(o, other).y > 3;
     }},
    {"velocity", SetVelocity{{0, 3, 0}, {}},
     [](const Outcome& o) {
         o.simulation->step();
         return velocity(o, other).y > 2;
     }},
    {"spawn", Spawn{{{0, 6, 0}, {}}, {0, 1, 0}},
     [](const Outcome& o) {
         const EntityIndex born = o.simulation->entities().back();
         return born > last_document_index && o.simulation->entities().size() == 4 &&
                o.simulation->spawned() == std::vector<EntityIndex>{born} &&
                o.simulation->definition(born)->name == "Ball";
     }},
    {"remove", Remove{},
     [](const Outcome& o) {
         return o.simulation->body(other).is_null() && o.simulation->despawned() == std::vector<EntityIndex>{other};
     }},
    {"disable", SetEnabled{false},
     [](const Outcome& o) { return !o.simulation->world().body(o.simulation->body(other))->enabled; }},
    {"pause", Pause{}, [](const Outcome& o) { return o.paused; }},
};

TEST(Actions, EveryTriggerStartsEveryEffect) {
    for (const NamedTrigger& trigger : triggers) {
        for (const NamedEffect& effect : effects) {
            Document document = scene_with(trigger.trigger, effect.effect, {Target::By::index, other, {}});
            // Only a bouncing body ends its contact with the floor.
            if (std::holds_alternative<OnContactEnd>(trigger.trigger))
                document.find(box)->attributes["restitution"] = 0.9;
            if (std::holds_alternative<OnFallAsleep>(trigger.trigger))
                document.find(box)->attributes["restitution"] = 0.0;
            const Outcome outcome = run(document);
            ASSERT_TRUE(outcome.simulation);
            EXPECT_GE(outcome.fired_at, trigger.earliest) << trigger.name << " → " << effect.name;
            EXPECT_LE(outcome.fired_at, trigger.latest) << trigger.name << " → " << effect.name;
            if (outcome.fired_at > 0) {
                EXPECT_TRUE(effect.is_done(outcome)) << trigger.name << " → " << effect.name;
            }
        }
    }
}

TEST(Actions, ReceiversByNameCategoryAndSender) {
    const Trigger trigger = OnContactBegin{{Target::By::name, 0, "Floor"}, 1};
    for (const Target& receiver : {Target{Target::By::name, 0, "Ball"}, Target{Target::By::category, 0, "toy"}}) {
        const Outcome outcome = run(scene_with(trigger, Remove{}, receiver));
        EXPECT_EQ(outcome.simulation->despawned(), std::vector<EntityIndex>{other});
    }
    const Outcome outcome = run(scene_with(trigger, Remove{}, {}));
    EXPECT_EQ(outcome.simulation->despawned(), std::vector<EntityIndex>{box}) << "any: who set it off";
    const Outcome nobody = run(scene_with(trigger, Remove{}, {Target::By::name, 0, "Nobody"}));
    EXPECT_EQ(nobody.fired_at, -1);
}

TEST(Actions, RepeatAsOftenAsTheySayAndOnceIsOnce) {
    const auto count = [](bool once) {
        Document document = scene_with(AtTime{0.1, 0.25}, SetVelocity{}, {Target::By::index, box, {}});
        document.actions[0].once = once;
        auto made = Simulation::create(document, nullptr);
        int times = 0;
        for (int i = 0; i < 120; ++i) {
            made.value()->step();
            times += static_cast<int>(made.value()->fired().size());
        }
        return times;
    };
    EXPECT_EQ(count(true), 1);
    EXPECT_EQ(count(false), 8);  // 0.1, 0.35 … 1.85 s
}

TEST(Actions, ASpawnThatTriggersItselfEnds) {
    // Each new ball touches the floor and so spawns another one.
    Document document = samples::floor_and_box(0.3);
    Action action;
    action.id = 1;
    action.receiver = {Target::By::index, box, {}};
    action.trigger = OnContactBegin{};
    action.effect = Spawn{{{0, 0.3, 0}, {}}, {}};
    action.once = false;
    document.actions.push_back(action);
    auto made = Simulation::create(document, nullptr);
    ASSERT_TRUE(made.ok());
    for (int i = 0; i < 8; ++i) made.value()->step();
    EXPECT_GT(made.value()->entities().size(), 2u);
    EXPECT_LT(made.value()->entities().size(), 8u * 32 + 3);
}

TEST(Actions, ADisabledEntityIsATemplate) {
    Document document = scene_with(AtTime{0.5, {}}, Spawn{{{0, 2, 0}, {}}, {}}, {Target::By::index, other, {}});
    document.find(other)->enabled = false;
    const Outcome outcome = run(document);
    ASSERT_EQ(outcome.simulation->spawned().size(), 1u);
    EXPECT_TRUE(outcome.simulation->definition(outcome.simulation->spawned()[0])->enabled);
}

}  // namespace
}  // namespace embody::scene
