// SPDX-License-Identifier: MIT
// Taps and drains of entities (docs/scene-format.md, "Taps and drains"): what came less what went is there, after every
// step of random scenes, whatever is done to them; and what makes no sense is told by its field.
#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/simulation/take.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using physics::BoxShape;
using physics::CylinderShape;
using samples::make;
using samples::points_of;

Entity& add_box(Document& document, const char* name, Vec3 half, Vec3 position, PhysicalKind kind) {
    Entity& box = samples::add(document, name, BoxShape{half}, position);
    box.attributes["kind"] = to_value(kind);
    return box;
}

/// A tub without lid, inside 40 × 30 × 40 cm above height 0, on ground that what splashes over falls on.
Document tub() {
    Document document;
    samples::add(document, "Ground", physics::PlaneShape{}, {0, -0.1, 0});
    add_box(document, "Bottom", {0.25, 0.05, 0.25}, {0, -0.05, 0}, PhysicalKind::static_body);
    for (const double side : {-1.0, 1.0}) {
        add_box(document, "Wall", {0.05, 0.2, 0.3}, {side * 0.25, 0.15, 0}, PhysicalKind::static_body);
        add_box(document, "Wall", {0.2, 0.2, 0.05}, {0, 0.15, side * 0.25}, PhysicalKind::static_body);
    }
    return document;
}

/// Water for a layer of this depth on the tub's bottom.
Entity& add_water(Document& document, double depth, bool starts_empty, double budget = 3000) {
    Entity& water = add_box(document, "Water", {0.2, depth / 2, 0.2}, {0, depth / 2, 0}, PhysicalKind::fluid);
    water.attributes["particle_budget"] = budget;
    water.starts_empty = starts_empty;
    return water;
}

Entity& add_tap(Document& document, Vec3 position, double litres_per_minute) {
    Entity& tap = samples::add(document, "Tap", CylinderShape{0.02, 0.02}, position);
    tap.attributes["kind"] = to_value(PhysicalKind::static_body);
    tap.tap = {.litres_per_minute = litres_per_minute, .radius = 0.02, .position = {0, -0.04, 0}};
    return tap;
}

Entity& add_drain(Document& document, Vec3 position, double radius) {
    Entity& drain = samples::add(document, "Drain", CylinderShape{0.02, 0.002}, position);
    drain.attributes["kind"] = to_value(PhysicalKind::static_body);
    drain.drain.radius = radius;
    return drain;
}

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
    if (scene.oil != 0 && drained == 0) EXPECT_EQ(points_of(*simulation, scene.oil).size(), oil_before + oil_poured);
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

INSTANTIATE_TEST_SUITE_P(Seeds, Ports, testing::Range(0u, 8u));

TEST(PortsTest, ATubIsFilledAndEmptiedAndKeptEmpty) {
    Document document = tub();
    const EntityIndex water = add_water(document, 0.1, true).index;
    const EntityIndex tap = add_tap(document, {0, 0.3, 0}, 60).index;
    const auto filled = make(document);
    ASSERT_TRUE(filled);
    EXPECT_TRUE(filled->notes().empty());
    EXPECT_TRUE(points_of(*filled, water).empty());
    samples::step(*filled, 300);
    // 60 litres a minute for 5 s.
    EXPECT_NEAR(filled->points(water)->mass(), 998 * 5e-3, 998 * 1e-4);
    EXPECT_NEAR(filled->points(water)->center_of_mass().y, 5e-3 / 0.16 / 2, 0.01);
    EXPECT_EQ(points_of(*filled, water).size(), filled->passed_drops(tap).poured);

    // A scene that begins full, with a wide drain, until nothing is left; kept, it begins empty.
    document.find(tap)->tap.open = false;
    document.find(water)->starts_empty = false;
    add_drain(document, {0, 0.002, 0}, 0.5);
    const auto emptied = make(document);
    ASSERT_TRUE(emptied);
    EXPECT_GT(points_of(*emptied, water).size(), 1000u);
    samples::step(*emptied, 10);
    EXPECT_TRUE(points_of(*emptied, water).empty());
    samples::step(*emptied, 120);
    EXPECT_EQ(emptied->sleep_state(water), physics::SleepState::asleep);
    document.find(water)->kept = emptied->kept_form(water);
    ASSERT_TRUE(document.find(water)->kept);
    const auto read = document_from_json(document_to_json(document));
    ASSERT_TRUE(read.ok()) << read.error().message();
    const auto again = make(read.value());
    ASSERT_TRUE(again);
    EXPECT_TRUE(points_of(*again, water).empty());
}

