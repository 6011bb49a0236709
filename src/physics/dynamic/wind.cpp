// SPDX-License-Identifier: MIT
// Gusts as value noise: random levels at the corners of a lattice, joined smoothly, in octaves of half the size and
// half the height each. No library functions whose bits differ between compilers.
#include "physics/dynamic/wind.h"

#include <cmath>
#include <cstdint>

#include "foundation/random.h"

namespace embody::physics::dynamic {

namespace {

constexpr int octaves = 3;                      // gusts of a half and a quarter of the length are in it
constexpr double across = 0.8, upwards = 0.52;  // of the changes along the wind
constexpr double width = 0.3;                   // of a gust, over its length

// Uniform in -1 … 1: the level of a component at a corner of the lattice.
double level(std::uint64_t component, std::int64_t i, std::int64_t j, std::int64_t k) {
    const std::uint64_t corner = static_cast<std::uint64_t>(i) * 0x9E3779B185EBCA87ull ^
                                 static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Full ^
                                 static_cast<std::uint64_t>(k) * 0x165667B19E3779F9ull;
    return Random(corner + component).between(-1, 1);
}

struct Place {
    std::int64_t index = 0;
    double fraction = 0;  // of the next corner, 3u² - 2u³
};

Place place(double x) {
    const double low = std::floor(x), u = x - low;
    return {static_cast<std::int64_t>(low), u * u * (3 - 2 * u)};
}

// Of root mean square 1: a level has the variance 1/3, and between two of them, mixed by s = 3u² - 2u³, the mean of
// (1-s)² + s² is 26/35, in each of three directions.
double noise(std::uint64_t component, Vec3 at) {
    constexpr double mixed = 26.0 / 35, of_octave = mixed * mixed * mixed / 3;  // variances, see above
    double sum = 0, variance = 0, height = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        const Place x = place(at.x), y = place(at.y), z = place(at.z);
        for (int corner = 0; corner < 8; ++corner) {
            const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
            const double fraction = (a ? x.fraction : 1 - x.fraction) * (b ? y.fraction : 1 - y.fraction) *
                                    (c ? z.fraction : 1 - z.fraction);
            sum += height * fraction *
                   level(4 * component + static_cast<std::uint64_t>(octave), x.index + a, y.index + b, z.index + c);
        }
        variance += height * height * of_octave;
        height /= 2;
        at = 2 * at;
    }
    return sum / std::sqrt(variance);
}

}  // namespace

Vec3 Wind::at(Vec3 position) const {
    if (!is_gusty()) return mean;
    const double speed = length(mean), size = speed * gust_time;
    const Vec3 along = mean / speed;
    // One axis across the wind is horizontal where the wind is not vertical.
    const Vec3 side = normalized(cross(Vec3{0, 1, 0}, along), {1, 0, 0});
    const Vec3 up = cross(along, side);
    const Vec3 gust{time / gust_time - dot(position, along) / size, dot(position, side) / (width * size),
                    dot(position, up) / (width * size)};
    return mean + gustiness * speed *
                      (noise(0, gust) * along + across * noise(1, gust) * side + upwards * noise(2, gust) * up);
}

Wind wind_at(const WorldSettings& settings, double time) {
    return {settings.wind, settings.gustiness, settings.gust_time, time};
}

}  // namespace embody::physics::dynamic
