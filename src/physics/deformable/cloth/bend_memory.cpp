// SPDX-License-Identifier: MIT
//
// Friction as in P. R. Dahl, "A solid friction model" (1968), for curvatures: with B and κ_f the friction's curvature
// and s its first stiffness, both over the bend stiffness, dφ = s (dκ - |dκ| φ / κ_f). Along a straight way of length l
// in the direction m that is φ = κ_f m + (φ₀ - κ_f m) exp(-s l / κ_f): never more than κ_f, in any step. Of the energy
// |φ|²/2s that it holds, |dκ| |φ|²/κ_f is lost.
#include "physics/deformable/cloth/bend_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace embody::physics::deformable {

namespace {

constexpr double max_curvature = 1e6;  // 1/m, of a fold that is put in

Vec3 shortened(Vec3 v, double longest) {
    const double size = length(v);
    return size > longest ? longest / size * v : v;
}

std::array<double, 6> numbers_of(Vec3 a, Vec3 b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

}  // namespace

BendMemory::BendMemory(BendElements elements, std::size_t nodes, double friction, double yield)
    : elements_(std::move(elements)), friction_(friction), yield_(yield) {
    if (!is_active()) {
        elements_ = {};
        return;
    }
    kept_.resize(elements_.triangles.size());
    sides_.assign(elements_.hinges.size(), {});
    std::vector<std::uint8_t> known(elements_.hinges.size(), 0);
    for (std::uint32_t t = 0; t < elements_.triangles.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t hinge = elements_.triangles[t].hinge[k];
            if (hinge != BendTriangle::no_hinge && known[hinge] < 2) sides_[hinge][known[hinge]++] = 3 * t + k;
        }
    }
    std::vector<std::vector<OfNode>> of_node(nodes);
    for (std::uint32_t h = 0; h < elements_.hinges.size(); ++h) {
        for (std::size_t k = 0; k < 4; ++k)
            of_node[elements_.hinges[h].node[k]].push_back({h, elements_.hinges[h].weight[k]});
    }
    first_.push_back(0);
    for (const auto& hinges : of_node) {
        of_node_.insert(of_node_.end(), hinges.begin(), hinges.end());
        first_.push_back(static_cast<std::uint32_t>(of_node_.size()));
    }
}

// Folds at the hinges, m, with the nodes at position + moves.
void BendMemory::find_folds(std::span<const Vec3> position, std::span<const Vec3> moves, std::vector<Vec3>& folds,
                            TaskPool& workers) const {
    folds.resize(elements_.hinges.size());
    parallel_for(workers, folds.size(), folds.size() >= 1000, [&](int, IndexRange range) {
        for (std::size_t h = range.first; h < range.last; ++h) {
            const auto& [node, weight] = elements_.hinges[h];
            Vec3 fold;
            for (std::size_t k = 0; k < 4; ++k) {
                const Vec3 x = moves.empty() ? position[node[k]] : position[node[k]] + moves[node[k]];
                fold += weight[k] * x;
            }
            folds[h] = fold;
        }
    });
}

Vec3 BendMemory::curvature(const BendTriangle& triangle, std::span<const Vec3> folds, Vec3 normal) {
    Vec3 sum;
    for (std::size_t k = 0; k < 3; ++k) {
        if (triangle.hinge[k] != BendTriangle::no_hinge)
            sum += dot(folds[triangle.hinge[k]], normal) * triangle.part[k];
    }
    return sum / (2 * triangle.area);
}

BendMemory::Kept BendMemory::after(const Kept& before, Vec3 from, Vec3 to, double stiffness) const {
    Kept kept = before;
    const double change = length(to - from);
    if (friction_ > 0 && change > 0) {
        const Vec3 full = friction_ / change * (to - from);
        kept.friction = full + std::exp(-stiffness * change / friction_) * (before.friction - full);
    }
    kept.fold = to - shortened(to - before.fold, yield_);
    return kept;
}

