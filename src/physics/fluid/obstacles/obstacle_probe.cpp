// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/obstacle_probe.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/queries/cast_at_convex.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::fluid {

namespace {

// Distance of a point from a box along the axis where it is largest: a lower bound of its distance.
double outside_of(const Bounds& box, Vec3 p) {
    const Vec3 out = max(box.lower - p, p - box.upper);
    return std::max({out.x, out.y, out.z});
}

// Half-space distances of a convex at a point: the largest, and the largest of those whose faces are turned away from
// its face by more than this cosine: facets of a round thing (32 a turn: 0.98) count as one face, corners of 45° (0.71)
// and more do not.
constexpr double turned_away = 0.8;
struct TwoFaces {
    ObstacleDistance first{-1e300, {}}, second{-1e300, {}};

    void offer(double distance, Vec3 normal) {
        if (distance > first.distance) {
            if (dot(normal, first.normal) < turned_away) second = first;
            first = {distance, normal};
        } else if (distance > second.distance && dot(normal, first.normal) < turned_away) {
            second = {distance, normal};
        }
    }
};

TwoFaces faces_near(const Convex& convex, Vec3 p) {
    TwoFaces faces;
    const Vec3 across{p.x, 0, p.z};
    switch (convex.kind) {
        case ConvexKind::sphere:
            faces.offer(length(p) - convex.radius, normalized(p, {0, 1, 0}));
            break;
        case ConvexKind::capsule: {
            const Vec3 from_axis = p - Vec3{0, std::clamp(p.y, -convex.half_height, convex.half_height), 0};
            faces.offer(length(from_axis) - convex.radius, normalized(from_axis, {1, 0, 0}));
            break;
        }
        case ConvexKind::cylinder:
            faces.offer(length(across) - convex.radius, normalized(across, {1, 0, 0}));
            faces.offer(std::fabs(p.y) - convex.half_height, {0, p.y < 0 ? -1.0 : 1.0, 0});
            break;
        case ConvexKind::cone: {
            const ConeSlope side = cone_slope(convex);
            const Vec3 outward = normalized(across, {1, 0, 0});
            faces.offer(length(across) * side.radial + (p.y - convex.half_height) * side.axial,
                        outward * side.radial + Vec3{0, side.axial, 0});
            faces.offer(-convex.half_height - p.y, {0, -1, 0});
            break;
        }
        case ConvexKind::polytope:
            for (const Polytope::Face& face : convex.polytope.faces) {
                faces.offer(dot(face.normal, p) - face.offset, face.normal);
            }
            break;
    }
    return faces;
}

/// The faces of a convex that may cut a cube around a point.
struct FacesOfCube {
    FacesOfCube(const Convex& piece, Vec3 center, double edge) : convex(piece) {
        const double reach = half_diagonal * edge;
        if (convex.kind != ConvexKind::polytope) {
            is_outside = faces_near(convex, center).first.distance > reach;
            return;
        }
        for (const Polytope::Face& face : convex.polytope.faces) {
            const double distance = dot(face.normal, center) - face.offset;
            is_outside = is_outside || distance > reach;
            if (distance < -reach || count == max_faces) continue;
            faces[count++] = &face;
        }
    }
    /// Distances of those faces, as faces_near; wholly inside where there are none.
    [[nodiscard]] TwoFaces at(Vec3 p) const {
        if (convex.kind != ConvexKind::polytope || count == max_faces) return faces_near(convex, p);
        TwoFaces two;
        for (int i = 0; i < count; ++i) two.offer(dot(faces[i]->normal, p) - faces[i]->offset, faces[i]->normal);
        return two;
    }

