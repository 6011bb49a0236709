// SPDX-License-Identifier: MIT
#include "scene/session/journal.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include "scene/session/session_fixture.h"
#include "scene/session/session_state.h"

namespace {
std::atomic<int> syncs_of_tests{0};  // on the thread that runs the tests
const std::thread::id test_thread = std::this_thread::get_id();
}  // namespace

// In place of the system's.
extern "C" int fsync(int descriptor) {
    if (std::this_thread::get_id() == test_thread) ++syncs_of_tests;
    return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class JournalTest : public SessionTest {
protected:
    fs::path folder() const { return folder_ / "saved" / "autosave"; }
    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        if (!fs::exists(folder())) return found;
        for (const auto& entry : fs::directory_iterator(folder()))
            if (!entry.path().native().ends_with("draft")) found.push_back(entry.path());
        return found;
    }
    // The document of the only journal.
    json kept() {
        const std::vector<fs::path> found = files();
        if (found.size() != 1) {
            ADD_FAILURE() << found.size() << " files";
            return {};
        }
        const Result<Recovered> read = read_journal(found[0]);
        if (!read.ok()) {
            ADD_FAILURE() << read.error().message();
            return {};
        }
        return document_to_json(read.value().document);
    }
    template <class Condition>
    static void wait_until(const Condition& condition) {
        for (int i = 0; i < 10'000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    static std::string content_of(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(JournalTest, HoldsEveryAcknowledgedEditUndoAndRedo) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        session_.reset();
        fs::remove_all(folder());
        session_ = make();
        Random random(seed);
        if (seed % 4 == 0) run("simulation.play");
        for (int i = 0; i < 120; ++i) {
            std::string name;
            json params = random_command(random, session_->document(), name);
            const std::uint64_t what = random.below(6);
            if (what < 2) {
                name = what == 0 ? "edit.undo" : "edit.redo";
                params = json::object();
            }
            (void)session_->execute(name, params, 1 + random.below(3)).ok();
            if (seed % 4 == 0) session_->step();
            if (files().empty()) {
                ASSERT_FALSE(run("hello")["unsaved"]) << "seed " << seed << ", command " << i;
            } else {
                ASSERT_EQ(kept(), document()) << "seed " << seed << ", command " << i << ": " << name;
            }
        }
    }
}

TEST_F(JournalTest, ACutOrDamagedFileGivesADocumentThatWasOrAReason) {
    std::set<std::string> states;
    Random random(7);
    for (int i = 0; i < 40; ++i) {
        std::string name;
        const json params = random_command(random, session_->document(), name);
        if (session_->execute(name, params).ok()) states.insert(document().dump());
    }
    const std::string whole = content_of(files().at(0));
    const fs::path damaged = folder_ / "damaged.journal";
    std::size_t read_well = 0, refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string text = whole;
        if (i % 2 == 0) {
            text.resize(random.below(whole.size()));
        } else {
            text[random.below(whole.size())] ^= static_cast<char>(1 + random.below(255));
        }
        std::ofstream(damaged, std::ios::binary) << text;
        const Result<Recovered> read = read_journal(damaged);
        if (!read.ok()) {
            EXPECT_FALSE(read.error().message().empty());
            ++refused;
            continue;
        }
        ++read_well;
        ASSERT_TRUE(states.contains(document_to_json(read.value().document).dump())) << "case " << i;
    }
    EXPECT_GT(read_well, 200u);
    EXPECT_GT(refused, 5u) << "of a file without its document nothing is left";
}

TEST_F(JournalTest, HoldsEditsOfASceneWithoutACamera) {
    json scene = document();
    scene.erase("camera");
    run("scene.load", {{"scene", scene}});
    add_box({0, 1, 0});
    run("scene.settings", {{"title", "T"}});
    add_box({1, 1, 0});
    run("scene.settings", {{"camera", {{"position", {1, 2, 3}}, {"target", {0, 0, 0}}}}});
    run("edit.undo");
    add_box({2, 1, 0});
    EXPECT_EQ(kept(), document());
}

// A limit of the size of files stands for a full disk.
TEST_F(JournalTest, AFullDiskLosesNothingThatWasKept) {
    for (int i = 0; i < 20; ++i) add_box({0.1 * i, 1, 0});
    const json before = document();
    rlimit usual{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &usual), 0);
    const auto ignored = signal(SIGXFSZ, SIG_IGN);
    const auto set_room = [&usual](rlim_t bytes) {
        const rlimit limit{bytes, usual.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    };
    session_->take_events();
    // The first line is written in part; then there is no room for a new file, either.
    set_room(fs::file_size(files().at(0)) + 20);
    add_box({9, 1, 0});
    set_room(64);
    add_box({10, 1, 0});
    std::size_t told = 0;
    for (const json& event : session_->take_events().messages) told += event["event"] == "message" ? 1 : 0;
    EXPECT_EQ(told, 1u);
    EXPECT_EQ(run("hello")["kept"], false);
    EXPECT_EQ(kept()["entities"], before["entities"]) << "what was on disk is on disk";

    // With room again all is written.
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &usual), 0);
    (void)signal(SIGXFSZ, ignored);
    add_box({11, 1, 0});
    EXPECT_EQ(run("hello")["kept"], true);
    EXPECT_EQ(kept(), document());
}

