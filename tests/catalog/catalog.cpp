// SPDX-License-Identifier: MIT
#include "catalog/catalog.h"

#include <limits>

#include "attributes/physical_kind.h"
#include "catalog/import_fixture.h"
#include "catalog/knowledge_json.h"

namespace embody::catalog {
namespace {

using attributes::AttributeLevel;
using attributes::AttributeValue;

class CatalogTest : public ImportTest {
protected:
    void SetUp() override {
        write_model("office_chair.obj", std::string(80, 'x'));
        ASSERT_TRUE(import());
    }
    static double mass(const Catalog& catalog, std::int64_t id) {
        const auto set = catalog.attributes(id);
        EXPECT_TRUE(set);
        return set ? set->number("mass", -1) : -1;
    }
};

TEST_F(CatalogTest, RefusesAMissingTaxonomyAndAForeignFile) {
    EXPECT_FALSE(Catalog::open(database(), folder_ / "no taxonomy"));
    write_file(folder_ / "letter.sqlite", "Dear reader, this is no database at all." + std::string(2000, '.'));
    EXPECT_FALSE(Catalog::open(folder_ / "letter.sqlite", taxonomy_folder));
    EXPECT_FALSE(Catalog::open(folder_.path(), taxonomy_folder));
}

TEST_F(CatalogTest, ReportsMissingModelsAndIds) {
    const auto catalog = open();
    EXPECT_FALSE(catalog->model("nothing of this name"));
    EXPECT_FALSE(catalog->model(""));
    EXPECT_FALSE(catalog->model("999999"));
    EXPECT_FALSE(catalog->model("99999999999999999999999"));
    for (const std::int64_t id : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{999'999}}) {
        EXPECT_FALSE(catalog->facts(id));
        EXPECT_FALSE(catalog->attributes(id));
        EXPECT_FALSE(catalog->automatic_attributes(id));
        EXPECT_FALSE(catalog->thumbnail(id));
        EXPECT_FALSE(catalog->geometry_glb(id));
        EXPECT_FALSE(catalog->hull_points(id));
        EXPECT_FALSE(catalog->mesh(id));
        EXPECT_FALSE(catalog->set_attribute(id, "mass", 1.0));
        EXPECT_FALSE(catalog->reset_attribute(id, "mass"));
        EXPECT_FALSE(catalog->remove(id));
    }
}

TEST_F(CatalogTest, RefusesAWrongAttributeByName) {
    const auto catalog = open();
    const std::int64_t id = catalog->model("office chair")->id;
    EXPECT_FALSE(catalog->set_attribute(id, "mas", 1.0));
    EXPECT_FALSE(catalog->set_attribute(id, "mass", -1.0));
    EXPECT_FALSE(catalog->set_attribute(id, "mass", std::string("heavy")));
    EXPECT_FALSE(catalog->set_attribute(id, "mass", std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(catalog->attributes(id)->find("mass")->level == AttributeLevel::manual, false);
}

TEST_F(CatalogTest, ReturnsWhatWasPrepared) {
    const auto catalog = open();
    const auto model = catalog->model("office chair");
    ASSERT_TRUE(model);
    EXPECT_EQ(model->size, (Vec3{0.8f, 0.8f, 0.8f}));
    EXPECT_EQ(model->geometry_kind, GeometryKind::mesh);
    EXPECT_EQ(model->source, "models");
    EXPECT_EQ(catalog->model(model->key)->id, model->id);
    EXPECT_EQ(catalog->model(std::to_string(model->id))->id, model->id);
    EXPECT_EQ(catalog->hull_points(model->id)->size(), 8u);
    EXPECT_EQ(catalog->hull_points(model->id)->back(), (Vec3{0.8f, 0.8f, 0.8f}));
    EXPECT_EQ(catalog->mesh(model->id)->triangles.size(), 12u);
    EXPECT_EQ(catalog->thumbnail(model->id)->size(), 4u);
    EXPECT_EQ(catalog->geometry_glb(model->id)->at(0), 'g');
    EXPECT_EQ(catalog->facts(model->id)->geometry.volume_method, "test");
    EXPECT_GT(mass(*catalog, model->id), 0);
    EXPECT_EQ(catalog->search({.words = "chair"})->total, 1);
}

TEST_F(CatalogTest, AManualAttributeSurvivesReimportRemovalAndReturn) {
    std::string key;
    {
        const auto catalog = open();
        const auto model = catalog->model("office chair");
        key = model->key;
        ASSERT_TRUE(catalog->set_attribute(model->id, "mass", 17.5));
        EXPECT_EQ(mass(*catalog, model->id), 17.5);
        EXPECT_NE(catalog->automatic_attributes(model->id)->number("mass", 0), 17.5);
    }
    ASSERT_TRUE(import({models()}, {.again = true}));
    const auto catalog = open();
    EXPECT_EQ(mass(*catalog, catalog->model(key)->id), 17.5);
    write_model("office_chair.obj", std::string(90, 'x'));
    ASSERT_TRUE(import());
    EXPECT_EQ(mass(*catalog, catalog->model(key)->id), 17.5);

    // A model that is removed and imported again with its first content gets its first key.
    ASSERT_TRUE(catalog->remove(catalog->model(key)->id));
    EXPECT_FALSE(catalog->model(key));
    write_model("office_chair.obj", std::string(80, 'x'));
    ASSERT_EQ(import()->added, 1u);
    const std::int64_t id = catalog->model(key)->id;
    EXPECT_EQ(mass(*catalog, id), 17.5);
    const auto set = catalog->attributes(id);
    EXPECT_EQ(set->find("mass")->level, AttributeLevel::manual);
    EXPECT_EQ(set->find("mass")->source.rfind("set by ", 0), 0u);

    ASSERT_TRUE(catalog->reset_attribute(id, "mass"));
    EXPECT_EQ(mass(*catalog, id), catalog->automatic_attributes(id)->number("mass", 0));
}

TEST_F(CatalogTest, AManualCategoryIsWhereTheModelIsListed) {
    const auto catalog = open();
    const auto before = catalog->model("office chair");
    ASSERT_TRUE(catalog->set_attribute(before->id, "category", std::string("my things")));
    EXPECT_EQ(catalog->model("office chair")->category, "my things");
    EXPECT_EQ(catalog->search({.category = "my things"})->total, 1);
    EXPECT_EQ(catalog->search({.words = "things"})->total, 1);
    ASSERT_TRUE(catalog->reset_attribute(before->id, "category"));
    EXPECT_EQ(catalog->model("office chair")->category, before->category);
}

TEST_F(CatalogTest, AChangedTaxonomyResolvesAllModelsAgain) {
    const std::filesystem::path own = folder_ / "taxonomy";
    std::filesystem::copy(taxonomy_folder, own, std::filesystem::copy_options::recursive);
    {
        auto catalog = Catalog::open(database(), own);
        ASSERT_TRUE(catalog);
        ASSERT_TRUE((*catalog)->set_attribute((*catalog)->model("office chair")->id, "mass", 17.5));
    }
    // Every stored value is replaced, as the damaged row shows.
    auto connection = database::open_model_database(database());
    ASSERT_TRUE(connection);
    ASSERT_TRUE((*connection)->execute("UPDATE model_knowledge SET automatic = '[]'"));
    {
        auto same = Catalog::open(database(), own);
        EXPECT_TRUE((*same)->automatic_attributes((*same)->model("office chair")->id)->entries().empty());
    }
    std::ofstream(own / "categories" / "furniture.json", std::ios::app) << "\n\n";
    auto changed = Catalog::open(database(), own);
    ASSERT_TRUE(changed);
    const std::int64_t id = (*changed)->model("office chair")->id;
    EXPECT_GT((*changed)->automatic_attributes(id)->number("mass", 0), 0);
    EXPECT_EQ(mass(**changed, id), 17.5);
}

// The user's own categories extend ours: a file that is added, changed or removed changes the taxonomy.
TEST_F(CatalogTest, AChangedOverlayResolvesAgainAndKeepsWhatPersonsSet) {
    const std::filesystem::path own = folder_ / "own taxonomy";
    const auto write = [&](const std::string& mass) {
        write_file(own / "chairs.json", R"({"categories": [{"name": "office chair", "mass": )" + mass +
                                            R"(, "at_size": [0.5, 0.9, 0.5], "source": "weighed in our stock"}]})");
    };
    const auto with_overlay = [&] { return std::move(*Catalog::open(database(), taxonomy_folder, {}, own)); };
    const auto automatic_mass = [](const Catalog& catalog, const char* name) {
        return catalog.automatic_attributes(catalog.model(name)->id)->number("mass", 0);
    };
    std::filesystem::create_directories(own);
    double ours = 0;
    {
        const auto catalog = with_overlay();
        ours = automatic_mass(*catalog, "office chair");
        ASSERT_GT(ours, 0);
        ASSERT_TRUE(catalog->set_attribute(catalog->model("office chair")->id, "friction_dynamic", 0.123));
    }
    write("[40, 50, 60]");
    double heavy = 0;
    {
        const auto catalog = with_overlay();
        const std::int64_t id = catalog->model("office chair")->id;
        heavy = automatic_mass(*catalog, "office chair");
        EXPECT_GT(heavy, 2 * ours);
        EXPECT_NE(catalog->automatic_attributes(id)->find("mass")->source.find("your chairs.json"), std::string::npos)
            << catalog->automatic_attributes(id)->find("mass")->source;
        EXPECT_EQ(catalog->attributes(id)->number("friction_dynamic", 0), 0.123);
        ASSERT_TRUE(catalog->set_attribute(id, "mass", 17.5));
    }
    write("[80, 100, 120]");
    {
        const auto catalog = with_overlay();
        EXPECT_NEAR(automatic_mass(*catalog, "office chair"), 2 * heavy, 1e-6 * heavy);
        EXPECT_EQ(mass(*catalog, catalog->model("office chair")->id), 17.5);
        // Persons' changes stay in the history, and can be undone to the present automatic value.
        ASSERT_EQ(catalog->history({})->size(), 2u);
        ASSERT_TRUE(catalog->undo_changes(catalog->history({})->front().batch));
        EXPECT_NEAR(mass(*catalog, catalog->model("office chair")->id), 2 * heavy, 1e-6 * heavy);
    }
    // A broken file is named and nothing is resolved; without the files everything is as before.
    write("[3, 2, 1]");
    const auto broken = Catalog::open(database(), taxonomy_folder, {}, own);
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().message().find("chairs.json"), std::string::npos);
    std::filesystem::remove_all(own);
    const auto catalog = open();
    EXPECT_DOUBLE_EQ(automatic_mass(*catalog, "office chair"), ours);
    EXPECT_EQ(catalog->attributes(catalog->model("office chair")->id)->number("friction_dynamic", 0), 0.123);
}

TEST_F(CatalogTest, ResolvingContinuesWhereItWasStopped) {
    {
        const auto catalog = open();
        std::vector<ModelVariant> variants;
        for (int i = 0; i < 1500; ++i) {
            variants.push_back({.like = catalog->model("office chair")->id,
                                .key = "variant:" + std::to_string(i),
                                .name = "oak chair",
                                .tags = {"oak"},
                                .material_names = {"oak"},
                                .scale = 0.5});
        }
        ASSERT_TRUE(catalog->add_variants(variants));
        EXPECT_FALSE(catalog->add_variants({{.like = 100'000, .key = "variant:none"}}));
        const std::int64_t first = catalog->model("variant:0")->id;
        EXPECT_DOUBLE_EQ(catalog->facts(first)->geometry.size.x,
                         0.5 * catalog->facts(catalog->model("office chair")->id)->geometry.size.x);
        EXPECT_EQ(*catalog->geometry_glb(first), *catalog->geometry_glb(catalog->model("office chair")->id));
    }
    const std::filesystem::path own = folder_ / "taxonomy";
    std::filesystem::copy(taxonomy_folder, own, std::filesystem::copy_options::recursive);
    std::ofstream(own / "categories" / "furniture.json", std::ios::app) << "\n\n";
    auto connection = database::open_model_database(database());
    ASSERT_TRUE(connection);
    ASSERT_TRUE((*connection)->execute("UPDATE model_knowledge SET automatic = '[]'"));
    const auto unresolved = [&] {
        return *(*connection)->query_integer("SELECT count(*) FROM model_knowledge WHERE automatic = '[]'");
    };
    const std::int64_t all = unresolved();

    // Stopped after the first batch: its results are kept, and the rest is resolved later, even if the taxonomy changes
    // back and forth.
    const auto stopped = Catalog::open(database(), own, {.progress = [](std::size_t, std::size_t) { return false; }});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(unresolved(), all - 512);
    std::vector<std::size_t> told;
    ASSERT_TRUE(Catalog::open(database(), own, {.progress = [&](std::size_t done, std::size_t) {
                                  told.push_back(done);
                                  return true;
                              }}));
    EXPECT_EQ(told.front(), 1024u);
    EXPECT_EQ(unresolved(), 0);
    ASSERT_TRUE((*connection)->execute("UPDATE model_knowledge SET automatic = '[]'"));
    EXPECT_FALSE(Catalog::open(database(), taxonomy_folder, {.progress = [](auto, auto) { return false; }}));
    ASSERT_TRUE(Catalog::open(database(), own));
    EXPECT_EQ(unresolved(), 0);
}

TEST_F(CatalogTest, ANameOfTwoModelsIsAmbiguous) {
    write_model("other/office_chair.obj", std::string(85, 'x'));
    ASSERT_TRUE(import());
    const auto catalog = open();
    const auto model = catalog->model("office chair");
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().remedy.find("file:"), std::string::npos);
}

TEST_F(CatalogTest, ComesWithThePrimitivesAndTheirFormulas) {
    auto catalog = Catalog::open(folder_ / "new.sqlite", taxonomy_folder);
    ASSERT_TRUE(catalog) << catalog.error().message();
    EXPECT_EQ((*catalog)->model_count(), 6);
    EXPECT_EQ((*catalog)->search({.category = "primitives"})->total, 6);
    for (const char* shape : {"box", "sphere", "capsule", "cylinder", "cone", "plane"}) {
        const auto model = (*catalog)->model(std::string("primitive:") + shape);
        ASSERT_TRUE(model) << shape;
        EXPECT_EQ(model->geometry_kind, GeometryKind::analytical);
        EXPECT_GT((*catalog)->thumbnail(model->id)->size(), 100u) << shape;
        const auto mesh = (*catalog)->mesh(model->id);
        ASSERT_TRUE(mesh);
        EXPECT_NEAR(geometry::bounds(*mesh).lower.y, 0, 1e-4) << shape;
        EXPECT_EQ(model->physical_kind, std::string(shape) == "plane" ? attributes::PhysicalKind::static_body
                                                                      : attributes::PhysicalKind::rigid)
            << shape;
        const auto facts = (*catalog)->facts(model->id);
        ASSERT_TRUE(facts);
        EXPECT_NEAR(geometry::bounds(*mesh).size().y, facts->geometry.size.y, 1e-3) << shape;
    }
    const auto volume = [&](const char* key) { return (*catalog)->facts((*catalog)->model(key)->id)->geometry.volume; };
    EXPECT_DOUBLE_EQ(volume("primitive:box"), 1);
    EXPECT_NEAR(volume("primitive:sphere"), 0.5235988, 1e-7);
    EXPECT_NEAR(volume("primitive:cylinder"), 0.7853982, 1e-7);
    EXPECT_NEAR(volume("primitive:cone"), 0.2617994, 1e-7);

    // A model that a person removed does not come back.
    ASSERT_TRUE((*catalog)->remove((*catalog)->model("primitive:cone")->id));
    catalog = Catalog::open(folder_ / "new.sqlite", taxonomy_folder);
    EXPECT_EQ((*catalog)->model_count(), 5);
}

TEST(KnowledgeJson, RefusesDamagedText) {
    for (const char* text : {"", "{", "null", "3", "[1]", "[{}]", R"([{"name":"mass"}])", R"({"name":3})",
                             R"([{"name":"mass","number":[],"source":"","level":"kind"}])",
                             R"([{"name":"mass","number":1,"source":"","level":"best"}])",
                             R"([{"name":"inertia","tensor":[[1,2,3],[1,2]],"source":"","level":"kind"}])"}) {
        EXPECT_FALSE(set_from_json(text)) << text;
        EXPECT_FALSE(facts_from_json(text)) << text;
        EXPECT_FALSE(value_from_json(text)) << text;
    }
}

TEST(KnowledgeJson, KeepsEveryBit) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<AttributeValue> values{0.1,
                                             1e-300,
                                             infinity,
                                             -infinity,
                                             std::string("inf"),
                                             std::string(),
                                             true,
                                             false,
                                             Vec3{0.1, -infinity, 3},
                                             Mat3{{1, 2, 3}, {4, 5, 6}, {7, 8, 1.0 / 3}}};
    for (const AttributeValue& value : values) {
        const auto back = value_from_json(to_json(value));
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, value);
    }
    attributes::AttributeSet set;
    set.put({"mass", 0.1, 0.05, infinity, "Marks' handbook, \"table 3\"", AttributeLevel::category});
    const auto back = set_from_json(to_json(set));
    ASSERT_TRUE(back);
    ASSERT_EQ(back->entries().size(), 1u);
    EXPECT_EQ(back->find("mass")->high, infinity);
    EXPECT_EQ(back->find("mass")->source, "Marks' handbook, \"table 3\"");
    EXPECT_EQ(back->find("mass")->level, AttributeLevel::category);
}

TEST(KnowledgeJson, ReadsTheFactsOfDatabasesThatExist) {
    const auto facts = facts_from_json(
        R"({"name":"Box","tags":["a"],"catalogue_category":"Bedroom","folder":"f","material_names":["oak"],
            "door_or_window":false,"size_is_stated":true,"movable":true,
            "geometry":{"size":[1.0,2.0,3.0],"closed":true,"volume":6.0,"volume_method":"m","volume_relative_error":0.1,
              "center_of_volume":[0.0,1.0,0.0],"unit_inertia":[[6.5,0.1,0.2],[0.1,5.0,0.3],[0.2,0.3,2.5]],
              "hull_volume":6.0,"surface_area":22.0,"fitted_shape":"box","fitted_dimensions":[0.5,1.0,1.5],
              "fitted_position":[0.0,1.0,0.0],"fitted_rotation":[0.0,0.0,0.0,1.0],"fitted_error":0.25}})");
    ASSERT_TRUE(facts) << facts.error().message();
    EXPECT_EQ(facts->movable, true);
    EXPECT_EQ(facts->geometry.unit_inertia, (Mat3{{6.5, 0.1, 0.2}, {0.1, 5, 0.3}, {0.2, 0.3, 2.5}}));
    EXPECT_EQ(facts->geometry.fitted_pose.position, (Vec3{0, 1, 0}));
    EXPECT_EQ(facts->geometry.fitted_error, 0.25);
}

TEST(KnowledgeJson, TextThatIsNotUtf8IsReplaced) {
    attributes::ModelFacts facts;
    facts.material_names = {"Bo\xeete"};
    const auto back = facts_from_json(to_json(facts));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->material_names[0], "Bo\xef\xbf\xbdte");
    EXPECT_EQ(valid_utf8("Boîte"), "Boîte");
}

}  // namespace
}  // namespace embody::catalog
