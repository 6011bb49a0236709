// SPDX-License-Identifier: MIT
// The Studio's panel shows the mass that the solver uses.
#include <gtest/gtest.h>

#include <cstdlib>

#include "attributes/physical_kind.h"
#include "catalog/catalog.h"
#include "folders.h"
#include "physics/definitions/mass_properties.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;

constexpr EntityIndex thing = 2;

void expect_panel_is_solver(const Simulation& simulation, const std::string& what) {
    const auto panel = simulation.attributes(thing);
    ASSERT_TRUE(panel.ok()) << what;
    const physics::World& world = simulation.world();
    const physics::BodyHandle body = simulation.body(thing);
    ASSERT_FALSE(body.is_null()) << what;
    EXPECT_EQ(world.mass(body), panel->number("mass", -1)) << what;
    const Vec3 center = inverse_transform_point(world.pose(body), world.center_of_mass(body));
    const Vec3 shown = std::get<Vec3>(panel->find("center_of_mass")->value);
    EXPECT_LT(distance(center, shown), 1e-9 * (1 + length(shown))) << what;
    const Mat3 inertia = world.inertia(body), told = std::get<Mat3>(panel->find("inertia")->value);
    for (int k = 0; k < 3; ++k) EXPECT_LT(distance(inertia.column(k), told.column(k)), 1e-9 * trace(told)) << what;
}

using OwnAttributes = decltype(Entity::attributes);

TEST(PanelMass, IsTheSolversForEveryShapeWhateverAPersonSets) {
    const OwnAttributes sets[] = {{},
                                  {{"mass", 3.7}},
                                  {{"density", 530.0}},
                                  {{"density", 7800.0}, {"fill_fraction", 0.13}},
                                  {{"fill_fraction", 0.3}},
                                  {{"bulk_density", 77.0}},
                                  {{"volume", 0.25}},
                                  {{"mass", 2.0}, {"density", 900.0}, {"fill_fraction", 0.5}}};
    int compared = 0;
    for (const Entity& sample : samples::everything().entities) {
        const auto* shape = std::get_if<physics::ShapeDefinition>(&sample.geometry);
        // Planes, heightfields and sheets enclose no volume.
        if (!shape || !(physics::mass_properties(*shape)->volume > 0)) continue;
        for (const OwnAttributes& own : sets) {
            Document document = samples::floor_and_box(1);
            document.entities[1].geometry = *shape;
            document.entities[1].attributes = own;
            document.entities[1].attributes["kind"] = to_value(PhysicalKind::rigid);
            std::string what = physics::shape_name(*shape);
            for (const auto& [name, value] : own) what += " " + name;
            const auto simulation = samples::make(document);
            ASSERT_TRUE(simulation) << what;
            expect_panel_is_solver(*simulation, what);
            ++compared;
        }
    }
    EXPECT_GE(compared, 7 * 8);
}

// Needs the database that ./test imports from the collections on this machine; without ./test there is none.
TEST(PanelMass, IsTheSolversForRealModels) {
    const char* database = std::getenv("EMBODY_TEST_DATABASE");
    if (database == nullptr) GTEST_SKIP() << "EMBODY_TEST_DATABASE names no database of models";
    auto catalog = catalog::Catalog::open(database, source_folder() / "data/taxonomy", {}, {});
    ASSERT_TRUE(catalog.ok()) << catalog.error().message();
    constexpr std::int64_t step = 7;
    int compared = 0;
    for (catalog::SearchQuery query{.limit = 1};; query.offset += step) {
        const auto page = (*catalog)->search(query);
        ASSERT_TRUE(page.ok()) << page.error().message();
        if (page->models.empty()) break;
        const catalog::ModelSummary& model = page->models.front();
        if (traits_of(model.physical_kind).matter != attributes::Matter::body || is_static(model.physical_kind))
            continue;
        for (const double scale : {1.0, 0.37}) {
            Document document = samples::floor_and_box(1);
            document.entities[1].geometry = ModelReference{model.key};
            document.entities[1].attributes = {};
            document.entities[1].scale = scale;
            const auto simulation = Simulation::create(document, catalog->get());
            ASSERT_TRUE(simulation.ok()) << model.key << ": " << simulation.error().message();
            expect_panel_is_solver(**simulation, model.key);
            ++compared;
        }
    }
    EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace embody::scene
