// SPDX-License-Identifier: MIT
//
// What is computed: B. Mirtich, "Fast and accurate computation of polyhedral mass properties", Journal of Graphics
// Tools 1(2), 1996: the volume integrals of 1, x and x xᵀ (his eqs. 1-6 with density 1).
// How: the paper turns them into surface and line integrals; for triangles the same numbers come from a sum over signed
// tetrahedra (reference, a, b, c), which is shorter and as exact: F. Tonon, "Explicit exact formulas for the 3-D
// tetrahedron inertia tensor in terms of its vertex coordinates", J. Mathematics and Statistics 1(1), 2004.
//   6V = a·(b×c),   ∫x dV = V/4 · s,   ∫x xᵀ dV = V/20 · (aaᵀ + bbᵀ + ccᵀ + ssᵀ),   s = a + b + c.
#include "geometry/mass_properties.h"

namespace embody::geometry {

void PolyhedronIntegral::add_triangle(Vec3 a, Vec3 b, Vec3 c) {
    a -= reference_;
    b -= reference_;
    c -= reference_;
    const double volume = dot(a, cross(b, c)) / 6;
    const Vec3 s = a + b + c;
    volume_ += volume;
    first_moment_ += s * (volume / 4);
    second_moment_ += (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s)) * (volume / 20);
}

MassProperties PolyhedronIntegral::mass_properties() const {
    MassProperties p;
    p.volume = volume_;
    p.center = reference_;
    if (volume_ == 0) return p;

    // Second moments about the centre of mass, then I = tr(C) 1 - C.
    const Vec3 offset = first_moment_ / volume_;
    const Mat3 covariance = second_moment_ - volume_ * outer(offset, offset);
    p.center = reference_ + offset;
    p.inertia = trace(covariance) * Mat3::identity() - covariance;
    return p;
}

MassProperties integrate_polyhedron(const TriangleMesh& mesh) {
    PolyhedronIntegral integral(mesh.triangles.empty() ? Vec3{} : bounds(mesh).center());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = corners(mesh, i);
        integral.add_triangle(a, b, c);
    }
    return integral.mass_properties();
}

MassProperties transformed(const Transform& t, const MassProperties& p) {
    return {p.volume, transform_point(t, p.center), rotate_tensor(t.rotation, p.inertia)};
}

MassProperties combined(const MassProperties& a, const MassProperties& b) {
    const double volume = a.volume + b.volume;
    if (volume == 0) return {};
    const Vec3 center = (a.center * a.volume + b.center * b.volume) / volume;
    const Mat3 inertia =
        inertia_about(a.inertia, a.volume, center - a.center) + inertia_about(b.inertia, b.volume, center - b.center);
    return {volume, center, inertia};
}

Mat3 inertia_about(const Mat3& inertia_about_center, double mass, Vec3 offset) {
    return inertia_about_center + mass * (length_squared(offset) * Mat3::identity() - outer(offset, offset));
}

}  // namespace embody::geometry
