// SPDX-License-Identifier: MIT
#include "scene/simulation/recording.h"
#include "folders.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/file/scene_file.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Recording : public testing::Test {
protected:
    Recording() {
        std::string name = (fs::temp_directory_path() / "embody_recording_XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~Recording() override { fs::remove_all(folder_); }

    std::vector<json> record(const RecordingOptions& options, int steps) {
        const Document document = samples::floor_and_box(0.5);
        auto simulation = Simulation::create(document, nullptr);
        const fs::path file = folder_ / "out.jsonl";
        auto recorder = Recorder::create(file, document, options);
        if (!simulation.ok() || !recorder.ok()) return {};
        EXPECT_TRUE(recorder.value()->sample(*simulation.value()).ok());
        for (int i = 0; i < steps; ++i) {
            simulation.value()->step();
            EXPECT_TRUE(recorder.value()->sample(*simulation.value()).ok());
        }
        EXPECT_TRUE(recorder.value()->finish().ok());
        std::vector<json> lines;
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
        return lines;
    }
    fs::path folder_;
};

TEST_F(Recording, RefusesWhatItCanNotWrite) {
    const Document document = samples::floor_and_box();
    EXPECT_FALSE(Recorder::create(folder_ / "none" / "out.jsonl", document, {}).ok());
    EXPECT_FALSE(Recorder::create(folder_ / "out.jsonl", document, {.rate = 0}).ok());
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    // A full disk is an error already at the header.
    EXPECT_FALSE(Recorder::create("/dev/full", document, {}).ok());
}

TEST_F(Recording, HasAHeaderAndALineASample) {
    const std::vector<json> lines = record({.rate = 30}, 60);
    ASSERT_EQ(lines.size(), 1u + 31u);
    EXPECT_EQ(lines[0]["embody_recording"], 1);
    EXPECT_EQ(lines[0]["entities"][1], (json{{"index", 2}, {"name", "Box"}}));
    for (std::size_t i = 1; i < lines.size(); ++i) {
        EXPECT_NEAR(lines[i]["t"].get<double>(), static_cast<double>(i - 1) / 30, 1e-9);
        EXPECT_EQ(lines[i]["step"], 2 * (i - 1));
        ASSERT_EQ(lines[i]["entities"].size(), 2u);
        const json& box = lines[i]["entities"][1];
        for (const char* field : {"index", "position", "rotation", "linear_velocity", "angular_velocity", "state"})
            EXPECT_TRUE(box.contains(field)) << field;
        EXPECT_FALSE(lines[i].contains("contacts") || lines[i].contains("energy"));
    }
    EXPECT_EQ(lines[1]["entities"][0]["state"], "static");
    EXPECT_EQ(lines[1]["entities"][1]["state"], "active");
}

TEST_F(Recording, SaysContactsAndEnergyOnRequest) {
    const std::vector<json> lines = record({.rate = 60, .contacts = true, .energy = true}, 40);
    ASSERT_EQ(lines.size(), 42u);
    // 125 kg at 0.5 m.
    EXPECT_NEAR(lines[1]["energy"]["total"].get<double>(), 125 * 9.81 * 0.5, 1e-6);
    EXPECT_TRUE(lines[1]["contacts"].empty());
    const json& last = lines.back();
    ASSERT_FALSE(last["contacts"].empty());
    for (const char* field : {"a", "b", "position", "normal", "separation", "impulse"})
        EXPECT_TRUE(last["contacts"][0].contains(field)) << field;
    EXPECT_EQ(last["contacts"][0]["a"], 1);
    EXPECT_EQ(last["contacts"][0]["b"], 2);
    EXPECT_EQ(last["linear_momentum"].size(), 3u);
}

TEST(DemoScenes, OfPrimitivesRunAndComeToRest) {
    const fs::path demos = source_folder() / "data" / "scenes";
    for (const char* name : {"stack_of_boxes", "dominoes"}) {
        const Result<Document> document = load_document(demos / (std::string(name) + ".json"));
        ASSERT_TRUE(document.ok()) << document.error().message();
        auto simulation = Simulation::create(document.value(), nullptr);
        ASSERT_TRUE(simulation.ok()) << simulation.error().message();
        std::size_t fired = 0;
        for (int i = 0; i < 900; ++i) {
            simulation.value()->step();
            fired += simulation.value()->fired().size();
            EXPECT_TRUE(simulation.value()->problems().empty());
        }
        const physics::StepReport& report = simulation.value()->world().last_report();
        EXPECT_EQ(report.bodies_active + report.bodies_wanting_to_sleep, 0u) << name;
        // Every domino falls: the actions of the push, the bell, the ball and the sleeper fire.
        if (std::string(name) == "dominoes") {
            EXPECT_EQ(fired, 4u);
        }
    }
}

}  // namespace
}  // namespace embody::scene
