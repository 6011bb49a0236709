// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/definitions/deformable_definition.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// A ray of finite length.
struct Ray {
    Vec3 origin, direction;   ///< m; unit
    double max_distance = 0;  ///< m
};

/// The nodes and faces of a deformable that are visible from outside.
class DeformableSurface {
public:
    explicit DeformableSurface(const physics::DeformableDefinition& definition);

    /// True for a solid and for cloth, false for a rope.
    [[nodiscard]] bool has_faces() const { return !faces_.empty(); }
    /// Nodes of the faces, ascending; all nodes for a rope.
    [[nodiscard]] const std::vector<std::uint32_t>& nodes() const { return nodes_; }
    /// The first hit of the ray with a face, the nodes being at `positions`.
    [[nodiscard]] std::optional<SurfaceHit> meet(std::span<const Vec3> positions, const Ray& ray) const;

private:
    /// Outer faces of a solid, counter-clockwise from outside, or all faces of cloth.
    std::vector<std::array<std::uint32_t, 3>> faces_;
    std::vector<std::uint32_t> nodes_;
    bool has_two_sides_;
};

/// The first hit of the ray with a rope of this radius along nodes at `positions`. `broken`: its broken segments,
/// ascending.
std::optional<SurfaceHit> meet_rope(std::span<const Vec3> positions, double radius,
                                    std::span<const std::uint32_t> broken, const Ray& ray);

}  // namespace embody::scene
