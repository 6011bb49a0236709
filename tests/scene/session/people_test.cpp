// SPDX-License-Identifier: MIT
// Several people in one session: steps of undo, presence, questions, locks.
#include <algorithm>
#include <map>

#include "scene/session/session_fixture.h"
#include "scene/session/session_state.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr ClientId ann = 1, ben = 2, eve = 3;

class PeopleTest : public SessionTest {
protected:
    void meet(ClientId client, const std::string& name) {
        run("hello", {{"person", name + "'s page"}}, client);
        run("client.set_name", {{"name", name}}, client);
    }
    EntityIndex add(ClientId client, Vec3 position) {
        const json box = {{"shape", {{"type", "box"}, {"half_extents", {0.25, 0.25, 0.25}}}},
                          {"pose", {{"position", {position.x, position.y, position.z}}}}};
        return run("entity.add", {{"entity", box}}, client)["index"];
    }
    void move(ClientId client, EntityIndex index, double x, const std::string& merge = "") {
        json params = {{"poses", {{{"index", index}, {"position", {x, 1, 0}}}}}};
        if (!merge.empty()) params["merge"] = merge;
        run("entity.transform", params, client);
    }
    json undone(ClientId client) { return run("edit.undo", json::object(), client)["undone"]; }
    json redone(ClientId client) { return run("edit.redo", json::object(), client)["redone"]; }
    // What one client was told since the last call, by event.
    std::vector<json> told(ClientId client, const std::string& event) {
        std::vector<json> found;
        for (const auto& [to, message] : last_.directed)
            if (to == client && message["event"] == event) found.push_back(message);
        for (const json& message : last_.messages)
            if (message["event"] == event) found.push_back(message);
        return found;
    }
    void listen() { last_ = session_->take_events(); }

    Events last_;
};

TEST_F(PeopleTest, EachUndoesTheirOwnSteps) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex chair = add(ann, {0, 1, 0}), table = add(ben, {2, 1, 0});
    move(ann, chair, 5);
    move(ben, table, 7);
    EXPECT_EQ(undone(ann), "Move Box");
    EXPECT_EQ(where(chair).x, 0);
    EXPECT_EQ(where(table).x, 7);
    EXPECT_EQ(undone(ben), "Move Box 2");
    EXPECT_EQ(where(table).x, 2);
    EXPECT_EQ(redone(ann), "Move Box");
    EXPECT_EQ(where(chair).x, 5);
    EXPECT_EQ(undone(ann), "Move Box");
    EXPECT_EQ(undone(ann), "Add Box");
    EXPECT_TRUE(undone(ann).is_null());
    EXPECT_TRUE(session_->document().find(table));
    EXPECT_EQ(run("hello", json::object(), eve)["undo"], nullptr) << "who has done nothing can undo nothing";
}

TEST_F(PeopleTest, TwoWhoDragAtOnceMakeTwoSteps) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex one = add(ann, {0, 1, 0}), other = add(ben, {2, 1, 0});
    for (int i = 1; i <= 30; ++i) {
        move(ann, one, 0.1 * i, "drag a");
        move(ben, other, 2 + 0.1 * i, "drag b");
    }
    undone(ann);
    EXPECT_EQ(where(one).x, 0);
    EXPECT_NEAR(where(other).x, 5, 1e-12);
    undone(ben);
    EXPECT_EQ(where(other).x, 2);
}

// A drag whose things change while others delete, rename or move one of them.
TEST_F(PeopleTest, ADragThatLosesAThingToSomebodyIsTwoSteps) {
    for (const char* act : {"deletes", "renames", "moves"}) {
        session_ = make();
        meet(ann, "Ann");
        meet(ben, "Ben");
        const EntityIndex one = add(ann, {0, 1, 0}), two = add(ann, {2, 1, 0});
        const json both = {
            {"merge", "drag"},
            {"poses", {{{"index", one}, {"position", {1, 1, 0}}}, {{"index", two}, {"position", {3, 1, 0}}}}}};
        run("entity.transform", both, ann);
        if (act == std::string("deletes")) run("entity.remove", {{"indices", {two}}}, ben);
        if (act == std::string("renames")) run("entity.update", {{"index", two}, {"entity", {{"name", "Ben's"}}}}, ben);
        if (act == std::string("moves")) move(ben, two, 9);
        move(ann, one, 5, "drag");
        undone(ann);
        EXPECT_EQ(where(one).x, 1) << act << ": the drag after Ben's edit is a step of its own";
        const auto rest = session_->execute("edit.undo", json::object(), ann);
        EXPECT_EQ(rest.ok(), act == std::string("renames")) << act;
        if (act == std::string("moves")) {
            EXPECT_EQ(where(two).x, 9) << "Ben's move stays";
        }
    }
}

