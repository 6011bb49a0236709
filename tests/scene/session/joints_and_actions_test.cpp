// SPDX-License-Identifier: MIT
// The editors' commands for joints and actions: changing, ordering, disabling and trying them.
#include "scene/session/session_fixture.h"

namespace embody::scene {
namespace {

using nlohmann::json;

class JointsAndActions : public SessionTest {
protected:
    json joint(std::size_t at = 0) { return document()["joints"][at]; }
    json action(std::size_t at) { return document()["actions"][at]; }
    EntityIndex add_hinge() {
        door_ = add_box({1, 1, 0});
        return run("joint.add",
                   {{"type", "hinge"}, {"entity_b", door_}, {"anchor", {0.5, 1, 0}}, {"axis", {0, 1, 0}}})["index"];
    }
    // A point of a joint's frame in the world, by its second entity.
    Vec3 anchor() {
        const SceneJoint& joint = session_->document().joints.front();
        return transform_point(session_->document().find(joint.entity_b)->pose, joint.definition.frame_b.position);
    }
    Vec3 axis() {
        const SceneJoint& joint = session_->document().joints.front();
        return rotate(session_->document().find(joint.entity_b)->pose.rotation,
                      rotate(joint.definition.frame_b.rotation, {1, 0, 0}));
    }
    std::uint32_t add_timed(const std::string& name, double time, const json& effect) {
        return run("action.add", {{"name", name},
                                  {"receiver", {{"index", box_}}},
                                  {"trigger", {{"type", "time"}, {"time", time}}},
                                  {"effect", effect}})["index"];
    }

