// SPDX-License-Identifier: MIT
#include "scene/embody/thin_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "attributes/form.h"
#include "geometry/bounding_volume_tree.h"
#include "physics/definitions/deformable_primitives.h"
#include "scene/embody/shape_surface.h"

namespace embody::scene {

namespace {

using attributes::SheetMesh;
using physics::DeformableDefinition;
using physics::ShapeDefinition;

constexpr double max_thickness = 1.0 / 3;  // of a sheet, relative to its width
constexpr double max_width = 1.0 / 4;      // of a line, relative to its length
constexpr double min_cover = 0.5;          // covered fraction of a triangle; a triangle with less is outside
constexpr int samples = 4;                 // along an edge of a triangle

// Axes by extent, the smallest first.
std::array<int, 3> axes_by_extent(Vec3 size) {
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::stable_sort(axes, {}, [size](int axis) { return size[axis]; });
    return axes;
}

Error no_sheet(std::string why) { return {"shape", "it is no sheet: " + std::move(why), "make it rigid or soft"}; }
Error no_line(std::string why) { return {"shape", "it is no rope: " + std::move(why), "make it rigid or soft"}; }
std::string metres(double value) { return attributes::short_number(value) + " m"; }

// Edge length of equilateral triangles that cover an area with this number of nodes.
double edge_for(double area, int nodes) { return std::sqrt(2 * area / (std::sqrt(3.0) * nodes)); }

// Turns a form that lies flat in XZ: its X is along `u` and its Z along `v`.
SheetMesh placed(const DeformableDefinition& flat, Vec3 center, int u, int v) {
    SheetMesh sheet;
    for (const Vec3 node : flat.nodes) {
        Vec3 at = center;
        at[u] += node.x;
        at[v] += node.z;
        sheet.nodes.push_back(at);
    }
    sheet.triangles = std::get<physics::Cloth>(flat.matter).triangles;
    return sheet;
}

struct Plane {
    int u = 0, v = 0, across = 0;
};

Result<Plane> plane_of(Vec3 size) {
    const auto [thin, middle, wide] = axes_by_extent(size);
    if (!(size[middle] > 0)) return no_sheet("it has no area");
    if (size[thin] > max_thickness * size[middle])
        return no_sheet("it is " + metres(size[thin]) + " thick and only " + metres(size[middle]) + " wide");
    return Plane{std::min(middle, wide), std::max(middle, wide), thin};
}

SheetMesh rectangle(const Bounds& box, const Plane& plane, int nodes) {
    const Vec3 size = box.size();
    const double edge = edge_for(size[plane.u] * size[plane.v], nodes);
    return placed(physics::cloth_rectangle(size[plane.u], size[plane.v], edge), box.center(), plane.u, plane.v);
}

bool covers(const std::array<Vec3, 3>& t, Vec3 p, const Plane& plane) {
    const auto side = [&](Vec3 a, Vec3 b) {
        return (b[plane.u] - a[plane.u]) * (p[plane.v] - a[plane.v]) -
               (b[plane.v] - a[plane.v]) * (p[plane.u] - a[plane.u]);
    };
    const double ab = side(t[0], t[1]), bc = side(t[1], t[2]), ca = side(t[2], t[0]);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// The fraction of a sheet's triangle that the surface covers.
double cover_of(const std::array<Vec3, 3>& triangle, const geometry::TriangleMesh& surface,
                const geometry::BoundingVolumeTree& tree, const Plane& plane) {
    int covered = 0, all = 0;
    for (int i = 0; i < samples; ++i) {
        for (int k = 0; i + k < samples; ++k) {
            const double a = (i + 1.0 / 3) / samples, b = (k + 1.0 / 3) / samples;
            const Vec3 p = triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
            Bounds column{p, p};
            column.lower[plane.across] = tree.bounds().lower[plane.across] - 1e-3;
            column.upper[plane.across] = tree.bounds().upper[plane.across] + 1e-3;
            bool is_under = false;
            tree.query(column, [&](std::uint32_t index) {
                is_under = is_under || covers(geometry::corners(surface, index), p, plane);
            });
            covered += is_under ? 1 : 0;
            ++all;
        }
    }
    return static_cast<double>(covered) / all;
}

// The largest part that is connected by edges' ends, and only the nodes that it uses.
SheetMesh largest_part(const SheetMesh& sheet) {
    std::vector<std::uint32_t> leader(sheet.nodes.size());
    std::iota(leader.begin(), leader.end(), 0u);
    const auto find = [&leader](std::uint32_t node) {
        while (leader[node] != node) node = leader[node] = leader[leader[node]];
        return node;
    };
    for (const auto& [a, b, c] : sheet.triangles) {
        leader[find(b)] = find(a);
        leader[find(c)] = find(a);
    }
    std::vector<std::size_t> count(sheet.nodes.size(), 0);
    for (const auto& triangle : sheet.triangles) ++count[find(triangle[0])];
    const auto largest = static_cast<std::uint32_t>(std::ranges::max_element(count) - count.begin());
    constexpr std::uint32_t unused = 0xFFFFFFFF;
    SheetMesh part;
    std::vector<std::uint32_t> number(sheet.nodes.size(), unused);
    for (const auto& triangle : sheet.triangles) {
        if (find(triangle[0]) != largest) continue;
        auto& corners = part.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& own = number[triangle[k]];
            if (own == unused) {
                own = static_cast<std::uint32_t>(part.nodes.size());
                part.nodes.push_back(sheet.nodes[triangle[k]]);
            }
            corners[k] = own;
        }
    }
    return part;
}

// A line along an axis, `half` to either side of the origin.
LineForm straight_line(int axis, double half, double diameter, int segments) {
    LineForm line;
    line.diameter = diameter;
    for (int k = 0; k <= segments; ++k) {
        Vec3 node;
        node[axis] = half * (2.0 * k / segments - 1);
        line.nodes.push_back(node);
    }
    return line;
}

Result<int> long_axis(Vec3 size) {
    const auto [thin, middle, longest] = axes_by_extent(size);
    if (size[middle] > max_width * size[longest])
        return no_line("it is " + metres(size[longest]) + " long and " + metres(size[middle]) + " wide");
    return longest;
}

// Weights and centres of a surface at places along an axis.
struct Slices {
    std::vector<double> weight;
    std::vector<Vec3> center;
};

template <class Visit>
void for_each_sample(const geometry::TriangleMesh& surface, int axis, double spacing, Visit visit) {
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const auto [a, b, c] = geometry::corners(surface, i);
        const double low = std::min({a[axis], b[axis], c[axis]}), high = std::max({a[axis], b[axis], c[axis]});
        const int parts = std::clamp(static_cast<int>(2 * (high - low) / spacing) + 1, 1, 200);
        const double area = length(cross(b - a, c - a)) / (parts * parts);
        for (int k = 0; k < parts; ++k) {
            for (int l = 0; k + l < parts; ++l)
                visit(a + ((k + 1.0 / 3) / parts) * (b - a) + ((l + 1.0 / 3) / parts) * (c - a), area);
        }
    }
}

Slices slice(const geometry::TriangleMesh& surface, int axis, const Bounds& box, int segments) {
    Slices slices{std::vector<double>(static_cast<std::size_t>(segments) + 1, 0),
                  std::vector<Vec3>(static_cast<std::size_t>(segments) + 1)};
    const double spacing = box.size()[axis] / segments;
    for_each_sample(surface, axis, spacing, [&](Vec3 point, double area) {
        const auto k = static_cast<std::size_t>(std::lround((point[axis] - box.lower[axis]) / spacing));
        slices.weight[k] += area;
        slices.center[k] += area * point;
    });
    return slices;
}

}  // namespace

