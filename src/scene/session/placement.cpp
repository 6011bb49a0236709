// SPDX-License-Identifier: MIT
#include "scene/session/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "attributes/physical_kind.h"
#include "scene/session/building.h"
#include "scene/session/placement_probe.h"
#include "scene/session/placement_rules.h"

namespace embody::scene {

namespace {

constexpr double steepest_floor = 0.5;   // cosine: a surface up to 60° steep counts as a floor
constexpr double straight_wall = 0.1;    // largest upright part of a wall's normal
constexpr double wall_gap = 0.01;        // m, before a wall while room is looked for
constexpr double wall_reach = 1.0;       // m: a picture dropped on the floor goes to a wall so near
constexpr double hanging_height = 1.5;   // m over the floor: the eyes of who stands before it
constexpr double tall = 1.5;             // m: a wall thing of this height stands on the floor, as doors do
constexpr double neighbour_gap = 0.08;   // m, that is closed beside furniture
constexpr double carpet = 0.05;          // m: what is lower is no neighbour
constexpr double base_of_stacks = 1.4;   // m: on a higher thing nothing is put by pointing at its side
constexpr double max_push = 1.5;         // m, to the side, out of what is there already
constexpr double arm = 5;                // m: so far before the eye where the ray meets nothing
constexpr double farthest_ground = 100;  // m
constexpr double short_fall = 0.05;      // m: on the same support still
constexpr double lift_step = 0.05;       // m: gaps above a stack that are larger are found
constexpr double highest_lift = 30;      // m
constexpr int directions = 16;           // that are tried around a place
constexpr Vec3 down{0, -1, 0}, up{0, 1, 0};

struct Surface {
    Vec3 position;
    Vec3 normal = up;
    EntityIndex on = 0;
};

bool is_floor(const Surface& s) { return s.normal.y > steepest_floor; }
bool is_ceiling(const Surface& s) { return s.normal.y < -steepest_floor; }

Transform moved(Transform pose, Vec3 by) {
    pose.position += by;
    return pose;
}

// Unit vectors all around, in the plane of two.
std::array<Vec3, directions> all_around(Vec3 first, Vec3 second) {
    std::array<Vec3, directions> around;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * std::numbers::pi * i / directions;
        around[static_cast<std::size_t>(i)] = first * std::cos(angle) + second * std::sin(angle);
    }
    return around;
}

// The next height to try: in even steps within a room, in larger ones above.
double raised(double lift) { return lift + std::max(lift_step, 0.1 * (lift - 3)); }

/// A thing while its place is looked for.
class Placer {
public:
    Placer(const SessionState& state, const PlacementProbe& probe, PlacementRules rules,
           const PlacementOptions& options)
        : state_(state), probe_(probe), rules_(std::move(rules)), snap_(options.snap) {}

    [[nodiscard]] Surface find_surface(const PointerRay& ray) const;
    [[nodiscard]] Placement place(const Transform& start, const Surface& surface) const {
        std::optional<Placement> hung;
        if (rules_.usual_place == "wall") hung = hang_on_wall(start, surface);
        if (rules_.usual_place == "ceiling") hung = hang_from_ceiling(start, surface);
        return hung ? *hung : stand(start, surface);
    }

private:
    [[nodiscard]] Placement stand(const Transform& start, const Surface& surface) const;
    [[nodiscard]] Placement stand_on_floor(Transform pose, const Surface& surface) const;
    [[nodiscard]] Placement stand_at_side(Transform pose, const Surface& surface) const;
    [[nodiscard]] std::optional<Placement> put_on_top(Transform pose, const Surface& side) const;
    [[nodiscard]] std::optional<Placement> hang_on_wall(Transform pose, const Surface& surface) const;
    [[nodiscard]] std::optional<Placement> hang_from_ceiling(Transform pose, const Surface& surface) const;

