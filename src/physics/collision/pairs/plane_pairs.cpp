// SPDX-License-Identifier: MIT
// Any convex against a half space: the points of its surface that lie deepest, exact for every shape. A cylinder or a
// cone offers four points of each rim, one of them the lowest, so that it rolls on a smooth circle.
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/shapes/rim.h"

namespace embody::physics::collision {

namespace {

/// Adds surface points of the convex that are within the margin of the plane.
struct PlaneProbe {
    const PlacedPlane& plane;
    double margin;
    ContactRegion& region;

    void add(Vec3 point, std::uint32_t feature) const {
        const double separation = dot(plane.normal, point) - plane.offset;
        if (separation <= margin) region.add(point, separation, feature);
    }
};

void probe_rim(const PlacedConvex& round, double height, std::uint32_t first_feature, const PlaneProbe& probe) {
    const Vec3 down = round.direction_to_local(-probe.plane.normal);
    const RimStart start = rim_start(down);
    // Quarter turns from the lowest point, named by their number: on a rolling wheel number 0 stays the lowest point.
    const double r = round.shape->radius;
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const Vec3 d = quarter == 0   ? start.along
                       : quarter == 1 ? start.across
                       : quarter == 2 ? -start.along
                                      : -start.across;
        probe.add(round.to_frame(d * r + Vec3{0, height, 0}), first_feature + quarter);
    }
}

// The corners of a box are its centre and the half edges, added or taken away.
void probe_box(const PlacedConvex& box, const PlaneProbe& probe) {
    const Vec3 normal = probe.plane.normal, half = box.shape->bounds.upper;
    const Vec3 along[3] = {box.rotation.x * half.x, box.rotation.y * half.y, box.rotation.z * half.z};
    const double rise[3] = {dot(along[0], normal), dot(along[1], normal), dot(along[2], normal)};
    const double middle = dot(box.position, normal) - probe.plane.offset;
    if (middle - std::fabs(rise[0]) - std::fabs(rise[1]) - std::fabs(rise[2]) > probe.margin) return;
    std::uint32_t all = 7, any = 0;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        double height = middle;
        for (std::uint32_t k = 0; k < 3; ++k) height += (corner >> k & 1u) != 0 ? rise[k] : -rise[k];
        if (height > probe.margin) continue;
        Vec3 point = box.position;
        for (std::uint32_t k = 0; k < 3; ++k) point += (corner >> k & 1u) != 0 ? along[k] : -along[k];
        probe.region.add(point, height, corner);
        all &= corner;
        any |= corner;
    }
    // Four corners with a common side are a face.
    probe.region.is_proper = probe.region.points.size() == 4 && (all != 0 || any != 7);
}

}  // namespace

void collide_plane(const PlacedConvex& a, const PlacedPlane& plane, double margin, ContactRegion& region) {
    region.normal = -plane.normal;
    const PlaneProbe probe{plane, margin, region};
    const Convex& shape = *a.shape;
    switch (shape.kind) {
        case ConvexKind::sphere:
            probe.add(a.position - plane.normal * shape.radius, 0);
            return;
        case ConvexKind::capsule:
            probe.add(a.to_frame({0, -shape.half_height, 0}) - plane.normal * shape.radius, 0);
            probe.add(a.to_frame({0, shape.half_height, 0}) - plane.normal * shape.radius, 1);
            return;
        case ConvexKind::polytope:
            if (shape.is_box) {
                probe_box(a, probe);
                return;
            }
            for (std::uint32_t i = 0; i < shape.polytope.vertices.size(); ++i) {
                probe.add(a.to_frame(shape.polytope.vertices[i]), i);
            }
            return;
        case ConvexKind::cylinder:
            probe_rim(a, -shape.half_height, 0, probe);
            probe_rim(a, shape.half_height, 4, probe);
            return;
        case ConvexKind::cone:
            probe_rim(a, -shape.half_height, 0, probe);
            probe.add(a.to_frame({0, shape.half_height, 0}), 8);
            return;
    }
}

}  // namespace embody::physics::collision
