// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/triangle_mesh.h"
#include "math/transform.h"

namespace embody::geometry {

/// Of a solid of density 1 kg/m³.
struct MassProperties {
    double volume = 0;  ///< m³; equals the mass at density 1
    Vec3 center;        ///< centre of mass, m
    Mat3 inertia = Mat3::zero();  ///< about `center`, kg m² at density 1
};

/// Volume integrals over the polyhedron that the mesh bounds, exact up to rounding where the mesh is closed and
/// consistently oriented outwards (B. Mirtich, "Fast and accurate computation of polyhedral mass properties", 1996).
/// On an open mesh the numbers mean nothing: ask is_closed() first.
MassProperties integrate_polyhedron(const TriangleMesh& mesh);

/// The same solid moved by `t`.
MassProperties transformed(const Transform& t, const MassProperties& p);
/// Two solids as one.
MassProperties combined(const MassProperties& a, const MassProperties& b);
/// Inertia about the point at `offset` from the centre of mass (parallel axis theorem).
Mat3 inertia_about(const Mat3& inertia_about_center, double mass, Vec3 offset);

}  // namespace embody::geometry
