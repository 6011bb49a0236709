// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/bounding_volume_tree.h"
#include "geometry/volume_estimate.h"

namespace embody::geometry {

/// The solid that a surface encloses, as in estimate_volume(): the places in its bounds with a winding number above one
/// half. The surface may be open, and its parts may overlap.
class EnclosedSolid {
public:
    /// `mesh` is welded and its triangles face outwards.
    explicit EnclosedSolid(const TriangleMesh& mesh);

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] bool contains(Vec3 p) const;
    /// The fraction of the path from `inside` to `outside` at which the solid ends: 0 … 1. The first end if there are
    /// several.
    [[nodiscard]] double leave(Vec3 inside, Vec3 outside) const;

private:
    [[nodiscard]] double halve(Vec3 inside, Vec3 outside) const;

    std::vector<std::array<Vec3, 3>> triangles_;
    BoundingVolumeTree tree_;
    WindingNumber winding_;
    Bounds bounds_;
};

}  // namespace embody::geometry
