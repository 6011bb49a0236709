// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "folders.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {

/// The case of that id in reference-cases.json: setup, expected values, tolerance.
inline nlohmann::json reference_case(const std::string& id) {
    static const nlohmann::json file =
        nlohmann::json::parse(std::ifstream(source_folder() / "tests/validation/reference-cases.json"));
    for (const auto& reference : file.at("cases")) {
        if (reference.at("id") == id) return reference;
    }
    ADD_FAILURE() << "no reference case " << id;
    return {};
}

inline Vec3 to_vec3(const nlohmann::json& numbers) {
    return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

/// A plane through the origin, tilted by `angle` (rad) about Z: it falls towards +X.
inline BodyHandle add_plane(World& world, const Material& material, double angle = 0) {
    const auto shape = world.create_shape(PlaneShape{{std::sin(angle), std::cos(angle), 0}, 0}).value();
    return world.create_body({.kind = BodyKind::static_body, .shape = shape, .material = material}).value();
}

inline void run(World& world, double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / world.settings().time_step));
    for (int i = 0; i < steps; ++i) world.step();
}

inline double energy(const World& world) {
    const Conserved sum = world.conserved();
    return sum.kinetic_energy + sum.potential_energy;
}

inline Material friction(double mu) {
    return {.friction_static = mu, .friction_dynamic = mu, .friction_combine = CombineRule::geometric_mean};
}

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double gravity = 9.81;

}  // namespace embody::physics
