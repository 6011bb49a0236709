// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/enclosed_solid.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace embody::geometry {
namespace {

constexpr double edge_margin = 1e-9;  // barycentric: an edge counts for both triangles rather than for none
constexpr int halvings = 12;

// Parameter t at which origin + t direction meets the triangle (T. Möller, B. Trumbore, "Fast, minimum storage
// ray/triangle intersection", Journal of Graphics Tools 2(1), 1997).
std::optional<double> meet(Vec3 origin, Vec3 direction, const std::array<Vec3, 3>& triangle) {
    const Vec3 e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
    const Vec3 p = cross(direction, e2);
    const double determinant = dot(e1, p);
    if (determinant == 0) return std::nullopt;
    const Vec3 s = origin - triangle[0], q = cross(s, e1);
    const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
    if (!(u >= -edge_margin && v >= -edge_margin && u + v <= 1 + edge_margin)) return std::nullopt;
    const double t = dot(e2, q) / determinant;
    if (!(t >= -edge_margin && t <= 1 + edge_margin)) return std::nullopt;
    return std::clamp(t, 0.0, 1.0);
}

}  // namespace

EnclosedSolid::EnclosedSolid(const TriangleMesh& mesh) : tree_(mesh), winding_(mesh), bounds_(geometry::bounds(mesh)) {
    triangles_.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) triangles_.push_back(corners(mesh, i));
}

bool EnclosedSolid::contains(Vec3 p) const { return embody::contains(bounds_, p) && winding_.at(p) > 0.5; }

double EnclosedSolid::leave(Vec3 inside, Vec3 outside) const {
    // Finds every triangle on the path; then the first behind which it is outside. Behind the last it is.
    std::vector<double> met;
    const Vec3 way = outside - inside;
    tree_.query_ray(inside, way, 1, [&](std::uint32_t leaf, double max_t) {
        if (const auto t = meet(inside, way, triangles_[leaf])) met.push_back(*t);
        return max_t;
    });
    if (met.empty()) return halve(inside, outside);  // through a hole
    std::sort(met.begin(), met.end());
    for (std::size_t i = 0; i + 1 < met.size(); ++i) {
        if (!contains(inside + 0.5 * (met[i] + met[i + 1]) * way)) return met[i];
    }
    return met.back();
}

double EnclosedSolid::halve(Vec3 inside, Vec3 outside) const {
    double within = 0, beyond = 1;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (within + beyond);
        (contains(inside + middle * (outside - inside)) ? within : beyond) = middle;
    }
    return 0.5 * (within + beyond);
}

}  // namespace embody::geometry
