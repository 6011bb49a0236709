// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "math/bounds.h"
#include "math/transform.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// One end of a wall that stands upright.
struct WallEnd {
    physics::WallShape* wall = nullptr;
    Transform pose;       ///< of the wall
    bool is_end = false;  ///< the end, or the start
};

/// Ends that are nearer to each other than this are joined, m.
inline constexpr double joint_reach = 0.005;

/// Whether the wall's up is the world's: others are not joined.
bool is_upright(const Transform& pose);
/// The end's point at the foot of the wall's middle, in the world.
Vec3 point_of(const WallEnd& end);

/// Cuts the ends of walls that meet in one point, so that the faces of neighbours meet and no gap is left; a lone end
/// is square. Walls that go on in one line keep square ends. A corner as sharp as to need more than three times the two
/// thicknesses, or nearly half of a wall, is cut by that much only.
void mitre(const std::vector<WallEnd>& ends);

/// The box around a primitive, in its frame; empty where it has no end.
Bounds box_around(const physics::ShapeDefinition& shape);

/// The opening that a door or window of this size cuts into the wall that it stands in, at a pose in the wall's frame
/// whose origin is the middle of its base; none where it does not stand in it, along it.
std::optional<physics::WallOpening> opening_of(const physics::WallShape& wall, const Transform& local, Vec3 size);

}  // namespace embody::scene
