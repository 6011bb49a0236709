// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/decomposition/part.h"

namespace embody::geometry {
namespace {

// Concavity of two parts merged: exact, or a lower bound.
struct PairCost {
    double concavity = 0;
    bool is_known = false;
};

class Merging {
public:
    Merging(std::vector<Part>& parts, const DecompositionSearch& search) : parts_(parts), search_(search) {}
    void run(std::size_t max_parts);

private:
    [[nodiscard]] double least_concavity(const Part& a, const Part& b) const;
    [[nodiscard]] Part joined(const Part& a, const Part& b) const;
    void absorb_contained();
    void erase(std::size_t index);

    std::vector<Part>& parts_;
    const DecompositionSearch& search_;
    std::vector<std::vector<PairCost>> costs_;  // of parts i < j at [j][i]
};

// Samples places between corners of one part and corners of the other, all of which their common hull contains.
double Merging::least_concavity(const Part& a, const Part& b) const {
    double deepest = std::max(a.concavity, b.concavity);
    const std::size_t na = a.hull.vertices.size(), nb = b.hull.vertices.size();
    const std::size_t steps = std::min<std::size_t>(24, std::max(na, nb));
    for (std::size_t i = 0; i < steps; ++i) {
        const Vec3 p = a.hull.vertices[i * na / steps], q = b.hull.vertices[(i * 7 + 3) % nb];
        for (const double t : {0.5, 0.25, 0.75}) deepest = std::max(deepest, search_.grid.depth_at(p + t * (q - p)));
    }
    return deepest;
}

Part Merging::joined(const Part& a, const Part& b) const {
    Part part;
    part.points = a.hull.vertices;
    part.points.insert(part.points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
    part.hull = build_search_hull(part.points, search_.tolerance, search_.thickness);
    part.concavity = search_.grid.for_each_deeper(part.hull.box, search_.void_depth,
                                                  [&, most = search_.void_depth](Vec3 center, double depth) mutable {
                                                      if (part.hull.contains(center)) most = depth;
                                                      return most;
                                                  });
    if (part.concavity <= search_.void_depth) part.concavity = 0;
    part.is_final = true;
    return part;
}

void Merging::erase(std::size_t index) {
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(index));
    if (costs_.empty()) return;
    costs_.erase(costs_.begin() + static_cast<std::ptrdiff_t>(index));
    for (std::size_t j = index; j < costs_.size(); ++j) {
        costs_[j].erase(costs_[j].begin() + static_cast<std::ptrdiff_t>(index));
    }
}

// A part inside another part's hull needs no hull of its own.
void Merging::absorb_contained() {
    for (std::size_t j = parts_.size(); j-- > 0;) {
        const Part& small = parts_[j];
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            Part& large = parts_[i];
            if (i == j || large.hull.volume < small.hull.volume) continue;
            if (large.hull.volume == small.hull.volume && i > j) continue;
            if (!contains(enlarged(large.hull.box, search_.tolerance), small.hull.box)) continue;
            const bool inside = std::all_of(small.hull.vertices.begin(), small.hull.vertices.end(),
                                            [&](Vec3 v) { return large.hull.height(v) <= search_.tolerance; });
            if (!inside) continue;
            large.points.insert(large.points.end(), small.hull.vertices.begin(), small.hull.vertices.end());
            erase(j);
            break;
        }
    }
}

void Merging::run(std::size_t max_parts) {
    absorb_contained();
    costs_.resize(parts_.size());
    for (std::size_t j = 0; j < parts_.size(); ++j) {
        for (std::size_t i = 0; i < j; ++i) costs_[j].push_back({least_concavity(parts_[i], parts_[j]), false});
    }
    while (parts_.size() > 1) {
        std::size_t a = 0, b = 1;
        for (std::size_t j = 1; j < parts_.size(); ++j) {
            for (std::size_t i = 0; i < j; ++i) {
                if (costs_[j][i].concavity < costs_[b][a].concavity) a = i, b = j;
            }
        }
        PairCost& cost = costs_[b][a];
        if (cost.concavity > search_.error && parts_.size() <= max_parts) return;
        Part both = joined(parts_[a], parts_[b]);
        if (!cost.is_known) {
            cost = {std::max(both.concavity, cost.concavity), true};
            continue;
        }
        both.concavity = cost.concavity;
        both.points = std::move(parts_[a].points);
        both.points.insert(both.points.end(), parts_[b].points.begin(), parts_[b].points.end());
        parts_[a] = std::move(both);
        erase(b);
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            if (k != a) costs_[std::max(a, k)][std::min(a, k)] = {least_concavity(parts_[a], parts_[k]), false};
        }
    }
}

}  // namespace

void merge_parts(std::vector<Part>& parts, std::size_t max_parts, const DecompositionSearch& search) {
    Merging(parts, search).run(max_parts);
}

}  // namespace embody::geometry
