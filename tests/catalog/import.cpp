// SPDX-License-Identifier: MIT
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "catalog/import_fixture.h"
#include "end_child.h"

namespace embody::catalog {
namespace {

TEST_F(ImportTest, NamesEachPathThatCannotBeImportedAndGoesOn) {
    write_model("a.obj", "aaa");
    write_model("b.obj", "broken");
    write_model("letter.txt", "Dear reader");
    write_file(folder_ / "fake.sh3f", "no zip");
    std::filesystem::create_directories(folder_ / "empty");
    const auto report = import(
        {folder_ / "missing.obj", models() / "letter.txt", folder_ / "fake.sh3f", folder_ / "empty", models(), ""});
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->added, 1u);
    ASSERT_EQ(report->failures.size(), 6u);
    for (const ImportFailure& failure : report->failures) {
        EXPECT_FALSE(failure.error.why.empty());
        EXPECT_EQ(failure.error.message().find('\n'), std::string::npos);
    }
    EXPECT_NE(report->failures[0].error.message().find("missing.obj"), std::string::npos);
    EXPECT_EQ(report->failures.back().path, (models() / "b.obj").string());
    EXPECT_EQ(report->failures.back().error.why, "is broken");
}

TEST_F(ImportTest, AnUnreadableDatabaseEndsTheImport) {
    write_model("a.obj", "aaa");
    write_file(database(), std::string(4096, 'x'));
    EXPECT_FALSE(import());
}

TEST_F(ImportTest, FailsWhereNoWorkerCanBeStarted) {
    write_model("a.obj", "aaa");
    const auto report = import({models()}, {}, [](const auto&, const auto&) {
        return Error{"worker", "is missing", {}};
    });
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().why, "is missing");
}

TEST_F(ImportTest, WantedModelsComeFirst) {
    for (const char letter : std::string("abcdef"))
        write_model(std::string(1, letter) + ".obj", std::string(3, letter));
    std::vector<std::string> names;
    const PrepareModels prepare = [&](const std::vector<ImportItem>& items, const auto& done) {
        // Models that may be in another unit are prepared once more; the order is that of the first time.
        if (names.empty())
            for (const ImportItem& item : items) names.push_back(item.name);
        return prepare_boxes(items, done);
    };
    const auto all = import({models()}, {}, prepare);
    ASSERT_TRUE(all);
    EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c", "d", "e", "f"}));
    names.clear();
    ASSERT_TRUE(import({models()}, {.again = true, .wanted = {all->keys.at(4), all->keys.at(2)}}, prepare));
    EXPECT_EQ(names, (std::vector<std::string>{"c", "e", "a", "b", "d", "f"}));
}

TEST_F(ImportTest, AFullDiskIsReportedAndWhatWasStoredStays) {
    for (int i = 0; i < 200; ++i) write_model("q" + std::to_string(i) + ".obj", std::string(200 + i, 'x'));
    auto taxonomy = attributes::Taxonomy::load(taxonomy_folder);
    auto connection = database::open_model_database(database());
    ASSERT_TRUE(taxonomy && connection);
    ASSERT_TRUE((*connection)->execute("PRAGMA max_page_count = 120"));
    const auto report = Importer(**connection, **taxonomy, prepare_boxes).run({models()}, {});
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().why.find("no space"), std::string::npos) << report.error().message();
    const std::int64_t stored = stored_models();
    EXPECT_GT(stored, 0);
    EXPECT_LT(stored, 200);
    EXPECT_TRUE((*connection)->check_integrity());
}

TEST_F(ImportTest, TheSameFileTwiceIsNotTwoModels) {
    write_model("a.obj", "aaa");
    write_model("copy of a.obj", "aaa");
    const auto first = import();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->added, 1u);
    EXPECT_EQ(first->unchanged, 1u);

    write_model("elsewhere/again.obj", "aaa");
    const auto second = import({models(), models() / "a.obj"});
    ASSERT_TRUE(second);
    EXPECT_EQ(second->added + second->updated, 0u);
    EXPECT_EQ(second->unchanged, 4u);
    EXPECT_EQ(second->keys, std::vector<std::string>(4, first->keys.at(0)));
    EXPECT_EQ(stored_models(), 1);
}

TEST_F(ImportTest, AChangedFileGoesOnBeingTheSameModel) {
    write_model("chair.obj", std::string(80, 'x'));
    ASSERT_TRUE(import());
    const auto catalog = open();
    const ModelSummary before = *catalog->model("chair");
    write_model("chair.obj", std::string(90, 'x'));
    const auto report = import();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->updated, 1u);
    const ModelSummary after = *catalog->model("chair");
    EXPECT_EQ(after.key, before.key);
    EXPECT_EQ(after.id, before.id);
    EXPECT_NE(after.content_hash, before.content_hash);

    // The old content again: it is not taken for stored.
    write_model("chair.obj", std::string(80, 'x'));
    EXPECT_EQ(import()->updated, 1u);
    EXPECT_EQ(catalog->model("chair")->content_hash, before.content_hash);
    EXPECT_EQ(stored_models(), 1);
}