TEST_F(PeopleTest, ARefusedStepDoesNotHoldUpTheStepsBeforeIt) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex lamp = add(ann, {5, 1, 0}), box = add(ann, {0, 1, 0});
    move(ann, lamp, 6);
    move(ann, box, 1);
    move(ben, box, 2);
    EXPECT_NE(error_of("edit.undo", json::object(), ann), "accepted");
    EXPECT_EQ(undone(ann), "Move Box") << "the lamp, whose name is Box";
    EXPECT_EQ(where(lamp).x, 5);
    EXPECT_EQ(where(box).x, 2);
    undone(ben);
    EXPECT_EQ(undone(ann), "Move Box 2") << "it can be taken back again";
    EXPECT_EQ(where(box).x, 0);
}

TEST_F(PeopleTest, AMergedStepIsRedoneAsItWasDone) {
    meet(ann, "Ann");
    const EntityIndex box = add(ann, {0, 1, 0});
    move(ann, box, 1, "m");
    run("entity.update", {{"index", box}, {"merge", "m"}, {"entity", {{"name", "Crate"}}}}, ann);
    move(ann, box, 5, "m");
    const json before = document();
    undone(ann);
    EXPECT_EQ(where(box).x, 0);
    redone(ann);
    EXPECT_EQ(document(), before);
}

TEST_F(PeopleTest, UndoPassesNoLock) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex box = add(ann, {0, 1, 0});
    move(ann, box, 1);
    run("entity.lock", {{"indices", {box}}, {"locked", true}}, ben);
    EXPECT_NE(error_of("edit.undo", json::object(), ann).find("is locked"), std::string::npos);
    EXPECT_EQ(where(box).x, 1);
    EXPECT_NE(error_of("entity.update", {{"index", box}, {"entity", {{"enabled", false}}}}), "accepted");
    undone(ben);
    EXPECT_EQ(undone(ann), "Move Box");
}

TEST_F(PeopleTest, AConnectionIsOnePerson) {
    meet(ann, "Ann");
    add(ann, {0, 1, 0});
    EXPECT_NE(error_of("hello", {{"person", "Ben's page"}}, ann).find("another person already"), std::string::npos);
    meet(ben, "Ben");
    EXPECT_TRUE(undone(ben).is_null()) << "Ben is not Ann";
    // However many come and go, who has steps is not forgotten.
    session_->forget_client(ann);
    for (ClientId client = 100; client < 2200; ++client) {
        run("hello", {{"person", "guest " + std::to_string(client)}}, client);
        session_->forget_client(client);
    }
    EXPECT_EQ(run("hello", {{"person", "Ann's page"}}, 50)["undo"], "Add Box");
}

TEST_F(PeopleTest, UndoKeepsWhatOthersChangedOnTheSameThing) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex box = add(ann, {0, 1, 0});
    run("entity.set_attribute", {{"indices", {box}}, {"name", "friction_static"}, {"value", 0.9}}, ann);
    run("entity.set_attribute", {{"indices", {box}}, {"name", "mass"}, {"value", 3}}, ben);
    run("entity.update", {{"index", box}, {"entity", {{"name", "Crate"}}}}, ben);
    undone(ann);
    const Entity* entity = session_->document().find(box);
    EXPECT_FALSE(entity->attributes.contains("friction_static"));
    EXPECT_TRUE(entity->attributes.contains("mass"));
    EXPECT_EQ(entity->name, "Crate");
    redone(ann);
    EXPECT_TRUE(session_->document().find(box)->attributes.contains("friction_static"));
    EXPECT_EQ(session_->document().find(box)->name, "Crate");
}

