// SPDX-License-Identifier: MIT
//
// How contacts lie in memory for the wide solver (docs/physics/wide-solver.md). A batch is a block of floats: a head,
// then up to four points; each quantity is one float a lane. Only numbers here: kernels include this file, and inline
// code would be merged across instruction sets.
#pragma once

#include <cstdint>

#include "physics/constraint/namespace.h"

namespace embody::physics::constraint {

/// Quantities of a contact, in floats times lanes from the start of its batch.
struct BatchHead {
    static constexpr int max_points = 4;  ///< of a region, as in Manifold
    enum Quantity : int {
        body_a,  ///< row of the body, an integer
        body_b,
        writable,  ///< lane 0: bit mask of the lanes whose body a may move; 1: the same for b; 2: of those that resist
                   ///< rolling; 3: of those with points whose time may not have come
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
        torsion_static,  ///< lever of the torsional friction beside the static one, and beside the dynamic one, m
        torsion_dynamic,
        friction_rolling,
        start_speed,                       ///< relative velocity at the anchor at the step's start along the three axes
        start_spin = start_speed + 3,      ///< ω of b less that of a at the step's start, about the three axes
        coupling = start_spin + 3,         ///< A_ij of points 01 02 03 12 13 23, 1/kg
        friction_coupling = coupling + 6,  ///< response of u_n, of ω₁, of ω₂ to friction: 3×3
        stop = friction_coupling + 9,      ///< inverse response of (u₁ u₂ ω_n): 11 12 13 22 23 33
        shift_response = stop + 6,         ///< largest response of the anchor's tangential speed, 1/kg
        twist_response,                    ///< response of ω_n, 1/(kg m²)
        friction,                          ///< impulse on b along tangent 1, 2, about the normal
        friction_total = friction + 3,     ///< of the step
        rolling = friction_total + 3,      ///< angular impulse on b by rolling resistance, world: x y z
        sticks = rolling + 3,              ///< mask
        round_a,                           ///< mask: the point of contact does not turn with the body
        round_b,
        turns,  ///< mask: of two balls, whose axes turn with the line of their centres
        apart,  ///< of those: from the centre of a to that of b when found, world: x y z
        size = apart + 3
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

/// How a Contact lies in memory, as rows of eight numbers (contact.h; wide_contact_solver.cpp checks it).
struct ContactRow {
    enum Row : int {
        frame = 1,     ///< normal, tangent 1, static and dynamic friction
        friction = 2,  ///< of the last substep, of the step, torsional and rolling friction
        rolling = 3,   ///< moment
        point = 4,     ///< arms, separation, impulse
        point_rest,    ///< place and separation when compared, total, inactive until
        rows_of_point = 2,
        size = 12
    };
};

/// What a lane's contact is, in bits.
struct LaneBit {
    enum Bit : int { sticks = 1, round_a = 2, round_b = 4, turns = 8, first_point = 16 /* then the other points' */ };
};

/// What a batch is filled from. Lanes without a contact have no bits and meet the rows of others.
struct BatchSource {
    const float* contacts = nullptr;            ///< first row of the first one
    const std::int32_t* contact_row = nullptr;  ///< by lane: first row of its contact, counted from there
    const std::int32_t* body_a = nullptr;       ///< by lane: row of the body
    const std::int32_t* body_b = nullptr;
    const std::int32_t* bits = nullptr;  ///< by lane: LaneBit
    const float* start = nullptr;        ///< rows: v, ω when the step began
    const float* inertia = nullptr;      ///< rows: inverse inertia xx xy xz yy yz zz, inverse mass
};

/// Floats of a batch of `lanes` contacts with up to `points` points.
constexpr int batch_floats(int lanes, int points) { return lanes * (BatchHead::size + points * BatchPoint::size); }

/// Numbers of one sweep.
struct ContactSweep {
    float* velocity = nullptr;               ///< rows of eight floats: change of v and of ω since the step began
    const float* motion = nullptr;           ///< rows: displacement, turn (x y z w)
    const float* start = nullptr;            ///< rows: v, ω when the step began
    float substep = 0, inverse_substep = 0;  ///< s, 1/s
    float time = 0;                          ///< of the substep's end in the step, s
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
    /// Takes up contacts and finds their effective masses; all but BatchHead::writable.
    void (*fill)(float* batch, int points, const BatchSource& source) = nullptr;
    /// Takes points whose time has not come out, applies the last step's impulses of the others; in the first substep.
    void (*warm_start)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Before the drift: takes position errors out as well.
    void (*solve_positions)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Gaps, and axes between balls, from the bodies' motion; before the first substep.
    void (*separate)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// After the drift: velocities alone.
    void (*solve_velocities)(float* batch, int points, const ContactSweep& sweep) = nullptr;
    /// Forces of a substep on the rows [first, last), and what the contacts did in the last substep once more (warm
    /// start): the impulses are the same, and the arms stay through the step.
    void (*kick)(const BodyRows& rows, std::int32_t first, std::int32_t last) = nullptr;
    /// Moves the rows [first, last) by their velocities.
    void (*drift)(const BodyRows& rows, float substep, std::int32_t first, std::int32_t last) = nullptr;

    /// For each width of math/kernel_width.h.
    static const ContactKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody::physics::constraint
