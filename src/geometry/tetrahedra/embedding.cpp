// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/embedding.h"

#include <algorithm>

#include "geometry/bounding_volume_tree.h"
#include "geometry/triangle_distance.h"

namespace embody::geometry {
namespace {

constexpr double on_face = 1e-9;  // minimum weight of a place that counts as inside

std::array<double, 4> barycentric(const TetrahedralMesh& mesh, const Tetrahedron& t, Vec3 p) {
    const Vec3 a = mesh.nodes[t[0]];
    const Vec3 w = solve({mesh.nodes[t[1]] - a, mesh.nodes[t[2]] - a, mesh.nodes[t[3]] - a}, p - a);
    return {1 - w.x - w.y - w.z, w.x, w.y, w.z};
}

template <class Corners>
Bounds bounds_of(const TetrahedralMesh& mesh, const Corners& corners) {
    Bounds box;
    for (const std::uint32_t corner : corners) box.add(mesh.nodes[corner]);
    return box;
}

// Finds the tetrahedron that contains a place.
class Carriers {
public:
    explicit Carriers(const TetrahedralMesh& mesh) : mesh_(mesh) {
        std::vector<Bounds> boxes;
        for (const Tetrahedron& t : mesh.tetrahedra) boxes.push_back(bounds_of(mesh, t));
        solids_ = BoundingVolumeTree(boxes);
        boxes.clear();
        for (const auto& face : mesh.surface) boxes.push_back(bounds_of(mesh, face));
        faces_ = BoundingVolumeTree(boxes);
        box_ = solids_.bounds();
    }

    [[nodiscard]] EmbeddedPoint at(Vec3 p) const {
        EmbeddedPoint best;
        double depth = -1;  // minimum weight
        solids_.query({p, p}, [&](std::uint32_t t) {
            const auto weights = barycentric(mesh_, mesh_.tetrahedra[t], p);
            const double least = *std::min_element(weights.begin(), weights.end());
            if (least > depth || (least == depth && t < best.tetrahedron)) {
                best = {t, weights};
                depth = least;
            }
        });
        if (depth >= -on_face) return best;
        const std::uint32_t t = mesh_.surface_tetrahedra[nearest_face(p)];
        return {t, barycentric(mesh_, mesh_.tetrahedra[t], p)};
    }

private:
    [[nodiscard]] std::uint32_t nearest_face(Vec3 p) const {
        // A ball that grows until it contains a triangle; the bounds give a radius that is certainly empty.
        const double size = length(box_.size());
        double reach = distance(p, min(max(p, box_.lower), box_.upper)) + 0.02 * size;
        for (;; reach *= 2) {
            double best = reach * reach;
            std::uint32_t nearest = 0;
            bool found = false;
            faces_.query(enlarged({p, p}, reach), [&](std::uint32_t f) {
                const auto& [a, b, c] = mesh_.surface[f];
                const double d = squared_distance(p, {mesh_.nodes[a], mesh_.nodes[b], mesh_.nodes[c]});
                if (d < best || (d == best && found && f < nearest)) {
                    best = d;
                    nearest = f;
                    found = true;
                }
            });
            if (found) return nearest;
        }
    }

    const TetrahedralMesh& mesh_;
    BoundingVolumeTree solids_, faces_;
    Bounds box_;
};

}  // namespace

Result<std::vector<EmbeddedPoint>> embed(const std::vector<Vec3f>& positions, const TetrahedralMesh& mesh) {
    if (mesh.tetrahedra.empty() || mesh.surface.empty())
        return Error{"embedding: mesh", "has no tetrahedra or no surface", "fill_with_tetrahedra() gives both"};
    const Carriers carriers(mesh);
    std::vector<EmbeddedPoint> points;
    points.reserve(positions.size());
    for (const Vec3f position : positions) {
        if (!is_finite(position))
            return Error{"embedding: positions[" + std::to_string(points.size()) + "]", "is not finite",
                         "drop or mend that vertex"};
        points.push_back(carriers.at(position));
    }
    return points;
}

Vec3 position(const EmbeddedPoint& point, const TetrahedralMesh& mesh, const std::vector<Vec3>& nodes) {
    const Tetrahedron& t = mesh.tetrahedra[point.tetrahedron];
    Vec3 sum;
    for (std::size_t i = 0; i < 4; ++i) sum += point.weights[i] * nodes[t[i]];
    return sum;
}

}  // namespace embody::geometry