TEST_F(ImportTest, OfTwoEqualFilesAChangedOneBecomesAModelOfItsOwn) {
    write_model("a.obj", std::string(80, 'x'));
    write_model("b.obj", std::string(80, 'x'));
    ASSERT_TRUE(import());
    ASSERT_TRUE(import());  // now both places are known
    write_model("b.obj", std::string(90, 'x'));
    EXPECT_EQ(import()->added, 1u);
    EXPECT_EQ(import()->unchanged, 2u);
    EXPECT_EQ(stored_models(), 2);
}

TEST_F(ImportTest, TheOptionAgainPreparesUnchangedFiles) {
    write_model("a.obj", "aaa");
    ASSERT_TRUE(import());
    const auto report = import({models()}, {.again = true});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->updated, 1u);
}

// Found by tools/soak.sh: each import put the full-text index two levels higher, and SQLite 3.40 takes one of 2000
// levels for damaged. The number of levels follows four bytes at the start of FTS5's structure record.
TEST_F(ImportTest, ManyImportsLeaveTheIndexOfWordsFlat) {
    const auto connection = database::open_model_database(database());
    ASSERT_TRUE(connection);
    for (int i = 0; i < 30; ++i) {
        const std::string name = "m" + std::to_string(i) + ".obj";
        write_model(name, std::string(static_cast<std::size_t>(i) + 1, 'a'));
        const auto report = import();
        ASSERT_TRUE(report) << "import " << i << ": " << report.error().message();
        ASSERT_EQ(report->added, 1u);
        std::filesystem::remove(models() / name);
        if (i > 0) continue;

        // A small index does not grow in levels.
        std::string words;
        for (int k = 0; k < 3000; ++k) words += "tag" + std::to_string(k) + "\n";
        ASSERT_TRUE((*connection)->execute("UPDATE model SET tags = '" + words + "'"));
    }
    const auto levels = (*connection)
                            ->query_integer(
                                "SELECT instr('0123456789ABCDEF', substr(hex(block), 9, 1)) * 16 + "
                                "instr('0123456789ABCDEF', substr(hex(block), 10, 1)) - 17"
                                " FROM model_words_data WHERE id = 10");
    ASSERT_TRUE(levels) << levels.error().message();
    EXPECT_GE(*levels, 1);
    EXPECT_LE(*levels, 10);
}

TEST_F(ImportTest, StopsWhenAskedAndGoesOnNextTime) {
    for (int i = 0; i < 10; ++i) write_model("q" + std::to_string(i) + ".obj", std::string(10 + i, 'x'));
    std::size_t last_done = 0;
    const auto stopped = import({models()}, {.progress = [&](const ImportProgress& progress) {
                                    EXPECT_EQ(progress.total, progress.done == 0 ? progress.total : 10u);
                                    EXPECT_LE(progress.done, last_done + 1);
                                    last_done = progress.done;
                                    return progress.done < 4;
                                }});
    ASSERT_TRUE(stopped);
    EXPECT_TRUE(stopped->stopped);
    EXPECT_EQ(stopped->added, 4u);
    EXPECT_EQ(last_done, 4u);
    const auto rest = import();
    EXPECT_EQ(rest->added, 6u);
    EXPECT_EQ(rest->unchanged, 4u);
    EXPECT_FALSE(rest->stopped);
}

TEST_F(ImportTest, ASparseFileOfATebibyteIsRefusedBeforeItIsRead) {
    write_model("small.obj", "aaa");
    for (const char* name : {"huge.obj", "huge.zip"}) {
        write_model(name, "");
        std::error_code problem;
        std::filesystem::resize_file(models() / name, std::uintmax_t{1} << 40, problem);
        if (problem) GTEST_SKIP() << "no files of 1 TiB here: " << problem.message();
    }
    const auto report = import();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->added, 1u);
    ASSERT_EQ(report->failures.size(), 2u);
    for (const ImportFailure& failure : report->failures) {
        const std::string limit = failure.path.ends_with(".obj") ? "512 MiB" : "16 GiB";
        EXPECT_EQ(failure.error.why, "is larger than the limit of " + limit);
        EXPECT_FALSE(failure.error.remedy.empty());
    }
}

TEST_F(ImportTest, StopsWhileAFileIsReadForChanges) {
    write_model("large.obj", "");
    std::filesystem::resize_file(models() / "large.obj", std::uintmax_t{256} << 20);
    std::string last;
    const auto report = import({models()}, {.progress = [&](const ImportProgress& progress) {
                                   last = progress.current;
                                   return last.find("read to 3 %") == std::string::npos;
                               }});
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_TRUE(report->stopped);
    EXPECT_EQ(last, "large.obj, read to 3 %");
    EXPECT_EQ(stored_models(), 0);
}