TEST_F(PeopleTest, AStepThatSomebodyBuiltOnIsRefusedByName) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    const EntityIndex box = add(ann, {0, 1, 0});
    move(ann, box, 1);
    move(ben, box, 2);
    const json before = document();
    EXPECT_NE(error_of("edit.undo", json::object(), ann).find("Box: it was moved since by Ben"), std::string::npos);
    EXPECT_EQ(document(), before);
    undone(ben);
    EXPECT_EQ(undone(ann), "Move Box") << "Ben has taken his move back";
    EXPECT_EQ(where(box).x, 0);

    // A joint of Ben's holds the thing that Ann added.
    run("joint.add", {{"type", "ball"}, {"entity_b", box}, {"anchor", {0, 2, 0}}}, ben);
    EXPECT_NE(error_of("edit.undo", json::object(), ann).find("a joint was put to it since"), std::string::npos);
    // What Ann would bring back hangs on something that Ben has deleted.
    undone(ben);
    const EntityIndex hook = add(ben, {3, 1, 0});
    const EntityIndex joint = run(
        "joint.add", {{"type", "ball"}, {"entity_a", hook}, {"entity_b", box}, {"anchor", {0, 2, 0}}}, ann)["index"];
    run("joint.remove", {{"index", joint}}, ann);
    run("entity.remove", {{"indices", {hook}}}, ben);
    EXPECT_NE(error_of("edit.undo", json::object(), ann).find("what it held was deleted since"), std::string::npos);
}

// Random edits of three people. Whatever the order of undo and redo: a refused one changes nothing, an undo that was
// done can be redone at once to the same document, and "saved" is said only of the document that was saved.
TEST_F(PeopleTest, RandomStepsOfThreePeople) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        session_ = make();
        for (const ClientId client : {ann, ben, eve}) meet(client, "P" + std::to_string(client));
        Random random(seed);
        json saved = document();
        std::size_t undone_well = 0, refused = 0;
        for (int i = 0; i < 200; ++i) {
            const ClientId client = 1 + random.below(3);
            const json before = document();
            if (random.below(3) > 0) {
                std::string name;
                const json params = random_command(random, session_->document(), name);
                if (!session_->execute(name, params, client).ok()) {
                    ASSERT_EQ(document(), before) << "a refused " << name << " changed the document";
                }
            } else if (random.below(20) == 0) {
                run("scene.save", {{"name", "kept"}}, client);
                saved = document();
            } else {
                const auto step = session_->execute("edit.undo", json::object(), client);
                if (!step.ok()) {
                    ++refused;
                    ASSERT_EQ(document(), before);
                } else if (!step.value()["undone"].is_null()) {
                    ++undone_well;
                    const json after = document();
                    ASSERT_FALSE(redone(client).is_null());
                    ASSERT_EQ(document(), before) << "seed " << seed << ", step " << i;
                    undone(client);
                    ASSERT_EQ(document(), after);
                }
            }
            json now = document();
            now["next_index"] = saved["next_index"];
            if (!run("hello", json::object(), client)["unsaved"].get<bool>()) {
                ASSERT_EQ(now, saved) << "seed " << seed;
            }
        }
        EXPECT_GT(undone_well, 10u) << "seed " << seed;
        EXPECT_GT(refused, 0u) << "seed " << seed;
    }
}

// Where everybody works on things of their own, any interleaving of undo leads back to the start, and of redo forth.
TEST_F(PeopleTest, StepsOnThingsOfOnesOwnCommute) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        session_ = make();
        Random random(seed);
        std::map<ClientId, std::vector<EntityIndex>> own;
        for (const ClientId client : {ann, ben, eve}) meet(client, "P" + std::to_string(client));
        const json start = document();
        for (int i = 0; i < 80; ++i) {
            const ClientId client = 1 + random.below(3);
            std::vector<EntityIndex>& mine = own[client];
            if (mine.empty() || random.below(3) == 0) {
                mine.push_back(add(client, {random.between(-5, 5), random.between(1, 4), random.between(-5, 5)}));
            } else if (random.below(4) == 0) {
                run("entity.remove", {{"indices", {mine.back()}}}, client);
                mine.pop_back();
            } else {
                move(client, mine[random.below(mine.size())], random.between(-5, 5), random.below(2) == 0 ? "m" : "");
            }
        }
        const json end = document();
        std::vector<ClientId> left = {ann, ben, eve};
        std::size_t steps = 0;
        while (!left.empty()) {
            const std::size_t at = random.below(left.size());
            if (undone(left[at]).is_null())
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
            else
                ++steps;
        }
        EXPECT_EQ(document()["entities"], start["entities"]) << "seed " << seed;
        EXPECT_GT(steps, 30u);
        left = {ann, ben, eve};
        while (!left.empty()) {
            const std::size_t at = random.below(left.size());
            if (redone(left[at]).is_null()) left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
        }
        EXPECT_EQ(document()["entities"], end["entities"]) << "seed " << seed;
    }
}

