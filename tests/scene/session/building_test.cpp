// SPDX-License-Identifier: MIT
// Walls, rooms, doors and windows: how they fit each other, and what they hold in a run.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "geometry/flat_polygon.h"
#include "scene/session/session_fixture.h"

namespace embody::scene {
namespace {

using nlohmann::json;

class Building : public SessionTest {
protected:
    std::vector<EntityIndex> build(const json& params) { return run("room.add", params)["indices"]; }
    const Entity& entity(EntityIndex index) { return *session_->document().find(index); }
    physics::WallShape wall(EntityIndex index) {
        return std::get<physics::WallShape>(std::get<physics::ShapeDefinition>(entity(index).geometry));
    }
    EntityIndex add_ball(Vec3 at, double radius, Vec3 velocity = {}) {
        return run("entity.add", {{"entity",
                                   {{"shape", {{"type", "sphere"}, {"radius", radius}}},
                                    {"pose", {{"position", {at.x, at.y, at.z}}}},
                                    {"linear_velocity", {velocity.x, velocity.y, velocity.z}}}}})["index"];
    }
    // A door as a thing: a box of the category that stands in walls.
    EntityIndex add_door(Vec3 at, double width = 0.9, double height = 2, const char* category = "door") {
        return run("entity.add", {{"entity",
                                   {{"shape", {{"type", "box"}, {"half_extents", {width / 2, height / 2, 0.03}}}},
                                    {"category", category},
                                    {"attributes", {{"kind", "static"}}},
                                    {"pose", {{"position", {at.x, at.y + height / 2, at.z}}}}}}})["index"];
    }
    // Whether a point at knee height is in some wall, by what is seen of them from above.
    int walls_at(const std::vector<EntityIndex>& walls, double x, double z) {
        int in = 0;
        for (const EntityIndex index : walls) {
            const Vec3 p = inverse_transform_point(entity(index).pose, {x, 0.5, z});
            const geometry::FlatPolygon seen = wall(index).footprint();
            bool inside = false;
            for (std::size_t i = 0; i < seen.size(); ++i) {
                const auto a = seen[i], b = seen[(i + 1) % seen.size()];
                if ((a[1] > p.z) != (b[1] > p.z) && p.x < a[0] + (b[0] - a[0]) * (p.z - a[1]) / (b[1] - a[1]))
                    inside = !inside;
            }
            in += inside ? 1 : 0;
        }
        return in;
    }
};

TEST_F(Building, ARoomIsOneStepOfUndoAndReadsBack) {
    const json before = document();
    const auto indices = build({{"points", {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}}},
                                {"closed", true},
                                {"floor", true},
                                {"ceiling", true}});
    ASSERT_EQ(indices.size(), 6U);
    for (const EntityIndex index : indices) EXPECT_TRUE(entity(index).locked);
    const json built = document();
    const auto read = document_from_json(built);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(document_to_json(read.value()), built);
    run("edit.undo");
    EXPECT_EQ(document()["entities"], before["entities"]);
    run("edit.redo");
    EXPECT_EQ(document()["entities"], built["entities"]);
}

TEST_F(Building, CornersOfRoomsAreMitred) {
    const auto indices =
        build({{"points", {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}}}, {"closed", true}, {"thickness", 0.2}});
    for (const EntityIndex index : indices) {
        const physics::WallShape each = wall(index);
        for (const auto& cut : {each.start_cut, each.end_cut}) {
            EXPECT_NEAR(std::fabs(cut[0]), 0.1, 1e-12);
            EXPECT_NEAR(cut[0] + cut[1], 0, 1e-12);
        }
    }
}

// Around a point where two to six random walls meet there is neither a gap nor a place that two walls have.
TEST_F(Building, CornersOfRandomWallsHaveNoGap) {
    Random random(5);
    int solid = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const std::size_t count = 2 + random.below(5);
        const Vec3 node{trial * 30.0, 0, 0};
        std::vector<double> angles;
        for (std::size_t i = 0; i < count; ++i)
            angles.push_back(2 * std::numbers::pi * (static_cast<double>(i) + random.between(0.1, 0.6)) /
                             static_cast<double>(count));
        const double thickness = random.between(0.08, 0.3);
        std::vector<EntityIndex> walls;
        for (const double angle : angles) {
            Vec3 from = node, to = node + Vec3{5 * std::cos(angle), 0, 5 * std::sin(angle)};
            if (random.below(2) == 0) std::swap(from, to);
            walls.push_back(
                build({{"points", {{from.x, 0, from.z}, {to.x, 0, to.z}}}, {"thickness", thickness}}).front());
        }
        for (int k = 0; k < 300; ++k) {
            const double x = node.x + random.between(-0.5, 0.5), z = random.between(-0.5, 0.5);
            // Solid: nearer than half the thickness to some wall's middle line. At sharp corners walls are longer than
            // that.
            double nearest = 1e9;
            for (const double angle : angles) {
                const double along = std::max(0.0, (x - node.x) * std::cos(angle) + z * std::sin(angle));
                nearest =
                    std::min(nearest, std::hypot(x - node.x - along * std::cos(angle), z - along * std::sin(angle)));
            }
            const int in = walls_at(walls, x, z);
            const bool is_convex_side = count == 2 && nearest > 0.45 * thickness;
            if (nearest < thickness / 2 - 1e-3 && !is_convex_side) {
                EXPECT_EQ(in, 1) << "trial " << trial << " at " << x - node.x << " " << z;
                ++solid;
            }
            EXPECT_LE(in, 1) << "trial " << trial << " at " << x - node.x << " " << z;
        }
    }
    EXPECT_GT(solid, 3000);
}

