// SPDX-License-Identifier: MIT
// Any convex against a half space: the points of its surface that lie deepest, exact for every shape. A cylinder or a
// cone offers four points of each rim, one of them the lowest, so that it rolls on a smooth circle.
#include "physics/collision/convex_pairs.h"
#include "physics/collision/rim.h"

namespace embody::physics {

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
    // Quarter turns from the lowest point, named by their number: on a rolling wheel number 0 stays the lowest.
    const double r = round.shape->radius;
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const Vec3 d = quarter == 0   ? start.along
                       : quarter == 1 ? start.across
                       : quarter == 2 ? -start.along
                                      : -start.across;
        probe.add(round.to_frame(d * r + Vec3{0, height, 0}), first_feature + quarter);
    }
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

}  // namespace embody::physics
