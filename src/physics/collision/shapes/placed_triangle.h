// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "math/vec3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Lean that still counts as none, in radians: what floats leave of a flat surface.
inline constexpr double flat_sine = 1e-3;

/// A triangle of a surface in the frame of the convex that it meets.
struct PlacedTriangle {
    std::uint32_t index = 0;  ///< in the surface
    std::array<Vec3, 3> corners;
    Vec3 normal;                            ///< unit
    std::array<Vec3, 3> outward;            ///< unit, in the plane, across each edge
    std::array<float, 3> half_dihedrals{};  ///< of the surface at each edge: see TriangleSurface::half_dihedrals

    // The convex's point that is lowest along the normal, and its height over the plane, m.
    Vec3 lowest;
    double height = 0;

    /// Whether a normal may lean over the edge.
    [[nodiscard]] bool is_open(std::size_t edge) const { return half_dihedrals[edge] > 0; }
    /// Whether a normal (from the triangle outwards) at the triangle's point `at` leans over an edge on which that
    /// point lies, beyond the bend there: then it belongs to the neighbour.
    [[nodiscard]] bool leans_too_far(Vec3 outwards, Vec3 at) const;
    /// Whether the normal is the triangle's own up to a lean too small to mean an edge.
    [[nodiscard]] bool is_flat_to(Vec3 outwards) const;
    /// The distance of a point beyond an edge, in the plane, m.
    [[nodiscard]] double beyond(std::size_t edge, Vec3 p) const { return dot(p - corners[edge], outward[edge]); }
    /// Whether its own normal separates it from the convex more than any leaning one can.
    [[nodiscard]] bool normal_is_best() const;
    /// From the corner where an edge begins to the next one.
    [[nodiscard]] Vec3 along(std::size_t edge) const { return corners[edge == 2 ? 0 : edge + 1] - corners[edge]; }
    /// Its point nearest to `p`.
    [[nodiscard]] Vec3 nearest_to(Vec3 p) const;
};

/// A side of the prism over a triangle. Over an edge where the surface bends away a little the side leans halfway to
/// the neighbour's normal, so that nothing in the wedge between the two prisms is lost.
struct PrismSide {
    /// Tangent of half the angle between the normals (30 degrees) up to which both neighbours have the wedge.
    static constexpr float shallow_half_dihedral = 0.268F;

    Vec3 outwards;
    double offset = 0;

    PrismSide(const PlacedTriangle& t, std::size_t edge) : outwards(t.outward[edge]) {
        if (t.half_dihedrals[edge] <= shallow_half_dihedral)
            outwards -= t.normal * static_cast<double>(t.half_dihedrals[edge]);
        // A tiny slack keeps points that lie on the side.
        const Vec3 displacement = abs(t.along(edge));
        offset = dot(outwards, t.corners[edge]) + 1e-9 * (displacement.x + displacement.y + displacement.z);
    }
    [[nodiscard]] double beyond(Vec3 p) const { return dot(outwards, p) - offset; }
};

}  // namespace embody::physics::collision
