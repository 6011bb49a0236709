// SPDX-License-Identifier: MIT
// Sliding and rolling friction that determine the slope of a pile of balls: measured on poured piles,
// docs/physics/grains.md.
#include "physics/definitions/grain_material.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace embody::physics {

namespace {

// Lever arm of the friction that stops a ball that spins on the spot, in diameters. Without any, single grains spin for
// ever and the pile never sleeps: docs/physics/grains.md, "The law".
constexpr double torsion = 0.1;
// Lever arms of a material, m: rolling and torsional friction may not have longer ones (material.cpp).
constexpr double max_rolling = 0.05, max_torsion = 0.1;

/// Slope (degrees) measured for a sliding friction and a rolling resistance (in diameters).
struct Heap {
    double angle, sliding, rolling;
};
// Source: docs/physics/grains.md, "How the slope is measured"; the last stands for all that is steeper.
constexpr std::array<Heap, 15> heaps = {{{6.5, 0.1, 0.005},
                                         {12.1, 0.2, 0.005},
                                         {16.5, 0.3, 0.005},
                                         {19.6, 0.4, 0.005},
                                         {25.5, 0.6, 0.006},
                                         {28.7, 0.6, 0.012},
                                         {31.9, 0.6, 0.02},
                                         {34.9, 0.6, 0.035},
                                         {38.0, 0.6, 0.05},
                                         {41.1, 0.6, 0.07},
                                         {44.4, 0.6, 0.1},
                                         {48.9, 0.6, 0.14},
                                         {52.2, 0.6, 0.2},
                                         {54.2, 0.6, 0.3},
                                         {90.0, 0.6, 0.3}}};

// Linear interpolation between the measured piles.
Heap heap_of(double angle) {
    const auto above = std::ranges::find_if(heaps, [angle](const Heap& heap) { return heap.angle >= angle; });
    if (above == heaps.begin()) return heaps.front();
    const Heap &a = *std::prev(above), &b = *above;
    const double fraction = (angle - a.angle) / (b.angle - a.angle);
    return {angle, a.sliding + fraction * (b.sliding - a.sliding), a.rolling + fraction * (b.rolling - a.rolling)};
}

}  // namespace

Material grain_material(double friction_angle, double diameter) {
    const Heap heap = heap_of(std::clamp(friction_angle, 0.0, heaps.back().angle));
    Material material;
    material.friction_static = material.friction_dynamic = heap.sliding;
    material.friction_rolling = std::min(max_rolling, heap.rolling * diameter);
    // A single grain rolls on a slope of more than 2 c / d: on what is no grain none rolls before it would slide. Else
    // the lowest layer on a smooth plank carries all others away like rollers.
    material.friction_rolling_on_others = std::min(max_rolling, heap.sliding * diameter / 2);
    material.friction_torsional = std::min(max_torsion, torsion * diameter);
    return material;
}

int substeps_for_grains(double diameter, const WorldSettings& settings) {
    // Length of a substep over the time in which a grain falls its own diameter; large islands are solved in twice as
    // many substeps as the settings say.
    constexpr double min_gravity = 0.1;  // m/s²: only not zero
    const GrainSettings& grains = settings.solver.fluid.grains;
    const double gravity = std::max(length(settings.gravity), min_gravity);
    const double parts = settings.time_step * std::sqrt(gravity / diameter) / (2 * grains.max_part);
    return std::max(settings.substeps, std::min(grains.max_substeps, static_cast<int>(std::ceil(parts))));
}

}  // namespace embody::physics
