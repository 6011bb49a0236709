// SPDX-License-Identifier: MIT
#include "scene/document/history.h"

#include <gtest/gtest.h>

namespace embody::scene {
namespace {

constexpr std::size_t megabyte = 1 << 20;

Edit moves(PersonId person, int count) {
    Edit edit;
    edit.person = person;
    for (int i = 0; i < count; ++i) edit.changes.emplace_back(PoseChange{static_cast<EntityIndex>(i + 1), {}, {}});
    return edit;
}

Edit arrival(PersonId person) {
    Entity entity;
    entity.index = 1;
    physics::MeshShape mesh;
    mesh.positions.resize(3000);
    entity.geometry = physics::ShapeDefinition{mesh};
    Edit edit;
    edit.person = person;
    edit.changes.emplace_back(EntityChange{std::nullopt, std::move(entity)});
    return edit;
}

// Most steps are moves; a heading, the largest state, is 40 times as large.
TEST(History, MovesOfEightPeopleTakeLittle) {
    History history;
    for (int i = 0; i < 8 * 1100; ++i) history.add(moves(static_cast<PersonId>(i % 8 + 1), 1));
    EXPECT_LT(history.bytes(), 2 * megabyte);
}

TEST(History, TheOldestStepsGoWhereAllTakeTooMuch) {
    History history(megabyte);
    for (int i = 0; i < 300; ++i) {
        Edit edit = i % 2 == 0 ? moves(1, 300) : arrival(2);
        edit.label = std::to_string(i);
        history.add(std::move(edit));
        ASSERT_LE(history.bytes(), megabyte);
        ASSERT_EQ(history.undoable(i % 2 == 0 ? 1 : 2)->label, std::to_string(i));
    }
    // What was undone counts, until something else is done.
    int undone = 0;
    for (; history.undoable(1); ++undone) history.move_back(1, history.undoable(1)->changes);
    EXPECT_GT(undone, 5);
    EXPECT_LT(undone, 100);
    const std::size_t before = history.bytes();
    history.add(moves(1, 1));
    EXPECT_LT(history.bytes(), before - 5 * bytes_of(PoseChange{}) * 300);
}

TEST(History, AKeptFormCountsWhereItComesAndGoesAlone) {
    Entity before, after;
    KeptForm form;
    form.places.values.resize(30'000);
    after.kept = form;
    const auto edit = [](const Entity& from, const Entity& to) {
        Edit made;
        made.person = 1;
        made.changes.emplace_back(change_of(from, to));
        return made;
    };
    History history;
    history.add(edit(before, after));
    const std::size_t once = history.bytes(), size = form.places.values.size() * sizeof(double);
    EXPECT_GT(once, size);
    for (int i = 0; i < 100; ++i) history.add(edit(after, after));
    EXPECT_LT(history.bytes(), once + 100 * 2000);
    history.add(edit(after, before));
    EXPECT_GT(history.bytes(), 2 * size);
}

TEST(History, AStepLargerThanAllMayTakeStays) {
    History history(megabyte);
    history.add(moves(1, 10));
    history.add(moves(2, 30000));
    EXPECT_GT(history.bytes(), megabyte);
    EXPECT_EQ(history.undoable(1), nullptr);
    EXPECT_EQ(history.undoable(2)->changes.size(), 30000U);
    history.add(moves(1, 10));
    EXPECT_LT(history.bytes(), megabyte);
}

TEST(History, EveryWayOutGivesBackTheBytes) {
    History history;
    for (int i = 0; i < 10; ++i) history.add(i % 2 == 0 ? moves(1, 5) : arrival(1));
    Edit drag = moves(1, 5);
    drag.merge = "drag";
    history.add(drag);
    const std::size_t once = history.bytes();
    history.add(drag);
    EXPECT_EQ(history.bytes(), once) << "a drag is one step";
    for (int i = 0; i < 4; ++i) history.move_back(1, history.undoable(1)->changes);
    history.move_forward(1, history.redoable(1)->changes);
    history.drop_redoable(1);
    EXPECT_LT(history.bytes(), once);
    history.forget(1);
    while (history.undoable(1)) history.drop_undoable(1);
    EXPECT_EQ(history.bytes(), 0U);
}

}  // namespace
}  // namespace embody::scene
