// SPDX-License-Identifier: MIT
//
// Bending by the rotation-free triangle of E. Oñate and F. Zárate, "Rotation-free triangular plate and shell elements",
// International Journal for Numerical Methods in Engineering 47 (2000): the curvature of a triangle is given by the
// slopes across its edges, each the mean of the two triangles that share the edge. With the hinge vector of M. Bergou,
// M. Wardetzky, D. Harmon, D. Zorin and E. Grinspun, "A quadratic bending model for inextensible surfaces" (2006),
// linear in the nodes, in the place of edge length times angle, the energy is quadratic and keeps its value when the
// sheet turns. At free edges the moment across the edge is zero: that part of the curvature is condensed out.
#include "physics/deformable/cloth/cloth_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace embody::physics::deformable {

namespace {

double cotangent(Vec3 a, Vec3 b) { return dot(a, b) / length(cross(a, b)); }

// A fold, or a free edge.
struct MeshEdge {
    BendHinge hinge;
    int sides = 0;            // 1: a free edge
    std::uint32_t index = 0;  // of the hinge among those of two sides
};

// The triangle's corner k, seen from the edge that it does not touch.
struct Side {
    std::uint32_t opposite = 0;
    double cot_first = 0, cot_second = 0;  // of the angles at the edge's ends
};

using EdgeMap = std::map<SheetEdge, MeshEdge>;

Side side_of(const std::vector<Vec3>& nodes, SheetEdge edge, std::uint32_t opposite) {
    const Vec3 a = nodes[edge.first], b = nodes[edge.second], c = nodes[opposite];
    return {opposite, cotangent(b - a, c - a), cotangent(a - b, c - b)};
}

EdgeMap find_edges(const std::vector<Vec3>& nodes, const Cloth& cloth) {
    EdgeMap edges;
    for (const auto& triangle : cloth.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const SheetEdge ends = edge_between(triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
            auto& [hinge, sides, index] = edges[ends];
            if (++sides > 2) continue;  // where three sheets meet the first two are one sheet
            const Side side = side_of(nodes, ends, triangle[k]);
            if (sides == 1) hinge = {{ends.first, ends.second, side.opposite, side.opposite}, {0, 0, 0, 0}};
            // c03 + c04, c01 + c02, -c01 - c03, -c02 - c04 in the paper's names
            hinge.weight[0] += side.cot_second;
            hinge.weight[1] += side.cot_first;
            hinge.node[static_cast<std::size_t>(sides + 1)] = side.opposite;
            hinge.weight[static_cast<std::size_t>(sides + 1)] = -side.cot_first - side.cot_second;
        }
    }
    return edges;
}

// n nᵀ of an edge's normal in the triangle's plane, as a vector whose product is that of the tensors: xx, yy, √2 xy.
Vec3 tensor_of(Vec3 along, Vec3 u, Vec3 v) {
    const Vec3 t = normalized(along);
    const double x = -dot(t, v), y = dot(t, u);
    return {x * x, y * y, std::sqrt(2.0) * x * y};
}

// Two axes in the triangle's plane, the first along the warp.
std::array<Vec3, 2> axes_of(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 normal = normalized(cross(b - a, c - a));
    const Vec3 along = std::fabs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    const Vec3 warp = normalized(along - dot(along, normal) * normal);
    return {warp, cross(normal, warp)};
}

using Pairs = std::map<SheetEdge, double>;  // of the upper half and the diagonal

void add_product(const BendHinge& a, const BendHinge& b, double factor, Pairs& pairs) {
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            // Both (a, b) and (b, a) occur: each ordered pair of nodes once, its mirror image in the other triangle.
            if (a.node[i] <= b.node[k]) pairs[{a.node[i], b.node[k]}] += factor * a.weight[i] * b.weight[k];
        }
    }
}

