// SPDX-License-Identifier: MIT
// Taps and drains of entities (docs/scene-format.md, "Taps and drains"): what came less what went is there, after every
// step of random scenes, whatever is done to them.
#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/simulation/take.h"
#include "scene/simulation/tub.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using samples::add_box;
using samples::add_drain;
using samples::add_tap;
using samples::add_water;
using samples::make;
using samples::points_of;
using samples::tub;

struct Scene {
    Document document;
    EntityIndex water = 0, oil = 0;
    std::vector<EntityIndex> ports;
};

/// One or two liquids, that may begin empty, with one to three taps and up to two drains.
Scene random_scene(Random& random) {
    Scene scene{tub(), 0, 0, {}};
    Document& document = scene.document;
    scene.water = add_water(document, 0.06, random.below(2) == 0).index;
    if (random.below(2) == 0) {
        Entity& oil = add_box(document, "Oil", {0.2, 0.03, 0.2}, {0, 0.1, 0}, PhysicalKind::fluid);
        oil.attributes["particle_budget"] = 3000.0;
        oil.attributes["density"] = 800.0;
        oil.starts_empty = random.below(2) == 0;
        scene.oil = oil.index;
    }
    for (std::uint64_t i = 0; i <= random.below(3); ++i) {
        Entity& tap =
            add_tap(document, {random.between(-0.1, 0.1), random.between(0.25, 0.4), random.between(-0.1, 0.1)},
                    random.between(20, 200));
        if (scene.oil != 0 && random.below(2) == 0) tap.tap.liquid = scene.oil;
        if (random.below(4) == 0) tap.attributes["kind"] = to_value(PhysicalKind::rigid);
        scene.ports.push_back(tap.index);
    }
    for (std::uint64_t i = 0; i < random.below(3); ++i)
        scene.ports.push_back(add_drain(document, {random.between(-0.1, 0.1), 0.002, random.between(-0.1, 0.1)},
                                        random.between(0.02, 0.05))
                                  .index);
    return scene;
}

/// Drops that are there less those that came, plus those that went: as many as at the start.
std::int64_t balance(const Simulation& simulation, const Scene& scene) {
    std::int64_t sum = 0;
    for (const EntityIndex liquid : {scene.water, scene.oil})
        if (liquid != 0) sum += static_cast<std::int64_t>(points_of(simulation, liquid).size());
    for (const EntityIndex port : scene.ports) {
        const auto passed = simulation.passed_drops(port);
        sum += static_cast<std::int64_t>(passed.drained) - static_cast<std::int64_t>(passed.poured);
    }
    return sum;
}

class Ports : public testing::TestWithParam<unsigned> {};

TEST_P(Ports, WhatCameLessWhatWentIsThereAfterEveryStep) {
    Random random(GetParam() + 1);
    const Scene scene = random_scene(random);
    const auto simulation = make(scene.document);
    ASSERT_TRUE(simulation);
    const std::int64_t before = balance(*simulation, scene);
    std::uint64_t poured = 0, oil_poured = 0;
    const std::size_t oil_before = points_of(*simulation, scene.oil).size();
    for (int i = 0; i < 120; ++i) {
        simulation->step();
        ASSERT_TRUE(simulation->problems().empty()) << simulation->problems().front().message();
        ASSERT_EQ(balance(*simulation, scene), before) << "step " << i;
    }
    std::uint64_t drained = 0;
    for (const EntityIndex port : scene.ports) {
        const auto passed = simulation->passed_drops(port);
        poured += passed.poured;
        drained += passed.drained;
        if (scene.oil != 0 && scene.document.find(port)->tap.liquid == scene.oil) oil_poured += passed.poured;
    }
    EXPECT_GT(poured, 0u);
    // Each liquid gains what its own taps gave.
    if (scene.oil != 0 && drained == 0) {
        EXPECT_EQ(points_of(*simulation, scene.oil).size(), oil_before + oil_poured);
    }
    RecordProperty("poured", std::to_string(poured));
    RecordProperty("drained", std::to_string(drained));
}

