// SPDX-License-Identifier: MIT
#include "interchange/compact/detail_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "geometry/triangle_distance.h"
#include "interchange/compact/compact_geometry.h"

namespace embody::interchange {
namespace {

constexpr double half_extent = 32767;

GridPoint grid_point(Vec3 p) {
    const auto number = [](double v) { return static_cast<std::uint16_t>(std::lround(half_extent * (1 + v))); };
    return {number(p.x), number(p.y), number(p.z), 0};
}

OctNormal normal(Vec3 n) {
    const auto number = [](double v) { return static_cast<std::int8_t>(std::lround(127 * v)); };
    return {number(n.x), number(n.y), number(n.z), 0};
}

/// A ball that fills the grid; smooth normals.
StoredPart ball(std::uint32_t rings) {
    StoredPart part;
    const std::uint32_t sectors = 2 * rings;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const double polar = M_PI * r / rings, angle = M_PI * s / rings;
            const Vec3 n{std::sin(polar) * std::sin(angle), std::cos(polar), std::sin(polar) * std::cos(angle)};
            part.positions.push_back(grid_point(n));
            part.normals.push_back(normal(n));
        }
    }
    const auto at = [&](std::uint32_t r, std::uint32_t s) { return r * sectors + s % sectors; };
    for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t s = 0; s < sectors; ++s) {
            part.indices.insert(part.indices.end(), {at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            part.indices.insert(part.indices.end(), {at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    }
    return part;
}

/// A cube of `cells` squares a side on each face; corners and edges have a vertex for each face.
StoredPart cube(std::uint32_t cells) {
    StoredPart part;
    for (int face = 0; face < 6; ++face) {
        const double side = face % 2 == 0 ? 1 : -1;
        const auto first = static_cast<std::uint32_t>(part.positions.size());
        for (std::uint32_t i = 0; i <= cells; ++i) {
            for (std::uint32_t j = 0; j <= cells; ++j) {
                const double u = 2.0 * i / cells - 1, v = side * (2.0 * j / cells - 1);
                const std::array<Vec3, 3> places{Vec3{side, u, v}, Vec3{v, side, u}, Vec3{u, v, side}};
                const std::array<Vec3, 3> normals{Vec3{side, 0, 0}, Vec3{0, side, 0}, Vec3{0, 0, side}};
                part.positions.push_back(grid_point(places[std::size_t(face / 2)]));
                part.normals.push_back(normal(normals[std::size_t(face / 2)]));
            }
        }
        for (std::uint32_t i = 0; i < cells; ++i) {
            for (std::uint32_t j = 0; j < cells; ++j) {
                const std::uint32_t a = first + i * (cells + 1) + j, b = a + cells + 1;
                part.indices.insert(part.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        }
    }
    return part;
}

Vec3 place(const StoredPart& part, std::uint32_t vertex) {
    const GridPoint& p = part.positions[vertex];
    return {double(p[0]), double(p[1]), double(p[2])};
}

/// How far the part's vertices are from a level's surface at most, steps of the grid.
double farthest(const StoredPart& part, const std::vector<std::uint32_t>& indices) {
    double most = 0;
    for (std::uint32_t vertex = 0; vertex < part.positions.size(); ++vertex) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const std::array<Vec3, 3> triangle{place(part, indices[i]), place(part, indices[i + 1]),
                                               place(part, indices[i + 2])};
            least = std::min(least, geometry::squared_distance(place(part, vertex), triangle));
        }
        most = std::max(most, least);
    }
    return std::sqrt(most);
}

TEST(DetailLevels, BecomeCoarserWithinTheirErrors) {
    const StoredPart part = ball(48);
    const auto levels = detail_levels(part);
    ASSERT_EQ(levels.size(), level_errors.size());
    std::size_t before = part.indices.size();
    for (const DetailLevel& level : levels) {
        EXPECT_LE(level.indices.size(), before);
        before = level.indices.size();
        for (const std::uint32_t index : level.indices) ASSERT_LT(index, part.positions.size());
        // The library's estimate is of a mean; twice that, and a step of the grid, bounds the farthest point here.
        EXPECT_LE(farthest(part, level.indices), 2 * level.error + 1);
    }
    EXPECT_LT(levels.front().indices.size(), 2 * part.indices.size() / 3);
    EXPECT_LT(levels.back().indices.size(), part.indices.size() / 20);
}

TEST(DetailLevels, HardEdgesDoNotKeepTrianglesNorLoseTheirNormals) {
    const StoredPart part = cube(16);
    const auto levels = detail_levels(part);
    // All that a cube needs; its faces' inner vertices cost nothing to leave out.
    EXPECT_LE(levels.front().indices.size(), 3u * 24);
    EXPECT_LE(farthest(part, levels.front().indices), 1);
    for (const DetailLevel& level : levels) {
        for (std::size_t i = 0; i < level.indices.size(); i += 3) {
            const Vec3 a = place(part, level.indices[i]);
            const Vec3 face = normalized(
                cross(place(part, level.indices[i + 1]) - a, place(part, level.indices[i + 2]) - a), {0, 0, 0});
            for (std::size_t k = i; k < i + 3; ++k) {
                const OctNormal& n = part.normals[level.indices[k]];
                EXPECT_NEAR(dot(face, Vec3{double(n[0]), double(n[1]), double(n[2])}), 127, 1);
            }
        }
    }
}

TEST(DetailLevels, WhatIsTooSmallIsLeftOut) {
    StoredPart part = cube(1);
    for (GridPoint& p : part.positions) {
        for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<std::uint16_t>(p[k] / 100);
    }
    const auto levels = detail_levels(part);
    EXPECT_FALSE(levels.front().indices.empty());
    EXPECT_TRUE(levels.back().indices.empty());
}

TEST(DetailLevels, OlderStoredFormsGetThemOnTheWayOut) {
    RawScene scene;
    const StoredPart part = ball(24);
    scene.meshes.push_back(
        {.name = "ball", .material = -1, .positions = {}, .normals = {}, .texture_coordinates = {}, .triangles = {}});
    for (std::uint32_t i = 0; i < part.positions.size(); ++i)
        scene.meshes[0].positions.push_back(to_vec3f(place(part, i) / half_extent));
    for (std::size_t i = 0; i < part.indices.size(); i += 3)
        scene.meshes[0].triangles.push_back({part.indices[i], part.indices[i + 1], part.indices[i + 2]});
    const auto stored = encode(scene);
    ASSERT_TRUE(stored) << stored.error().message();

    const auto document_of = [](const std::vector<std::uint8_t>& bytes) {
        const auto glb = split_glb(bytes);
        return nlohmann::json::parse(glb->json.begin(), glb->json.end());
    };
    nlohmann::json older = document_of(stored->bytes);
    const nlohmann::json levels = older["meshes"][0]["primitives"][0]["extras"]["embody"]["levels"];
    ASSERT_EQ(levels.size(), level_errors.size());
    older["asset"]["extras"]["embody"].erase("levels");
    older["meshes"][0]["primitives"][0].erase("extras");
    const auto sent = to_glb(join_glb(older, split_glb(stored->bytes)->binary));
    ASSERT_TRUE(sent);
    const nlohmann::json now = document_of(*sent);
    const nlohmann::json given = now["meshes"][0]["primitives"][0]["extras"]["embody"]["levels"];
    ASSERT_EQ(given.size(), levels.size());
    for (std::size_t k = 0; k < levels.size(); ++k) {
        EXPECT_EQ(given[k]["error"], levels[k]["error"]);
        const auto count = [&](const nlohmann::json& document, const nlohmann::json& level) {
            return document["accessors"][level["indices"].get<std::size_t>()]["count"];
        };
        EXPECT_EQ(count(now, given[k]), count(older, levels[k]));
    }
    // What has them stays as it is.
    EXPECT_EQ(*to_glb(*sent), *sent);
}

}  // namespace
}  // namespace embody::interchange
