// SPDX-License-Identifier: MIT
// Presets, copies of values, and warnings of values that make no sense.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "attributes/material_presets.h"
#include "attributes/taxonomy_data.h"
#include "catalog/catalog.h"
#include "folders.h"
#include "scene/file/scene_file.h"
#include "scene/session/session.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Values : public testing::Test {
protected:
    Values() {
        std::string name = (fs::temp_directory_path() / "embody_values_XXXXXX").string();
        folder_ = mkdtemp(name.data());
        auto catalog = catalog::Catalog::open(folder_ / "models.sqlite", source_folder() / "data" / "taxonomy");
        if (!catalog) throw std::runtime_error(catalog.error().message());
        catalog_ = std::move(*catalog);
        session_ = Session::create(catalog_.get(), {folder_ / "saved", folder_ / "demo"}).value();
        run("scene.load",
            {{"scene",
              {{"embody_scene", 1},
               {"entities",
                {entity(1, "Box", {{"type", "box"}, {"half_extents", {0.2, 0.2, 0.2}}}),
                 entity(2, "Ball", {{"type", "sphere"}, {"radius", 0.1}}),
                 entity(3, "Honey", {{"type", "box"}, {"half_extents", {0.1, 0.1, 0.1}}}, {{"kind", "fluid"}}),
                 entity(4, "Can", {{"type", "cylinder"}, {"radius", 0.1}, {"half_height", 0.1}})}}}}});
    }
    ~Values() override {
        session_.reset();
        fs::remove_all(folder_);
    }
    static json entity(int index, const char* name, const json& shape, const json& attributes = json::object()) {
        return {{"index", index},
                {"name", name},
                {"shape", shape},
                {"attributes", attributes},
                {"pose", {{"position", {index, 1, 0}}}}};
    }
    json run(const std::string& command, const json& params = json::object()) {
        auto result = session_->execute(command, params);
        if (result.ok()) return result.value();
        ADD_FAILURE() << command << " " << params.dump() << ": " << result.error().message();
        return {};
    }
    std::string error_of(const std::string& command, const json& params) {
        const auto result = session_->execute(command, params);
        return result.ok() ? "accepted" : result.error().message();
    }
    json row(EntityIndex index, const std::string& name) {
        const json told = run("entity.attributes", {{"index", index}});
        for (const json& row : told["attributes"])
            if (row["name"] == name) return row;
        return {};
    }
    double number(EntityIndex index, const std::string& name) { return row(index, name)["value"]; }
    json document() { return document_to_json(session_->document()); }
    json own(EntityIndex index) { return document()["entities"][index - 1].value("attributes", json::object()); }

    fs::path folder_;
    std::unique_ptr<catalog::Catalog> catalog_;
    std::unique_ptr<Session> session_;
};

TEST_F(Values, EveryPresetBringsWhatTheMaterialSays) {
    const json presets = run("entity.presets")["presets"];
    ASSERT_GE(presets.size(), 20u);
    for (const json& preset : presets) {
        EXPECT_FALSE(preset["source"].get<std::string>().empty()) << preset["preset"];
        run("entity.apply_preset", {{"indices", {1}}, {"preset", preset["preset"]}});
        EXPECT_EQ(row(1, "surface_material")["value"], preset["preset"]);
        for (const json& value : preset["values"])
            EXPECT_NEAR(number(1, value["name"]), value["value"], 1e-9 * value["value"].get<double>())
                << preset["preset"] << " " << value["name"];
        // A solid box of 0.4 m.
        EXPECT_NEAR(number(1, "mass"), number(1, "density") * 0.064, 1e-9 * number(1, "mass")) << preset["preset"];
    }
}

TEST_F(Values, EveryMaterialOfAPresetIsInTheTaxonomy) {
    // A name that the table of materials lost would leave the list of presets shorter without a word.
    EXPECT_EQ(attributes::material_presets(catalog_->taxonomy()).size(), 22u);
    EXPECT_EQ(attributes::preset_named(catalog_->taxonomy(), "cast_iron").value().label, "Cast iron");
}

TEST_F(Values, APresetTakesBackWhatWouldHideItInOneStep) {
    for (const json& own : {json{"mass", 1e4}, json{"friction_static", 1.4}, json{"restitution", 0.9}})
        run("entity.set_attribute", {{"indices", {1, 2}}, {"name", own[0]}, {"value", own[1]}});
    run("entity.set_attribute", {{"indices", {1}}, {"name", "linear_damping"}, {"value", 0.7}});
    const json before = document();
    run("entity.apply_preset", {{"indices", {1, 2}}, {"preset", "steel"}});
    EXPECT_EQ(own(1), (json{{"linear_damping", 0.7}, {"surface_material", "steel"}}));
    EXPECT_EQ(own(2), (json{{"surface_material", "steel"}}));
    EXPECT_NEAR(number(1, "mass"), 7850 * 0.064, 1e-6);
    EXPECT_EQ(run("edit.undo")["undone"], "Make 2 entities of steel");
    EXPECT_EQ(document(), before);
    run("edit.redo");
    EXPECT_EQ(row(2, "surface_material")["value"], "steel");
}

