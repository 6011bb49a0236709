// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/bounding_volume_tree.h"
#include "geometry/volume_estimate.h"

namespace embody::geometry {

/// What a surface encloses, as estimate_volume() sees it: the places in its bounds with a winding number above one
/// half. The surface may be open, and its parts may overlap.
class EnclosedSolid {
public:
    /// `mesh` is welded and its triangles face outwards.
    explicit EnclosedSolid(const TriangleMesh& mesh);

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] bool contains(Vec3 p) const;
    /// Where on the way from `inside` to `outside` the solid ends: 0 … 1. The first end where there are several.
    [[nodiscard]] double leave(Vec3 inside, Vec3 outside) const;

private:
    [[nodiscard]] double halve(Vec3 inside, Vec3 outside) const;

    std::vector<std::array<Vec3, 3>> triangles_;
    BoundingVolumeTree tree_;
    WindingNumber winding_;
    Bounds bounds_;
};

}  // namespace embody::geometry
