// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "catalog/import_fixture.h"
#include "database/decomposition_table.h"
#include "geometry/furniture_meshes.h"

namespace embody::catalog {
namespace {

// A chair as the confined worker would prepare it.
Result<void> prepare_chairs(const std::vector<ImportItem>& items,
                            const std::function<bool(std::size_t, Result<PreparedModel>)>& done) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        auto model = prepare_box(items[i]);
        if (!model) return model.error();
        const geometry::TriangleMesh mesh = geometry::make_chair();
        interchange::RawScene scene;
        scene.meshes.emplace_back();
        scene.meshes[0].positions = mesh.positions;
        scene.meshes[0].triangles = mesh.triangles;
        auto compact = interchange::encode(scene);
        if (!compact) return compact.error();
        model->geometry = compact->bytes;
        auto parts = make_convex_parts(mesh, 16, 0.01);
        if (!parts) return parts.error();
        model->facts.geometry.hull_concavity = parts->hull_concavity;
        model->convex_parts = std::move(*parts);
        if (!done(i, std::move(*model))) break;
    }
    return {};
}

class ConvexPartsTest : public ImportTest {
protected:
    void SetUp() override {
        write_model("office_chair.obj", std::string(80, 'x'));
        ASSERT_TRUE(import({models()}, {}, prepare_chairs));
        catalog_ = open();
        ASSERT_TRUE(catalog_);
        id_ = catalog_->model("office chair")->id;
    }
    [[nodiscard]] std::int64_t stored() const {
        auto connection = database::open_model_database(database());
        return *(*connection)->query_integer("SELECT count(*) FROM model_decomposition");
    }

    std::unique_ptr<Catalog> catalog_;
    std::int64_t id_ = 0;
};

TEST_F(ConvexPartsTest, RefusesUnknownModelsAndLimits) {
    EXPECT_FALSE(catalog_->convex_parts(999'999, 16, 0.01));
    EXPECT_FALSE(catalog_->convex_parts(id_, 0, 0.01));
    EXPECT_FALSE(catalog_->convex_parts(id_, 300, 0.01));
    EXPECT_FALSE(catalog_->convex_parts(id_, 16, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(stored(), 1);
}

TEST_F(ConvexPartsTest, ThoseOfTheImportAreStoredAndOthersAreMadeOnce) {
    EXPECT_EQ(catalog_->attributes(id_)->word("collision_shape", ""), "decomposition");
    const auto usual = catalog_->convex_parts(id_, 16, 0.01);
    ASSERT_TRUE(usual) << usual.error().message();
    EXPECT_EQ(usual->hulls.size(), 6u);
    EXPECT_EQ(stored(), 1);
    const auto fewer = catalog_->convex_parts(id_, 3, 0.01);
    ASSERT_TRUE(fewer) << fewer.error().message();
    EXPECT_LE(fewer->hulls.size(), 3u);
    EXPECT_GT(fewer->concavity, usual->concavity);
    EXPECT_EQ(stored(), 2);
    EXPECT_EQ(catalog_->convex_parts(id_, 3, 0.01)->hulls, fewer->hulls);
    EXPECT_EQ(stored(), 2);
}

TEST_F(ConvexPartsTest, AChangeByHandOfALimitMakesThemAnew) {
    ASSERT_TRUE(catalog_->set_attribute(id_, "max_hulls", 2.0));
    EXPECT_EQ(stored(), 2);
    ASSERT_TRUE(catalog_->set_attribute(id_, "hull_error", 0.05));
    EXPECT_EQ(stored(), 3);
    ASSERT_TRUE(catalog_->reset_attribute(id_, "max_hulls"));
    EXPECT_EQ(stored(), 4);
    ASSERT_TRUE(catalog_->set_attribute(id_, "collision_shape", std::string("convex_hull")));
    ASSERT_TRUE(catalog_->set_attribute(id_, "max_hulls", 7.0));
    EXPECT_EQ(stored(), 4);
}

TEST_F(ConvexPartsTest, NewGeometryRemovesThem) {
    ASSERT_TRUE(catalog_->set_attribute(id_, "max_hulls", 2.0));
    EXPECT_EQ(stored(), 2);
    ASSERT_TRUE(import({models()}, {.again = true}, prepare_chairs));
    EXPECT_EQ(stored(), 1);
    ASSERT_TRUE(import({models()}, {.again = true}));
    EXPECT_EQ(stored(), 0);
    EXPECT_EQ(catalog_->convex_parts(id_, 16, 0.01)->hulls.size(), 1u);
}

TEST_F(ConvexPartsTest, DamagedOnesAreMadeAgain) {
    auto connection = database::open_model_database(database());
    ASSERT_TRUE((*connection)->execute("UPDATE model_decomposition SET hulls = x'0500000000'"));
    EXPECT_EQ(catalog_->convex_parts(id_, 16, 0.01)->hulls.size(), 6u);
}

}  // namespace
}  // namespace embody::catalog
