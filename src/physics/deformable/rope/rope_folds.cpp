// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_folds.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

// Of one span: by the smallest turn from each direction to the next, and all turned together as its first clamp is.
void RopeFolds::find_axes(std::span<const RopeCorner> corners, std::span<Seen> seen) {
    Vec3 along = corners[0].before.direction.displacement, first = any_perpendicular(along);
    std::uint32_t clamp = RopeCorner::no_clamp;
    Part angle{1, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 before = corners[i].before.direction.displacement, after = corners[i].after.direction.displacement;
        Seen& own = seen[i];
        own.middle = normalized(before + after, before);
        first = carried(first, along, own.middle);
        first = normalized(first - dot(first, own.middle) * own.middle, any_perpendicular(own.middle));
        own.first = first;
        own.second = cross(own.middle, first);
        first = carried(first, own.middle, after);
        along = after;
        if (clamp != RopeCorner::no_clamp || corners[i].clamp == RopeCorner::no_clamp) continue;
        clamp = corners[i].clamp;
        const bool is_before = corners[i].before.segment == FoldRow::none;  // that which is the clamp's
        const Vec3 normal = carried(corners[i].normal, is_before ? before : after, own.middle);
        angle = unit({dot(normal, own.first), dot(normal, own.second)});
    }
    for (Seen& own : seen) {
        const Vec3 turned = angle[0] * own.first + angle[1] * own.second;
        own.second = angle[0] * own.second - angle[1] * own.first;
        own.first = turned;
        own.clamp = clamp;
    }
}

// Of one span. Folds whose axes went by the same clamp stay as they are; others turn together to where they have the
// least energy. Of parts that are elastic that is the angle of Σ bend (stiffness fold + damping start)*; what yields
// counts with the moment that it bears over what it is beyond its fold, found by iteration.
void RopeFolds::find_folds(std::span<const RopeCorner> corners, double damping, std::span<Seen> seen) const {
    bool is_known = seen[0].clamp != RopeCorner::no_clamp;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 bend = corners[i].after.direction.displacement - corners[i].before.direction.displacement;
        const Fold& kept = folds_[corners[i].fold];
        seen[i].bend = {dot(bend, seen[i].first), dot(bend, seen[i].second)};
        seen[i].fold = kept.part;
        seen[i].start = kept.start;
        seen[i].stiffness = rigidity_ / corners[i].length;
        seen[i].damping = damping * seen[i].stiffness;
        is_known = is_known && (kept.clamp == seen[i].clamp || size_of(kept.part) == 0);
    }
    constexpr int iterations = 10;  // Test: RopeFolds.ForcesAreTheDerivativesOfTheEnergy
    for (int iteration = 0; iteration < iterations; ++iteration) {
        Part best{};
        for (const Seen& own : seen) {
            const Part by_fold = product(own.bend, conjugate(own.fold));
            const Part by_start = product(own.bend, conjugate(own.start));
            for (std::size_t k = 0; k < 2; ++k) best[k] += own.stiffness * by_fold[k] + own.damping * by_start[k];
        }
        const Part angle = is_known ? Part{1, 0} : unit(best);
        bool is_elastic = true;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            seen[i].fold = product(angle, seen[i].fold);
            seen[i].start = product(angle, seen[i].start);
            const double size = size_of(seen[i].beyond()), limit = yield_ * corners[i].length;
            seen[i].stiffness = rigidity_ / corners[i].length * (size > limit ? limit / size : 1);
            is_elastic = is_elastic && size <= limit;
        }
        if (is_elastic || is_known) break;
    }
}

std::vector<RopeFolds::Seen> RopeFolds::see(std::span<const RopeCorner> corners, double damping) const {
    std::vector<Seen> seen(corners.size());
    for (std::size_t first = 0, last = 0; first < corners.size(); first = last) {
        for (last = first + 1; last < corners.size() && !corners[last].begins_span;) ++last;
        const auto span = corners.subspan(first, last - first);
        const auto span_seen = std::span(seen).subspan(first, last - first);
        find_axes(span, span_seen);
        find_folds(span, damping, span_seen);
    }
    return seen;
}

void RopeFolds::begin(std::span<const RopeCorner> corners, double damping) {
    damping_ = damping;
    const std::vector<Seen> seen = see(corners, 0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        folds_[corners[i].fold] = {seen[i].fold, seen[i].clamp, seen[i].bend};
}

double RopeFolds::energy(std::span<const RopeCorner> corners) const {
    const std::vector<Seen> seen = see(corners, damping_);
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double size = size_of(seen[i].beyond()), elastic = std::min(size, yield_ * corners[i].length);
        const double grown = size_of(seen[i].grown());
        sum += rigidity_ / corners[i].length * elastic * (size - elastic / 2) + seen[i].damping / 2 * grown * grown;
    }
    return sum;
}

double RopeFolds::elastic_energy(std::span<const RopeCorner> corners) const {
    const std::vector<Seen> seen = see(corners, 0);
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double elastic = std::min(size_of(seen[i].beyond()), yield_ * corners[i].length);
        sum += rigidity_ / corners[i].length / 2 * elastic * elastic;
    }
    return sum;
}

void RopeFolds::keep(std::span<const RopeCorner> corners) {
    const std::vector<Seen> seen = see(corners, damping_);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Part fold = seen[i].fold;
        const Part beyond = seen[i].beyond();
        const double size = size_of(beyond), limit = yield_ * corners[i].length;
        for (std::size_t k = 0; k < 2 && size > limit; ++k) fold[k] += (1 - limit / size) * beyond[k];
        folds_[corners[i].fold] = {fold, seen[i].clamp, seen[i].bend};
    }
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
        folds_[i] = {};
        for (std::size_t k = 0; k < 2 && !states.empty(); ++k)
            folds_[i].part[k] = states[i / by_node][2 * (i % by_node) + k];
    }
}

}  // namespace embody::physics::deformable
