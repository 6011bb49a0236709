// SPDX-License-Identifier: MIT
#include "scene/matter/fluid_filling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "scene/embody/filled_region.h"

namespace embody::scene {

namespace {

// Maximum number of lattice places: they take about a second.
constexpr double max_places = 20'000'000;

/// A lattice of `counts` places that fits the bounds.
struct Lattice {
    Vec3 first, spacing;
    std::array<double, 3> counts{};

    Lattice(const Bounds& bounds, double step) {
        for (int axis = 0; axis < 3; ++axis) {
            counts[axis] = std::max(1.0, std::round(bounds.size()[axis] / step));
            spacing[axis] = bounds.size()[axis] / counts[axis];
        }
        first = bounds.lower + spacing * 0.5;
    }
    [[nodiscard]] double size() const { return counts[0] * counts[1] * counts[2]; }
};

// Stops at more than `max_count` places.
std::vector<Vec3> places_in(const FilledRegion& region, const Lattice& lattice, std::size_t max_count) {
    std::vector<Vec3> places;
    for (double y = 0; y < lattice.counts[1]; ++y) {
        for (double z = 0; z < lattice.counts[2]; ++z) {
            for (double x = 0; x < lattice.counts[0]; ++x) {
                const Vec3& s = lattice.spacing;
                const Vec3 place = lattice.first + Vec3{x * s.x, y * s.y, z * s.z};
                if (!region.holds_ball(place, 0)) continue;
                places.push_back(place);
                if (places.size() > max_count) return places;
            }
        }
    }
    return places;
}

// Leaves `count` of the places, in their order. Those that go follow the golden ratio, whatever the lattice's rows.
std::vector<Vec3> thinned(const std::vector<Vec3>& places, std::size_t count) {
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [](std::size_t i) {
        const double turns = static_cast<double>(i) / std::numbers::phi;
        return turns - std::floor(turns);
    };
    std::ranges::stable_sort(order, {}, rank);
    order.resize(count);
    std::ranges::sort(order);
    std::vector<Vec3> left;
    left.reserve(count);
    for (const std::size_t i : order) left.push_back(places[i]);
    return left;
}

const Error too_flat{"shape", "is too flat to be filled with liquid",
                     "make it thicker, or allow more with particle_budget"};

}  // namespace

Result<FluidFilling> fill_with_fluid(const physics::ShapeDefinition& shape, double cell_size, std::size_t max_count) {
    const Result<FilledRegion> region = FilledRegion::of(shape);
    if (!region.ok()) return region.error();
    constexpr double coarser = 1.03, finer = 0.7;
    bool was_too_many = false;
    for (double step = cell_size / 2;;) {
        const Lattice lattice(region.value().bounds(), step);
        if (lattice.size() > max_places) {
            if (!was_too_many && step < cell_size / 2) break;
            step *= 1.25;
            continue;
        }
        FluidFilling filling{places_in(region.value(), lattice, max_count), 0};
        if (filling.places.size() > max_count) {
            was_too_many = true;
            step *= coarser;
        } else if (!filling.places.empty()) {
            filling.cell_size = 2 * std::cbrt(lattice.spacing.x * lattice.spacing.y * lattice.spacing.z);
            return filling;
        } else if (was_too_many) {
            break;
        } else {
            step *= finer;
        }
    }
    return too_flat;
}

Result<std::vector<Vec3>> places_of_particles(const physics::ShapeDefinition& shape, std::size_t count) {
    const Result<FilledRegion> region = FilledRegion::of(shape);
    if (!region.ok()) return region.error();
    constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    constexpr double probes = 20'000, coarser = 1.06, finer = 0.98;
    const Vec3 size = region.value().bounds().size();
    const Lattice probe(region.value().bounds(), std::cbrt(size.x * size.y * size.z / probes));
    const auto inside = static_cast<double>(places_in(region.value(), probe, all).size());
    const double volume = inside * probe.spacing.x * probe.spacing.y * probe.spacing.z;
    if (!(volume > 0)) return too_flat;
    // From too coarse a lattice to the first that is fine enough.
    for (double step = coarser * std::cbrt(volume / static_cast<double>(count));; step *= finer) {
        const Lattice lattice(region.value().bounds(), step);
        if (lattice.size() > max_places) return too_flat;
        const std::vector<Vec3> places = places_in(region.value(), lattice, all);
        if (places.size() >= count) return thinned(places, count);
    }
}

}  // namespace embody::scene
