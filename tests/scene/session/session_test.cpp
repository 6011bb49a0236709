// SPDX-License-Identifier: MIT
#include "scene/session/session.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/sample_documents.h"
#include "scene/session/session_fixture.h"
#include "scene/session/session_state.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

TEST_F(SessionTest, RefusesWrongCommandsByName) {
    EXPECT_NE(error_of("entity.ad").find("did you mean \"entity.add\"?"), std::string::npos);
    EXPECT_NE(error_of("").find("is not a command"), std::string::npos);
    EXPECT_NE(error_of("entity.remove", {{"indexes", {1}}}).find("indices"), std::string::npos);
    EXPECT_NE(error_of("entity.remove", {{"indices", {99}}}).find("indices[0]: there is no entity 99"),
              std::string::npos);
    EXPECT_NE(error_of("entity.remove", {{"indices", json::array()}}).find("names no entity"), std::string::npos);
    EXPECT_NE(error_of("entity.add", {{"entity", {{"shap", 1}}}}).find("entity.shap"), std::string::npos);
    EXPECT_NE(error_of("entity.add", {{"entity", {{"index", 4}, {"shape", {{"type", "sphere"}, {"radius", 1}}}}}})
                  .find("entity.index"),
              std::string::npos);
    EXPECT_NE(error_of("entity.set_attribute", {{"indices", {1}}, {"name", "frictoin_static"}, {"value", 1}})
                  .find("friction_static"),
              std::string::npos);
    EXPECT_NE(error_of("simulation.step", {{"count", 0}}).find("count"), std::string::npos);
    EXPECT_NE(error_of("simulation.step", 7).find("must be an object"), std::string::npos);
    EXPECT_NE(error_of("simulation.move_grab", {{"target", {0, 0, 0}}}).find("nothing is held"), std::string::npos);
    EXPECT_NE(error_of("catalog.search").find("no model database"), std::string::npos);
    EXPECT_NE(error_of("scene.load", {{"name", "../../etc/passwd"}}).find("there is no scene"), std::string::npos);
    EXPECT_NE(error_of("scene.settings", {{"gravty", 1}}).find("gravity"), std::string::npos);
    EXPECT_NE(error_of("action.trigger", {{"key", "a"}, {"button", "b"}}).find("either"), std::string::npos);
    EXPECT_EQ(session_->take_events().messages.size(), 0u) << "refused commands change nothing";
}

TEST_F(SessionTest, GreetsWithEverythingAClientNeeds) {
    const json hello = run("hello");
    EXPECT_EQ(hello["scene"], document());
    EXPECT_EQ(hello["frame_version"], 2);
    EXPECT_EQ(hello["simulation"]["state"], "stopped");
    EXPECT_TRUE(hello.contains("version") && hello.contains("revision"));
}

TEST_F(SessionTest, TellsSmallChangesAndLabels) {
    session_->take_events();
    const EntityIndex index = add_box({0, 2, 0});
    const Events events = session_->take_events();
    ASSERT_EQ(events.messages.size(), 1u);
    const json& event = events.messages[0];
    EXPECT_EQ(event["event"], "document");
    ASSERT_EQ(event["changes"].size(), 1u);
    EXPECT_EQ(event["changes"][0]["op"], "entity");
    EXPECT_EQ(event["changes"][0]["entity"]["index"], index);
    EXPECT_EQ(event["unsaved"], true);
    EXPECT_EQ(run("hello")["undo"], "Add Box");
    EXPECT_EQ(run("hello")["redo"], nullptr);
}

TEST_F(SessionTest, MergesADragIntoOneUndo) {
    const EntityIndex index = add_box({0, 2, 0});
    const json before = document();
    for (int i = 0; i < 50; ++i)
        run("entity.transform", {{"merge", "drag 1"}, {"poses", {{{"index", index}, {"position", {0.1 * i, 2, 0}}}}}});
    run("entity.transform", {{"merge", "drag 2"}, {"poses", {{{"index", index}, {"position", {9, 9, 9}}}}}});
    EXPECT_EQ(run("edit.undo")["undone"], "Move Box");
    EXPECT_NEAR(where(index).x, 4.9, 1e-12);
    run("edit.undo");
    EXPECT_EQ(document(), before);
    EXPECT_EQ(run("edit.redo")["redone"], "Move Box");
    EXPECT_NEAR(where(index).x, 4.9, 1e-12);
}

