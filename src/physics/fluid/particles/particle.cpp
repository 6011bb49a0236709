// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/particle.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "physics/fluid/grid/four.h"

namespace embody::physics::fluid {

namespace {

/// A reach while it is being found, four numbers at a time: a place followed by the speed, then the rest of the
/// velocity.
struct WideReach {
    Four lower = Four{} + INFINITY, upper = Four{} - INFINITY, zero{};
    float fastest_squared = 0;

    void add(const FluidParticle& particle) {
        static_assert(offsetof(FluidParticle, velocity) == sizeof particle.position);
        const char* numbers = reinterpret_cast<const char*>(&particle);
        const Four first = load_four(numbers), last = load_four(numbers + 2 * sizeof(float));
        lower = first < lower ? first : lower;
        upper = first > upper ? first : upper;
        zero += first * 0 + last * 0;
        fastest_squared = std::max(fastest_squared, last[1] * last[1] + last[2] * last[2] + last[3] * last[3]);
    }
    [[nodiscard]] ParticleReach result() const {
        return {{lower[0], lower[1], lower[2]},
                {upper[0], upper[1], upper[2]},
                fastest_squared,
                zero[0] + zero[1] + zero[2] + zero[3]};
    }
};

}  // namespace

void ParticleReach::add(const ParticleReach& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], other.lower[axis]);
        upper[axis] = std::max(upper[axis], other.upper[axis]);
    }
    fastest_squared = std::max(fastest_squared, other.fastest_squared);
    zero += other.zero;
}

float ParticleReach::farthest() const {
    if (!is_finite()) return INFINITY;
    float most = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        most = std::max({most, std::fabs(lower[axis]), std::fabs(upper[axis])});
    }
    return most;
}

ParticleReach reach_of(std::span<const FluidParticle> particles, TaskPool& workers) {
    std::vector<ParticleReach> found(static_cast<std::size_t>(workers.workers()));
    parallel_for(workers, particles.size(), particles.size() > few_particles, [&](int worker, IndexRange range) {
        WideReach own;
        for (std::size_t i = range.first; i < range.last; ++i) own.add(particles[i]);
        found[static_cast<std::size_t>(worker)] = own.result();
    });
    ParticleReach all;
    for (const ParticleReach& own : found) all.add(own);
    return all;
}

double usual_speed_of(std::span<const FluidParticle> particles, std::size_t particles_per_outlier, TaskPool& workers) {
    // Squares counted by their exponent and the first bits of their mantissa: 2 % of a square, 1 % of a speed.
    // A float has 8 bits of exponent and 23 of mantissa.
    constexpr int kept_bits = 6, dropped_bits = 23 - kept_bits;
    constexpr std::size_t bins = std::size_t{1} << (8 + kept_bits);
    std::vector<std::vector<std::uint32_t>> counts(static_cast<std::size_t>(workers.workers()));
    parallel_for(workers, particles.size(), particles.size() > few_particles, [&](int worker, IndexRange range) {
        std::vector<std::uint32_t>& own = counts[static_cast<std::size_t>(worker)];
        own.assign(bins, 0);
        for (std::size_t i = range.first; i < range.last; ++i) {
            const float* v = particles[i].velocity;
            const float square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            ++own[(std::bit_cast<std::uint32_t>(square) & 0x7FFFFFFF) >> dropped_bits];
        }
    });
    std::size_t left = particles.size() / particles_per_outlier;
    for (std::size_t bin = bins; bin-- > 0;) {
        std::size_t here = 0;
        for (const auto& own : counts) here += own.empty() ? 0 : own[bin];
        if (here > left) {
            constexpr std::size_t infinite = 255 << kept_bits;  // the first bin of the largest exponent
            const auto upper = static_cast<std::uint32_t>(std::min(bin + 1, infinite)) << dropped_bits;
            return std::sqrt(static_cast<double>(std::bit_cast<float>(upper)));
        }
        left -= here;
    }
    return 0;
}

}  // namespace embody::physics::fluid
