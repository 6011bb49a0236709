// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "physics/definitions/deformable_definition.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// The nodes at an edge's ends, the lower first.
using SheetEdge = std::pair<std::uint32_t, std::uint32_t>;
SheetEdge edge_between(std::uint32_t a, std::uint32_t b);

/// A triangle of cloth as it was cut: F = Σ x_k (warp_k, weft_k) turns its plane at rest into where it is.
struct ClothTriangle {
    std::array<std::uint32_t, 3> node;
    double area = 0;             ///< m²
    std::array<double, 3> warp;  ///< gradient of the corner's weight along the warp, 1/m
    std::array<double, 3> weft;  ///< the same across
};

/// Numbers of a sparse symmetric matrix, row by row: of row i those from start[i] to start[i + 1].
struct ScalarRows {
    std::vector<std::uint32_t> start, column;
    std::vector<double> value;
};

/// The fold at an edge between two triangles: Σ weight x is the edge's length times the angle, along the normal.
struct BendHinge {
    std::array<std::uint32_t, 4> node;  ///< the edge's ends, then the corners across it
    std::array<double, 4> weight;       ///< together 0
};

/// How a triangle's curvature follows from the folds r at its edges: Λ = Σ part r / 2A, as a vector whose product is
/// that of tensors: xx, yy, √2 xy of the triangle's plane, x along the warp.
struct BendTriangle {
    static constexpr std::uint32_t no_hinge = ~std::uint32_t{0};  // at a free edge
    std::array<std::uint32_t, 3> hinge{no_hinge, no_hinge, no_hinge};
    std::array<Vec3, 3> part;
    double area = 0;  ///< m²
};

/// What tells the curvature of a sheet that is flat at rest: as many triangles as the cloth has.
struct BendElements {
    std::vector<BendHinge> hinges;
    std::vector<BendTriangle> triangles;
};

/// Elements of a sheet at rest. The warp runs along the frame's x axis (its z axis where a triangle stands across x).
std::vector<ClothTriangle> make_cloth_triangles(const std::vector<Vec3>& nodes, const Cloth& cloth);

/// Folds and curvatures of the sheet with these nodes at rest.
BendElements make_bend_elements(const std::vector<Vec3>& nodes, const Cloth& cloth);

/// The bending energy ½ Σ_ik B_ik x_i·x_k = ½ Σ A |Λ|² of `nodes` nodes, per unit of bend stiffness (1/m²). Every row
/// has its diagonal element first.
ScalarRows make_bending_rows(const BendElements& elements, std::size_t nodes);

}  // namespace embody::physics::deformable
