// SPDX-License-Identifier: MIT
//
// Surface integrals over a triangle of area A with s = a + b + c (exact: the integrands are quadratic):
//   ∫ dA = A,   ∫ x dA = A/3 · s,   ∫ x xᵀ dA = A/12 · (aaᵀ + bbᵀ + ccᵀ + ssᵀ).
#include "geometry/solid_and_shell.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/topology.h"

namespace embody::geometry {
namespace {

constexpr double widest_opening = 1.0 / 3;  // of the closed surface; with a larger opening it encloses nothing
constexpr double thinnest_solid = 1e-4;     // a volume below this fraction of (size · area) is a sheet

// A side of a triangle that is no side of another triangle, in the triangle's direction.
using RimEdge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<RimEdge> rim_of(const TriangleMesh& mesh) {
    // Sides that share an edge come together: (low, high) first, then the side itself.
    std::vector<std::pair<RimEdge, RimEdge>> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const RimEdge side{t[k], t[(k + 1) % 3]};
            sides.push_back({std::minmax(side.first, side.second), side});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<RimEdge> rim;
    for (std::size_t first = 0, next = 0; first < sides.size(); first = next) {
        while (next < sides.size() && sides[next].first == sides[first].first) ++next;
        if (next == first + 1) rim.push_back(sides[first].second);
    }
    return rim;
}

// Vertex → number of the opening on whose rim it lies.
std::map<std::uint32_t, std::uint32_t> openings_of(const std::vector<RimEdge>& rim) {
    std::map<std::uint32_t, std::uint32_t> parent;
    const auto root = [&](std::uint32_t vertex) {
        while (parent.at(vertex) != vertex) vertex = parent.at(vertex) = parent.at(parent.at(vertex));
        return vertex;
    };
    for (const auto& [a, b] : rim) {
        parent.try_emplace(a, a);
        parent.try_emplace(b, b);
        const std::uint32_t ra = root(a), rb = root(b);
        parent[std::max(ra, rb)] = std::min(ra, rb);
    }
    for (auto& [vertex, above] : parent) above = root(vertex);
    return parent;
}

// A connected piece of surface with its openings closed by fans.
MassProperties integrate_closed(const TriangleMesh& piece) {
    const std::vector<RimEdge> rim = rim_of(piece);
    const auto opening_of = openings_of(rim);

    // The middle of each rim, its edges weighted by their lengths.
    struct Middle {
        Vec3 sum;
        double weight = 0;
    };
    std::map<std::uint32_t, Middle> middles;
    const auto position = [&](std::uint32_t vertex) { return to_vec3(piece.positions[vertex]); };
    for (const auto& [a, b] : rim) {
        Middle& middle = middles[opening_of.at(a)];
        const double length = distance(position(a), position(b));
        middle.sum += length / 2 * (position(a) + position(b));
        middle.weight += length;
    }

    // The surface, then its fans, which run the rim backwards.
    PolyhedronIntegral integral(bounds(piece).center());
    for (std::size_t i = 0; i < piece.triangles.size(); ++i) {
        const auto [a, b, c] = corners(piece, i);
        integral.add_triangle(a, b, c);
    }
    double opened = 0;
    for (const auto& [a, b] : rim) {
        const Middle& middle = middles[opening_of.at(a)];
        if (!(middle.weight > 0)) continue;
        const Vec3 center = middle.sum / middle.weight;
        integral.add_triangle(position(b), position(a), center);
        opened += length(cross(position(a) - center, position(b) - center)) / 2;
    }

    const double area = surface_area(piece);
    const MassProperties solid = integral.mass_properties();
    const bool is_sheet = solid.volume <= thinnest_solid * length(bounds(piece).size()) * area;
    if (opened > widest_opening * (area + opened) || is_sheet) return {};
    return solid;
}

}  // namespace

MassProperties integrate_shell(const TriangleMesh& mesh) {
    const Vec3 reference = mesh.triangles.empty() ? Vec3{} : bounds(mesh).center();
    double area = 0;
    Vec3 first;
    Mat3 second = Mat3::zero();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto [a, b, c] = corners(mesh, i);
        a -= reference;
        b -= reference;
        c -= reference;
        const double own = length(cross(b - a, c - a)) / 2;
        const Vec3 s = a + b + c;
        area += own;
        first += (own / 3) * s;
        second += (own / 12) * (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s));
    }
    if (!(area > 0)) return {};
    const Vec3 offset = first / area;
    const Mat3 covariance = second - area * outer(offset, offset);
    return {area, reference + offset, trace(covariance) * Mat3::identity() - covariance};
}

SolidAndShell integrate_solid_and_shell(const TriangleMesh& mesh) {
    SolidAndShell result;
    result.shell = integrate_shell(mesh);
    if (mesh.triangles.empty()) return result;
    for (const TriangleMesh& piece : split_components(mesh, find_topology(mesh))) {
        result.solid = combined(result.solid, integrate_closed(piece));
    }
    return result;
}

}  // namespace embody::geometry
