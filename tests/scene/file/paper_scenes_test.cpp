// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>

#include "scene/file/scene_file.h"
#include "scenes/bench.h"
#include "scenes/generated_meshes.h"

namespace embody::scenes {
namespace {

class PaperScenes : public ::testing::TestWithParam<SceneBuilder> {};

TEST_P(PaperScenes, EndAsTheyMust) {
    const auto result = run_bench(GetParam(), 0);
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_TRUE(result->checked);
    EXPECT_EQ(result->wrong, "");
}

INSTANTIATE_TEST_SUITE_P(All, PaperScenes, ::testing::ValuesIn(scene_builders()),
                         [](const auto& scene) { return scene.param.name; });

TEST(PaperScenesList, HasDifferentNamesAndThePapersCounts) {
    std::set<std::string> names;
    for (const SceneBuilder& builder : scene_builders()) names.insert(builder.name);
    EXPECT_EQ(names.size(), scene_builders().size());
    ASSERT_NE(find_scene_builder("table1_f"), nullptr);
    EXPECT_EQ(find_scene_builder("no such scene"), nullptr);
    // A ground and 210 cubes; a ground, four walls and 343 primitives.
    EXPECT_EQ(find_scene_builder("table1_f")->build().entities.size(), 211u);
    EXPECT_EQ(find_scene_builder("table1_g")->build().entities.size(), 348u);
}

TEST(GeneratedMeshes, HaveThePapersNumberOfTriangles) {
    const physics::MeshShape dog = make_dog(1);
    EXPECT_EQ(dog.triangles.size(), 33854u);
    // The surface is closed: each edge occurs once in each direction.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : dog.triangles)
        for (const int i : {0, 1, 2})
            EXPECT_TRUE(
                edges.insert({t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>((i + 1) % 3)]}).second);
    for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
    const physics::HeightfieldShape terrain = make_terrain(1);
    EXPECT_EQ(2 * (terrain.columns - 1) * (terrain.rows - 1), 115200);
}

}  // namespace
}  // namespace embody::scenes
