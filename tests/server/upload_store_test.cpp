// SPDX-License-Identifier: MIT
#include "server/upload_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "database/temporary_folder.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;

class UploadStoreTest : public testing::Test {
protected:
    [[nodiscard]] fs::path uploads() const { return folder_ / "models.sqlite-uploads"; }

    test::TemporaryFolder folder_;
};

TEST_F(UploadStoreTest, AFileHasItsNameAndIsRemovedWithItsObject) {
    auto store = UploadStore::open(uploads());
    ASSERT_TRUE(store.ok()) << store.error().message();
    auto upload = (*store)->begin("chair.glb");
    ASSERT_TRUE(upload.ok()) << upload.error().message();
    const std::string text = "glTF";
    EXPECT_TRUE((*upload)->write(text).ok());
    EXPECT_TRUE((*upload)->write(text).ok());
    EXPECT_TRUE((*upload)->finish().ok());
    const fs::path file = (*upload)->file();
    EXPECT_EQ(file.filename(), "chair.glb");
    EXPECT_EQ(fs::file_size(file), 8u);
    *upload = nullptr;
    EXPECT_FALSE(fs::exists(file));
    *store = nullptr;
    EXPECT_FALSE(fs::exists(uploads())) << "nothing is left";
}

TEST_F(UploadStoreTest, TooManyAreRefusedUntilOneIsDone) {
    auto store = *UploadStore::open(uploads());
    std::vector<std::shared_ptr<Upload>> held;
    for (std::size_t i = 0; i < most_uploads; ++i) held.push_back(*store->begin("same.glb"));
    const auto refused = store->begin("same.glb");
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().why.find("8 other files"), std::string::npos);
    held.pop_back();
    EXPECT_TRUE(store->begin("same.glb").ok());
}

TEST_F(UploadStoreTest, NamesThatNoFileCanHaveAreRefused) {
    auto store = *UploadStore::open(uploads());
    EXPECT_FALSE(store->begin(std::string(300, 'n')).ok());
    EXPECT_TRUE(store->begin("short.glb").ok()) << "the refused one has no place";
}

TEST_F(UploadStoreTest, OpeningRemovesWhatAKilledProcessLeftAndNothingElse) {
    fs::create_directories(uploads() / "holiday");
    std::ofstream(uploads() / "holiday" / "picture.png") << "not ours";
    auto living = *UploadStore::open(uploads());
    auto kept = *living->begin("kept.glb");
    const pid_t child = fork();
    if (child == 0) {
        // Leave the store as a killed process does: without a destructor.
        const auto store = UploadStore::open(uploads());
        const bool began = store.ok() && (*store)->begin("left.glb").ok();
        static std::vector<std::shared_ptr<Upload>> leaked;
        if (began) leaked.push_back(*(*store)->begin("left.glb"));
        _exit(began ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    const auto count = [&](const char* name) {
        return std::count_if(fs::recursive_directory_iterator(uploads()), fs::recursive_directory_iterator(),
                             [&](const fs::directory_entry& entry) { return entry.path().filename() == name; });
    };
    ASSERT_EQ(count("left.glb"), 1);
    auto next = UploadStore::open(uploads());
    ASSERT_TRUE(next.ok()) << next.error().message();
    EXPECT_EQ(count("left.glb"), 0);
    EXPECT_EQ(count("kept.glb"), 1) << "another server's, which is running";
    EXPECT_EQ(count("picture.png"), 1);
}

}  // namespace
}  // namespace embody::server
