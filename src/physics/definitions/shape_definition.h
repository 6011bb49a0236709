// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/building_shapes.h"
#include "physics/definitions/shape_traits.h"

namespace embody::physics {

// Lengths in metres, in the shape's own frame. Round shapes have their axis along Y and are centred on the origin.
// `name` is the shape's in scene files. Where lengths are all that a shape is, `lengths` lists them: what validate()
// checks and what scene files hold, each a number or a vector, all > 0.

struct SphereShape {
    static constexpr const char* name = "sphere";
    double radius = 0.5;

    static void lengths(auto& sphere, auto&& visit) { visit("radius", sphere.radius, a_length); }

    friend bool operator==(const SphereShape&, const SphereShape&) = default;
};
struct BoxShape {
    static constexpr const char* name = "box";
    Vec3 half_extents{0.5, 0.5, 0.5};

    static void lengths(auto& box, auto&& visit) {
        visit("half_extents", box.half_extents, "half the lengths of the edges, [x, y, z]");
    }

    friend bool operator==(const BoxShape&, const BoxShape&) = default;
};
struct CapsuleShape {
    static constexpr const char* name = "capsule";
    double radius = 0.25;
    double half_height = 0.5;  ///< half the distance between the two cap centres

    static void lengths(auto& capsule, auto&& visit) { round_lengths(capsule, visit); }

    friend bool operator==(const CapsuleShape&, const CapsuleShape&) = default;
};
struct CylinderShape {
    static constexpr const char* name = "cylinder";
    double radius = 0.5;
    double half_height = 0.5;

    static void lengths(auto& cylinder, auto&& visit) { round_lengths(cylinder, visit); }

    friend bool operator==(const CylinderShape&, const CylinderShape&) = default;
};
/// Apex at +half_height, base circle at -half_height. The centre of mass lies half_height / 2 below the origin.
struct ConeShape {
    static constexpr const char* name = "cone";
    double radius = 0.5;  ///< of the base
    double half_height = 0.5;

    static void lengths(auto& cone, auto&& visit) { round_lengths(cone, visit); }

    friend bool operator==(const ConeShape&, const ConeShape&) = default;
};
/// Convex hull of the points; at least four that span a volume. At most max_hull_vertices of them are kept.
struct HullShape {
    static constexpr const char* name = "hull";
    std::vector<Vec3> points;

    [[nodiscard]] const std::vector<Vec3>& corners() const { return points; }

    friend bool operator==(const HullShape&, const HullShape&) = default;
};
inline constexpr int max_hull_vertices = 256;  ///< more are simplified

/// The half space below dot(normal, p) = offset. Static bodies only.
struct PlaneShape {
    static constexpr const char* name = "plane";
    Vec3 normal{0, 1, 0};  ///< any length but zero
    double offset = 0;     ///< in units of the normalised normal

    friend bool operator==(const PlaneShape&, const PlaneShape&) = default;
};
/// Heights over the XZ plane: sample (column c, row r) is at x = c * cell.x, y = heights[r * columns + c],
/// z = r * cell.z, each cell split along the diagonal from (c, r) to (c+1, r+1). Static bodies only.
struct HeightfieldShape {
    static constexpr const char* name = "heightfield";
    int columns = 0;  ///< samples along X, >= 2
    int rows = 0;     ///< samples along Z, >= 2
    double cell_x = 1, cell_z = 1;
    std::vector<float> heights;  ///< columns * rows

    friend bool operator==(const HeightfieldShape&, const HeightfieldShape&) = default;
};
/// One-sided triangles, counter-clockwise seen from outside. Static bodies only.
struct MeshShape {
    static constexpr const char* name = "mesh";
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    friend bool operator==(const MeshShape&, const MeshShape&) = default;
};

struct CompoundChild;
/// Convex children rigidly joined; no planes, heightfields, meshes or further compounds inside.
struct CompoundShape {
    static constexpr const char* name = "compound";
    std::vector<CompoundChild> children;
};

using ConvexShape = std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, HullShape>;

using ShapeDefinition = std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, HullShape,
                                     PlaneShape, HeightfieldShape, MeshShape, CompoundShape, WallShape, SlabShape>;

struct CompoundChild {
    ConvexShape shape;
    Transform local;  ///< of the child in the compound's frame

    friend bool operator==(const CompoundChild&, const CompoundChild&) = default;
};
inline bool operator==(const CompoundShape& a, const CompoundShape& b) { return a.children == b.children; }

/// Whether every number is finite and in its stated range; the error's `where` is the field, e.g. "radius".
Result<void> validate(const ShapeDefinition& definition);

/// "sphere", "box" and so on, as scene files write it.
const char* shape_name(const ShapeDefinition& definition);

/// Planes, heightfields and meshes have no inside that could have a mass.
bool is_static_only(const ShapeDefinition& definition);

}  // namespace embody::physics
