// SPDX-License-Identifier: MIT
#include "catalog/prepare/prepare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "catalog/prepare/appearance.h"
#include "catalog/prepare/part_measurement.h"
#include "catalog/prepare/placement.h"
#include "catalog/prepare/surface_finish.h"
#include "catalog/prepare/thumbnail.h"
#include "geometry/decomposition/decomposition.h"
#include "geometry/furniture_meshes.h"
#include "interchange/compact/compact_geometry.h"
#include "interchange/image/image_codec.h"
#include "interchange/scratch_files.h"

namespace embody::catalog {
namespace {

using test::cube_obj;
using test::ScratchFolder;

/// An open square in the XZ plane, 2 m × 1 m, off the origin, without normals.
interchange::RawScene square() {
    interchange::RawScene scene;
    scene.materials.resize(1);
    scene.materials[0].double_sided = true;
    scene.meshes.push_back({.name = "square",
                            .material = 0,
                            .positions = {{1, 5, 1}, {3, 5, 1}, {3, 5, 2}, {1, 5, 2}},
                            .normals = {},
                            .texture_coordinates = {},
                            .triangles = {{0, 2, 1}, {0, 3, 2}}});
    return scene;
}

TEST(MeasureParts, OneForEachMaterialTheLargestFirst) {
    interchange::RawScene scene = square();
    scene.materials[0].name = "glass";
    scene.materials.push_back({.name = "steel"});
    scene.materials.push_back({.name = "nowhere"});
    for (const float x : {0.0f, 10.0f}) {  // two tetrahedra
        scene.meshes.push_back({.name = "corner",
                                .material = 1,
                                .positions = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}},
                                .normals = {},
                                .texture_coordinates = {},
                                .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    }
    const auto parts = measure_parts(scene);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].material, "steel");
    EXPECT_NEAR(parts[0].form.solid.volume, 2.0 / 6, 1e-6);
    EXPECT_NEAR(parts[0].form.shell.volume, 2 * (1.5 + std::sqrt(3.0) / 2), 1e-6);
    EXPECT_NEAR(parts[0].form.solid.center.x, 5.25, 1e-5);
    EXPECT_EQ(parts[1].material, "glass");
    EXPECT_NEAR(parts[1].form.shell.volume, 2, 1e-6);
    EXPECT_EQ(parts[1].form.solid.volume, 0);

    // Too many materials: those beyond the limit become one without a name.
    for (int i = 0; i < 100; ++i) {
        scene.materials.push_back({.name = "m" + std::to_string(i)});
        scene.meshes.push_back(scene.meshes[0]);
        scene.meshes.back().material = 3 + i;
    }
    const auto many = measure_parts(scene);
    ASSERT_EQ(many.size(), max_parts);
    EXPECT_EQ(many.back().material, "");
    EXPECT_NEAR(many.back().form.shell.volume, 2 * (102 - 31), 1e-4);
}

TEST(Appearance, ColoursAreThoseOfThePlaceAndPanesAreGlass) {
    interchange::RawScene scene = square();
    scene.materials[0] = {.name = "white", .base_color = {1, 1, 1, 1}, .base_color_image = 3};
    scene.materials.push_back({.name = "metal", .base_color = {1, 1, 1, 1}});
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].name = "sweethome3d_window_pane_on_hinge_1";
    ImportItem item;
    item.recolors = {{"", {1, 0, 0}}, {"metal", {0, 1, 0}}, {"nowhere", {0, 0, 1}}};
    set_appearance(scene, item);
    using Color = std::array<float, 4>;
    EXPECT_EQ(scene.materials[0].base_color, (Color{1, 0, 0, 1}));
    EXPECT_EQ(scene.materials[0].base_color_image, -1) << "a colour takes the texture's place";
    EXPECT_EQ(scene.materials[1].base_color, (Color{0, 1, 0, 1}));
    const auto& pane = scene.materials.at(static_cast<std::size_t>(scene.meshes[1].material));
    EXPECT_EQ(pane.name, "glass");
    EXPECT_EQ(pane.base_color, (Color{1, 1, 1, 0.5F}));
}

TEST(Placement, RefusesWhatHasNoExtentOrAnAbsurdOne) {
    auto scene = square();
    for (Vec3f& p : scene.meshes[0].positions) p = {1, 1, 1};
    EXPECT_FALSE(place(scene, {}));
    scene = square();
    for (Vec3f& p : scene.meshes[0].positions) p.x *= 1e20f;
    EXPECT_FALSE(place(scene, {}));
    scene = square();
    for (Vec3f& p : scene.meshes[0].positions) p.x *= 1e5f;
    const auto large = place(scene, {});
    ASSERT_FALSE(large);
    EXPECT_NE(large.error().message().find("in metres?"), std::string::npos);
}

