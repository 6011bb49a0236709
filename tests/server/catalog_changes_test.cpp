// SPDX-License-Identifier: MIT
//
// Changes of the catalogue by clients of the server, by its history, and by other programs at the same time.
#include <thread>

#include "catalog/import_fixture.h"
#include "folders.h"
#include "server/scene_thread_fixture.h"

namespace embody::server {
namespace {

using nlohmann::json;

constexpr int chairs = 40, puddles = 5;

/// Oak chairs, and puddles, which are fluid.
class CatalogChangesTest : public SceneThreadTest {
protected:
    void SetUp() override {
        // One model of each kind is imported; the others are copies.
        const auto taxonomy = attributes::Taxonomy::load(catalog::taxonomy_folder, {});
        auto connection = database::open_model_database(folder_ / "models.sqlite");
        ASSERT_TRUE(taxonomy && connection);
        catalog::write_file(folder_ / "models" / "chair.obj", std::string(60, 'x'));
        catalog::write_file(folder_ / "models" / "puddle of water.obj", std::string(40, 'y'));
        const auto imported =
            catalog::Importer(**connection, **taxonomy, catalog::prepare_boxes).run({folder_ / "models"}, {});
        ASSERT_TRUE(imported);
        ASSERT_EQ(imported->added, 2u);
        other_ = open();
        ASSERT_TRUE(other_);
        std::vector<catalog::ModelVariant> variants;
        for (int i = 0; i < chairs; ++i)
            variants.push_back({.like = like("chair"), .key = key(i), .name = "oak chair " + std::to_string(i)});
        for (int i = 0; i < puddles; ++i) {
            variants.push_back({.like = like("puddle of water"), .key = "test:puddle " + std::to_string(i)});
            variants.back().name = "spilled water";
        }
        const auto added = other_->add_variants(variants);
        ASSERT_TRUE(added) << added.error().message();
        for (const char* name : {"chair", "puddle of water"}) ASSERT_TRUE(other_->remove(like(name)));
    }
    [[nodiscard]] std::int64_t like(const std::string& name) const { return other_->model(name)->id; }
    static json one(const char* name, const json& value) {
        json change;
        change["name"] = name;
        change["value"] = value;
        return json::array({change});
    }
    static std::string key(int chair) { return "test:chair " + std::to_string(chair); }
    [[nodiscard]] std::unique_ptr<catalog::Catalog> open() const {
        auto catalog = catalog::Catalog::open(folder_ / "models.sqlite", source_folder() / "data" / "taxonomy");
        return catalog ? std::move(*catalog) : nullptr;
    }
    json change(const json& models, const char* name, const json& value, ClientId client = 1, bool dry_run = false) {
        return run("catalog.change", {{"models", models}, {"attributes", one(name, value)}, {"dry_run", dry_run}},
                   client);
    }
    std::string refusal(const json& models, const json& attributes) {
        return error_of("catalog.change", {{"models", models}, {"attributes", attributes}});
    }
    json entry(const std::string& model, const std::string& name) {
        return row_of(run("catalog.model", {{"key", model}}), name);
    }
    json value_in_scene(const json& entity, const std::string& name) {
        return row_of(run("entity.attributes", {{"index", entity}}), name).value("value", json());
    }
    static json row_of(const json& answer, const std::string& name) {
        for (const json& row : answer.at("attributes"))
            if (row.at("name") == name) return row;
        return json::object();
    }
    json value(const std::string& model, const std::string& name) { return entry(model, name).value("value", json()); }