TEST_F(PeopleTest, EachIsToldOnlyOfTheirOwnHistory) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    listen();
    add(ann, {0, 1, 0});
    listen();
    ASSERT_EQ(told(ann, "history").size(), 1u);
    EXPECT_EQ(told(ann, "history")[0]["undo"], "Add Box");
    EXPECT_TRUE(told(ben, "history").empty());
    EXPECT_FALSE(told(ben, "document")[0].contains("undo"));
}

TEST_F(PeopleTest, MembersHaveNamesColoursAndTheSameStepsAfterAReload) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    run("hello", json::object(), eve);
    json members = run("hello", json::object(), ann)["members"];
    ASSERT_EQ(members.size(), 2u) << "a script is no member";
    EXPECT_EQ(members[0]["name"], "Ann");
    EXPECT_NE(members[0]["color"], members[1]["color"]);
    add(ann, {0, 1, 0});
    listen();
    session_->forget_client(ann);
    listen();
    EXPECT_EQ(told(ben, "members").at(0)["members"].size(), 1u);
    const ClientId again = 9;
    EXPECT_EQ(run("hello", {{"person", "Ann's page"}}, again)["undo"], "Add Box");
    EXPECT_EQ(undone(again), "Add Box");
    EXPECT_NE(error_of("hello", {{"person", ""}}).find("person"), std::string::npos);
    EXPECT_NE(error_of("hello", {{"person", std::string(65, 'a')}}).find("person"), std::string::npos);
}

TEST_F(PeopleTest, PresenceIsToldToTheOtherMembersOnly) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    run("hello", json::object(), eve);
    listen();
    run("client.present",
        {{"selection", json::array({1})},
         {"camera", {{"position", {1, 2, 3}}, {"target", {0, 0, 0}}}},
         {"pointer", nullptr},
         {"head", {{"position", {0, 1.7, 0}}, {"rotation", {0, 0, 0, 1}}}},
         {"hands", json::array({json{{"hand", "left"}, {"position", {0, 1, 0}}, {"holds", 7}}})},
         {"mode", "headset"}},
        ann);
    listen();
    ASSERT_EQ(told(ben, "presence").size(), 1u);
    const json presence = told(ben, "presence")[0];
    EXPECT_EQ(presence["client"], ann);
    EXPECT_EQ(presence["selection"], json::array({1}));
    EXPECT_EQ(presence["pointer"], nullptr);
    EXPECT_EQ(presence["hands"][0]["holds"], 7);
    EXPECT_TRUE(told(ann, "presence").empty());
    EXPECT_TRUE(told(eve, "presence").empty());
    EXPECT_NE(error_of("client.present", json::object(), eve).find("say hello with a person"), std::string::npos);
    EXPECT_NE(
        error_of("client.present", {{"hands", json::array({json{{"hand", "third"}}})}}, ann).find("hands[0].hand"),
        std::string::npos);
    EXPECT_NE(error_of("client.present", {{"head", {{"position", {0, "up", 0}}}}}, ann).find("head.position"),
              std::string::npos);

    // Who comes later is told what everybody did last.
    listen();
    meet(4, "Dan");
    listen();
    ASSERT_EQ(told(4, "presence").size(), 1u);
    EXPECT_EQ(told(4, "presence")[0]["mode"], "headset");
}

