// SPDX-License-Identifier: MIT
#include "scene/matter/melting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/matter/fluid_filling.h"

namespace embody::scene {

using physics::FluidDrop;

namespace {

using Tetrahedron = std::array<std::uint32_t, 4>;

double volume_of(const Tetrahedron& of, std::span<const Vec3> nodes) {
    const Vec3 a = nodes[of[0]];
    return std::fabs(dot(nodes[of[1]] - a, cross(nodes[of[2]] - a, nodes[of[3]] - a))) / 6;
}

// Weights of a tetrahedron's corners for the k-th place of a sequence that fills it evenly: the quasirandom sequence R3
// of the unit cube (M. Roberts, 2018), folded into the tetrahedron (C. Rocchini, P. Cignoni, 2000).
std::array<double, 4> weights_at(std::size_t k) {
    constexpr double plastic = 1.2207440846057596;  // root of x⁴ = x + 1
    std::array<double, 3> at{};
    double step = 1;
    for (double& coordinate : at) {
        step /= plastic;
        const double turns = 0.5 + static_cast<double>(k) * step;
        coordinate = turns - std::floor(turns);
    }
    auto [s, t, u] = at;
    if (s + t > 1) {
        s = 1 - s;
        t = 1 - t;
    }
    if (t + u > 1) {
        const double before = u;
        u = 1 - s - t;
        t = 1 - before;
    } else if (s + t + u > 1) {
        const double before = u;
        u = s + t + u - 1;
        s = 1 - t - before;
    }
    return {1 - s - t - u, s, t, u};
}

Result<std::vector<FluidDrop>> drops(const MeltingBody& body, Vec3 center, std::size_t count) {
    const Result<std::vector<Vec3>> places = places_of_particles(body.shape, count);
    if (!places.ok()) return places.error();
    std::vector<FluidDrop> made;
    made.reserve(count);
    for (const Vec3 place : places.value()) {
        const Vec3 at = transform_point(body.pose, place);
        made.push_back({at, body.linear_velocity + cross(body.angular_velocity, at - center)});
    }
    return made;
}

// The mass of a tetrahedron goes as its volume at rest. What is owed after one is owed to the next.
std::vector<FluidDrop> drops(const MeltingSolid& solid, std::size_t count) {
    const auto rest_volume = [&](double sum, const Tetrahedron& of) { return sum + volume_of(of, solid.rest); };
    const double all = std::accumulate(solid.tetrahedra.begin(), solid.tetrahedra.end(), 0.0, rest_volume);
    std::vector<FluidDrop> made;
    made.reserve(count);
    double before = 0;
    for (const Tetrahedron& of : solid.tetrahedra) {
        before += volume_of(of, solid.rest);
        const double owed = std::round(before / all * static_cast<double>(count));
        while (static_cast<double>(made.size()) < owed) {
            const std::array<double, 4> weights = weights_at(made.size());
            FluidDrop drop;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                drop.position += weights[corner] * solid.positions[of[corner]];
                drop.velocity += weights[corner] * solid.velocities[of[corner]];
            }
            made.push_back(drop);
        }
    }
    return made;
}

}  // namespace

Momenta momenta_of(const MeltingSolid& solid) {
    Momenta momenta;
    for (std::size_t i = 0; i < solid.masses.size(); ++i) {
        momenta.mass += solid.masses[i];
        momenta.center += solid.masses[i] * solid.positions[i];
        momenta.linear += solid.masses[i] * solid.velocities[i];
    }
    momenta.center = momenta.center / momenta.mass;
    for (std::size_t i = 0; i < solid.masses.size(); ++i)
        momenta.angular += solid.masses[i] * cross(solid.positions[i] - momenta.center, solid.velocities[i]);
    return momenta;
}

Result<Filled> filled_by(const Melting& melting, double cell_size, std::size_t max_count) {
    if (const auto* solid = std::get_if<MeltingSolid>(&melting.matter)) {
        const auto add = [&](double sum, const Tetrahedron& of) { return sum + volume_of(of, solid->positions); };
        const double volume = std::accumulate(solid->tetrahedra.begin(), solid->tetrahedra.end(), 0.0, add);
        return Filled{volume, std::max(cell_size, std::cbrt(8 * volume / static_cast<double>(max_count)))};
    }
    const Result<FluidFilling> filling =
        fill_with_fluid(std::get<MeltingBody>(melting.matter).shape, cell_size, max_count);
    if (!filling.ok()) return filling.error();
    const double cell = filling.value().cell_size;
    return Filled{static_cast<double>(filling.value().places.size()) * cell * cell * cell / 8, cell};
}

Result<std::vector<FluidDrop>> drops_of(const Melting& melting, std::size_t count) {
    if (const auto* solid = std::get_if<MeltingSolid>(&melting.matter)) return drops(*solid, count);
    return drops(std::get<MeltingBody>(melting.matter), melting.momenta.center, count);
}

}  // namespace embody::scene
