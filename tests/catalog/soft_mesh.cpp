// SPDX-License-Identifier: MIT
#include "catalog/soft_mesh.h"

#include <gtest/gtest.h>

#include "attributes/physical_kind.h"
#include "catalog/import_fixture.h"
#include "geometry/sample_meshes.h"

namespace embody::catalog {
namespace {

geometry::TriangleMesh box(Vec3 size) { return geometry::make_box(0.5 * size); }

TEST(SoftMesh, CountFollowsTheFormNotTheSize) {
    for (const double size : {0.01, 1.0, 30.0}) {
        const auto cube = make_soft_mesh(box({size, size, size}));
        ASSERT_TRUE(cube) << cube.error().message();
        EXPECT_GT(cube->mesh.tetrahedra.size(), 500u);
        EXPECT_LT(cube->mesh.tetrahedra.size(), 1000u);
        EXPECT_NEAR(geometry::volume(cube->mesh) / (size * size * size), 1, 0.08);
        EXPECT_EQ(cube->left_out, 0u);
    }
    // A mattress with two cells across would need more tetrahedra than the maximum.
    const auto mattress = make_soft_mesh(box({2, 0.2, 0.9}));
    ASSERT_TRUE(mattress) << mattress.error().message();
    EXPECT_GT(mattress->mesh.tetrahedra.size(), 1300u);
    EXPECT_LT(mattress->mesh.tetrahedra.size(), 2300u);
    const auto cushion = make_soft_mesh(box({0.4, 0.15, 0.4}));
    ASSERT_TRUE(cushion);
    EXPECT_LE(cushion->cell, 0.075) << "two cells across";
    EXPECT_GT(cushion->cell, 0.05) << "and not three";
}

TEST(SoftMesh, AResolutionSaysHowManyCellsLieAcross) {
    const double thickness = 3 * 0.024 / 0.56;  // 3 V/A, which is less than its height
    for (const int resolution : {1, 2, 3, 4}) {
        const auto cushion = make_soft_mesh(box({0.4, 0.15, 0.4}), resolution);
        ASSERT_TRUE(cushion) << cushion.error().message();
        EXPECT_NEAR(cushion->cell, thickness / resolution, 1e-6);
        EXPECT_EQ(cushion->flatness, 1);
    }
    for (const Vec3 size : {Vec3{2, 0.2, 0.9}, Vec3{2, 0.001, 2}}) {
        const auto too_many = make_soft_mesh(box(size), 12);
        ASSERT_FALSE(too_many);
        EXPECT_NE(too_many.error().why.find("soft_resolution of 12 takes"), std::string::npos)
            << too_many.error().message();
        EXPECT_FALSE(too_many.error().remedy.empty());
    }
}

TEST(SoftMesh, FlatThingsAreCutFromFlatCells) {
    for (const Vec3 size : {Vec3{0.6, 0.01, 0.6}, {0.02, 0.6, 0.6}, {2, 1, 0.05}, {1, 0.01, 0.02}}) {
        const auto flat = make_soft_mesh(box(size));
        ASSERT_TRUE(flat) << flat.error().message();
        EXPECT_GT(flat->flatness, 1);
        EXPECT_LE(flat->flatness, 8);
        EXPECT_LE(flat->mesh.tetrahedra.size(), 2600u);
        EXPECT_LE(flat->mesh.nodes.size(), 1000u);
        EXPECT_GT(geometry::volume(flat->mesh) / (size.x * size.y * size.z), 0.7);
        Bounds bounds;
        for (const Vec3 node : flat->mesh.nodes) bounds.add(node);
        EXPECT_LT(length(bounds.size() - size), 0.1 * length(size));
        EXPECT_EQ(soft_mesh_from(stored_form(flat))->flatness, flat->flatness);
    }
    EXPECT_EQ(make_soft_mesh(box({0.4, 0.15, 0.4}))->flatness, 1) << "a cushion is not flat";
    const auto too_flat = make_soft_mesh(box({2, 0.01, 2}));
    ASSERT_FALSE(too_flat) << too_flat->mesh.tetrahedra.size();
    EXPECT_FALSE(too_flat.error().remedy.empty());
}

TEST(SoftMesh, WhatCannotBeSoftSaysWhy) {
    geometry::TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto none = make_soft_mesh(sheet);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().why, "its surface encloses nothing");

    EXPECT_FALSE(make_soft_mesh(box({2, 0.001, 2}))) << "cells of millimetres on two metres";

