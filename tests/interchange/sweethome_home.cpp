// SPDX-License-Identifier: MIT
#include "interchange/sweethome/sweethome_home.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "interchange/archive/archive.h"
#include "interchange/read_model.h"
#include "interchange/scratch_files.h"

namespace embody::interchange {
namespace {

const std::string plan = R"(<?xml version='1.0'?>
<home version='6400' name='flat.sh3d' wallHeight='250.0'>
  <level id='L0' name='Ground' elevation='0.0' floorThickness='12.0' height='250.0'/>
  <level id='L1' name='Upstairs' elevation='262.0' floorThickness='12.0' height='240.0'/>
  <doorOrWindow level='L0' name='Door' x='200' y='0' width='90' depth='10' height='210' angle='0' model='2/door.obj'/>
  <furnitureGroup level='L0' name='Seat' x='100' y='100' width='90' depth='90' height='90'>
    <pieceOfFurniture name='Chair' x='100' y='150' width='50' depth='60' height='90' angle='1.5707964' model='1/chair.obj' modelMirrored='true'/>
    <pieceOfFurniture name='Lamp' x='100' y='120' width='20' depth='20' height='30' elevation='200' model='9'/>
  </furnitureGroup>
  <pieceOfFurniture level='L0' name='Hidden' visible='false' x='0' y='0' width='1' depth='1' height='1'/>
  <pieceOfFurniture level='L0' name='Nowhere' x='NaN' y='0' width='1' depth='1' height='1'/>
  <wall id='w0' level='L0' xStart='0' yStart='0' xEnd='400' yEnd='0' height='250' thickness='12' leftSideColor='FFFF0000'/>
  <wall id='w1' level='L0' xStart='400' yStart='0' xEnd='400' yEnd='300' height='250' heightAtEnd='300' thickness='12'/>
  <wall id='w2' level='L0' xStart='1' yStart='1' xEnd='1' yEnd='1' height='250' thickness='12'/>
  <wall id='w3' level='L0' xStart='1e999' yStart='1' xEnd='1' yEnd='1' height='250' thickness='12'/>
  <room level='L1' name='Attic'><point x='0' y='0'/><point x='400' y='0'/><point x='400' y='300'/></room>
  <room level='L1'><point x='0' y='0'/></room>
</home>)";

class SweethomeHomeFile : public testing::Test {
protected:
    std::filesystem::path home(const std::string& xml) const {
        return folder_.write_zip(
            "flat.sh3d", {{"Home.xml", xml}, {"1/chair.obj", test::cube_obj()}, {"2/door.obj", test::cube_obj()}});
    }
    test::ScratchFolder folder_;
};

TEST_F(SweethomeHomeFile, IsReadInMetresWithZDownThePlan) {
    const auto read = read_sweethome_home(home(plan));
    ASSERT_TRUE(read.ok()) << read.error().message();
    ASSERT_EQ(read->levels.size(), 2U);
    EXPECT_DOUBLE_EQ(read->levels[1].elevation, 2.62);
    ASSERT_EQ(read->walls.size(), 2U);
    EXPECT_EQ(read->walls[1].end, (HomePoint{4, 3}));
    EXPECT_DOUBLE_EQ(read->walls[1].end_height, 3);
    ASSERT_TRUE(read->walls[0].color);
    EXPECT_NEAR((*read->walls[0].color)[0], 1, 1e-6);
    ASSERT_EQ(read->rooms.size(), 1U);
    EXPECT_EQ(read->rooms[0].points.size(), 3U);

    ASSERT_EQ(read->pieces.size(), 3U);
    EXPECT_TRUE(read->pieces[0].door_or_window);
    const HomePiece& chair = read->pieces[1];
    EXPECT_EQ(chair.group, "Seat");
    EXPECT_EQ(chair.level, "L0");
    EXPECT_NEAR(chair.angle, -1.5707964, 1e-9);
    EXPECT_EQ(chair.size, (std::array{0.5, 0.9, 0.6}));
    ASSERT_EQ(read->furniture.pieces.size(), 2U);
    EXPECT_EQ(read->furniture.pieces[1].model_path, "1/chair.obj");
    EXPECT_EQ(read->furniture.pieces[1].rotation[0], -1);  // mirrored
    EXPECT_EQ(chair.id, read->furniture.pieces[1].id);
    EXPECT_TRUE(read->pieces[2].id.empty());
    EXPECT_DOUBLE_EQ(read->pieces[2].elevation, 2);
    // Two bad walls, a room, a piece without a place, one without a model.
    EXPECT_EQ(read->notes.size(), 4U);
}

// Models of one file have a number for a name in homes.
TEST_F(SweethomeHomeFile, FindsModelsWithoutAnExtension) {
    const auto file = folder_.write_zip(
        "numbers.sh3d",
        {{"Home.xml",
          "<home><pieceOfFurniture name='Bed' x='0' y='0' width='9' depth='9' height='9' model='1'/>"
          "<pieceOfFurniture name='Note' x='0' y='0' width='9' depth='9' height='9' model='2'/></home>"},
         {"1", test::cube_obj()},
         {"2", "not a model"}});
    const auto read = read_sweethome_home(file);
    ASSERT_TRUE(read.ok()) << read.error().message();
    ASSERT_EQ(read->furniture.pieces.size(), 1U);
    EXPECT_EQ(read->furniture.pieces[0].model_path, "1");
    EXPECT_TRUE(read->pieces[1].id.empty());
    const auto archive = Archive::open(file);
    const auto model = read_model(ArchiveSource(*archive, "numbers.sh3d"), "1");
    ASSERT_TRUE(model.ok()) << model.error().message();
    const auto note = read_model(ArchiveSource(*archive, "numbers.sh3d"), "2");
    ASSERT_FALSE(note.ok());
    EXPECT_NE(note.error().message().find("format that is not read"), std::string::npos);
}

TEST_F(SweethomeHomeFile, PiecesHaveTheirColoursAndTilt) {
    const auto read = read_sweethome_home(home(
        "<home><pieceOfFurniture name='A' x='0' y='0' width='9' depth='9' height='9' model='1/chair.obj' "
        "color='FFFF0000' "
        "pitch='0.5' heightInPlan='12'><material name='seat' color='FF00FF00'/><material "
        "name='leg'><texture/></material>"
        "</pieceOfFurniture><pieceOfFurniture name='B' x='0' y='0' width='9' depth='9' height='9' model='1/chair.obj'/>"
        "</home>"));
    ASSERT_TRUE(read.ok()) << read.error().message();
    ASSERT_EQ(read->furniture.pieces.size(), 2U) << "of another colour it is another model";
    const std::vector<Recolor> wanted{{"", {1, 0, 0}}, {"seat", {0, 1, 0}}};
    EXPECT_EQ(read->furniture.pieces[0].recolors, wanted);
    EXPECT_TRUE(read->furniture.pieces[1].recolors.empty());
    EXPECT_DOUBLE_EQ(read->pieces[0].pitch, -0.5);
    EXPECT_DOUBLE_EQ(read->pieces[0].height, 0.12);
    EXPECT_EQ(read->notes.size(), 1U) << "a texture is left out";
}

// Arcs above and below the plan's line from (0, 0) to (4, 0), up to nearly a whole circle.
TEST_F(SweethomeHomeFile, CurvedWallsAreRowsOfStraightOnes) {
    for (const double arc : {0.3, std::numbers::pi / 2, std::numbers::pi, 1.5 * std::numbers::pi, -0.3, -2.0, -5.0}) {
        char wall[256];
        std::snprintf(wall, sizeof wall,
                      "<home><wall xStart='0' yStart='0' xEnd='400' yEnd='0' height='200' heightAtEnd='300' "
                      "thickness='12' arcExtent='%.9f'/></home>",
                      arc);
        const auto read = read_sweethome_home(home(wall));
        ASSERT_TRUE(read.ok());
        const auto& walls = read->walls;
        ASSERT_GE(walls.size(), 2U);
        EXPECT_EQ(walls.front().start, (HomePoint{0, 0}));
        EXPECT_EQ(walls.back().end, (HomePoint{4, 0}));
        EXPECT_NEAR(walls.back().end_height, 3, 1e-9);
        // A circle through both ends on which the wall turns by `arc` has this radius; it bulges up the plan for arc >
        // 0.
        const double radius = 2 / std::fabs(std::sin(arc / 2));
        double length = 0, highest = 0;
        for (std::size_t i = 0; i < walls.size(); ++i) {
            if (i > 0) {
                EXPECT_EQ(walls[i].start, walls[i - 1].end);
            }
            length += std::hypot(walls[i].end[0] - walls[i].start[0], walls[i].end[1] - walls[i].start[1]);
            highest = std::max(highest, (arc > 0 ? -1 : 1) * walls[i].end[1]);
        }
        EXPECT_NEAR(length, radius * std::fabs(arc), 0.02 * length) << arc;
        EXPECT_NEAR(highest, radius * (1 - std::cos(arc / 2)), 0.02) << arc;
        EXPECT_TRUE(read->notes.empty());
    }
}

TEST_F(SweethomeHomeFile, CurvedWallsCountByTheirPieces) {
    std::string walls = "<home><wall xStart='0' yStart='0' xEnd='1000000' yEnd='0' thickness='12' arcExtent='6.282'/>";
    for (int i = 0; i < 4000; ++i)
        walls += "<wall xStart='0' yStart='0' xEnd='10000' yEnd='0' thickness='12' arcExtent='3.14'/>";
    const auto read = read_sweethome_home(home(walls + "</home>"));
    ASSERT_TRUE(read.ok());
    EXPECT_LT(read->walls.size(), 100'100U);
    ASSERT_EQ(read->notes.size(), 2U);
    EXPECT_NE(read->notes[1].find("1 walls"), std::string::npos) << "a radius of some hundred kilometres";
}

TEST_F(SweethomeHomeFile, WithoutAPlanInXmlSaysWhatToDo) {
    const auto old = read_sweethome_home(folder_.write_zip("old.sh3d", {{"Home", "\xac\xed"}}));
    ASSERT_FALSE(old.ok());
    EXPECT_NE(old.error().message().find("save it again"), std::string::npos);
    const auto none = read_sweethome_home(folder_.write_zip("none.sh3d", {{"readme", "x"}}));
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().message().find("no Home.xml"), std::string::npos);
    EXPECT_FALSE(read_sweethome_home(folder_.write("no.sh3d", "not a zip")).ok());
}

TEST_F(SweethomeHomeFile, RefusesWhatIsNoXmlAndReadsAnyEndOfOne) {
    EXPECT_FALSE(read_sweethome_home(home("<home")).ok());
    EXPECT_FALSE(read_sweethome_home(home("<house/>")).ok());
    EXPECT_TRUE(read_sweethome_home(home("<home/>")).ok());
    // However a file is damaged, it is read or refused.
    int refused = 0;
    for (std::size_t end = 0; end < plan.size(); end += 37)
        if (!read_sweethome_home(home(plan.substr(0, end))).ok()) ++refused;
    EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace embody::interchange
