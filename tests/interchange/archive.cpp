// SPDX-License-Identifier: MIT
#include "interchange/archive/archive.h"

#include <gtest/gtest.h>

#include <random>

#include "interchange/file_source.h"
#include "interchange/scratch_files.h"
#include "interchange/utf8.h"

namespace embody::interchange {
namespace {

using test::ScratchFolder;

TEST(Archive, RefusesWhatIsNoArchive) {
    const ScratchFolder scratch;
    EXPECT_FALSE(Archive::open(scratch.path() / "missing.zip"));
    EXPECT_FALSE(Archive::open(scratch.path()));
    EXPECT_FALSE(Archive::open(scratch.write("empty.zip", "")));
    EXPECT_FALSE(Archive::open(scratch.write("text.zip", "this is a text, not a zip archive at all")));
}

TEST(Archive, SurvivesTruncationAtEveryLength) {
    const ScratchFolder scratch;
    const auto whole = scratch.write_zip("whole.zip", {{"a.txt", std::string(300, 'a')}, {"b/c.txt", "hello"}});
    std::ifstream stream(whole, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const auto archive = Archive::open(scratch.write("cut.zip", bytes.substr(0, length)));
        // Where the central directory is still found, members must be refused or complete.
        if (!archive) continue;
        const auto read = archive->read("b/c.txt");
        if (read) {
            EXPECT_EQ(std::string(read->begin(), read->end()), "hello");
        }
    }
}

TEST(Archive, SurvivesDamagedBytes) {
    const ScratchFolder scratch;
    const auto whole = scratch.write_zip("whole.zip", {{"a.txt", std::string(300, 'a')}, {"b/c.txt", "hello"}});
    std::ifstream stream(whole, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    std::mt19937 random(7);
    for (int trial = 0; trial < 300; ++trial) {
        std::string damaged = bytes;
        for (int k = 0; k < 4; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
        const auto archive = Archive::open(scratch.write("damaged.zip", damaged));
        if (!archive) continue;
        for (const ArchiveMember& member : archive->members()) {
            const auto read = archive->read(member.path, 1 << 20);
            if (read) {
                EXPECT_LE(read->size(), std::size_t{1} << 20);
            }
        }
    }
}

TEST(Archive, StopsUnpackingABomb) {
    const ScratchFolder scratch;
    const auto bomb = scratch.write_zip("bomb.zip", {{"zeros", std::string(50'000'000, '\0')}});
    EXPECT_LT(std::filesystem::file_size(bomb), 100'000u);
    const auto archive = Archive::open(bomb);
    ASSERT_TRUE(archive);
    const auto read = archive->read("zeros", 1'000'000);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().why.find("more than 1000000 bytes"), std::string::npos) << read.error().message();
}

TEST(Archive, LeavesOutNamesThatLeadOutside) {
    const ScratchFolder scratch;
    const auto file = scratch.write_zip(
        "evil.zip", {{"../../etc/passwd", "x"}, {"a/../../b", "x"}, {"C:\\x", "x"}, {"a/../c", "inside"}});
    const auto archive = Archive::open(file);
    ASSERT_TRUE(archive);
    ASSERT_EQ(archive->members().size(), 1u);
    EXPECT_EQ(archive->members()[0].path, "c");
    EXPECT_FALSE(archive->read("../../etc/passwd"));
}

TEST(Archive, FindsMembersInAnyOrderAndCase) {
    const ScratchFolder scratch;
    const auto archive =
        Archive::open(scratch.write_zip("some.zip", {{"Dir/One.OBJ", "1"}, {"dir/two", "22"}, {"three", ""}}));
    ASSERT_TRUE(archive);
    EXPECT_EQ(archive->find("/dir/one.obj"), "Dir/One.OBJ");
    EXPECT_EQ(archive->read("dir/two")->size(), 2u);
    EXPECT_EQ(archive->read("dir/one.obj")->size(), 1u);
    EXPECT_EQ(archive->read("three")->size(), 0u);
    EXPECT_TRUE(archive->find("four").empty());
}

TEST(Archive, NamesOfOldProgramsAreFoundAsTheyAreListed) {
    const ScratchFolder scratch;
    // "Möbel/Stühle.obj" by code page 437, as UTF-8, and bytes that are valid in neither.
    const std::vector<std::string> stored{
        "M\x94"
        "bel/St\x81hle.obj",
        "Größe.obj", "\xff\xfe.obj"};
    const auto archive =
        Archive::open(scratch.write_zip("old.zip", {{stored[0], "1"}, {stored[1], "22"}, {stored[2], ""}}));
    ASSERT_TRUE(archive) << archive.error().message();
    ASSERT_EQ(archive->members().size(), 3u);
    EXPECT_EQ(archive->members()[0].path, "Möbel/Stühle.obj");
    EXPECT_EQ(archive->members()[1].path, "Größe.obj");
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string& listed = archive->members()[i].path;
        EXPECT_TRUE(is_utf8(listed)) << listed;
        EXPECT_EQ(archive->find(listed), listed);
        EXPECT_EQ(archive->find(stored[i]), listed);  // by the name that another member of the same archive uses
        EXPECT_TRUE(archive->read(listed));
    }
}

TEST(Utf8, TellsWhatIsWellFormed) {
    for (const char* good : {"", "abc", "\u00e4\u20ac", "\U0001F600", "\xf4\x8f\xbf\xbf"})
        EXPECT_TRUE(is_utf8(good)) << good;
    for (const char* bad :
         {"\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "a\xff"})
        EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(FolderSource, ReachesNothingOutside) {
    const ScratchFolder scratch;
    scratch.write("secret.txt", "secret");
    scratch.write("inside/file.txt", "fine");
    std::filesystem::create_symlink(scratch.path() / "secret.txt", scratch.path() / "inside/link.txt");
    const FolderSource source(scratch.path() / "inside");
    EXPECT_TRUE(source.read("file.txt"));
    EXPECT_TRUE(source.read("FILE.TXT"));
    EXPECT_FALSE(source.read("../secret.txt"));
    EXPECT_FALSE(source.read((scratch.path() / "secret.txt").string()));
    EXPECT_FALSE(source.read("link.txt"));
    EXPECT_FALSE(source.read("."));
    EXPECT_FALSE(source.read(""));
}

}  // namespace
}  // namespace embody::interchange
