// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "math/mat3.h"
#include "physics/collision/namespace.h"
#include "physics/collision/shapes/collision_shape.h"

namespace embody::physics::collision {

/// By how much the normal may turn at an edge of what approximates a curved surface, rad (16 degrees): a circle of 24
/// sides (15 degrees each) still counts as round. Tessellators allow more (OpenCASCADE: 0.5 rad, Blender's smooth
/// shading: 30 degrees), but a ramp of 20 degrees is one (validation.Bowls: CoarseHalfPipe…, RampOfTwentyDegrees…).
inline constexpr double smooth_edge_angle = 0.28;

/// A place where a ball touches a surface or is within the margin.
struct BallTouch {
    Vec3 normal;     ///< world, unit, towards the ball
    double gap = 0;  ///< m, negative where they overlap
    /// Shape operator S: how the normal turns along the surface, world, 1/m, symmetric: dn = S · dx, positive where the
    /// surface curves away.
    Mat3 shape_operator = Mat3::zero();
    bool knows_curvature = false;  ///< known at a smooth place of a mesh or heightfield
    bool is_flat = false;          ///< a face or plane, whose normal does not turn with the place
};

/// Appends the places where the ball (a shape of that radius, world) is closer than `margin` (m, > 0) to the ground:
/// for each triangle of a mesh or heightfield, of other shapes for each piece.
void find_ball_touches(const CollisionShape& ball, double radius, Vec3 center, const CollisionShape& ground,
                       const Transform& pose, double margin, std::vector<BallTouch>& touches);

}  // namespace embody::physics::collision