    [[nodiscard]] bool is_fixed(EntityIndex entity) const { return entity != 0 && !probe_.is_movable(entity); }
    [[nodiscard]] bool is_furniture(EntityIndex entity) const;
    [[nodiscard]] bool goes_on(EntityIndex target, const Transform& pose) const;
    /// Nearest upright face of something fixed within `reach` of a place.
    [[nodiscard]] std::optional<Surface> nearest_wall(Vec3 place, double reach) const;
    [[nodiscard]] Transform with_base_at(Transform pose, Vec3 place) const;
    [[nodiscard]] Transform before_wall(Transform pose, const Surface& wall) const;
    [[nodiscard]] Transform touching_wall(const Transform& pose, Vec3 normal) const;
    /// Nearest free place in the plane of two unit vectors; none within max_push.
    [[nodiscard]] std::optional<Transform> with_room(const Transform& pose, Vec3 first, Vec3 second) const;
    [[nodiscard]] std::optional<Transform> lowered(const Transform& pose) const;
    [[nodiscard]] Transform settle(const Transform& pose, const Surface& surface) const;
    [[nodiscard]] Transform back_to_wall(const Transform& pose) const;
    [[nodiscard]] Transform beside_neighbour(const Transform& pose) const;
    [[nodiscard]] EntityIndex support_of(const Transform& pose) const;

