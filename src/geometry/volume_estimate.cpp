// SPDX-License-Identifier: MIT
//
// A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers",
// ACM Trans. on Graphics 32(4), 2013: w(p) = (1/4π) Σ Ω_f(p), the solid angles of all triangles (their eq. 5), from
// A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomedical Engineering 30(2), 1983:
//   tan(Ω/2) = a·(b×c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|).
// G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson, "Fast winding numbers for soups and clouds", ACM Trans. on
// Graphics 37(4), 2018: a cluster farther away than β radii counts as the dipole n·r / (4π r³) (their eq. 12, first
// order). Flood filling from outside was the alternative; it leaks through every missing back or bottom.
#include "geometry/volume_estimate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/topology.h"

namespace embody::geometry {
namespace {

// β of Barill et al. With 2 the number is off by at most 0.05 in the tests, with 3 by 0.025 at 1.8 times the time; the
// decision lies at one half.
constexpr double far_away = 2.0;
constexpr std::uint32_t triangles_per_cluster = 8;
constexpr double weld_tolerance = 1e-6;     // of the mesh's size
constexpr double exact_error = 1e-6;        // single precision positions
constexpr double thinnest_enclosed = 1e-4;  // a volume below this fraction of (size · area) is a sheet

// Solid angle of a triangle seen from the origin.
double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
    const double la = length(a), lb = length(b), lc = length(c);
    const double numerator = dot(a, cross(b, c));
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2 * std::atan2(numerator, denominator);
}

Vec3 centroid(const std::array<Vec3, 3>& t) { return (t[0] + t[1] + t[2]) / 3; }

}  // namespace

const char* name(VolumeMethod method) {
    switch (method) {
        case VolumeMethod::closed_mesh:
            return "closed mesh";
        case VolumeMethod::closed_parts:
            return "closed parts";
        case VolumeMethod::winding_number:
            return "winding number";
        case VolumeMethod::no_volume:
            break;
    }
    return "no volume";
}

// ---------------------------------------------------------------------------------------- winding number

WindingNumber::WindingNumber(const TriangleMesh& mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) triangles_.push_back(corners(mesh, i));
    if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingNumber::build(std::uint32_t first, std::uint32_t last) {
    // The dipole sits at the area-weighted middle; its radius reaches every corner.
    Cluster cluster;
    Bounds middles;
    double area = 0;
    for (std::uint32_t i = first; i < last; ++i) {
        const auto& [a, b, c] = triangles_[i];
        const Vec3 n = 0.5 * cross(b - a, c - a);
        cluster.area_vector += n;
        cluster.center += length(n) * centroid(triangles_[i]);
        area += length(n);
        middles.add(centroid(triangles_[i]));
    }
    cluster.center = area > 0 ? cluster.center / area : middles.center();
    for (std::uint32_t i = first; i < last; ++i) {
        for (const Vec3 corner : triangles_[i]) {
            cluster.radius = std::max(cluster.radius, distance(corner, cluster.center));
        }
    }

    // Halves along the longest axis, by count: balanced, so the recursion is shallow.
    const std::size_t index = clusters_.size();
    const bool leaf = last - first <= triangles_per_cluster;
    cluster.first = first;
    cluster.count = leaf ? last - first : 0;
    clusters_.push_back(cluster);
    if (!leaf) {
        const Vec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t middle = first + (last - first) / 2;
        std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
                         [axis](const auto& s, const auto& t) { return centroid(s)[axis] < centroid(t)[axis]; });
        build(first, middle);
        build(middle, last);
    }
    clusters_[index].next = static_cast<std::uint32_t>(clusters_.size());
}

double WindingNumber::at(Vec3 point) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < clusters_.size();) {
        const Cluster& cluster = clusters_[i];
        const Vec3 r = cluster.center - point;
        const double squared = length_squared(r);
        if (squared > far_away * far_away * cluster.radius * cluster.radius) {
            sum += dot(cluster.area_vector, r) / (squared * std::sqrt(squared));
            i = cluster.next;
            continue;
        }
        for (std::uint32_t k = cluster.first; k < cluster.first + cluster.count; ++k) {
            const auto& [a, b, c] = triangles_[k];
            sum += solid_angle(a - point, b - point, c - point);
        }
        ++i;
    }
    return sum / (4 * std::numbers::pi);
}

// ---------------------------------------------------------------------------------------- volume