TEST_F(PeopleTest, PresenceThatComesFasterIsToldTogether) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    listen();
    for (int i = 0; i < 1000; ++i) run("client.present", {{"selection", json::array({i + 1})}}, ann);
    run("client.present", {{"mode", "headset"}}, ann);
    listen();
    const std::size_t at_once = told(ben, "presence").size();
    EXPECT_LT(at_once, 100u) << "20 a second, and the machine may be busy";
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::seconds(1));
    listen();
    ASSERT_EQ(told(ben, "presence").size(), 1u);
    EXPECT_EQ(told(ben, "presence")[0]["selection"], json::array({1000}));
    EXPECT_EQ(told(ben, "presence")[0]["mode"], "headset");
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::seconds(2));
    listen();
    EXPECT_TRUE(told(ben, "presence").empty());
}

TEST_F(PeopleTest, ManyEditsOfOnePersonLeaveTheOthersTheirs) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    add(ann, {0, 1, 0});
    const EntityIndex box = add(ben, {3, 1, 0});
    for (int i = 0; i < 1100; ++i) move(ben, box, 0.001 * i);
    EXPECT_EQ(undone(ann), "Add Box");
    std::size_t steps = 0;
    while (!undone(ben).is_null()) ++steps;
    EXPECT_EQ(steps, 1000u);
}

TEST_F(PeopleTest, OpeningASceneAsksTheOthers) {
    meet(ann, "Ann");
    add(ann, {0, 1, 0});
    const json open = document();
    EXPECT_FALSE(run("scene.new", {{"name", "Alone"}}, ann).contains("asked")) << "nobody else is here";
    run("scene.load", {{"scene", open}}, ann);
    meet(ben, "Ben");
    meet(eve, "Eve");
    listen();

    // The first who does not agree ends it.
    json asked = run("scene.new", {{"name", "Other"}}, ann);
    EXPECT_EQ(asked["asked"], json::array({ben, eve}));
    EXPECT_EQ(document(), open);
    listen();
    ASSERT_EQ(told(ben, "question").size(), 1u);
    EXPECT_EQ(told(ben, "question")[0]["text"], "Ann would like to open “Other” for everybody");
    EXPECT_TRUE(told(ann, "question").empty());
    EXPECT_NE(error_of("scene.new", json::object(), ben).find("Ann is asking already"), std::string::npos);
    run("scene.answer", {{"question", asked["question"]}, {"agrees", true}}, ben);
    run("scene.answer", {{"question", asked["question"]}, {"agrees", false}}, eve);
    listen();
    EXPECT_EQ(document(), open);
    ASSERT_EQ(told(ann, "message").size(), 1u);
    EXPECT_NE(told(ann, "message")[0]["text"].get<std::string>().find("Eve would rather go on here"),
              std::string::npos);
    EXPECT_EQ(told(ben, "question_over").size(), 1u);
    EXPECT_NE(error_of("scene.answer", {{"question", asked["question"]}, {"agrees", true}}, eve).find("no question"),
              std::string::npos);

    // All agree, or leave, or the time is over.
    asked = run("scene.new", {{"name", "Agreed"}}, ann);
    run("scene.answer", {{"question", asked["question"]}, {"agrees", true}}, ben);
    EXPECT_EQ(document(), open);
    session_->forget_client(eve);
    EXPECT_EQ(document()["title"], "Agreed");
    run("scene.new", {{"name", "Silence"}}, ann);
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::seconds(19));
    EXPECT_EQ(document()["title"], "Agreed");
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::seconds(21));
    EXPECT_EQ(document()["title"], "Silence");
    run("scene.new", {{"name", "At once"}, {"ask", false}}, ann);
    EXPECT_EQ(document()["title"], "At once");
    EXPECT_NE(error_of("scene.load", {{"name", "none"}}, ann).find("there is no scene"), std::string::npos)
        << "nobody is asked about a scene that is not there";
}

