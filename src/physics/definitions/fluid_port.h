// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "foundation/result.h"
#include "math/vec3.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/handles.h"

namespace embody::physics {

/// A tap or a shower: liquid leaves a disc evenly, as particles of a fluid. docs/physics/fluids.md, "Sources and
/// drains".
struct FluidSource {
    FluidHandle fluid;         ///< gains the particles; while it is stale or frozen, nothing comes
    BodyHandle body;           ///< goes along with it; null: stands in the world
    Vec3 position;             ///< of the disc's middle, in the body's frame or the world's, m; outside of solids
    Vec3 direction{0, -1, 0};  ///< of the flow, in that frame; of any length
    double radius = 0.01;      ///< of the disc, m, 0 … 10
    double rate = 1e-4;        ///< m³/s, 0 … 10
    double speed = 0;          ///< m/s, 0 … 100; 0: that at which the flow fills the disc
    bool is_open = true;
    std::optional<LiquidMatter> matter;  ///< of the particles; without, that of the ids behind the fluid's
    /// The particles have the next of these ids, which World::make_room has kept free; it waits when they are used up.
    /// None: those that follow all others of the fluid.
    FluidIds ids;
    /// It waits while the fluid has as many particles.
    std::size_t max_particles = max_fluid_particles;
};

/// A hole: takes the particles of all fluids that come into a ball.
struct FluidDrain {
    BodyHandle body;       ///< goes along with it; null: stands in the world
    Vec3 position;         ///< of the ball's middle, in the body's frame or the world's, m
    double radius = 0.03;  ///< m, 0 … 10; of half a cell or more, to be noticed
    bool is_open = true;
};

using FluidPort = std::variant<FluidSource, FluidDrain>;

/// The error's `where` is the field.
Result<void> validate(const FluidPort& port);

}  // namespace embody::physics
