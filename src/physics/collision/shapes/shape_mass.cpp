// SPDX-License-Identifier: MIT
// Closed forms: any table of moments of inertia. Polytopes: J. Blow, A. Binstock, "How to find the inertia tensor
// (or other mass properties) of a 3D solid body represented by a triangle mesh", 2004: sums over signed tetrahedra.
// In double throughout, unlike the integration over a TriangleMesh, whose vertices are floats.
#include "physics/collision/shapes/shape_mass.h"

#include <numbers>

namespace embody::physics::collision {

namespace {

using std::numbers::pi;

geometry::MassProperties sphere_mass(double r) {
    const double m = 4.0 / 3 * pi * r * r * r;
    const double i = 0.4 * m * r * r;
    return {m, {}, Mat3::diagonal({i, i, i})};
}

geometry::MassProperties cylinder_mass(double r, double h) {
    const double m = 2 * pi * r * r * h;
    const double across = m * (r * r / 4 + h * h / 3);
    return {m, {}, Mat3::diagonal({across, m * r * r / 2, across})};
}

geometry::MassProperties capsule_mass(double r, double h) {
    const geometry::MassProperties middle = cylinder_mass(r, h);
    const double caps = 4.0 / 3 * pi * r * r * r;
    // Each half sphere: about its own centre of mass 3/8 r off the cap's centre, then moved.
    const double axial = 0.4 * caps * r * r;
    const double across = caps * (0.4 * r * r + h * h + 0.75 * h * r);
    return {middle.volume + caps, {}, middle.inertia + Mat3::diagonal({across, axial, across})};
}

geometry::MassProperties cone_mass(double r, double half_height) {
    const double height = 2 * half_height;
    const double m = pi / 3 * r * r * height;
    const double across = m * (0.15 * r * r + 0.0375 * height * height);
    return {m, {0, -half_height / 2, 0}, Mat3::diagonal({across, 0.3 * m * r * r, across})};
}

geometry::MassProperties polytope_mass(const Polytope& p) {
    // Second moments about an inner point keep the digits of hulls far from their origin.
    const Vec3 origin = p.center;
    double volume = 0;
    Vec3 first;
    Mat3 second = Mat3::zero();
    for (const Polytope::Face& face : p.faces) {
        const Vec3 a = p.vertices[p.loops[face.first]] - origin;
        for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
            const Vec3 b = p.vertices[p.loops[face.first + i]] - origin;
            const Vec3 c = p.vertices[p.loops[face.first + i + 1]] - origin;
            const double v = dot(a, cross(b, c)) / 6;
            const Vec3 sum = a + b + c;
            volume += v;
            first += sum * (v / 4);
            second += (outer(a, a) + outer(b, b) + outer(c, c) + outer(sum, sum)) * (v / 20);
        }
    }
    if (!(volume > 0)) return {};

    // From the second moments about the inner point to the inertia about the centre of mass.
    const Vec3 center = first / volume;
    const Mat3 central = second - outer(center, center) * volume;
    return {volume, origin + center, Mat3::identity() * trace(central) - central};
}

}  // namespace

geometry::MassProperties mass_of(const Convex& convex) {
    switch (convex.kind) {
        case ConvexKind::sphere:
            return sphere_mass(convex.radius);
        case ConvexKind::capsule:
            return capsule_mass(convex.radius, convex.half_height);
        case ConvexKind::cylinder:
            return cylinder_mass(convex.radius, convex.half_height);
        case ConvexKind::cone:
            return cone_mass(convex.radius, convex.half_height);
        case ConvexKind::polytope:
            break;
    }
    return polytope_mass(convex.polytope);
}

}  // namespace embody::physics::collision
