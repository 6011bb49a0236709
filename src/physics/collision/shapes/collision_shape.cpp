// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/collision_shape.h"

#include <algorithm>
#include <cmath>

#include "geometry/convex_hull.h"
#include "physics/collision/pairs/convex_pair.h"
#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/collision/shapes/polytope_query.h"
#include "physics/definitions/mass_properties.h"

namespace embody::physics::collision {

namespace {

// Stands for the endless extent of a plane; finite, so that sums of bounds stay numbers.
constexpr double endless = 1e9;

Bounds symmetric_bounds(Vec3 half) { return {-half, half}; }

Convex round_convex(ConvexKind kind, double radius, double half_height) {
    const double up = kind == ConvexKind::capsule ? half_height + radius : half_height;
    return {kind, radius, half_height, {}, symmetric_bounds({radius, up, radius})};
}

Polytope polytope_from(const geometry::ConvexHull& hull) {
    Polytope polytope;
    polytope.vertices = hull.vertices;
    polytope.loops = hull.face_vertices;
    for (const auto& face : hull.faces) polytope.faces.push_back({face.normal, face.offset, face.first, face.count});
    link_edges(polytope);
    return polytope;
}

Convex make_convex(const SphereShape& s) {
    return {ConvexKind::sphere, s.radius, 0, {}, symmetric_bounds({s.radius, s.radius, s.radius})};
}
Convex make_convex(const BoxShape& s) {
    return {ConvexKind::polytope, 0, 0, box_polytope(s.half_extents), symmetric_bounds(s.half_extents), true};
}
Convex make_convex(const CapsuleShape& s) { return round_convex(ConvexKind::capsule, s.radius, s.half_height); }
Convex make_convex(const CylinderShape& s) { return round_convex(ConvexKind::cylinder, s.radius, s.half_height); }
Convex make_convex(const ConeShape& s) { return round_convex(ConvexKind::cone, s.radius, s.half_height); }

Convex make_convex(const geometry::ConvexHull& hull) {
    return {ConvexKind::polytope, 0, 0, polytope_from(hull), geometry::bounds(hull)};
}

// Bounds of a placed convex; round ones by their own formulas, since turned boxes would overestimate.
Bounds convex_bounds(const Convex& convex, const Transform& pose) {
    const Mat3 r = to_matrix(pose.rotation);
    const PlacedConvex placed{&convex, r, pose.position};
    Bounds b;
    if (convex.is_box) {
        const Vec3 half =
            abs(r.x) * convex.bounds.upper.x + abs(r.y) * convex.bounds.upper.y + abs(r.z) * convex.bounds.upper.z;
        return {pose.position - half, pose.position + half};
    }
    if (convex.kind == ConvexKind::polytope) {
        for (int k = 0; k < 3; ++k) {
            const Extent along = extent(convex.polytope.vertex_lanes, {r.x[k], r.y[k], r.z[k]});
            b.lower[k] = pose.position[k] + along.lowest;
            b.upper[k] = pose.position[k] + along.highest;
        }
        return b;
    }
    // Extents along each axis: of the core, then the radius around it.
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; ++k) {
        b.lower[k] = core_support(placed, -axes[k])[k] - rounding(convex);
        b.upper[k] = core_support(placed, axes[k])[k] + rounding(convex);
    }
    return b;
}

// The library's hypot may differ in its last digit from one machine to the next; sizes are far from overflow.
double hypotenuse(double a, double b) { return std::sqrt(a * a + b * b); }

double convex_radius_about(const Convex& convex, Vec3 c) {
    const double flat = hypotenuse(c.x, c.z);
    switch (convex.kind) {
        case ConvexKind::sphere:
            return length(c) + convex.radius;
        case ConvexKind::capsule:
            return hypotenuse(flat, std::fabs(c.y) + convex.half_height) + convex.radius;
        case ConvexKind::cylinder:
            return hypotenuse(flat + convex.radius, std::fabs(c.y) + convex.half_height);
        case ConvexKind::cone:
            return std::max(hypotenuse(flat + convex.radius, c.y + convex.half_height),
                            hypotenuse(flat, c.y - convex.half_height));
        case ConvexKind::polytope:
            break;
    }
    double farthest = 0;
    for (const Vec3& v : convex.polytope.vertices) farthest = std::max(farthest, distance(v, c));
    return farthest;
}

Vec3 inner_point(const Convex& convex) { return interior_point({&convex, {}, {}}); }

/// Fills the data of one kind of shape.
struct Builder {
    CollisionShape::Data& data;

