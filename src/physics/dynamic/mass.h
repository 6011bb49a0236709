// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/mass_properties.h"
#include "physics/definitions/body_definition.h"
#include "physics/dynamic/body_state.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

/// Mass, centre and inertia in `constants`: what `definition` gives, the rest from the shape's homogeneous solid.
/// Fails where neither has a mass or an inertia. `solid` has zero volume for a body without a shape that has one.
Result<void> resolve_mass(const MassDefinition& definition, const geometry::MassProperties& solid,
                          BodyConstants& constants);

}  // namespace embody::physics::dynamic
