// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "foundation/result.h"
#include "geometry/mass_properties.h"
#include "math/bounds.h"
#include "physics/definitions/shape_definition.h"
#include "physics/fracture/namespace.h"

namespace embody::physics::fracture {

/// The points p with dot(normal, p) <= offset.
struct HalfSpace {
    Vec3 normal;        ///< unit
    double offset = 0;  ///< m
};

/// A convex polyhedron that half spaces cut. Corners that two faces share are equal to the last bit, so that volumes
/// of what a plane cuts in two add up to rounding.
class ConvexCell {
public:
    struct Face {
        std::vector<Vec3> corners;  ///< counter-clockwise from outside, m
        bool is_cut = false;        ///< made by cut()
    };

    ConvexCell() = default;
    explicit ConvexCell(std::vector<Face> faces) : faces_(std::move(faces)) {}

    [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
    [[nodiscard]] bool is_empty() const { return faces_.empty(); }
    /// Keeps what lies in the half space. Corners within `tolerance` (m) of its plane count as on it.
    void cut(const HalfSpace& half, double tolerance);
    /// Each corner once.
    [[nodiscard]] std::vector<Vec3> corners() const;
    [[nodiscard]] Bounds bounds() const;
    /// Of the solid at density 1.
    [[nodiscard]] geometry::MassProperties mass_properties() const;
    /// Area of the faces that cut() made, m².
    [[nodiscard]] double cut_area() const;

private:
    std::vector<Face> faces_;
};

/// The convex solids that a shape consists of, in its frame. What is round is the hull of points on its surface. The
/// error says that the shape has no inside.
Result<std::vector<ConvexCell>> cells_of(const ShapeDefinition& shape);

}  // namespace embody::physics::fracture