    const SessionState& state_;
    const PlacementProbe& probe_;
    PlacementRules rules_;
    bool snap_;
};

bool Placer::is_furniture(EntityIndex entity) const {
    const Entity* definition = state_.simulation->definition(entity);
    if (!definition || !probe_.is_movable(entity)) return false;
    return std::holds_alternative<ModelReference>(definition->geometry) || !definition->category.empty();
}

// Chairs and wardrobes stand on floors: for these the ray passes tables.
Surface Placer::find_surface(const PointerRay& ray) const {
    const Vec3 direction = normalized(ray.direction);
    constexpr int max_passed = 20;
    constexpr double past = 1e-5;  // m
    double gone = 0;
    for (int i = 0; i < max_passed; ++i) {
        const auto hit = probe_.cast_ray(ray.origin + direction * gone, direction, max_ray_length - gone);
        if (!hit) break;
        if (!rules_.stands_on_floors_only || !is_furniture(hit->entity))
            return {hit->position, hit->normal, hit->entity};
        gone += hit->distance + past;
    }
    // Without a hit the ground at height 0, or what is below a place in front of the viewer.
    const double to_ground = direction.y < -1e-3 ? -ray.origin.y / direction.y : -1;
    if (to_ground > 0 && to_ground < farthest_ground) return {ray.origin + direction * to_ground};
    const Vec3 ahead = ray.origin + normalized(Vec3{direction.x, 0, direction.z}) * arm;
    const auto below = probe_.cast_ray(ahead, down, max_ray_length);
    if (below) return {below->position, below->normal, below->entity};
    return {{ahead.x, 0, ahead.z}};
}

// Making room ---------------------------------------------------------------------------------------------------------

Transform Placer::with_base_at(Transform pose, Vec3 place) const {
    pose.position = place;
    pose.position.y += place.y + clearance - probe_.bounds(pose).lower.y;
    return pose;
}

Transform Placer::before_wall(Transform pose, const Surface& wall) const {
    pose.position = wall.position;
    const Bounds bounds = probe_.bounds(pose);
    const Vec3 n = wall.normal, half = bounds.half_extents();
    const double reach = std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z;
    return moved(pose, wall.position - bounds.center() + n * (reach + wall_gap));
}

Transform Placer::touching_wall(const Transform& pose, Vec3 normal) const {
    const Vec3 half = probe_.bounds(pose).half_extents();
    const auto gap = probe_.travel(pose, -normal, wall_gap + half.x + half.z);
    return gap && *gap > clearance ? moved(pose, normal * (clearance - *gap)) : pose;
}

std::optional<Transform> Placer::with_room(const Transform& pose, Vec3 first, Vec3 second) const {
    constexpr double first_step = 0.02, growth = 1.3;  // m, and from ring to ring
    const auto around = all_around(first, second);
    for (double radius = first_step; radius < max_push; radius *= growth) {
        std::optional<double> least;
        Transform best;
        for (const Vec3& direction : around) {
            const Transform tried = moved(pose, direction * radius);
            if (probe_.overlaps(tried)) continue;
            // Not through a wall.
            const Vec3 center = probe_.bounds(pose).center();
            const auto between = probe_.cast_ray(center, direction, radius);
            if (between && is_fixed(between->entity)) continue;
            const double back = probe_.travel(tried, -direction, radius).value_or(radius);
            const double left = radius - std::max(0.0, back - clearance);
            if (least && left >= *least) continue;
            least = left;
            best = moved(pose, direction * left);
        }
        if (least) return best;
    }
    return std::nullopt;
}

// Where it comes to rest from there; none where it overlaps something.
std::optional<Transform> Placer::lowered(const Transform& pose) const {
    if (probe_.overlaps(pose)) return std::nullopt;
    const auto fall = probe_.fall(pose);
    return fall ? moved(pose, down * std::max(0.0, *fall - clearance)) : pose;
}

// On the first support below, out of what is there already: a little higher, to the side, on top of it.
Transform Placer::settle(const Transform& pose, const Surface& surface) const {
    const bool is_level = surface.normal.y > 0.999;
    for (const double lift : {0.0, 0.002, 0.02})
        if (const auto found = lowered(moved(pose, up * lift))) return *found;
    const auto to_the_side = [&]() -> std::optional<Transform> {
        const auto room = with_room(moved(pose, up * 0.002), {1, 0, 0}, {0, 0, 1});
        const auto found = room ? lowered(*room) : room;
        if (found && found->position.y > pose.position.y - short_fall) return found;
        return std::nullopt;
    };
    if (is_level)
        if (const auto found = to_the_side()) return *found;
    for (double lift = lift_step; lift < highest_lift; lift = raised(lift))
        if (const auto found = lowered(moved(pose, up * lift))) return *found;
    return pose;
}

// Walls and neighbours ------------------------------------------------------------------------------------------------

std::optional<Surface> Placer::nearest_wall(Vec3 place, double reach) const {
    std::optional<Surface> nearest;
    double least = reach;
    for (const Vec3& direction : all_around({1, 0, 0}, {0, 0, 1})) {
        const auto hit = probe_.cast_ray(place, direction, reach * 1.5);
        if (!hit || !is_fixed(hit->entity) || std::fabs(hit->normal.y) > straight_wall) continue;
        const Vec3 normal = normalized(Vec3{hit->normal.x, 0, hit->normal.z});
        const double distance = dot(place - hit->position, normal);
        if (distance >= least) continue;
        least = distance;
        nearest = Surface{place - normal * distance, normal, hit->entity};
    }
    return nearest;
}

// Furniture nearer to a wall than half its depth turns its back to it and touches it.
Transform Placer::back_to_wall(const Transform& pose) const {
    const Vec3 front = front_of(rules_);
    const Bounds own = probe_.bounds({{}, {}});
    const double depth = dot(abs(front), own.size());
    const Bounds bounds = probe_.bounds(pose);
    Vec3 eye = bounds.center();
    eye.y = std::min(eye.y, bounds.lower.y + 1);
    const auto wall = nearest_wall(eye, depth);
    if (!wall) return pose;
    Transform turned{pose.position, turned_to(pose.rotation, front, wall->normal)};
    const Bounds now = probe_.bounds(turned);
    const Vec3 half = now.half_extents();
    const double reach = std::fabs(wall->normal.x) * half.x + std::fabs(wall->normal.z) * half.z;
    const double gap = dot(now.center() - wall->position, wall->normal) - reach;
    const Transform there = moved(turned, wall->normal * (clearance - gap));
    // Skirting boards and what else is before the wall.
    return touching_wall(moved(there, wall->normal * wall_gap), wall->normal);
}

Transform Placer::beside_neighbour(const Transform& pose) const {
    const Vec3 side = normalized(cross(up, rotate(pose.rotation, front_of(rules_))));
    if (side == Vec3{}) return pose;
    std::optional<double> least;
    Vec3 toward;
    for (const Vec3& direction : {side, -side}) {
        const auto gap = probe_.travel(moved(pose, up * carpet), direction, neighbour_gap);
        if (!gap || (least && *gap >= *least)) continue;
        least = gap;
        toward = direction;
    }
    if (!least || *least <= clearance) return pose;
    const Transform there = moved(pose, toward * (*least - clearance));
    return probe_.overlaps(there) ? pose : there;
}

EntityIndex Placer::support_of(const Transform& pose) const {
    const Bounds bounds = probe_.bounds(pose);
    Vec3 base = bounds.center();
    base.y = bounds.lower.y + std::min(0.01, bounds.size().y / 2);
    const auto hit = probe_.cast_ray(base, down, 0.1);
    return hit ? hit->entity : 0;
}

// Standing ------------------------------------------------------------------------------------------------------------

Placement Placer::stand(const Transform& start, const Surface& surface) const {
    if (is_floor(surface)) return stand_on_floor(start, surface);
    if (is_ceiling(surface)) {
        Transform below = start;
        below.position = surface.position;
        below.position.y += surface.position.y - wall_gap - probe_.bounds(below).upper.y;
        const auto found = lowered(below);
        const Transform pose = found ? *found : settle(below, {});
        return {pose, support_of(pose)};
    }
    if (goes_on(surface.on, start))
        if (const auto found = put_on_top(start, surface)) return *found;
    return stand_at_side(start, surface);
}

Placement Placer::stand_on_floor(Transform pose, const Surface& surface) const {
    pose = with_base_at(pose, surface.position);
    if (snap_ && rules_.belongs_to_walls) pose = back_to_wall(pose);
    pose = settle(pose, surface);
    if (snap_ && rules_.belongs_to_walls) pose = beside_neighbour(pose);
    const EntityIndex support = support_of(pose);
    return {pose, support != 0 ? support : surface.on};
}

// Things of tables go on anything of their size, others on their like.
bool Placer::goes_on(EntityIndex target, const Transform& pose) const {
    if (!probe_.is_movable(target) || rules_.stands_on_floors_only) return false;
    const Entity* other = state_.simulation->definition(target);
    const Bounds base = state_.simulation->bounds(target), own = probe_.bounds(pose);
    if (!other || base.is_empty() || base.size().y > base_of_stacks) return false;
    constexpr double widest = 1.5;  // times the thing below
    if (own.size().x > widest * base.size().x || own.size().z > widest * base.size().z) return false;
    if (rules_.usual_place == "table" || rules_.usual_place == "free" || !rules_.has_front) return true;
    const auto acting = state_.simulation->attributes(target);
    return acting.ok() && placement_rules(*other, acting.value()).category == rules_.category;
}

std::optional<Placement> Placer::put_on_top(Transform pose, const Surface& side) const {
    const Bounds base = state_.simulation->bounds(side.on);
    if (snap_ && !rules_.has_front) {
        const Vec3 along = rotate(state_.simulation->pose(side.on).rotation, Vec3{1, 0, 0});
        pose.rotation = squared_to(pose.rotation, normalized(Vec3{along.x, 0, along.z}));
    }
    const Vec3 half = probe_.bounds(pose).half_extents(), room = base.half_extents(), middle = base.center();
    const auto within = [](double wanted, double center, double space) {
        return space > 0 ? std::clamp(wanted, center - space, center + space) : center;
    };
    const Vec3 place{within(side.position.x, middle.x, room.x - half.x), base.upper.y,
                     within(side.position.z, middle.z, room.z - half.z)};
    pose = with_base_at(pose, place);
    const Vec3 center = probe_.bounds(pose).center();
    pose = moved(pose, {place.x - center.x, 0, place.z - center.z});
    for (double lift = 0; lift < highest_lift; lift = raised(lift)) {
        const auto found = lowered(moved(pose, up * lift));
        if (!found) continue;
        // Beside it: it has no flat top there.
        if (probe_.bounds(*found).lower.y < base.center().y) return std::nullopt;
        const EntityIndex support = support_of(*found);
        return Placement{*found, support != 0 ? support : side.on};
    }
    return std::nullopt;
}

Placement Placer::stand_at_side(Transform pose, const Surface& surface) const {
    const Vec3 n = normalized(Vec3{surface.normal.x, 0, surface.normal.z});
    if (snap_ && is_fixed(surface.on))
        pose.rotation = rules_.has_front ? turned_to(pose.rotation, front_of(rules_), n) : squared_to(pose.rotation, n);
    pose = before_wall(pose, {surface.position, n, surface.on});
    const Bounds bounds = probe_.bounds(pose);
    const Vec3 front = surface.position + n * (bounds.half_extents().x + bounds.half_extents().z + wall_gap);
    const auto below = probe_.cast_ray({front.x, surface.position.y, front.z}, down, max_ray_length);

    // From where the ray met the wall, else lower, where there is room.
    const double on_floor = (below ? below->position.y : surface.position.y - bounds.half_extents().y) - bounds.lower.y;
    std::optional<Transform> found;
    for (const double lift : {0.0, -bounds.half_extents().y + wall_gap, on_floor + clearance, on_floor + 0.02}) {
        found = lowered(moved(pose, up * lift));
        if (found) break;
    }
    if (!found) found = settle(moved(pose, up * (on_floor + clearance)), {surface.position, up, 0});
    pose = touching_wall(*found, n);
    if (const auto lower = lowered(pose)) pose = *lower;
    if (snap_ && rules_.belongs_to_walls) pose = beside_neighbour(pose);
    return {pose, support_of(pose)};
}

// Hanging -------------------------------------------------------------------------------------------------------------

std::optional<Placement> Placer::hang_on_wall(Transform pose, const Surface& surface) const {
    Surface wall = surface;
    if (is_floor(surface) || is_ceiling(surface)) {
        if (surface.on != 0 && !is_fixed(surface.on)) return std::nullopt;
        const Vec3 eye = surface.position + up * (is_floor(surface) ? hanging_height : -0.3);
        const auto found = nearest_wall(eye, wall_reach);
        if (!found) return std::nullopt;
        wall = *found;
    } else if (!is_fixed(surface.on)) {
        return std::nullopt;
    }
    wall.normal = normalized(Vec3{wall.normal.x, 0, wall.normal.z});
    pose.rotation = turned_to(pose.rotation, front_of(rules_), wall.normal);
    pose = before_wall(pose, wall);
    const double height = probe_.bounds(pose).size().y;
    if (height > tall) {
        const auto floor = probe_.cast_ray(probe_.bounds(pose).center(), down, max_ray_length);
        if (floor) pose = moved(pose, up * (floor->position.y + clearance - probe_.bounds(pose).lower.y));
    }
    if (probe_.overlaps(pose)) {
        const auto room = with_room(pose, cross(up, wall.normal), up);
        if (!room) return std::nullopt;
        pose = *room;
    }
    return Placement{touching_wall(pose, wall.normal), wall.on, Seat::wall};
}

std::optional<Placement> Placer::hang_from_ceiling(Transform pose, const Surface& surface) const {
    Surface ceiling = surface;
    if (!is_ceiling(surface)) {
        const Vec3 half = probe_.bounds(pose).half_extents();
        const Vec3 n = is_floor(surface) ? up : surface.normal;
        const Vec3 start = surface.position + n * (is_floor(surface) ? wall_gap : half.x + half.z + wall_gap);
        const auto hit = probe_.cast_ray(start, up, max_ray_length);
        if (!hit || !is_ceiling({hit->position, hit->normal, 0})) return std::nullopt;
        ceiling = {hit->position, hit->normal, hit->entity};
    }
    if (!is_fixed(ceiling.on)) return std::nullopt;
    pose.position = ceiling.position;
    pose.position.y += ceiling.position.y - wall_gap - probe_.bounds(pose).upper.y;
    if (probe_.overlaps(pose)) {
        const auto room = with_room(pose, {1, 0, 0}, {0, 0, 1});
        if (!room) return std::nullopt;
        pose = *room;
    }
    const auto gap = probe_.travel(pose, up, wall_gap * 2);
    if (gap && *gap > clearance) pose = moved(pose, up * (*gap - clearance));
    return Placement{pose, ceiling.on, Seat::ceiling};
}

}  // namespace

std::string to_text(Seat seat) { return seat == Seat::wall ? "wall" : seat == Seat::ceiling ? "ceiling" : "floor"; }

Result<Placement> place_on_ray(SessionState& state, const Entity& entity, const PointerRay& ray,
                               const PlacementOptions& options) {
    if (!(length(ray.direction) > 1e-9)) return Error{"drop.direction", "must not be zero"};
    const Result<attributes::AttributeSet> acting = state.definitions.attributes.acting(entity);
    if (!acting.ok()) return acting.error();
    const Result<PlacementProbe> probe = PlacementProbe::make(state, entity, options.ignored);
    if (!probe.ok()) return probe.error();
    const Placer placer(state, probe.value(), placement_rules(entity, acting.value()), options);
    const Surface surface = placer.find_surface(ray);
    if (const auto in_wall = place_in_wall(state, entity, ray, distance(surface.position, ray.origin))) return *in_wall;
    if (!probe.value().has_bounds({{}, entity.pose.rotation}))
        return Placement{{surface.position, entity.pose.rotation}, surface.on};
    return placer.place(entity.pose, surface);
}

}  // namespace embody::scene
