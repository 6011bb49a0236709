// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/session/groups.h"
#include "scene/session/session.h"

namespace embody::scene {
namespace {

using nlohmann::json;

json vector(Vec3 v) { return {v.x, v.y, v.z}; }

/// A session with random boxes, some of them in groups.
class Arrange : public testing::Test {
protected:
    Arrange() { renew(); }
    void renew() { session_ = Session::create(nullptr, {"/nonexistent/saved", "/nonexistent/demo"}).value(); }
    json run(const std::string& command, const json& params = json::object()) {
        auto result = session_->execute(command, params);
        if (!result.ok()) {
            ADD_FAILURE() << command << " " << params.dump() << ": " << result.error().message();
            return {};
        }
        return result.value();
    }
    std::string error_of(const std::string& command, const json& params) {
        const auto result = session_->execute(command, params);
        return result.ok() ? "accepted" : result.error().message();
    }
    EntityIndex add_box(Random& random) {
        const Vec3 half{random.between(0.1, 0.5), random.between(0.1, 0.5), random.between(0.1, 0.5)};
        const Vec3 at{random.between(-5, 5), random.between(1, 5), random.between(-5, 5)};
        const Quat turn = normalized(Quat{random.unit(), random.unit(), random.unit(), random.unit()});
        return run("entity.add",
                   {{"entity",
                     {{"shape", {{"type", "box"}, {"half_extents", vector(half)}}},
                      {"pose", {{"position", vector(at)}, {"rotation", {turn.x, turn.y, turn.z, turn.w}}}}}}})["index"];
    }
    std::vector<EntityIndex> add_boxes(Random& random, int count) {
        std::vector<EntityIndex> boxes;
        for (int i = 0; i < count; ++i) boxes.push_back(add_box(random));
        return boxes;
    }
    const Entity& entity(EntityIndex index) { return *session_->document().find(index); }
    json document() { return document_to_json(session_->document()); }
    Bounds bounds(EntityIndex index) {
        const Entity& its = entity(index);
        const Vec3 half = std::get<physics::BoxShape>(std::get<physics::ShapeDefinition>(its.geometry)).half_extents;
        return transformed(its.pose, {-half, half});
    }

