// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/handles.h"
#include "physics/fluid/solver.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// A body's state when a fluid last met it.
struct SeenBody {
    std::uint32_t version = 0;
    Transform pose;
    Vec3 force, torque;  ///< of the fluid on it in that step, N, N m
};

/// Where a point of a deformable lies among its nodes.
struct ImmersedPlace {
    std::uint32_t count = 0;
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};  ///< together 1
};

/// A deformable that a fluid met in its last step.
struct SeenDeformable {
    DeformableHandle deformable;
    std::vector<Vec3> force;  ///< of the fluid on its nodes in that step, N
    /// Liquid that its points hold from the fluid's advance until that step ends, and where these are.
    std::vector<PointBond> bonds;
    std::vector<ImmersedPlace> places;
    /// That liquid by node and axis, kg, and its momentum at which no force is between both, kg m/s.
    std::vector<Vec3> bound, bound_momentum;
};

/// A fluid with what drawing it and its sleep need.
struct FluidRecord {
    FluidDefinition definition;
    std::unique_ptr<FluidSolver> solver;
    Bounds bounds;       ///< of the particles, world
    double fastest = 0;  ///< m/s
    std::vector<Vec3f> positions, velocities;
    std::vector<std::uint32_t> ids;
    std::map<std::uint32_t, SeenBody> seen;  ///< by slot: bodies within its reach in the last step
    std::vector<SeenDeformable> immersed;    ///< by slot: deformables within its reach in the last step
    double quiet_time = 0;                   ///< s
    double quiet_height = 0;                 ///< mean height when the quiet time began, m
    bool is_asleep = false, is_frozen = false;
    std::uint64_t version = 0;  ///< counts changes of what users read
    std::uint64_t lost = 0;     ///< particles that flew out of reach
    /// Next id that sources use of those that were kept free for them, by the first of these.
    std::map<std::uint32_t, std::uint32_t> next_kept_ids;
};

/// A dynamic body in a fluid: forces that the next step expects of its contacts and joints (docs/physics/fluids.md).
struct FluidTouch {
    std::uint64_t step = 0;                  ///< last step in which a fluid touched it
    Vec3 linear_velocity, angular_velocity;  ///< when that step began
    Vec3 acceleration, torque;               ///< in that step, including the fluids'
    Vec3 force_asleep;                       ///< force of the fluids in the last step before it fell asleep, N
    double carried = 0;                      ///< force of the fluids in that step or the one before, the smaller one, N
};

}  // namespace embody::physics::state