TEST(Placement, PutsTheOriginUnderTheStatedSize) {
    auto scene = square();
    ImportItem item;
    item.stated_size = {4, 9, 3};  // the height is impossible: the square is flat
    ASSERT_TRUE(place(scene, item));
    EXPECT_EQ(scene.meshes[0].positions[0], (Vec3f{-2, 0, -1.5f}));
    EXPECT_EQ(scene.meshes[0].positions[2], (Vec3f{2, 0, 1.5f}));
}

TEST(Placement, TurnsBeforeItMeasures) {
    auto scene = square();
    ImportItem item;
    item.stated_rotation = {0, 0, 1, 0, 1, 0, -1, 0, 0};  // a quarter turn about Y: z becomes x
    item.stated_size = {1, 1, 2};
    ASSERT_TRUE(place(scene, item));
    EXPECT_NEAR(scene.meshes[0].positions[0].x, -0.5f, 1e-6f);
    EXPECT_NEAR(scene.meshes[0].positions[0].z, 1, 1e-6f);
}

TEST(Placement, MirroringTurnsTrianglesAround) {
    auto scene = square();
    ImportItem item;
    item.stated_rotation = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    ASSERT_TRUE(place(scene, item));
    EXPECT_EQ(scene.meshes[0].triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(SurfaceFinish, OpenSurfacesShowBothSidesAndClosedOnesDoNot) {
    auto scene = square();
    finish_surfaces(scene);
    EXPECT_TRUE(scene.materials[0].double_sided);
    // Modelled with both sides: drawing both would flicker.
    scene = square();
    scene.meshes[0].triangles.push_back({0, 1, 2});
    scene.meshes[0].triangles.push_back({0, 2, 3});
    finish_surfaces(scene);
    EXPECT_FALSE(scene.materials[0].double_sided);
}

TEST(SurfaceFinish, NormalsAreSharpAtAFold) {
    // Two squares at a right angle with a common edge.
    interchange::RawScene scene;
    scene.meshes.push_back({.name = "fold",
                            .material = -1,
                            .positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {1, 1, 0}, {0, 1, 0}},
                            .normals = {},
                            .texture_coordinates = {},
                            .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 5}}});
    finish_surfaces(scene);
    const auto& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.normals.size(), 12u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(std::fabs(mesh.normals[i].y), 1, 1e-6);
    for (std::size_t i = 6; i < 12; ++i) EXPECT_NEAR(std::fabs(mesh.normals[i].z), 1, 1e-6);
}

TEST(Prepare, SaysWhatIsWrongAndWhere) {
    const ScratchFolder scratch;
    Preparation preparation;
    for (const std::string& content :
         {std::string(), std::string("nonsense"), std::string("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n")}) {
        const auto prepared = preparation.prepare({.path = scratch.write("bad.obj", content).string()});
        ASSERT_FALSE(prepared);
        EXPECT_NE(prepared.error().message().find("bad.obj"), std::string::npos) << prepared.error().message();
    }
    EXPECT_FALSE(preparation.prepare({.archive = (scratch.path() / "none.zip").string(), .path = "m.obj"}));
    EXPECT_FALSE(preparation.prepare({.path = "/"}));
    EXPECT_FALSE(preparation.prepare({}));
}

TEST(Prepare, FoldersThatAreOnlyPlacesSayNothing) {
    const ScratchFolder scratch;
    Preparation preparation;
    for (const auto& [file, folder] :
         std::vector<std::pair<std::string, std::string>>{{"Chairs/Desktop/a.obj", "Chairs"},
                                                          {"temp/Kitchen/a.obj", "Kitchen"},
                                                          {"New Folder/Documents/a.obj", ""}}) {
        const auto prepared = preparation.prepare({.path = scratch.write(file, cube_obj()).string()});
        ASSERT_TRUE(prepared) << prepared.error().message();
        EXPECT_EQ(prepared->facts.folder, folder);
    }
}

TEST(Prepare, MeasuresACubeExactly) {
    const ScratchFolder scratch;
    Preparation preparation;
    ImportItem item{.path = scratch.write("Furniture/Kitchen/cube.obj", cube_obj()).string()};
    item.stated_size = {2, 3, 4};
    const auto prepared = preparation.prepare(item);
    ASSERT_TRUE(prepared) << prepared.error().message();
    const auto& facts = prepared->facts;
    EXPECT_EQ(facts.name, "cube");
    EXPECT_EQ(facts.folder, "Furniture/Kitchen");
    EXPECT_TRUE(facts.size_is_stated);
    EXPECT_TRUE(facts.geometry.closed);
    EXPECT_NEAR(facts.geometry.volume, 24, 1e-5);
    EXPECT_NEAR(facts.geometry.hull_volume, 24, 1e-5);
    EXPECT_NEAR(facts.geometry.surface_area, 52, 1e-5);
    EXPECT_NEAR(facts.geometry.center_of_volume.y, 1.5, 1e-6);
    EXPECT_NEAR(facts.geometry.unit_inertia.x.x, 24 * (9 + 16) / 12.0, 1e-4);
    EXPECT_EQ(facts.geometry.fitted_shape, "box");
    EXPECT_NEAR(facts.geometry.fitted_pose.position.y, 1.5, 1e-6);
    EXPECT_EQ(prepared->quality, 3);
    EXPECT_EQ(prepared->triangles, 12u);
    EXPECT_EQ(prepared->hull_points.size(), 8u);

    // The stored mesh is the one that was measured.
    const auto mesh = interchange::decode_mesh(prepared->geometry);
    ASSERT_TRUE(mesh);
    const Bounds bounds = geometry::bounds(*mesh);
    EXPECT_LT(distance(bounds.lower, {-1, 0, -2}), 1e-4);
    EXPECT_LT(distance(bounds.upper, {1, 3, 2}), 1e-4);
}

