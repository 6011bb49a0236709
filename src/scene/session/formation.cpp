// SPDX-License-Identifier: MIT
#include "scene/session/formation.h"

#include <algorithm>
#include <array>
#include <optional>

#include "scene/session/placement_probe.h"

namespace embody::scene {

namespace {

// Of more things only the lead is looked at: each of them is tried at each height.
constexpr std::size_t max_looked_at = 60;
constexpr auto lifts = std::to_array({0.0, 0.002, 0.02, 0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0});  // m

Transform lifted(Transform pose, double by) {
    pose.position.y += by;
    return pose;
}

}  // namespace

Formation::Formation(SessionState& state, EntityIndex lead, const std::vector<EntityIndex>& indices) : state_(state) {
    for (const EntityIndex index : indices) {
        if (index == lead) lead_ = members_.size();
        members_.push_back(*state.document.find(index));
        if (state.simulation->contains(index)) members_.back().pose = state.simulation->pose(index);
        ignored_.insert(index);
    }
}

Formation::Formation(SessionState& state, std::vector<Entity> members) : state_(state), members_(std::move(members)) {}

void Formation::follow(const Transform& lead) {
    const Transform before = members_[lead_].pose;
    const Quat turn = normalized(lead.rotation * conjugate(before.rotation));
    for (Entity& member : members_) {
        const Vec3 offset = member.pose.position - before.position;
        member.pose = {lead.position + rotate(turn, offset), normalized(turn * member.pose.rotation)};
    }
    members_[lead_].pose = lead;
}

// How much higher all can stand on what is there, or lower, without one of them ending in it.
double Formation::raised() const {
    std::array<bool, lifts.size()> has_room;
    std::array<std::optional<double>, lifts.size()> fall;
    has_room.fill(true);
    for (const Entity& member : members_) {
        const Result<PlacementProbe> probe = PlacementProbe::make(state_, member, ignored_);
        if (!probe.ok() || !probe.value().has_bounds(member.pose)) continue;
        for (std::size_t i = 0; i < lifts.size(); ++i) {
            const Transform pose = lifted(member.pose, lifts[i]);
            if (!has_room[i]) continue;
            if (probe.value().overlaps(pose)) {
                has_room[i] = false;
                continue;
            }
            const auto its = probe.value().fall(pose);
            if (its && (!fall[i] || *its < *fall[i])) fall[i] = its;
        }
    }
    for (std::size_t i = 0; i < lifts.size(); ++i)
        if (has_room[i]) return lifts[i] - (fall[i] ? std::max(0.0, *fall[i] - clearance) : 0);
    return 0;
}

Result<Placement> Formation::place(const PointerRay& ray, bool snap) {
    Result<Placement> placed = place_on_ray(state_, members_[lead_], ray, {snap, ignored_});
    if (!placed.ok()) return placed;
    follow(placed.value().pose);
    if (members_.size() == 1 || members_.size() > max_looked_at || placed.value().seat != Seat::floor) return placed;
    const double by = raised();
    for (Entity& member : members_) member.pose = lifted(member.pose, by);
    placed.value().pose = members_[lead_].pose;
    return placed;
}

}  // namespace embody::scene
