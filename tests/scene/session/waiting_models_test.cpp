// SPDX-License-Identifier: MIT
// Scenes that are opened before their models are in the database.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "attributes/physical_kind.h"
#include "catalog/catalog.h"
#include "folders.h"
#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/sample_documents.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int model_count = 6;

class WaitingModels : public testing::Test {
protected:
    WaitingModels() {
        std::string name = (fs::temp_directory_path() / "embody_waiting_XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~WaitingModels() override { fs::remove_all(folder_); }

    // A database with the primitives only, by two connections: the session's, and that of an import.
    void open_database(const std::string& name) {
        session_.reset();
        catalog_ = open_catalog(name);
        other_ = open_catalog(name);
        auto made = Session::create(catalog_.get(), {folder_ / "saved", folder_ / "demo"});
        ASSERT_TRUE(made.ok()) << made.error().message();
        session_ = std::move(made).value();
    }
    [[nodiscard]] std::unique_ptr<catalog::Catalog> open_catalog(const std::string& name) const {
        auto catalog = catalog::Catalog::open(folder_ / name, source_folder() / "data" / "taxonomy");
        if (catalog) return std::move(*catalog);
        ADD_FAILURE() << catalog.error().message();
        return nullptr;
    }
    static std::string key(int model) { return "test:" + std::to_string(model); }
    void import_model(int model) const {
        constexpr const char* forms[] = {"primitive:box", "primitive:cylinder", "primitive:sphere"};
        const auto like = other_->model(forms[model % 3]);
        ASSERT_TRUE(like);
        const auto added = other_->add_variants({{.like = like->id,
                                                  .key = key(model),
                                                  .name = "thing " + std::to_string(model),
                                                  .tags = {},
                                                  .material_names = {},
                                                  .scale = 0.3 + 0.1 * model}});
        ASSERT_TRUE(added) << added.error().message();
    }
    json run(const std::string& command, const json& params = json::object()) {
        auto result = session_->execute(command, params);
        if (result.ok()) return result.value();
        ADD_FAILURE() << command << " " << params.dump() << ": " << result.error().message();
        return {};
    }
    void load(const Document& document) { run("scene.load", {{"scene", document_to_json(document)}}); }
    [[nodiscard]] json states() const {
        std::vector<EntityState> read;
        session_->read_states(read);
        json all = json::array();
        for (const EntityState& state : read) {
            const Vec3 p = state.pose.position;
            const Quat q = state.pose.rotation;
            json points = json::array();
            std::vector<Vec3> nodes;
            if (state.points) state.points->read(nodes);
            for (const Vec3 node : nodes) points.push_back({node.x, node.y, node.z});
            all.push_back({state.entity, p.x, p.y, p.z, q.x, q.y, q.z, q.w, state.state, std::move(points)});
        }
        return all;
    }
    [[nodiscard]] std::set<EntityIndex> present() const {
        std::vector<EntityState> read;
        session_->read_states(read);
        std::set<EntityIndex> indices;
        for (const EntityState& state : read) indices.insert(state.entity);
        return indices;
    }
    [[nodiscard]] json document() const { return document_to_json(session_->document()); }

    fs::path folder_;
    std::unique_ptr<catalog::Catalog> catalog_, other_;
    std::unique_ptr<Session> session_;
};

const std::string* model_of(const Entity& entity) {
    const auto* model = std::get_if<ModelReference>(&entity.geometry);
    return model ? &model->key : nullptr;
}

// A floor, things of random models above it, joints between neighbours, and ropes that hang on them.
Document random_scene(Random& random) {
    Document document = samples::floor_and_box();
    const int count = 5 + static_cast<int>(random.below(8));
    for (int i = 0; i < count; ++i) {
        Entity& thing = samples::add(document, "Thing " + std::to_string(i), physics::BoxShape{},
                                     {1.5 * i, random.between(0.5, 2), random.between(-1, 1)});
        thing.geometry = ModelReference{"test:" + std::to_string(random.below(model_count))};
        thing.scale = random.between(0.5, 1.5);
    }
    const EntityIndex first = 3;
    for (int i = 0; i + 1 < count; ++i) {
        if (random.below(3) != 0) continue;
        SceneJoint joint;
        joint.index = document.joints.size() + 1;
        joint.entity_a = first + static_cast<EntityIndex>(i);
        joint.entity_b = *joint.entity_a + 1;
        joint.definition.joint = physics::BallJoint{};
        joint.definition.frame_a.position = {0.75, 0, 0};
        joint.definition.frame_b.position = {-0.75, 0, 0};
        document.joints.push_back(joint);
    }
    for (int i = 0; i < 2; ++i) {
        const EntityIndex holder = first + static_cast<EntityIndex>(random.below(count));
        Vec3 place = document.find(holder)->pose.position;
        place.y += 1.5;
        Entity& rope = samples::add(document, "Rope " + std::to_string(i), physics::CapsuleShape{0.01, 0.5}, place);
        rope.attributes = {{"kind", to_value(attributes::PhysicalKind::rope)}, {"mass", 0.1}, {"rope_segments", 8.0}};
        rope.pins = {{{0, -0.5, 0}, 0.0, holder}};
    }
    return document;
}

// Edits that do not depend on which models are there.
void edit_at_random(Random& random, const Document& document, const auto& run) {
    const EntityIndex index = document.entities[random.below(document.entities.size())].index;
    switch (random.below(5)) {
        case 0:
            run("entity.transform",
                {{"poses", {{{"index", index}, {"position", {random.between(-3, 20), random.between(1, 3), 0.5}}}}}});
            break;
        case 1:
            run("entity.update", {{"index", index}, {"entity", {{"name", "Renamed"}}}});
            break;
        case 2:
            run("entity.remove", {{"indices", {index}}});
            if (random.below(2) == 0) run("edit.undo", json::object());
            break;
        case 3:
            run("entity.duplicate", {{"indices", {index}}, {"offset", {0, 2, 0}}});
            break;
        default:
            run("edit.undo", json::object());
            if (random.below(2) == 0) run("edit.redo", json::object());
            break;
    }
}

TEST_F(WaitingModels, ArriveInAnyOrderAndGiveTheSceneThatHadThemFromTheStart) {
    constexpr int cases = 12;
    open_database("whole.sqlite");
    for (int model = 0; model < model_count; ++model) import_model(model);
    auto whole = std::move(session_);
    const auto whole_catalog = std::move(catalog_);
    for (int seed = 0; seed < cases; ++seed) {
        SCOPED_TRACE(seed);
        Random random(static_cast<std::uint64_t>(seed));
        open_database("partial " + std::to_string(seed) + ".sqlite");
        std::vector<int> missing;
        for (int model = 0; model < model_count; ++model) {
            if (random.below(3) == 0)
                import_model(model);
            else
                missing.push_back(model);
        }
        for (std::size_t i = missing.size(); i > 1; --i) std::swap(missing[i - 1], missing[random.below(i)]);
        const Document opened = random_scene(random);
        load(opened);
        EXPECT_EQ(document(), document_to_json(opened)) << "nothing of the document is lost";
        // Steps between, in a third of the cases, and edits.
        const bool plays = random.below(3) == 0;
        for (const int model : missing) {
            if (random.below(2) == 0 && !session_->document().entities.empty())
                edit_at_random(random, session_->document(),
                               [&](const char* command, const json& params) { run(command, params); });
            if (plays) run("simulation.step", {{"count", 3}});
            import_model(model);
            session_->follow_catalog();
            for (const Entity& entity : session_->document().entities) {
                const std::string* name = model_of(entity);
                EXPECT_EQ(present().contains(entity.index), !name || other_->model(*name).ok()) << entity.name;
            }
        }
        EXPECT_EQ(run("hello")["waiting"], json::array());
        run("simulation.reset");
        std::swap(session_, whole);
        run("scene.load", {{"scene", document_to_json(whole->document())}});
        std::swap(session_, whole);
        const json at_start = states();
        run("simulation.step", {{"count", 30}});
        const json later = states(), same = document();
        std::swap(session_, whole);
        EXPECT_EQ(document(), same);
        EXPECT_EQ(states(), at_start) << "bit by bit";
        run("simulation.step", {{"count", 30}});
        EXPECT_EQ(states(), later);
        std::swap(session_, whole);
    }
}

Document two_things() {
    Document document = samples::floor_and_box();
    for (int i = 0; i < 2; ++i) {
        Entity& thing = samples::add(document, "Thing " + std::to_string(i), physics::BoxShape{}, {2.0 * i, 3, 0});
        thing.geometry = ModelReference{"test:" + std::to_string(i)};
    }
    return document;
}

TEST_F(WaitingModels, AreToldOnceAndAppearInTheRunningSimulation) {
    open_database("models.sqlite");
    load(two_things());
    json told, waiting;
    for (const json& event : session_->take_events().messages) {
        if (event["event"] == "message") told.push_back(event);
        if (event["event"] == "waiting") waiting = event["indices"];
    }
    ASSERT_EQ(told.size(), 1u) << told;
    EXPECT_EQ(told[0]["level"], "info");
    EXPECT_EQ(told[0]["text"].get<std::string>().find("2 things wait for their models"), 0u) << told;
    EXPECT_EQ(waiting, (json{3, 4}));
    EXPECT_EQ(run("hello")["waiting"], (json{3, 4}));
    EXPECT_EQ(run("hello")["despawned"], json::array()) << "no action took them away";

    run("simulation.play");
    for (int i = 0; i < 30; ++i) session_->step();
    EXPECT_FALSE(session_->follow_catalog());
    import_model(1);
    session_->take_events();
    EXPECT_TRUE(session_->follow_catalog());
    const Events events = session_->take_events();
    ASSERT_EQ(events.messages.size(), 1u);
    EXPECT_EQ(events.messages[0], (json{{"event", "waiting"}, {"indices", {3}}}));
    EXPECT_TRUE(events.all_poses);
    EXPECT_TRUE(session_->playing());
    EXPECT_EQ(present(), (std::set<EntityIndex>{1, 2, 4}));
    const json before = states().back();
    for (int i = 0; i < 30; ++i) session_->step();
    EXPECT_LT(states().back()[2], before[2]) << "it falls as everything";
}

TEST_F(WaitingModels, AreEditedSavedAndUndoneLikeOthers) {
    open_database("models.sqlite");
    load(two_things());
    const json start = document();
    run("entity.transform", {{"poses", {{{"index", 3}, {"position", {5, 1, 0}}}}}});
    run("entity.drop_to_floor", {{"indices", {3, 4}}});
    run("entity.duplicate", {{"indices", {4}}});
    run("entity.remove", {{"indices", {4}}});
    EXPECT_EQ(run("hello")["waiting"], (json{3, 5}));
    run("scene.save", {{"name", "kept"}});
    const json saved = document();
    run("scene.new");
    run("scene.load", {{"name", "kept"}});
    EXPECT_EQ(document()["entities"], saved["entities"]);
    EXPECT_EQ(run("hello")["waiting"], (json{3, 5}));

    load(two_things());
    run("entity.transform", {{"poses", {{{"index", 3}, {"position", {5, 1, 0}}}}}});
    import_model(0);
    EXPECT_TRUE(session_->follow_catalog());
    EXPECT_EQ(states()[2][1], 5) << "it comes where it was moved to";
    run("edit.undo");
    EXPECT_EQ(document(), start);
    EXPECT_EQ(states()[2][1], 0);

    // To a model that is there and back to the one that is not.
    run("entity.update", {{"index", 4}, {"entity", {{"model", "primitive:box"}}}});
    EXPECT_EQ(run("hello")["waiting"], json::array());
    run("edit.undo");
    EXPECT_EQ(run("hello")["waiting"], (json{4}));
    EXPECT_EQ(document(), start);
}

TEST_F(WaitingModels, AreNoModelsThatAPersonAsksFor) {
    open_database("models.sqlite");
    load(two_things());
    const auto added = session_->execute("entity.add", {{"entity", {{"name", "New"}, {"model", "test:9"}}}});
    ASSERT_FALSE(added.ok());
    EXPECT_EQ(added.error().where, "entity.model");
    const auto changed = session_->execute("entity.update", {{"index", 2}, {"entity", {{"model", "test:9"}}}});
    ASSERT_FALSE(changed.ok());
    EXPECT_EQ(changed.error().where, "entity.model");
    const auto asked = session_->execute("entity.attributes", {{"index", 3}});
    ASSERT_FALSE(asked.ok());
    EXPECT_NE(asked.error().message().find("test:0"), std::string::npos);
}

TEST_F(WaitingModels, AreNamedAllWhereASimulationNeedsThem) {
    open_database("models.sqlite");
    const auto refused = Simulation::create(two_things(), catalog_.get());
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().where, "entity 3 (Thing 0): model");
    EXPECT_NE(refused.error().why.find("2 models: test:0, test:1"), std::string::npos) << refused.error().message();
}

}  // namespace
}  // namespace embody::scene