TEST_F(SessionTest, UndoAndRedoOfRandomEditsGiveTheIdenticalDocument) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        session_ = make();
        Random random(seed);
        std::vector<json> states{document()};
        const bool running = seed % 3 == 0;
        if (running) run("simulation.play");
        for (int i = 0; i < 60; ++i) {
            std::string name;
            const json params = random_command(random, session_->document(), name);
            const json before = document();
            const auto done = session_->execute(name, params);
            if (running && i % 5 == 0) session_->step();
            if (!done.ok()) {
                ASSERT_EQ(document(), before) << "a refused " << name << " changed the document";
            } else {
                states.push_back(document());
            }
        }

        // Back to the start, each undo to an earlier state; then forward to the end.
        const json last = document();
        std::size_t steps = 0;
        while (!run("edit.undo")["undone"].is_null()) {
            ++steps;
            ASSERT_NE(std::find(states.begin(), states.end(), document()), states.end())
                << "seed " << seed << ": undo " << steps << " gave a document that never was";
        }
        ASSERT_EQ(document(), states.front()) << "seed " << seed;
        ASSERT_GT(steps, 20u);
        while (!run("edit.redo")["redone"].is_null()) --steps;
        ASSERT_EQ(steps, 0u);
        ASSERT_EQ(document(), last) << "seed " << seed;
    }
}

TEST_F(SessionTest, PlaysTheSameAfterAnyEditsThatWereUndone) {
    const auto fall = [this] {
        run("simulation.reset");
        run("simulation.step", {{"count", 120}});
        std::vector<EntityState> states;
        session_->read_states(states);
        std::vector<double> numbers;
        for (const EntityState& state : states)
            for (int i = 0; i < 3; ++i) numbers.push_back(state.pose.position[i]);
        return numbers;
    };
    for (int i = 0; i < 5; ++i) add_box({0.1 * i, 1.0 + 0.6 * i, 0});
    const auto first = fall();
    run("simulation.reset");
    const EntityIndex extra = add_box({0, 8, 0});
    run("entity.remove", {{"indices", {2, 3}}});
    run("edit.undo");
    run("entity.remove", {{"indices", {extra}}});
    EXPECT_EQ(fall(), first);
}

TEST_F(SessionTest, PlayPauseStepResetAndKeep) {
    const EntityIndex box = add_box({0, 3, 0});
    session_->take_events();
    run("simulation.step", {{"count", 10}});
    EXPECT_EQ(session_->simulated_steps(), 10u);
    EXPECT_FALSE(session_->playing());
    EXPECT_LT(where(box).y, 3);
    run("simulation.play");
    EXPECT_TRUE(session_->playing());
    session_->step();
    run("simulation.pause");
    EXPECT_EQ(session_->simulated_steps(), 11u);
    EXPECT_NEAR(session_->simulated_time(), 11.0 / 60, 1e-9);
    run("simulation.reset");
    EXPECT_EQ(where(box).y, 3);
    EXPECT_EQ(session_->simulated_steps(), 0u);
    EXPECT_TRUE(session_->take_events().all_poses);

    // Settle: the resting pose becomes the document's, and can be undone.
    const json before = document();
    run("simulation.step", {{"count", 200}});
    run("simulation.keep");
    EXPECT_NEAR(session_->document().find(box)->pose.position.y, 0.25, 0.02);
    EXPECT_NEAR(where(box).y, 0.25, 0.02);
    EXPECT_EQ(run("edit.undo")["undone"], "Keep poses and forms");
    EXPECT_EQ(document(), before);
    EXPECT_EQ(where(box).y, 3);
}

