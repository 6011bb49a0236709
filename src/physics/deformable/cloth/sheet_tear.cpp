// SPDX-License-Identifier: MIT
//
// The energy that a tear releases as the force on its tip in the sheet at rest: J. D. Eshelby, "The force on an elastic
// singularity" (1951); of finite elements as in F. Z. Li, C. F. Shih and A. Needleman, "A comparison of methods for
// calculating energy release rates", Engineering Fracture Mechanics 21 (1985). C. Miehe and E. Gürses, "A robust
// algorithm for configurational-force-driven brittle crack propagation" (2007), tear along edges by it.
#include "physics/deformable/cloth/sheet_tear.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "math/mat3.h"

namespace embody::physics::deformable {

namespace {

// Of the symmetric matrix [a c; c b].
double largest_principal(double a, double b, double c) { return (a + b) / 2 + std::hypot((a - b) / 2, c); }

}  // namespace

SheetTear::SheetTear(const std::vector<Vec3>& rest, const Cloth& cloth, std::span<const ClothTriangle> triangles)
    : strength_(cloth.tear_strength), energy_(cloth.tear_energy) {
    if (std::isinf(strength_) && std::isinf(energy_)) return;
    rest_ = rest;
    fans_ = NodeFans(cloth.triangles, rest.size());
    for (const ClothTriangle& triangle : triangles) {
        Vec3 f, g;
        for (std::size_t k = 0; k < 3; ++k) {
            f += triangle.warp[k] * rest[triangle.node[k]];
            g += triangle.weft[k] * rest[triangle.node[k]];
        }
        axes_.push_back({normalized(f), normalized(g)});
    }
    for (std::uint32_t i = 0; i < rest.size(); ++i) {
        const std::vector<NodeFan> fans = fans_.around(i);
        if (is_stitch(fans)) stitches_.push_back(i);
        if (std::isinf(energy_) || fans.size() != 1 || fans[0].is_closed()) continue;
        const std::vector<std::uint32_t>& spokes = fans[0].spokes;
        if (rest[spokes.front()] == rest[spokes.back()]) tips_.push_back(tip_at(i, fans[0]));
    }
}

// What tears around a held node, which stays one, leaves its fans beside each other.
bool SheetTear::is_stitch(std::span<const NodeFan> fans) const {
    for (std::size_t a = 0; a < fans.size(); ++a) {
        for (std::size_t b = 0; b < fans.size(); ++b) {
            if (a != b && rest_[fans[a].spokes.back()] == rest_[fans[b].spokes.front()]) return true;
        }
    }
    return false;
}

SheetTear::Tip SheetTear::tip_at(std::uint32_t node, const NodeFan& fan) const {
    const std::vector<std::uint32_t>& spokes = fan.spokes;
    Tip tip{node, spokes, {node, spokes.front(), spokes.back()}, {}};
    for (std::size_t k = 1; k + 1 < spokes.size(); ++k) {
        const std::uint32_t near = spokes[k];
        const std::vector<NodeFan> fans = fans_.around(near);
        if (fans.size() == 1 && fans[0].is_closed()) tip.around.push_back(near);  // a hem stays where it is
    }
    for (const std::uint32_t near : tip.around) {
        for (const std::uint32_t triangle : fans_.triangles_of(near)) tip.triangles.push_back(triangle);
    }
    std::ranges::sort(tip.triangles);
    tip.triangles.erase(std::unique(tip.triangles.begin(), tip.triangles.end()), tip.triangles.end());
    return tip;
}

// The energy that the sheet loses, for the length, where the tip and what is around it are shifted in the sheet at
// rest: J = -Σ A (W 1 - Fᵀ ∂W/∂F) ∇q, with q 1 at what is shifted and 0 beyond.
Vec3 SheetTear::release_at(const Tip& tip, std::span<const ClothTriangle> triangles,
                           std::span<const SheetStress> stress, std::span<const std::uint8_t> held) const {
    Vec3 sum;
    for (const std::uint32_t t : tip.triangles) {
        const ClothTriangle& triangle = triangles[t];
        double along_warp = 0, along_weft = 0;  // ∇q
        for (std::size_t k = 0; k < 3; ++k) {
            if (held[triangle.node[k]] != 0 || std::ranges::find(tip.around, triangle.node[k]) == tip.around.end())
                continue;
            along_warp += triangle.warp[k];
            along_weft += triangle.weft[k];
        }
        const auto& [warp, weft] = stress[t].pull;
        const double energy = stress[t].energy;
        sum -= triangle.area * ((energy * along_warp - warp[0] * along_warp - warp[1] * along_weft) * axes_[t][0] +
                                (energy * along_weft - weft[0] * along_warp - weft[1] * along_weft) * axes_[t][1]);
    }
    return sum;
}

// The largest principal tension of the triangles' mean, and the edges that have most across them.
SheetTear::Start SheetTear::start_at(std::uint32_t node, std::span<const ClothTriangle> triangles,
                                     std::span<const SheetStress> stress) const {
    const std::vector<NodeFan> fans = fans_.around(node);
    if (fans.size() != 1) return {};
    const auto& [fan, spokes] = fans[0];
    Mat3 sum = Mat3::zero();
    Vec3 normal;
    double area = 0;
    for (const std::uint32_t t : fan) {
        const double own = triangles[t].area;
        const auto& [f, g] = axes_[t];
        sum += own * (stress[t].warp * outer(f, f) + stress[t].weft * outer(g, g) +
                      stress[t].shear * (outer(f, g) + outer(g, f)));
        normal += own * cross(f, g);
        area += own;
    }
    const Mat3 tension = (1 / area) * sum;
    normal = normalized(normal);
    const Vec3 u = any_perpendicular(normal), v = cross(normal, u);
    const double uu = dot(u, tension * u), uv = dot(u, tension * v), vv = dot(v, tension * v);
    Start start;
    start.excess = largest_principal(uu, vv, uv) / strength_;
    if (!(start.excess > 1)) return {};

    // At a hem one edge leads into the sheet; elsewhere two that lead away from each other.
    const auto along = [&](std::size_t k) { return normalized(rest_[spokes[k]] - rest_[node]); };
    const auto across = [&](std::size_t k) {
        const Vec3 out = cross(normal, along(k));
        return dot(out, tension * out);
    };
    const bool is_closed = fans[0].is_closed();
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = is_closed ? 0 : 1; k + 1 < spokes.size(); ++k) {
        if (!is_closed && across(k) > most) {
            most = across(k);
            start.edges = {edge_between(node, spokes[k])};
        }
        for (std::size_t other = k + 1; is_closed && other + 1 < spokes.size(); ++other) {
            if (dot(along(k), along(other)) >= 0 || across(k) + across(other) <= most) continue;
            most = across(k) + across(other);
            start.edges = {edge_between(node, spokes[k]), edge_between(node, spokes[other])};
        }
    }
    return start;
}

