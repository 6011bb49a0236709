// SPDX-License-Identifier: MIT
// A thread of viscous liquid that falls on a plate winds there, now in circles, now to and fro, at a rate that gravity
// and viscosity set: Ω ~ (g Q³/(ν a⁸))^¼ (M. Habibi, M. Maleki, R. Golestanian, N. M. Ribe, D. Bonn, "Dynamics of
// liquid rope coiling", Phys. Rev. E 74, 2006: gravitational coiling).
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "foundation/random.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

/// A thread of random viscosity, radius, height and speed, five cells across.
struct Thread {
    double density = 1400, viscosity, radius, height, speed, cell;
    double x, z;  ///< of its axis, m

    explicit Thread(std::uint64_t seed) {
        Random random(seed);
        viscosity = 20 * std::pow(5, random.unit());
        radius = random.between(0.004, 0.006);
        height = random.between(8, 14) * radius;
        speed = random.between(0.05, 0.15);
        cell = radius / 2.5;
        x = random.between(-1, 1) * cell;
        z = random.between(-1, 1) * cell;
    }
    [[nodiscard]] double rate() const { return pi * radius * radius * speed; }  // m³/s
    /// rad/s
    [[nodiscard]] double gravitational_frequency() const {
        const double kinematic = viscosity / density, squared = radius * radius;
        return std::pow(9.81 * rate() * rate() * rate() / (kinematic * std::pow(squared, 4)), 0.25);
    }
};

/// How far the thread is from its axis where it comes to the heap, m; not found: no number.
std::complex<double> find_offset(const Thread& thread, const FluidParticles& particles) {
    constexpr std::size_t around = 2;  // layers below and above, over which sums are smooth
    constexpr double heap_area = 1.7;  // of the thread's
    struct Layer {
        double count = 0, x = 0, z = 0;
    };
    std::vector<Layer> layers(static_cast<std::size_t>(thread.height / thread.cell));
    for (const Vec3f p : particles.positions) {
        const Vec3 place = particles.origin + Vec3(p);
        if (place.y < 0 || place.y >= static_cast<double>(layers.size()) * thread.cell) continue;
        Layer& layer = layers[static_cast<std::size_t>(place.y / thread.cell)];
        ++layer.count;
        layer.x += place.x;
        layer.z += place.z;
    }
    const auto near = [&](std::size_t middle) {
        Layer sum;
        for (std::size_t k = middle - around; k <= middle + around; ++k) {
            sum.count += layers[k].count;
            sum.x += layers[k].x;
            sum.z += layers[k].z;
        }
        return sum;
    };
    const double of_thread =
        (2 * around + 1) * pi * thread.radius * thread.radius * thread.cell / particles.particle_volume;
    std::size_t top = layers.size() - 1 - around;
    while (top > around && near(top).count < heap_area * of_thread) --top;
    const Layer above = near(std::min(top + 2, layers.size() - 1 - around));
    return {above.x / above.count - thread.x, above.z / above.count - thread.z};
}

/// Of the strongest oscillation, in either sense, from 0.4 to 10 Hz: rad/s.
double strongest_frequency(const std::vector<std::complex<double>>& offsets, double interval) {
    const auto count = static_cast<double>(offsets.size());
    std::complex<double> mean;
    for (const auto offset : offsets) mean += offset / count;
    double strongest = 0, found = 0;
    for (double frequency = 0.4; frequency < 10; frequency += 0.1) {
        for (const double sense : {-1.0, 1.0}) {
            std::complex<double> sum;
            for (std::size_t k = 0; k < offsets.size(); ++k) {
                const double turns = static_cast<double>(k) / (count - 1);
                const double window = 0.5 - 0.5 * std::cos(2 * pi * turns);
                sum += window * (offsets[k] - mean) *
                       std::polar(1.0, -sense * 2 * pi * frequency * interval * static_cast<double>(k));
            }
            if (std::norm(sum) <= strongest) continue;
            strongest = std::norm(sum);
            found = 2 * pi * frequency;
        }
    }
    return found;
}

class FluidCoiling : public testing::TestWithParam<unsigned> {};

// Fourteen threads of 1.0 to 3.7 Hz have 0.35 to 0.71 of that rate.
TEST_P(FluidCoiling, ThreadsWindAtTheRateOfGravityAndViscosity) {
    const Thread thread(GetParam());
    auto world = make_world({});
    ASSERT_TRUE(
        world->create_body({.kind = BodyKind::static_body, .shape = world->create_shape(PlaneShape{}).value()}));
    const FluidHandle honey = world
                                  ->create_fluid({.boxes = {{{-0.06, 0, -0.06}, {0.06, thread.height, 0.06}}},
                                                  .density = thread.density,
                                                  .viscosity = thread.viscosity,
                                                  .cell_size = thread.cell,
                                                  .allow_sleep = false,
                                                  .starts_empty = true})
                                  .value();
    ASSERT_TRUE(world->create_fluid_port(FluidSource{.fluid = honey,
                                                     .position = {thread.x, thread.height, thread.z},
                                                     .radius = thread.radius,
                                                     .rate = thread.rate(),
                                                     .speed = thread.speed}));
    run(*world, 1);
    std::vector<std::complex<double>> offsets;
    double mean = 0;
    for (int step = 0; step < 180; ++step) {
        world->step();
        const std::complex<double> offset = find_offset(thread, world->fluid_particles(honey));
        if (!std::isfinite(offset.real())) continue;
        offsets.push_back(offset);
        mean += std::abs(offset) / thread.radius;
    }
    ASSERT_GT(offsets.size(), 170u);
    mean /= static_cast<double>(offsets.size());
    const double ratio = strongest_frequency(offsets, 1.0 / 60) / thread.gravitational_frequency();
    RecordProperty("rate_ratio", std::to_string(ratio));
    RecordProperty("offset_in_radii", std::to_string(mean));
    EXPECT_GT(ratio, 0.3);
    EXPECT_LT(ratio, 0.8);
    EXPECT_GT(mean, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Random, FluidCoiling, testing::Values(1, 3, 10));

}  // namespace
}  // namespace embody::physics