TEST_F(SessionTest, DropsWhatIsAddedOntoTheSurfaceUnderThePointer) {
    const EntityIndex table = add_box({0, 0.5, 0}, 0.5);
    const json ray = {{"origin", {0.1, 5, 0.2}}, {"direction", {0, -1, 0}}};
    const json ball = {{"shape", {{"type", "sphere"}, {"radius", 0.2}}}};
    const EntityIndex on_table = run("entity.add", {{"entity", ball}, {"drop", ray}})["index"];
    EXPECT_NEAR(where(on_table).y, 1.2, 2e-3);
    EXPECT_NEAR(where(on_table).x, 0.1, 1e-9);

    // Placed beside the table on the floor, and against its side.
    const json beside = {{"origin", {3, 5, 0}}, {"direction", {0, -1, 0}}};
    const EntityIndex on_floor = run("entity.add", {{"entity", ball}, {"drop", beside}})["index"];
    EXPECT_NEAR(where(on_floor).y, 0.2, 2e-3);
    const json side = {{"origin", {-5, 0.6, 0}}, {"direction", {1, 0, 0}}};
    const EntityIndex at_side = run("entity.add", {{"entity", ball}, {"drop", side}})["index"];
    EXPECT_NEAR(where(at_side).x, -0.3, 6e-3);
    EXPECT_NEAR(where(at_side).y, 1.2, 2e-3) << "it is put on the thing, as on a stack";
    run("entity.set_attribute", {{"indices", {table}}, {"name", "kind"}, {"value", "static"}});
    const EntityIndex before = run("entity.add", {{"entity", ball}, {"drop", side}})["index"];
    EXPECT_NEAR(where(before).x, -0.7, 6e-3);
    EXPECT_NEAR(where(before).y, 0.2, 2e-3) << "it stands on the floor before what is fixed";

    // Nothing is hit: it is still placed at a finite position.
    const json sky = {{"origin", {0, 2, 0}}, {"direction", {0, 1, 0}}};
    EXPECT_TRUE(is_finite(where(run("entity.add", {{"entity", ball}, {"drop", sky}})["index"])));
}

TEST_F(SessionTest, AddsToTheRunningWorldAtOnce) {
    run("simulation.play");
    const EntityIndex box = add_box({0, 3, 0});
    for (int i = 0; i < 200; ++i) session_->step();
    EXPECT_NEAR(where(box).y, 0.25, 0.02);
    EXPECT_EQ(session_->document().find(box)->pose.position.y, 3) << "the document keeps the start";
    run("entity.transform", {{"poses", {{{"index", box}, {"position", {2, 1, 0}}}}}});
    EXPECT_EQ(where(box), (Vec3{2, 1, 0}));
    run("entity.remove", {{"indices", {box}}});
    session_->step();
    run("edit.undo");
    EXPECT_EQ(where(box), (Vec3{2, 1, 0}));
    session_->step();
}

TEST_F(SessionTest, PicksWhatTheRayMeets) {
    const EntityIndex box = add_box({0, 1, 0});
    const json params = {{"origin", {0, 5, 0}}, {"direction", {0, -2, 0}}};
    const json hit = run("scene.pick", params)["hit"];
    EXPECT_EQ(hit["index"], box);
    EXPECT_NEAR(hit["distance"].get<double>(), 3.75, 1e-6);
    json ignoring = params;
    ignoring["ignore"] = box;
    EXPECT_EQ(run("scene.pick", ignoring)["hit"]["index"], 1);
    EXPECT_TRUE(run("scene.pick", {{"origin", {0, 5, 0}}, {"direction", {0, 1, 0}}})["hit"].is_null());
}

TEST_F(SessionTest, AGrabPullsAPointToItsTargetAndHoldsIt) {
    const EntityIndex box = add_box({0, 0.25, 0});
    EXPECT_NE(
        error_of("simulation.grab", {{"index", box}, {"point", {0, 0, 0}}, {"target", {0, 0, 0}}}).find("stopped"),
        std::string::npos);
    run("simulation.play");
    run("simulation.grab", {{"index", box}, {"point", {0.25, 0.5, 0.25}}, {"target", {1, 2, 0}}, {"strength", 1e4}});
    double highest = 0;
    for (int i = 0; i < 180; ++i) {
        session_->step();
        highest = std::max(highest, where(box).y);
    }
    // It hangs below the point that is held, and never rose above it.
    EXPECT_LT(highest, 2.1);
    EXPECT_NEAR(where(box).x, 1, 0.1);
    EXPECT_NEAR(where(box).y, 2 - std::sqrt(3) * 0.25, 0.1);
    run("simulation.release");
    for (int i = 0; i < 180; ++i) session_->step();
    EXPECT_LT(where(box).y, 0.5);
}