TEST_F(PeopleTest, AQuestionOpensTheFileAsItIsWhenItIsAnswered) {
    meet(ann, "Ann");
    meet(ben, "Ben");
    add(ann, {0, 1, 0});
    run("scene.save", {{"name", "Flat"}}, ann);
    run("scene.new", {{"name", "Draft"}, {"ask", false}}, ann);
    const json asked = run("scene.load", {{"name", "Flat"}}, ann);
    add(ben, {1, 1, 0});
    add(ben, {2, 1, 0});
    run("scene.save", {{"name", "Flat"}}, ben);
    const json newest = document();

    // A stranger does not answer, nor does one person twice.
    run("hello", json::object(), eve);
    EXPECT_NE(error_of("scene.answer", {{"question", asked["question"]}, {"agrees", false}}, eve).find("not asked"),
              std::string::npos);
    run("scene.answer", {{"question", asked["question"]}, {"agrees", true}}, ben);
    EXPECT_EQ(document(), newest) << "Ben's work";
    EXPECT_EQ(run("hello", json::object(), eve)["unsaved"], false);

    // A script is told, and edits no other scene than it asked for.
    EXPECT_NE(error_of("scene.new", json::object(), eve).find("ask: false"), std::string::npos);
    // Who asked and left wants nothing any more.
    run("scene.new", {{"name", "Never"}}, ann);
    session_->forget_client(ann);
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::seconds(60));
    EXPECT_EQ(document()["title"], "Flat");
}

TEST_F(PeopleTest, LockedThingsKeepPoseSizeAndExistence) {
    const EntityIndex floor = 1, box = add_box({3, 1, 0});
    EXPECT_TRUE(session_->document().find(floor)->locked) << "the floor of a new scene";
    const json before = document();
    for (const auto& [command, params] : std::vector<std::pair<std::string, json>>{
             {"entity.remove", {{"indices", {floor}}}},
             {"entity.transform", {{"poses", {{{"index", floor}, {"position", {0, 1, 0}}}}}}},
             {"entity.drop_to_floor", {{"indices", {floor}}}},
             {"entity.update", {{"index", floor}, {"entity", {{"pose", {{"position", {0, 1, 0}}}}}}}},
             {"entity.update", {{"index", floor}, {"entity", {{"shape", {{"type", "sphere"}, {"radius", 1}}}}}}},
             {"entity.turn", {{"indices", {floor}}, {"angle", 0.1}}},
             {"entity.move", {{"indices", {floor}}, {"offset", {0, 0.1, 0}}}},
             {"entity.mirror", {{"indices", {floor, box}}, {"axis", "x"}}},
             {"entity.drag", {{"indices", {floor}}, {"drop", {{"origin", {0, 3, 0}}, {"direction", {0, -1, 0}}}}}}})
        EXPECT_NE(error_of(command, params).find("Floor is locked (unlock it first)"), std::string::npos)
            << command << ": " << error_of(command, params);
    EXPECT_EQ(document(), before);

    // Everything else can be edited.
    run("entity.set_attribute", {{"indices", {floor}}, {"name", "friction_static"}, {"value", 0.2}});
    run("entity.update", {{"index", floor}, {"entity", {{"name", "Ice"}}}});
    run("entity.lock", {{"indices", {floor}}, {"locked", false}});
    run("entity.transform", {{"poses", {{{"index", floor}, {"position", {0, 1, 0}}}}}});
    EXPECT_EQ(run("edit.undo")["undone"], "Move Ice");
    EXPECT_EQ(run("edit.undo")["undone"], "Unlock Ice");
    EXPECT_NE(error_of("entity.remove", {{"indices", {floor}}}), "accepted");
    const EntityIndex copy = run("entity.duplicate", {{"indices", {floor}}})["indices"][0];
    EXPECT_FALSE(session_->document().find(copy)->locked) << "a copy is there to be moved";
}

TEST_F(PeopleTest, WallsAndFloorsComeLocked) {
    const auto comes = [this](const std::string& category, const std::string& kind) {
        const json entity = {{"shape", {{"type", "box"}, {"half_extents", {1, 1, 0.1}}}},
                             {"category", category},
                             {"attributes", {{"kind", kind}}}};
        return session_->document().find(run("entity.add", {{"entity", entity}})["index"])->locked;
    };
    EXPECT_TRUE(comes("wall", "static"));
    EXPECT_TRUE(comes("floor", "static"));
    EXPECT_FALSE(comes("wall", "rigid"));
    EXPECT_FALSE(comes("table", "static"));
}

