// SPDX-License-Identifier: MIT
// Gusts as value noise: random levels at even times, joined smoothly, in octaves of half the time and half the height
// each. No library functions whose bits differ between compilers.
#include "physics/step/wind.h"

#include <cmath>
#include <cstdint>

#include "foundation/random.h"

namespace embody::physics {

namespace {

constexpr int octaves = 4;
constexpr double across = 0.8, upwards = 0.52;  // of the changes along the wind

// Uniform in -1 … 1: the level of a component at a whole number of gusts.
double level(std::uint64_t component, int octave, std::int64_t index) {
    Random random(static_cast<std::uint64_t>(index) * 64 + component * 16 + static_cast<std::uint64_t>(octave));
    random.next();
    return random.between(-1, 1);
}

// Of root mean square 1: a level has the variance 1/3, and between two of them, mixed by s = 3u² - 2u³, the mean of
// (1-s)² + s² is 26/35.
double noise(std::uint64_t component, double gusts) {
    double sum = 0, variance = 0, height = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        const double at = std::floor(gusts), u = gusts - at, s = u * u * (3 - 2 * u);
        const auto index = static_cast<std::int64_t>(at);
        sum += height * ((1 - s) * level(component, octave, index) + s * level(component, octave, index + 1));
        variance += height * height * 26 / 105;
        height /= 2;
        gusts *= 2;
    }
    return sum / std::sqrt(variance);
}

}  // namespace

bool is_gusty(const WorldSettings& settings) { return settings.gustiness > 0 && length_squared(settings.wind) > 0; }

Vec3 wind_at(const WorldSettings& settings, double time) {
    if (!is_gusty(settings)) return settings.wind;
    const double speed = length(settings.wind), gusts = time / settings.gust_time;
    const Vec3 along = settings.wind / speed;
    // Across and level where the wind is not vertical.
    const Vec3 side = normalized(cross(Vec3{0, 1, 0}, along), {1, 0, 0});
    const Vec3 up = cross(along, side);
    return settings.wind +
           settings.gustiness * speed *
               (noise(0, gusts) * along + across * noise(1, gusts) * side + upwards * noise(2, gusts) * up);
}

}  // namespace embody::physics