TEST_F(SessionTest, ShowsAttributesWithTheirOrigin) {
    const EntityIndex box = add_box({0, 1, 0});
    run("entity.set_attribute", {{"indices", {box}}, {"name", "friction_static"}, {"value", 0.9}});
    const json rows = run("entity.attributes", {{"index", box}})["attributes"];
    bool found = false;
    for (const json& row : rows) {
        for (const char* field : {"name", "kind", "kind_label", "label", "value", "unit", "low", "high", "source",
                                  "level", "help", "type", "choices", "range", "automatic", "overridden"})
            EXPECT_TRUE(row.contains(field)) << field << " of " << row.value("name", "?");
        if (row["name"] != "friction_static") continue;
        found = true;
        EXPECT_EQ(row["value"], 0.9);
        EXPECT_EQ(row["automatic"], 0.5);
        EXPECT_EQ(row["overridden"], true);
        EXPECT_EQ(row["level"], "manual");
    }
    EXPECT_TRUE(found);
    run("entity.reset_attribute", {{"indices", {box}}, {"name", "friction_static"}});
    EXPECT_TRUE(session_->document().find(box)->attributes.empty());
}

TEST_F(SessionTest, TellsWhatCollides) {
    EXPECT_NE(error_of("entity.collision_shape", {{"index", 99}}).find("99"), std::string::npos);
    EXPECT_NE(error_of("entity.collision_shape").find("index"), std::string::npos);
    const EntityIndex box = add_box({0, 1, 0});
    const json shape = run("entity.collision_shape", {{"index", box}})["shape"];
    EXPECT_EQ(shape["type"], "box");
    EXPECT_EQ(shape["half_extents"], json({0.25, 0.25, 0.25}));
    const EntityIndex plane = run("entity.add", {{"entity", {{"shape", {{"type", "plane"}}}}}})["index"];
    EXPECT_TRUE(run("entity.collision_shape", {{"index", plane}})["shape"].is_null());
    run("entity.set_attribute", {{"indices", {box}}, {"name", "kind"}, {"value", "visual"}});
    EXPECT_TRUE(run("entity.collision_shape", {{"index", box}})["shape"].is_null());
}

TEST_F(SessionTest, ActionsTellWhatTheyDid) {
    const EntityIndex box = add_box({0, 1, 0});
    run("entity.update", {{"index", box}, {"entity", {{"enabled", false}}}});
    run("action.add", {{"name", "drop one"},
                       {"once", false},
                       {"receiver", {{"index", box}}},
                       {"trigger", {{"type", "signal"}, {"button", "Drop"}}},
                       {"effect", {{"type", "spawn"}, {"pose", {{"position", {0, 2, 0}}}}}}});
    run("simulation.play");
    EXPECT_EQ(run("action.trigger", {{"button", "Drop"}})["started"], 1);
    EXPECT_EQ(run("action.trigger", {{"button", "Nothing"}})["started"], 0);
    session_->take_events();
    session_->step();
    std::vector<std::string> names;
    EntityIndex born = 0;
    for (const json& message : session_->take_events().messages) {
        names.push_back(message["event"]);
        if (message["event"] == "spawned") born = message["entity"]["index"];
    }
    EXPECT_EQ(names, (std::vector<std::string>{"spawned", "action"}));
    EXPECT_EQ(run("hello")["spawned"].size(), 1u);
    EXPECT_TRUE(std::isfinite(where(born).y));
    run("simulation.reset");
    EXPECT_EQ(run("hello")["spawned"].size(), 0u);
}

