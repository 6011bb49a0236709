// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/definitions/deformable_definition.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

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

/// Elements of a sheet at rest. The warp runs along the frame's x axis (its z axis where a triangle stands across x).
std::vector<ClothTriangle> make_cloth_triangles(const std::vector<Vec3>& nodes, const Cloth& cloth);

/// The bending energy ½ Σ_ik B_ik x_i·x_k of a sheet that is flat at rest, per unit of bend stiffness (1/m²). Every row
/// has its diagonal element first.
ScalarRows make_bending_rows(const std::vector<Vec3>& nodes, const Cloth& cloth);

}  // namespace embody::physics::deformable
