// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/triangle_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "geometry/bounding_volume_tree.h"
#include "physics/collision/shapes/placed_triangle.h"

namespace embody::physics::collision {

struct TriangleSurface::Tree {
    geometry::BoundingVolumeTree tree;
};

namespace {

// Corners at the same place are one, or the edge between two triangles of a "soup" would pass for open.
std::vector<std::uint32_t> weld(const std::vector<Vec3f>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    // Zeros of both signs are equal here, as they must be.
    const auto place = [&positions](std::uint32_t i) {
        return std::tie(positions[i].x, positions[i].y, positions[i].z);
    };
    std::sort(order.begin(), order.end(), [&place](std::uint32_t i, std::uint32_t k) {
        return place(i) != place(k) ? place(i) < place(k) : i < k;
    });
    std::vector<std::uint32_t> same(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_first = i == 0 || place(order[i]) != place(order[i - 1]);
        same[order[i]] = is_first ? order[i] : same[order[i - 1]];
    }
    return same;
}

/// One side of a triangle.
struct Side {
    std::uint32_t high = 0;  ///< its corner of the higher number
    std::uint32_t triangle = 0, edge = 0;
};

/// The sides of all triangles by their corner of the lower number.
struct SideTable {
    std::vector<std::uint32_t> first;
    std::vector<Side> sides;

    SideTable(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t corners) : first(corners + 1) {
        const auto for_each_side = [&triangles](auto&& visit) {
            for (std::uint32_t t = 0; t < triangles.size(); ++t) {
                for (std::uint32_t e = 0; e < 3; ++e) {
                    const std::uint32_t u = triangles[t][e], v = triangles[t][e == 2 ? 0 : e + 1];
                    if (u != v) visit(std::min(u, v), Side{std::max(u, v), t, e});
                }
            }
        };
        for_each_side([this](std::uint32_t low, const Side&) { ++first[low + 1]; });
        for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
        sides.resize(first.back());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for_each_side([&](std::uint32_t low, const Side& side) { sides[next[low]++] = side; });
    }
    // Sides of one corner, sorted by the other one; equal ones stay in the order of the triangles.
    [[nodiscard]] std::span<Side> of(std::size_t low) {
        const std::span<Side> own(sides.data() + first[low], sides.data() + first[low + 1]);
        std::stable_sort(own.begin(), own.end(), [](const Side& a, const Side& b) { return a.high < b.high; });
        return own;
    }
};

}  // namespace

TriangleSurface::TriangleSurface(const MeshShape& mesh) : positions_(mesh.positions) {
    const std::vector<std::uint32_t> same = weld(positions_);
    triangles_.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) triangles_.push_back({same[t[0]], same[t[1]], same[t[2]]});

    // The tree over the triangles' bounds, and the bounds of all that are used.
    std::vector<Bounds> leaves(triangles_.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        for (const std::uint32_t corner : triangles_[i]) leaves[i].add(positions_[corner]);
        bounds_.add(leaves[i]);
    }
    tree_ = std::make_unique<Tree>();
    tree_->tree = geometry::BoundingVolumeTree(leaves);
    half_dihedrals_.resize(triangles_.size());
    const std::vector<Neighbours> neighbours = find_neighbours();
    for (std::uint32_t t = 0; t < count(); ++t) measure_dihedrals(t, neighbours[t]);
}

TriangleSurface::TriangleSurface(const HeightfieldShape& field)
    : heights_(field.heights),
      columns_(field.columns),
      rows_(field.rows),
      cell_x_(field.cell_x),
      cell_z_(field.cell_z),
      half_dihedrals_(2 * static_cast<std::size_t>(field.columns - 1) * static_cast<std::size_t>(field.rows - 1)) {
    const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
    bounds_ = {{0, static_cast<double>(*low), 0},
               {(columns_ - 1) * cell_x_, static_cast<double>(*high), (rows_ - 1) * cell_z_}};
    for (std::uint32_t t = 0; t < count(); ++t) measure_dihedrals(t, neighbours_in_field(t));
}

TriangleSurface::~TriangleSurface() = default;

std::vector<TriangleSurface::Neighbours> TriangleSurface::find_neighbours() const {
    std::vector<Neighbours> neighbours(triangles_.size(), {no_neighbour, no_neighbour, no_neighbour});
    SideTable table(triangles_, positions_.size());

    // Two triangles that run along their common edge in opposite directions are neighbours; where more than two meet,
    // the edge stays open, which only costs smoothness there.
    for (std::size_t low = 0; low < positions_.size(); ++low) {
        const std::span<Side> sides = table.of(low);
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i + 1;
            while (end < sides.size() && sides[end].high == sides[i].high) ++end;
            const Side &a = sides[i], &b = sides[end - 1];
            if (end - i == 2 && triangles_[a.triangle][a.edge] != triangles_[b.triangle][b.edge]) {
                neighbours[a.triangle][a.edge] = b.triangle;
                neighbours[b.triangle][b.edge] = a.triangle;
            }
            i = end;
        }
    }
    return neighbours;
}

void TriangleSurface::measure_dihedrals(std::uint32_t triangle, const Neighbours& neighbours) {
    const Vec3 own = normal(triangle);
    const auto at = corners(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        float& half = half_dihedrals_[triangle][e];
        half = std::numeric_limits<float>::infinity();
        if (neighbours[e] == no_neighbour) continue;
        // Towards the outside the neighbour's normal leans away over a convex edge, back over a concave one.
        const Vec3 other = normal(neighbours[e]), outward = normalized(cross(at[e == 2 ? 0 : e + 1] - at[e], own));
        const double sine = dot(other, outward), cosine = dot(other, own);
        const bool is_folded = sine <= 0 && cosine < -1 + 1e-12;
        half = is_folded ? -1e6F : static_cast<float>(sine / (1 + cosine));
    }
}

