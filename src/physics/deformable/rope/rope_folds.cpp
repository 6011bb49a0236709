// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_folds.h"

#include <algorithm>
#include <cmath>

#include "math/quat.h"

namespace embody::physics::deformable {

namespace {

using Part = std::array<double, 2>;

// Of complex numbers.
Part product(Part a, Part b) { return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]}; }
Part conjugate(Part a) { return {a[0], -a[1]}; }
double size_of(Part a) { return std::hypot(a[0], a[1]); }
// Of size 1; 1 where there is no angle.
Part unit(Part a) {
    const double size = size_of(a);
    return size > 0 ? Part{a[0] / size, a[1] / size} : Part{1, 0};
}

Vec3 middle_of(const RopeCorner& corner) { return normalized(corner.before + corner.after, corner.before); }

}  // namespace

// Of one span: from corner to corner by the smallest turn of the wire's direction, and all turned together as its first
// clamp is.
void RopeFolds::find_axes(std::span<const RopeCorner> corners, std::span<Seen> seen) {
    Vec3 along = middle_of(corners[0]), first = any_perpendicular(along);
    std::uint32_t clamp = RopeCorner::no_clamp;
    Part angle{1, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 here = middle_of(corners[i]);
        first = rotate(from_two_vectors(along, here), first);
        along = here;
        first = normalized(first - dot(first, along) * along, any_perpendicular(along));
        seen[i].first = first;
        seen[i].second = cross(along, first);
        if (clamp != RopeCorner::no_clamp || corners[i].clamp == RopeCorner::no_clamp) continue;
        clamp = corners[i].clamp;
        angle = unit({dot(corners[i].side, seen[i].first), dot(corners[i].side, seen[i].second)});
    }
    for (Seen& own : seen) {
        const Vec3 turned = angle[0] * own.first + angle[1] * own.second;
        own.second = angle[0] * own.second - angle[1] * own.first;
        own.first = turned;
        own.clamp = clamp;
    }
}

// Of one span. Folds whose axes went by the same clamp stay as they are; others turn together to where they have the
// least energy, the angle of Σ stiffness bend fold*.
void RopeFolds::find_folds(std::span<const RopeCorner> corners, std::span<Seen> seen) const {
    Part best{};
    bool is_known = seen[0].clamp != RopeCorner::no_clamp;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 bend = corners[i].after - corners[i].before;
        const Fold& kept = folds_[corners[i].fold];
        seen[i].bend = {dot(bend, seen[i].first), dot(bend, seen[i].second)};
        const Part pull = product(seen[i].bend, conjugate(kept.part));
        for (std::size_t k = 0; k < 2; ++k) best[k] += corners[i].stiffness * pull[k];
        is_known = is_known && (kept.clamp == seen[i].clamp || size_of(kept.part) == 0);
    }
    const Part angle = is_known ? Part{1, 0} : unit(best);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Part& fold = seen[i].fold = product(angle, folds_[corners[i].fold].part);
        // It follows the bend beyond the limit.
        const Part beyond{seen[i].bend[0] - fold[0], seen[i].bend[1] - fold[1]};
        const double size = size_of(beyond), limit = yield_ * corners[i].length;
        if (size <= limit) continue;
        for (std::size_t k = 0; k < 2; ++k) fold[k] += (1 - limit / size) * beyond[k];
    }
}

std::vector<RopeFolds::Seen> RopeFolds::see(std::span<const RopeCorner> corners) const {
    std::vector<Seen> seen(corners.size());
    for (std::size_t first = 0, last = 0; first < corners.size(); first = last) {
        for (last = first + 1; last < corners.size() && !corners[last].begins_span;) ++last;
        const auto span = corners.subspan(first, last - first);
        const auto span_seen = std::span(seen).subspan(first, last - first);
        find_axes(span, span_seen);
        find_folds(span, span_seen);
    }
    return seen;
}

std::vector<Vec3> RopeFolds::at(std::span<const RopeCorner> corners) const {
    std::vector<Vec3> folds;
    for (const Seen& seen : see(corners)) folds.push_back(seen.fold[0] * seen.first + seen.fold[1] * seen.second);
    return folds;
}

void RopeFolds::keep(std::span<const RopeCorner> corners) {
    const std::vector<Seen> seen = see(corners);
    for (std::size_t i = 0; i < corners.size(); ++i) folds_[corners[i].fold] = {seen[i].fold, seen[i].clamp};
}

std::vector<std::array<double, 6>> RopeFolds::state() const {
    const bool has_any = std::ranges::any_of(folds_, [](const Fold& fold) { return size_of(fold.part) > 0; });
    std::vector<std::array<double, 6>> states(has_any ? folds_.size() / by_node : 0);
    for (std::size_t i = 0; i < by_node * states.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) states[i / by_node][2 * (i % by_node) + k] = folds_[i].part[k];
    }
    return states;
}

void RopeFolds::set_state(std::span<const std::array<double, 6>> states) {
    for (std::size_t i = 0; i < folds_.size(); ++i) {
        const auto part = [&](std::size_t k) {
            return states.empty() ? 0 : states[i / by_node][2 * (i % by_node) + k];
        };
        folds_[i] = {{part(0), part(1)}};
    }
}

}  // namespace embody::physics::deformable
