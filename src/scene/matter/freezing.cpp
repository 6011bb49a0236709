// SPDX-License-Identifier: MIT
#include "scene/matter/freezing.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/convex_hull.h"

namespace embody::scene {

namespace {

using Cell = std::array<std::int64_t, 3>;
using Indices = std::vector<std::size_t>;

Cell cell_of(Vec3 place, double edge) {
    return {static_cast<std::int64_t>(std::floor(place.x / edge)),
            static_cast<std::int64_t>(std::floor(place.y / edge)),
            static_cast<std::int64_t>(std::floor(place.z / edge))};
}

// Calls `visit` with each cell that touches this one, and with itself.
void for_neighbours(const Cell& cell, auto&& visit) {
    for (std::int64_t z = -1; z <= 1; ++z)
        for (std::int64_t y = -1; y <= 1; ++y)
            for (std::int64_t x = -1; x <= 1; ++x) visit(Cell{cell[0] + x, cell[1] + y, cell[2] + z});
}

// Drops within a cell's edge of each other are of one component; at rest neighbours are half of it apart.
std::vector<Indices> components_of(std::span<const Vec3> places, double cell_size) {
    std::map<Cell, Indices> open;  // drops that are in no component yet
    for (std::size_t i = 0; i < places.size(); ++i) open[cell_of(places[i], cell_size)].push_back(i);
    std::vector<bool> is_taken(places.size(), false);
    std::vector<Indices> components;
    for (std::size_t first = 0; first < places.size(); ++first) {
        if (is_taken[first]) continue;
        Indices component{first};
        is_taken[first] = true;
        for (std::size_t at = 0; at < component.size(); ++at) {
            const Vec3 place = places[component[at]];
            for_neighbours(cell_of(place, cell_size), [&](const Cell& cell) {
                const auto found = open.find(cell);
                if (found == open.end()) return;
                std::erase_if(found->second, [&](std::size_t i) {
                    if (is_taken[i]) return true;
                    if (distance(places[i], place) > cell_size) return false;
                    component.push_back(i);
                    is_taken[i] = true;
                    return true;
                });
            });
        }
        components.push_back(std::move(component));
    }
    return components;
}

// The hull of the drops of a block of two cells a side and of those within half a cell of it, so that hulls overlap: no
// hull reaches farther out than drops do. Where they span no volume, each drop is a ball that reaches as far as a film
// of drops is thick to both sides.
physics::CompoundShape shape_of(std::span<const Vec3> places, double cell_size) {
    const double edge = 2 * cell_size, overlap = cell_size / 2;
    std::map<Cell, std::pair<Indices, std::vector<Vec3>>> blocks;  // its drops, and places of these and those near it
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Cell own = cell_of(places[i], edge);
        blocks[own].first.push_back(i);
        for_neighbours(own, [&](const Cell& block) {
            for (int axis = 0; axis < 3; ++axis) {
                const double lower = edge * static_cast<double>(block[axis]);
                if (places[i][axis] < lower - overlap || places[i][axis] > lower + edge + overlap) return;
            }
            blocks[block].second.push_back(places[i]);
        });
    }
    physics::CompoundShape shape;
    for (const auto& [block, drops] : blocks) {
        const auto& [own, near] = drops;
        if (own.empty()) continue;
        if (geometry::build_convex_hull(near).ok()) {
            shape.children.push_back({physics::HullShape{near}, {}});
            continue;
        }
        for (const std::size_t i : own)
            shape.children.push_back({physics::SphereShape{cell_size / 4}, {places[i], {}}});
    }
    return shape;
}

}  // namespace

std::vector<FrozenPiece> freeze(std::span<const Vec3> places, std::span<const Vec3> velocities, double drop_mass,
                                double cell_size) {
    // Of a ball of a drop's volume, so that a single drop can turn too.
    const double radius = cell_size / 2 * std::cbrt(3 / (4 * std::numbers::pi));
    std::vector<FrozenPiece> pieces;
    for (const Indices& component : components_of(places, cell_size)) {
        std::vector<Vec3> own, moving;
        for (const std::size_t i : component) {
            own.push_back(places[i]);
            moving.push_back(velocities[i]);
        }
        FrozenPiece piece;
        piece.momenta = momenta_of(own, moving, drop_mass);
        piece.inertia =
            moments_of(own, drop_mass).inertia + 0.4 * radius * radius * piece.momenta.mass * Mat3::identity();
        piece.linear_velocity = piece.momenta.linear / piece.momenta.mass;
        piece.angular_velocity = solve(piece.inertia, piece.momenta.angular);
        for (Vec3& place : own) place -= piece.momenta.center;
        piece.shape = shape_of(own, cell_size);
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

}  // namespace embody::scene
