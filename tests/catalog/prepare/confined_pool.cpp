// SPDX-License-Identifier: MIT
#include "catalog/prepare/confined_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "catalog/prepare/worker_protocol.h"
#include "folders.h"
#include "interchange/compact/compact_geometry.h"
#include "interchange/scratch_files.h"

namespace embody::catalog {
namespace {

using test::cube_obj;
using test::ScratchFolder;

const std::filesystem::path real_worker = build_folder() / "src/embody-import-worker";

/// The result of each item; fails the test where one is reported twice or not at all.
std::map<std::size_t, Result<PreparedModel>> prepare_all(const std::vector<ImportItem>& items,
                                                         const ConfinedPoolOptions& options) {
    std::map<std::size_t, Result<PreparedModel>> results;
    const auto run = prepare_confined(items, options, [&](std::size_t item, Result<PreparedModel> prepared) {
        EXPECT_LT(item, items.size());
        EXPECT_TRUE(results.emplace(item, std::move(prepared)).second) << "item " << item << " was told twice";
        return true;
    });
    EXPECT_TRUE(run) << run.error().message();
    EXPECT_EQ(results.size(), items.size());
    return results;
}

std::string as_text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// A program that reports that it is ready, waits for an item and then runs `rest` (shell).
std::filesystem::path fake_worker(const ScratchFolder& scratch, const std::string& rest) {
    const auto ready = scratch.write("ready", as_text(frame(FrameKind::ready, {})));
    const auto program =
        scratch.write("worker", "#!/bin/sh\ncat '" + ready.string() + "'\nhead -c 16 >/dev/null\n" + rest + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return program;
}

std::string reason_from(const std::filesystem::path& worker, ConfinedPoolOptions options = {}) {
    options.workers = 1;
    options.worker_program = worker;
    const auto results = prepare_all({{.path = "a.obj"}}, options);
    if (results.empty() || results.at(0).ok()) return "prepared";
    EXPECT_EQ(results.at(0).error().where.find("a.obj"), 0u) << results.at(0).error().message();
    return results.at(0).error().why;
}

bool fails_to_start(const std::filesystem::path& program) {
    const auto run = prepare_confined({{.path = "a.obj"}}, {.workers = 1, .worker_program = program},
                                      [](std::size_t, const auto&) { return true; });
    return !run.ok() && run.error().where == program.string();
}

TEST(ConfinedPool, SaysSoWhenNoWorkerStarts) {
    const ScratchFolder scratch;
    EXPECT_TRUE(fails_to_start(scratch.path() / "missing"));
    EXPECT_TRUE(fails_to_start(scratch.write("no-program", "hello")));
    EXPECT_TRUE(fails_to_start("/bin/true"));
    EXPECT_TRUE(fails_to_start("/bin/echo"));
    EXPECT_FALSE(prepare_confined({}, {.processor_seconds_per_model = 0}, {}));
    EXPECT_FALSE(prepare_confined({}, {.processor_seconds_per_model = 4000}, {}));
    EXPECT_FALSE(prepare_confined({}, {.wall_seconds_per_model = 0}, {}));
    EXPECT_TRUE(prepare_confined({}, {}, {}));
}

TEST(ConfinedPool, EndsAWorkerThatTakesTooLong) {
    const ScratchFolder scratch;
    EXPECT_EQ(reason_from(fake_worker(scratch, "exec sleep 1000"), {.wall_seconds_per_model = 0.5}),
              "was not ready within 0.500000 s");
    EXPECT_EQ(reason_from(fake_worker(scratch, "exec sleep 1000"), {.wall_seconds_per_model = 1}),
              "was not ready within 1 s");
    EXPECT_EQ(reason_from(fake_worker(scratch, "while :; do :; done"), {.processor_seconds_per_model = 1}),
              "needs more than 1 s of processor time");
}

// A fake worker's answer to every item.
std::string answers(const ScratchFolder& scratch, FrameKind kind, const std::string& why) {
    const auto answer = scratch.write("answer " + why, as_text(frame(kind, to_bytes(Error{"a.obj", why}))));
    return "cat '" + answer.string() + "'\nexec sleep 1000";
}

TEST(ConfinedPool, WaitingCountsAsNoProcessorTime) {
    const ScratchFolder scratch;
    const auto late = fake_worker(scratch, "sleep 2\n" + answers(scratch, FrameKind::failed, "late"));
    EXPECT_EQ(reason_from(late, {.processor_seconds_per_model = 0.5}), "late");
}

/// A program that dies by `death` (shell) when it first receives an item, and runs `rest` the next time.
std::filesystem::path fake_worker_that_recovers(const ScratchFolder& scratch, const std::string& death,
                                                const std::string& rest) {
    const std::string mark = "'" + (scratch.path() / "tried").string() + "'";
    return fake_worker(scratch, "test -e " + mark + " || { echo x > " + mark + "; " + death + "; }\n" + rest);
}

TEST(ConfinedPool, RetriesAFailureThatALoadedMachineMayHaveCaused) {
    for (const std::string death : {"kill -KILL $$", "kill -SEGV $$", "exec sleep 1000"}) {
        const ScratchFolder scratch;
        const auto worker = fake_worker_that_recovers(scratch, death, answers(scratch, FrameKind::failed, "answered"));
        EXPECT_EQ(reason_from(worker, {.wall_seconds_per_model = 3}), "answered") << death;
    }
    // A failure that the file causes by itself is not tried again.
    const ScratchFolder scratch;
    const auto worker =
        fake_worker_that_recovers(scratch, "while :; do :; done", answers(scratch, FrameKind::failed, "answered"));
    EXPECT_EQ(reason_from(worker, {.processor_seconds_per_model = 0.5}),
              "needs more than 0.500000 s of processor time");
}

// A worker whose memory a file may have damaged is not used for the next file.
TEST(ConfinedPool, ANewWorkerMakesTheSecondTry) {
    const ScratchFolder scratch;
    const std::string lives = "'" + scratch.write("lives", "0").string() + "'";
    const auto worker = fake_worker(scratch, "n=$(cat " + lives + "); echo $((n + 1)) >" + lives +
                                                 "\ntest $n -ge 2 || kill -SEGV $$\n" +
                                                 answers(scratch, FrameKind::failed, "answered"));
    const auto results = prepare_all({{.path = "a.obj"}, {.path = "b.obj"}},
                                     {.workers = 1, .wall_seconds_per_model = 3, .worker_program = worker});
    for (const auto& [item, result] : results) {
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().why, "answered") << item;
    }
}

TEST(ConfinedPool, AModelThatNeedsMoreMemoryRunsAlone) {
    const ScratchFolder scratch;
    // A worker's second argument is its address space. Half of the budget, for two workers at a time, is too little.
    const std::string more = answers(scratch, FrameKind::out_of_memory, "too little");
    const auto worker = fake_worker(
        scratch, "test $2 -gt 2000000000 || { " + more + "; }\n" + answers(scratch, FrameKind::failed, "enough"));
    EXPECT_EQ(reason_from(worker, {.bytes = std::size_t{1} << 30}), "too little");
    const auto results =
        prepare_all({{.path = "a.obj"}}, {.workers = 2, .bytes = std::size_t{2} << 30, .worker_program = worker});
    EXPECT_EQ(results.at(0).error().why, "enough");
}

TEST(ConfinedPool, StopsWithinAModel) {
    const ScratchFolder scratch;
    int asked = 0;
    EXPECT_TRUE(prepare_confined(
        {{.path = "a.obj"}},
        {.workers = 1, .worker_program = fake_worker(scratch, "exec sleep 1000"), .go_on = [&] { return ++asked < 3; }},
        [](std::size_t, const auto&) { return ADD_FAILURE() << "nothing was prepared", true; }));
    EXPECT_EQ(asked, 3);
}

TEST(ConfinedPool, NamesTheSignalOfACrash) {
    const ScratchFolder scratch;
    EXPECT_NE(reason_from(fake_worker(scratch, "kill -SEGV $$")).find("signal 11 (Segmentation fault)"),
              std::string::npos);
    EXPECT_NE(reason_from(fake_worker(scratch, "kill -ABRT $$")).find("signal 6 (Aborted)"), std::string::npos);
    EXPECT_NE(reason_from(fake_worker(scratch, "exit 5")).find("code 5"), std::string::npos);
}

TEST(ConfinedPool, TakesNothingFromAWorkerThatLies) {
    const ScratchFolder scratch;
    const auto says = [&](const std::string& bytes) {
        return reason_from(
            fake_worker(scratch, "cat '" + scratch.write("answer", bytes).string() + "'\nexec sleep 1000"));
    };
    const std::string refused = "sent something that is not its protocol";
    EXPECT_EQ(says("garbage that is longer than a header"), refused);
    // A length of 4 GiB, a wrong hash, an invalid model.
    std::string huge = as_text(frame(FrameKind::prepared, {}));
    std::fill(huge.begin() + 12, huge.begin() + 16, '\xff');
    EXPECT_EQ(says(huge), refused);
    std::string wrong = as_text(frame(FrameKind::failed, to_bytes(Error{"a", "b"})));
    wrong.back() = static_cast<char>(wrong.back() ^ 1);
    EXPECT_EQ(says(wrong), refused);
    EXPECT_EQ(says(as_text(frame(FrameKind::ready, {}))), "the import worker spoke out of turn");
}

TEST(ConfinedPool, RefusesAnInvalidModel) {
    const ScratchFolder scratch;
    const std::vector<std::uint8_t> nonsense(100, 0xFF);
    const auto answer = scratch.write("answer", as_text(frame(FrameKind::prepared, nonsense)));
    const auto results = prepare_all(
        {{.path = "a.obj"}},
        {.workers = 1, .worker_program = fake_worker(scratch, "cat '" + answer.string() + "'\nexec sleep 1000")});
    EXPECT_FALSE(results.at(0));
}

TEST(ConfinedPool, OneBadFileCostsThatFileOnly) {
    const ScratchFolder scratch;
    std::vector<ImportItem> items;
    for (int i = 0; i < 12; ++i) {
        const bool bad = i % 3 == 0;
        const auto file = scratch.write("m" + std::to_string(i) + ".obj",
                                        bad ? "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" : cube_obj());
        items.push_back({.path = file.string(), .name = "model " + std::to_string(i)});
    }
    const auto results = prepare_all(items, {.workers = 2, .worker_program = real_worker});
    for (const auto& [item, result] : results) {
        EXPECT_EQ(result.ok(), item % 3 != 0) << item;
        if (!result) continue;
        EXPECT_EQ(result->facts.name, items[item].name);
        EXPECT_TRUE(interchange::decode_mesh(result->geometry));
    }
}

TEST(ConfinedPool, SurvivesMemoryAndArchiveBombs) {
    const ScratchFolder scratch;
    std::string vertices;
    for (int i = 0; i < 4'000'000; ++i) vertices += "v 1 2 3\n";
    const auto many = scratch.write("many.obj", vertices + "f 1 2 3\n");
    const auto bomb = scratch.write_zip("bomb.zip", {{"bomb.obj", std::string(std::size_t{600} << 20, ' ')}});
    const auto cube = scratch.write("cube.obj", cube_obj());
    const auto results =
        prepare_all({{.path = many.string()}, {.archive = bomb.string(), .path = "bomb.obj"}, {.path = cube.string()}},
                    {.workers = 1, .bytes = std::size_t{400} << 20, .worker_program = real_worker});
    ASSERT_FALSE(results.at(0));
    EXPECT_FALSE(results.at(1));
    EXPECT_TRUE(results.at(2)) << results.at(2).error().message();
}

TEST(ConfinedPool, StopsWhenToldTo) {
    const ScratchFolder scratch;
    std::vector<ImportItem> items(20, ImportItem{.path = scratch.write("cube.obj", cube_obj()).string()});
    int told = 0;
    EXPECT_TRUE(prepare_confined(items, {.workers = 2, .worker_program = real_worker},
                                 [&](std::size_t, const auto&) { return ++told < 3; }));
    EXPECT_EQ(told, 3);
}

TEST(ConfinedPool, RefusesItemsThatAreTooLong) {
    const ScratchFolder scratch;
    const auto cube = scratch.write("cube.obj", cube_obj()).string();
    const auto results = prepare_all({{.path = std::string(100'000, 'x')}, {.path = cube}},
                                     {.workers = 1, .worker_program = real_worker});
    EXPECT_FALSE(results.at(0));
    EXPECT_TRUE(results.at(1));
}

TEST(ConfinedPool, NoTestModelOfAssimpEndsTheImport) {
    const std::filesystem::path folder = "/usr/share/assimp/models";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "assimp-testmodels is not installed";
    std::vector<ImportItem> items;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) items.push_back({.path = entry.path().string()});
    }
    std::sort(items.begin(), items.end(), [](const ImportItem& a, const ImportItem& b) { return a.path < b.path; });
    std::size_t prepared = 0;
    for (const auto& [item, result] : prepare_all(items, {.workers = 2, .worker_program = real_worker})) {
        prepared += result.ok() ? 1 : 0;
        if (!result) {
            EXPECT_EQ(result.error().why.find("import worker"), std::string::npos) << result.error().message();
        }
    }
    EXPECT_GE(prepared, 80u);
}

}  // namespace
}  // namespace embody::catalog
