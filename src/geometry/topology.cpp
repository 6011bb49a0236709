// SPDX-License-Identifier: MIT
#include "geometry/topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "geometry/mass_properties.h"

namespace embody::geometry {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

// ---------------------------------------------------------------------------------------- weld

// Kept vertices in cells a few tolerances wide, so that a search around a point mostly reads one cell.
class VertexGrid {
public:
    explicit VertexGrid(double tolerance) : tolerance_(tolerance), cell_(4 * tolerance) {}

    // The first kept vertex within the tolerance of p, or p itself, newly kept.
    std::uint32_t find_or_keep(Vec3f p, std::vector<Vec3f>& kept) {
        const Vec3 point = to_vec3(p);
        const Vec3 reach{tolerance_, tolerance_, tolerance_};
        const Cell low = cell_of(point - reach), high = cell_of(point + reach);
        std::uint32_t best = none;
        for (std::int64_t x = low.x; x <= high.x; ++x) {
            for (std::int64_t y = low.y; y <= high.y; ++y) {
                for (std::int64_t z = low.z; z <= high.z; ++z) best = std::min(best, find_in({x, y, z}, point, kept));
            }
        }
        if (best != none) return best;
        const auto index = static_cast<std::uint32_t>(kept.size());
        kept.push_back(p);
        const auto [head, is_new] = head_of_cell_.try_emplace(cell_of(point), index);
        next_in_cell_.push_back(is_new ? none : head->second);
        head->second = index;
        return index;
    }

private:
    struct Cell {
        std::int64_t x = 0, y = 0, z = 0;
        bool operator==(const Cell&) const = default;
    };
    struct CellHash {
        std::size_t operator()(const Cell& c) const {
            std::uint64_t h = static_cast<std::uint64_t>(c.x) * 0x9E3779B97F4A7C15ull;
            h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(c.y)) * 0xBF58476D1CE4E5B9ull;
            h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(c.z)) * 0x94D049BB133111EBull;
            return h ^ (h >> 32);
        }
    };

    // Far cells are clamped to the last one; with tolerance 0 the cells are the floats themselves.
    std::int64_t cell_of(double x) const {
        if (cell_ == 0) return static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x));
        return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_), -9e18, 9e18));
    }
    Cell cell_of(Vec3 p) const { return {cell_of(p.x), cell_of(p.y), cell_of(p.z)}; }

    std::uint32_t find_in(const Cell& cell, Vec3 point, const std::vector<Vec3f>& kept) const {
        const auto head = head_of_cell_.find(cell);
        std::uint32_t best = none;
        for (std::uint32_t i = head == head_of_cell_.end() ? none : head->second; i != none; i = next_in_cell_[i]) {
            if (distance(to_vec3(kept[i]), point) <= tolerance_) best = std::min(best, i);
        }
        return best;
    }

    double tolerance_;
    double cell_;
    std::unordered_map<Cell, std::uint32_t, CellHash> head_of_cell_;  // looked up only, never iterated
    std::vector<std::uint32_t> next_in_cell_;                         // parallel to the kept vertices
};

using Triangle = std::array<std::uint32_t, 3>;

// Marks every triangle that has the same corners as an earlier one, in whichever order.
std::vector<bool> find_copies(const std::vector<Triangle>& triangles) {
    std::vector<std::pair<Triangle, std::uint32_t>> sorted;
    sorted.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        Triangle t = triangles[i];
        std::sort(t.begin(), t.end());
        sorted.emplace_back(t, i);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<bool> copy(triangles.size(), false);
    for (std::size_t i = 1; i < sorted.size(); ++i) copy[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
    return copy;
}

// ---------------------------------------------------------------------------------------- edges

// One side of a triangle. Sorting brings the sides of an edge together.
struct Side {
    std::uint32_t low, high;  // vertices
    std::uint32_t triangle;
    bool forwards;  // runs from low to high

    bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
    bool operator<(const Side& other) const {
        if (low != other.low) return low < other.low;
        if (high != other.high) return high < other.high;
        return triangle < other.triangle;
    }
};

std::vector<Side> sorted_sides(const TriangleMesh& mesh) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), i, a < b});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