TEST_P(Ports, HaveEqualBitsForAnyNumberOfWorkers) {
    Random random(GetParam() + 101);
    Scene scene = random_scene(random);
    std::vector<Vec3> first;
    for (const int workers : {1, 2, 5}) {
        scene.document.settings.workers = workers;
        const auto simulation = make(scene.document);
        ASSERT_TRUE(simulation);
        samples::step(*simulation, 60);
        std::vector<Vec3> now = points_of(*simulation, scene.water);
        const std::vector<Vec3> oil = points_of(*simulation, scene.oil);
        now.insert(now.end(), oil.begin(), oil.end());
        if (workers == 1) first = now;
        EXPECT_FALSE(now.empty());
        EXPECT_EQ(now, first) << workers << " workers";
    }
}

// Taps and drains are opened, shut, moved, removed and copied; liquids disabled, changed and removed.
TEST_P(Ports, KeepTheirAccountWhateverIsDoneInARun) {
    Random random(GetParam() + 201);
    Scene scene = random_scene(random);
    const auto simulation = make(scene.document);
    ASSERT_TRUE(simulation);
    for (int i = 0; i < 90; ++i) {
        if (i % 6 == 5) {
            const std::vector<EntityIndex> all = simulation->entities();
            Entity changed = *simulation->definition(all[random.below(all.size())]);
            const bool is_port = changed.tap.litres_per_minute > 0 || changed.drain.radius > 0;
            switch (random.below(5)) {
                case 0:
                    changed.tap.open = changed.drain.open = !changed.tap.open;
                    break;
                case 1:
                    if (is_port || changed.index == scene.oil) changed.enabled = !changed.enabled;
                    break;
                case 2:
                    if (changed.index == scene.oil) changed.attributes["viscosity"] = random.between(0.001, 1);
                    if (is_port) changed.tap.litres_per_minute = random.between(0, 400);
                    break;
                case 3:
                    changed.starts_empty = !changed.starts_empty;
                    break;
                default:
                    if (is_port || changed.index == scene.oil) {
                        ASSERT_TRUE(simulation->remove(changed.index).ok());
                        continue;
                    }
            }
            const Result<void> updated = simulation->update(changed, true);
            ASSERT_TRUE(updated.ok()) << updated.error().message();
        }
        const auto balance_of_living = [&] {
            std::int64_t sum = 0;
            for (const EntityIndex index : simulation->entities()) {
                const MovingPoints* points = simulation->points(index);
                if (points != nullptr) sum += static_cast<std::int64_t>(points_of(*simulation, index).size());
                const auto passed = simulation->passed_drops(index);
                sum += static_cast<std::int64_t>(passed.drained) - static_cast<std::int64_t>(passed.poured);
            }
            return sum;
        };
        const std::int64_t before = balance_of_living();
        simulation->step();
        ASSERT_EQ(balance_of_living(), before) << "step " << i;
        for (const Vec3 p : points_of(*simulation, scene.water)) ASSERT_TRUE(is_finite(p));
    }
}

// A moment of a take has the drops of that step with their velocities, and a run goes on from it with as many.
TEST_P(Ports, AMomentOfATakeHasTheDropsOfItsStep) {
    Random random(GetParam() + 301);
    const Scene scene = random_scene(random);
    const auto simulation = make(scene.document);
    ASSERT_TRUE(simulation);
    Take take;
    struct Then {
        double time;
        std::size_t water, oil;
        Vec3 velocity;
    };
    std::vector<Then> then;
    for (int i = 0; i < 60; ++i) {
        simulation->step();
        take.add(*simulation);
        const MovingPoints* water = simulation->points(scene.water);
        then.push_back({simulation->world().last_report().time, points_of(*simulation, scene.water).size(),
                        points_of(*simulation, scene.oil).size(), water->linear_velocity()});
    }
    for (const std::size_t at : {std::size_t{1}, random.below(58) + 1, std::size_t{59}}) {
        const Moment moment = take.at(then[at].time);
        const auto again = make(scene.document);
        ASSERT_TRUE(again);
        const Result<void> restored = again->restore_moment(moment, {});
        ASSERT_TRUE(restored.ok()) << restored.error().message();
        EXPECT_EQ(points_of(*again, scene.water).size(), then[at].water);
        EXPECT_EQ(points_of(*again, scene.oil).size(), then[at].oil);
        // Their mean velocity, to the steps of differences: gravity changes it by 0.16 m/s in one.
        EXPECT_LT(length(again->points(scene.water)->linear_velocity() - then[at].velocity), 0.3);
        const std::int64_t before = balance(*again, scene);
        for (int i = 0; i < 30; ++i) {
            again->step();
            ASSERT_EQ(balance(*again, scene), before);
        }
    }
}

