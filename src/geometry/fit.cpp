// SPDX-License-Identifier: MIT
//
// Convex bodies are compared by their support functions: the Hausdorff distance of two convex bodies is the largest
// difference of h(u) = max u·p over all directions u (R. Schneider, "Convex Bodies: The Brunn-Minkowski Theory", 1993,
// theorem 1.8.11). Here u runs over the hull's face normals, the primitive's axes and an even set over the sphere.
// Boxes: the smallest has a face flush with the hull nearly always (J. O'Rourke, "Finding minimal enclosing boxes",
// 1985, proves two adjacent flush edges), so large faces with their edges are the frames to try.
#include "geometry/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace embody::geometry {
namespace {

constexpr int direction_count = 512;
constexpr std::size_t most_faces = 24;     // largest faces whose edges give frames
constexpr double worth_turning = 0.99;     // a turned box must be at least 1 % smaller
constexpr double least_half_height = 0.1;  // of the radius: a shorter capsule is a sphere
constexpr double pi = std::numbers::pi;

double support(const ConvexHull& hull, Vec3 direction) {
    double best = dot(hull.vertices[0], direction);
    for (const Vec3 v : hull.vertices) best = std::max(best, dot(v, direction));
    return best;
}

// Directions spread evenly over the sphere along a Fibonacci spiral.
std::vector<Vec3> even_directions(int count) {
    std::vector<Vec3> directions;
    const double golden_angle = pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2.0 * i + 1) / count, r = std::sqrt(1 - y * y);
        directions.push_back({r * std::cos(golden_angle * i), y, r * std::sin(golden_angle * i)});
    }
    return directions;
}

// The data that all fits to one hull use.
struct Subject {
    const ConvexHull& hull;
    MassProperties solid;
    std::vector<Vec3> directions;  // where surfaces are compared
    std::vector<double> supports;  // of the hull, parallel to directions
    std::vector<Mat3> frames;      // right-handed; the model's own first, then principal axes, then faces

    explicit Subject(const ConvexHull& h)
        : hull(h), solid(integrate_hull(h)), directions(even_directions(direction_count)) {
        for (const auto& face : hull.faces) directions.push_back(face.normal);
        for (const Vec3 u : directions) supports.push_back(support(hull, u));
        frames = {Mat3::identity(), eigen_symmetric(solid.inertia).vectors};
        add_face_frames();
    }

private:
    void add_face_frames() {
        std::vector<std::pair<double, std::uint32_t>> by_area;
        for (std::uint32_t f = 0; f < hull.faces.size(); ++f) {
            const auto corner = hull.corners(hull.faces[f]);
            Vec3 area;
            for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
                area += cross(hull.vertices[corner[i]] - hull.vertices[corner[0]],
                              hull.vertices[corner[i + 1]] - hull.vertices[corner[0]]);
            }
            by_area.emplace_back(-length(area), f);
        }
        std::sort(by_area.begin(), by_area.end());
        by_area.resize(std::min(by_area.size(), most_faces));
        for (const auto& [area, f] : by_area) add_frames_of(hull.faces[f]);
    }
    // The face's normal with its longest edges.
    void add_frames_of(const ConvexHull::Face& face) {
        const auto corner = hull.corners(face);
        std::vector<std::pair<double, std::size_t>> by_length;
        for (std::size_t i = 0; i < corner.size(); ++i) {
            const Vec3 side = hull.vertices[corner[(i + 1) % corner.size()]] - hull.vertices[corner[i]];
            by_length.emplace_back(-length(side), i);
        }
        std::sort(by_length.begin(), by_length.end());
        for (std::size_t k = 0; k < std::min<std::size_t>(4, by_length.size()); ++k) {
            const std::size_t i = by_length[k].second;
            const Vec3 side = hull.vertices[corner[(i + 1) % corner.size()]] - hull.vertices[corner[i]];
            const Vec3 x = normalized(side - dot(side, face.normal) * face.normal);
            if (x != Vec3{}) frames.push_back({x, face.normal, cross(x, face.normal)});
        }
    }
};

