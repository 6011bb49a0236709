// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "foundation/result.h"
#include "math/transform.h"

namespace embody::physics {

// Lengths in metres, in the shape's own frame. Round shapes have their axis along Y and are centred on the origin.

struct SphereShape {
    double radius = 0.5;  ///< > 0
};
struct BoxShape {
    Vec3 half_extents{0.5, 0.5, 0.5};  ///< each > 0
};
struct CapsuleShape {
    double radius = 0.25;      ///< > 0
    double half_height = 0.5;  ///< half the distance between the two cap centres, > 0
};
struct CylinderShape {
    double radius = 0.5;       ///< > 0
    double half_height = 0.5;  ///< > 0
};
/// Apex at +half_height, base circle at -half_height. The centre of mass lies half_height / 2 below the origin.
struct ConeShape {
    double radius = 0.5;       ///< of the base, > 0
    double half_height = 0.5;  ///< > 0
};
/// Convex hull of the points; at least four that span a volume. At most max_hull_vertices of them are kept.
struct HullShape {
    std::vector<Vec3> points;
};
inline constexpr int max_hull_vertices = 256;  ///< more are simplified

/// The half space below dot(normal, p) = offset. Static bodies only.
struct PlaneShape {
    Vec3 normal{0, 1, 0};  ///< any length but zero
    double offset = 0;     ///< in units of the normalised normal
};
/// Heights over the XZ plane: sample (column c, row r) is at x = c * cell.x, y = heights[r * columns + c],
/// z = r * cell.z, each cell split along the diagonal from (c, r) to (c+1, r+1). Static bodies only.
struct HeightfieldShape {
    int columns = 0;  ///< samples along X, >= 2
    int rows = 0;     ///< samples along Z, >= 2
    double cell_x = 1, cell_z = 1;
    std::vector<float> heights;  ///< columns * rows
};
/// One-sided triangles, counter-clockwise seen from outside. Static bodies only.
struct MeshShape {
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct CompoundChild;
/// Convex children rigidly joined; no planes, heightfields, meshes or further compounds inside.
struct CompoundShape {
    std::vector<CompoundChild> children;
};

using ShapeDefinition = std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, HullShape,
                                     PlaneShape, HeightfieldShape, MeshShape, CompoundShape>;

struct CompoundChild {
    std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, HullShape> shape;
    Transform local;  ///< of the child in the compound's frame
};

/// Whether every number is finite and in its stated range; the error's `where` is the field, e.g. "radius".
Result<void> validate(const ShapeDefinition& definition);

/// "sphere", "box", "capsule", "cylinder", "cone", "hull", "plane", "heightfield", "mesh" or "compound".
const char* shape_name(const ShapeDefinition& definition);

/// Planes, heightfields and meshes have no inside that could have a mass.
bool is_static_only(const ShapeDefinition& definition);

}  // namespace embody::physics
