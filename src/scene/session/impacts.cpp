// SPDX-License-Identifier: MIT
#include "scene/session/impacts.h"

#include <algorithm>
#include <map>
#include <utility>

namespace embody::scene {

using physics::ContactEvent;

namespace {

constexpr std::size_t max_impacts = 8;  // of one event: more at once sound like one

}  // namespace

std::vector<Impact> new_impacts(const Simulation& simulation,
                                const std::function<bool(const ContactEvent&)>& is_meant) {
    std::vector<Impact> impacts;
    std::map<std::pair<physics::BodyHandle, physics::BodyHandle>, std::size_t> places;
    for (const ContactEvent& event : simulation.world().contact_events()) {
        if (event.kind != ContactEvent::Kind::begin || !is_meant(event)) continue;
        places[{event.a, event.b}] = impacts.size();
        impacts.push_back({event.a, event.b, event.position, 0});
    }
    if (impacts.empty()) return impacts;
    std::vector<Vec3> sums(impacts.size());
    for (const physics::ContactView& contact : simulation.world().contacts()) {
        const auto found = places.find({contact.a, contact.b});
        if (found != places.end()) sums[found->second] += contact.impulse;
    }
    for (std::size_t i = 0; i < impacts.size(); ++i) impacts[i].impulse = length(sums[i]);
    return impacts;
}

bool Pace::is_due(double simulated) {
    const Clock::time_point now = Clock::now();
    if (simulated < last_) last_ = -1e9;
    // A step that comes half a step early by rounding is not late by one.
    if (now < next_ || simulated < last_ + period_ * (1 - 1e-9)) return false;
    last_ = simulated;
    next_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
    return true;
}

void StrongestImpacts::add(const std::vector<Impact>& impacts) {
    impacts_.insert(impacts_.end(), impacts.begin(), impacts.end());
    std::ranges::stable_sort(impacts_, std::greater(), &Impact::impulse);
    if (impacts_.size() > max_impacts) impacts_.resize(max_impacts);
}

std::vector<Impact> StrongestImpacts::take() { return std::exchange(impacts_, {}); }

}  // namespace embody::scene
