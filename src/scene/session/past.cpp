// SPDX-License-Identifier: MIT
#include "scene/session/past.h"

#include <algorithm>

namespace embody::scene {

namespace {

/// Of more marks the weaker half of the contacts goes.
constexpr std::size_t max_marks = 4000;

}  // namespace

void Marks::add(Mark mark) {
    ++revision_;
    marks_.push_back(std::move(mark));
    if (marks_.size() <= max_marks) return;
    std::vector<double> impulses;
    for (const Mark& each : marks_)
        if (each.kind == Mark::Kind::contact) impulses.push_back(each.impulse);
    // Where nearly all are something else, the older half goes.
    if (impulses.size() < max_marks / 4) {
        marks_.erase(marks_.begin(), marks_.begin() + max_marks / 2);
        return;
    }
    const auto middle = impulses.begin() + static_cast<std::ptrdiff_t>(impulses.size() / 2);
    std::ranges::nth_element(impulses, middle);
    const double weakest = *middle;
    std::erase_if(marks_,
                  [&](const Mark& each) { return each.kind == Mark::Kind::contact && each.impulse <= weakest; });
}

void Marks::cut_after(double time) {
    ++revision_;
    std::erase_if(marks_, [time](const Mark& mark) { return mark.time > time; });
}

void Marks::cut_before(double time) {
    if (marks_.empty() || marks_.front().time >= time) return;
    ++revision_;
    std::erase_if(marks_, [time](const Mark& mark) { return mark.time < time; });
}

void Marks::clear() {
    ++revision_;
    marks_.clear();
}

std::vector<std::uint32_t> Past::broken_at(EntityIndex rope, double time) const {
    std::vector<std::uint32_t> segments;
    for (const Break& broke : breaks)
        if (broke.rope == rope && broke.time <= time) segments.push_back(broke.segment);
    return segments;
}

std::vector<physics::TornCorner> Past::torn_at(EntityIndex sheet, double time, std::size_t points) const {
    std::vector<physics::TornCorner> corners;
    if (const auto known = torn.find(sheet); known != torn.end()) {
        for (const Torn& each : known->second)
            if (each.since <= time) corners = each.corners;
    }
    // What tore later made nodes of higher numbers.
    std::erase_if(corners, [points](const physics::TornCorner& corner) { return corner.node >= points; });
    return corners;
}

void Past::add_torn(EntityIndex sheet, double time, std::vector<physics::TornCorner> corners) {
    std::vector<Torn>& known = torn[sheet];
    const auto goes_on = [&](const std::vector<physics::TornCorner>& before) {
        return before.size() <= corners.size() && std::equal(before.begin(), before.end(), corners.begin());
    };
    if (known.empty() || !goes_on(known.back().corners)) known.push_back({time, {}});
    known.back().corners = std::move(corners);
}

void Past::clear() {
    take.clear();
    marks.clear();
    spawned.clear();
    removed.clear();
    melted.clear();
    fired.clear();
    torn.clear();
    breaks.clear();
    if (shown) ++jumps;
    shown.reset();
}

}  // namespace embody::scene
