// SPDX-License-Identifier: MIT
#include "interchange/sweethome/sweethome_home.h"

#include <cmath>

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
