// SPDX-License-Identifier: MIT
// A file is written whole or stays as it was, whatever stops the writing; and nothing is left beside it.
#include "scene/file/whole_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "database/temporary_folder.h"

namespace embody::scene {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

/// Lets this process write no file longer than that, as a full disk would.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    sighandler_t handler_;
};

TEST(WholeFile, StaysAsItWasWhereTheDiskIsFull) {
    const test::TemporaryFolder folder;
    const fs::path file = folder / "scene.json";
    ASSERT_TRUE(write_whole_file(file, "before").ok());
    {
        const FileSizeLimit full(1000);
        const auto refused = write_whole_file(file, std::string(5000, 'x'));
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().where, file.string());
        EXPECT_NE(refused.error().why.find("can't be written"), std::string::npos) << refused.error().message();
        EXPECT_EQ(refused.error().remedy, "the file that was there is unchanged");
    }
    EXPECT_EQ(content_of(file), "before");
    EXPECT_EQ(files_in(folder.path()), 1) << "no draft is left";
    ASSERT_TRUE(write_whole_file(file, "after").ok());
    EXPECT_EQ(content_of(file), "after");
}

TEST(WholeFile, KeepsItsMode) {
    const test::TemporaryFolder folder;
    const fs::path file = folder / "scene.json";
    ASSERT_TRUE(write_whole_file(file, "1").ok());
    for (const mode_t mode : {0600u, 0644u, 0640u}) {
        ASSERT_EQ(chmod(file.c_str(), mode), 0);
        ASSERT_TRUE(write_whole_file(file, "2").ok());
        struct stat status {};
        ASSERT_EQ(stat(file.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 07777u, mode);
    }
}

// Folders have the names that drafts would get: they are nobody's to remove.
TEST(WholeFile, TakesTheNextNameForItsDraft) {
    const test::TemporaryFolder folder;
    const fs::path file = folder / "scene.json";
    const auto draft = [&](int number) {
        return file.string() + "." + std::to_string(getpid()) + "-" + std::to_string(number) + ".embody-draft";
    };
    constexpr int taken = 2000;  // more than one call tries, and more than all tests have written
    for (int number = 1; number <= taken; ++number) fs::create_directory(draft(number));
    const auto refused = write_whole_file(file, "text");
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().why.find("File exists"), std::string::npos) << refused.error().message();
    for (int number = 1; number <= taken; number += 7) fs::remove(draft(number));
    ASSERT_TRUE(write_whole_file(file, "text").ok());
    EXPECT_EQ(content_of(file), "text");
}

TEST(WholeFile, RemovesTheDraftsOfProgramsThatEnded) {
    const test::TemporaryFolder folder;
    const auto draft = [&](const char* name) {
        return folder / (std::string("scene.json.77-") + name + ".embody-draft");
    };
    for (const char* name : {"ended", "written"}) std::ofstream(draft(name)) << "half";
    fs::create_symlink(folder / "elsewhere", draft("link"));
    const int writer = open(draft("written").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(flock(writer, LOCK_EX | LOCK_NB), 0);
    ASSERT_TRUE(write_whole_file(folder / "scene.json", "text").ok());
    EXPECT_FALSE(fs::exists(draft("ended")));
    EXPECT_TRUE(fs::exists(draft("written"))) << "locked: somebody writes it";
    EXPECT_TRUE(fs::is_symlink(draft("link"))) << "no file";
    close(writer);
    remove_abandoned_drafts(folder.path());
    EXPECT_FALSE(fs::exists(draft("written")));
    remove_abandoned_drafts(folder / "nowhere");
}

TEST(WholeFile, RefusesWhatIsNoFileByItsName) {
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "folder");
    const auto folder_refused = write_whole_file(folder / "folder", "text");
    ASSERT_FALSE(folder_refused.ok());
    EXPECT_EQ(folder_refused.error().where, (folder / "folder").string());
    ASSERT_TRUE(write_whole_file(folder / "file", "text").ok());
    const auto below_refused = write_whole_file(folder / "file/scene.json", "text");
    ASSERT_FALSE(below_refused.ok());
    EXPECT_NE(below_refused.error().why.find("can't be made"), std::string::npos) << below_refused.error().message();
}

}  // namespace
}  // namespace embody::scene
