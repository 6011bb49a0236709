// SPDX-License-Identifier: MIT
//
// Triangles and cells: M. Schwarz, H.-P. Seidel, "Fast parallel surface and solid voxelization on GPUs", ACM Trans. on
// Graphics 29(6), 2010: a box overlaps a triangle iff it does so with its plane and in the three projections.
// Distances on the grid: P. Felzenszwalb, D. Huttenlocher, "Distance transforms of sampled functions", Theory of
// Computing 8, 2012, along one axis after the other; close to the surface by the triangles themselves.
// The generalised winding number was the alternative for inside and outside; it takes an open mug for solid.
#include "geometry/decomposition/solid_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/triangle_distance.h"

namespace embody::geometry {
namespace {

constexpr int most_cells_a_side = 256;
constexpr double exact_within = 1.8;  // cells: those that touch a cell with surface

// One axis of the squared distance transform: the lower envelope of parabolas over the samples f.
class Envelope {
public:
    explicit Envelope(std::size_t longest) : from_(longest), border_(longest + 1), result_(longest) {}

    template <class Get, class Set>
    void transform(int n, Get get, Set set) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        int last = -1;
        for (int q = 0; q < n; ++q) {
            if (get(q) == infinity) continue;
            float start = -infinity;
            while (last >= 0) {
                const int v = from_[static_cast<std::size_t>(last)];
                start = ((get(q) + float(q * q)) - (get(v) + float(v * v))) / float(2 * (q - v));
                if (start > border_[static_cast<std::size_t>(last)]) break;
                --last;
                start = -infinity;
            }
            ++last;
            from_[static_cast<std::size_t>(last)] = q;
            border_[static_cast<std::size_t>(last)] = start;
        }
        if (last < 0) return;
        int k = 0;
        for (int q = 0; q < n; ++q) {
            while (k < last && border_[static_cast<std::size_t>(k + 1)] < float(q)) ++k;
            const int v = from_[static_cast<std::size_t>(k)];
            result_[static_cast<std::size_t>(q)] = float((q - v) * (q - v)) + get(v);
        }
        for (int q = 0; q < n; ++q) set(q, result_[static_cast<std::size_t>(q)]);
    }

private:
    std::vector<int> from_;
    std::vector<float> border_, result_;
};

}  // namespace

// ---------------------------------------------------------------------------------------- distances

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh) : tree_(mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) triangles_.push_back(corners(mesh, i));
    box_ = tree_.bounds();
}

double SurfaceDistance::at(Vec3 p, double limit) const {
    double best = limit * limit;
    tree_.query(enlarged({p, p}, limit),
                [&](std::uint32_t leaf) { best = std::min(best, squared_distance(p, triangles_[leaf])); });
    return std::sqrt(best);
}

double SurfaceDistance::at(Vec3 p) const {
    if (triangles_.empty()) return std::numeric_limits<double>::infinity();
    // A ball that grows until it contains a triangle; the bounds give a radius that is certainly empty.
    const Vec3 nearest = min(max(p, box_.lower), box_.upper);
    const double size = length(box_.size());
    double limit = distance(p, nearest) + 0.02 * size + 1e-12;
    for (int i = 0; i < 60; ++i) {
        const double found = at(p, limit);
        if (found < limit) return found;
        limit = 2 * limit;
    }
    return limit;
}

// ---------------------------------------------------------------------------------------- cells

SolidGrid::SolidGrid(const TriangleMesh& mesh, int cells, double least_cell, bool open_below) {
    const Bounds box = bounds(mesh);
    const Vec3 size = box.is_empty() ? Vec3{} : box.size();
    const double largest = std::max({size.x, size.y, size.z, 1e-12});
    cell_ = std::max(
        {std::cbrt(size.x * size.y * size.z / std::max(cells, 64)), least_cell, largest / (most_cells_a_side - 4)});
    // The surface lies in the middle of the outermost cells that it touches, with one row of cells around. Flat and
    // thin models have many more cells of that margin than inside, so the margin stays one.
    for (int k = 0; k < 3; ++k) {
        const int inside = std::max(1, static_cast<int>(std::ceil(size[k] / cell_ + 1e-9)));
        count_[static_cast<std::size_t>(k)] = inside + 2;
        lower_[k] = (box.is_empty() ? 0 : box.center()[k]) - 0.5 * cell_ * (inside + 2);
    }
    const auto all =
        static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(count_[2]);
    touched_.assign(all, 0);
    depth_.assign(all, 0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mark(corners(mesh, i));
    flood(open_below);
    measure_depths(mesh);
}

int SolidGrid::clamped(double at, int axis) const {
    const int last = count_[static_cast<std::size_t>(axis)] - 1;
    return at <= 0 ? 0 : at >= last ? last : static_cast<int>(at);
}

void SolidGrid::mark(const std::array<Vec3, 3>& triangle) {
    // The corners in cells, from the grid's corner.
    std::array<Vec3, 3> v{};
    Bounds box;
    for (std::size_t i = 0; i < 3; ++i) {
        v[i] = (triangle[i] - lower_) / cell_;
        box.add(v[i]);
    }
    const Vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    const Vec3 reach = abs(normal);
    const double plane = dot(normal, v[0]), half = 0.5 * (reach.x + reach.y + reach.z);

    // In each projection a cell must lie within all three sides: sign · (e × (q - start)) >= -reach of the cell.
    struct Side {
        int a, b;              // the projection's axes
        double na, nb, least;  // inwards normal, least value at the cell's centre
    };
    std::array<Side, 9> sides{};
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double sign = normal[axis] >= 0 ? 1 : -1;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 edge = v[(i + 1) % 3] - v[i];
            const double na = -sign * edge[b], nb = sign * edge[a];
            const double least = na * v[i][a] + nb * v[i][b] - 0.5 * (std::fabs(na) + std::fabs(nb));
            sides[count++] = {a, b, na, nb, least - 1e-9};
        }
    }
    const int x1 = clamped(box.upper.x, 0), y1 = clamped(box.upper.y, 1), z1 = clamped(box.upper.z, 2);
    for (int z = clamped(box.lower.z, 2); z <= z1; ++z) {
        for (int y = clamped(box.lower.y, 1); y <= y1; ++y) {
            for (int x = clamped(box.lower.x, 0); x <= x1; ++x) {
                const Vec3 c{x + 0.5, y + 0.5, z + 0.5};
                if (std::fabs(dot(normal, c) - plane) > half + 1e-9) continue;
                bool meets = true;
                for (const Side& s : sides) meets = meets && s.na * c[s.a] + s.nb * c[s.b] >= s.least;
                if (meets) touched_[index(x, y, z)] = 1;
            }
        }
    }
}