    std::unique_ptr<catalog::Catalog> other_;  ///< the database as another program has it open
};

TEST_F(CatalogChangesTest, WhatIsWrongIsRefusedByFieldAndChangesNothing) {
    const json mass = one("mass", 3);
    for (const auto& [models, where] : std::map<std::string, std::string>{
             {"{}", "models: must say which"},
             {R"({"all": true, "category": "chair"})", "models: must say which"},
             {R"({"keys": ["test:chair 0"], "words": "chair"})", "models: must say which"},
             {R"({"keys": []})", "models.keys: must name"},
             {R"({"keys": "test:chair 0"})", "models.keys: "},
             {R"({"keys": ["test:chair 0", "none"]})", "models.keys[1]: "},
             {R"({"keys": ["test:chair 0", 3]})", "models.keys[1]: "},
             {R"({"word": "chair"})", "models.word"},
             {"[]", "models: "}})
        EXPECT_EQ(refusal(json::parse(models), mass).find(where), 0u)
            << models << " " << refusal(json::parse(models), mass);
    const json all = {{"all", true}};
    EXPECT_EQ(refusal(all, one("mass", -3)).find("attributes[0].value: "), 0u) << refusal(all, one("mass", -3));
    EXPECT_EQ(refusal(all, one("mas", nullptr)).find("attributes[0].value: "), 0u) << refusal(all, one("mas", nullptr));
    EXPECT_EQ(refusal(all, json::array({json{{"name", "mass"}}})).find("attributes[0].value"), 0u);
    EXPECT_EQ(refusal(all, "mass").find("attributes"), 0u);
    EXPECT_NE(refusal(all, json::array()).find("none is named"), std::string::npos);
    EXPECT_EQ(error_of("catalog.undo", {{"batch", 0}}).find("batch"), 0u);
    EXPECT_NE(error_of("catalog.undo", {{"batch", 77}}).find("77"), std::string::npos);
    EXPECT_EQ(error_of("catalog.history", {{"limit", 0}}).find("limit"), 0u);
    EXPECT_EQ(error_of("catalog.history", {{"limit", 1000}, {"changes", 1000}}).find("limit"), 0u);
    EXPECT_EQ(error_of("client.set_name", {{"name", "A\nB"}}).find("name"), 0u);
    EXPECT_EQ(error_of("client.set_name", {{"name", std::string(161, 'x')}}).find("name"), 0u);
    EXPECT_TRUE(run("catalog.history").at("batches").empty());
}

TEST_F(CatalogChangesTest, APreviewCountsNamesAndTellsWhatRefuses) {
    change({{"keys", {key(7)}}}, "mass", 4.5);
    const json preview = change({{"category", "chair"}}, "mass", 4.5, 1, true);
    EXPECT_EQ(preview.at("chosen"), chairs);
    EXPECT_EQ(preview.at("changed"), chairs - 1);
    EXPECT_EQ(preview.at("unchanged"), 1);
    EXPECT_EQ(preview.at("models").size(), 20u);
    EXPECT_TRUE(preview.at("batch").is_null());
    EXPECT_EQ(entry(key(8), "mass").at("overridden"), false);

    // A puddle has no walls; the others would be changed.
    const json mixed = change({{"all", true}}, "wall_thickness", 0.01, 1, true);
    EXPECT_EQ(mixed.at("refused"), puddles);
    EXPECT_NE(mixed.at("refusals")[0].at("why").get<std::string>().find("fluid"), std::string::npos);
    EXPECT_EQ(
        run("catalog.change", {{"models", {{"all", true}}}, {"attributes", one("wall_thickness", 0.01)}}).at("batch"),
        nullptr);
    const json skipped = run(
        "catalog.change", {{"models", {{"all", true}}}, {"attributes", one("wall_thickness", 0.01)}, {"skip", true}});
    EXPECT_GE(skipped.at("changed"), chairs);
    EXPECT_EQ(value(key(3), "wall_thickness"), 0.01);
}

TEST_F(CatalogChangesTest, OneHistoryTakesBackSceneAndCatalogueInTurn) {
    run("entity.add", {{"entity", {{"model", key(0)}}}});
    const json before = entry(key(0), "mass");
    EXPECT_EQ(change({{"words", "oak chair"}}, "mass", 9).at("label"), "Set Mass of 40 models");
    run("entity.add", {{"entity", {{"model", key(1)}}}});
    EXPECT_EQ(run("hello").at("undo").get<std::string>().find("Add"), 0u);
    run("edit.undo");
    EXPECT_EQ(run("edit.undo").at("undone"), "Set Mass of 40 models");
    EXPECT_EQ(entry(key(0), "mass"), before);
    EXPECT_EQ(run("hello").at("redo"), "Set Mass of 40 models");
    run("edit.redo");
    EXPECT_EQ(value(key(39), "mass"), 9);
    run("edit.undo");
    run("edit.redo");
    run("edit.redo");
    EXPECT_EQ(value(key(39), "mass"), 9);
    EXPECT_EQ(run("hello").at("scene").at("entities").size(), 3u);

    // Changes of models do not change the document.
    run("scene.save", {{"name", "chairs"}});
    change({{"keys", {key(2)}}}, "mass", 2);
    EXPECT_EQ(run("hello").at("unsaved"), false);
    run("edit.undo");
    EXPECT_EQ(run("hello").at("unsaved"), false);
    EXPECT_EQ(value(key(2), "mass"), 9);
}

TEST_F(CatalogChangesTest, ABatchIsTakenBackByItsNumberAndThatTooCanBeTakenBack) {
    const json first = change({{"keys", {key(0)}}}, "mass", 1).at("batch");
    const json second = change({{"keys", {key(1)}}}, "mass", 2).at("batch");
    run("catalog.undo", {{"batch", first}});
    EXPECT_EQ(entry(key(0), "mass").at("overridden"), false);
    EXPECT_NE(error_of("catalog.undo", {{"batch", first}}).find("undone already"), std::string::npos);
    run("edit.undo");
    EXPECT_EQ(value(key(0), "mass"), 1);
    run("edit.redo");
    EXPECT_EQ(entry(key(0), "mass").at("overridden"), false);
    run("edit.undo");
    EXPECT_EQ(run("edit.undo").at("undone"), "Set Mass of oak chair 1");
    EXPECT_EQ(entry(key(1), "mass").at("overridden"), false);
    EXPECT_EQ(run("edit.undo").at("undone"), "Set Mass of oak chair 0");
    EXPECT_EQ(entry(key(0), "mass").at("overridden"), false);
    EXPECT_EQ(run("edit.undo").at("undone"), nullptr);

    // An undo by the batch's number is an undo of the last action, too: redo applies it again.
    change({{"keys", {key(1)}}}, "mass", 5);
    const json last = run("catalog.history", {{"limit", 1}}).at("batches")[0].at("batch");
    run("catalog.undo", {{"batch", last}});
    EXPECT_EQ(run("edit.redo").at("redone"), "Set Mass of oak chair 1");
    EXPECT_EQ(value(key(1), "mass"), 5);
    // The undo of that undo is the redo that would come next.
    run("edit.undo");
    const json undo = run("catalog.history", {{"limit", 1}}).at("batches")[0];
    EXPECT_EQ(undo.at("command"), "undo");
    run("catalog.undo", {{"batch", undo.at("batch")}});
    EXPECT_EQ(value(key(1), "mass"), 5);
    EXPECT_EQ(run("edit.undo").at("undone"), "Set Mass of oak chair 1");
    EXPECT_EQ(entry(key(1), "mass").at("overridden"), false);
    EXPECT_EQ(second, first.get<int>() + 1);
}

TEST_F(CatalogChangesTest, WhatAnotherProgramChangedSinceIsNotUndoneAndUndoGoesOn) {
    run("entity.add", {{"entity", {{"model", key(0)}}}});
    change({{"category", "chair"}}, "mass", 9);
    ASSERT_TRUE(other_->set_attribute(other_->model(key(5))->id, "mass", 12.0));
    const std::string why = error_of("edit.undo");
    EXPECT_NE(why.find("oak chair 5"), std::string::npos) << why;
    EXPECT_EQ(value(key(0), "mass"), 9) << "all or nothing";
    EXPECT_EQ(value(key(5), "mass"), 12);
    // The batch stays in the history; undo reaches the change before it.
    EXPECT_EQ(run("edit.undo").at("undone").get<std::string>().find("Add"), 0u);
}

TEST_F(CatalogChangesTest, TheAuditNamesWhoActed) {
    run("client.set_name", {{"name", "  Ada Lovelace "}}, 4);
    change({{"keys", {key(0)}}}, "mass", 1, 4);
    change({{"keys", {key(0)}}}, "mass", 2, 9);
    thread_->forget(4);
    change({{"keys", {key(0)}}}, "mass", 3, 4);
    const json batches = run("catalog.history", {{"key", key(0)}}).at("batches");
    ASSERT_EQ(batches.size(), 3u);
    EXPECT_EQ(batches[0].at("session"), "studio 4");
    EXPECT_EQ(batches[1].at("session"), "studio 9");
    EXPECT_EQ(batches[2].at("session"), "studio: Ada Lovelace");
    EXPECT_EQ(batches[1].at("changes")[0].at("before"), 1);
    EXPECT_EQ(batches[1].at("changes")[0].at("after"), 2);
    EXPECT_EQ(batches[2].at("changes")[0].at("before"), nullptr);
    EXPECT_EQ(batches[2].at("changes")[0].at("unit"), "kg");
    EXPECT_EQ(run("catalog.history", {{"before", batches[1].at("batch")}}).at("batches").size(), 1u);
    EXPECT_TRUE(run("catalog.history", {{"key", key(3)}}).at("batches").empty());
}

TEST_F(CatalogChangesTest, TheOpenSceneFollowsAtOnceAndOwnValuesStay) {
    const json first = run("entity.add", {{"entity", {{"model", key(0)}}}}).at("index");
    const json second = run("entity.add", {{"entity", {{"model", key(1)}}}}).at("index");
    run("entity.set_attribute", {{"indices", {second}}, {"name", "mass"}, {"value", 50}});
    const json preview = change({{"category", "chair"}}, "mass", 7, 1, true);
    EXPECT_EQ(preview.at("entities"), (json{{"following", 1}, {"keeping", 1}}));
    for (const char* state : {"stopped", "paused"}) {
        if (state == std::string("paused")) {
            run("simulation.step", {{"count", 5}});
        }
        change({{"category", "chair"}}, "mass", 7);
        EXPECT_EQ(value_in_scene(first, "mass"), 7) << state;
        EXPECT_EQ(value_in_scene(second, "mass"), 50) << state;
        run("edit.undo");
        EXPECT_NE(value_in_scene(first, "mass"), 7) << state;
    }
    EXPECT_EQ(run("hello").at("simulation").at("state"), "paused");
    EXPECT_EQ(run("hello").at("simulation").at("step"), 5) << "a run goes on";
}

TEST_F(CatalogChangesTest, TheSceneFollowsAChangeOfKindWithItsJoints) {
    json entities = json::array();
    for (int i = 0; i < 2; ++i)
        entities.push_back(
            run("entity.add", {{"entity", {{"model", key(i)}, {"pose", {{"position", {i, 1, 0}}}}}}}).at("index"));
    json joint;
    joint["type"] = "ball";
    joint["entity_a"] = entities[0];
    joint["entity_b"] = entities[1];
    run("joint.add", {{"joint", joint}});
    for (const bool running : {false, true}) {
        if (running) run("simulation.step", {{"count", 5}});
        for (const char* kind : {"static", "visual", "soft"}) {
            change({{"category", "chair"}}, "kind", kind);
            EXPECT_EQ(value_in_scene(entities[0], "kind"), kind);
            run("simulation.step", {{"count", 5}});
            if (!running) run("simulation.reset");
        }
        for (int i = 0; i < 3; ++i) run("edit.undo");
        EXPECT_EQ(value_in_scene(entities[0], "kind"), "rigid");
        run("simulation.step", {{"count", 5}});
        run("simulation.reset");
    }
}

TEST_F(CatalogChangesTest, TheValuesOfAScaledEntityAreReportedAsTheModelHasThem) {
    const json index = run("entity.add", {{"entity", {{"model", key(0)}, {"scale", 2}}}}).at("index");
    const json answer = run("entity.attributes", {{"index", index}});
    EXPECT_NEAR(row_of(answer, "mass").at("value").get<double>(), 8 * value(key(0), "mass").get<double>(), 1e-9);
    for (const char* name : {"mass", "volume", "density", "kind"}) {
        const json told = row_of(answer, name).at("of_model"), own = value(key(0), name);
        if (own.is_number())
            EXPECT_NEAR(told.get<double>(), own.get<double>(), 1e-9 * own.get<double>()) << name;
        else
            EXPECT_EQ(told, own) << name;
    }
}

TEST_F(CatalogChangesTest, AllClientsHearOfChangesByOtherPrograms) {
    forget_events();
    change({{"words", "oak chair"}}, "mass", 8, 3);
    const json event = events("catalog").front();
    EXPECT_EQ(event.at("client"), 3);
    EXPECT_EQ(event.at("models"), chairs);
    EXPECT_EQ(event.at("keys").size(), static_cast<std::size_t>(chairs));
    EXPECT_EQ(event.at("attributes"), json::array({"mass"}));

    const json entity = run("entity.add", {{"entity", {{"model", key(2)}}}}).at("index");
    forget_events();
    other_->set_session("command line");
    ASSERT_TRUE(other_->set_attribute(other_->model(key(2))->id, "mass", 77.0));
    const json told = events("catalog").front();
    EXPECT_EQ(told.at("client"), nullptr);
    EXPECT_EQ(told.at("session"), "command line");
    EXPECT_EQ(told.at("keys"), json::array({key(2)}));
    EXPECT_EQ(told.at("label"), "Set Mass of oak chair 2");
    EXPECT_EQ(value_in_scene(entity, "mass"), 77);
}

// Every change is all or nothing and sees the result of the one before it, whoever made it.
TEST_F(CatalogChangesTest, TwoClientsAndAnotherProgramAtOnceLoseNothing) {
    constexpr int rounds = 15;
    std::thread program([&] {
        const auto own = open();
        ASSERT_TRUE(own);
        for (int round = 0; round < rounds; ++round) {
            const auto done =
                own->change_attributes(catalog::SearchQuery{.category = "chair"}, {{"mass", 100.0 + round}});
            EXPECT_TRUE(done) << done.error().message();
        }
    });
    const auto client = [&](ClientId id) {
        for (int round = 0; round < rounds; ++round)
            change({{"category", "chair"}}, "mass", 10.0 * static_cast<double>(id) + 0.1 * round, id);
    };
    std::thread first([&] { client(1); }), second([&] { client(2); });
    for (std::thread* each : {&program, &first, &second}) each->join();

    const auto history = other_->history({.limit = 1'000'000});
    ASSERT_TRUE(history);
    EXPECT_EQ(history->size(), static_cast<std::size_t>(3 * rounds * chairs));
    std::map<std::string, std::optional<attributes::AttributeValue>> present;
    for (auto record = history->rbegin(); record != history->rend(); ++record) {
        EXPECT_EQ(record->before, present[record->model_key]);
        present[record->model_key] = record->after;
    }
    for (int chair = 0; chair < chairs; ++chair)
        EXPECT_EQ(value(key(chair), "mass"), std::get<double>(*present.at(key(chair)))) << chair;
}

// A long command reports its progress, and the client that sent it may stop it: then nothing is changed.
TEST_F(CatalogChangesTest, LongCommandsReportProgressAndCanBeStopped) {
    constexpr int stools = 8000;
    const std::int64_t chair = other_->model(key(0))->id;
    std::vector<catalog::ModelVariant> variants;
    for (int i = 0; i < stools; ++i)
        variants.push_back({.like = chair, .key = "test:stool " + std::to_string(i), .name = "stool"});
    ASSERT_TRUE(other_->add_variants(variants));
    thread_->post(5, R"({"id": 1, "command": "catalog.change", "params":
        {"models": {"words": "stool"}, "attributes": [{"name": "category", "value": "table"}]}})");
    const json progress = events("progress").front();
    EXPECT_EQ(progress.at("client"), 5);
    EXPECT_EQ(progress.at("total"), stools);
    thread_->post(6, R"({"id": 1, "command": "catalog.stop"})");
    thread_->post(5, R"({"id": 2, "command": "catalog.stop"})");
    const json reply = next_reply(5);
    EXPECT_EQ(reply.at("ok"), false);
    EXPECT_NE(reply.dump().find("nothing was changed"), std::string::npos) << reply.dump();
    EXPECT_EQ(next_reply(5).at("ok"), true);
    EXPECT_TRUE(run("catalog.history").at("batches").empty());
    EXPECT_EQ(run("catalog.search", {{"category", "table"}}).at("total"), 0);
}

}  // namespace
}  // namespace embody::server
