// SPDX-License-Identifier: MIT
#include "scene/matter/liquid_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

#include "scene/embody/filled_region.h"

namespace embody::scene {

namespace {

using Place = std::array<std::int64_t, 3>;

// Cells of that edge length that contain points, without duplicates, sorted.
std::vector<Place> cells_of(const std::vector<Vec3>& points, double edge) {
    std::vector<Place> cells;
    cells.reserve(points.size());
    for (const Vec3 p : points) {
        cells.push_back({static_cast<std::int64_t>(std::floor(p.x / edge)),
                         static_cast<std::int64_t>(std::floor(p.y / edge)),
                         static_cast<std::int64_t>(std::floor(p.z / edge))});
    }
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

std::string in_millimetres(double length) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g mm", 1000 * length);
    return text;
}

// Why the cells are not those that were told by hand: the budget of particles, or other liquid.
std::string note_of_cells(const LiquidDefinition& liquid, const FluidBody& body) {
    if (!(liquid.set_cell_size > 0) || !liquid.places.empty()) return {};
    const double particles = body.mass() / liquid.matter.density * 8 / std::pow(liquid.set_cell_size, 3);
    const bool are_too_many = particles > static_cast<double>(liquid.particle_budget);
    const std::string cells =
        "has cells of " + in_millimetres(body.cell_size()) + " and not of " + in_millimetres(liquid.set_cell_size);
    const std::string budget = "particle_budget is " + std::to_string(liquid.particle_budget) + " and it would take " +
                               std::to_string(std::llround(particles)) + " particles";
    if (body.join() == FluidBody::Join::joined && body.cell_size() > FluidBody::max_cell_ratio * liquid.set_cell_size)
        return cells + ": it is one with other liquid, which has these";
    const bool is_coarser = body.cell_size() > liquid.set_cell_size;
    if (body.join() == FluidBody::Join::joined || !are_too_many || !is_coarser) return {};
    if (body.join() == FluidBody::Join::apart) return cells + ", so that it does not see other liquid: " + budget;
    return cells + ": " + budget;
}

}  // namespace

std::string note_of(const LiquidDefinition& liquid, const FluidBody& body) {
    const Result<FilledRegion> region = FilledRegion::of(liquid.shape);
    if (!region.ok()) return {};
    const Vec3 size = region.value().bounds().size();
    const double thickness = std::min({size.x, size.y, size.z});
    const double edge = std::cbrt(4 * std::numbers::pi / 3) * body.radius();
    if (thickness > edge / 2) return note_of_cells(liquid, body);
    return "is " + in_millimetres(thickness) + " thick, which its particles of " + in_millimetres(edge) +
           " cannot show: it moves as single drops, and those that run too far away are taken out (raise "
           "particle_budget, or make "
           "it thicker)";
}

bool are_overlapping(const MovingPoints& a, const MovingPoints& b) {
    constexpr double cells_of_radius = 4, common_fraction = 0.05;
    const double edge = cells_of_radius * std::max(a.radius(), b.radius());
    if (!(edge > 0) || !overlaps(a.bounds(), b.bounds())) return false;
    std::vector<Vec3> points;
    a.read(points);
    const std::vector<Place> of_a = cells_of(points, edge);
    b.read(points);
    const std::vector<Place> of_b = cells_of(points, edge);
    std::vector<Place> common;
    std::ranges::set_intersection(of_a, of_b, std::back_inserter(common));
    const std::size_t fewer = std::min(of_a.size(), of_b.size());
    return static_cast<double>(common.size()) > common_fraction * static_cast<double>(fewer);
}

}  // namespace embody::scene