TEST_F(PeopleTest, SavingUnderAnotherNameMakesThatTheTitleAndKeepsTheCamera) {
    add_box({0, 1, 0});
    const json camera = {{"position", {5, 6, 7}}, {"target", {0, 1, 0}}};
    run("scene.save", {{"name", "Flat"}, {"camera", camera}});
    EXPECT_EQ(document()["title"], "Flat");
    EXPECT_EQ(document()["camera"], camera);
    EXPECT_EQ(run("hello")["unsaved"], false);
    run("scene.settings", {{"title", "Our flat"}});
    run("scene.save");
    EXPECT_EQ(document()["title"], "Our flat") << "a title of one's own stays";
    EXPECT_EQ(run("edit.undo")["undone"], "Change settings");
    EXPECT_EQ(document()["camera"], camera) << "the camera is no step of undo";
    // What a save gave the scene is not taken back by the undo of an edit before it.
    run("scene.settings", {{"title", "Mine"}, {"gravity", {0, -3, 0}}});
    run("scene.save", {{"name", "Copy"}});
    run("edit.undo");
    EXPECT_EQ(document()["title"], "Copy");
    EXPECT_EQ(document()["settings"]["gravity"], json({0.0, -9.81, 0.0}));
    run("edit.redo");
    EXPECT_EQ(run("hello")["unsaved"], false);
    run("scene.load", {{"name", "Copy"}});
    EXPECT_EQ(document()["settings"]["gravity"], json({0.0, -3.0, 0.0}));
    EXPECT_EQ(document()["title"], "Copy");
    EXPECT_EQ(document()["camera"], camera);
    EXPECT_NE(error_of("scene.save", {{"camera", {{"position", {0, 0}}}}}).find("camera.position"), std::string::npos);
}

TEST_F(PeopleTest, VersionsAreKeptByName) {
    add_box({0, 1, 0});
    run("scene.save", {{"name", "Flat"}, {"version", "one box"}});
    const json one = document();
    add_box({1, 1, 0});
    run("scene.save", {{"version", "two: boxes"}});
    const json two = document();
    EXPECT_NE(error_of("scene.save", {{"version", "one box"}}).find("there is a version"), std::string::npos);
    const json versions = run("scene.versions")["versions"];
    ASSERT_EQ(versions.size(), 2u);
    EXPECT_EQ(versions[0]["version"], "one box");
    EXPECT_EQ(versions[1]["version"], "two: boxes");
    run("scene.load", {{"name", "Flat"}, {"version", "one box"}});
    EXPECT_EQ(document(), one);
    EXPECT_EQ(run("hello")["unsaved"], true);
    EXPECT_EQ(run("hello")["name"], "Flat");
    run("scene.load", {{"name", "Flat"}});
    EXPECT_EQ(document(), two) << "opening a version does not save it";
    EXPECT_NE(error_of("scene.load", {{"name", "Flat"}, {"version", "none"}}), "accepted");
    EXPECT_EQ(run("scene.versions", {{"name", "none"}})["versions"], json::array());
}

TEST_F(PeopleTest, ComponentsThatAreNotToldStayAsTheyAre) {
    const EntityIndex one = add_box({0, 1, 0}), other = add_box({2, 1, 0});
    run("entity.set_attribute", {{"indices", {one}}, {"name", "center_of_mass"}, {"value", {0.1, 0.02, 0.03}}});
    run("entity.set_attribute",
        {{"indices", {one, other}}, {"name", "center_of_mass"}, {"value", {nullptr, 0.05, nullptr}}});
    const auto center = [this](EntityIndex index) {
        return std::get<Vec3>(session_->document().find(index)->attributes.at("center_of_mass"));
    };
    EXPECT_EQ(center(one), Vec3(0.1, 0.05, 0.03));
    EXPECT_EQ(center(other).y, 0.05);
    EXPECT_EQ(run("edit.undo")["undone"].get<std::string>().substr(0, 4), "Set ");
    EXPECT_EQ(center(one), Vec3(0.1, 0.02, 0.03));
    EXPECT_NE(error_of("entity.set_attribute",
                       {{"indices", {one}}, {"name", "center_of_mass"}, {"value", {nullptr, "up", nullptr}}})
                  .find("value"),
              std::string::npos);
}

}  // namespace
}  // namespace embody::scene
