// SPDX-License-Identifier: MIT
//
// How contacts lie in memory for the wide solver (docs/physics/wide-solver.md). A batch is a block of floats: a head,
// then up to four points; each quantity is one float a lane. Only numbers here: kernels include this file, and inline
// code would be merged across instruction sets.
#pragma once

#include <cstdint>

namespace embody::physics {

/// Rounds over the points of a region within one pass, in which its bodies are not touched.
inline constexpr int normal_rounds = 2;

/// Quantities of a contact, in floats times lanes from the start of its batch.
struct BatchHead {
    enum Quantity : int {
        body_a,  ///< row of the body, an integer
        body_b,
        writable,  ///< lane 0: bit mask of the lanes whose body a may move; 1: the same for b; 2: of those that resist
                   ///< rolling
        inverse_mass_a,
        inverse_mass_b,
        inverse_inertia_a,  ///< world, at the step's start: xx xy xz yy yz zz
        inverse_inertia_b = inverse_inertia_a + 6,
        normal = inverse_inertia_b + 6,  ///< from a to b: x y z; so are the next two
        tangent_1 = normal + 3,
        tangent_2 = tangent_1 + 3,
        arm_a = tangent_2 + 3,  ///< from the centre of mass to the anchor, the middle of the points, world: x y z
        arm_b = arm_a + 3,
        friction_static = arm_b + 3,
        friction_dynamic,
        friction_torsional,
        friction_rolling,
        start_speed,                      ///< relative velocity at the anchor at the step's start along the three axes
        start_spin = start_speed + 3,     ///< ω of b less that of a at the step's start, about the three axes
        coupling = start_spin + 3,        ///< A_ij of points 01 02 03 12 13 23, 1/kg
        stop_all = coupling + 6,          ///< inverse response of (u₁ u₂ ω_n): 11 12 13 22 23 33
        stop_shift = stop_all + 6,        ///< inverse response of (u₁ u₂): 11 12 22
        shift_response = stop_shift + 3,  ///< largest response of the anchor's tangential speed, 1/kg
        twist_response,                   ///< response of ω_n, 1/(kg m²)
        friction,                         ///< impulse on b along tangent 1, 2, about the normal
        friction_total = friction + 3,    ///< of the step
        rolling = friction_total + 3,     ///< angular impulse on b by rolling resistance, world: x y z
        sticks = rolling + 3,             ///< mask
        round_a,                          ///< mask: the point of contact does not turn with the body
        round_b,
        size
    };
};

/// Quantities of a point, in floats times lanes from its own start.
struct BatchPoint {
    enum Quantity : int {
        along_1,  ///< place on the region from the anchor, m
        along_2,
        separation_found,
        separation,       ///< now
        normal_response,  ///< A_ii, 1/kg
        normal_mass,      ///< 1/A_ii, kg; 0 where there is no point
        impulse,          ///< along the normal
        total,            ///< of the step
        inactive_until,   ///< s in the step
        size
    };
};

/// Floats of a batch of `lanes` contacts with up to `points` points.
constexpr int batch_floats(int lanes, int points) { return lanes * (BatchHead::size + points * BatchPoint::size); }

/// Numbers of one sweep.
struct ContactSweep {
    float* velocity = nullptr;      ///< rows of eight floats: change of v and of ω since the step began
    const float* motion = nullptr;  ///< rows: way, turn (x y z w)
    float substep = 0;              ///< s
    float time = 0;                 ///< of the substep's end in the step, s
    float bias_rate = 0, mass_scale = 1, impulse_scale = 0;
    float push_speed = 0;   ///< m/s
    bool is_first = false;  ///< of the passes after a drift: finds the gaps anew
    bool is_last = false;   ///< adds the substep's impulses to the step's
};

/// Rows of the bodies and what moves them. A kick is v ← v damping + kick.
struct BodyRows {
    float* velocity = nullptr;       ///< as in ContactSweep
    float* motion = nullptr;         ///< as in ContactSweep
    const float* start = nullptr;    ///< v, ω when the step began
    const float* kick = nullptr;     ///< change of v and ω by the forces of a substep
    const float* damping = nullptr;  ///< factors
    float* kicked = nullptr;         ///< velocity after the forces and before the contacts of this substep
};

/// One width's code. Each function works on one batch of up to `points` points, or on rows of bodies.
struct ContactKernels {
    int lanes = 0;
    /// Effective masses, from arms, masses and inertias.
    void (*prepare)(float* batch, int points) = nullptr;
    /// Takes points whose time has not come out, applies the last step's impulses of the others; in the first substep.
    void (*warm_start)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Before the drift: takes position errors out as well.
    void (*solve_positions)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Gaps from the bodies' motion; before the first substep.
    void (*separate)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// After the drift: velocities alone.
    void (*solve_velocities)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Forces of a substep on the rows [first, last), and what the contacts did in the last substep once more (warm
    /// start): the impulses are the same, and the arms stay through the step.
    void (*kick)(const BodyRows& rows, std::int32_t first, std::int32_t last) = nullptr;
    /// Moves the rows [first, last) by their velocities.
    void (*drift)(const BodyRows& rows, float substep, std::int32_t first, std::int32_t last) = nullptr;
};

/// Code for that many lanes, or nullptr where the processor or the build has none.
const ContactKernels* contact_kernels(int lanes);
/// The widest there is.
const ContactKernels& widest_contact_kernels();

}  // namespace embody::physics