std::string obj_text(const geometry::TriangleMesh& mesh) {
    std::string text;
    for (const Vec3f& p : mesh.positions) {
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    }
    for (const auto& t : mesh.triangles) {
        text += "f";
        for (const std::uint32_t corner : t) text += " " + std::to_string(corner + 1);
        text += "\n";
    }
    return text;
}

TEST(Prepare, HollowThingsThatMoveAreDecomposed) {
    const ScratchFolder scratch;
    Preparation preparation;
    ImportItem item{.path = scratch.write("chair.obj", obj_text(geometry::make_chair())).string()};
    const auto chair = preparation.prepare(item);
    ASSERT_TRUE(chair) << chair.error().message();
    EXPECT_EQ(chair->convex_parts.hulls.size(), 6u);
    EXPECT_EQ(chair->convex_parts.max_hulls, 16);
    EXPECT_EQ(chair->convex_parts.hull_error, attributes::usual_hull_error);
    EXPECT_GT(chair->facts.geometry.hull_concavity, 0.15);

    // An immovable model collides by its triangles; its hollowness is computed all the same.
    item.movable = false;
    const auto fixed = preparation.prepare(item);
    ASSERT_TRUE(fixed);
    EXPECT_TRUE(fixed->convex_parts.hulls.empty());
    EXPECT_EQ(fixed->facts.geometry.hull_concavity, chair->facts.geometry.hull_concavity);

    const auto cube = preparation.prepare({.path = scratch.write("cube.obj", cube_obj()).string()});
    ASSERT_TRUE(cube);
    EXPECT_TRUE(cube->convex_parts.hulls.empty());
    EXPECT_EQ(cube->facts.geometry.hull_concavity, 0);
}

TEST(Prepare, LimitsOfADecompositionAreThoseOfTheAttributes) {
    const geometry::DecompositionParameters usual;
    EXPECT_EQ(usual.hull_error, attributes::usual_hull_error);
}

TEST(Prepare, FlatModelsGetAThinBox) {
    const ScratchFolder scratch;
    Preparation preparation;
    const auto prepared =
        preparation.prepare({.path = scratch.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n").string()});
    ASSERT_TRUE(prepared) << prepared.error().message();
    EXPECT_FALSE(prepared->facts.geometry.closed);
    EXPECT_EQ(prepared->facts.geometry.volume, 0);
    EXPECT_EQ(prepared->quality, 1);
    EXPECT_EQ(prepared->hull_points.size(), 8u);
    EXPECT_NEAR(prepared->facts.geometry.hull_volume, 1e-3, 1e-6);
}

TEST(Prepare, ThumbnailIsTheCataloguesIconOrARenderedPicture) {
    const ScratchFolder scratch;
    const auto icon = interchange::encode_png({2, 1, {9, 9, 9, 255, 9, 9, 9, 255}});
    const auto archive = scratch.write_zip(
        "c.zip", {{"cube.obj", cube_obj()}, {"icon.png", std::string(icon.begin(), icon.end())}, {"bad.png", "x"}});
    Preparation preparation;
    ImportItem item{.archive = archive.string(), .path = "cube.obj", .icon_path = "icon.png"};
    const auto picture = [&] {
        const auto prepared = preparation.prepare(item);
        EXPECT_TRUE(prepared);
        auto image = interchange::decode_image(prepared->thumbnail);
        EXPECT_TRUE(image);
        EXPECT_EQ(image->width, thumbnail_size);
        EXPECT_EQ(image->height, thumbnail_size);
        return *image;
    };
    const auto alpha = [](const interchange::Image& image, int x, int y) {
        return image.rgba[4 * static_cast<std::size_t>(y * thumbnail_size + x) + 3];
    };
    const auto stretched = picture();
    EXPECT_EQ(alpha(stretched, 128, 20), 0);  // above the wide icon
    EXPECT_EQ(alpha(stretched, 5, 128), 255);

    // Without a usable icon the cube itself is drawn: in the centre, not in the corners.
    for (const char* path : {"", "bad.png", "missing.png"}) {
        item.icon_path = path;
        const auto rendered = picture();
        EXPECT_EQ(alpha(rendered, 128, 128), 255);
        EXPECT_EQ(alpha(rendered, 2, 2), 0);
        EXPECT_EQ(alpha(rendered, 253, 253), 0);
    }
}

}  // namespace
}  // namespace embody::catalog
