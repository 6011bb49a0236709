// SPDX-License-Identifier: MIT
// The bits that ten scenes come to: the same for gcc and clang, Debug and Release, any number of lanes and workers.
// Whoever changes a formula or an order of summation changes them, and says so by committing golden_hashes.txt, which
//     EMBODY_GOLDEN_HASHES=write test_validation --gtest_filter='GoldenHashes.AreTheSameInEveryBuild/*'
// writes anew.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "folders.h"
#include "validation/golden_scenes.h"

namespace embody::physics {
namespace {

constexpr std::array checkpoints{10, 60, 240};  // steps

using Hashes = std::array<std::uint64_t, checkpoints.size()>;

const std::filesystem::path table_file = source_folder() / "tests/validation/golden_hashes.txt";

// Lines of a scene's name and its hashes in hexadecimal digits.
std::map<std::string, Hashes> read_table() {
    std::map<std::string, Hashes> table;
    std::ifstream file(table_file);
    std::string name;
    while (file >> name) {
        for (std::uint64_t& hash : table[name]) file >> std::hex >> hash;
    }
    return table;
}

void write_table(const std::map<std::string, Hashes>& table) {
    std::ofstream file(table_file);
    for (const auto& [name, hashes] : table) {
        file << name;
        for (const std::uint64_t hash : hashes) file << ' ' << std::hex << hash;
        file << '\n';
    }
}

// Null hashes where the processor has not as many lanes.
Hashes run_golden(const Golden& golden, int workers, int lanes) {
    const GoldenScene scene = golden.build();
    WorldSettings settings = scene.world->settings();
    settings.workers = workers;
    settings.lanes = lanes;
    if (!scene.world->set_settings(settings)) return {};
    Hashes hashes{};
    int step = 0;
    for (std::size_t k = 0; k < checkpoints.size(); ++k) {
        for (; step < checkpoints[k]; ++step) {
            if (scene.before_step) scene.before_step(*scene.world, step);
            scene.world->step();
        }
        hashes[k] = scene.world->state_hash();
    }
    return hashes;
}

void expect_same(const Golden& golden, const Hashes& hashes, const Hashes& expected) {
    for (std::size_t k = 0; k < checkpoints.size(); ++k) {
        ASSERT_EQ(hashes[k], expected[k]) << golden.name << " differs within " << checkpoints[k] << " steps";
    }
}

class GoldenHashes : public testing::TestWithParam<Golden> {};

TEST_P(GoldenHashes, AreTheSameInEveryBuild) {
    const char* wish = std::getenv("EMBODY_GOLDEN_HASHES");
    const bool writes = wish != nullptr && std::string_view(wish) == "write";
    auto table = read_table();
    const Hashes hashes = run_golden(GetParam(), 1, 0);
    if (!writes) expect_same(GetParam(), hashes, table[GetParam().name]);
    table[GetParam().name] = hashes;
    if (writes) write_table(table);
}

// A scene and a number of workers a test: where these are more than the processors that are free, they take turns, and
// the pyramid needs many times as long.
void expect_golden(const Golden& golden, int workers, int lanes) {
    const Hashes hashes = run_golden(golden, workers, lanes);
    if (hashes != Hashes{}) expect_same(golden, hashes, read_table()[golden.name]);
}

TEST_P(GoldenHashes, AreTheSameForThreeWorkersAndFourLanes) { expect_golden(GetParam(), 3, 4); }

TEST_P(GoldenHashes, AreTheSameForEightWorkersAndLanes) { expect_golden(GetParam(), 8, 8); }

INSTANTIATE_TEST_SUITE_P(, GoldenHashes, testing::ValuesIn(golden_scenes().begin(), golden_scenes().end()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace embody::physics
