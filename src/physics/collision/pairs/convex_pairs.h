// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/contact_region.h"
#include "physics/collision/pairs/convex_pair.h"
#include "physics/collision/pairs/pair_memory.h"

namespace embody::physics::collision {

// Each function finds the contact region of one family of pairs in an empty ContactRegion; its normal is set if there
// are points. The frame is that of a.

/// Signed distance of a point from the surface of a convex (negative inside), and the outward direction there.
struct SurfaceDistance {
    Vec3 normal;  ///< unit, local
    double distance = 0;
    std::uint32_t face = Polytope::no_face;  ///< of a hull: the point lies over it, or inside and nearest to it
};
/// For points farther away than `enough`, only a lower bound of the distance.
SurfaceDistance distance_from_surface(const Convex& convex, Vec3 local_point, double enough = 1e300);

/// Half space below dot(normal, p) = offset, in the frame of the pair.
struct PlacedPlane {
    Vec3 normal;
    double offset = 0;
};

/// a is a sphere, b any convex.
void collide_sphere(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory,
                    ContactRegion& region);
/// a is any convex, b the plane; the normal points from a into the plane.
void collide_plane(const PlacedConvex& a, const PlacedPlane& plane, double margin, ContactRegion& region);
/// Both are polytopes with volume. False, with nothing done, where they overlap so deeply that too many edges would
/// have to be paired.
bool collide_polytopes(const ConvexPair& pair, double margin, PairMemory& memory, ContactRegion& region);
/// Any pair of convexes, by GJK and EPA: those with a round side, and triangles.
void collide_round(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory,
                   ContactRegion& region);

}  // namespace embody::physics::collision