TEST(PortsTest, ActionsOpenAndShutThem) {
    Document document = tub();
    const EntityIndex water = add_water(document, 0.1, true).index;
    Entity& tap = add_tap(document, {0, 0.3, 0}, 60);
    tap.tap.open = false;
    const EntityIndex index = tap.index;
    for (const double time : {0.5, 1.0})
        document.actions.push_back({.id = time < 0.7 ? 1u : 2u,
                                    .receiver = {Target::By::index, index, {}},
                                    .trigger = AtTime{time, {}},
                                    .effect = SetOpen{time < 0.7}});
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    samples::step(*simulation, 29);
    EXPECT_TRUE(points_of(*simulation, water).empty());
    samples::step(*simulation, 91);
    // Half a second of 1 litre a second.
    EXPECT_NEAR(simulation->points(water)->mass(), 998 * 5e-4, 998 * 5e-5);
}

TEST(PortsTest, WaitWhileTheLiquidHasItsBudget) {
    Document document = tub();
    const EntityIndex water = add_water(document, 0.1, true, 300).index;
    add_tap(document, {0, 0.3, 0}, 600);
    add_tap(document, {0.1, 0.3, 0}, 600);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    std::uint32_t limits = 0;
    for (int i = 0; i < 120; ++i) limits |= simulation->step().limits;
    EXPECT_EQ(points_of(*simulation, water).size(), 300u);
    EXPECT_NE(limits & static_cast<std::uint32_t>(physics::StepLimit::fluid_source_waits), 0u);
}

// What makes no sense: an error by its field, or a note where the scene can be played.
TEST(PortsTest, TellWhatIsWrongByItsField) {
    const auto error_of = [](auto change) {
        Document document = tub();
        add_water(document, 0.1, true);
        change(add_tap(document, {0, 0.3, 0}, 60));
        const auto made = Simulation::create(document, nullptr);
        return made.ok() ? std::string("right") : made.error().message();
    };
    EXPECT_EQ(error_of([](Entity&) {}), "right");
    EXPECT_NE(error_of([](Entity& tap) { tap.tap.litres_per_minute = 6e5; }).find("tap.radius"), std::string::npos);
    EXPECT_NE(error_of([](Entity& tap) { tap.tap.radius = 0; }).find("tap.speed"), std::string::npos);
    EXPECT_NE(error_of([](Entity& tap) { tap.tap.speed = std::nan(""); }).find("tap.speed"), std::string::npos);
    EXPECT_NE(error_of([](Entity& tap) { tap.tap.position.y = 1e300; }).find("tap.position[1]"), std::string::npos);
    EXPECT_NE(error_of([](Entity& tap) { tap.drain.radius = 11; }).find("drain.radius"), std::string::npos);

    const auto fault_of = [](auto change, bool has_water = true) {
        Document document = tub();
        const EntityIndex water = has_water ? add_water(document, 0.1, true).index : 0;
        change(add_tap(document, {0, 0.3, 0}, 60), water);
        const auto made = make(document);
        if (!made || made->port_faults().empty()) return std::string();
        EXPECT_EQ(made->notes().size(), 1u);
        samples::step(*made, 5);
        EXPECT_TRUE(made->problems().empty());
        return made->port_faults().front().error.where;
    };
    EXPECT_EQ(fault_of([](Entity&, EntityIndex) {}), "");
    EXPECT_EQ(fault_of([](Entity&, EntityIndex) {}, false), "tap.liquid");
    EXPECT_EQ(fault_of([](Entity& tap, EntityIndex) { tap.tap.liquid = 99; }), "tap.liquid");
    EXPECT_EQ(fault_of([](Entity& tap, EntityIndex) { tap.tap.liquid = 1; }), "tap.liquid");
    EXPECT_EQ(fault_of([](Entity& tap, EntityIndex) { tap.tap.liquid = tap.index; }), "tap.liquid");
    const auto soften = [](Entity& tap, EntityIndex) { tap.attributes["kind"] = to_value(PhysicalKind::soft); };
    EXPECT_EQ(fault_of(soften), "tap");
}

}  // namespace
}  // namespace embody::scene
