// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "math/vec3.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// What the drag of a point in a liquid is computed as.
enum class DragForm : std::uint8_t { none, sphere, cylinder, sheet };

/// The form of a point in a liquid.
struct ImmersedForm {
    DragForm form = DragForm::none;
    Vec3 direction;     ///< unit: along the cylinder, across the sheet
    double size = 0;    ///< diameter of the sphere or cylinder, m
    double extent = 0;  ///< length of the cylinder, m; area of the sheet, m²; fraction of a sphere
};

/// Drag of a point as D (u − v), D = its coefficients along the axes less those of `less`: an implicit step with
/// `along` and an explicit one with the rest is stable for any time step, as no eigenvalue of `less` is larger than
/// that of `along`.
struct ImmersedDrag {
    Vec3 along;  ///< by axis, N s/m
    Vec3 less;   ///< (along − D) (u − v) with the slip that it was computed for, N
};

/// Matter of the liquid around: density, kg/m³; dynamic viscosity, Pa s.
struct DragLiquid {
    double density = 998, viscosity = 0.001;
};

/// For a slip u − v, m/s: the liquid's velocity relative to the point's. docs/physics/coupling.md, "Liquids and what
/// bends".
ImmersedDrag drag_of(const ImmersedForm& form, Vec3 slip, const DragLiquid& liquid);

}  // namespace embody::physics::fluid