// A mean of tensors has no larger principal value than the mean of theirs: most nodes need no more than that.
SheetTear::Start SheetTear::find_start(std::span<const ClothTriangle> triangles, std::span<const SheetStress> stress,
                                       std::span<const std::uint8_t> held) const {
    std::vector<double> tension(rest_.size(), 0), area(rest_.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const double own = largest_principal(stress[t].warp, stress[t].weft, stress[t].shear);
        for (const std::uint32_t node : triangles[t].node) {
            tension[node] += triangles[t].area * own;
            area[node] += triangles[t].area;
        }
    }
    std::vector<std::uint8_t> is_at_tip(rest_.size(), 0);
    for (const Tip& tip : tips_) {
        if (held[tip.node] != 0) continue;
        is_at_tip[tip.node] = 1;
        for (const std::uint32_t near : tip.ring) is_at_tip[near] = 1;
    }
    Start worst;
    for (std::uint32_t i = 0; i < rest_.size(); ++i) {
        if (is_at_tip[i] != 0 || held[i] != 0 || !(tension[i] > area[i] * strength_)) continue;
        Start start = start_at(i, triangles, stress);
        if (start.excess > worst.excess && !start.edges.empty()) worst = std::move(start);
    }
    return worst;
}

// Cuts so many edges that lie nearest to the direction, up to a hem or a held node.
void SheetTear::run_on(std::uint32_t tip, Vec3 direction, double edges, std::span<const std::uint8_t> held,
                       std::vector<SheetEdge>& cut) const {
    bool is_inside = false;
    for (double left = edges; left >= 1; --left) {
        const std::vector<NodeFan> fans = fans_.around(tip);
        if (fans.size() != 1 || (is_inside && !fans[0].is_closed())) return;
        double most = 0;
        std::uint32_t next = tip;
        const std::vector<std::uint32_t>& spokes = fans[0].spokes;
        for (std::size_t k = is_inside ? 0 : 1; k + 1 < spokes.size(); ++k) {
            const double along = dot(direction, normalized(rest_[spokes[k]] - rest_[tip]));
            if (along > most) {
                most = along;
                next = spokes[k];
            }
        }
        if (next == tip) return;
        cut.push_back(edge_between(tip, next));
        if (held[next] != 0) return;
        tip = next;
        is_inside = true;
    }
}

std::vector<TornCorner> SheetTear::find(std::span<const ClothTriangle> triangles, std::span<const SheetStress> stress,
                                        std::span<const std::uint8_t> held) const {
    std::vector<SheetEdge> cut;
    for (const Tip& tip : tips_) {
        if (held[tip.node] != 0) continue;
        const Vec3 release = release_at(tip, triangles, stress, held);
        if (length(release) >= energy_) run_on(tip.node, normalized(release), length(release) / energy_, held, cut);
    }
    if (!std::isinf(strength_)) {
        const Start worst = find_start(triangles, stress, held);
        cut.insert(cut.end(), worst.edges.begin(), worst.edges.end());
    }
    std::vector<std::uint32_t> loose;
    std::ranges::copy_if(stitches_, std::back_inserter(loose), [&](std::uint32_t node) { return held[node] == 0; });
    return cut.empty() && loose.empty() ? std::vector<TornCorner>() : fans_.split(std::move(cut), held, loose);
}

}  // namespace embody::physics::deformable