    template <class ConvexShape>
    Result<void> operator()(const ConvexShape& shape) const {
        return add_piece(shape, {});
    }
    Result<void> operator()(const PlaneShape& plane) const {
        const double size = length(plane.normal);
        data.is_plane = true;
        data.plane_normal = plane.normal / size;
        data.plane_offset = plane.offset;
        return {};
    }
    Result<void> operator()(const HeightfieldShape& field) const {
        data.surface = std::make_unique<TriangleSurface>(field);
        return {};
    }
    Result<void> operator()(const MeshShape& mesh) const {
        data.surface = std::make_unique<TriangleSurface>(mesh);
        return {};
    }
    Result<void> operator()(const CompoundShape& compound) const {
        for (std::size_t i = 0; i < compound.children.size(); ++i) {
            const CompoundChild& child = compound.children[i];
            const Transform local{child.local.position, normalized(child.local.rotation)};
            const auto added = std::visit([&](const auto& shape) { return add_piece(shape, local); }, child.shape);
            if (added) continue;
            const Error& e = added.error();
            return Error{"children[" + std::to_string(i) + "]." + e.where, e.why, e.remedy};
        }
        return {};
    }
    Result<void> operator()(const HasParts auto& shape) const { return (*this)(CompoundShape{shape.parts()}); }

private:
    Result<void> add_piece(const HasCorners auto& shape, const Transform& local) const {
        const auto hull = geometry::build_convex_hull(shape.corners(), max_hull_vertices);
        if (!hull) return Error{"points", hull.error().why, hull.error().remedy};
        return add_piece(*hull, local);
    }
    /// For a round shape, a box or a built hull.
    template <class Solid>
    Result<void> add_piece(const Solid& solid, const Transform& local) const {
        Convex convex = make_convex(solid);
        const Vec3 inside = inner_point(convex);
        convex.reach = convex_radius_about(convex, inside);
        convex.inner = -distance_from_surface(convex, inside).distance - convex.polytope.unevenness;
        physics::add_piece(data.mass, mass_properties(solid), local);
        data.piece_bounds.push_back(convex_bounds(convex, local));
        data.pieces.push_back({std::move(convex), local, local == Transform{}});
        return {};
    }
};

Bounds plane_bounds(Vec3 normal, double offset) {
    // Endless but for a plane along an axis, which has an upper side.
    Bounds b = symmetric_bounds({endless, endless, endless});
    for (int k = 0; k < 3; ++k) {
        if (normal[k] > 1 - 1e-12) b.upper[k] = offset;
        if (normal[k] < -1 + 1e-12) b.lower[k] = -offset;
    }
    return b;
}

}  // namespace

CollisionShape::CollisionShape() : data_(std::make_unique<Data>()) {}
CollisionShape::~CollisionShape() = default;

Result<std::unique_ptr<CollisionShape>> CollisionShape::create(const ShapeDefinition& definition) {
    if (auto valid = validate(definition); !valid) return valid.error();
    std::unique_ptr<CollisionShape> shape(new CollisionShape);
    shape->data_->definition = definition;
    if (auto built = std::visit(Builder{*shape->data_}, definition); !built) return built.error();
    shape->data_->bounds = shape->bounds({});
    return shape;
}

const ShapeDefinition& CollisionShape::definition() const { return data_->definition; }
const geometry::MassProperties& CollisionShape::mass_properties() const { return data_->mass; }
Bounds CollisionShape::local_bounds() const { return data_->bounds; }

Bounds CollisionShape::bounds(const Transform& pose) const {
    if (data_->is_plane) {
        const Vec3 normal = rotate(pose.rotation, data_->plane_normal);
        return plane_bounds(normal, data_->plane_offset + dot(normal, pose.position));
    }
    if (data_->surface) return transformed(pose, data_->surface->bounds());
    Bounds all;
    for (const ConvexPiece& piece : data_->pieces) all.add(convex_bounds(piece.convex, pose * piece.local));
    return all;
}

double CollisionShape::radius_about(Vec3 center) const {
    if (data_->is_plane) return endless;
    double farthest = 0;
    if (data_->surface) {
        const Bounds& b = data_->surface->bounds();
        farthest = length(max(abs(b.lower - center), abs(b.upper - center)));
    }
    for (const ConvexPiece& piece : data_->pieces) {
        const Vec3 local = inverse_transform_point(piece.local, center);
        farthest = std::max(farthest, convex_radius_about(piece.convex, local));
    }
    return farthest;
}

bool CollisionShape::is_round() const {
    return std::any_of(data_->pieces.begin(), data_->pieces.end(),
                       [](const ConvexPiece& piece) { return piece.convex.is_round(); });
}

PlacedConvex place(const ConvexPiece& piece, const Transform& pose, Vec3 origin) {
    if (piece.is_alone) return {&piece.convex, turn_of(pose.rotation), pose.position - origin};
    // The origin is subtracted first: far from the world's origin the small differences keep their digits.
    const Vec3 at = (pose.position - origin) + rotate(pose.rotation, piece.local.position);
    return {&piece.convex, turn_of(pose.rotation * piece.local.rotation), at};
}

}  // namespace embody::physics::collision