namespace {

// The mesh divided into parts that can be integrated and parts that cannot.
struct Parts {
    TriangleMesh closed, open;
    MassProperties closed_sum;  // overlaps counted twice
    bool closed_apart = true;   // no two closed parts' bounds overlap
};

void append(TriangleMesh& mesh, const TriangleMesh& part) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    for (const auto& t : part.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

Parts sort_parts(const TriangleMesh& mesh, const Topology& topology) {
    Parts parts;
    std::vector<Bounds> boxes;
    for (const TriangleMesh& part : split_components(mesh, topology)) {
        const bool closed = find_topology(part).is_closed();
        append(closed ? parts.closed : parts.open, part);
        if (!closed) continue;
        parts.closed_sum = combined(parts.closed_sum, integrate_polyhedron(part));
        boxes.push_back(bounds(part));
    }
    // Sorted along x, so that many small parts need few comparisons.
    std::sort(boxes.begin(), boxes.end(), [](const Bounds& a, const Bounds& b) { return a.lower.x < b.lower.x; });
    for (std::size_t i = 0; i < boxes.size() && parts.closed_apart; ++i) {
        for (std::size_t k = i + 1; k < boxes.size() && boxes[k].lower.x <= boxes[i].upper.x; ++k) {
            if (overlaps(boxes[i], boxes[k])) parts.closed_apart = false;
        }
    }
    return parts;
}

// Nearly cubic cells over a box, at least four along each axis.
struct Grid {
    Vec3 lower, cell;
    std::array<int, 3> count{};

    Grid(const Bounds& box, int cells) : lower(box.lower) {
        const Vec3 size = box.size();
        const double wanted = std::cbrt(size.x * size.y * size.z / std::max(cells, 64));
        for (int k = 0; k < 3; ++k) {
            const double n = wanted > 0 ? std::round(size[k] / wanted) : 4;
            const int whole = static_cast<int>(std::clamp(n, 4.0, 512.0));
            count[static_cast<std::size_t>(k)] = whole;
            cell[k] = size[k] / whole;
        }
    }
    [[nodiscard]] double cell_volume() const { return cell.x * cell.y * cell.z; }

    template <class Visit>
    void for_each_center(Visit visit) const {
        for (int z = 0; z < count[2]; ++z) {
            for (int y = 0; y < count[1]; ++y) {
                for (int x = 0; x < count[0]; ++x) visit(lower + scale(cell, {x + 0.5, y + 0.5, z + 0.5}));
            }
        }
    }
};

// Weighted cells as one solid; weights may be negative.
class CellSum {
public:
    CellSum(Vec3 reference, const Grid& grid) : reference_(reference), grid_(grid) {}

    void add(Vec3 center, double weight) {
        const Vec3 r = center - reference_;
        weight_ += weight;
        absolute_ += std::fabs(weight);
        first_moment_ += weight * r;
        second_moment_ += weight * outer(r, r);
    }
    // Volume of all cells added, whatever their sign.
    [[nodiscard]] double touched_volume() const { return absolute_ * grid_.cell_volume(); }

    // `solid` with the cells added, all moments taken about the reference.
    [[nodiscard]] MassProperties added_to(const MassProperties& solid) const {
        MassProperties result;
        result.volume = solid.volume + weight_ * grid_.cell_volume();
        result.center = reference_;
        if (!(result.volume > 0)) return result;

        const Vec3 offset = solid.center - reference_;
        const Vec3 mean = (solid.volume * offset + grid_.cell_volume() * first_moment_) / result.volume;
        const Mat3 cells = second_moment_ + weight_ * Mat3::diagonal(scale(grid_.cell, grid_.cell) / 12);
        const Mat3 own = grid_.cell_volume() * (trace(cells) * Mat3::identity() - cells);
        const Mat3 about_reference = inertia_about(solid.inertia, solid.volume, offset) + own;
        result.center += mean;
        result.inertia = inertia_about(about_reference, -result.volume, mean);
        return result;
    }

private:
    Vec3 reference_;
    const Grid& grid_;
    double weight_ = 0, absolute_ = 0;
    Vec3 first_moment_;
    Mat3 second_moment_ = Mat3::zero();
};

// The closed parts' exact sum, corrected cell by cell: +1 where only open parts wind around a cell, -1 for each time
// that closed parts have counted a cell too often.
VolumeEstimate correct_on_grid(const Parts& parts, const Bounds& box, int cells) {
    const Grid grid(box, cells);
    const WindingNumber closed(parts.closed), open(parts.open);
    CellSum correction(box.center(), grid);
    grid.for_each_center([&](Vec3 center) {
        const double around_closed = closed.at(center);
        const double counted = std::max(0.0, std::round(around_closed));
        const double inside = around_closed + open.at(center) > 0.5 ? 1 : 0;
        if (inside != counted) correction.add(center, inside - counted);
    });

    // Expected error: a tenth of a cell along open surfaces, half of what the cells corrected in closed parts. Measured
    // errors lie below this for the shapes in the tests.
    VolumeEstimate estimate;
    estimate.solid = correction.added_to(parts.closed_sum);
    estimate.method = parts.open.triangles.empty() ? VolumeMethod::closed_parts : VolumeMethod::winding_number;
    const double corrected = parts.open.triangles.empty() ? 0.5 * correction.touched_volume() : 0;
    const double doubtful = 0.1 * std::cbrt(grid.cell_volume()) * surface_area(parts.open) + corrected;
    if (estimate.solid.volume > 0) {
        estimate.relative_error = std::min(1.0, 0.01 + doubtful / estimate.solid.volume);
    }
    return estimate;
}

}  // namespace

VolumeEstimate estimate_volume(const TriangleMesh& mesh, int cells) {
    VolumeEstimate estimate;
    if (mesh.triangles.empty()) return estimate;
    const Bounds box = bounds(mesh);
    const double size = length(box.size());
    const TriangleMesh welded = oriented_outwards(weld(mesh, weld_tolerance * size));
    const Topology topology = find_topology(welded);
    const Parts parts = sort_parts(welded, topology);

    // Closed parts that do not overlap are exact, all else needs the grid.
    if (parts.open.triangles.empty() && parts.closed_apart) {
        estimate.solid = parts.closed_sum;
        estimate.method = VolumeMethod::closed_mesh;
        estimate.relative_error = exact_error;
    } else {
        estimate = correct_on_grid(parts, box, cells);
    }
    if (!(estimate.solid.volume > thinnest_enclosed * size * surface_area(welded))) {
        estimate = {};
        estimate.solid.center = box.center();
    }
    estimate.boundary_edges = topology.boundary_edges;
    estimate.component_count = topology.component_count;
    return estimate;
}

}  // namespace embody::geometry