    EntityIndex door_ = 0;
    EntityIndex box_ = 0;
};

TEST_F(JointsAndActions, AJointKeepsWhatIsNotChanged) {
    const auto index = add_hinge();
    const json before = document();
    run("joint.update", {{"index", index}, {"joint", {{"limit", {{"lower", -1}, {"upper", 2}}}, {"name", "Hinge"}}}});
    EXPECT_EQ(joint()["limit"]["upper"], 2);
    EXPECT_LT(distance(anchor(), {0.5, 1, 0}), 1e-12);
    EXPECT_LT(distance(axis(), {0, 1, 0}), 1e-12);
    run("joint.update", {{"index", index}, {"joint", {{"anchor", {0.5, 2, 0.5}}}}});
    EXPECT_LT(distance(anchor(), {0.5, 2, 0.5}), 1e-12);
    EXPECT_LT(distance(axis(), {0, 1, 0}), 1e-12);
    EXPECT_EQ(joint()["name"], "Hinge");
    run("joint.update", {{"index", index}, {"joint", {{"axis", {0, 0, 3}}}}});
    EXPECT_LT(distance(anchor(), {0.5, 2, 0.5}), 1e-12);
    EXPECT_LT(distance(axis(), {0, 0, 1}), 1e-12);
    run("joint.update", {{"index", index}, {"joint", {{"limit", nullptr}}}});
    EXPECT_FALSE(joint().contains("limit"));
    for (int i = 0; i < 4; ++i) run("edit.undo");
    EXPECT_EQ(document(), before);
}

TEST_F(JointsAndActions, AnotherKindOfJointHasNoLimitsOfTheOld) {
    const auto index = add_hinge();
    run("joint.update",
        {{"index", index}, {"joint", {{"limit", {{"lower", 0}, {"upper", 1}}}, {"motor", {{"max_force", 5}}}}}});
    run("joint.update", {{"index", index}, {"joint", {{"type", "slider"}}}});
    EXPECT_EQ(joint()["type"], "slider");
    EXPECT_FALSE(joint().contains("limit"));
    EXPECT_FALSE(joint().contains("motor"));
    EXPECT_LT(distance(anchor(), {0.5, 1, 0}), 1e-12);
}

TEST_F(JointsAndActions, AJointAtAnotherThingStaysWhereItIs) {
    const auto index = add_hinge();
    const EntityIndex post = add_box({0, 1, 0});
    run("joint.update", {{"index", index}, {"joint", {{"entity_a", post}}}});
    EXPECT_EQ(joint()["entity_a"], post);
    EXPECT_LT(distance(anchor(), {0.5, 1, 0}), 1e-12);
    EXPECT_EQ(joint()["frame_a"]["position"], json({0.5, 0, 0}));
    run("joint.update", {{"index", index}, {"joint", {{"entity_a", nullptr}}}});
    EXPECT_FALSE(joint().contains("entity_a"));
    EXPECT_EQ(joint()["frame_a"]["position"], json({0.5, 1, 0}));
}

TEST_F(JointsAndActions, ARefusedUpdateChangesNothing) {
    const auto index = add_hinge();
    const json before = document();
    const auto refused = [&](const json& fields) {
        return error_of("joint.update", {{"index", index}, {"joint", fields}});
    };
    EXPECT_NE(refused({{"limit", {{"lower", 2}, {"upper", 1}}}}).find("limit"), std::string::npos);
    EXPECT_NE(refused({{"entity_b", 99}}).find("joint.entity_b: there is no entity 99"), std::string::npos);
    EXPECT_NE(refused({{"entity_a", door_}}).find("must not be entity_a itself"), std::string::npos);
    EXPECT_NE(refused({{"axis", {0, 0, 0}}}).find("joint.axis: must not be zero"), std::string::npos);
    EXPECT_NE(refused({{"index", 4}}).find("joint.index: cannot be changed"), std::string::npos);
    EXPECT_NE(refused({{"stiffness", 4}}).find("joint.stiffness"), std::string::npos);
    EXPECT_NE(error_of("joint.update", {{"index", 9}, {"joint", {{"name", "x"}}}}).find("there is no joint 9"),
              std::string::npos);
    EXPECT_EQ(document(), before);
    // It holds as before.
    run("simulation.step", {{"count", 30}});
    EXPECT_NEAR(where(door_).y, 1, 0.01);
}

TEST_F(JointsAndActions, AnAnchorInARunIsAPlaceAsItIsNow) {
    run("scene.settings", {{"gravity", {0, 0, 0}}});
    const EntityIndex box = run("entity.add", {{"entity",
                                                {{"shape", {{"type", "box"}, {"half_extents", {0.2, 0.2, 0.2}}}},
                                                 {"pose", {{"position", {0, 3, 0}}}},
                                                 {"linear_velocity", {1, 0, 0}}}}})["index"];
    run("simulation.step", {{"count", 60}});
    const Vec3 moved = where(box);
    ASSERT_GT(moved.x, 0.9);
    run("joint.add", {{"type", "ball"}, {"entity_b", box}, {"anchor", {moved.x, moved.y + 1, moved.z}}});
    run("simulation.step", {{"count", 1}});
    // Nothing jumps: the thing hangs a metre below its anchor.
    EXPECT_LT(distance(where(box), moved), 0.05);
    EXPECT_NEAR(joint()["frame_b"]["position"][1], 1, 0.01);
}

TEST_F(JointsAndActions, AnActionKeepsWhatIsNotChanged) {
    box_ = add_box({0, 3, 0});
    const auto id = add_timed("kick", 1, {{"type", "apply_impulse"}, {"impulse", {1, 0, 0}}});
    const json before = document();
    run("action.update", {{"index", id}, {"action", {{"enabled", false}}}});
    EXPECT_EQ(action(0)["enabled"], false);
    EXPECT_EQ(action(0)["name"], "kick");
    run("action.update", {{"index", id}, {"action", {{"enabled", nullptr}, {"effect", {{"type", "remove"}}}}}});
    EXPECT_FALSE(action(0).contains("enabled"));
    EXPECT_EQ(action(0)["effect"], (json{{"type", "remove"}}));
    EXPECT_EQ(action(0)["trigger"]["time"], 1);
    run("edit.undo");
    run("edit.undo");
    EXPECT_EQ(document(), before);
    const auto refused = [&](const json& fields) {
        return error_of("action.update", {{"index", id}, {"action", fields}});
    };
    EXPECT_NE(refused({{"trigger", {{"type", "times"}}}}).find("action.trigger.type"), std::string::npos);
    EXPECT_NE(refused({{"effect", {{"type", "apply_force"}}}}).find("action.effect.force"), std::string::npos);
    EXPECT_NE(refused({{"id", 7}}).find("action.id: cannot be changed"), std::string::npos);
    EXPECT_EQ(document(), before);
}

TEST_F(JointsAndActions, NothingSetsOffWhatIsDisabled) {
    box_ = add_box({0, 3, 0});
    const auto id = add_timed("remove it", 0.1, {{"type", "remove"}});
    run("action.update", {{"index", id}, {"action", {{"enabled", false}}}});
    run("simulation.step", {{"count", 30}});
    EXPECT_GT(where(box_).y, 0);
    run("action.update", {{"index", id}, {"action", {{"enabled", true}}}});
    run("simulation.step", {{"count", 1}});
    std::vector<EntityState> states;
    session_->read_states(states);
    EXPECT_TRUE(std::ranges::none_of(states, [&](const EntityState& state) { return state.entity == box_; }));
}

TEST_F(JointsAndActions, ActionsAreOrderedByTheirNumbers) {
    box_ = add_box({0, 3, 0});
    for (const char* name : {"a", "b", "c", "d"}) add_timed(name, 1, {{"type", "pause"}});
    const json before = document();
    const auto order = [&] {
        std::string names;
        const json now = document();
        for (const json& each : now["actions"]) names += each["name"];
        return names;
    };
    EXPECT_EQ(run("action.move", {{"index", 1}, {"place", 3}})["index"], 3);
    EXPECT_EQ(order(), "bcad");
    EXPECT_EQ(run("action.move", {{"index", 4}, {"place", 1}})["index"], 1);
    EXPECT_EQ(order(), "dbca");
    run("edit.undo");
    run("edit.undo");
    EXPECT_EQ(document(), before);
    EXPECT_NE(error_of("action.move", {{"index", 1}, {"place", 5}}).find("place"), std::string::npos);
    EXPECT_NE(error_of("action.move", {{"index", 9}, {"place", 1}}).find("there is no action 9"), std::string::npos);
}

TEST_F(JointsAndActions, AnActionIsTriedAtOnce) {
    box_ = add_box({0, 3, 0});
    const auto id = add_timed("lift", 1e6, {{"type", "set_velocity"}, {"linear", {0, 9, 0}}});
    run("action.update", {{"index", id}, {"action", {{"enabled", false}}}});
    EXPECT_NE(error_of("action.run", {{"index", id}}).find("play first"), std::string::npos);
    run("simulation.step", {{"count", 5}});
    const double low = where(box_).y;
    run("action.run", {{"index", id}});
    run("simulation.step", {{"count", 5}});
    EXPECT_GT(where(box_).y, low + 0.3);
    EXPECT_NE(error_of("action.run", {{"index", 8}}).find("there is no action 8"), std::string::npos);
}

TEST_F(JointsAndActions, ATriedActionChangesOnlyWhoSetsItOff) {
    box_ = add_box({0, 3, 0});
    const EntityIndex other = add_box({3, 3, 0});
    const json touch = {{"type", "contact_begin"}};
    const auto any = run("action.add", {{"trigger", touch}, {"effect", {{"type", "remove"}}}})["index"];
    const auto named = run(
        "action.add", {{"sender", {{"index", other}}}, {"trigger", touch}, {"effect", {{"type", "remove"}}}})["index"];
    run("simulation.step");
    EXPECT_NE(error_of("action.run", {{"index", any}}).find("sender: the action changes who sets it off"),
              std::string::npos);
    EXPECT_NE(error_of("action.run", {{"index", any}, {"sender", 99}}).find("there is no entity 99"),
              std::string::npos);
    const auto is_there = [&](EntityIndex index) {
        std::vector<EntityState> states;
        session_->read_states(states);
        return std::ranges::any_of(states, [&](const EntityState& state) { return state.entity == index; });
    };
    run("action.run", {{"index", named}});
    run("simulation.step");
    EXPECT_FALSE(is_there(other));
    EXPECT_TRUE(is_there(box_));
    run("action.run", {{"index", any}, {"sender", box_}});
    run("simulation.step");
    EXPECT_FALSE(is_there(box_));
    EXPECT_TRUE(is_there(1));
}

}  // namespace
}  // namespace embody::scene