// What is kept and what is saved: the next run begins with every drop, none too where all have gone, also of those that
// stand in a solid, as below a tap whose mouth has come to lie in the ground.
TEST_P(Ports, AKeptFormHasItsDropsThroughAFile) {
    Random random(GetParam() + 401);
    Scene scene = random_scene(random);
    const auto simulation = make(scene.document);
    ASSERT_TRUE(simulation);
    samples::step(*simulation, 60);
    for (Entity& entity : scene.document.entities) {
        entity.kept = simulation->kept_form(entity.index);
        entity.pose = simulation->pose(entity.index);
    }
    const auto read = document_from_json(document_to_json(scene.document));
    ASSERT_TRUE(read.ok()) << read.error().message();
    const auto again = make(read.value());
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->notes().empty()) << again->notes().front();
    for (const EntityIndex liquid : {scene.water, scene.oil}) {
        const std::vector<Vec3> kept = points_of(*again, liquid), was = points_of(*simulation, liquid);
        ASSERT_EQ(kept.size(), was.size());
        for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_LT(distance(kept[i], was[i]), 1e-6);
    }
    const std::int64_t before = balance(*again, scene);
    for (int i = 0; i < 30; ++i) {
        again->step();
        ASSERT_EQ(balance(*again, scene), before);
    }
}

// A solid that is put into water that was kept: no drop is lost, and the solid pushes them out.
TEST_P(Ports, ASolidPutIntoKeptLiquidRaisesIt) {
    Random random(GetParam() + 501);
    Document document = tub();
    const EntityIndex water = add_water(document, random.between(0.06, 0.15), false).index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    samples::step(*simulation, 60);
    document.find(water)->kept = simulation->kept_form(water);
    const double height = simulation->points(water)->center_of_mass().y;
    const Vec3 half{random.between(0.03, 0.12), random.between(0.03, 0.12), random.between(0.03, 0.12)};
    const Vec3 middle{random.between(-0.05, 0.05), half.y, random.between(-0.05, 0.05)};
    add_box(document, "Block", half, middle, PhysicalKind::static_body);
    const auto again = make(document);
    ASSERT_TRUE(again);
    const std::size_t count = points_of(*again, water).size();
    EXPECT_EQ(count, points_of(*simulation, water).size());
    double fastest = 0, highest = 0;
    std::vector<Vec3> velocities;
    for (int i = 0; i < 240; ++i) {
        again->step();
        again->points(water)->read_velocities(velocities);
        for (const Vec3 velocity : velocities) fastest = std::max(fastest, length(velocity));
        for (const Vec3 p : points_of(*again, water)) highest = std::max(highest, p.y);
    }
    std::size_t inside = 0;
    for (const Vec3 p : points_of(*again, water)) {
        const Vec3 depth = half - abs(p - middle);
        if (std::min({depth.x, depth.y, depth.z}) > 1e-3) ++inside;
    }
    EXPECT_EQ(points_of(*again, water).size(), count);
    EXPECT_GT(again->points(water)->center_of_mass().y, height);
    EXPECT_LT(inside, count / 20);
    // No burst: slower than a fall from where the highest drop was.
    EXPECT_LT(fastest, std::sqrt(2 * 9.81 * highest));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Ports, testing::Range(0u, 8u));

}  // namespace
}  // namespace embody::scene