// Λ = (1 / 2A) Σ_e r_e n_e n_eᵀ, less its part that free edges take away.
BendTriangle bend_triangle(const std::vector<Vec3>& nodes, const std::array<std::uint32_t, 3>& corners,
                           const EdgeMap& edges) {
    const Vec3 a = nodes[corners[0]], b = nodes[corners[1]], c = nodes[corners[2]];
    BendTriangle triangle;
    triangle.area = length(cross(b - a, c - a)) / 2;
    const auto [u, v] = axes_of(a, b, c);
    std::array<Vec3, 3> free_part;
    std::size_t free_count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t first = corners[(k + 1) % 3], second = corners[(k + 2) % 3];
        const MeshEdge& edge = edges.at(edge_between(first, second));
        triangle.part[k] = tensor_of(nodes[second] - nodes[first], u, v);
        if (edge.sides > 1) {
            triangle.hinge[k] = edge.index;
            continue;
        }
        Vec3 part = triangle.part[k];
        for (std::size_t f = 0; f < free_count; ++f) part -= dot(part, free_part[f]) * free_part[f];
        free_part[free_count++] = normalized(part);
    }
    for (Vec3& part : triangle.part) {
        for (std::size_t f = 0; f < free_count; ++f) part -= dot(part, free_part[f]) * free_part[f];
    }
    return triangle;
}

}  // namespace

SheetEdge edge_between(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

std::vector<ClothTriangle> make_cloth_triangles(const std::vector<Vec3>& nodes, const Cloth& cloth) {
    std::vector<ClothTriangle> triangles;
    triangles.reserve(cloth.triangles.size());
    for (const auto& corners : cloth.triangles) {
        const Vec3 a = nodes[corners[0]], b = nodes[corners[1]], c = nodes[corners[2]];
        const auto [u, v] = axes_of(a, b, c);
        const double bu = dot(b - a, u), bv = dot(b - a, v), cu = dot(c - a, u), cv = dot(c - a, v);
        const double twice = bu * cv - bv * cu;
        ClothTriangle triangle{corners, twice / 2, {0, cv / twice, -bv / twice}, {0, -cu / twice, bu / twice}};
        triangle.warp[0] = -triangle.warp[1] - triangle.warp[2];
        triangle.weft[0] = -triangle.weft[1] - triangle.weft[2];
        triangles.push_back(triangle);
    }
    return triangles;
}

BendElements make_bend_elements(const std::vector<Vec3>& nodes, const Cloth& cloth) {
    EdgeMap edges = find_edges(nodes, cloth);
    BendElements elements;
    for (auto& [ends, edge] : edges) {
        if (edge.sides < 2) continue;
        edge.index = static_cast<std::uint32_t>(elements.hinges.size());
        elements.hinges.push_back(edge.hinge);
    }
    for (const auto& triangle : cloth.triangles) elements.triangles.push_back(bend_triangle(nodes, triangle, edges));
    return elements;
}

ScalarRows make_bending_rows(const BendElements& elements, std::size_t nodes) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < nodes; ++i) pairs[{i, i}] = 0;
    for (const auto& [hinge, part, area] : elements.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (hinge[i] != BendTriangle::no_hinge && hinge[k] != BendTriangle::no_hinge)
                    add_product(elements.hinges[hinge[i]], elements.hinges[hinge[k]],
                                dot(part[i], part[k]) / (4 * area), pairs);
            }
        }
    }

    ScalarRows rows;
    rows.start.assign(nodes + 1, 0);
    for (const auto& [pair, value] : pairs) {
        ++rows.start[pair.first + 1];
        if (pair.second != pair.first) ++rows.start[pair.second + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) rows.start[i + 1] += rows.start[i];
    rows.column.resize(rows.start.back());
    rows.value.resize(rows.start.back());
    std::vector<std::uint32_t> next(rows.start.begin(), rows.start.end() - 1);
    const auto put = [&](std::uint32_t row, std::uint32_t column, double value) {
        rows.column[next[row]] = column;
        rows.value[next[row]++] = value;
    };
    for (std::uint32_t i = 0; i < nodes; ++i) put(i, i, pairs.at({i, i}));
    for (const auto& [pair, value] : pairs) {
        if (pair.first == pair.second) continue;
        put(pair.first, pair.second, value);
        put(pair.second, pair.first, value);
    }
    return rows;
}

}  // namespace embody::physics::deformable