Result<SheetMesh> sheet_of(const geometry::TriangleMesh& surface, int nodes) {
    const Bounds box = geometry::bounds(surface);
    const Result<Plane> plane = plane_of(box.size());
    if (!plane) return plane.error();
    SheetMesh sheet = rectangle(box, *plane, nodes);
    const geometry::BoundingVolumeTree tree(surface);
    std::erase_if(sheet.triangles, [&](const std::array<std::uint32_t, 3>& t) {
        return cover_of({sheet.nodes[t[0]], sheet.nodes[t[1]], sheet.nodes[t[2]]}, surface, tree, *plane) < min_cover;
    });
    if (sheet.triangles.empty()) return no_sheet("nearly all of its outline is open");
    return largest_part(sheet);
}

Result<SheetMesh> sheet_of(const ShapeDefinition& shape, int nodes) {
    if (const auto* box = std::get_if<physics::BoxShape>(&shape)) {
        const Result<Plane> plane = plane_of(2 * box->half_extents);
        if (!plane) return plane.error();
        return rectangle({-box->half_extents, box->half_extents}, *plane, nodes);
    }
    const auto* disc = std::get_if<physics::CylinderShape>(&shape);
    if (disc && disc->half_height < disc->radius) {
        if (const auto plane = plane_of({2 * disc->radius, 2 * disc->half_height, 2 * disc->radius}); !plane)
            return plane.error();
        constexpr double pi = 3.14159265358979323846;
        const double edge = edge_for(pi * disc->radius * disc->radius, nodes);
        return placed(physics::cloth_disc(disc->radius, edge), {}, 0, 2);
    }
    const auto surface = surface_of(shape);
    if (!surface) return surface.error();
    return sheet_of(*surface, nodes);
}