void BendMemory::foresee(std::span<const Vec3> position, std::span<const Vec3> moves,
                         std::span<const std::array<Vec3, 2>> normals, double stiffness, TaskPool& workers) {
    find_folds(position, {}, folds_, workers);
    find_folds(position, moves, moved_folds_, workers);
    start_.resize(kept_.size());
    pull_.resize(kept_.size());
    parallel_for(workers, kept_.size(), kept_.size() >= 1000, [&](int, IndexRange range) {
        for (std::size_t t = range.first; t < range.last; ++t) {
            const BendTriangle& triangle = elements_.triangles[t];
            start_[t] = curvature(triangle, folds_, normals[t][0]);
            const Kept kept = after(kept_[t], start_[t], curvature(triangle, moved_folds_, normals[t][1]), stiffness);
            for (std::size_t k = 0; k < 3; ++k)
                pull_[t][k] = dot(triangle.part[k], kept.friction - kept.fold) / 2 * normals[t][1];
        }
    });
}

Vec3 BendMemory::force_on(std::size_t node) const {
    Vec3 force;
    for (std::uint32_t i = first_[node]; i < first_[node + 1]; ++i) {
        for (const std::uint32_t side : sides_[of_node_[i].hinge])
            force -= of_node_[i].weight * pull_[side / 3][side % 3];
    }
    return force;
}

void BendMemory::keep(std::span<const Vec3> position, std::span<const Vec3> normals, double stiffness,
                      TaskPool& workers) {
    find_folds(position, {}, folds_, workers);
    for (std::size_t t = 0; t < kept_.size(); ++t)
        kept_[t] = after(kept_[t], start_[t], curvature(elements_.triangles[t], folds_, normals[t]), stiffness);
}

double BendMemory::energy(std::span<const Vec3> position, std::span<const Vec3> normals, double stiffness) const {
    double sum = 0;
    for (std::size_t t = 0; t < kept_.size(); ++t) {
        const auto& [friction, stays] = kept_[t];
        const Vec3 curvature = curvature_at(t, position, normals[t]);
        sum += elements_.triangles[t].area *
               (dot(friction, friction) / (2 * stiffness) + dot(stays, stays / 2 - curvature));
    }
    return sum;
}

Vec3 BendMemory::curvature_at(std::size_t t, std::span<const Vec3> position, Vec3 normal) const {
    const BendTriangle& triangle = elements_.triangles[t];
    Vec3 curvature;
    for (std::size_t k = 0; k < 3; ++k) {
        if (triangle.hinge[k] == BendTriangle::no_hinge) continue;
        const auto& [node, weight] = elements_.hinges[triangle.hinge[k]];
        for (std::size_t i = 0; i < 4; ++i)
            curvature += weight[i] * dot(position[node[i]], normal) / (2 * triangle.area) * triangle.part[k];
    }
    return curvature;
}

void BendMemory::go_on_from(const BendMemory& whole, std::span<const Vec3> position,
                            std::span<const Vec3> whole_position, std::span<const Vec3> normals) {
    if (!is_active() || whole.kept_.size() != kept_.size()) return;
    set_state(whole.state());
    for (std::size_t t = 0; t < kept_.size(); ++t) {
        if (kept_[t].fold != Vec3{})
            kept_[t].fold += curvature_at(t, position, normals[t]) - whole.curvature_at(t, whole_position, normals[t]);
    }
}

std::vector<std::array<double, 6>> BendMemory::state() const {
    const auto is_flat = [](const Kept& kept) { return kept.friction == Vec3{} && kept.fold == Vec3{}; };
    std::vector<std::array<double, 6>> states;
    if (std::ranges::all_of(kept_, is_flat)) return states;
    for (const Kept& kept : kept_) states.push_back(numbers_of(kept.friction, kept.fold));
    return states;
}

void BendMemory::set_state(std::span<const std::array<double, 6>> states) {
    for (std::size_t t = 0; t < kept_.size(); ++t) {
        const std::array<double, 6> s = states.empty() ? std::array<double, 6>{} : states[t];
        kept_[t] = {shortened({s[0], s[1], s[2]}, friction_), shortened({s[3], s[4], s[5]}, max_curvature)};
    }
}

}  // namespace embody::physics::deformable
