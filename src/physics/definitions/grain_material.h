// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/material.h"
#include "physics/definitions/world_settings.h"

namespace embody::physics {

/// Surface of balls of this diameter (m) whose poured pile comes to rest at `friction_angle` (degrees), clamped to 7 …
/// 54. Against one another they roll as measured, on other bodies not before they slide. How it was measured:
/// docs/physics/grains.md.
Material grain_material(double friction_angle, double diameter);

/// WorldSettings::substeps that balls of this diameter need so that their piles have the slope that grain_material
/// says; not fewer than the settings have.
int substeps_for_grains(double diameter, const WorldSettings& settings);

}  // namespace embody::physics
