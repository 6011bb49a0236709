// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/mixture.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace embody::physics::fluid {

std::uint16_t Mixture::liquid_of(std::uint32_t id) const { return std::prev(first_ids_.upper_bound(id))->second; }

void Mixture::assign(FluidIds ids, FluidProperties liquid) {
    if (ids.first >= ids.last) return;
    liquid.particle_volume = first().particle_volume;
    auto known = std::ranges::find(liquids_, liquid);
    if (known == liquids_.end()) known = liquids_.insert(known, liquid);
    const auto index = static_cast<std::uint16_t>(known - liquids_.begin());
    // The ids after the last one keep their liquid.
    const std::uint16_t after = liquid_of(ids.last);
    first_ids_.erase(first_ids_.lower_bound(ids.first), first_ids_.upper_bound(ids.last));
    // A run that goes on stays one.
    if (ids.first == 0 || liquid_of(ids.first) != index) first_ids_[ids.first] = index;
    if (after != index) first_ids_[ids.last] = after;
}

void Mixture::keep_liquids_of(const std::vector<FluidParticle>& particles) {
    if (is_one() || particles.empty()) return;
    std::vector<bool> is_used(liquids_.size(), false);
    for (const FluidParticle& particle : particles) is_used[liquid_of(particle.id)] = true;
    std::vector<std::uint16_t> index(liquids_.size(), 0);
    std::vector<FluidProperties> kept;
    for (std::size_t i = 0; i < liquids_.size(); ++i) {
        if (!is_used[i]) continue;
        index[i] = static_cast<std::uint16_t>(kept.size());
        kept.push_back(liquids_[i]);
    }
    liquids_ = std::move(kept);
    for (auto& [first, liquid] : first_ids_) liquid = index[liquid];
}

Mixture::Around Mixture::around(const FluidGrid& grid, const float* place) const {
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) c[axis] = static_cast<int>(grid.in_cells(place[axis], axis));
    const auto of = [&](double FluidProperties::*property) {
        return mean(grid, grid.index(c), [property](const FluidProperties& liquid) { return liquid.*property; });
    };
    return {of(&FluidProperties::density), of(&FluidProperties::viscosity)};
}

bool Mixture::is_top_heavy(const FluidGrid& grid, Vec3 gravity) const {
    if (is_one()) return false;
    const auto density_at = [&](int cell) {
        return mean(grid, cell, [](const FluidProperties& liquid) { return liquid.density; });
    };
    constexpr double drops = 0.05;  // of the falls: what drops that settle still add to the rises
    double rises = 0, falls = 0;
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            double down = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int other = cell - grid.stride(axis);
                if (grid.row[cell] < 0 || grid.row[other] < 0 || grid.open[axis][cell] <= 0) continue;
                down += gravity[axis] * (density_at(cell) - density_at(other));
            }
            (down > 0 ? falls : rises) += std::fabs(down);
        });
    }
    return rises > drops * falls;
}

std::vector<Mixture::Run> Mixture::runs(FluidIds ids) const {
    std::vector<Run> runs;
    for (std::uint32_t id = ids.first; id < ids.last;) {
        const auto next = first_ids_.upper_bound(id);
        const std::uint32_t last = next == first_ids_.end() ? ids.last : std::min(ids.last, next->first);
        runs.push_back({{id, last}, std::prev(next)->second});
        id = last;
    }
    return runs;
}

void Mixture::identify(const std::vector<FluidParticle>& particles, TaskPool& workers) {
    of_particle_.resize(is_one() ? 0 : particles.size());
    parallel_for(workers, of_particle_.size(), of_particle_.size() > few_particles, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) of_particle_[i] = liquid_of(particles[i].id);
    });
}

}  // namespace embody::physics::fluid