TEST_F(JournalTest, WhatIsBehindADamagedLineIsKeptAndTold) {
    for (int i = 0; i < 10; ++i) add_box({0.1 * i, 1, 0});
    session_.reset();
    const fs::path file = files().at(0);
    std::string text = content_of(file);
    const std::size_t end = text.rfind('\n', text.size() - 2);
    text[text.rfind('\n', end - 1) + 30] ^= 1;
    std::ofstream(file, std::ios::binary) << text;
    session_ = make();
    session_->take_events();
    run("scene.load", {{"name", run("hello")["recovered"][0]["name"]}});
    EXPECT_EQ(session_->document().entities.size(), 9u);
    bool is_told = false;
    for (const json& event : session_->take_events().messages)
        is_told = is_told || event.value("text", "").find("1 edits behind a damaged line") != std::string::npos;
    EXPECT_TRUE(is_told);
    EXPECT_EQ(content_of(file.string() + ".damaged"), text);
    // It does not come up again by itself.
    EXPECT_EQ(run("hello")["recovered"].size(), 0u);
}

TEST_F(JournalTest, TwoProgramsInOneFolderKeepAJournalEach) {
    const std::unique_ptr<Session> first = std::move(session_);
    session_ = make();
    const json box = {{"entity", {{"shape", {{"type", "sphere"}, {"radius", 0.2}}}}}};
    ASSERT_TRUE(first->execute("entity.add", box).ok());
    ASSERT_TRUE(session_->execute("entity.add", box).ok());
    EXPECT_EQ(files().size(), 2u);
    EXPECT_TRUE(run("hello")["recovered"].empty()) << "both are in use";
}

TEST_F(JournalTest, ForeignFilesInTheFolderAreLeftOut) {
    fs::create_directories(folder());
    ASSERT_EQ(mkfifo((folder() / "pipe.journal").c_str(), 0600), 0);
    for (const char* head : {R"({"embody_journal": "one"})", R"({"embody_journal": 1, "edits": "many"})", "[]", ""})
        std::ofstream(folder() / (std::to_string(std::string(head).size()) + ".journal")) << head << "\n";
    EXPECT_EQ(run("hello")["recovered"], json::array());
    add_box({0, 1, 0});
    EXPECT_EQ(run("hello")["kept"], true);
}

TEST_F(JournalTest, IsARecoveryOnceItsSessionHasEnded) {
    run("scene.new", {{"name", "Flat"}});
    add_box({0, 1, 0});
    add_box({1, 1, 0});
    const json edited = document();
    EXPECT_EQ(run("hello")["recovered"], json::array()) << "it is in use";
    session_.reset();
    session_ = make();
    const json recovered = run("hello")["recovered"];
    ASSERT_EQ(recovered.size(), 1u);
    EXPECT_EQ(recovered[0]["title"], "Flat");
    EXPECT_EQ(recovered[0]["edits"], 2);
    EXPECT_EQ(recovered[0]["scene"], "") << "it was never saved";
    EXPECT_EQ(recovered[0]["modified"].get<std::string>().size(), std::string("2026-11-24T03:10:00Z").size());
    EXPECT_EQ(run("scene.list")["scenes"], recovered);

    // Opened it is unsaved work of this session, kept in a new journal.
    run("scene.load", {{"name", recovered[0]["name"]}});
    EXPECT_EQ(document(), edited);
    EXPECT_EQ(run("hello")["unsaved"], true);
    EXPECT_EQ(kept(), edited);
    session_.reset();
    session_ = make();
    const json again = run("hello")["recovered"];
    ASSERT_EQ(again.size(), 1u);
    run("scene.discard", {{"name", again[0]["name"]}});
    EXPECT_TRUE(files().empty());
    EXPECT_NE(error_of("scene.discard", {{"name", again[0]["name"]}}).find("there is no recovered scene"),
              std::string::npos);
    EXPECT_NE(error_of("scene.discard", {{"name", "autosave/../kept"}}).find("there is no recovered scene"),
              std::string::npos);
}

TEST_F(JournalTest, UnsavedWorkSurvivesThatAnotherSceneIsOpened) {
    run("scene.new", {{"name", "One"}});
    add_box({0, 1, 0});
    const json one = document();
    run("scene.new", {{"name", "Two"}});
    EXPECT_EQ(run("hello")["recovered"].size(), 1u);
    run("scene.load", {{"name", run("hello")["recovered"][0]["name"]}});
    EXPECT_EQ(document(), one);
}

TEST_F(JournalTest, GoesWithASaveAndWithTheUndoOfTheLastEdit) {
    add_box({0, 1, 0});
    EXPECT_EQ(files().size(), 1u);
    run("edit.undo");
    EXPECT_TRUE(files().empty()) << "nothing is unsaved";
    run("edit.redo");
    EXPECT_EQ(kept(), document());
    run("scene.save", {{"name", "kept"}});
    EXPECT_TRUE(files().empty());
    add_box({1, 1, 0});
    EXPECT_EQ(kept(), document());
}