Result<LineForm> line_of(const geometry::TriangleMesh& surface, int segments) {
    const Bounds box = geometry::bounds(surface);
    const Result<int> axis = long_axis(box.size());
    if (!axis) return axis.error();
    const Slices slices = slice(surface, *axis, box, segments);
    LineForm line;
    const double spacing = box.size()[*axis] / segments;
    for (std::size_t k = 0; k < slices.weight.size(); ++k) {
        // Where a slice is empty, the node before it is used.
        Vec3 node = k > 0 ? line.nodes[k - 1] : box.center();
        if (slices.weight[k] > 0) node = slices.center[k] / slices.weight[k];
        node[*axis] = box.lower[*axis] + spacing * static_cast<double>(k);
        line.nodes.push_back(node);
    }
    double away = 0, area = 0;
    for_each_sample(surface, *axis, spacing, [&](Vec3 point, double weight) {
        const auto k = static_cast<std::size_t>(std::lround((point[*axis] - box.lower[*axis]) / spacing));
        Vec3 arm = point - line.nodes[k];
        arm[*axis] = 0;
        away += weight * length(arm);
        area += weight;
    });
    if (!(away > 0)) return no_line("it has no surface");
    line.diameter = 2 * away / area;
    return line;
}

Result<LineForm> line_of(const ShapeDefinition& shape, int segments) {
    if (const auto* capsule = std::get_if<physics::CapsuleShape>(&shape)) {
        const double radius = capsule->radius, half = capsule->half_height;
        if (const auto axis = long_axis({2 * radius, 2 * (half + radius), 2 * radius}); !axis) return axis.error();
        return straight_line(1, half, 2 * radius, segments);
    }
    if (const auto* cylinder = std::get_if<physics::CylinderShape>(&shape)) {
        const Result<int> axis = long_axis(2 * Vec3{cylinder->radius, cylinder->half_height, cylinder->radius});
        if (!axis) return axis.error();
        if (*axis == 1) return straight_line(1, cylinder->half_height, 2 * cylinder->radius, segments);
    }
    if (const auto* box = std::get_if<physics::BoxShape>(&shape)) {
        const Vec3 h = box->half_extents;
        const Result<int> axis = long_axis(2 * h);
        if (!axis) return axis.error();
        return straight_line(*axis, h[*axis], 2 * std::sqrt(h.x * h.y * h.z / h[*axis]), segments);
    }
    const auto surface = surface_of(shape);
    if (!surface) return surface.error();
    return line_of(*surface, segments);
}

}  // namespace embody::scene
