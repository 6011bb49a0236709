// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/deformable/cloth/cloth_mesh.h"
#include "physics/deformable/cloth/node_fans.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// What a triangle's weave pulls with.
struct SheetStress {
    double warp = 0, weft = 0, shear = 0;         ///< tensions of the unstretched width, N/m
    double energy = 0;                            ///< W, of stretch and shear per area, J/m²
    std::array<std::array<double, 2>, 2> pull{};  ///< Fᵀ ∂W/∂F by rows: warp, weft, N/m
};

/// Where a sheet tears (docs/physics/tearing.md): it starts by tension, and goes on by the energy that it releases.
class SheetTear {
public:
    SheetTear() = default;
    /// `rest`: the places at rest, `triangles`: of this sheet.
    SheetTear(const std::vector<Vec3>& rest, const Cloth& cloth, std::span<const ClothTriangle> triangles);

    /// Whether the sheet can tear.
    [[nodiscard]] bool is_active() const { return fans_.node_count() > 0; }
    /// Corners of triangles that get new nodes now; none: it holds. `stress`: of the sheet's triangles now. `held`: by
    /// node, whether something holds it, so that it stays one.
    [[nodiscard]] std::vector<TornCorner> find(std::span<const ClothTriangle> triangles,
                                               std::span<const SheetStress> stress,
                                               std::span<const std::uint8_t> held) const;

private:
    struct Tip {
        std::uint32_t node = 0;
        std::vector<std::uint32_t> ring;       // nodes beside it
        std::vector<std::uint32_t> around;     // nodes that are shifted with the tip, and the tip
        std::vector<std::uint32_t> triangles;  // at these
    };
    struct Start {
        std::vector<SheetEdge> edges;
        double excess = 0;  // tension over the strength
    };
    [[nodiscard]] Tip tip_at(std::uint32_t node, const NodeFan& fan) const;
    [[nodiscard]] Vec3 release_at(const Tip& tip, std::span<const ClothTriangle> triangles,
                                  std::span<const SheetStress> stress, std::span<const std::uint8_t> held) const;
    [[nodiscard]] bool is_stitch(std::span<const NodeFan> fans) const;
    void run_on(std::uint32_t tip, Vec3 direction, double edges, std::span<const std::uint8_t> held,
                std::vector<SheetEdge>& cut) const;
    [[nodiscard]] Start start_at(std::uint32_t node, std::span<const ClothTriangle> triangles,
                                 std::span<const SheetStress> stress) const;
    [[nodiscard]] Start find_start(std::span<const ClothTriangle> triangles, std::span<const SheetStress> stress,
                                   std::span<const std::uint8_t> held) const;

    double strength_ = 0, energy_ = 0;
    std::vector<Vec3> rest_;
    NodeFans fans_;
    std::vector<Tip> tips_;
    std::vector<std::uint32_t> stitches_;    // nodes that alone join the sides of slits
    std::vector<std::array<Vec3, 2>> axes_;  // of the triangles at rest: along warp and weft
};

}  // namespace embody::physics::deformable
