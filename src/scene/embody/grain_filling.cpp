// SPDX-License-Identifier: MIT
// Face-centred cubic rows, loosened and with random shifts (docs/physics/grains.md: Filling).
#include "scene/embody/grain_filling.h"

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "scene/embody/filled_region.h"

namespace embody::scene {

namespace {

constexpr double spacing = 1.1;  // of the rows, in diameters: 0.74 / 1.1³ = 0.556 of the space is grain
// Largest random shift along an axis, in diameters: two balls 0.1 d apart that are both shifted by √3 times that
// towards each other still do not touch.
constexpr double jitter = 0.028;
// Maximum number of lattice places: they take about a second.
constexpr std::size_t max_places = 50'000'000;
// The rule for the diameter ignores edges: at most this fraction of the wanted number may be left out at the top.
constexpr double max_left_out = 0.5;

}  // namespace

Result<std::vector<Vec3>> fill_with_grains(const physics::ShapeDefinition& shape, double diameter,
                                           std::size_t max_count, std::uint64_t seed) {
    const Result<FilledRegion> region = FilledRegion::of(shape);
    if (!region.ok()) return region.error();
    const Bounds& bounds = region.value().bounds();

    // Rows along X in layers upwards; every third layer lies above the first.
    const double a = spacing * diameter, row = a * std::sqrt(3.0) / 2, layer = a * std::sqrt(2.0 / 3);
    const Vec3 first = bounds.lower + Vec3{diameter, diameter, diameter} * (0.5 + jitter);
    const auto count = [&](double extent, double step) {
        return static_cast<std::int64_t>(std::max(0.0, (extent - diameter) / step)) + 2;
    };
    const Vec3 size = bounds.size();
    Random random(seed);
    std::vector<Vec3> centers;
    std::size_t looked_at = 0, left_out = 0;
    for (std::int64_t iy = 0; iy < count(size.y, layer); ++iy) {
        for (std::int64_t iz = 0; iz < count(size.z, row); ++iz) {
            for (std::int64_t ix = 0; ix < count(size.x, a); ++ix) {
                if (++looked_at > max_places)
                    return Error{"simulated_diameter", "is too small to fill so large a shape", "make it larger"};
                const double shift_x = static_cast<double>((iz + iy % 3) % 2) * a / 2;
                const double shift_z = static_cast<double>(iy % 3) * row / 3;
                const Vec3 offset{random.between(-jitter, jitter), random.between(-jitter, jitter),
                                  random.between(-jitter, jitter)};
                const Vec3 place = first +
                                   Vec3{static_cast<double>(ix) * a + shift_x, static_cast<double>(iy) * layer,
                                        static_cast<double>(iz) * row + shift_z} +
                                   offset * diameter;
                if (!region.value().holds_ball(place, diameter / 2)) continue;
                if (centers.size() < max_count) {
                    centers.push_back(place);
                } else if (static_cast<double>(++left_out) > max_left_out * static_cast<double>(max_count)) {
                    return Error{"grain_budget",
                                 "of " + std::to_string(max_count) + " grains of " + std::to_string(diameter) +
                                     " m does not fill the shape",
                                 "raise it, make simulated_diameter larger, or fill a smaller shape"};
                }
            }
        }
    }
    if (centers.empty())
        return Error{"simulated_diameter", "is too large: no grain fits into the shape",
                     "make it smaller, or allow more grains with grain_budget"};
    return centers;
}

}  // namespace embody::scene
