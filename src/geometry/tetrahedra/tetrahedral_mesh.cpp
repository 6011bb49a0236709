// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/tetrahedral_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace embody::geometry {

double signed_volume(const TetrahedralMesh& mesh, const Tetrahedron& t) {
    const Vec3 a = mesh.nodes[t[0]];
    return dot(mesh.nodes[t[1]] - a, cross(mesh.nodes[t[2]] - a, mesh.nodes[t[3]] - a)) / 6;
}

double volume(const TetrahedralMesh& mesh) {
    double sum = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) sum += signed_volume(mesh, t);
    return sum;
}

DihedralAngles measure_dihedral_angles(const TetrahedralMesh& mesh) {
    if (mesh.tetrahedra.empty()) return {};
    constexpr double degrees = 180 / std::numbers::pi;
    DihedralAngles angles{180, 0};
    for (const Tetrahedron& t : mesh.tetrahedra) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = i + 1; k < 4; ++k) {
                // Directions at the edge i k, between the faces to the two other corners.
                std::array<Vec3, 2> away{};
                std::size_t count = 0;
                const Vec3 at = mesh.nodes[t[i]], along = normalized(mesh.nodes[t[k]] - at);
                for (std::size_t other = 0; other < 4; ++other) {
                    if (other == i || other == k) continue;
                    const Vec3 to = mesh.nodes[t[other]] - at;
                    away[count++] = to - dot(to, along) * along;
                }
                const double angle = degrees * std::atan2(length(cross(away[0], away[1])), dot(away[0], away[1]));
                angles.least = std::min(angles.least, angle);
                angles.largest = std::max(angles.largest, angle);
            }
        }
    }
    return angles;
}

TetrahedralTopology find_tetrahedral_topology(const std::vector<Tetrahedron>& tetrahedra) {
    struct Keyed {
        std::array<std::uint32_t, 3> key;  // corners in ascending order
        TetrahedronFace face;
    };
    // The face opposite to each corner, seen from outside where the volume is positive.
    constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    std::vector<Keyed> all;
    all.reserve(4 * tetrahedra.size());
    for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) {
        for (const auto& f : faces) {
            const std::array<std::uint32_t, 3> corners{tetrahedra[i][f[0]], tetrahedra[i][f[1]], tetrahedra[i][f[2]]};
            auto key = corners;
            std::sort(key.begin(), key.end());
            all.push_back({key, {corners, i}});
        }
    }
    std::sort(all.begin(), all.end(), [](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : a.face.tetrahedron < b.face.tetrahedron;
    });
    TetrahedralTopology topology;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i + 1 < all.size() && all[i].key == all[i + 1].key) {
            topology.neighbours.push_back({all[i].face.tetrahedron, all[i + 1].face.tetrahedron});
            ++i;
        } else {
            topology.outer_faces.push_back(all[i].face);
        }
    }
    return topology;
}

}  // namespace embody::geometry
