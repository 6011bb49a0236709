// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/mass_properties.h"
#include "physics/definitions/body_definition.h"
#include "physics/dynamic/body_state.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

/// Sets mass, centre and inertia in `constants` to those of body_mass(), and the inverse that the solver needs. Fails
/// where body_mass() fails, and where the inertia is too small to be inverted.
Result<void> resolve_mass(const MassDefinition& definition, const geometry::MassProperties& solid,
                          BodyConstants& constants);

}  // namespace embody::physics::dynamic
