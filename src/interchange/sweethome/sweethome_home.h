// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "interchange/sweethome/sweethome_catalogue.h"

namespace embody::interchange {

// A home of Sweet Home 3D (.sh3d): a zip with the plan in Home.xml and the models of its furniture. Here in SI units; X
// to the right of the plan, Z down it, Y up; angles counter-clockwise as seen from above, rad.

using HomePoint = std::array<double, 2>;  ///< [x, z], m
using HomeColor = std::array<double, 3>;  ///< linear red, green, blue

struct HomeLevel {
    std::string id, name;
    double elevation = 0, height = 2.5, floor_thickness = 0.12;  ///< m
};
struct HomeWall {
    HomePoint start{}, end{};
    double height = 2.5, end_height = 2.5, thickness = 0.1;  ///< m
    std::optional<HomeColor> color;
    std::string level;  ///< id; empty: the home has no levels
};
struct HomeRoom {
    std::string name;
    std::vector<HomePoint> points;
    std::optional<HomeColor> color;  ///< of the floor
    std::string level;
};
struct HomePiece {
    std::string name, group;       ///< names of the groups that it is in, with '/' between
    std::string id;                ///< of the piece in SweethomeHome::furniture that is its model; empty: it has none
    HomePoint place{};             ///< of its middle
    double elevation = 0;          ///< of its base over the level's floor, m
    double angle = 0;              ///< about the vertical
    double pitch = 0, roll = 0;    ///< about X first, then about Z, before the angle; rad
    std::array<double, 3> size{};  ///< width X, height Y, depth Z at angle, pitch and roll 0, m
    double height = 0;             ///< from its lowest to its highest point where it is tilted, m; 0: its size's
    std::optional<HomeColor> color;
    bool door_or_window = false, movable = true;
    bool light_source = false;  ///< may have no shape, as light itself
    std::string level;
};

struct SweethomeHome {
    std::vector<HomeLevel> levels;
    std::vector<HomeWall> walls;
    std::vector<HomeRoom> rooms;
    std::vector<HomePiece> pieces;
    /// The models of the pieces, each once, turned, mirrored and sized as the home has them.
    SweethomeCatalogue furniture;
    std::vector<std::string> notes;  ///< what was left out or is not as in the home, for people
};

/// Whether the file name looks like one: *.sh3d.
bool is_sweethome_home(const std::filesystem::path& file);

/// Reads the plan; models stay packed. What is wrong with a single wall, room or piece leaves that one out with a note;
/// an archive without Home.xml, or one that is no XML, is an error.
Result<SweethomeHome> read_sweethome_home(const std::filesystem::path& file);

}  // namespace embody::interchange
