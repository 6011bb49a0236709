// SPDX-License-Identifier: MIT
// Single cases of taps and drains: filled and emptied, opened by actions, full liquids, and what makes no sense.
#include <cmath>

#include "scene/file/scene_file.h"
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
