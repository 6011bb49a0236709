// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "attributes/resolver.h"
#include "foundation/result.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/shape_definition.h"

namespace embody::attributes {

/// Geometry of a model for its collision shape, fetched only where it is needed.
class ModelGeometry {
public:
    virtual ~ModelGeometry() = default;
    /// Vertices of the convex hull, at most physics::max_hull_vertices.
    virtual Result<std::vector<Vec3>> hull_points() = 0;
    virtual Result<physics::MeshShape> mesh() = 0;
    /// Vertices of each hull of the convex decomposition: at most `max_hulls`, hollows up to `hull_error` (m) filled.
    virtual Result<std::vector<std::vector<Vec3>>> convex_parts(int max_hulls, double hull_error) = 0;
};

/// A body's definition without pose, velocity and shape handle: kind, mass, material, damping … from the attributes.
/// With a taxonomy, friction and restitution of the surface material come from the pair table (Taxonomy::surfaces)
/// where both things of a pair are set to pair_table; a number of the thing's own always counts.
Result<physics::BodyDefinition> body_from_attributes(const AttributeSet& attributes,
                                                     const Taxonomy* taxonomy = nullptr);

/// The collision shape that the attributes name (collision_shape), in the model's frame.
Result<physics::ShapeDefinition> shape_from_attributes(const AttributeSet& attributes, const GeometryFacts& facts,
                                                       ModelGeometry& geometry);

/// The attributes of all deformables, without nodes, matter and pose: material, gravity factor, groups. The taxonomy is
/// used as in body_from_attributes().
physics::DeformableDefinition deformable_from_attributes(const AttributeSet& attributes,
                                                         const Taxonomy* taxonomy = nullptr);

/// A soft solid of these tetrahedra, without pose. Its density makes its mass that of the attributes, since tetrahedra
/// leave out parts that are thinner than they are. Poisson's ratio is clamped to -0.9 … 0.495, and a yield stress of 0
/// is taken as 1 Pa. The error says where the mass needs a density that no matter has.
Result<physics::DeformableDefinition> soft_solid_from_attributes(const AttributeSet& attributes,
                                                                 const geometry::TetrahedralMesh& mesh,
                                                                 const Taxonomy* taxonomy = nullptr);

/// Mesh of a sheet at rest, in the thing's frame.
struct SheetMesh {
    std::vector<Vec3> nodes;                              ///< m
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< with area
};

/// Cloth of these triangles, without pose. Its area density makes its mass that of the attributes; a thickness above
/// the length of an edge is reduced to that length. The form of a closed sheet is the one that it has under its
/// internal pressure, exactly so for balls. The error says where the mass needs a density that no cloth has.
Result<physics::DeformableDefinition> cloth_from_attributes(const AttributeSet& attributes, const SheetMesh& sheet,
                                                            const Taxonomy* taxonomy = nullptr);

/// A rope along these nodes (m, each apart from the one before it), `diameter` (m) thick, without pose. Its linear
/// density makes its mass, slack included, that of the attributes. Errors as for cloth.
Result<physics::DeformableDefinition> rope_from_attributes(const AttributeSet& attributes,
                                                           const std::vector<Vec3>& nodes, double diameter,
                                                           const Taxonomy* taxonomy = nullptr);

/// A liquid without volume and velocity: its material and cell size. Density is at least 1 kg/m³, viscosity and yield
/// stress are at most 10,000 Pa s and Pa.
physics::FluidDefinition fluid_from_attributes(const AttributeSet& attributes);

}  // namespace embody::attributes
