// SPDX-License-Identifier: MIT
#include "physics/collision/triangle_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "geometry/bounding_volume_tree.h"

namespace embody::physics {

struct TriangleSurface::Tree {
    geometry::BoundingVolumeTree tree;
};

namespace {

// Corners at the same place are one, or the edge between two triangles of a "soup" would pass for open.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions) {
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    std::vector<std::uint32_t> same(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const Vec3 p = positions[i];
        // Adding zero turns -0 into +0.
        same[i] = first.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, i).first->second;
    }
    return same;
}

}  // namespace

TriangleSurface::TriangleSurface(const MeshShape& mesh) {
    for (const Vec3f& p : mesh.positions) positions_.push_back(to_vec3(p));
    const std::vector<std::uint32_t> same = weld(positions_);
    for (const auto& t : mesh.triangles) triangles_.push_back({same[t[0]], same[t[1]], same[t[2]]});

    // The tree over the triangles' bounds, and the bounds of all that are used.
    std::vector<Bounds> leaves(triangles_.size());
    for (std::uint32_t i = 0; i < count(); ++i) {
        for (const Vec3& p : corners(i)) leaves[i].add(p);
        bounds_.add(leaves[i]);
    }
    tree_ = std::make_unique<Tree>();
    tree_->tree = geometry::BoundingVolumeTree(leaves);
    link_neighbours();
}

TriangleSurface::TriangleSurface(const HeightfieldShape& field)
    : columns_(field.columns), rows_(field.rows), cell_x_(field.cell_x), cell_z_(field.cell_z) {
    for (int r = 0; r < rows_; ++r) {
        for (int c = 0; c < columns_; ++c) {
            const auto height = field.heights[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                                              static_cast<std::size_t>(c)];
            positions_.push_back({c * cell_x_, static_cast<double>(height), r * cell_z_});
            bounds_.add(positions_.back());
        }
    }
    const auto sample = [&](int c, int r) { return static_cast<std::uint32_t>(r * columns_ + c); };
    for (int r = 0; r + 1 < rows_; ++r) {
        for (int c = 0; c + 1 < columns_; ++c) {
            triangles_.push_back({sample(c, r), sample(c, r + 1), sample(c + 1, r + 1)});
            triangles_.push_back({sample(c, r), sample(c + 1, r + 1), sample(c + 1, r)});
        }
    }
    link_neighbours();
}

TriangleSurface::~TriangleSurface() = default;

void TriangleSurface::link_neighbours() {
    struct Side {
        std::uint32_t low, high, triangle, edge;
        auto key() const { return std::tie(low, high, triangle, edge); }
    };
    std::vector<Side> sides;
    neighbours_.assign(triangles_.size(), {no_neighbour, no_neighbour, no_neighbour});
    for (std::uint32_t t = 0; t < count(); ++t) {
        for (std::uint32_t e = 0; e < 3; ++e) {
            const std::uint32_t u = triangles_[t][e], v = triangles_[t][(e + 1) % 3];
            if (u != v) sides.push_back({std::min(u, v), std::max(u, v), t, e});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });

    // Two triangles that run along their common edge in opposite directions are neighbours; where more than two meet,
    // the edge stays open, which only costs smoothness there.
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
        if (end - i == 2) {
            const Side &a = sides[i], &b = sides[i + 1];
            if (triangles_[a.triangle][a.edge] != triangles_[b.triangle][b.edge]) {
                neighbours_[a.triangle][a.edge] = b.triangle;
                neighbours_[b.triangle][b.edge] = a.triangle;
            }
        }
        i = end;
    }
}

std::array<Vec3, 3> TriangleSurface::corners(std::uint32_t triangle) const {
    const auto& t = triangles_[triangle];
    return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
}

Vec3 TriangleSurface::normal(std::uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    return normalized(cross(b - a, c - a));
}

void TriangleSurface::find(const Bounds& box, std::vector<std::uint32_t>& found) const {
    if (tree_) {
        const std::size_t first = found.size();
        tree_->tree.query(box, [&found](std::uint32_t triangle) { found.push_back(triangle); });
        std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
        return;
    }
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
            for (std::uint32_t half = 0; half < 2; ++half) {
                const std::uint32_t triangle = 2 * static_cast<std::uint32_t>(r * (columns_ - 1) + c) + half;
                Bounds b;
                for (const Vec3& p : corners(triangle)) b.add(p);
                if (overlaps(b, box)) found.push_back(triangle);
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

}  // namespace embody::physics
