// SPDX-License-Identifier: MIT
#include "scene/session/placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/session/session.h"

namespace embody::scene {
namespace {

using nlohmann::json;

json vector(Vec3 v) { return {v.x, v.y, v.z}; }

/// A room of 8 x 3 x 8 m, its floor at height 0 and its middle at x = z = 0, with what a test puts in.
class Room : public testing::Test {
protected:
    Room() {
        session_ = Session::create(nullptr, {"/nonexistent/saved", "/nonexistent/demo"}).value();
        wall({-4.1, 1.5, 0}, {0.1, 1.5, 4});
        wall({4.1, 1.5, 0}, {0.1, 1.5, 4});
        back_wall_ = wall({0, 1.5, -4.1}, {4, 1.5, 0.1});
        wall({0, 3.1, 0}, {4.2, 0.1, 4.2});
    }
    json run(const std::string& command, const json& params = json::object()) {
        auto result = session_->execute(command, params);
        if (!result.ok()) {
            ADD_FAILURE() << command << " " << params.dump() << ": " << result.error().message();
            return {};
        }
        return result.value();
    }
    static json box(Vec3 size, const std::string& category = "", const std::string& place = "") {
        json entity = {{"shape", {{"type", "box"}, {"half_extents", vector(size * 0.5)}}}};
        if (!category.empty()) entity["category"] = category;
        if (!place.empty()) entity["attributes"]["placement"] = place;
        return entity;
    }
    EntityIndex wall(Vec3 at, Vec3 half) {
        json entity = box(half * 2);
        entity["attributes"]["kind"] = "static";
        entity["pose"]["position"] = vector(at);
        return run("entity.add", {{"entity", entity}})["index"];
    }
    static json ray(Vec3 from, Vec3 to, bool snap = true) {
        return {{"origin", vector(from)}, {"direction", vector(to - from)}, {"snap", snap}};
    }
    EntityIndex put(const json& entity, const json& drop) {
        return run("entity.add", {{"entity", entity}, {"drop", drop}})["index"];
    }
    const Entity& entity(EntityIndex index) { return *session_->document().find(index); }
    Transform pose(EntityIndex index) { return entity(index).pose; }
    json document() { return document_to_json(session_->document()); }
    Vec3 facing(EntityIndex index) { return rotate(pose(index).rotation, Vec3{0, 0, 1}); }
    /// Half extents of the box, along the world's axes.
    Vec3 reach(const Entity& entity) {
        const Vec3 half = std::get<physics::BoxShape>(std::get<physics::ShapeDefinition>(entity.geometry)).half_extents;
        const Mat3 r = to_matrix(entity.pose.rotation);
        return abs(r.x) * half.x + abs(r.y) * half.y + abs(r.z) * half.z;
    }
    /// How deep the bounds of two boxes are in each other; exact for boxes along the axes.
    double depth(const Entity& a, const Entity& b) {
        const Vec3 both = reach(a) + reach(b), apart = abs(a.pose.position - b.pose.position);
        return std::min({both.x - apart.x, both.y - apart.y, both.z - apart.z});
    }

