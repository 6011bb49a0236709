// SPDX-License-Identifier: MIT
#include "interchange/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "interchange/archive/archive.h"
#include "interchange/file_source.h"
#include "interchange/scratch_files.h"

namespace embody::interchange {
namespace {

using test::ScratchFolder;

constexpr std::uint64_t no_limit = ~std::uint64_t{0};

TEST(RegularFile, RefusesWhatIsNoFile) {
    const ScratchFolder scratch;
    const auto pipe = scratch.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(RegularFile::open(pipe, no_limit).error().why, "is no regular file");  // does not wait for a writer
    EXPECT_EQ(RegularFile::open("/dev/zero", no_limit).error().why, "is no regular file");
    EXPECT_EQ(RegularFile::open(scratch.path(), no_limit).error().why, "is no regular file");
    EXPECT_FALSE(RegularFile::open(scratch.path() / "missing", no_limit));
    EXPECT_FALSE(RegularFile::open("", no_limit));
}

TEST(RegularFile, FollowsNoLinkOnItsWay) {
    const ScratchFolder scratch;
    const auto file = scratch.write("real/file.txt", "text");
    std::filesystem::create_symlink("file.txt", scratch.path() / "real/link.txt");
    std::filesystem::create_directory_symlink("real", scratch.path() / "folder");
    EXPECT_EQ(RegularFile::open(scratch.path() / "real/link.txt", no_limit).error().why, "is a symbolic link");
    EXPECT_FALSE(RegularFile::open(scratch.path() / "folder/file.txt", no_limit));
    auto opened = RegularFile::open(file, no_limit);
    ASSERT_TRUE(opened) << opened.error().message();
    EXPECT_EQ(opened->read_all()->size(), 4u);
}

TEST(RegularFile, NamesTheLimit) {
    const ScratchFolder scratch;
    const auto file = scratch.write("file", std::string(3000, 'x'));
    EXPECT_EQ(RegularFile::open(file, 2048).error().why, "is larger than the limit of 2 KiB");
    EXPECT_TRUE(RegularFile::open(file, 3000));
}

TEST(RegularFile, ArchivesAndFoldersReadNothingElse) {
    const ScratchFolder scratch;
    const auto zip = scratch.write_zip("a.zip", {{"m.obj", "v"}});
    std::filesystem::create_symlink("a.zip", scratch.path() / "link.zip");
    EXPECT_TRUE(Archive::open(zip));
    EXPECT_FALSE(Archive::open(scratch.path() / "link.zip"));

    ASSERT_EQ(mkfifo((scratch.path() / "folder.png").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", scratch.path() / "zero.png");
    const FolderSource source(scratch.path());
    EXPECT_FALSE(source.read("folder.png"));
    EXPECT_FALSE(source.read("zero.png"));
    EXPECT_TRUE(source.read("link.zip"));  // a link that stays inside
}

}  // namespace
}  // namespace embody::interchange
