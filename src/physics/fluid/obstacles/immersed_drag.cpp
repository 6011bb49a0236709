// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/immersed_drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/fluid/obstacles/small_body.h"

namespace embody::physics::fluid {

namespace {

using std::numbers::pi;

// C_d |u| of a cylinder across its axis: C_d = 1 + 10 Re^(-2/3) (F. M. White, "Viscous Fluid Flow", 2nd edition 1991)
// from Re = 1 on; below, the drag is proportional to the speed.
double cross_flow(double speed, double diameter, double kinematic_viscosity) {
    const double reynolds = std::max(speed * diameter / kinematic_viscosity, 1.0);
    const double root = std::cbrt(reynolds);
    return (1 + 10 / (root * root)) * std::max(speed, kinematic_viscosity / diameter);
}

// Friction along a cylinder, by its surface: 0.008 (ESDU 80025, smooth cylinders), and in slow flow half of the drag
// across (G. I. Taylor 1952; R. G. Cox 1970).
constexpr double skin_friction = 0.008;  // of ρ/2 u²

// What cloth lets through, 1/m: pressure over viscosity and speed (Darcy). A dense woven cotton lets 0.1 m/s of air
// through at 100 Pa (ISO 9237 tells it at that pressure; 0.01 to 1 m/s are usual), and air has 1.8e-5 Pa s.
constexpr double fabric_resistance = 100 / (0.1 * 1.8e-5);  // 1/m
// Friction along cloth: of a smooth plate, 0.074 Re^(-1/5), is 0.005 at Re = 7e5 (H. Schlichting, "Boundary-Layer
// Theory", 7th edition 1979, fig. 21.2), by each side.
constexpr double plate_friction = 0.005;  // of ρ/2 u²

ImmersedDrag drag_of_cylinder(const ImmersedForm& form, Vec3 slip, const DragLiquid& liquid) {
    const double nu = liquid.viscosity / liquid.density, d = form.size;
    const Vec3 t = form.direction, slip_along = dot(slip, t) * t, slip_across = slip - slip_along;
    // F = ρ/2 d l C_d |u| u across, ρ/2 π d l C_f |u| u along; half of the creeping one across is the least.
    const double front = liquid.density / 2 * d * form.extent;
    const double across = front * cross_flow(length(slip_across), d, nu);
    const double along = std::min(across, front * (pi * skin_friction * length(slip_along) + cross_flow(0, d, nu) / 2));
    return {{across, across, across}, (across - along) * slip_along};
}

// Δp = R u·n. The sheet is taken as steps along the axes: a flow u_a through the faces of axis a makes its own part of
// the pressure, A |n_a| of the area has it, and the flows through all of them together are A u·n.
ImmersedDrag drag_of_sheet(const ImmersedForm& form, Vec3 slip, const DragLiquid& liquid) {
    const Vec3 n = form.direction, size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
    const double across = fabric_resistance * liquid.viscosity * form.extent * (size.x + size.y + size.z);
    const double friction = liquid.density * form.extent * plate_friction * length(slip - dot(slip, n) * n);
    return {size * across + Vec3{friction, friction, friction}, {}};
}

}  // namespace

ImmersedDrag drag_of(const ImmersedForm& form, Vec3 slip, const DragLiquid& liquid) {
    switch (form.form) {
        case DragForm::none:
            break;
        case DragForm::sphere: {
            const double d =
                form.extent * drag_of_sphere(form.size / 2, length(slip), liquid.density, liquid.viscosity);
            return {{d, d, d}, {}};
        }
        case DragForm::cylinder:
            return drag_of_cylinder(form, slip, liquid);
        case DragForm::sheet:
            return drag_of_sheet(form, slip, liquid);
    }
    return {};
}

}  // namespace embody::physics::fluid