    // Three separate boxes; a small part beside one of them moves along with it.
    geometry::TriangleMesh three;
    const auto add = [&](Vec3 at, double size) {
        const auto first = static_cast<std::uint32_t>(three.positions.size());
        const geometry::TriangleMesh cube = box({size, size, size});
        for (const Vec3f& p : cube.positions) three.positions.push_back(to_vec3f(to_vec3(p) + at));
        for (const auto& t : cube.triangles) three.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    };
    add({}, 1);
    add({3, 0, 0}, 0.5);
    const auto with_crumb = make_soft_mesh(three);
    ASSERT_TRUE(with_crumb) << with_crumb.error().message();
    EXPECT_EQ(with_crumb->left_out, 1u);
    EXPECT_NEAR(geometry::volume(with_crumb->mesh), 1, 0.1);
    add({0, 3, 0}, 1);
    add({0, 0, 3}, 1);
    const auto apart = make_soft_mesh(three);
    ASSERT_FALSE(apart);
    EXPECT_NE(apart.error().why.find("do not hang together"), std::string::npos);
}

TEST(SoftMesh, ComesBackFromItsStoredFormBitForBit) {
    const auto made = make_soft_mesh(box({0.4, 0.15, 0.4}));
    ASSERT_TRUE(made);
    const database::StoredSimulationMesh stored = stored_form(made);
    EXPECT_EQ(stored.kind, "soft");
    EXPECT_TRUE(is_current(stored));
    const auto read = soft_mesh_from(stored);
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->mesh.nodes.size(), made->mesh.nodes.size());
    for (std::size_t i = 0; i < made->mesh.nodes.size(); ++i) EXPECT_EQ(read->mesh.nodes[i], made->mesh.nodes[i]) << i;
    EXPECT_EQ(read->mesh.tetrahedra, made->mesh.tetrahedra);
    EXPECT_EQ(read->mesh.surface, made->mesh.surface);
    EXPECT_EQ(read->cell, made->cell);

    const auto problem =
        soft_mesh_from(stored_form(Error{"soft mesh", "its surface encloses nothing", "make it rigid"}));
    ASSERT_FALSE(problem);
    EXPECT_EQ(problem.error().why, "its surface encloses nothing");
    EXPECT_EQ(problem.error().remedy, "make it rigid");

    // Truncated, or with an invalid node.
    for (std::size_t size = 0; size < stored.mesh.size(); size += 997) {
        database::StoredSimulationMesh cut = stored;
        cut.mesh.resize(size);
        EXPECT_FALSE(soft_mesh_from(cut)) << size;
    }
    database::StoredSimulationMesh wrong = stored;
    wrong.mesh.back() = 0x7F;
    EXPECT_FALSE(soft_mesh_from(wrong));
}

class StoredSoftMesh : public ImportTest {
protected:
    [[nodiscard]] std::int64_t stored(const std::string& where = "") const {
        auto connection = database::open_model_database(database());
        return *(*connection)->query_integer("SELECT count(*) FROM model_simulation_mesh " + where);
    }
};

TEST_F(StoredSoftMesh, IsMadeAtTheImportOfSoftModelsAndElseWhenItIsNeeded) {
    write_model("teddy_bear.obj", std::string(40, 'x'));
    write_model("office_chair.obj", std::string(80, 'x'));
    ASSERT_TRUE(import());
    EXPECT_EQ(stored(), 1);
    const auto catalog = open();
    ASSERT_TRUE(catalog);
    const auto bear = catalog->model("teddy bear"), chair = catalog->model("office chair");
    ASSERT_TRUE(bear && chair);
    EXPECT_EQ(bear->physical_kind, attributes::PhysicalKind::soft);
    const auto mesh = catalog->soft_mesh(bear->id);
    ASSERT_TRUE(mesh) << mesh.error().message();
    EXPECT_NEAR(geometry::volume(mesh->mesh), 0.4 * 0.4 * 0.4, 0.005);
    EXPECT_EQ(stored(), 1);

    // A person makes the chair soft: its mesh is made at once and is the one that is returned later.
    ASSERT_TRUE(catalog->set_attribute(chair->id, "kind", to_value(attributes::PhysicalKind::soft)));
    EXPECT_EQ(stored(), 2);
    const auto first = catalog->soft_mesh(chair->id);
    ASSERT_TRUE(first);
    EXPECT_EQ(catalog->soft_mesh(chair->id)->mesh.nodes, first->mesh.nodes);
    EXPECT_EQ(stored(), 2);
    EXPECT_FALSE(catalog->soft_mesh(999'999));

    // New geometry removes the mesh; damaged meshes and those of another version are made again.
    write_model("office_chair.obj", std::string(60, 'x'));
    ASSERT_TRUE(import());
    EXPECT_NEAR(geometry::volume(catalog->soft_mesh(chair->id)->mesh), 0.6 * 0.6 * 0.6, 0.02);
    auto connection = database::open_model_database(database());
    ASSERT_TRUE((*connection)->execute("UPDATE model_simulation_mesh SET mesh = x'0500000000'"));
    EXPECT_TRUE(catalog->soft_mesh(bear->id));
    ASSERT_TRUE((*connection)->execute("UPDATE model_simulation_mesh SET revision = 0, problem = 'an old one'"));
    EXPECT_TRUE(catalog->soft_mesh(bear->id));
}

}  // namespace
}  // namespace embody::catalog
