// SPDX-License-Identifier: MIT
// Size of pieces: D. E. Grady, "Local inertial effects in dynamic fragmentation", J. Appl. Phys. 53, 1982. What breaks
// small pieces: H. Rumpf, "Physical aspects of comminution and new formulation of a law of comminution", Powder
// Technology 7, 1973.
#include "physics/fracture/fracture_rule.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::fracture {

std::optional<double> excess_of(const Blow& blow, const Brittleness& brittleness) {
    std::optional<double> excess;
    if (blow.impulse > brittleness.break_impulse) excess = 1 - brittleness.break_impulse / blow.impulse;
    // A blow that has given the fraction s of its impulse has given 1 - (1 - s)² of its energy.
    if (blow.energy > brittleness.break_energy)
        excess = std::max(excess.value_or(0), std::sqrt(1 - brittleness.break_energy / blow.energy));
    return excess;
}

int piece_count(const BrokenSolid& solid, double blow_energy, const Brittleness& brittleness) {
    // Grady: s³ = 24 G / (ρ ε'²). The solid of length L is strained at the rate ε' = u / L by the speed u = √(2 E / m),
    // so that ρ drops out: s³ = 12 G V L² / E.
    const double length = std::max({solid.size.x, solid.size.y, solid.size.z});
    const double size = std::cbrt(12 * brittleness.fracture_energy * solid.volume * length * length / blow_energy);
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) count *= std::max(1.0, solid.size[axis] / size);
    return static_cast<int>(std::clamp(std::round(count), 2.0, static_cast<double>(brittleness.max_pieces)));
}

std::optional<Brittleness> brittleness_of_piece(const Brittleness& whole, double fraction) {
    Brittleness piece = whole;
    piece.max_pieces = static_cast<int>(std::floor(whole.max_pieces * fraction));
    if (piece.max_pieces < 2) return std::nullopt;
    // Rumpf: the energy by mass that breaks similar solids is as 1 / their size, so the energy is as size², and the
    // impulse, m √(2 E / m), as size^2.5.
    piece.break_energy = whole.break_energy * std::cbrt(fraction * fraction);
    piece.break_impulse = whole.break_impulse * std::pow(fraction, 2.5 / 3);
    return piece;
}

}  // namespace embody::physics::fracture
