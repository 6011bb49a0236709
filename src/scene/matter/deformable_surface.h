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

/// A ray of a length.
struct Ray {
    Vec3 origin, direction;  ///< m; unit
    double most = 0;         ///< m
};

/// Which nodes and faces of a deformable others can see.
class DeformableSurface {
public:
    explicit DeformableSurface(const physics::DeformableDefinition& definition);

    /// A solid and cloth; a rope has none.
    [[nodiscard]] bool has_faces() const { return !faces_.empty(); }
    /// Those of the faces, ascending; all of a rope's.
    [[nodiscard]] const std::vector<std::uint32_t>& nodes() const { return nodes_; }
    /// Where the ray meets a face first, the nodes being at `positions`.
    [[nodiscard]] std::optional<SurfaceHit> meet(std::span<const Vec3> positions, const Ray& ray) const;

private:
    std::vector<std::array<std::uint32_t, 3>> faces_;  ///< a solid's outer ones, counter-clockwise from outside, or
                                                       ///< those of cloth
    std::vector<std::uint32_t> nodes_;
    bool has_two_sides_;
};

/// Where the ray meets first a rope of this radius along nodes at `positions`. `broken`: its broken segments,
/// ascending.
std::optional<SurfaceHit> meet_rope(std::span<const Vec3> positions, double radius,
                                    std::span<const std::uint32_t> broken, const Ray& ray);

}  // namespace embody::scene
