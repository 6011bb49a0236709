// SPDX-License-Identifier: MIT
// Every number that steers a solver is worth its place: with another value some scene comes to other bits or
// reports another limit. What no scene notices does nothing, and goes. That the values are good is what the tests and
// sources beside them show (tools/check_settings.py).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "physics/definitions/grain_material.h"
#include "validation/setting_scenes.h"

namespace embody::physics {
namespace {

constexpr const char* groups[] = {"collision", "constraint", "deformable", "fluid", "optimization"};

bool is_tried(std::size_t place) {
    const char* wish = std::getenv("EMBODY_SETTINGS");
    return place % 6 == 0 || (wish != nullptr && std::string_view(wish) == "all");
}

/// One setting at another value than the default.
struct Changed {
    std::string path;
    WorldSettings settings;
};

// Each halving of joints doubles the parts of a step: where nothing converges, the 2^16 of the range would take hours.
constexpr double max_tried_halvings = 8;

// The default times and over 4 and 100, as far as it may go.
std::vector<Changed> changes_of(const std::string& group) {
    std::vector<Changed> changes;
    std::size_t place = 0;
    for (const SettingNumber& number : list_settings({})) {
        if (number.path.substr(0, number.path.find('.')) != group || !is_tried(place++)) continue;
        const double high =
            number.path == "constraint.joint.max_halvings" ? std::min(number.high, max_tried_halvings) : number.high;
        for (const double factor : {4.0, 0.25, 100.0, 0.01}) {
            double value = std::clamp(number.value == 0 ? factor : number.value * factor, number.low, high);
            if (number.is_integer && std::round(value) == number.value) value = std::min(number.value + 1, high);
            if (value == number.value) continue;
            Changed changed{number.path, {}};
            EXPECT_TRUE(set_setting(changed.settings.solver, number.path, value));
            changes.push_back(std::move(changed));
        }
    }
    return changes;
}

/// A scene, and the hash of the end and of the limits reached that it comes to by default.
struct Judge {
    std::string name;
    GoldenScene (*build)();
    int steps = 0;
    std::uint64_t usual = 0;
    std::chrono::steady_clock::duration time{};  // of the run

    [[nodiscard]] std::uint64_t run(const SolverSettings& solver) const {
        SCOPED_TRACE(name);
        const GoldenScene scene = build();
        WorldSettings settings = scene.world->settings();
        settings.solver = solver;
        settings.workers = 1;
        if (const auto set = scene.world->set_settings(settings); !set) {
            ADD_FAILURE() << set.error().message();
            return usual;
        }
        std::uint64_t limits = 0;
        for (int step = 0; step < steps; ++step) {
            if (scene.before_step) scene.before_step(*scene.world, step);
            limits = 31 * limits + scene.world->step().limits;
        }
        return scene.world->state_hash() ^ limits;
    }
};

// All scenes of the group, for rigid things also those of the others; those first that take the least time.
std::vector<Judge> judges_for(const std::string& group) {
    std::vector<Judge> judges;
    for (const auto scenes : {setting_scenes(), matter_setting_scenes()}) {
        for (const SettingScene& scene : scenes) {
            if (scene.group == group) judges.push_back({scene.name, scene.build, scene.steps});
        }
    }
    if (group != "fluid" && group != "deformable") {
        for (const Golden& golden : golden_scenes()) judges.push_back({golden.name, golden.build, 120});
        for (const SettingScene& scene : setting_scenes()) {
            const bool is_rigid = scene.group != "fluid" && scene.group != "deformable";
            if (is_rigid && scene.group != group) judges.push_back({scene.name, scene.build, scene.steps});
        }
    }
    for (Judge& judge : judges) {
        const auto begin = std::chrono::steady_clock::now();
        judge.usual = judge.run({});
        judge.time = std::chrono::steady_clock::now() - begin;
    }
    std::ranges::sort(judges, {}, &Judge::time);
    return judges;
}

// What those who make worlds of grains ask for, no world by itself.
std::vector<int> steps_for_grains(const WorldSettings& settings) {
    std::vector<int> substeps;
    for (const double radius : {0.0002, 0.002, 0.02}) substeps.push_back(substeps_for_grains(radius, settings));
    return substeps;
}

class Settings : public testing::TestWithParam<const char*> {};

TEST_P(Settings, AreNoticed) {
    const std::string group = GetParam();
    const std::vector<Judge> judges = judges_for(group);
    const std::vector<Changed> changes = changes_of(group);
    ASSERT_FALSE(changes.empty());
    for (auto first = changes.begin(); first != changes.end();) {
        const auto last = std::find_if(first, changes.end(), [&](const Changed& c) { return c.path != first->path; });
        const auto is_noticed_by = [&](const Judge& judge) {
            return std::any_of(
                first, last, [&](const Changed& changed) { return judge.run(changed.settings.solver) != judge.usual; });
        };
        const bool is_for_grains = std::any_of(first, last, [](const Changed& changed) {
            return steps_for_grains(changed.settings) != steps_for_grains({});
        });
        EXPECT_TRUE(is_for_grains || std::ranges::any_of(judges, is_noticed_by))
            << first->path << ": no scene notices it";
        first = last;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Settings, testing::ValuesIn(groups),
                         [](const auto& one) { return std::string(one.param); });

TEST(SettingLists, HaveEachDefaultWithinItsRange) {
    const std::vector<SettingNumber> numbers = list_settings({});
    EXPECT_GT(numbers.size(), 100u);
    for (const SettingNumber& number : numbers) {
        EXPECT_LE(number.low, number.value) << number.path;
        EXPECT_LE(number.value, number.high) << number.path;
    }
    EXPECT_TRUE(validate(SolverSettings{}).ok());
}

TEST(SettingLists, ArePrinted) {
    for (const SettingNumber& number : list_settings({})) {
        std::printf("setting %s %.17g %.17g %.17g %d\n", number.path.c_str(), number.value, number.low, number.high,
                    number.is_integer ? 1 : 0);
    }
}

TEST(SettingLists, RefuseWhatIsOutOfRangeByItsName) {
    for (const SettingNumber& number : list_settings({})) {
        WorldSettings settings;
        ASSERT_TRUE(set_setting(settings.solver, number.path, number.high + std::max(1.0, number.high)));
        const auto refused = validate(settings);
        ASSERT_FALSE(refused.ok()) << number.path << " above " << number.high;
        EXPECT_EQ(refused.error().where, "solver." + number.path);
    }
    SolverSettings settings;
    EXPECT_FALSE(set_setting(settings, "collision.none", 1));
    EXPECT_FALSE(set_setting(settings, "", 1));
}

}  // namespace
}  // namespace embody::physics