// The extent of the hull along a unit vector.
struct Extent {
    double low, high;
    [[nodiscard]] double middle() const { return (low + high) / 2; }
    [[nodiscard]] double half() const { return (high - low) / 2; }
};
Extent extent(const ConvexHull& hull, Vec3 axis) { return {-support(hull, -axis), support(hull, axis)}; }

void judge(const Subject& subject, PrimitiveFit& fit) {
    fit.volume_error = std::fabs(fit.volume() / subject.solid.volume - 1);
    fit.deviation = 0;
    const auto compare = [&](Vec3 u, double hull_support) {
        fit.deviation = std::max(fit.deviation, std::fabs(fit.support(u) - hull_support));
    };
    for (std::size_t i = 0; i < subject.directions.size(); ++i) compare(subject.directions[i], subject.supports[i]);
    const Mat3 axes = to_matrix(fit.local.rotation);
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                const Vec3 u = normalized(axes * Vec3{double(x), double(y), double(z)});
                if (u != Vec3{}) compare(u, support(subject.hull, u));
            }
        }
    }
}

PrimitiveFit box_in_frame(const ConvexHull& hull, const Mat3& frame) {
    PrimitiveFit fit;
    fit.kind = PrimitiveKind::box;
    fit.local.rotation = to_quat(frame);
    Vec3 middle;
    for (int k = 0; k < 3; ++k) {
        const Extent e = extent(hull, frame.column(k));
        fit.half_extents[k] = e.half();
        middle[k] = e.middle();
    }
    fit.local.position = frame * middle;
    return fit;
}

PrimitiveFit box_of(const Subject& subject) {
    PrimitiveFit best = box_in_frame(subject.hull, subject.frames[0]);
    double limit = worth_turning * best.volume();
    for (std::size_t i = 1; i < subject.frames.size(); ++i) {
        const PrimitiveFit fit = box_in_frame(subject.hull, subject.frames[i]);
        if (fit.volume() >= limit) continue;
        best = fit;
        limit = fit.volume() * (1 - 1e-9);
    }
    judge(subject, best);
    return best;
}

PrimitiveFit sphere_of(const Subject& subject) {
    PrimitiveFit fit;
    fit.kind = PrimitiveKind::sphere;
    fit.local.position = subject.solid.center;
    double smallest = HUGE_VAL, largest = 0;
    for (std::size_t i = 0; i < subject.directions.size(); ++i) {
        const double reach = subject.supports[i] - dot(subject.directions[i], subject.solid.center);
        smallest = std::min(smallest, reach);
        largest = std::max(largest, reach);
    }
    fit.radius = (smallest + largest) / 2;
    judge(subject, fit);
    return fit;
}

// A cylinder whose Y axis is column `axis` of the frame; radius from supports around it.
PrimitiveFit cylinder_along(const Subject& subject, const Mat3& frame, int axis) {
    const Vec3 y = frame.column(axis), z = frame.column((axis + 1) % 3), x = frame.column((axis + 2) % 3);
    const Extent along = extent(subject.hull, y);
    PrimitiveFit fit;
    fit.kind = PrimitiveKind::cylinder;
    fit.half_height = along.half();
    fit.local.rotation = to_quat({x, y, z});
    const Vec3 center = subject.solid.center - dot(subject.solid.center, y) * y;
    fit.local.position = center + along.middle() * y;

    double smallest = HUGE_VAL, largest = 0;
    constexpr int around = 64;
    for (int i = 0; i < around; ++i) {
        const Vec3 u = std::cos(2 * pi * i / around) * x + std::sin(2 * pi * i / around) * z;
        const double reach = support(subject.hull, u) - dot(u, center);
        smallest = std::min(smallest, reach);
        largest = std::max(largest, reach);
    }
    fit.radius = (smallest + largest) / 2;
    return fit;
}

double badness(const Subject& subject, const PrimitiveFit& fit) {
    const Vec3 size = bounds(subject.hull).size();
    return fit.volume_error + fit.deviation / std::max({size.x, size.y, size.z});
}