std::array<Vec3, 3> TriangleSurface::corners_in_field(std::uint32_t triangle) const {
    const int cell = static_cast<int>(triangle / 2), row = cell / (columns_ - 1), column = cell % (columns_ - 1);
    const auto at = [this](int c, int r) {
        return Vec3{c * cell_x_, static_cast<double>(heights_[sample(c, r)]), r * cell_z_};
    };
    if (triangle % 2 == 0) return {at(column, row), at(column, row + 1), at(column + 1, row + 1)};
    return {at(column, row), at(column + 1, row + 1), at(column + 1, row)};
}

TriangleSurface::Neighbours TriangleSurface::neighbours_in_field(std::uint32_t triangle) const {
    const auto cells = static_cast<std::uint32_t>(columns_ - 1), cell = triangle / 2;
    const std::uint32_t row = cell / cells, column = cell % cells, row_after = 2 * cells;
    // The first half of a cell ends at its left and lower sides, the second at its right and upper ones.
    if (triangle % 2 == 0) {
        const bool is_lowest = row + 2 == static_cast<std::uint32_t>(rows_);
        return {column == 0 ? no_neighbour : triangle - 1, is_lowest ? no_neighbour : triangle + row_after + 1,
                triangle + 1};
    }
    return {triangle - 1, column + 1 == cells ? no_neighbour : triangle + 1,
            row == 0 ? no_neighbour : triangle - row_after - 1};
}

Vec3 TriangleSurface::normal(std::uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    return normalized(cross(b - a, c - a));
}

std::size_t TriangleSurface::memory_bytes() const {
    const std::size_t of_tree = tree_ ? tree_->tree.memory_bytes() : 0;
    return of_tree + positions_.size() * sizeof(Vec3f) + heights_.size() * sizeof(float) +
           triangles_.size() * sizeof(triangles_[0]) + half_dihedrals_.size() * sizeof(half_dihedrals_[0]);
}

void TriangleSurface::find(const Bounds& box, std::vector<std::uint32_t>& found) const {
    if (!tree_) {
        find_in_field(box, found);
        return;
    }
    tree_->tree.query(box, [&](std::uint32_t triangle) {
        __builtin_prefetch(&triangles_[triangle]);
        __builtin_prefetch(&half_dihedrals_[triangle]);
        found.push_back(triangle);
    });
}

void TriangleSurface::find_in_field(const Bounds& box, std::vector<std::uint32_t>& found) const {
    // The cells below the box; clamped before the conversion, which far off numbers would overflow.
    const auto cell = [](double at, double size, int cells) {
        return static_cast<int>(std::clamp(std::floor(at / size), -1.0, static_cast<double>(cells)));
    };
    const int left = std::max(0, cell(box.lower.x, cell_x_, columns_ - 1));
    const int right = std::min(columns_ - 2, cell(box.upper.x, cell_x_, columns_ - 1));
    const int back = std::max(0, cell(box.lower.z, cell_z_, rows_ - 1));
    const int front = std::min(rows_ - 2, cell(box.upper.z, cell_z_, rows_ - 1));
    for (int r = back; r <= front; ++r) {
        for (int c = left; c <= right; ++c) {
            // Both halves hold the ends of the diagonal, and one corner beside it.
            const auto height = [&](int column, int row) { return static_cast<double>(heights_[sample(column, row)]); };
            const double begin = height(c, r), end = height(c + 1, r + 1);
            const double low = std::min(begin, end), high = std::max(begin, end);
            const std::uint32_t first_half = 2 * static_cast<std::uint32_t>(r * (columns_ - 1) + c);
            const double beside[2] = {height(c, r + 1), height(c + 1, r)};
            for (std::uint32_t half = 0; half < 2; ++half) {
                if (std::min(low, beside[half]) > box.upper.y || std::max(high, beside[half]) < box.lower.y) continue;
                found.push_back(first_half + half);
            }
        }
    }
}

void TriangleSurface::find_along_ray(Vec3 origin, Vec3 direction, double max_distance,
                                     const std::function<double(std::uint32_t, double)>& visit) const {
    if (tree_) {
        tree_->tree.query_ray(origin, direction, max_distance, visit);
        return;
    }
    // The part of the ray within the field's bounds, walked in pieces of a few cells.
    double enter = 0, leave = max_distance;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(direction[axis]) < 1e-300) {
            if (origin[axis] < bounds_.lower[axis] || origin[axis] > bounds_.upper[axis]) return;
            continue;
        }
        const double a = (bounds_.lower[axis] - origin[axis]) / direction[axis];
        const double b = (bounds_.upper[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    // A slack of rounding, so that a ray in the plane of a flat field is not lost.
    const double slack = 1e-9 * (1 + length(bounds_.size()) + std::fabs(enter));
    enter = std::max(0.0, enter - slack);
    leave = std::min(max_distance, leave + slack);
    const double flat_speed = std::max(std::fabs(direction.x) / cell_x_, std::fabs(direction.z) / cell_z_);
    const double stride = flat_speed > 1e-12 ? 4 / flat_speed : leave - enter + 1;
    std::vector<std::uint32_t> found;
    for (double from = enter; from <= leave; from += stride) {
        Bounds piece;
        piece.add(origin + direction * from);
        piece.add(origin + direction * std::min(leave, from + stride));
        found.clear();
        find(enlarged(piece, slack), found);
        for (const std::uint32_t triangle : found) leave = std::min(leave, visit(triangle, leave));
    }
}

}  // namespace embody::physics::collision