// Calls visit(first side, number of sides) for each edge.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t count = 1;
        while (i + count < sides.size() && sides[i].same_edge(sides[i + count])) ++count;
        visit(&sides[i], count);
        i += count;
    }
}

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// Neighbours across edges with exactly two triangles, and whether the two agree in direction.
struct Neighbour {
    std::uint32_t triangle = none;
    bool agrees = true;
};
std::vector<std::array<Neighbour, 3>> find_neighbours(const TriangleMesh& mesh) {
    std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
    std::vector<std::uint8_t> filled(mesh.triangles.size(), 0);
    for_each_edge(sorted_sides(mesh), [&](const Side* side, std::size_t count) {
        if (count != 2 || side[0].triangle == side[1].triangle) return;
        const bool agrees = side[0].forwards != side[1].forwards;
        neighbours[side[0].triangle][filled[side[0].triangle]++] = {side[1].triangle, agrees};
        neighbours[side[1].triangle][filled[side[1].triangle]++] = {side[0].triangle, agrees};
    });
    return neighbours;
}

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh, double tolerance) {
    // Vertices, in the order in which triangles use them.
    VertexGrid grid(tolerance);
    TriangleMesh welded;
    std::vector<std::uint32_t> new_index(mesh.positions.size(), none);
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const Triangle& old : mesh.triangles) {
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& index = new_index[old[k]];
            if (index == none) index = grid.find_or_keep(mesh.positions[old[k]], welded.positions);
            t[k] = index;
        }
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
    }

    // Triangles, without copies.
    const std::vector<bool> copy = find_copies(triangles);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!copy[i]) welded.triangles.push_back(triangles[i]);
    }

    // Vertices that only degenerate triangles used are dropped.
    std::vector<std::uint32_t> place(welded.positions.size(), none);
    std::vector<Vec3f> used;
    for (Triangle& t : welded.triangles) {
        for (std::uint32_t& vertex : t) {
            if (place[vertex] == none) {
                place[vertex] = static_cast<std::uint32_t>(used.size());
                used.push_back(welded.positions[vertex]);
            }
            vertex = place[vertex];
        }
    }
    welded.positions = std::move(used);
    return welded;
}

Topology find_topology(const TriangleMesh& mesh) {
    Topology topology;
    std::vector<std::uint32_t> parent(mesh.triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for_each_edge(sorted_sides(mesh), [&](const Side* side, std::size_t count) {
        ++topology.edge_count;
        if (count == 1) ++topology.boundary_edges;
        if (count > 2) ++topology.crowded_edges;
        if (count == 2 && side[0].forwards == side[1].forwards) ++topology.inconsistent_edges;
        // The smaller root wins, so that components are numbered by their first triangle.
        for (std::size_t i = 1; i < count; ++i) {
            const std::uint32_t a = find_root(parent, side[0].triangle), b = find_root(parent, side[i].triangle);
            parent[std::max(a, b)] = std::min(a, b);
        }
    });

    topology.component_of.resize(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = find_root(parent, i);
        topology.component_of[i] = root == i ? topology.component_count++ : topology.component_of[root];
    }
    return topology;
}

bool is_closed(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return false;
    return find_topology(weld(mesh, 1e-6 * length(bounds(mesh).size()))).is_closed();
}

TriangleMesh oriented_outwards(const TriangleMesh& mesh) {
    TriangleMesh oriented = mesh;
    const auto neighbours = find_neighbours(mesh);
    std::vector<std::uint8_t> turned(mesh.triangles.size(), 0), seen(mesh.triangles.size(), 0);
    std::vector<std::uint32_t> patch;
    for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (seen[seed] != 0) continue;
        // Spreads from the seed: a neighbour is turned where the common edge requires it.
        patch.assign(1, seed);
        seen[seed] = 1;
        for (std::size_t i = 0; i < patch.size(); ++i) {
            for (const Neighbour& n : neighbours[patch[i]]) {
                if (n.triangle == none || seen[n.triangle] != 0) continue;
                seen[n.triangle] = 1;
                turned[n.triangle] = static_cast<std::uint8_t>(turned[patch[i]] ^ (n.agrees ? 0 : 1));
                patch.push_back(n.triangle);
            }
        }

        // Outwards is the orientation of positive volume.
        Bounds box;
        for (const std::uint32_t i : patch) {
            for (const Vec3 corner : corners(mesh, i)) box.add(corner);
        }
        PolyhedronIntegral integral(box.center());
        for (const std::uint32_t i : patch) {
            if (turned[i] != 0) std::swap(oriented.triangles[i][1], oriented.triangles[i][2]);
            const auto [a, b, c] = corners(oriented, i);
            integral.add_triangle(a, b, c);
        }
        if (integral.mass_properties().volume >= 0) continue;
        for (const std::uint32_t i : patch) std::swap(oriented.triangles[i][1], oriented.triangles[i][2]);
    }
    return oriented;
}

std::vector<TriangleMesh> split_components(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<TriangleMesh> parts(topology.component_count);
    std::vector<std::vector<std::uint32_t>> members(topology.component_count);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) members[topology.component_of[i]].push_back(i);

    // A vertex may belong to several components that touch in it, so its new index is valid for one part only.
    std::vector<std::uint32_t> place(mesh.positions.size(), none), owner(mesh.positions.size(), none);
    for (std::uint32_t part = 0; part < parts.size(); ++part) {
        for (const std::uint32_t i : members[part]) {
            Triangle t = mesh.triangles[i];
            for (std::uint32_t& vertex : t) {
                if (owner[vertex] != part) {
                    owner[vertex] = part;
                    place[vertex] = static_cast<std::uint32_t>(parts[part].positions.size());
                    parts[part].positions.push_back(mesh.positions[vertex]);
                }
                vertex = place[vertex];
            }
            parts[part].triangles.push_back(t);
        }
    }
    return parts;
}

}  // namespace embody::geometry
