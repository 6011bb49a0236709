// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/brittleness.h"
#include "physics/definitions/handles.h"
#include "physics/definitions/material.h"

namespace embody::physics {

/// static: never moves, infinite mass. kinematic: moves as its velocity says, infinite mass. dynamic: obeys forces.
enum class BodyKind : std::uint8_t { static_body, kinematic_body, dynamic_body };

/// The paper's sleeping states: red, green and gray in its figures.
enum class SleepState : std::uint8_t { active, wants_to_sleep, asleep };

/// Mass of a dynamic body. What is not given is computed from the shape: mass = density × volume, centre and inertia of
/// a homogeneous solid (scaled to the mass where one is given).
struct MassDefinition {
    std::optional<double> mass;          ///< kg, 1e-6 … 1e9
    double density = 1000;               ///< kg/m³, used where the mass is not given, > 0
    std::optional<Vec3> center_of_mass;  ///< in the body's frame, m
    std::optional<Mat3> inertia;         ///< about the centre of mass, in the body's axes, kg m², symmetric, positive
                                         ///< definite, each principal moment <= the sum of the other two
};

struct BodyDefinition {
    BodyKind kind = BodyKind::dynamic_body;
    ShapeHandle shape;      ///< null: a body without collision shape (then mass and inertia must be given)
    Vec3 position;          ///< of the body's origin, m
    Quat rotation;          ///< normalised on creation; must not be zero
    Vec3 linear_velocity;   ///< of the centre of mass, m/s
    Vec3 angular_velocity;  ///< world axes, rad/s
    MassDefinition mass;
    Material material;
    double linear_damping = 0;   ///< 1/s, 0 … 100
    double angular_damping = 0;  ///< 1/s, 0 … 100
    double drag_area = 0;        ///< area that meets the air times the drag coefficient, m², 0 …
                                 ///< 1e8
    double gravity_factor = 1;   ///< -10 … 10
    Vec3 force;                  ///< constant, world axes, at the centre of mass, N
    Vec3 torque;                 ///< constant, world axes, N m
    double sleep_energy_per_mass = 0.5 * 0.03 * 0.03;  ///< J/kg: a body with less for half a second may sleep
    bool allow_sleep = true;
    bool start_asleep = false;
    bool enabled = true;                ///< a disabled body neither moves nor collides
    bool continuous = false;            ///< sweep fast motion against everything, not only as the step's margin allows
    std::uint32_t collision_group = 1;  ///< bits
    std::uint32_t collision_mask = 0xFFFFFFFFu;  ///< bodies a and b collide iff a.group & b.mask and b.group & a.mask
    std::optional<Brittleness> brittleness;      ///< of a dynamic body with a shape: blows break it; none: nothing does
    std::uint64_t user_data = 0;                 ///< handed back in events; the library never reads it
};

/// Whether every number is finite and in range; the error's `where` is the field. Shape and handle are checked by the
/// world.
Result<void> validate(const BodyDefinition& definition);

}  // namespace embody::physics