    std::unique_ptr<Session> session_;
};

TEST_F(Arrange, AlignedThingsHaveTheSameBounds) {
    Random random(3);
    for (int run_number = 0; run_number < 20; ++run_number) {
        renew();
        const auto boxes = add_boxes(random, 2 + static_cast<int>(random.below(6)));
        const int axis = static_cast<int>(random.below(3));
        const char* at = run_number % 3 == 0 ? "low" : run_number % 3 == 1 ? "center" : "high";
        const json before = document();
        Bounds all;
        for (const EntityIndex box : boxes) all.add(bounds(box));
        const char* axes[] = {"x", "y", "z"};
        run("entity.align", {{"indices", boxes}, {"axis", axes[axis]}, {"at", at}});
        for (const EntityIndex box : boxes) {
            const Bounds now = bounds(box);
            const double place = run_number % 3 == 0   ? now.lower[axis] - all.lower[axis]
                                 : run_number % 3 == 1 ? now.center()[axis] - all.center()[axis]
                                                       : now.upper[axis] - all.upper[axis];
            EXPECT_NEAR(place, 0, 1e-9);
        }
        run("edit.undo");
        EXPECT_EQ(document(), before);
    }
}

TEST_F(Arrange, DistributedThingsHaveTheSameGaps) {
    Random random(4);
    for (int run_number = 0; run_number < 20; ++run_number) {
        renew();
        const auto boxes = add_boxes(random, 3 + static_cast<int>(random.below(6)));
        run("entity.distribute", {{"indices", boxes}, {"axis", "x"}});
        std::vector<Bounds> row;
        for (const EntityIndex box : boxes) row.push_back(bounds(box));
        std::sort(row.begin(), row.end(), [](const Bounds& a, const Bounds& b) { return a.center().x < b.center().x; });
        const double gap = row[1].lower.x - row[0].upper.x;
        for (std::size_t i = 1; i < row.size(); ++i) EXPECT_NEAR(row[i].lower.x - row[i - 1].upper.x, gap, 1e-9);
    }
    EXPECT_NE(error_of("entity.distribute", {{"indices", {2, 3}}, {"axis", "x"}}).find("at least three"),
              std::string::npos);
}

TEST_F(Arrange, AMirrorOfAMirrorIsTheFirstPicture) {
    Random random(5);
    const auto boxes = add_boxes(random, 5);
    for (const char* axis : {"x", "y", "z"}) {
        std::vector<Transform> before;
        for (const EntityIndex box : boxes) before.push_back(entity(box).pose);
        run("entity.mirror", {{"indices", boxes}, {"axis", axis}});
        run("entity.mirror", {{"indices", boxes}, {"axis", axis}});
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            EXPECT_LT(length(entity(boxes[i]).pose.position - before[i].position), 1e-9);
            const Vec3 x = rotate(entity(boxes[i]).pose.rotation, Vec3{1, 2, 3});
            EXPECT_LT(length(x - rotate(before[i].rotation, Vec3{1, 2, 3})), 1e-9);
        }
    }
}

TEST_F(Arrange, TurnsInARowAreOneStepAndEndWhereTheyBegan) {
    Random random(6);
    const auto boxes = add_boxes(random, 4);
    const json before = document();
    const Vec3 first = entity(boxes[0]).pose.position;
    for (int i = 0; i < 24; ++i)
        run("entity.turn", {{"indices", {boxes[0]}}, {"angle", 15 * 3.14159265358979323846 / 180}, {"merge", "t"}});
    EXPECT_LT(length(entity(boxes[0]).pose.position - first), 1e-9);
    run("edit.undo");
    EXPECT_EQ(document(), before);
}

TEST_F(Arrange, AnArrayIsAGridOfCopies) {
    Random random(7);
    const EntityIndex box = add_box(random);
    const json made = run("entity.array", {{"indices", {box}}, {"counts", {3, 2, 2}}, {"spacing", {1, 2, 3}}});
    ASSERT_EQ(made["indices"].size(), 11u);
    std::vector<Vec3> places{entity(box).pose.position};
    for (const json& index : made["indices"]) places.push_back(entity(index).pose.position);
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 2; ++y)
            for (int z = 0; z < 2; ++z) {
                const Vec3 wanted = places[0] + Vec3{1.0 * x, 2.0 * y, 3.0 * z};
                EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                                        [&](Vec3 place) { return length(place - wanted) < 1e-12; }));
            }
    EXPECT_NE(error_of("entity.array", {{"indices", {box}}, {"counts", {1000, 1000, 1}}}).find("10000"),
              std::string::npos);
}

TEST_F(Arrange, GroupsNestMoveAndDissolve) {
    Random random(8);
    const auto boxes = add_boxes(random, 4);
    const json before = document();
    EXPECT_EQ(run("entity.group", {{"indices", {boxes[0], boxes[1]}}, {"name", "Chairs"}})["group"], "Chairs");
    EXPECT_EQ(run("entity.group", {{"indices", {boxes[0], boxes[1], boxes[2]}}, {"name", "Dining"}})["group"],
              "Dining");
    EXPECT_EQ(entity(boxes[0]).group, "Dining/Chairs");
    EXPECT_EQ(entity(boxes[2]).group, "Dining");
    // Within the innermost group that both are in, under a name that is free there.
    EXPECT_EQ(run("entity.group", {{"indices", {boxes[0]}}, {"name", "Chairs"}})["group"], "Dining/Chairs/Chairs");
    run("edit.undo");
    run("entity.set_group", {{"indices", {boxes[0], boxes[1]}}, {"from", "Dining/Chairs"}, {"group", "Seats"}});
    EXPECT_EQ(entity(boxes[1]).group, "Seats");
    run("entity.set_group", {{"indices", {boxes[3]}}, {"group", "Seats"}});
    EXPECT_EQ(run("entity.ungroup", {{"group", "Seats"}})["indices"].size(), 3u);
    EXPECT_EQ(entity(boxes[3]).group, "");
    EXPECT_NE(error_of("entity.ungroup", {{"group", "Seats"}}).find("there is no group"), std::string::npos);
    EXPECT_NE(error_of("entity.set_group", {{"indices", {boxes[3]}}, {"group", "a//b"}}).find("no path"),
              std::string::npos);
    while (!run("edit.undo")["undone"].is_null() && document() != before) {
    }
    EXPECT_EQ(document(), before);
}

