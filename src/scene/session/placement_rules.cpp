// SPDX-License-Identifier: MIT
#include "scene/session/placement_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace embody::scene {

namespace {

// Categories of the taxonomy. Furniture whose back people put to a wall.
constexpr auto at_walls = std::to_array<std::string_view>({"air conditioner",
                                                           "bed",
                                                           "cabinet",
                                                           "chest of drawers",
                                                           "desk",
                                                           "fireplace",
                                                           "oven",
                                                           "radiator",
                                                           "refrigerator",
                                                           "shelf",
                                                           "sofa",
                                                           "television cabinet",
                                                           "toilet",
                                                           "wardrobe",
                                                           "washbasin",
                                                           "washing machine",
                                                           "bathtub",
                                                           "tumble dryer",
                                                           "shower",
                                                           "water heater"});
// Furniture that nobody puts on a table.
constexpr auto on_floors_only = std::to_array<std::string_view>(
    {"bathtub", "bed", "bench", "bicycle", "car", "chair", "desk", "motorcycle", "ottoman", "refrigerator", "shower",
     "sofa", "table", "toilet", "wardrobe", "washing machine"});

template <std::size_t count>
bool is_in(const std::array<std::string_view, count>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

Vec3 horizontal(Vec3 v) { return normalized(Vec3{v.x, 0, v.z}); }

// The angle about the vertical from one horizontal direction to another.
double angle_between(Vec3 from, Vec3 to) { return std::atan2(cross(from, to).y, dot(from, to)); }

}  // namespace

PlacementRules placement_rules(const Entity& entity, const attributes::AttributeSet& acting) {
    PlacementRules rules;
    const bool is_model = std::holds_alternative<ModelReference>(entity.geometry);
    rules.has_front = is_model || !entity.category.empty();
    rules.usual_place = acting.word("placement", "floor");
    rules.category = is_model ? acting.word("category", "") : entity.category;
    rules.front = acting.word("front", "+z");
    rules.belongs_to_walls = is_in(at_walls, rules.category);
    rules.stands_on_floors_only = is_in(on_floors_only, rules.category);
    return rules;
}

Vec3 front_of(const PlacementRules& rules) {
    if (rules.front == "-z") return {0, 0, -1};
    if (rules.front == "+x") return {1, 0, 0};
    if (rules.front == "-x") return {-1, 0, 0};
    return {0, 0, 1};
}

Quat turned_to(Quat rotation, Vec3 front, Vec3 wanted) {
    const Vec3 now = horizontal(rotate(rotation, front));
    // What lies on its back or its face has no front to the side.
    if (now == Vec3{} || std::fabs(rotate(rotation, front).y) > 0.9) return rotation;
    return normalized(from_axis_angle({0, 1, 0}, angle_between(now, wanted)) * rotation);
}

Quat squared_to(Quat rotation, Vec3 wanted) {
    const Vec3 x = rotate(rotation, Vec3{1, 0, 0}), z = rotate(rotation, Vec3{0, 0, 1});
    const Vec3 axis = horizontal(std::fabs(x.y) < std::fabs(z.y) ? x : z);
    if (axis == Vec3{}) return rotation;
    constexpr double quarter = std::numbers::pi / 2;
    const double angle = angle_between(axis, wanted);
    const double least = angle - quarter * std::round(angle / quarter);
    return normalized(from_axis_angle({0, 1, 0}, least) * rotation);
}

}  // namespace embody::scene
