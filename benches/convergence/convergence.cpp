// SPDX-License-Identifier: MIT
#include "benches/convergence/convergence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "benches/convergence/elastic_studies.h"
#include "benches/convergence/liquid_studies.h"

namespace embody::convergence {

namespace {

constexpr double g = 9.81, pi = 3.14159265358979323846;

// w L⁴/8EI + w L²/(2 · 5/6 · G A), w = ρ g A (Timoshenko).
constexpr double beam_tip() {
    constexpr double area = beam_side * beam_side, second_moment = area * area / 12, length = beam_length;
    constexpr double load = beam_density * g * area;
    constexpr double shear_modulus = beam_youngs_modulus / (2 * (1 + beam_poisson_ratio));
    return load * length * length * length * length / (8 * beam_youngs_modulus * second_moment) +
           load * length * length / (2 * 5.0 / 6 * shear_modulus * area);
}

// f = 1.8751²/2π √(EI/(ρ A L⁴)).
double beam_frequency() {
    return 1.8751040687 * 1.8751040687 / (2 * pi) *
           std::sqrt(beam_youngs_modulus * beam_side * beam_side / 12 / beam_density) / (beam_length * beam_length);
}

// w L⁴/8B, B per width; the same for a rod.
constexpr double hanging_end(double density, double length, double rigidity) {
    return density * g * length * length * length * length / (8 * rigidity);
}

// c (cosh x - 1) with sinh x / x = S/D and c = D/2x: a rope of length S over the span D.
double catenary_sag() {
    double low = 1e-6, high = 10;
    for (int i = 0; i < 100; ++i) {
        const double x = (low + high) / 2;
        (std::sinh(x) / x > catenary_length / catenary_span ? high : low) = x;
    }
    return catenary_span / (2 * low) * (std::cosh(low) - 1);
}

// T = 2π/ω, ω = j₀/2 √(g/L), j₀ the first zero of J₀ (Bernoulli's hanging chain).
double chain_period() { return 2 * pi / (2.404825557695773 / 2 * std::sqrt(g / hanging_length)); }

// ω² = g k tanh(k d), k = π/L: the slowest wave of small height (Lamb, Hydrodynamics, § 228).
double sloshing_period() {
    const double k = pi / tank_length;
    return 2 * pi / std::sqrt(g * k * std::tanh(k * tank_depth));
}

constexpr std::array beam_cells{1, 2, 3, 4, 6}, rates{60, 120, 240, 480, 960};
constexpr std::array pieces{2, 4, 8, 16, 32}, segments{4, 8, 16, 32, 64};
constexpr std::array sloshing_cells{15, 20, 40, 80, 120}, draft_cells{10, 15, 20, 30, 40};

}  // namespace

std::span<const Study> studies() {
    static const std::array all{
        Study{"beam_tip", "fall of a soft beam's tip, m", "cells across", "wL^4/8EI + wL^2/(2 5/6 GA)", beam_tip(),
              beam_cells, tip_of_beam},
        Study{"beam_frequency", "first frequency of the beam, Hz", "steps a second",
              "1.8751^2/2pi sqrt(EI/(rho A L^4))", beam_frequency(), rates, frequency_of_beam},
        Study{"strip_tip", "fall of the end of a strip of cloth, m", "triangles along", "wL^4/8B",
              hanging_end(strip_area_density, strip_length, strip_bend_stiffness), pieces, tip_of_strip},
        Study{"rod_tip", "fall of the end of a rope held as a rod, m", "segments", "wL^4/8EI",
              hanging_end(rod_linear_density, rod_length, rod_rigidity), segments, tip_of_rod},
        Study{"catenary_sag", "sag of a hanging rope, m", "segments", "c (cosh x - 1)", catenary_sag(), segments,
              sag_of_rope},
        Study{"rope_period", "slowest period of a hanging rope, s", "steps a second", "2 pi/(j0/2 sqrt(g/L))",
              chain_period(), rates, period_of_rope},
        Study{"sloshing_period", "slowest period of water in a tank, s", "cells along", "2 pi/sqrt(g k tanh(k d))",
              sloshing_period(), sloshing_cells, period_of_sloshing},
        Study{"slab_draft", "depth of a floating slab, m", "cells along the tank", "height times ratio of densities",
              slab_height * slab_density / water_density, draft_cells, draft_of_slab},
    };
    return all;
}

const Study* find_study(std::string_view name) {
    const auto found = std::ranges::find(studies(), name, &Study::name);
    return found == studies().end() ? nullptr : &*found;
}

}  // namespace embody::convergence