TEST_F(Arrange, AlignsGroupsAsOne) {
    Random random(9);
    const auto boxes = add_boxes(random, 4);
    run("entity.group", {{"indices", {boxes[0], boxes[1]}}});
    const Vec3 apart = entity(boxes[1]).pose.position - entity(boxes[0]).pose.position;
    run("entity.align", {{"indices", boxes}, {"axis", "z"}, {"at", "low"}});
    EXPECT_LT(length(entity(boxes[1]).pose.position - entity(boxes[0]).pose.position - apart), 1e-9);
    EXPECT_NEAR(std::min(bounds(boxes[0]).lower.z, bounds(boxes[1]).lower.z), bounds(boxes[2]).lower.z, 1e-9);
}

// What is between the copied things comes along, also into another scene.
TEST_F(Arrange, PastesJointsPinsActionsAndGroups) {
    Random random(10);
    const auto boxes = add_boxes(random, 3);
    run("entity.group", {{"indices", {boxes[0], boxes[1]}}, {"name", "Pair"}});
    run("joint.add", {{"type", "ball"}, {"entity_a", boxes[0]}, {"entity_b", boxes[1]}, {"anchor", {0, 2, 0}}});
    run("joint.add", {{"type", "ball"}, {"entity_a", boxes[0]}, {"entity_b", boxes[2]}, {"anchor", {0, 2, 0}}});
    run("action.add", {{"trigger", {{"type", "time"}, {"time", 1}}},
                       {"receiver", {{"index", boxes[1]}}},
                       {"effect", {{"type", "remove"}}}});
    run("action.add", {{"trigger", {{"type", "time"}, {"time", 1}}}, {"effect", {{"type", "pause"}}}});
    const json part = run("entity.copy", {{"indices", {boxes[0], boxes[1]}}})["part"];
    EXPECT_EQ(part["entities"].size(), 2u);
    EXPECT_EQ(part["joints"].size(), 1u) << "the other joint's end was not copied";
    EXPECT_EQ(part["actions"].size(), 1u) << "the other action is the scene's";

    const auto check = [&](std::size_t joints, std::size_t actions, const std::string& group) {
        const std::vector<EntityIndex> made = run("entity.paste", {{"part", part}, {"offset", {0, 0, 9}}})["indices"];
        ASSERT_EQ(made.size(), 2u);
        const Document& scene = session_->document();
        ASSERT_EQ(scene.joints.size(), joints);
        EXPECT_EQ(scene.joints.back().entity_a, made[0]);
        EXPECT_EQ(scene.joints.back().entity_b, made[1]);
        ASSERT_EQ(scene.actions.size(), actions);
        EXPECT_EQ(scene.actions.back().receiver.index, made[1]);
        EXPECT_EQ(scene.find(made[0])->group, group);
    };
    check(3, 3, "Pair 2");
    const json pasted = document();
    run("edit.undo");
    run("edit.redo");
    EXPECT_EQ(document(), pasted);
    renew();
    check(1, 1, "Pair");
    EXPECT_NE(error_of("entity.paste", {{"part", {{"embody_scene", 1}}}}).find("no entity"), std::string::npos);
}

TEST_F(Arrange, PastesInPlaceOrBeside) {
    Random random(12);
    const EntityIndex box = add_box(random);
    const json part = run("entity.copy", {{"indices", {box}}})["part"];
    const EntityIndex beside = run("entity.paste", {{"part", part}})["indices"][0];
    EXPECT_GT(bounds(beside).lower.x, bounds(box).upper.x);
    run("entity.remove", {{"indices", {box, beside}}});
    const Vec3 was{part["entities"][0]["pose"]["position"][0], part["entities"][0]["pose"]["position"][1],
                   part["entities"][0]["pose"]["position"][2]};
    EXPECT_LT(length(entity(run("entity.paste", {{"part", part}})["indices"][0]).pose.position - was), 1e-12);
}

TEST(Groups, ArePaths) {
    EXPECT_EQ(common_group("A/B/C", "A/B/D"), "A/B");
    EXPECT_EQ(common_group("A/B", "A/BC"), "A");
    EXPECT_EQ(common_group("A", "B"), "");
    EXPECT_EQ(moved_group("A/B/C", "A", "X/Y"), "X/Y/B/C");
    EXPECT_EQ(moved_group("A", "A", ""), "");
    EXPECT_EQ(parent_group("A/B"), "A");
    EXPECT_EQ(outermost_group("A/B"), "A");
    EXPECT_TRUE(is_in_group("A/B", "A"));
    EXPECT_FALSE(is_in_group("AB", "A"));
}

}  // namespace
}  // namespace embody::scene
