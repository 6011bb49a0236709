// SPDX-License-Identifier: MIT
#include "interchange/sweethome/sweethome_catalogue.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "interchange/scratch_files.h"
#include "interchange/sweethome/properties_file.h"

namespace embody::interchange {
namespace {

using test::ScratchFolder;

TEST(PropertiesFile, FollowsJavasRules) {
    const auto read = parse_properties(
        "# comment = no\n! neither = no\n\n  key = value \nother:1\nthird word\nempty=\nlonely\n"
        "long=a,\\\n     b,\\\r\n  c\npath=C\\:\\\\x\nuni=\\u00e9\\u20AC\\uD83D\\uDE00\nlatin=\xE9\na\\ "
        "b=c\nkey=again\nodd=\\uZZ\nlast=\\");
    EXPECT_EQ(read.at("key"), "again");
    EXPECT_EQ(read.at("other"), "1");
    EXPECT_EQ(read.at("third"), "word");
    EXPECT_EQ(read.at("empty"), "");
    EXPECT_EQ(read.at("lonely"), "");
    EXPECT_EQ(read.at("long"), "a,b,c");
    EXPECT_EQ(read.at("path"), "C:\\x");
    EXPECT_EQ(read.at("uni"), "é€😀");
    EXPECT_EQ(read.at("latin"), "é");
    EXPECT_EQ(read.at("a b"), "c");
    EXPECT_EQ(read.at("odd"), "uZZ");
    EXPECT_EQ(read.at("last"), "");
    EXPECT_FALSE(read.contains("# comment"));
}

TEST(SweethomeCatalogue, RefusesArchivesWithoutAList) {
    const ScratchFolder scratch;
    EXPECT_FALSE(read_sweethome_catalogue(scratch.write("broken.sh3f", "PK no")));
    const auto empty = read_sweethome_catalogue(scratch.write_zip("other.jar", {{"readme", "hello"}}));
    ASSERT_FALSE(empty);
    EXPECT_NE(empty.error().why.find("no Sweet Home 3D"), std::string::npos);
}

TEST(SweethomeCatalogue, LeavesOutImpossiblePieces) {
    const ScratchFolder scratch;
    const std::string list =
        "name#1=No size\nmodel#1=/m.obj\n"
        "name#2=No model\nwidth#2=1\ndepth#2=1\nheight#2=1\n"
        "name#3=Not there\nmodel#3=/n.obj\nwidth#3=1\ndepth#3=1\nheight#3=1\n"
        "name#4=Outside\nmodel#4=/../m.obj\nwidth#4=1\ndepth#4=1\nheight#4=1\n"
        "name#5=Negative\nmodel#5=/m.obj\nwidth#5=-1\ndepth#5=1\nheight#5=1\n"
        "name#6=No number\nmodel#6=/m.obj\nwidth#6=nan\ndepth#6=1\nheight#6=1\n"
        "name#7=Sheared\nmodel#7=/m.obj\nwidth#7=1\ndepth#7=1\nheight#7=1\nmodelRotation#7=9 0 0 0 1 0 0 0 1\n";
    const auto read = read_sweethome_catalogue(
        scratch.write_zip("bad.sh3f", {{"PluginFurnitureCatalog.properties", list}, {"m.obj", ""}}));
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->pieces.empty());
    EXPECT_EQ(read->warnings.size(), 7u);
}

TEST(SweethomeCatalogue, ReadsAllOfAPiece) {
    const ScratchFolder scratch;
    const std::string list =
        "id=own\nname=Own catalogue\nlicense=CC0\nprovider=us\nversion=1.2\n"
        "id#1=own#chair\nname#1=Chair\ntags#1=Seat, Wood ,\ncategory#1=Kitchen\ncreator#1=Me\nicon#1=/c/chair.png\n"
        "model#1=/c/"
        "chair.obj\nwidth#1=40\ndepth#1=50\nheight#1=90.5\nmovable#1=false\ndoorOrWindow#1=true\nelevation#1=10\n"
        "lightSourceX#1=5\n"
        "modelRotation#1=0 0 1 0 1 0 -1 0 0\n";
    const auto read = read_sweethome_catalogue(
        scratch.write_zip("own.sh3f", {{"PluginFurnitureCatalog.properties", list}, {"c/chair.obj", "x"}}));
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->name, "Own catalogue");
    EXPECT_EQ(read->licence, "CC0");
    EXPECT_EQ(read->provider, "us");
    ASSERT_EQ(read->pieces.size(), 1u);
    const SweethomePiece& piece = read->pieces[0];
    EXPECT_EQ(piece.id, "own#chair");
    EXPECT_EQ(piece.name, "Chair");
    EXPECT_EQ(piece.tags, (std::vector<std::string>{"Seat", "Wood"}));
    EXPECT_EQ(piece.category, "Kitchen");
    EXPECT_EQ(piece.creator, "Me");
    EXPECT_EQ(piece.model_path, "c/chair.obj");
    EXPECT_EQ(piece.icon_path, "c/chair.png");
    EXPECT_EQ(piece.size, (std::array{0.4, 0.905, 0.5}));
    EXPECT_DOUBLE_EQ(piece.elevation, 0.1);
    EXPECT_EQ(piece.rotation, (std::array<double, 9>{0, 0, 1, 0, 1, 0, -1, 0, 0}));
    EXPECT_FALSE(piece.movable);
    EXPECT_TRUE(piece.door_or_window);
    EXPECT_TRUE(piece.light_source);
}

/// Pieces of all catalogues in a folder, -1 where there are none.
int pieces_in(const std::filesystem::path& folder) {
    int pieces = -1;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem)) {
        if (!is_sweethome_catalogue(entry.path())) continue;
        const auto read = read_sweethome_catalogue(entry.path());
        if (!read) continue;
        EXPECT_TRUE(read->warnings.empty()) << entry.path() << ": " << read->warnings[0];
        pieces = std::max(pieces, 0) + static_cast<int>(read->pieces.size());
    }
    return pieces;
}

TEST(SweethomeCatalogue, DebiansCataloguesHaveAllTheirPieces) {
    const int libraries = pieces_in("/usr/share/sweethome3d/furniture"), program = pieces_in("/usr/share/sweethome3d");
    if (libraries < 0 && program < 0) GTEST_SKIP() << "sweethome3d and sweethome3d-furniture are not installed";
    if (libraries >= 0) {
        EXPECT_EQ(libraries, 820);
    }
    if (program >= 0) {
        EXPECT_EQ(program, 100);
    }
}

}  // namespace
}  // namespace embody::interchange
