// SPDX-License-Identifier: MIT
#include "scene/simulation/take.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;

/// What was shown at a moment, read from the simulation itself.
struct Shown {
    double time = 0;
    std::map<EntityIndex, EntityMotion> motions;
    std::map<EntityIndex, std::vector<Vec3>> points;
};

Shown shown_by(const Simulation& simulation) {
    Shown shown{simulation.world().last_report().time, {}, {}};
    simulation.visit([&](const EntityMotion& motion) {
        shown.motions[motion.entity] = motion;
        if (motion.points) motion.points->read(shown.points[motion.entity]);
    });
    return shown;
}

/// A floor and some things that fall on it; `with_points` also grains, a liquid and a soft thing.
Document random_scene(Random& random, bool with_points) {
    using namespace embody::physics;
    Document document;
    samples::add(document, "Floor", BoxShape{{10, 0.5, 10}}, {0, -0.5, 0}).attributes["kind"] =
        to_value(PhysicalKind::static_body);
    const auto place = [&] { return Vec3{random.between(-2, 2), random.between(0.4, 3), random.between(-2, 2)}; };
    for (std::uint64_t i = 0, count = 2 + random.below(12); i < count; ++i) {
        const double size = random.between(0.05, 0.4);
        Entity& thing = i % 2 == 0 ? samples::add(document, "Ball", SphereShape{size}, place())
                                   : samples::add(document, "Box", BoxShape{{size, size / 2, size}}, place());
        thing.linear_velocity = {random.between(-2, 2), random.between(-1, 4), random.between(-2, 2)};
        thing.angular_velocity = {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
    }
    if (!with_points) return document;
    for (const PhysicalKind kind : {PhysicalKind::granular, PhysicalKind::fluid, PhysicalKind::soft})
        samples::add(document, "Points", BoxShape{{0.08, 0.08, 0.08}}, place() + Vec3{0, 3, 0}).attributes = {
            {"kind", to_value(kind)}, {"grain_budget", 100.0}, {"particle_budget", 400.0}};
    return document;
}

/// Boxes that fall from up to 200 m and turn.
Document falling_boxes(int count) {
    Random random(3);
    Document document = samples::floor_and_box(30);
    for (int i = 0; i < count; ++i) {
        Entity& box = samples::add(document, "Box", physics::BoxShape{{0.1, 0.2, 0.3}},
                                   {random.between(-8, 8), random.between(1, 200), random.between(-8, 8)});
        box.angular_velocity = {random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)};
    }
    return document;
}

double angle_between(Quat a, Quat b) { return 2 * std::acos(std::min(1.0, std::abs(dot(a, b)))); }

void expect_same(const Moment& moment, const Shown& was, const char* when) {
    EXPECT_NEAR(moment.time, was.time, 1e-9) << when;
    ASSERT_EQ(moment.entities.size(), was.motions.size()) << when;
    for (const EntityMoment& entity : moment.entities) {
        const EntityMotion& motion = was.motions.at(entity.motion.entity);
        EXPECT_LT(length(entity.motion.pose.position - motion.pose.position), 3e-5) << when;
        EXPECT_LT(angle_between(entity.motion.pose.rotation, motion.pose.rotation), 1.2e-4) << when;
        EXPECT_LT(length(entity.motion.linear_velocity - motion.linear_velocity), 3e-4) << when;
        EXPECT_LT(length(entity.motion.angular_velocity - motion.angular_velocity), 3e-4) << when;
        EXPECT_EQ(entity.motion.state, motion.state) << when;
        ASSERT_EQ(entity.points != nullptr, motion.points != nullptr) << when;
        if (!entity.points) continue;
        std::vector<Vec3> positions;
        entity.points->read(positions);
        const std::vector<Vec3>& expected = was.points.at(entity.motion.entity);
        ASSERT_EQ(positions.size(), expected.size()) << when;
        double furthest = 0;
        for (std::size_t i = 0; i < positions.size(); ++i)
            furthest = std::max(furthest, length(positions[i] - expected[i]));
        EXPECT_LT(furthest, 6e-5) << when;
    }
}

