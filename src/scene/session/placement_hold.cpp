// SPDX-License-Identifier: MIT
// What a thing needs to stay where it was hung, and how it hangs or stands now.
#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "scene/session/placement.h"
#include "scene/session/placement_probe.h"
#include "scene/session/placement_rules.h"

namespace embody::scene {

namespace {

constexpr double still_touching = 0.03;  // m: what is nearer to its wall hangs on it
constexpr double pin_spacing = 0.12;     // m, between the pins of a curtain

std::string usual_place(const attributes::AttributeSet& acting) { return acting.word("placement", "floor"); }

// Along the upper edge, so near each other that their balls leave no gap.
std::vector<Pin> pins_of_upper_edge(const Bounds& own) {
    const Vec3 size = own.size(), middle = own.center();
    const bool is_wide = size.x >= size.z;
    const double width = is_wide ? size.x : size.z;
    const int count = std::clamp(static_cast<int>(std::ceil(width / pin_spacing)), 1, 100);
    std::vector<Pin> pins;
    for (int i = 0; i <= count; ++i) {
        const double along = (static_cast<double>(i) / count - 0.5) * width;
        Pin pin;
        pin.position = {middle.x + (is_wide ? along : 0), own.upper.y, middle.z + (is_wide ? 0 : along)};
        pin.radius = std::max(0.01, 0.5 * width / count);
        pins.push_back(pin);
    }
    return pins;
}

Result<PlacementProbe> probe_of(SessionState& state, const Entity& entity) {
    static const std::set<EntityIndex> none;
    return PlacementProbe::make(state, entity, none);
}

}  // namespace

bool can_hang(SessionState& state, const Entity& entity) {
    const auto acting = state.definitions.attributes.acting(entity);
    if (!acting.ok()) return false;
    return usual_place(acting.value()) == "wall" || usual_place(acting.value()) == "ceiling";
}

bool hold_in_place(SessionState& state, Entity& entity, Seat seat) {
    using attributes::PhysicalKind;
    if (!can_hang(state, entity)) return false;
    const auto automatic = state.definitions.attributes.automatic(entity);
    const auto acting = state.definitions.attributes.acting(entity);
    if (!automatic.ok() || !acting.ok()) return false;
    const PhysicalKind kind = kind_of(acting.value());
    if (seat == Seat::floor) {
        if (!is_static(kind) || is_static(kind_of(automatic.value()))) return false;
        return entity.attributes.erase("kind") > 0;
    }
    if (kind == PhysicalKind::cloth) {
        const auto probe = probe_of(state, entity);
        if (!entity.pins.empty() || !probe.ok() || !probe.value().has_bounds({})) return false;
        entity.pins = pins_of_upper_edge(probe.value().bounds({}));
        return true;
    }
    if (is_static(kind) || changes_form(kind)) return false;
    entity.attributes["kind"] = to_value(PhysicalKind::static_body);
    return true;
}

Result<Vec3> placing_point(SessionState& state, const Entity& entity, Seat seat) {
    const auto probe = probe_of(state, entity);
    if (!probe.ok()) return probe.error();
    const Transform& pose = entity.pose;
    if (!probe.value().has_bounds(pose)) return pose.position;
    const Bounds bounds = probe.value().bounds(pose);
    if (seat == Seat::floor) return Vec3{pose.position.x, bounds.lower.y, pose.position.z};
    if (seat == Seat::ceiling) return Vec3{pose.position.x, bounds.upper.y, pose.position.z};
    const auto acting = state.definitions.attributes.acting(entity);
    if (!acting.ok()) return acting.error();
    const Vec3 front = rotate(pose.rotation, front_of(placement_rules(entity, acting.value())));
    return bounds.center() - front * dot(abs(front), bounds.half_extents());
}

Seat present_seat(SessionState& state, const Entity& entity) {
    const auto acting = state.definitions.attributes.acting(entity);
    if (!acting.ok()) return Seat::floor;
    const std::string usual = usual_place(acting.value());
    if (usual != "wall" && usual != "ceiling") return Seat::floor;
    const std::set<EntityIndex> itself{entity.index};
    const auto probe = PlacementProbe::make(state, entity, itself);
    if (!probe.ok()) return Seat::floor;
    const Vec3 front = rotate(entity.pose.rotation, front_of(placement_rules(entity, acting.value())));
    const Vec3 toward = usual == "wall" ? -normalized(front, {0, 0, 1}) : Vec3{0, 1, 0};
    if (!probe.value().travel(entity.pose, toward, still_touching)) return Seat::floor;
    return usual == "wall" ? Seat::wall : Seat::ceiling;
}

}  // namespace embody::scene