TEST_F(ImportTest, LinksThatLeaveTheFolderAreNotFollowed) {
    namespace fs = std::filesystem;
    write_model("a.obj", "aaa");
    write_model("hidden.bin", "inside but of no kind");
    write_file(folder_ / "secret.obj", "secret");
    write_file(folder_ / "outside" / "b.obj", "bbbb");
    fs::create_symlink(folder_ / "secret.obj", models() / "leaves.obj");
    fs::create_symlink(folder_ / "missing.zip", models() / "dangling.zip");
    fs::create_symlink("/dev/zero", models() / "endless.obj");
    fs::create_symlink(folder_ / "outside", models() / "elsewhere");
    fs::create_symlink("a.obj", models() / "stays.obj");
    fs::create_symlink("hidden.bin", models() / "disguised.obj");
    ASSERT_EQ(mkfifo((models() / "pipe.obj").c_str(), 0600), 0);
    const auto report = import();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->added, 1u);
    EXPECT_EQ(report->unchanged, 0u);
    ASSERT_EQ(report->failures.size(), 1u);
    EXPECT_EQ(report->failures[0].path, (models() / "leaves.obj").string());
    EXPECT_EQ(report->failures[0].error.why, "is a symbolic link that leaves the imported folder");
    // A link that a person names is followed.
    EXPECT_EQ(import({models() / "leaves.obj"})->added, 1u);
}

TEST_F(ImportTest, AKillLosesNothingThatWasDone) {
    for (int i = 0; i < 40; ++i) write_model("q" + std::to_string(i) + ".obj", std::string(10 + i, 'x'));
    std::int64_t stored = 0;
    for (const std::size_t last : {7u, 21u}) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            // Is killed while it works on a model, during any operation of the database.
            std::size_t count = 0;
            (void)import({models()}, {}, [&](const auto& items, const auto& done) -> Result<void> {
                for (std::size_t i = 0; i < items.size(); ++i) {
                    if (count++ == last) kill(getpid(), SIGKILL);
                    if (!done(i, prepare_box(items[i]))) break;
                }
                return {};
            });
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
        stored += static_cast<std::int64_t>(last);
        EXPECT_EQ(stored_models(), stored);
        auto connection = database::open_model_database(database());
        ASSERT_TRUE(connection);
        EXPECT_TRUE((*connection)->check_integrity());
    }
    const auto report = import();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->added, 12u);
    EXPECT_EQ(report->unchanged, 28u);
    EXPECT_EQ(stored_models(), 40);
}

TEST_F(ImportTest, AKillAtAnyMomentLeavesAWholeDatabase) {
    for (int i = 0; i < 60; ++i) write_model("q" + std::to_string(i) + ".obj", std::string(10 + i, 'x'));
    for (int round = 0; round < 12; ++round) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            (void)import({models()}, {.again = true});
            _exit(0);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(15 + 17 * round));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        auto connection = database::open_model_database(database());
        ASSERT_TRUE(connection) << connection.error().message();
        const auto whole = (*connection)->check_integrity();
        ASSERT_TRUE(whole) << whole.error().message();
    }
    ASSERT_TRUE(import());
    EXPECT_EQ(stored_models(), 60);
}

TEST_F(ImportTest, TwoImportsAtOnceMakeEachModelOnceWhileOthersRead) {
    for (int i = 0; i < 60; ++i) write_model("chair" + std::to_string(i) + ".obj", std::string(10 + i, 'x'));
    { ASSERT_TRUE(open()); }
    std::vector<pid_t> children;
    for (int i = 0; i < 2; ++i) {
        children.push_back(fork());
        ASSERT_GE(children.back(), 0);
        if (children.back() == 0) {
            const auto report = import();
            test::end_child(report && report->failures.empty() ? 0 : 1);
        }
    }
    // Two readers see a growing, always consistent catalogue and are never refused.
    std::atomic<bool> importing = true;
    std::atomic<int> refused = 0, shrunk = 0;
    const auto read = [&] {
        const auto catalog = Catalog::open(database(), taxonomy_folder);
        if (!catalog) {
            ++refused;
            return;
        }
        std::int64_t seen = 0;
        while (importing) {
            const auto page = (*catalog)->search({.words = "chair", .limit = 1000});
            if (!page) ++refused;
            if (page && page->total < seen) ++shrunk;
            if (page) seen = page->total;
            for (const ModelSummary& model : page ? page->models : std::vector<ModelSummary>()) {
                if (!(*catalog)->geometry_glb(model.id)) ++refused;
            }
        }
    };
    std::thread first(read), second(read);
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    importing = false;
    first.join();
    second.join();
    EXPECT_EQ(refused, 0);
    EXPECT_EQ(shrunk, 0);
    EXPECT_EQ(stored_models(), 60);
}

}  // namespace
}  // namespace embody::catalog