// From the margin into all cells that no triangle touches: sideways and down, and up only if `open_below`.
void SolidGrid::flood(bool open_below) {
    std::vector<Cell> front;
    const auto enter = [&](int x, int y, int z) {
        if (x < 0 || y < 0 || z < 0 || x >= count_[0] || y >= count_[1] || z >= count_[2]) return;
        const std::size_t i = index(x, y, z);
        if (touched_[i] != 0 || depth_[i] != 0) return;
        depth_[i] = 1;  // outside; its depth follows later
        front.push_back({x, y, z});
    };
    for (int z = 0; z < count_[2]; ++z) {
        for (int y = 0; y < count_[1]; ++y) {
            for (int x = 0; x < count_[0]; ++x) {
                const bool side = x == 0 || z == 0 || x == count_[0] - 1 || z == count_[2] - 1;
                // The lowest row lies below the floor that the model stands on.
                if (y == 0 ? open_below : side || y == count_[1] - 1) enter(x, y, z);
            }
        }
    }
    while (!front.empty()) {
        const auto [x, y, z] = front.back();
        front.pop_back();
        enter(x - 1, y, z);
        enter(x + 1, y, z);
        enter(x, y, z - 1);
        enter(x, y, z + 1);
        if (y > 1 || open_below) enter(x, y - 1, z);
        if (open_below) enter(x, y + 1, z);
    }
}

void SolidGrid::measure_depths(const TriangleMesh& mesh) {
    // Squared distances in cells from the cells that are touched.
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> squared(depth_.size());
    for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = touched_[i] != 0 ? 0 : infinity;
    Envelope envelope(static_cast<std::size_t>(std::max({count_[0], count_[1], count_[2]})));
    const std::array<std::size_t, 3> stride{index(1, 0, 0), index(0, 1, 0), index(0, 0, 1)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t p = (axis + 1) % 3, q = (axis + 2) % 3;
        for (int j = 0; j < count_[q]; ++j) {
            for (int i = 0; i < count_[p]; ++i) {
                float* line =
                    squared.data() + static_cast<std::size_t>(i) * stride[p] + static_cast<std::size_t>(j) * stride[q];
                const std::size_t step = stride[axis];
                envelope.transform(
                    count_[axis], [&](int k) { return line[static_cast<std::size_t>(k) * step]; },
                    [&](int k, float value) { line[static_cast<std::size_t>(k) * step] = value; });
            }
        }
    }

    // Close to the surface a cell is too coarse.
    const SurfaceDistance surface(mesh);
    std::size_t i = 0;
    for (int z = 0; z < count_[2]; ++z) {
        for (int y = 0; y < count_[1]; ++y) {
            for (int x = 0; x < count_[0]; ++x, ++i) {
                if (depth_[i] == 0) continue;
                const double cells = std::sqrt(static_cast<double>(squared[i]));
                double depth = cells * cell_;
                if (cells <= exact_within) depth = surface.at(center(x, y, z), (cells + 0.9) * cell_);
                depth_[i] = std::max(static_cast<float>(depth), 1e-30f);
            }
        }
    }
}

std::vector<Void> SolidGrid::voids(double least_depth) const {
    std::vector<Void> found;
    std::size_t i = 0;
    for (int z = 0; z < count_[2]; ++z) {
        for (int y = 0; y < count_[1]; ++y) {
            for (int x = 0; x < count_[0]; ++x, ++i) {
                if (static_cast<double>(depth_[i]) > least_depth)
                    found.push_back({to_vec3f(center(x, y, z)), depth_[i]});
            }
        }
    }
    return found;
}

double SolidGrid::depth_at(Vec3 p) const {
    const Vec3 at = (p - lower_) / cell_;
    return static_cast<double>(depth_[index(clamped(at.x, 0), clamped(at.y, 1), clamped(at.z, 2))]);
}

bool SolidGrid::is_filled(Vec3 p) const { return depth_at(p) == 0; }

}  // namespace embody::geometry