    static constexpr int max_faces = 12;                // capacity: with more faces the convex is queried
    static constexpr double half_diagonal = 0.8660254;  // √3 / 2
    const Convex& convex;
    const Polytope::Face* faces[max_faces] = {};
    int count = 0;
    bool is_outside = false;
};

// Thickness added to the hulls of a compound, m.
double seal_of(const CollisionShape& shape, const FluidObstacleSettings& settings) {
    const auto* compound = std::get_if<CompoundShape>(&shape.definition());
    if (compound == nullptr || compound->children.size() < 2) return 0;
    if (!std::holds_alternative<HullShape>(compound->children.front().shape)) return 0;
    const Vec3 size = shape.local_bounds().size();
    return std::min(settings.max_seal, settings.seal_fraction * std::max({size.x, size.y, size.z}));
}

// Where a path (unit direction) enters a polytope whose faces lie `seal` farther out; nothing from inside. By clipping
// at its faces (M. Cyrus, J. Beck, "Generalized two- and three-dimensional clipping", 1978).
std::optional<ShapeRayHit> enter(const Polytope& polytope, double seal, Vec3 origin, Vec3 direction, double limit) {
    double first = 0, last = limit;
    const Polytope::Face* entered = nullptr;
    for (const Polytope::Face& face : polytope.faces) {
        const double height = dot(face.normal, origin) - face.offset - seal, rate = dot(face.normal, direction);
        if (height > 0 && rate >= 0) return std::nullopt;
        if (rate == 0) continue;
        const double at = -height / rate;
        if (rate < 0 && height > 0 && at >= first) {
            first = at;
            entered = &face;
        } else if (rate > 0) {
            last = std::min(last, at);
        }
    }
    if (entered == nullptr || first > last) return std::nullopt;
    return ShapeRayHit{first, entered->normal};
}

constexpr int octants = 8;  // of a cube

Vec3 octant_offset(int octant) {
    return {(octant & 1) ? 0.25 : -0.25, (octant & 2) ? 0.25 : -0.25, (octant & 4) ? 0.25 : -0.25};
}

Vec3 rotate_back(const Mat3& rotation, Vec3 v) { return {dot(rotation.x, v), dot(rotation.y, v), dot(rotation.z, v)}; }

// Fraction of a cube of that edge behind a face at this distance from its centre: exact for faces along the axes.
double fraction_behind(const ObstacleDistance& face, double edge) {
    const Vec3 n = abs(face.normal);
    if (face.distance < -edge) return 1;
    return std::clamp(0.5 - face.distance / (edge * (n.x + n.y + n.z)), 0.0, 1.0);
}

// C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5.
Vec3 closest_on_triangle(Vec3 p, const std::array<Vec3, 3>& t) {
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return t[0];
    const Vec3 bp = p - t[1];
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return t[1];
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + ab * (d1 / (d1 - d3));
    const Vec3 cp = p - t[2];
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return t[2];
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + ac * (d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return t[1] + (t[2] - t[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const double sum = va + vb + vc;
    return t[0] + ab * (vb / sum) + ac * (vc / sum);
}

// Whether a ray leaves a solid through a triangle of its surface (1), enters it (-1) or misses the triangle (0), by T.
// Möller and B. Trumbore.
int crosses(const std::array<Vec3, 3>& corners, Vec3 origin, Vec3 direction) {
    const auto& [a, b, c] = corners;
    const Vec3 ab = b - a, ac = c - a, p = cross(direction, ac), from = origin - a, q = cross(from, ab);
    const double determinant = dot(ab, p);
    if (determinant == 0) return 0;
    const double u = dot(from, p) / determinant, v = dot(direction, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || dot(ac, q) / determinant < 0) return 0;
    return determinant < 0 ? 1 : -1;
}

}  // namespace

ObstacleProbe::ObstacleProbe(const CollisionShape& shape, const Transform& pose, const FluidObstacleSettings& settings)
    : shape_(&shape), pose_(pose), bounds_(shape.bounds(pose)), seal_(seal_of(shape, settings)) {
    bounds_ = enlarged(bounds_, seal_);
    for (const ConvexPiece& piece : shape.data().pieces) {
        const Transform placed = pose * piece.local;
        pieces_.push_back({&piece.convex, to_matrix(placed.rotation), placed.position,
                           enlarged(transformed(placed, piece.convex.bounds), seal_)});
    }
}

bool ObstacleProbe::is_surface() const { return shape_->data().surface != nullptr; }

// A place in a solid leaves it once more than it enters it, in every direction. One that is asked of six directions is
// on the safe side where a surface has holes or is a single sheet: an open vessel is left through its opening.
bool ObstacleProbe::encloses(Vec3 p) const {
    const TriangleSurface* surface = shape_->data().surface.get();
    if (surface == nullptr) return false;
    const Vec3 origin = inverse_transform_point(pose_, p);
    if (!contains(surface->bounds(), origin)) return false;
    const double limit = length(surface->bounds().size());
    for (int side = 0; side < 6; ++side) {
        Vec3 direction;
        direction[side / 2] = side % 2 == 0 ? 1 : -1;
        int leaves = 0;
        surface->find_along_ray(origin, direction, limit, [&](std::uint32_t index, double unchanged) {
            const int facing = crosses(surface->corners(index), origin, direction);
            leaves += facing;
            return unchanged;
        });
        if (leaves < 1) return false;
    }
    return true;
}

bool ObstacleProbe::look_at(const Bounds& box, double reach) {
    reach_ = reach;
    const Bounds wide = enlarged(box, reach);
    near_pieces_.clear();
    near_triangles_.begin(box, reach);
    const CollisionShape::Data& data = shape_->data();
    if (data.is_plane) {
        const Vec3 normal = rotate(pose_.rotation, data.plane_normal);
        const double offset = data.plane_offset + dot(normal, pose_.position);
        const Vec3 half = box.half_extents();
        return dot(normal, box.center()) - offset - dot(abs(normal), half) < reach;
    }
    if (!overlaps(bounds_, wide)) return false;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
        if (overlaps(pieces_[i].bounds, wide)) near_pieces_.push_back(i);
    }
    if (data.surface) {
        found_.clear();
        data.surface->find(transformed(inverse(pose_), wide), found_);
        for (const std::uint32_t index : found_) {
            const Vec3 normal = data.surface->normal(index);
            if (normal == Vec3{}) continue;
            auto corners = data.surface->corners(index);
            for (Vec3& corner : corners) corner = transform_point(pose_, corner);
            near_triangles_.add({corners, rotate(pose_.rotation, normal)});
        }
        near_triangles_.finish();
    }
    return !near_pieces_.empty() || !near_triangles_.empty();
}

ObstacleDistance ObstacleProbe::nearest_triangle(Vec3 p) const {
    // Of triangles at the same distance (p is nearest to a common edge or corner) the one whose normal points most
    // directly at p determines the side; of two that face opposite directions, the front counts.
    double best = reach_ * reach_, best_side = 0;
    Vec3 away;
    for (const std::uint32_t index : near_triangles_.around(p)) {
        const NearTriangle& triangle = near_triangles_[index];
        const double height = dot(p - triangle.corners[0], triangle.normal);
        if (height * height > best * (1 + 1e-9)) continue;
        const Vec3 from = p - closest_on_triangle(p, triangle.corners);
        const double squared = length_squared(from), side = dot(from, triangle.normal);
        if (squared > best * (1 + 1e-9)) continue;
        const bool is_nearer = squared < best * (1 - 1e-9);
        const double difference = std::fabs(side) - std::fabs(best_side);
        const double slack = 1e-9 * std::fabs(best_side);
        if (!is_nearer && (difference < -slack || (difference < slack && side < best_side))) continue;
        best = std::min(best, squared);
        best_side = side;
        away = squared > 1e-24 ? from / std::sqrt(squared) * (side < 0 ? -1.0 : 1.0) : triangle.normal;
    }
    if (away == Vec3{}) return {reach_, {0, 1, 0}};
    return {best_side < 0 ? -std::sqrt(best) : std::sqrt(best), away};
}

ObstacleDistance ObstacleProbe::nearest(Vec3 p) const {
    const CollisionShape::Data& data = shape_->data();
    if (data.is_plane) {
        const Vec3 normal = rotate(pose_.rotation, data.plane_normal);
        return {std::min(reach_, dot(normal, p - pose_.position) - data.plane_offset), normal};
    }
    if (data.surface) return nearest_triangle(p);
    ObstacleDistance best{reach_, {0, 1, 0}};
    for (const std::uint32_t index : near_pieces_) {
        const Piece& piece = pieces_[index];
        if (outside_of(piece.bounds, p) >= best.distance) continue;
        const Vec3 local = rotate_back(piece.rotation, p - piece.position);
        ObstacleDistance here = faces_near(*piece.convex, local).first;
        here.distance -= seal_;
        if (here.distance < best.distance) best = {here.distance, piece.rotation * here.normal};
    }
    return best;
}

void ObstacleProbe::add_octants(Vec3 p, double edge, float* fractions) const {
    const double half = edge / 2;
    const auto add = [&](int octant, double fraction) {
        fractions[octant] = std::min(1.0f, fractions[octant] + static_cast<float>(fraction));
    };
    if (shape_->data().is_plane || shape_->data().surface) {
        for (int octant = 0; octant < octants; ++octant) {
            add(octant, fraction_behind(nearest(p + octant_offset(octant) * edge), half));
        }
        return;
    }
    // Pieces lie side by side: their fractions add up.
    for (const std::uint32_t index : near_pieces_) {
        const Piece& piece = pieces_[index];
        if (outside_of(piece.bounds, p) > edge) continue;
        const Vec3 center = rotate_back(piece.rotation, p - piece.position);
        const FacesOfCube faces(*piece.convex, center, edge);
        if (faces.is_outside) continue;
        for (int octant = 0; octant < octants; ++octant) {
            const Vec3 offset = octant_offset(octant) * edge;
            const TwoFaces two = faces.at(center + rotate_back(piece.rotation, offset));
            double fraction = fraction_behind({two.first.distance, piece.rotation * two.first.normal}, half);
            if (two.second.distance > -half) {
                fraction *= fraction_behind({two.second.distance, piece.rotation * two.second.normal}, half);
            }
            add(octant, fraction);
        }
    }
}

bool ObstacleProbe::is_thinner(Vec3 p, Vec3 normal, double depth) const {
    const CollisionShape::Data& data = shape_->data();
    if (data.is_plane) return false;
    const Vec3 behind = p - normal * depth;
    if (!data.surface) return nearest(behind).distance > 0;
    // A closed mesh is left through its back; an open mesh has no back.
    return crossing(p, behind).has_value();
}

std::optional<ObstacleProbe::Crossing> ObstacleProbe::crossing_of_pieces(Vec3 a, Vec3 direction, double whole) const {
    Bounds box;
    box.add(a);
    box.add(a + direction * whole);
    std::optional<Crossing> first;
    double limit = whole;
    for (const std::uint32_t index : near_pieces_) {
        const Piece& piece = pieces_[index];
        if (!overlaps(piece.bounds, box)) continue;
        const Vec3 from = rotate_back(piece.rotation, a - piece.position);
        const Vec3 along = rotate_back(piece.rotation, direction);
        const bool is_sealed = seal_ > 0 && piece.convex->kind == ConvexKind::polytope;
        const auto hit = is_sealed ? enter(piece.convex->polytope, seal_, from, along, limit)
                                   : cast_ray(*piece.convex, from, along, limit);
        if (!hit) continue;
        limit = hit->distance;
        first = Crossing{hit->distance / whole, piece.rotation * hit->normal};
    }
    return first;
}

std::optional<ObstacleProbe::Crossing> ObstacleProbe::crossing(Vec3 a, Vec3 b) const {
    const Vec3 displacement = b - a;
    const double whole = length(displacement);
    if (!(whole > 0)) return std::nullopt;
    if (shape_->data().is_plane) {
        const auto hit = cast_ray(*shape_, pose_, a, displacement / whole, whole);
        return hit ? std::optional(Crossing{hit->distance / whole, hit->normal}) : std::nullopt;
    }
    if (!shape_->data().surface) return crossing_of_pieces(a, displacement / whole, whole);

    // Both sides of triangles count. T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    std::optional<Crossing> first;
    for (const std::uint32_t index : near_triangles_.along(a, b)) {
        const NearTriangle& triangle = near_triangles_[index];
        const auto& [c0, c1, c2] = triangle.corners;
        const Vec3 e1 = c1 - c0, e2 = c2 - c0, p = cross(displacement, e2);
        const double determinant = dot(e1, p);
        if (determinant == 0) continue;
        const Vec3 from = a - c0, q = cross(from, e1);
        const double u = dot(from, p) / determinant, v = dot(displacement, q) / determinant,
                     t = dot(e2, q) / determinant;
        constexpr double slack = 1e-9;  // of an edge: rounding leaves 1e-12, and neighbours have no gap
        if (u < -slack || v < -slack || u + v > 1 + slack || t < 0 || t > 1) continue;
        if (first && t >= first->fraction) continue;
        first = Crossing{t, determinant > 0 ? triangle.normal : -triangle.normal};
    }
    return first;
}

}  // namespace embody::physics::fluid
