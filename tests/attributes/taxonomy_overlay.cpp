// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "attributes/resolver.h"
#include "attributes/taxonomy_data.h"
#include "folders.h"

namespace embody::attributes {
namespace {

/// A user's folder with one file over the real taxonomy.
class TaxonomyOverlayTest : public testing::Test {
protected:
    TaxonomyOverlayTest() {
        std::string name = (std::filesystem::temp_directory_path() / "embody-overlay-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~TaxonomyOverlayTest() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& categories, const char* file = "mine.json") const {
        std::ofstream(folder_ / file) << R"({"categories": [)" << categories << "]}";
    }
    [[nodiscard]] Result<std::unique_ptr<Taxonomy>> load() const {
        return Taxonomy::load(source_folder() / "data/taxonomy", folder_);
    }
    [[nodiscard]] std::string error_of(const std::string& categories) const {
        write(categories);
        const auto loaded = load();
        return loaded ? "" : loaded.error().message();
    }
    [[nodiscard]] static AttributeSet of(const Taxonomy& taxonomy, const char* name) {
        ModelFacts facts;
        facts.name = name;
        return resolve(taxonomy, facts);
    }

    std::filesystem::path folder_;
};

TEST_F(TaxonomyOverlayTest, RefusesByFileEntryAndField) {
    EXPECT_FALSE(Taxonomy::load(source_folder() / "data/taxonomy", "/nowhere"));
    for (const auto& [categories, told] : std::vector<std::pair<std::string, std::string>>{
             {"3", "mine.json: categories[0]"},
             {R"({"words": ["x"]})", "mine.json: categories[0].name"},
             {R"({"name": "chair", "mass": [1, 2, 3]})", "categories[0].source"},
             {R"({"name": "chair", "mass": [3, 2, 1], "source": "scale"})", "categories[0].mass"},
             {R"({"name": "chair", "material": "unobtanium"})", "categories[0].material"},
             {R"({"name": "chair", "colour": "red"})", "categories[0].colour"},
             {R"({"name": "widget", "words": ["widget"]})", "categories[0].kind"},
             {R"({"name": "chair", "words": ["zorb"]}, {"name": "table", "words": ["zorb"]})", "categories[1].words"},
             {R"({"name": "chair", "subcategories": [{"name": "table", "words": []}]})", "subcategories[0].name"}}) {
        const std::string error = error_of(categories);
        EXPECT_NE(error.find(told), std::string::npos) << categories << " → " << error;
        EXPECT_NE(error.find("mine.json"), std::string::npos) << error;
    }
}

TEST_F(TaxonomyOverlayTest, AFolderNamedLikeAFileIsNamed) {
    std::filesystem::create_directory(folder_ / "folder.json");
    const auto loaded = load();
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message().find("folder.json"), std::string::npos);
}

TEST_F(TaxonomyOverlayTest, ChangesOnlyTheGivenFieldsAndSaysWhoseTheyAre) {
    write(R"({"name": "chair", "words": ["zorbseat"], "mass": [20, 30, 40], "material": "steel",
              "source": "weighed in my shop"})");
    const auto ours = Taxonomy::load(source_folder() / "data/taxonomy");
    const auto mine = load();
    ASSERT_TRUE(mine) << mine.error().message();
    const CategoryData& before = *(*ours)->data().category("chair");
    const CategoryData& after = *(*mine)->data().category("chair");
    EXPECT_EQ(after.mass.typical, 30);
    EXPECT_EQ(after.placement, before.placement);
    EXPECT_EQ(after.usual_high, before.usual_high);
    EXPECT_EQ(after.words.size(), before.words.size() + 1);
    EXPECT_EQ((*mine)->data().categories.size(), (*ours)->data().categories.size());

    const AttributeSet set = of(**mine, "zorbseat");
    EXPECT_EQ(set.word("category", ""), "chair");
    EXPECT_NE(set.find("category")->source.find("mine.json"), std::string::npos) << set.find("category")->source;
    EXPECT_NE(set.find("mass")->source.find("your mine.json: weighed in my shop"), std::string::npos);
    EXPECT_NE(set.find("surface_material")->source.find("mine.json"), std::string::npos);
    EXPECT_EQ(set.find("placement")->source.find("mine.json"), std::string::npos);
    EXPECT_EQ(of(**mine, "table").find("mass")->source.find("mine.json"), std::string::npos);
}

TEST_F(TaxonomyOverlayTest, ANewEntryTakesItsWordsFromOurs) {
    const auto ours = Taxonomy::load(source_folder() / "data/taxonomy");
    ASSERT_EQ(of(**ours, "chair").word("category", ""), "chair");
    write(R"({"name": "throne of mine", "words": ["chair", "zorb throne"], "kind": "rigid", "placement": "floor",
              "movable": true, "material": "stone", "mass": [100, 200, 300], "at_size": [1, 2, 1],
              "usual_size": [1, 3], "source": "weighed"})");
    const auto mine = load();
    ASSERT_TRUE(mine) << mine.error().message();
    const AttributeSet set = of(**mine, "chair");
    EXPECT_EQ(set.word("category", ""), "throne of mine");
    EXPECT_NE(set.find("kind")->source.find("mine.json"), std::string::npos);
    EXPECT_EQ((*mine)->data().category("throne of mine")->domain, "mine");
}

}  // namespace
}  // namespace embody::attributes