    std::unique_ptr<Session> session_;
    EntityIndex back_wall_ = 0;
    const Vec3 eye_{0, 1.7, 3.5};
};

TEST_F(Room, AThingDroppedAtAWallFallsToTheFloorHoweverFarAndTouchesTheWall) {
    for (const double height : {0.3, 1.0, 2.0, 2.9}) {
        const EntityIndex index = put(box({0.4, 0.5, 0.3}), ray({1, height, 3}, {1, height, -4}));
        EXPECT_NEAR(pose(index).position.y, 0.25, 3 * clearance) << "dropped at " << height;
        EXPECT_NEAR(pose(index).position.z, -4 + 0.15, 3 * clearance) << "dropped at " << height;
        run("edit.undo");
    }
}

TEST_F(Room, AThingAtAWallStandsOnWhatIsThereAlready) {
    const EntityIndex cupboard = put(box({1, 0.9, 0.5}, "cabinet"), ray(eye_, {1, 0, -3.9}));
    const EntityIndex box_on_it = put(box({0.3, 0.3, 0.3}), ray({1, 2, 3}, {1, 2, -4}));
    EXPECT_NEAR(pose(cupboard).position.y, 0.45, 1e-3);
    EXPECT_NEAR(pose(box_on_it).position.y, 0.9 + 0.15, 1e-3);
}

TEST_F(Room, BoxesDroppedAtASideMakeAStack) {
    const json cube = box({0.5, 0.5, 0.5});
    put(cube, ray(eye_, {0, 0, 0}));
    for (int i = 1; i < 5; ++i) {
        const EntityIndex index = put(cube, ray({0.1, 0.25, 3}, {0.1, 0.25, 0}));
        EXPECT_NEAR(pose(index).position.y, 0.25 + 0.5 * i, 1e-3);
        EXPECT_NEAR(pose(index).position.x, 0, 1e-3);
    }
}

TEST_F(Room, WallThingsHangWhereTheRayMeetsTheWallAndStay) {
    const json clock = box({0.3, 0.3, 0.05}, "clock", "wall");
    const EntityIndex back = put(clock, ray(eye_, {1, 1.8, -4}));
    EXPECT_NEAR(pose(back).position.x, 1, 1e-3);
    EXPECT_NEAR(pose(back).position.y, 1.8, 1e-3);
    EXPECT_NEAR(pose(back).position.z, -4 + 0.025, 2 * clearance);
    EXPECT_NEAR(facing(back).z, 1, 1e-9);
    const EntityIndex left = put(clock, ray(eye_, {-4, 1.5, 0}));
    EXPECT_NEAR(facing(left).x, 1, 1e-9) << "it is turned to the room";
    EXPECT_NEAR(pose(left).position.x, -4 + 0.025, 2 * clearance);

    const Transform before = pose(left);
    run("simulation.step", {{"count", 180}});
    run("simulation.keep");
    EXPECT_LT(length(pose(left).position - before.position), 1e-9);
    run("simulation.reset");

    // On the floor: at the wall within reach, else on the floor, where it can move again.
    const EntityIndex near = put(clock, ray(eye_, {1, 0, -3.5}));
    EXPECT_NEAR(pose(near).position.z, -4 + 0.025, 2 * clearance);
    run("entity.drag", {{"indices", {near}}, {"drop", ray(eye_, {0, 0, 0})}});
    EXPECT_NEAR(pose(near).position.y, 0.15, 1e-3);
    EXPECT_FALSE(entity(near).attributes.contains("kind"));
    run("entity.drag", {{"indices", {near}}, {"drop", ray(eye_, {1, 1, -4})}});
    EXPECT_TRUE(entity(near).attributes.contains("kind"));
}

TEST_F(Room, CeilingThingsHangFromTheCeilingAboveThePlace) {
    const json lamp = box({0.4, 0.3, 0.4}, "lamp", "ceiling");
    for (const Vec3 at : {Vec3{1, 0, 1}, Vec3{1, 3, 1}}) {
        const EntityIndex index = put(lamp, ray({1, 1.5, 3}, at));
        EXPECT_NEAR(pose(index).position.y, 3 - 0.15, 2 * clearance);
        EXPECT_NEAR(pose(index).position.x, 1, 1e-3);
        run("edit.undo");
    }
}

TEST_F(Room, FurnitureNearAWallTurnsItsBackToItAndClosesGapsToNeighbours) {
    const json sofa = box({2, 0.8, 0.9}, "sofa");
    const EntityIndex first = put(sofa, ray(eye_, {-1, 0, -3.4}));
    EXPECT_NEAR(pose(first).position.z, -4 + 0.45, 3 * clearance);
    EXPECT_NEAR(facing(first).z, 1, 1e-9);
    const EntityIndex second = put(sofa, ray(eye_, {1.05, 0, -3.4}));
    EXPECT_NEAR(pose(second).position.x - pose(first).position.x, 2, 3 * clearance) << "the gap of 5 cm is closed";
    const EntityIndex side = put(box({1, 2, 0.6}, "wardrobe"), ray(eye_, {-3.6, 0, 1}));
    EXPECT_NEAR(facing(side).x, 1, 1e-9);
    EXPECT_NEAR(pose(side).position.x, -4 + 0.3, 3 * clearance);
    // Not in the middle of the room, and not without snapping.
    EXPECT_NEAR(facing(put(sofa, ray(eye_, {0, 0, 1}))).z, 1, 1e-9);
    const EntityIndex loose = put(box({0.5, 1, 0.4}, "shelf"), ray(eye_, {3.65, 0, 2}, false));
    EXPECT_NEAR(facing(loose).z, 1, 1e-9);
    EXPECT_NEAR(pose(loose).position.x, 3.65, 1e-6);
}

TEST_F(Room, ChairsPassTablesAndLaptopsStandOnThem) {
    const EntityIndex table = put(box({1.6, 0.75, 0.8}, "table"), ray(eye_, {0, 0, 0}));
    const EntityIndex laptop = put(box({0.35, 0.03, 0.25}, "computer", "table"), ray(eye_, {2, 0, 1}));
    EXPECT_NEAR(pose(laptop).position.y, 0.015, 1e-3);
    const json dragged = run("entity.drag", {{"indices", {laptop}}, {"drop", ray(eye_, {0.1, 0.75, 0})}});
    EXPECT_EQ(dragged["on"], table);
    EXPECT_NEAR(pose(laptop).position.y, 0.75 + 0.015, 1e-3);
    const EntityIndex chair = put(box({0.5, 0.9, 0.5}, "chair"), ray({0, 1.7, 2.5}, {0, 0.75, -0.3}));
    EXPECT_NEAR(pose(chair).position.y, 0.45, 1e-3) << "behind the table, not on it";
    EXPECT_LT(depth(entity(chair), entity(table)), 1e-6);
}

// Random rooms: what a preview shows is where it is added, and nothing ends in something else.
TEST_F(Room, APreviewIsThePlaceOfTheDropAndNoDropEndsInAnother) {
    const char* categories[] = {"", "sofa", "chair", "cabinet", "computer", "clock"};
    const char* places[] = {"floor", "floor", "floor", "floor", "table", "wall"};
    Random random(7);
    int deep = 0;
    for (int i = 0; i < 150; ++i) {
        const auto kind = random.below(6);
        const json thing = box({random.between(0.1, 0.9), random.between(0.1, 0.9), random.between(0.05, 0.6)},
                               categories[kind], places[kind]);
        const Vec3 at{random.between(-3.8, 3.8), random.between(0, 2.8), random.between(-3.8, 2.8)};
        const json drop = ray(eye_, at, random.below(4) != 0);
        const json seen = run("entity.preview", {{"entity", thing}, {"drop", drop}});
        const EntityIndex index = put(thing, drop);
        EXPECT_EQ(document()["entities"].back()["pose"], seen["pose"]) << "drop " << i;
        for (const Entity& other : session_->document().entities)
            if (other.index != index && depth(entity(index), other) > 1e-6) ++deep;
    }
    EXPECT_EQ(deep, 0);
}

// A drag over a random path: one step of undo, everything else stays, and the end is that of a single drop.
TEST_F(Room, ADragIsOneStepAndMovesNothingElse) {
    Random random(11);
    std::vector<EntityIndex> things;
    for (int i = 0; i < 12; ++i)
        things.push_back(put(box({0.4, random.between(0.2, 0.8), 0.3}),
                             ray(eye_, {random.between(-3, 3), 0, random.between(-3, 2)})));
    const json before = document();
    const std::vector<EntityIndex> dragged{things[3], things[5]};
    const Vec3 offset = pose(things[5]).position - pose(things[3]).position;
    for (int i = 0; i < 40; ++i)
        run("entity.drag", {{"indices", dragged},
                            {"merge", "drag 1"},
                            {"drop", ray(eye_, {random.between(-3, 3), 0, random.between(-3, 2)})}});
    const json after = document();
    for (std::size_t i = 0; i < things.size(); ++i)
        if (i != 3 && i != 5) EXPECT_EQ(after["entities"][5 + i], before["entities"][5 + i]);
    const Vec3 now = pose(things[5]).position - pose(things[3]).position;
    EXPECT_LT(length(now - offset), 1e-9) << "they keep their formation";
    run("edit.undo");
    EXPECT_EQ(document(), before);
    run("edit.redo");
    EXPECT_EQ(document(), after);
}

TEST_F(Room, ADragBeginsWhereTheThingIs) {
    const EntityIndex index = put(box({0.4, 0.5, 0.3}), ray(eye_, {1, 0, 0.5}));
    const json now = run("entity.preview", {{"index", index}});
    const json point = now["point"];
    const json moved = run("entity.drag", {{"indices", {index}}, {"drop", ray(eye_, {point[0], point[1], point[2]})}});
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(moved["pose"]["position"][axis].get<double>(), now["pose"]["position"][axis].get<double>(), 3e-4);
}

}  // namespace
}  // namespace embody::scene
