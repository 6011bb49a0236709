// SPDX-License-Identifier: MIT
#include "catalog/collection.h"

#include <gtest/gtest.h>

#include "attributes/classify.h"
#include "attributes/resolver.h"
#include "attributes/taxonomy_data.h"
#include "catalog/import_fixture.h"
#include "folders.h"

namespace embody::catalog {
namespace {

namespace fs = std::filesystem;

const fs::path collections = source_folder() / "data" / "collections";

TEST(Collection, AnUnknownNameIsReportedWithTheKnownOnes) {
    for (const char* name : {"missing", "../taxonomy/materials", ""}) {
        const auto read = read_collection(collections, name);
        ASSERT_FALSE(read) << name;
        EXPECT_NE(read.error().message().find("known are flightgear, kicad"), std::string::npos);
    }
}

TEST(Collection, AUsersDescriptionIsReadStrictly) {
    const test::TemporaryFolder folder;
    const std::string begin = R"({"name": "mine", "title": "Mine", "folders": [], "extensions": [".ply"], "unit": 0.01,
        "licence": "CC0-1.0", "author": "I", "source": "I made it", "up": )";
    const fs::path file = folder / "mine.json";
    write_file(file, begin + "\"z\"}");
    const auto read = read_collection(collections, file.string());
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->unit, 0.01);
    EXPECT_EQ(read->rotation[5], 1);  // up, the second row, is what was the third axis

    // Each error names its field.
    for (const auto& [text, field] : {std::pair{begin + "\"x\"}", "up"},
                                      {begin + "\"y\", \"units\": 1}", "units"},
                                      {std::string("{}"), "name"},
                                      {begin + "\"y\", \"things\": [{\"files\": \"*\"}]}", "things[0].are"}}) {
        write_file(file, text);
        const auto refused = read_collection(collections, file.string());
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message().find(field), std::string::npos) << refused.error().message();
    }
}

TEST(Collection, EachThingIsAWordOfTheTaxonomy) {
    const auto taxonomy = attributes::Taxonomy::load(taxonomy_folder);
    ASSERT_TRUE(taxonomy) << taxonomy.error().message();
    for (const char* name : {"flightgear", "kicad"}) {
        const auto collection = read_collection(collections, name);
        ASSERT_TRUE(collection) << collection.error().message();
        for (const CollectionThings& things : collection->things) {
            attributes::ModelFacts facts;
            facts.stated_thing = things.are;
            const auto what = attributes::classify((*taxonomy)->data(), facts);
            EXPECT_EQ(what.where, "collection") << name << ": " << things.are;
            EXPECT_EQ(what.steps, 0u) << name << ": " << things.are;
        }
    }
}

class CollectionImport : public ImportTest {
protected:
    [[nodiscard]] ImportOptions options() const {
        Collection relays;
        relays.name = "relays";
        relays.title = "Relays of the world";
        relays.folders = {{models(), "relay-models"}};
        relays.extensions = {".obj"};
        relays.unit = 0.00254;
        relays.licence = "CC0-1.0";
        relays.author = "Somebody";
        relays.things = {{"Coaches/*", "railway carriage"}, {"*relay*", "relay"}};
        relays.leave_out = {"*/sky.obj"};
        ImportOptions options;
        options.collection = relays;
        return options;
    }
};

TEST_F(CollectionImport, AMissingFolderIsReportedWithItsPackage) {
    const auto report = import({}, options());
    ASSERT_TRUE(report);
    ASSERT_EQ(report->failures.size(), 1u);
    EXPECT_NE(report->failures[0].error.message().find("apt-get install relay-models"), std::string::npos);
}

TEST_F(CollectionImport, ModelsHaveKeysCreditAndWhatTheyAreFromTheDescription) {
    write_model("Power_Relays/Relay_A12.obj", "aaaa");
    write_model("Coaches/Diesel.OBJ", "bbbb");
    write_model("Coaches/sky.obj", "cccc");
    write_model("Coaches/other.ply", "dddd");
    const auto report = import({}, options());
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->added, 2u);
    EXPECT_TRUE(report->failures.empty());

    const auto catalog = open();
    ASSERT_NE(catalog, nullptr);
    const auto relay = catalog->model("relays:Power_Relays/Relay_A12.obj");
    ASSERT_TRUE(relay) << relay.error().message();
    EXPECT_EQ(relay->source, "Relays of the world");
    EXPECT_EQ(relay->licence, "CC0-1.0");
    EXPECT_EQ(relay->author, "Somebody");
    EXPECT_EQ(relay->category, "relay");
    EXPECT_TRUE(catalog->facts(relay->id)->size_is_stated);
    // The file's folder has precedence over its name.
    const auto coach = catalog->model("relays:Coaches/Diesel.OBJ");
    ASSERT_TRUE(coach) << coach.error().message();
    EXPECT_EQ(coach->category, "train");
}

TEST_F(CollectionImport, FilesElsewhereAreTakenAsOfTheCollectionWhenNamed) {
    write_file(folder_ / "elsewhere" / "relay.obj", "aaaa");
    const auto report = import({folder_ / "elsewhere"}, options());
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->added, 1u);
    const auto catalog = open();
    ASSERT_NE(catalog, nullptr);
    const auto page = catalog->search({.words = "relay"});
    ASSERT_TRUE(page);
    ASSERT_EQ(page->models.size(), 1u);
    EXPECT_TRUE(page->models[0].key.starts_with("file:"));
    EXPECT_EQ(page->models[0].licence, "CC0-1.0");
}

TEST_F(CollectionImport, AnotherUnitPreparesAgain) {
    write_model("relay.obj", "aaaa");
    ASSERT_EQ(import({}, options())->added, 1u);
    EXPECT_EQ(import({}, options())->unchanged, 1u);
    ImportOptions metric = options();
    metric.collection->unit = 0.001;
    EXPECT_EQ(import({}, metric)->updated, 1u);
}

}  // namespace
}  // namespace embody::catalog
