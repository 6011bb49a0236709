// SPDX-License-Identifier: MIT
#include "scene/home/home_document.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scene/file/scene_file.h"
#include "scene/session/session.h"

namespace embody::scene {
namespace {

using interchange::HomePiece;
using interchange::SweethomeHome;

SweethomeHome flat() {
    SweethomeHome home;
    home.levels = {{"L0", "Ground", 0, 2.5, 0.12}, {"L1", "Upstairs", 2.62, 2.4, 0.12}};
    const std::array<interchange::HomePoint, 4> corners{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}};
    for (std::size_t i = 0; i < 4; ++i)
        home.walls.push_back({corners[i], corners[(i + 1) % 4], 2.5, 2.5, 0.1, std::nullopt, "L0"});
    home.rooms = {{"Room", {corners.begin(), corners.end()}, std::nullopt, "L0"}};
    HomePiece door{.name = "Door",
                   .id = "home#1",
                   .place = {2, 0},
                   .size = {0.9, 2.1, 0.1},
                   .door_or_window = true,
                   .movable = false,
                   .level = "L0"};
    HomePiece table{
        .name = "Table", .id = "home#2", .place = {1, 2}, .angle = 0.5, .size = {1, 0.7, 0.6}, .level = "L0"};
    HomePiece vase{.name = "Vase", .place = {1, 2}, .elevation = 0.7, .size = {0.1, 0.3, 0.1}, .level = "L0"};
    HomePiece lamp{.name = "Lamp", .place = {3, 2}, .elevation = 2, .size = {0.3, 0.3, 0.3}, .level = "L0"};
    home.pieces = {door, table, vase, lamp};
    return home;
}

const Entity& named(const Document& document, const std::string& name) {
    for (const Entity& entity : document.entities)
        if (entity.name == name) return entity;
    ADD_FAILURE() << "no " << name;
    return document.entities.front();
}

TEST(HomeDocument, IsAHomeWithCutAndMitredWallsThatCanBeOpened) {
    const HomeDocument made = document_of_home(flat(), "Flat", [](const std::string&) { return true; });
    const Document& document = made.document;
    EXPECT_EQ(document.levels.size(), 2U);
    const Entity& door = named(document, "Door");
    EXPECT_EQ(std::get<ModelReference>(door.geometry).key, key_of_home_model("home#1"));
    const auto& wall = std::get<physics::WallShape>(std::get<physics::ShapeDefinition>(document.entities[0].geometry));
    ASSERT_EQ(wall.openings.size(), 1U);
    EXPECT_EQ(wall.openings[0].owner, door.index);
    EXPECT_NEAR(wall.openings[0].offset, 1.55, 1e-9);
    EXPECT_NEAR(std::fabs(wall.start_cut[0]), 0.05, 1e-9);

    // What hangs is static, what stands on something is not.
    EXPECT_TRUE(named(document, "Lamp").attributes.contains("kind"));
    EXPECT_FALSE(named(document, "Vase").attributes.contains("kind"));

    const auto json = document_to_json(document);
    const auto read = document_from_json(json);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(document_to_json(read.value()), json);
}

// A roof of 4 m, 0.1 m thick, pitched by 30 degrees: 2.087 m high, its middle half of that over its elevation. A
// positive pitch of the file turns the far end (less Z) up, as Java 3D's rotX(-pitch) does.
TEST(HomeDocument, TiltedPiecesLieAsInTheHomeAndStay) {
    SweethomeHome home = flat();
    const double pitch = -std::numbers::pi / 6, height = 4 * 0.5 + 0.1 * std::cos(pitch);
    home.pieces = {{.name = "Roof",
                    .id = "home#1",
                    .place = {2, 1},
                    .elevation = 3,
                    .pitch = pitch,
                    .size = {1, 0.1, 4},
                    .height = height,
                    .level = "L0"}};
    for (const bool has_model : {true, false}) {
        const HomeDocument made = document_of_home(home, "Roof", [&](const std::string&) { return has_model; });
        const Entity& roof = named(made.document, "Roof");
        const Vec3 middle = has_model ? transform_point(roof.pose, Vec3{0, 0.05, 0}) : roof.pose.position;
        EXPECT_LT(distance(middle, {2, 3 + height / 2, 1}), 1e-9);
        const Vec3 along = rotate(roof.pose.rotation, {0, 0, 1});
        EXPECT_LT(distance(along, {0, -std::sin(pitch), std::cos(pitch)}), 1e-9);
        EXPECT_TRUE(roof.attributes.contains("kind"));
    }
}

// A cellar of 4 m by 3 m under a house of the same size: no ground reaches into it.
TEST(HomeDocument, TheGroundLeavesTheCellarFree) {
    SweethomeHome home = flat();
    home.levels.push_back({"L2", "Cellar", -2.62, 2.5, 0.12});
    home.rooms.push_back({"Cellar", {{0, 0}, {4, 0}, {4, 3}, {0, 3}}, std::nullopt, "L2"});
    const HomeDocument made = document_of_home(home, "House", [](const std::string&) { return false; });
    int grounds = 0;
    double area = 0;
    for (const Entity& entity : made.document.entities) {
        if (entity.category != "ground") continue;
        ++grounds;
        if (entity.pose.position.y < -2) {
            const double top = entity.pose.position.y + 0.25;
            EXPECT_NEAR(top, -2.62, 0.01) << "what stands in the cellar finds ground";
            continue;
        }
        const auto& box = std::get<physics::BoxShape>(std::get<physics::ShapeDefinition>(entity.geometry));
        const Vec3 half = box.half_extents, at = entity.pose.position;
        EXPECT_GT(std::min(half.x, half.z), 0.01);
        area += 4 * half.x * half.z;
        EXPECT_FALSE(std::fabs(at.x - 2) < half.x + 2 - 1e-9 && std::fabs(at.z - 1.5) < half.z + 1.5 - 1e-9);
    }
    EXPECT_EQ(grounds, 5);
    EXPECT_NEAR(area, 24.1 * 23.1 - 4 * 3, 1e-9);  // walls are 0.1 m thick
}

TEST(HomeDocument, OneWallBelowTheGroundIsACellarToo) {
    SweethomeHome home = flat();
    home.levels.push_back({"L2", "Terrace", -0.2, 2.5, 0.12});
    home.walls.push_back({{0, 0}, {0, 3}, 2.5, 2.5, 0.1, std::nullopt, "L2"});
    const HomeDocument made = document_of_home(home, "House", [](const std::string&) { return false; });
    EXPECT_TRUE(document_from_json(document_to_json(made.document)).ok());
}

TEST(HomeDocument, HasBoxesForModelsThatAreNotThereAndStaysAsItIsInARun) {
    const HomeDocument made = document_of_home(flat(), "Flat", [](const std::string&) { return false; });
    ASSERT_FALSE(made.notes.empty());
    auto session = Session::create(nullptr, {"/nonexistent/saved", "/nonexistent/demo"}).value();
    ASSERT_TRUE(session->execute("scene.load", {{"scene", document_to_json(made.document)}}).ok());
    ASSERT_TRUE(session->execute("simulation.step", {{"count", 120}}).ok());
    std::vector<EntityState> states;
    session->read_states(states);
    for (const EntityState& state : states) {
        const Vec3 start = made.document.find(state.entity)->pose.position;
        EXPECT_LT(distance(state.pose.position, start), 0.01) << made.document.find(state.entity)->name;
    }
}

}  // namespace
}  // namespace embody::scene