TEST_F(Values, APresetIsRefusedByNameAndForLiquids) {
    const json before = document();
    const std::string unknown = error_of("entity.apply_preset", {{"indices", {1}}, {"preset", "kryptonite"}});
    EXPECT_NE(unknown.find("preset: \"kryptonite\" is no preset"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("wood, steel"), std::string::npos) << unknown;
    const std::string liquid = error_of("entity.apply_preset", {{"indices", {1, 3}}, {"preset", "steel"}});
    EXPECT_NE(liquid.find("Honey is a liquid"), std::string::npos) << liquid;
    EXPECT_NE(liquid.find("make its kind rigid"), std::string::npos) << liquid;
    EXPECT_EQ(document(), before);
}

TEST_F(Values, WhatWasSetIsCopiedAndLeftOutWhereItDoesNotApply) {
    run("entity.set_attribute", {{"indices", {1}}, {"name", "mass"}, {"value", 3.5}});
    run("entity.set_attribute", {{"indices", {1}}, {"name", "friction_static"}, {"value", 0.9}});
    const json before = document();
    const json copied = run("entity.copy_attributes", {{"from", 1}, {"indices", {1, 2, 3, 4}}});
    EXPECT_EQ(number(2, "mass"), 3.5);
    EXPECT_EQ(number(4, "friction_static"), 0.9);
    // Of a liquid the mass counts, static friction has no meaning.
    EXPECT_EQ(copied["copied"], 4);
    std::vector<std::string> skipped;
    for (const json& skip : copied["skipped"]) {
        EXPECT_EQ(skip["index"], 3);
        skipped.push_back(skip["name"]);
    }
    EXPECT_EQ(skipped, (std::vector<std::string>{"friction_static", "mass"}));
    run("edit.undo");
    EXPECT_EQ(document(), before);
}

TEST_F(Values, NamedValuesAreCopiedAsTheyAct) {
    run("entity.apply_preset", {{"indices", {1}}, {"preset", "rubber"}});
    run("entity.copy_attributes", {{"from", 1}, {"indices", {2}}, {"names", {"restitution", "surface_material"}}});
    EXPECT_EQ(number(2, "restitution"), number(1, "restitution"));
    EXPECT_EQ(own(2).size(), 2u);
    EXPECT_NE(error_of("entity.copy_attributes", {{"from", 2}, {"indices", {1}}, {"names", {"masss"}}})
                  .find("names[0]: \"masss\" is no attribute"),
              std::string::npos);
    EXPECT_NE(error_of("entity.copy_attributes", {{"from", 4}, {"indices", {1}}}).find("nothing was set by hand"),
              std::string::npos);
    EXPECT_NE(error_of("entity.copy_attributes", {{"from", 1}, {"indices", {1}}}).find("names only the thing"),
              std::string::npos);
    EXPECT_NE(error_of("entity.copy_attributes", {{"from", 77}, {"indices", {1}}}).find("from: there is no entity 77"),
              std::string::npos);
}

TEST_F(Values, WarnsOfAMassBesideTheFieldAndInTheList) {
    EXPECT_TRUE(run("entity.warnings")["entities"].empty());
    run("entity.set_attribute", {{"indices", {1}}, {"name", "mass"}, {"value", 1e9}});
    const json warnings = row(1, "mass")["warnings"];
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0]["why"].get<std::string>().find("denser than osmium"), std::string::npos);
    EXPECT_EQ(warnings[0]["remedy"], "back to automatic: 64 kg");
    EXPECT_EQ(warnings[0]["reset"], "mass");
    EXPECT_TRUE(row(1, "friction_static")["warnings"].empty());
    const json told = run("entity.warnings")["entities"];
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0]["index"], 1);
    EXPECT_EQ(told[0]["warnings"][0]["attribute"], "mass");
    EXPECT_EQ(told[0]["warnings"][0]["label"], "Mass");
    EXPECT_TRUE(run("entity.warnings", {{"indices", {2, 3}}})["entities"].empty());
    EXPECT_EQ(run("entity.warnings", {{"indices", {1, 2}}})["entities"].size(), 1u);
    run("entity.reset_attribute", {{"indices", {1}}, {"name", "mass"}});
    EXPECT_TRUE(run("entity.warnings")["entities"].empty());
}

TEST_F(Values, GravityAndJointsDecideToo) {
    run("entity.set_attribute", {{"indices", {1}}, {"name", "collision_mask"}, {"value", 0}});
    EXPECT_EQ(run("entity.warnings")["entities"].size(), 1u);
    run("scene.settings", {{"gravity", {0, 0, 0}}});
    EXPECT_TRUE(run("entity.warnings")["entities"].empty());
    run("entity.set_attribute", {{"indices", {2}}, {"name", "kind"}, {"value", "articulated"}});
    EXPECT_EQ(run("entity.warnings")["entities"][0]["warnings"][0]["attribute"], "kind");
    run("joint.add", {{"type", "ball"}, {"entity_b", 2}, {"anchor", {0, 1, 0}}});
    EXPECT_TRUE(run("entity.warnings")["entities"].empty());
}

}  // namespace
}  // namespace embody::scene
