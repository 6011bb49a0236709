// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "math/vec3.h"

namespace embody::physics {

/// Energies and momenta of enabled dynamic bodies, deformables and fluids, or of some of them.
struct Conserved {
    double kinetic_energy = 0;    ///< J
    double potential_energy = 0;  ///< J in the world's gravity, zero at the origin's height
    Vec3 linear_momentum;         ///< kg m/s
    Vec3 angular_momentum;        ///< about the world's origin, kg m²/s
    [[nodiscard]] double energy() const { return kinetic_energy + potential_energy; }
};

/// What changes the energy and the momenta of rigid bodies in a step (docs/physics/energy.md).
enum class StepCause : std::uint8_t {
    gravity,              ///< its work moves energy from potential to kinetic
    forces,               ///< set by the user, and torques
    air,                  ///< drag
    impacts,              ///< eq. (3)
    contacts,             ///< normal forces and friction, by the relative velocity of the surfaces
    joints,               ///< those without motors, their limits included
    motors,               ///< joints with motors
    damping,              ///< of the bodies
    moving_bodies,        ///< kinematic bodies, through contacts, impacts and joints
    position_correction,  ///< bodies displaced otherwise than by their velocities
    limits,               ///< speeds that were cut, bodies that were frozen
    sleep,                ///< velocities that became zero as bodies fell asleep
    coupling,             ///< deformables and fluids
    count
};
/// "gravity", "position correction", …
const char* name_of(StepCause cause);

/// Account of the energy and the momenta of the rigid bodies in one step. Each entry is found on its own, from the
/// forces and impulses; the residual is the change of the bodies' states that the entries do not explain.
struct StepAccount {
    struct Entry {
        double work = 0;       ///< J
        Vec3 linear_impulse;   ///< N s, of everything but freely moving rigid bodies
        Vec3 angular_impulse;  ///< about the world's origin, N m s
    };
    Conserved before, after;
    std::array<Entry, static_cast<std::size_t>(StepCause::count)> entries{};
    double unexplained_energy = 0;  ///< change of kinetic and potential energy less all work but gravity's, J
    Vec3 unexplained_linear_momentum, unexplained_angular_momentum;  ///< change less all impulses

    Entry& of(StepCause cause) { return entries[static_cast<std::size_t>(cause)]; }
    [[nodiscard]] const Entry& of(StepCause cause) const { return entries[static_cast<std::size_t>(cause)]; }
};

}  // namespace embody::physics
