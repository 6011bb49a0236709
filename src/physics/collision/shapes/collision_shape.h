// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "foundation/result.h"
#include "geometry/mass_properties.h"
#include "math/bounds.h"
#include "physics/collision/namespace.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/collision/pairs/pair_memory.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics::collision {

/// A shape as the collision stages need it: hulls with faces and planes, meshes with a bounding volume tree. Immutable.
class CollisionShape {
public:
    /// Fails where validate(definition) fails or the points of a hull span no volume.
    static Result<std::unique_ptr<CollisionShape>> create(const ShapeDefinition& definition);
    ~CollisionShape();

    [[nodiscard]] const ShapeDefinition& definition() const;
    /// Mass properties of the homogeneous solid at density 1; zero for static-only shapes.
    [[nodiscard]] const geometry::MassProperties& mass_properties() const;
    [[nodiscard]] Bounds local_bounds() const;
    [[nodiscard]] Bounds bounds(const Transform& pose) const;
    /// Largest distance of a surface point from `center` (in the shape's frame): bounds the motion by rotation.
    [[nodiscard]] double radius_about(Vec3 center) const;

    /// Whether some piece of it rolls.
    [[nodiscard]] bool is_round() const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

private:
    CollisionShape();
    std::unique_ptr<Data> data_;
};

/// Appends the contact regions of a and b where they are closer than `margin` (m, >= 0). Any pair of shapes but two
/// static-only ones. Points with separation up to `margin` are reported, so that the solver can act before they touch.
void collide(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
             double margin, std::vector<Manifold>& manifolds);
/// As above with the memory of the pair's last call: the same result, but faster. Of compounds only the
/// first pair of pieces has a memory; planes, meshes and heightfields leave the memory as it is.
void collide(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
             double margin, PairMemory& memory, std::vector<Manifold>& manifolds);

/// As above for a capsule, given as the points closer than `radius` (m) to a segment.
void collide_capsule(Vec3 from, Vec3 to, double radius, const CollisionShape& b, const Transform& pose_b, double margin,
                     std::vector<Manifold>& manifolds);

struct ShapeRayHit {
    double distance = 0;  ///< m along the unit direction
    Vec3 normal;          ///< world, unit, against the ray
};
/// First hit of the ray from `origin` along the unit `direction` within `max_distance`; rays from inside a solid miss
/// it.
std::optional<ShapeRayHit> cast_ray(const CollisionShape& shape, const Transform& pose, Vec3 origin, Vec3 direction,
                                    double max_distance);

/// The path of a shape: `center` (in its frame) on a straight line, turning about it along the shortest arc.
struct Sweep {
    Transform start, end;
    Vec3 center;
};
/// What counts as an impact.
struct ImpactSearch {
    double target_separation = 0;  ///< m: a gap up to this counts as a touch
    /// Parts at least as close as this at the start are ignored for the whole path, m; by default none.
    double touching_at_start = -1e300;
    /// A touch is also ignored if at the end the two are no deeper than this along its direction, m: sliding and
    /// rolling. By default none.
    double harmless_depth = -1e300;
};
/// First time in [0, 1] at which the gap is the target, by conservative advancement; std::nullopt if the gap
/// stays larger. Parts that move away from each other do not count. a is not static-only.
std::optional<double> time_of_impact(const CollisionShape& a, const Sweep& path_a, const CollisionShape& b,
                                     const Sweep& path_b, const ImpactSearch& search);
/// As above for a rotation about a's origin while b does not move. 0 where they overlap at the start: call it only for
/// pairs that do not touch yet.
std::optional<double> time_of_impact(const CollisionShape& a, const Transform& pose_a_start,
                                     const Transform& pose_a_end, const CollisionShape& b, const Transform& pose_b,
                                     double target_separation);

/// Gap between the shapes, m: exact where positive, <= 0 where they overlap; may stop at `enough` if it is larger.
double separation(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
                  double enough);

}  // namespace embody::physics::collision
