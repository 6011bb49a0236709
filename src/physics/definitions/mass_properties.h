// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "geometry/volume_estimate.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics {

// Mass properties of shapes, for the solver and for everything that shows or estimates a mass. Solids are homogeneous,
// of density 1 kg/m³ and in the shape's own frame; the numbers are in range where validate() accepts the shape.

geometry::MassProperties mass_properties(const SphereShape& sphere);
geometry::MassProperties mass_properties(const BoxShape& box);
geometry::MassProperties mass_properties(const CapsuleShape& capsule);
geometry::MassProperties mass_properties(const CylinderShape& cylinder);
geometry::MassProperties mass_properties(const ConeShape& cone);
/// Of a hull shape once its hull is built.
geometry::MassProperties mass_properties(const geometry::ConvexHull& hull);

/// Adds a piece of a compound; a sum of zero volume has no pieces yet. Where pieces overlap, both count.
void add_piece(geometry::MassProperties& sum, const geometry::MassProperties& piece, const Transform& local);

/// What triangles enclose, exactly where they are closed; zero volume where they enclose nothing.
geometry::VolumeEstimate enclosed_by(const MeshShape& mesh);

/// Of any shape: triangles have what they enclose, although bodies of them are static; planes and heightfields have
/// zero volume. Errors: those of validate(), and points that span no volume.
Result<geometry::MassProperties> mass_properties(const ShapeDefinition& shape);

/// Mass and its distribution.
struct BodyMass {
    double mass = 0;              ///< kg
    Vec3 center;                  ///< in the body's frame, m
    Mat3 inertia = Mat3::zero();  ///< about `center`, in the body's axes, kg m², symmetric
};

/// What `definition` gives, the rest from the homogeneous solid; `solid` has zero volume for a body without a shape
/// that has one. Errors: neither of the two determines the mass or the inertia, or the mass is outside 1e-9 … 1e12 kg.
Result<BodyMass> body_mass(const MassDefinition& definition, const geometry::MassProperties& solid);

}  // namespace embody::physics