TEST_F(SessionTest, SavesLoadsListsAndRecovers) {
    add_box({0, 1, 0});
    const json saved = run("scene.save", {{"name", "../My: scene?"}});
    const json before = document();
    EXPECT_EQ(before["title"], "../My: scene?");
    EXPECT_EQ(saved["name"], "../My: scene?");
    EXPECT_EQ(fs::path(saved["path"].get<std::string>()).parent_path(), folder_ / "saved");
    EXPECT_EQ(run("hello")["unsaved"], false);
    add_box({1, 1, 0});
    EXPECT_EQ(run("hello")["unsaved"], true);
    run("edit.undo");
    EXPECT_EQ(run("hello")["unsaved"], false) << "undone to what is on disk";
    run("edit.redo");

    // A journal is beside it until it is saved.
    const json edited = document();
    const auto kinds = [this] {
        std::vector<std::string> found;
        const json list = run("scene.list");
        for (const json& scene : list["scenes"]) found.push_back(scene["kind"]);
        return found;
    };
    EXPECT_EQ(kinds(), (std::vector<std::string>{"saved"})) << "the journal is in use";
    session_ = make();
    EXPECT_EQ(kinds(), (std::vector<std::string>{"saved", "recovery"}));
    run("scene.load", {{"name", "../My: scene?"}});
    EXPECT_EQ(document()["entities"], before["entities"]);
    const json recovered = run("hello")["recovered"];
    ASSERT_EQ(recovered.size(), 1u);
    EXPECT_EQ(recovered[0]["title"], "../My: scene?");
    EXPECT_EQ(recovered[0]["scene"], "../My: scene?");
    run("scene.load", {{"name", recovered[0]["name"]}});
    EXPECT_EQ(document(), edited);
    EXPECT_EQ(run("hello")["unsaved"], true);
    EXPECT_EQ(run("hello")["name"], "../My: scene?");
    run("scene.save");
    EXPECT_EQ(kinds(), (std::vector<std::string>{"saved"}));
    run("scene.load", {{"scene", before}});
    EXPECT_EQ(document(), before);

    // A file that can't be opened leaves the open scene unchanged.
    EXPECT_NE(error_of("scene.load", {{"name", "none"}}), "accepted");
    EXPECT_NE(error_of("scene.load", {{"scene", {{"embody_scene", 3}}}}), "accepted");
    EXPECT_EQ(document(), before);
}

TEST_F(SessionTest, DifferentNamesAreDifferentScenes) {
    const std::vector<std::string> names = {"a/b", "a_b", "a:b", "a%2Fb", "A/B", "a\nb",
                                            ".a",  "..",  "%",   "è/é",   "a.b", "a b"};
    for (const std::string& name : names) {
        run("scene.new", {{"name", "title of " + name}});
        EXPECT_EQ(run("scene.save", {{"name", name}})["name"], name);
    }
    std::vector<std::string> listed;
    const json scenes = run("scene.list")["scenes"];
    for (const json& scene : scenes) listed.push_back(scene["name"]);
    EXPECT_TRUE(std::is_permutation(names.begin(), names.end(), listed.begin(), listed.end())) << scenes.dump(2);
    for (const std::string& name : names) {
        run("scene.load", {{"name", name}});
        EXPECT_EQ(document()["title"], name) << "saving gives the scene the name as its title";
        EXPECT_EQ(run("hello")["name"], name);
    }
    // All of them are files in the same folder.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "saved"), fs::directory_iterator()),
              static_cast<std::ptrdiff_t>(names.size()));
}

TEST_F(SessionTest, OpensFilesThatOthersNamed) {
    fs::create_directories(folder_ / "saved");
    for (const std::string name : {"_._My_ scene_", "50% off", "50%", "a: b", "50%2f"}) {
        Document placed = new_document(name);
        ASSERT_TRUE(save_document(placed, folder_ / "saved" / (name + ".json")).ok());
    }
    const json scenes = run("scene.list")["scenes"];
    ASSERT_EQ(scenes.size(), 5u);
    for (const json& scene : scenes) {
        run("scene.load", {{"name", scene["name"]}});
        EXPECT_EQ(document()["title"], scene["title"]);
        // It is saved where it was found.
        run("scene.save");
        EXPECT_EQ(run("scene.list")["scenes"].size(), 5u) << scene.dump();
    }
}

