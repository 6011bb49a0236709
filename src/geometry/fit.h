// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/convex_hull.h"
#include "math/transform.h"

namespace embody::geometry {

enum class PrimitiveKind { box, sphere, capsule, cylinder };
/// "box", "sphere", "capsule" or "cylinder".
const char* name(PrimitiveKind kind);

/// A primitive that replaces a convex body. Round ones have their axis along the local Y axis.
struct PrimitiveFit {
    PrimitiveKind kind = PrimitiveKind::box;
    Vec3 half_extents;       ///< m, box only
    double radius = 0;       ///< m, all but box
    double half_height = 0;  ///< m; cylinder: half its height; capsule: half the distance of the cap centres
    Transform local;         ///< of the primitive in the model's frame

    double deviation = 0;     ///< m, Hausdorff distance between the surfaces, over some 600 directions
    double volume_error = 0;  ///< |volume of the primitive / volume of the hull - 1|

    [[nodiscard]] double volume() const;
    /// Distance of the farthest point of the primitive along the unit vector `direction`, from the model's origin.
    [[nodiscard]] double support(Vec3 direction) const;
};

/// The box around the hull with faces along the model's axes, or a turned one where its volume is at least 1 % smaller
/// (frames tried: principal axes of inertia, and each large face with its edges).
PrimitiveFit fit_box(const ConvexHull& hull);
/// Centre at the centre of mass, radius halfway between the smallest and the largest support.
PrimitiveFit fit_sphere(const ConvexHull& hull);
/// Axis along the axis of the frames that fits best; radius halfway between smallest and largest sideways support.
/// None where the straight part would be shorter than a tenth of the radius along every axis.
std::optional<PrimitiveFit> fit_capsule(const ConvexHull& hull);
PrimitiveFit fit_cylinder(const ConvexHull& hull);

/// The primitive that represents the hull best: volume error at most `tolerance`, and deviation at most `tolerance`
/// times the hull's largest extent. Among those the one with the smallest sum of both; none where no primitive is as
/// good.
/// It ignores hollows of the model itself: compare the model's volume with the hull's for that.
std::optional<PrimitiveFit> best_primitive(const ConvexHull& hull, double tolerance = 0.05);

}  // namespace embody::geometry
