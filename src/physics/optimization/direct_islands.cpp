// SPDX-License-Identifier: MIT
#include "physics/optimization/direct_islands.h"

#include <algorithm>
#include <span>
#include <vector>

#include "physics/constraint/direct/direct_contact_solver.h"

namespace embody::physics::optimization {

namespace {

/// Bodies of a level, and the extremes of their masses.
struct Level {
    std::size_t bodies = 0;
    double min_inverse_mass = 1e300, largest_inverse_mass = 0, mass = 0;
};
using Levels = std::span<const Level>;

// Levels from the ground up; bodies without a connection to the ground come last. Valid until the next call.
Levels count_levels(const Island& island, const Islands& islands, std::span<const BodyState> bodies) {
    thread_local std::vector<Level> levels;
    levels.assign(island.deepest_level + 3, {});
    for (std::uint32_t k = 0; k < island.body_count; ++k) {
        const std::uint32_t body = islands.bodies[island.first_body + k];
        Level& level = levels[std::min<std::size_t>(islands.level[body], island.deepest_level + 1)];
        ++level.bodies;
        level.min_inverse_mass = std::min(level.min_inverse_mass, bodies[body].inverse_mass);
        level.largest_inverse_mass = std::max(level.largest_inverse_mass, bodies[body].inverse_mass);
        level.mass += 1 / bodies[body].inverse_mass;
    }
    return levels;
}

// An upper bound of the block products that elimination level by level needs.
std::size_t block_products(Levels levels) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
        const std::size_t here = levels[i].bodies, both = here + levels[i + 1].bodies;
        sum += here * both * both;
    }
    return sum;
}

// The largest ratio of a body's mass to that of a body below it.
double mass_ratio(Levels levels) {
    double ratio = 1, min_inverse_above = 1e300;
    for (std::size_t i = levels.size(); i-- > 0;) {
        const Level& level = levels[i];
        if (level.bodies == 0) continue;
        ratio = std::max(ratio, level.largest_inverse_mass / min_inverse_above);
        min_inverse_above = std::min(min_inverse_above, level.min_inverse_mass);
    }
    return ratio;
}

// The largest ratio of the mass of all levels above a body to the body's own mass.
double load_ratio(Levels levels) {
    double ratio = 0, above = 0;
    for (std::size_t i = levels.size(); i-- > 0;) {
        const Level& level = levels[i];
        if (level.bodies == 0) continue;
        ratio = std::max(ratio, above * level.largest_inverse_mass);
        above += level.mass;
    }
    return ratio;
}

// Whether movable bodies touch each other like the branches of a tree: eliminated from the leaves inwards, a tree has
// no fill-in. A box with balls on it is a tree, whatever the number of balls.
bool is_tree(const Island& island, const Islands& islands, std::span<const Contact> contacts,
             std::span<const BodyState> bodies) {
    std::uint32_t links = 0;
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = contacts[islands.contacts[island.first_contact + k]];
        if (bodies[contact.a].inverse_mass > 0 && bodies[contact.b].inverse_mass > 0) ++links;
    }
    return links < island.body_count;
}

bool is_moving_kinematic(const BodyState& body) {
    return body.inverse_mass == 0 && (body.linear_velocity != Vec3{} || body.angular_velocity != Vec3{});
}

}  // namespace

DirectUse direct_use_of(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                        std::span<const BodyState> bodies, const OptimizationSettings& settings) {
    if (island.joint_count > 0 || island.contact_count == 0) return DirectUse::never;
    if (island.body_count > DirectContactSolver::max_bodies) return DirectUse::never;
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = contacts[islands.contacts[island.first_contact + k]];
        if (is_moving_kinematic(bodies[contact.a]) || is_moving_kinematic(bodies[contact.b])) return DirectUse::never;
    }
    const Levels levels = count_levels(island, islands, bodies);
    const std::size_t products = block_products(levels);
    const bool is_heavy_on_light = mass_ratio(levels) > settings.direct_min_mass_ratio;
    const bool is_high = island.deepest_level >= settings.direct_min_levels;
    if (load_ratio(levels) > settings.direct_min_load_ratio && is_tree(island, islands, contacts, bodies))
        return DirectUse::always;
    if (is_heavy_on_light && products <= settings.direct_max_products_heavy) return DirectUse::always;
    if (is_high && products <= settings.direct_max_products_high) return DirectUse::always;
    return DirectUse::while_slow;
}

}  // namespace embody::physics::optimization