TEST_F(JournalTest, StaysShortThroughDragsThatDoNotEnd) {
    const EntityIndex box = add_box({0, 1, 0});
    std::uintmax_t largest = 0;
    for (int i = 0; i < 20'000; ++i) {
        run("entity.transform", {{"merge", "drag"}, {"poses", {{{"index", box}, {"position", {0.001 * i, 1, 0}}}}}});
        if (i % 20 != 0) continue;
        largest = std::max(largest, fs::file_size(files().at(0)));
        // People are slower than disks.
        wait_until([&] { return fs::file_size(files().at(0)) < (1u << 20); });
    }
    EXPECT_GT(largest, (1u << 20) - (1u << 16)) << "the drag must outgrow the document";
    EXPECT_LT(largest, (1u << 20) + (1u << 16));
    EXPECT_EQ(kept(), document());
    session_.reset();
    EXPECT_EQ(list_recoveries(folder()).at(0).edits, 20'001u);
}

// A disk that is busy takes a second for a sync, in which nobody's edit may wait.
TEST_F(JournalTest, NoEditWaitsForTheDisk) {
    const int before = syncs_of_tests;
    const EntityIndex box = add_box({0, 1, 0});
    bool has_grown = false, has_shrunk = false;
    for (int i = 0; i < 20'000 && !has_shrunk; ++i) {
        run("entity.transform", {{"poses", {{{"index", box}, {"position", {0.001 * i, 1, 0}}}}}});
        if (i % 100 != 0) continue;
        const std::uintmax_t size = fs::file_size(files().at(0));
        has_shrunk = has_grown && size < (1u << 20);
        has_grown = size > (1u << 20);
        if (has_grown) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (i % 1000 == 0) {
            ASSERT_EQ(kept(), document()) << "edit " << i;
        }
    }
    EXPECT_TRUE(has_shrunk) << "the document must be written anew";
    EXPECT_EQ(syncs_of_tests - before, 0);
    EXPECT_EQ(kept(), document());
}

// While the document is being written anew its journal may go, or be torn.
TEST_F(JournalTest, WhatIsWrittenAnewTooLateStaysAway) {
    const EntityIndex box = add_box({0, 1, 0});
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 7'000; ++i)
            run("entity.transform", {{"poses", {{{"index", box}, {"position", {0.001 * i, 1, 1.0 * round}}}}}});
        run("scene.save", {{"name", "Kept"}});
        EXPECT_TRUE(files().empty());
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_TRUE(files().empty());
    }
}

TEST_F(JournalTest, AFolderThatCannotBeWrittenIsToldOnceAndEditsGoOn) {
    fs::create_directories(folder_ / "saved");
    std::ofstream(folder_ / "saved" / "autosave") << "a file is where the folder should be";
    session_->take_events();
    add_box({0, 1, 0});
    add_box({1, 1, 0});
    std::size_t told = 0;
    for (const json& event : session_->take_events().messages) told += event["event"] == "message" ? 1 : 0;
    EXPECT_EQ(told, 1u);
    EXPECT_EQ(session_->document().entities.size(), 3u);

    // Once it can be written again, everything is kept.
    fs::remove(folder_ / "saved" / "autosave");
    add_box({2, 1, 0});
    EXPECT_EQ(kept(), document());
}

TEST_F(JournalTest, OnlyTheNewestFiftyRecoveriesAreKept) {
    for (int i = 0; i < 53; ++i) {
        run("scene.new", {{"name", "Scene " + std::to_string(i)}});
        add_box({0, 1, 0});
        // Files of one second are ordered by their names, which do not tell what came first.
        const std::vector<fs::path> all = files();
        const fs::path file = *std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
            return fs::last_write_time(a) < fs::last_write_time(b);
        });
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1000 - i));
    }
    session_.reset();
    const std::vector<Recovery> left = list_recoveries(folder());
    EXPECT_EQ(left.size(), 51u) << "fifty, and the one of the session that has ended";
    EXPECT_TRUE(std::none_of(left.begin(), left.end(), [](const Recovery& one) { return one.title == "Scene 0"; }));
    EXPECT_TRUE(std::any_of(left.begin(), left.end(), [](const Recovery& one) { return one.title == "Scene 52"; }));
}

TEST_F(JournalTest, AutosavesOfEarlierVersionsAreOffered) {
    fs::create_directories(folder());
    ASSERT_TRUE(save_document(new_document("Old"), folder() / "Old%3A work.json").ok());
    const json recovered = run("hello")["recovered"];
    ASSERT_EQ(recovered.size(), 1u);
    EXPECT_EQ(recovered[0]["name"], "autosave/Old: work");
    run("scene.load", {{"name", recovered[0]["name"]}});
    EXPECT_EQ(document()["title"], "Old");
    EXPECT_EQ(files().size(), 1u) << "it is in a journal now";
}

}  // namespace
}  // namespace embody::scene