TEST(Take, TellsOfEveryMomentWhatWasThen) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Random random(seed);
        const auto simulation = samples::make(random_scene(random, seed % 4 == 0));
        ASSERT_NE(simulation, nullptr);
        Take take;
        take.add(*simulation);
        std::vector<Shown> all{shown_by(*simulation)};
        for (int i = 0; i < 120; ++i) {
            simulation->step();
            take.add(*simulation);
            all.push_back(shown_by(*simulation));
        }
        ASSERT_EQ(take.samples(), all.size());
        // Forwards, and to and fro.
        for (const Shown& was : all) expect_same(take.at(was.time), was, "forwards");
        for (int i = 0; i < 40; ++i) {
            const Shown& was = all[random.below(all.size())];
            expect_same(take.at(was.time), was, "to and fro");
        }
        // Between two samples: between their places.
        const Moment middle = take.at((all[50].time + all[51].time) / 2);
        for (const EntityMoment& entity : middle.entities) {
            const Vec3 a = all[50].motions.at(entity.motion.entity).pose.position;
            const Vec3 b = all[51].motions.at(entity.motion.entity).pose.position;
            EXPECT_LT(length(entity.motion.pose.position - (a + b) / 2), 4e-5);
        }
    }
}

TEST(Take, CostsTwentyBytesForWhatMovesAndNothingForWhatSleeps) {
    Document document = samples::floor_and_box(40);
    for (int i = 0; i < 60; ++i) {
        Entity& ball =
            samples::add(document, "Ball", physics::SphereShape{0.1}, {0.5 * (i % 8) - 2, 0.1, 0.4 * (i / 8)});
        ball.start_asleep = true;
    }
    const auto asleep = samples::make(document);
    Take take;
    take.add(*asleep);
    const std::size_t beginning = take.bytes();
    for (int i = 0; i < 60; ++i) {
        asleep->step();
        take.add(*asleep);
    }
    // One box falls beside 60 sleepers.
    EXPECT_LT((take.bytes() - beginning) / 60, 20u + 40u);

    const auto falling = samples::make(falling_boxes(200));
    Take all;
    all.add(*falling);
    const std::size_t first = all.bytes();
    for (int i = 0; i < 120; ++i) {
        falling->step();
        all.add(*falling);
    }
    const double bytes = static_cast<double>(all.bytes() - first) / (120.0 * 201);
    RecordProperty("bytes a body and sample", std::to_string(bytes));
    EXPECT_LT(bytes, 20);
}

TEST(Take, StaysWithinItsMemoryAndKeepsTheEnd) {
    const auto simulation = samples::make(falling_boxes(30));
    constexpr std::size_t most = 1 << 16;
    Take take(most);
    std::vector<Shown> late;
    for (int i = 0; i < 300; ++i) {
        simulation->step();
        take.add_now(*simulation);
        ASSERT_LE(take.bytes(), most) << i;
        if (i >= 280) late.push_back(shown_by(*simulation));
    }
    EXPECT_GT(take.start(), 1) << "nothing had to go";
    EXPECT_GT(take.bytes(), most / 2) << "too much has gone";
    for (const Shown& was : late) expect_same(take.at(was.time), was, "late");
    expect_same(take.at(1e9), late.back(), "the end");
    EXPECT_NEAR(take.at(0).time, take.start(), 1e-12);
}

TEST(Take, GoesOnAfterACut) {
    Random random(5);
    const auto simulation = samples::make(random_scene(random, false));
    Take take;
    std::vector<Shown> all;
    for (int i = 0; i < 60; ++i) {
        simulation->step();
        take.add(*simulation);
        all.push_back(shown_by(*simulation));
    }
    take.cut(all[30].time);
    EXPECT_EQ(take.samples(), 31u);
    EXPECT_NEAR(take.end(), all[30].time, 1e-12);
    expect_same(take.at(all[30].time), all[30], "the cut");
    simulation->step();
    take.add_now(*simulation);
    expect_same(take.at(1e9), shown_by(*simulation), "after the cut");
    expect_same(take.at(all[12].time), all[12], "before the cut");
}

}  // namespace
}  // namespace embody::scene
