// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/triangle_mesh.h"
#include "math/transform.h"

namespace embody::geometry {

/// Mass properties of a solid of density 1 kg/m³.
struct MassProperties {
    double volume = 0;            ///< m³; equals the mass at density 1
    Vec3 center;                  ///< centre of mass, m
    Mat3 inertia = Mat3::zero();  ///< about `center`, kg m² at density 1
};

/// Volume integrals over the polyhedron that the mesh bounds, exact up to rounding where the mesh is closed and
/// consistently oriented outwards (B. Mirtich, "Fast and accurate computation of polyhedral mass properties", 1996).
/// On an open mesh the numbers have no meaning: call is_closed() first.
MassProperties integrate_polyhedron(const TriangleMesh& mesh);

/// The same integrals, one oriented triangle after another, in double precision.
class PolyhedronIntegral {
public:
    /// `reference` should be close to the solid, so that the tetrahedra are small and their sums lose no digits.
    explicit PolyhedronIntegral(Vec3 reference) : reference_(reference) {}
    void add_triangle(Vec3 a, Vec3 b, Vec3 c);
    /// Mass properties of the triangles so far; a volume of 0 has its centre at the reference.
    [[nodiscard]] MassProperties mass_properties() const;

private:
    Vec3 reference_;
    double volume_ = 0;
    Vec3 first_moment_;                  // ∫ x dV, from the reference
    Mat3 second_moment_ = Mat3::zero();  // ∫ x xᵀ dV, from the reference
};

/// The same solid moved by `t`.
MassProperties transformed(const Transform& t, const MassProperties& p);
/// Mass properties of two solids together.
MassProperties combined(const MassProperties& a, const MassProperties& b);
/// Inertia about the point at `offset` from the centre of mass (parallel axis theorem).
Mat3 inertia_about(const Mat3& inertia_about_center, double mass, Vec3 offset);

}  // namespace embody::geometry