TEST_F(SessionTest, NamesThatNoFileCanHaveAreRefusedAndTitlesOfAnyLengthAreKept) {
    EXPECT_NE(error_of("scene.save", {{"name", std::string(201, 'a')}}).find("name: is longer than"),
              std::string::npos);
    EXPECT_NE(error_of("scene.save", {{"name", std::string(100, '/')}}).find("count as three"), std::string::npos);
    EXPECT_EQ(run("scene.save", {{"name", std::string(200, 'a')}})["name"], std::string(200, 'a'));
    EXPECT_EQ(run("scene.save", {{"name", "  "}})["name"], "Untitled");
    for (const char* name : {"demo/stack", "autosave/stack"})
        EXPECT_NE(error_of("scene.save", {{"name", name}}).find("name: begins with"), std::string::npos);

    // Two long titles that differ at their ends have a journal each.
    for (const char* end : {"1", "2"}) {
        std::string title;
        for (int i = 0; i < 500; ++i) title += "è/";
        run("scene.new", {{"name", title + end}});
        add_box({0, 1, 0});
    }
    session_ = make();
    std::set<std::string> titles;
    const json scenes = run("scene.list")["scenes"];
    for (const json& scene : scenes) {
        if (scene["kind"] != "recovery") continue;
        run("scene.load", {{"name", scene["name"]}});
        titles.insert(document()["title"].get<std::string>());
    }
    EXPECT_EQ(titles.size(), 2u) << scenes.dump(2);
}

TEST_F(SessionTest, DraftsOfKilledSavesGoAtTheNextStart) {
    run("scene.save", {{"name", "kept"}});
    fs::create_directories(folder_ / "saved" / "autosave");
    const fs::path drafts[] = {folder_ / "saved" / "kept.json.77-1.embody-draft",
                               folder_ / "saved" / "autosave" / "kept.journal.77-2.embody-draft",
                               folder_ / "saved" / "kept.json.77-3.embody-draft"};
    for (const fs::path& draft : drafts) std::ofstream(draft) << "half a sce";
    const fs::path others[] = {folder_ / "saved" / "kept.json.backup", folder_ / "saved" / "notes.txt"};
    for (const fs::path& other : others) std::ofstream(other) << "mine";

    // A running program is writing the third one.
    const int writer = open(drafts[2].c_str(), O_WRONLY);
    ASSERT_EQ(flock(writer, LOCK_EX | LOCK_NB), 0);
    session_ = make();
    EXPECT_FALSE(fs::exists(drafts[0]));
    EXPECT_FALSE(fs::exists(drafts[1]));
    EXPECT_TRUE(fs::exists(drafts[2])) << "is in use";
    for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
    EXPECT_EQ(run("scene.list")["scenes"].size(), 1u);
    close(writer);
    session_ = make();
    EXPECT_FALSE(fs::exists(drafts[2]));
}

