// SPDX-License-Identifier: MIT
#include "interchange/compact/compact_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "geometry/mass_properties.h"
#include "interchange/image/image_codec.h"

namespace embody::interchange {
namespace {

/// A sphere of radius 1 m about `center`, closed, with smooth normals and texture coordinates.
RawMesh sphere(Vec3 center, int rings, int material) {
    RawMesh mesh{.name = "sphere",
                 .material = material,
                 .positions = {},
                 .normals = {},
                 .texture_coordinates = {},
                 .triangles = {}};
    const int sectors = 2 * rings;
    for (int r = 0; r <= rings; ++r) {
        for (int s = 0; s < sectors; ++s) {
            const double polar = 3.14159265358979 * r / rings, angle = 3.14159265358979 * s / rings;
            const Vec3 n{std::sin(polar) * std::sin(angle), std::cos(polar), std::sin(polar) * std::cos(angle)};
            mesh.positions.push_back(to_vec3f(center + n));
            mesh.normals.push_back(to_vec3f(n));
            mesh.texture_coordinates.push_back({static_cast<float>(s) / static_cast<float>(sectors),
                                                static_cast<float>(r) / static_cast<float>(rings)});
        }
    }
    const auto at = [&](int r, int s) { return static_cast<std::uint32_t>(r * sectors + s % sectors); };
    for (int r = 0; r < rings; ++r) {
        for (int s = 0; s < sectors; ++s) {
            mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    }
    return mesh;
}

RawScene two_spheres() {
    RawScene scene;
    scene.meshes = {sphere({0, 1, 0}, 24, 0), sphere({3, 1, 0}, 24, 1)};
    scene.materials.resize(2);
    scene.materials[0].name = "plain";
    scene.materials[1].name = "textured";
    scene.materials[1].base_color_image = 0;
    Image image{1500, 20, std::vector<std::uint8_t>(4 * 1500 * 20, 200)};
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    scene.images.push_back({"wide.png", encode_png(image)});
    return scene;
}

TEST(CompactGeometry, RefusesScenesThatCannotBeStored) {
    EXPECT_FALSE(encode({}));
    RawScene bad = two_spheres();
    bad.meshes[0].positions[5].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(encode(bad));
    bad = two_spheres();
    bad.meshes[1].triangles[3][2] = 1'000'000'000;
    EXPECT_FALSE(encode(bad));
    bad = two_spheres();
    bad.meshes[0].normals.pop_back();
    EXPECT_FALSE(encode(bad));
    bad = two_spheres();
    bad.meshes[1].texture_coordinates[0][0] = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(encode(bad));
    bad = two_spheres();
    for (RawMesh& mesh : bad.meshes) std::fill(mesh.positions.begin(), mesh.positions.end(), Vec3f{1, 1, 1});
    EXPECT_FALSE(encode(bad));
}

TEST(CompactGeometry, KeepsTheSolidToTheGridsStep) {
    const auto stored = encode(two_spheres());
    ASSERT_TRUE(stored) << stored.error().message();
    const auto mesh = decode_mesh(stored->bytes);
    ASSERT_TRUE(mesh) << mesh.error().message();
    EXPECT_EQ(mesh->triangles.size(), stored->triangles);
    EXPECT_EQ(mesh->positions.size(), stored->vertices);
    EXPECT_NEAR(stored->position_step, 5.0 / 65535, 1e-9);

    // Each vertex is within half a quantisation step of the sphere's surface, in every coordinate.
    for (const Vec3f p : mesh->positions) {
        const double radius = std::min(distance(to_vec3(p), {0, 1, 0}), distance(to_vec3(p), {3, 1, 0}));
        EXPECT_NEAR(radius, 1, stored->position_step);
    }
    geometry::TriangleMesh original;
    for (const RawMesh& part : two_spheres().meshes) {
        const auto first = static_cast<std::uint32_t>(original.positions.size());
        original.positions.insert(original.positions.end(), part.positions.begin(), part.positions.end());
        for (const auto& t : part.triangles) original.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    const double volume = geometry::integrate_polyhedron(original).volume;
    EXPECT_NEAR(geometry::integrate_polyhedron(*mesh).volume, volume, 1e-4 * volume);
}

TEST(CompactGeometry, IsSmallAndTheSameEveryTime) {
    RawScene scene = two_spheres();
    scene.images.clear();
    const auto stored = encode(scene);
    ASSERT_TRUE(stored);
    // Uncompressed: 32 bytes per vertex and 12 per triangle; the levels of detail are in it, too.
    EXPECT_LT(stored->bytes.size(), (32 * stored->vertices + 12 * stored->triangles) / 3);
    EXPECT_EQ(stored->bytes, encode(scene)->bytes);
    EXPECT_EQ(stored->parts, 2u);
    EXPECT_EQ(stored->materials, 2u);
}

TEST(CompactGeometry, ReducesTexturesAndLeavesOutDamagedOnes) {
    RawScene scene = two_spheres();
    const auto stored = encode(scene);
    ASSERT_TRUE(stored);
    EXPECT_EQ(stored->images, 1u);
    const std::string text(stored->bytes.begin(), stored->bytes.end());
    EXPECT_NE(text.find("image/jpeg"), std::string::npos);
    scene.images[0].bytes.resize(40);
    const auto without = encode(scene);
    ASSERT_TRUE(without);
    EXPECT_EQ(without->images, 0u);
    EXPECT_EQ(without->warnings.size(), 1u);
}

TEST(CompactGeometry, StoresFlatAndSingleTriangles) {
    RawScene scene;
    scene.meshes.push_back({.name = "t",
                            .material = -1,
                            .positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                            .normals = {},
                            .texture_coordinates = {},
                            .triangles = {{0, 1, 2}}});
    const auto stored = encode(scene);
    ASSERT_TRUE(stored);
    const auto mesh = decode_mesh(stored->bytes);
    ASSERT_TRUE(mesh) << mesh.error().message();
    EXPECT_EQ(mesh->triangles.size(), 1u);
}

TEST(CompactGeometry, RefusesOtherVersions) {
    const auto stored = encode(two_spheres());
    ASSERT_TRUE(stored);
    std::string text(stored->bytes.begin(), stored->bytes.end());
    const std::string field = "\"version\":1}";
    ASSERT_NE(text.find(field), std::string::npos);
    text.replace(text.find(field), field.size(), "\"version\":2}");
    const auto newer = decode_mesh(std::vector<std::uint8_t>(text.begin(), text.end()));
    ASSERT_FALSE(newer);
    EXPECT_NE(newer.error().message().find("version 2"), std::string::npos);
}

TEST(CompactGeometry, RefusesTruncatedBytes) {
    const auto stored = encode(two_spheres());
    ASSERT_TRUE(stored);
    for (std::size_t length = 0; length < stored->bytes.size(); length += 37) {
        EXPECT_FALSE(decode_mesh(std::span(stored->bytes).first(length)));
    }
    EXPECT_FALSE(to_glb(std::span(stored->bytes).first(11)));
    EXPECT_EQ(*to_glb(stored->bytes), stored->bytes);
}

TEST(CompactGeometry, SurvivesDamagedBytes) {
    const auto stored = encode(two_spheres());
    ASSERT_TRUE(stored);
    std::mt19937 random(11);
    for (int trial = 0; trial < 3000; ++trial) {
        std::vector<std::uint8_t> damaged = stored->bytes;
        for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
        // A mesh that still decodes is valid for the geometry layer.
        const auto mesh = decode_mesh(damaged);
        if (mesh) {
            EXPECT_TRUE(geometry::validate(*mesh));
        }
    }
}

}  // namespace
}  // namespace embody::interchange