TEST_F(Building, ACornerFollowsWhatIsAddedAndRemoved) {
    const EntityIndex first = build({{"points", {{0, 0, 0}, {4, 0, 0}}}}).front();
    EXPECT_EQ(wall(first).end_cut, (std::array{0.0, 0.0}));
    const EntityIndex second = build({{"points", {{4, 0, 0}, {4, 0, 3}}}}).front();
    EXPECT_NEAR(std::fabs(wall(first).end_cut[0]), 0.06, 1e-12);
    run("entity.lock", {{"indices", {second}}, {"locked", false}});
    run("entity.remove", {{"indices", {second}}});
    EXPECT_EQ(wall(first).end_cut, (std::array{0.0, 0.0}));
    run("edit.undo");
    EXPECT_NEAR(std::fabs(wall(first).end_cut[0]), 0.06, 1e-12);
}

TEST_F(Building, ABallRollsThroughADoorAndNotThroughTheWall) {
    const EntityIndex index = build({{"points", {{-3, 0, 0}, {3, 0, 0}}}}).front();
    json shape = document()["entities"].back()["shape"];
    shape["openings"] = {{{"kind", "door"}, {"offset", 2.5}, {"width", 1}, {"height", 2.1}}};
    run("entity.update", {{"index", index}, {"entity", {{"shape", shape}}}});
    const EntityIndex through = add_ball({0, 0.2, 1}, 0.2, {0, 0, -3}),
                      against = add_ball({-1.5, 0.2, 1}, 0.2, {0, 0, -3});
    run("simulation.step", {{"count", 120}});
    EXPECT_LT(where(through).z, -1);
    EXPECT_GT(where(against).z, 0.2);
}

TEST_F(Building, AWindowsPaneHoldsABallAndAHoleDoesNot) {
    const EntityIndex index = build({{"points", {{-3, 0, 0}, {3, 0, 0}}}}).front();
    json shape = document()["entities"].back()["shape"];
    shape["openings"] = {{{"kind", "window"}, {"offset", 1}, {"width", 1}, {"height", 1}, {"sill", 1}},
                         {{"kind", "hole"}, {"offset", 4}, {"width", 1}, {"height", 1}, {"sill", 1}}};
    run("entity.update", {{"index", index}, {"entity", {{"shape", shape}}}});
    const EntityIndex window = add_ball({-1.5, 1.6, 1}, 0.1, {0, 1, -5}),
                      hole = add_ball({1.5, 1.6, 1}, 0.1, {0, 1, -5});
    run("simulation.step", {{"count", 30}});
    EXPECT_GT(where(window).z, 0);
    EXPECT_LT(where(hole).z, -0.5);
}

TEST_F(Building, NothingFallsThroughARoomsFloor) {
    (void)build({{"points", {{0, 3, 0}, {4, 3, 0}, {4, 3, 3}, {2, 3, 3}, {2, 3, 5}, {0, 3, 5}}},
                 {"closed", true},
                 {"floor", true}});
    const EntityIndex book = run("entity.add", {{"entity",
                                                 {{"shape", {{"type", "box"}, {"half_extents", {0.1, 0.015, 0.15}}}},
                                                  {"pose", {{"position", {1, 4.5, 4}}}}}}})["index"];
    run("simulation.step", {{"count", 180}});
    EXPECT_NEAR(where(book).y, 3.005 + 0.015, 0.003);
}

TEST_F(Building, ADoorCutsTheWallThatItStandsInAndGoesOnCuttingItWhereItIsMoved) {
    const EntityIndex index = build({{"points", {{0, 0, 0}, {6, 0, 0}}}}).front();
    const EntityIndex door = add_door({2, 0, 0});
    ASSERT_EQ(wall(index).openings.size(), 1U);
    EXPECT_EQ(wall(index).openings[0].owner, door);
    EXPECT_NEAR(wall(index).openings[0].offset, 2 - 0.45, 1e-9);
    EXPECT_NEAR(wall(index).openings[0].height, 2, 1e-9);
    const json with_door = document();

    run("entity.transform", {{"poses", {{{"index", door}, {"position", {4, 1, 0}}}}}});
    EXPECT_NEAR(wall(index).openings.at(0).offset, 4 - 0.45, 1e-9);
    run("edit.undo");
    EXPECT_EQ(document()["entities"], with_door["entities"]);

    run("entity.transform", {{"poses", {{{"index", door}, {"position", {4, 1, 2}}}}}});
    EXPECT_TRUE(wall(index).openings.empty());
    run("entity.transform", {{"poses", {{{"index", door}, {"position", {1, 1, 0}}}}}});
    run("entity.remove", {{"indices", {door}}});
    EXPECT_TRUE(wall(index).openings.empty());
}

