// SPDX-License-Identifier: MIT
// A primitive's category says its kind: liquid, bulk, cloth, rope, something soft, without any attribute of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "attributes/physical_kind.h"
#include "catalog/catalog.h"
#include "database/temporary_folder.h"
#include "folders.h"
#include "scene/sample_documents.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using physics::BoxShape;
using physics::CapsuleShape;
using physics::ShapeDefinition;

class PrimitiveOfCategory : public testing::Test {
protected:
    PrimitiveOfCategory() {
        auto opened = catalog::Catalog::open(folder_ / "models.sqlite", source_folder() / "data/taxonomy");
        if (!opened.ok()) ADD_FAILURE() << opened.error().message();
        catalog_ = std::move(opened).value();
        document_ = samples::floor_and_box(1);
    }
    Entity& thing() { return document_.entities[1]; }
    void become(const char* category, const ShapeDefinition& shape) {
        thing().category = category;
        thing().geometry = shape;
        auto made = Simulation::create(document_, catalog_.get());
        if (!made.ok()) ADD_FAILURE() << made.error().message();
        simulation_ = std::move(made).value();
    }
    [[nodiscard]] attributes::AttributeSet acting() const { return simulation_->attributes(2).value(); }

    test::TemporaryFolder folder_;
    std::unique_ptr<catalog::Catalog> catalog_;
    Document document_;
    std::unique_ptr<Simulation> simulation_;
};

TEST_F(PrimitiveOfCategory, BehavesAsAModelOfItWould) {
    become("honey", BoxShape{{0.05, 0.05, 0.05}});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_TRUE(simulation_->points(2)->is_liquid());
    const double density = acting().number("rest_density", 0);
    EXPECT_GT(density, 1350) << "honey, not water";
    EXPECT_NEAR(simulation_->points(2)->mass() / (density * 1e-3), 1, 0.03);
    EXPECT_NEAR(acting().number("mass", 0), density * 1e-3, 1e-9);

    become("sand", BoxShape{{0.1, 0.1, 0.1}});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_GT(simulation_->points(2)->radius(), 0);
    become("tablecloth", BoxShape{{0.5, 0.001, 0.5}});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_NEAR(simulation_->points(2)->mass(), acting().number("area_density", 0), 1e-6) << "of a square metre";
    become("rope", CapsuleShape{0.01, 1});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_NEAR(simulation_->points(2)->mass(), acting().number("linear_density", 0) * 2.02, 1e-6);
    become("cushion", BoxShape{{0.2, 0.08, 0.2}});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_LT(simulation_->points(2)->mass(), 3) << "foam";
    EXPECT_TRUE(simulation_->notes().empty());
}

TEST_F(PrimitiveOfCategory, YieldsToWhatAPersonSets) {
    thing().attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    become("cushion", BoxShape{{0.2, 0.08, 0.2}});
    EXPECT_FALSE(simulation_->points(2));
    EXPECT_LT(simulation_->world().mass(simulation_->body(2)), 3) << "a rigid cushion is still as light as one";
    thing().attributes = {{"mass", 5.0}};
    become("cushion", BoxShape{{0.2, 0.08, 0.2}});
    EXPECT_NEAR(simulation_->points(2)->mass(), 5, 1e-9);
    thing().attributes = {{"category", std::string("water")}};
    become("cushion", BoxShape{{0.2, 0.08, 0.2}});
    ASSERT_TRUE(simulation_->points(2));
    EXPECT_TRUE(simulation_->points(2)->is_liquid()) << "renamed in the property panel";
}

TEST_F(PrimitiveOfCategory, ChangesNothingWhereThingsOfItAreRigidOrItIsUnknown) {
    thing().category.clear();
    become("", BoxShape{{0.2, 0.08, 0.2}});
    const double usual = simulation_->world().mass(simulation_->body(2));
    for (const char* category : {"toy", "chair", "wall", "shot"}) {
        become(category, BoxShape{{0.2, 0.08, 0.2}});
        ASSERT_FALSE(simulation_->points(2)) << category;
        EXPECT_EQ(simulation_->world().mass(simulation_->body(2)), usual) << category;
    }
    // A primitive whose shape cannot be of the kind is rigid and has a note why; a plane is always rigid or static.
    become("curtain", BoxShape{{0.2, 0.2, 0.2}});
    EXPECT_FALSE(simulation_->points(2));
    EXPECT_EQ(simulation_->notes().size(), 1u);
    become("water", physics::PlaneShape{});
    EXPECT_FALSE(simulation_->points(2));
    EXPECT_TRUE(simulation_->notes().empty());
}

// Liquids fill the space that others leave free, also where only the category says that one is a liquid.
TEST_F(PrimitiveOfCategory, LiquidsAreFilledLast) {
    Entity block = thing();
    block.index = 3;
    block.geometry = ShapeDefinition{BoxShape{{0.1, 0.1, 0.1}}};
    block.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
    document_.entities.push_back(block);
    become("water", BoxShape{{0.2, 0.1, 0.2}});
    ASSERT_TRUE(simulation_->points(2));
    std::vector<Vec3> particles;
    simulation_->points(2)->read(particles);
    for (const Vec3 p : particles) EXPECT_FALSE(std::fabs(p.x) < 0.09 && std::fabs(p.z) < 0.09);
}

}  // namespace
}  // namespace embody::scene