// The best of the candidates that `make` returns for each axis of each frame.
template <class Make>
std::optional<PrimitiveFit> best_over_axes(const Subject& subject, Make make) {
    std::optional<PrimitiveFit> best;
    std::vector<Vec3> tried;
    for (const Mat3& frame : subject.frames) {
        for (int axis = 0; axis < 3; ++axis) {
            // Frames of parallel faces repeat the same axes.
            const Vec3 y = frame.column(axis);
            if (std::ranges::any_of(tried, [&](Vec3 t) { return std::fabs(dot(t, y)) > 1 - 1e-9; })) continue;
            tried.push_back(y);
            std::optional<PrimitiveFit> fit = make(cylinder_along(subject, frame, axis));
            if (!fit) continue;
            judge(subject, *fit);
            // An equally good axis later in the list is not better: the model's own come first.
            if (!best || badness(subject, *fit) < 0.999 * badness(subject, *best)) best = fit;
        }
    }
    return best;
}

PrimitiveFit cylinder_of(const Subject& subject) {
    return *best_over_axes(subject, [](const PrimitiveFit& fit) { return std::optional(fit); });
}

std::optional<PrimitiveFit> capsule_of(const Subject& subject) {
    return best_over_axes(subject, [](PrimitiveFit fit) -> std::optional<PrimitiveFit> {
        fit.kind = PrimitiveKind::capsule;
        fit.half_height -= fit.radius;
        if (fit.half_height < least_half_height * fit.radius) return std::nullopt;
        return fit;
    });
}

}  // namespace

const char* name(PrimitiveKind kind) {
    switch (kind) {
        case PrimitiveKind::box:
            return "box";
        case PrimitiveKind::sphere:
            return "sphere";
        case PrimitiveKind::capsule:
            return "capsule";
        case PrimitiveKind::cylinder:
            break;
    }
    return "cylinder";
}

double PrimitiveFit::volume() const {
    const double disc = pi * radius * radius;
    switch (kind) {
        case PrimitiveKind::box:
            return 8 * half_extents.x * half_extents.y * half_extents.z;
        case PrimitiveKind::sphere:
            return disc * radius * 4 / 3;
        case PrimitiveKind::capsule:
            return disc * (2 * half_height + radius * 4 / 3);
        case PrimitiveKind::cylinder:
            break;
    }
    return disc * 2 * half_height;
}

double PrimitiveFit::support(Vec3 direction) const {
    const Vec3 u = rotate_inverse(local.rotation, direction);
    const double center = dot(direction, local.position);
    switch (kind) {
        case PrimitiveKind::box:
            return center + dot(half_extents, abs(u));
        case PrimitiveKind::sphere:
            return center + radius;
        case PrimitiveKind::capsule:
            return center + radius + half_height * std::fabs(u.y);
        case PrimitiveKind::cylinder:
            break;
    }
    return center + radius * std::sqrt(u.x * u.x + u.z * u.z) + half_height * std::fabs(u.y);
}

PrimitiveFit fit_box(const ConvexHull& hull) { return box_of(Subject(hull)); }
PrimitiveFit fit_sphere(const ConvexHull& hull) { return sphere_of(Subject(hull)); }
std::optional<PrimitiveFit> fit_capsule(const ConvexHull& hull) { return capsule_of(Subject(hull)); }
PrimitiveFit fit_cylinder(const ConvexHull& hull) { return cylinder_of(Subject(hull)); }

std::optional<PrimitiveFit> best_primitive(const ConvexHull& hull, double tolerance) {
    const Subject subject(hull);
    const Vec3 size = bounds(hull).size();
    const double largest_deviation = tolerance * std::max({size.x, size.y, size.z});
    std::optional<PrimitiveFit> best;
    for (const std::optional<PrimitiveFit>& fit : {std::optional(box_of(subject)), std::optional(sphere_of(subject)),
                                                   std::optional(cylinder_of(subject)), capsule_of(subject)}) {
        if (!fit || fit->volume_error > tolerance || fit->deviation > largest_deviation) continue;
        if (!best || badness(subject, *fit) < badness(subject, *best)) best = fit;
    }
    return best;
}

}  // namespace embody::geometry