// A refusal of physics at the opening names file, entity and the field as in the file.
TEST_F(SessionTest, WhatPhysicsRefusesIsToldByFileEntityAndField) {
    const json ball = {{"index", 7}, {"name", "Ball"}, {"shape", {{"type", "sphere"}, {"radius", 0.1}}}};
    const json box = {{"index", 9}, {"shape", {{"type", "box"}, {"half_extents", {1, 1, 1}}}}};
    const json hinge = {{"type", "hinge"}, {"name", "Axle"}, {"entity_a", 9}, {"entity_b", 7}};
    struct Case {
        const char* pointer;
        json value;
        const char* says;
    };
    const Case cases[] = {
        {"/entities/0/pose",
         {{"position", {0, 1e12, 0}}},
         "mine.json: entity 7 (Ball): pose.position[1]: must be between"},
        {"/entities/1/pose", {{"position", {0, 0, 1e-320}}}, "mine.json: entity 9: pose.position[2]: is a denormal"},
        {"/entities/0/linear_velocity", {1e9, 0, 0}, "entity 7 (Ball): linear_velocity[0]: must be"},
        {"/entities/0/angular_velocity", {0, 0, 1e9}, "entity 7 (Ball): angular_velocity[2]: must be"},
        {"/entities/0/force", {0, 1e20, 0}, "entity 7 (Ball): force[1]: must be"},
        {"/entities/0/torque", {0, 1e20, 0}, "entity 7 (Ball): torque[1]: must be"},
        {"/entities/0",
         {{"index", 7}, {"name", "Ball"}, {"shape", {{"type", "plane"}}}, {"attributes", {{"kind", "rigid"}}}},
         "mine.json: entity 7 (Ball): shape: a plane can only be static"},
        {"/entities/0/shape", {{"type", "sphere"}, {"radius", 1e9}}, "mine.json: entities[0].shape.radius: must be"},
        {"/entities/0/attributes",
         {{"inertia", {1, 1, 9, 0, 0, 0}}, {"mass", 1}},
         "mine.json: entities[0].attributes.inertia: no principal moment"},
        {"/joints/0/anchor", {0, 0, 1e12}, "mine.json: joints[0].anchor[2]: must be between"},
        {"/joints/0/anchor", {9e8, 9e8, 9e8}, "accepted"},
        {"/joints/0/frame_a", {{"position", {0, 0, 1e12}}}, "mine.json: joint 1 (Axle): frame_a.position[2]: must be"},
        {"/joints/0/limit", {{"lower", -9}, {"upper", 1}}, "mine.json: joint 1 (Axle): limit.lower: must be"},
        {"/joints/0/motor", {{"speed", 1e9}, {"max_force", 1}}, "mine.json: joint 1 (Axle): motor.speed: must be"},
        {"/settings", {{"gravity", {0, 1e9, 0}}}, "mine.json: settings.gravity[1]: must be"},
    };
    const json right = {{"embody_scene", 1}, {"entities", {ball, box}}, {"joints", {hinge}}};
    for (const Case& wrong : cases) {
        json scene = right;
        scene[json::json_pointer(wrong.pointer)] = wrong.value;
        const std::string told = error_of("scene.load", {{"text", scene.dump()}, {"file", "mine.json"}});
        EXPECT_NE(told.find(wrong.says), std::string::npos) << wrong.pointer << " gave: " << told;
        EXPECT_EQ(error_of("scene.load", {{"scene", scene}}) == "accepted", told == "accepted");
    }

    // A saved scene is named by its file.
    json scene = right;
    scene["entities"][0]["pose"] = {{"position", {0, 1e12, 0}}};
    fs::create_directories(folder_ / "saved");
    const fs::path file = folder_ / "saved" / "wrong.json";
    std::ofstream(file) << scene.dump();
    EXPECT_EQ(error_of("scene.load", {{"name", "wrong"}}).find(file.string() + ": entity 7 (Ball): pose"), 0u);
}

// An anchor inside its range, but too far from an entity at the other end of the world.
TEST_F(SessionTest, AnAnchorThatIsTooFarFromItsEntityIsToldAsAnAnchor) {
    const json scene = {
        {"embody_scene", 1},
        {"entities",
         {{{"index", 1}, {"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"pose", {{"position", {-9e8, 0, 0}}}}}}},
        {"joints", {{{"type", "ball"}, {"entity_b", 1}, {"anchor", {9e8, 0, 0}}}}}};
    const std::string told = error_of("scene.load", {{"scene", scene}});
    EXPECT_NE(told.find("scene.joints[0].anchor: is more than 1e9 m away"), std::string::npos) << told;
}

TEST_F(SessionTest, ARefusedEditLeavesDocumentAndWorldAlone) {
    const EntityIndex box = add_box({0, 1, 0});
    const json before = document();
    // A plane can't move: the world refuses something that the reader can't check.
    EXPECT_NE(
        error_of("entity.update",
                 {{"index", box}, {"entity", {{"shape", {{"type", "plane"}}}, {"attributes", {{"kind", "rigid"}}}}}}),
        "accepted");
    EXPECT_NE(error_of("entity.add", {{"entity", {{"model", "none"}}}}), "accepted");
    EXPECT_EQ(document(), before);
    EXPECT_EQ(where(box).y, 1);
    run("simulation.step", {{"count", 100}});
    EXPECT_NEAR(where(box).y, 0.25, 0.02);
}

}  // namespace
}  // namespace embody::scene