TEST_F(Building, ADoorGoesWithItsWallAndACopiedWallHasACopiedDoor) {
    const EntityIndex index = build({{"points", {{0, 0, 0}, {6, 0, 0}}}}).front();
    const EntityIndex door = add_door({2, 0, 0});
    run("entity.lock", {{"indices", {index}}, {"locked", false}});
    run("entity.transform", {{"poses", {{{"index", index}, {"position", {0, 0, 5}}}}}});
    EXPECT_NEAR(entity(door).pose.position.z, 5, 1e-9);
    ASSERT_EQ(wall(index).openings.size(), 1U);

    const std::vector<EntityIndex> copies =
        run("entity.duplicate", {{"indices", {index, door}}, {"offset", {0, 0, 3}}})["indices"];
    ASSERT_EQ(wall(copies[0]).openings.size(), 1U);
    EXPECT_EQ(wall(copies[0]).openings[0].owner, copies[1]);
}

TEST_F(Building, APointerPutsADoorIntoTheWallAndAWindowAtItsHeight) {
    const EntityIndex index = build({{"points", {{0, 0, 0}, {6, 0, 0}}}}).front();
    const auto drop = [&](const char* category, double height) {
        const json entity = {{"shape", {{"type", "box"}, {"half_extents", {0.4, 0.5, 0.05}}}},
                             {"category", category},
                             {"attributes", {{"kind", "static"}}}};
        return run("entity.add",
                   {{"entity", entity}, {"drop", {{"origin", {3, height, 4}}, {"direction", {0, 0, -1}}}}})["index"]
            .get<EntityIndex>();
    };
    const EntityIndex door = drop("door", 1.7);
    EXPECT_NEAR(entity(door).pose.position.x, 3, 1e-9);
    EXPECT_NEAR(entity(door).pose.position.y, 0.5, 1e-9);
    EXPECT_NEAR(entity(door).pose.position.z, 0, 1e-9);
    ASSERT_EQ(wall(index).openings.size(), 1U);
    EXPECT_EQ(wall(index).openings[0].owner, door);
    // A drag of it: the pointer is over its own hole.
    run("entity.drag", {{"indices", {door}}, {"drop", {{"origin", {5, 0.5, 4}}, {"direction", {0, 0, -1}}}}});
    EXPECT_NEAR(wall(index).openings.at(0).offset, 5 - 0.4, 1e-9);
    const EntityIndex window = drop("window", 1.7);
    EXPECT_NEAR(entity(window).pose.position.y, 1.7, 1e-9);
    EXPECT_EQ(wall(index).openings.size(), 2U);
}

TEST_F(Building, ALockKeepsAWallsSizeAndNotItsOpenings) {
    const EntityIndex index = build({{"points", {{0, 0, 0}, {6, 0, 0}}}}).front();
    json shape = document()["entities"].back()["shape"];
    shape["length"] = 5;
    EXPECT_NE(error_of("entity.update", {{"index", index}, {"entity", {{"shape", shape}}}}).find("is locked"),
              std::string::npos);
    shape["length"] = 6;
    shape["openings"] = {{{"kind", "hole"}, {"offset", 1}, {"width", 1}, {"height", 1}}};
    EXPECT_EQ(error_of("entity.update", {{"index", index}, {"entity", {{"shape", shape}}}}), "accepted");
}

TEST_F(Building, RefusesByFieldWhatCannotBeBuilt) {
    const auto refused = [&](const json& params) { return error_of("room.add", params); };
    EXPECT_NE(refused({{"points", {{0, 0, 0}}}}).find("points"), std::string::npos);
    EXPECT_NE(refused({{"points", {{0, 0, 0}, {0, 0, 0}}}}).find("points[1]"), std::string::npos);
    EXPECT_NE(refused({{"points", {{0, 0, 0}, {1, 1, 0}}}}).find("points[1][1]"), std::string::npos);
    EXPECT_NE(refused({{"points", {{0, 0, 0}, {1, 0, 0}}}, {"floor", true}}).find("floor"), std::string::npos);
    EXPECT_NE(refused({{"points", {{0, 0, 0}, {2, 0, 2}, {2, 0, 0}, {0, 0, 2}}}, {"closed", true}, {"floor", true}})
                  .find("meet"),
              std::string::npos);
    EXPECT_NE(refused({{"points", {{0, 0, 0}, {1, 0, 0}}}, {"height", -1}}).find("height"), std::string::npos);
}

TEST_F(Building, LevelsAreOneStepOfUndo) {
    run("scene.settings", {{"levels",
                            {{{"name", "Ground"}, {"elevation", 0}, {"height", 2.6}},
                             {{"name", "First"}, {"elevation", 2.8}, {"height", 2.4}}}}});
    EXPECT_EQ(document()["levels"][1]["name"], "First");
    run("edit.undo");
    EXPECT_FALSE(document().contains("levels"));
}

}  // namespace
}  // namespace embody::scene
