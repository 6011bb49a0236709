// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec3.h"

namespace embody::geometry {

using Tetrahedron = std::array<std::uint32_t, 4>;

/// A solid as tetrahedra. Metres.
struct TetrahedralMesh {
    std::vector<Vec3> nodes;                            ///< each is used
    std::vector<Tetrahedron> tetrahedra;                ///< dot(b - a, cross(c - a, d - a)) > 0
    std::vector<std::array<std::uint32_t, 3>> surface;  ///< outer faces, counter-clockwise from outside
    std::vector<std::uint32_t> surface_tetrahedra;      ///< the tetrahedron of each face, parallel to `surface`
};

/// Volume, m³; negative where the tetrahedron is inverted.
double signed_volume(const TetrahedralMesh& mesh, const Tetrahedron& t);
/// Volume of all tetrahedra, m³.
double volume(const TetrahedralMesh& mesh);

/// The angles between faces, which say how well the elements are shaped: 70.5° in a regular tetrahedron.
struct DihedralAngles {
    double least = 0, largest = 0;  ///< degrees; both 0 where there are no tetrahedra
};
DihedralAngles measure_dihedral_angles(const TetrahedralMesh& mesh);

/// A face of a tetrahedron, counter-clockwise seen from outside.
struct TetrahedronFace {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t tetrahedron = 0;
};

/// How tetrahedra are connected through common faces.
struct TetrahedralTopology {
    std::vector<std::array<std::uint32_t, 2>> neighbours;  ///< pairs of tetrahedra with a common face
    std::vector<TetrahedronFace> outer_faces;              ///< of one tetrahedron only
};
/// Expects that no face has more than two tetrahedra. The order is the same for the same tetrahedra.
TetrahedralTopology find_tetrahedral_topology(const std::vector<Tetrahedron>& tetrahedra);

}  // namespace embody::geometry
