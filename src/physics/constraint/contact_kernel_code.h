// SPDX-License-Identifier: MIT
//
// The contact solver on EMBODY_LANES contacts at once. Equations and sources: contact_solver.cpp; why in this shape:
// docs/physics/wide-solver.md. Included once by each of contact_kernel_4.cpp, _8.cpp and _16.cpp.
#include "math/wide.h"
#include "physics/constraint/contact_batch.h"

namespace embody::EMBODY_WIDE {
namespace {

using physics::BatchHead;
using physics::BatchPoint;
using physics::BodyRows;
using physics::ContactSweep;

/// Two bodies' velocities, one pair a lane, taken from their rows and put back.
struct Velocities {
    Wide a[row_floats], b[row_floats];

    EMBODY_WIDE_INLINE Velocities take(const float* batch, const ContactSweep& sweep) {
        Velocities v;
        gather_rows(sweep.velocity, rows_of(batch, BatchHead::body_a), v.a);
        gather_rows(sweep.velocity, rows_of(batch, BatchHead::body_b), v.b);
        return v;
    }
    [[gnu::always_inline]] inline void put_back(const float* batch, const ContactSweep& sweep) const {
        const std::int32_t* writable = rows_of(batch, BatchHead::writable);
        scatter_rows(sweep.velocity, rows_of(batch, BatchHead::body_a), static_cast<std::uint32_t>(writable[0]), a);
        scatter_rows(sweep.velocity, rows_of(batch, BatchHead::body_b), static_cast<std::uint32_t>(writable[1]), b);
    }
    EMBODY_WIDE_INLINE const std::int32_t* rows_of(const float* batch, int quantity) {
        return reinterpret_cast<const std::int32_t*>(batch + quantity * lanes);
    }

    [[gnu::always_inline]] inline Wide3 linear_a() const { return {a[0], a[1], a[2]}; }
    [[gnu::always_inline]] inline Wide3 linear_b() const { return {b[0], b[1], b[2]}; }
    [[gnu::always_inline]] inline Wide3 angular_a() const { return {a[3], a[4], a[5]}; }
    [[gnu::always_inline]] inline Wide3 angular_b() const { return {b[3], b[4], b[5]}; }
    /// Change of the velocity of b's matter relative to a's.
    [[gnu::always_inline]] inline Wide3 relative(const Wide3& arm_a, const Wide3& arm_b) const {
        return linear_b() + cross(angular_b(), arm_b) - (linear_a() + cross(angular_a(), arm_a));
    }
};

/// Masses and inertias of a batch.
struct Inertia {
    Wide mass_a, mass_b;                 // inverse
    WideSymmetric inertia_a, inertia_b;  // inverse

    EMBODY_WIDE_INLINE WideSymmetric load_symmetric(const float* from) {
        return {load(from),
                load(from + lanes),
                load(from + 2 * lanes),
                load(from + 3 * lanes),
                load(from + 4 * lanes),
                load(from + 5 * lanes)};
    }
    EMBODY_WIDE_INLINE Inertia of(const float* batch) {
        return {load(batch + BatchHead::inverse_mass_a * lanes), load(batch + BatchHead::inverse_mass_b * lanes),
                load_symmetric(batch + BatchHead::inverse_inertia_a * lanes),
                load_symmetric(batch + BatchHead::inverse_inertia_b * lanes)};
    }
};

// Paper, eq. (6): an impulse on b and its opposite on a.
EMBODY_WIDE_INLINE void apply(Velocities& v, const Inertia& m, const Wide3& arm_a, const Wide3& arm_b,
                              const Wide3& impulse) {
    const Wide3 turn_a = m.inertia_a * cross(arm_a, impulse), turn_b = m.inertia_b * cross(arm_b, impulse);
    v.a[0] -= impulse.x * m.mass_a;
    v.a[1] -= impulse.y * m.mass_a;
    v.a[2] -= impulse.z * m.mass_a;
    v.a[3] -= turn_a.x;
    v.a[4] -= turn_a.y;
    v.a[5] -= turn_a.z;
    v.b[0] += impulse.x * m.mass_b;
    v.b[1] += impulse.y * m.mass_b;
    v.b[2] += impulse.z * m.mass_b;
    v.b[3] += turn_b.x;
    v.b[4] += turn_b.y;
    v.b[5] += turn_b.z;
}

EMBODY_WIDE_INLINE void apply_turning(Velocities& v, const Inertia& m, const Wide3& impulse) {
    const Wide3 turn_a = m.inertia_a * impulse, turn_b = m.inertia_b * impulse;
    v.a[3] -= turn_a.x;
    v.a[4] -= turn_a.y;
    v.a[5] -= turn_a.z;
    v.b[3] += turn_b.x;
    v.b[4] += turn_b.y;
    v.b[5] += turn_b.z;
}

EMBODY_WIDE_INLINE float* point_of(float* batch, int k) {
    return batch + (BatchHead::size + k * BatchPoint::size) * lanes;
}
EMBODY_WIDE_INLINE Wide quantity(const float* part, int which) { return load(part + which * lanes); }
EMBODY_WIDE_INLINE Wide3 quantity_3(const float* part, int which) { return load_3(part + which * lanes); }

/// What friction, normals and turning share.
struct Frame {
    Wide3 normal, tangent_1, tangent_2;
    EMBODY_WIDE_INLINE Frame of(const float* batch) {
        return {quantity_3(batch, BatchHead::normal), quantity_3(batch, BatchHead::tangent_1),
                quantity_3(batch, BatchHead::tangent_2)};
    }
};

EMBODY_WIDE_INLINE bool resists_turning(const float* batch) {
    return Velocities::rows_of(batch, BatchHead::writable)[2] != 0;
}

// u along a direction after a unit impulse along another one at the same point: dᵀ A e.
EMBODY_WIDE_INLINE Wide response(const Inertia& m, const Wide3& arm_a, const Wide3& arm_b, const Wide3& d,
                                 const Wide3& e) {
    return (m.mass_a + m.mass_b) * dot(d, e) + dot(cross(arm_a, d), m.inertia_a * cross(arm_a, e)) +
           dot(cross(arm_b, d), m.inertia_b * cross(arm_b, e));
}

void prepare(float* batch, int points) {
    const Frame frame = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    const Wide zero{}, one = broadcast(1), two = broadcast(2), four = broadcast(4);
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const Wide3 arm_a = quantity_3(point, BatchPoint::arm_a), arm_b = quantity_3(point, BatchPoint::arm_b);
        // Lanes without this point hold 0 there; the others 1.
        const WideMask exists = quantity(point, BatchPoint::normal_mass) > zero;

        const Wide nn = response(m, arm_a, arm_b, frame.normal, frame.normal);
        store(point + BatchPoint::normal_mass * lanes, select(exists & (nn > zero), one / nn, zero));

        const Wide k11 = response(m, arm_a, arm_b, frame.tangent_1, frame.tangent_1);
        const Wide k12 = response(m, arm_a, arm_b, frame.tangent_1, frame.tangent_2);
        const Wide k22 = response(m, arm_a, arm_b, frame.tangent_2, frame.tangent_2);
        const Wide determinant = k11 * k22 - k12 * k12;
        const WideMask solvable = exists & (determinant > zero);
        const Wide split = square_root((k11 - k22) * (k11 - k22) + four * k12 * k12);
        store(point + BatchPoint::tangent_11 * lanes, select(solvable, k22 / determinant, zero));
        store(point + BatchPoint::tangent_12 * lanes, select(solvable, -k12 / determinant, zero));
        store(point + BatchPoint::tangent_22 * lanes, select(solvable, k11 / determinant, zero));
        store(point + BatchPoint::slide_mass * lanes, select(solvable, two / (k11 + k22 + split), zero));
    }
}

void warm_start(float* batch, int points, const ContactSweep& sweep) {
    const Frame frame = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    const Wide zero{}, time = broadcast(sweep.time);
    Velocities v = Velocities::take(batch, sweep);
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const WideMask is_active = time > quantity(point, BatchPoint::inactive_until);
        const Wide normal = select(is_active, quantity(point, BatchPoint::impulse_normal), zero);
        const Wide along_1 = select(is_active, quantity(point, BatchPoint::impulse_1), zero);
        const Wide along_2 = select(is_active, quantity(point, BatchPoint::impulse_2), zero);
        store(point + BatchPoint::impulse_normal * lanes, normal);
        store(point + BatchPoint::impulse_1 * lanes, along_1);
        store(point + BatchPoint::impulse_2 * lanes, along_2);
        apply(v, m, quantity_3(point, BatchPoint::arm_a), quantity_3(point, BatchPoint::arm_b),
              frame.normal * normal + frame.tangent_1 * along_1 + frame.tangent_2 * along_2);
    }
    if (resists_turning(batch)) apply_turning(v, m, quantity_3(batch, BatchHead::turning));
    v.put_back(batch, sweep);
}

// How the point moved since it was found (as contact.cpp: motion_of): on a round body only the tilt counts.
EMBODY_WIDE_INLINE Wide3 motion_of(const Wide row[row_floats], const Wide3& arm, WideMask is_round) {
    const Wide3 turn{row[3], row[4], row[5]};
    const Wide w = row[6], two = broadcast(2);
    const Wide3 by_tilt = cross(turn, arm) * two;
    const Wide3 by_turn = by_tilt * w + cross(turn, by_tilt);
    return Wide3{row[0], row[1], row[2]} + select(is_round, by_tilt, by_turn);
}

void separate(float* batch, int points, const ContactSweep& sweep) {
    Wide a[row_floats], b[row_floats];
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_a), a);
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_b), b);
    const WideMask round_a = load_mask(batch + BatchHead::round_a * lanes);
    const WideMask round_b = load_mask(batch + BatchHead::round_b * lanes);
    const Wide3 normal = quantity_3(batch, BatchHead::normal);
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const Wide3 move_a = motion_of(a, quantity_3(point, BatchPoint::arm_a), round_a);
        const Wide3 move_b = motion_of(b, quantity_3(point, BatchPoint::arm_b), round_b);
        store(point + BatchPoint::separation * lanes,
              quantity(point, BatchPoint::separation_found) + dot(normal, move_b - move_a));
    }
}

// Coulomb's cone of one point (paper, eq. 7).
EMBODY_WIDE_INLINE void solve_friction(float* point, const Frame& frame, const Inertia& m, Wide mu_static,
                                       Wide mu_dynamic, WideMask is_active, Velocities& v) {
    const Wide zero{};
    const Wide3 arm_a = quantity_3(point, BatchPoint::arm_a), arm_b = quantity_3(point, BatchPoint::arm_b);
    const Wide normal = quantity(point, BatchPoint::impulse_normal);
    const Wide old_1 = quantity(point, BatchPoint::impulse_1), old_2 = quantity(point, BatchPoint::impulse_2);
    const Wide t11 = quantity(point, BatchPoint::tangent_11), t12 = quantity(point, BatchPoint::tangent_12);
    const Wide t22 = quantity(point, BatchPoint::tangent_22);

    // What would stop the point.
    const Wide3 velocity = v.relative(arm_a, arm_b);
    const Wide u1 = quantity(point, BatchPoint::start_speed + 1) + dot(velocity, frame.tangent_1);
    const Wide u2 = quantity(point, BatchPoint::start_speed + 2) + dot(velocity, frame.tangent_2);
    const Wide stop_1 = old_1 - (t11 * u1 + t12 * u2), stop_2 = old_2 - (t12 * u1 + t22 * u2);

    // A sticking point holds up to the static limit; once it slides, it must fall below the dynamic one.
    const WideMask stuck = load_mask(point + BatchPoint::sticks * lanes);
    const Wide limit = select(stuck, mu_static, mu_dynamic) * normal;
    const WideMask holds = stop_1 * stop_1 + stop_2 * stop_2 <= limit * limit;

    // Sliding friction opposes the velocity, not the impulse that would stop it.
    const Wide slide_mass = quantity(point, BatchPoint::slide_mass);
    const Wide slide_1 = old_1 - slide_mass * u1, slide_2 = old_2 - slide_mass * u2;
    const Wide size = square_root(slide_1 * slide_1 + slide_2 * slide_2);
    const Wide share = select(size > zero, mu_dynamic * normal / size, zero);
    Wide new_1 = select(holds, stop_1, slide_1 * share), new_2 = select(holds, stop_2, slide_2 * share);

    // An unloaded point neither sticks nor slides.
    const WideMask idle = ~is_active | ((normal == zero) & (old_1 == zero) & (old_2 == zero));
    new_1 = select(idle, old_1, new_1);
    new_2 = select(idle, old_2, new_2);
    store_mask(point + BatchPoint::sticks * lanes, (idle & stuck) | (~idle & holds));
    store(point + BatchPoint::impulse_1 * lanes, new_1);
    store(point + BatchPoint::impulse_2 * lanes, new_2);
    apply(v, m, arm_a, arm_b, frame.tangent_1 * (new_1 - old_1) + frame.tangent_2 * (new_2 - old_2));
}

/// The two kinds of sweep.
enum class Sweep { positions, velocities };

// Non-penetration of one point (paper, eq. 4).
template <Sweep kind>
EMBODY_WIDE_INLINE void solve_normal(float* point, const Frame& frame, const Inertia& m, const ContactSweep& sweep,
                                     WideMask is_active, Velocities& v) {
    const Wide zero{}, one = broadcast(1);
    const Wide3 arm_a = quantity_3(point, BatchPoint::arm_a), arm_b = quantity_3(point, BatchPoint::arm_b);
    const Wide separation = quantity(point, BatchPoint::separation);
    const Wide mass = quantity(point, BatchPoint::normal_mass), old = quantity(point, BatchPoint::impulse_normal);

    // Apart: the gap may close in this substep. Overlapping: pushed apart, softly, before the drift only.
    const WideMask is_apart = separation > zero;
    Wide bias = select(is_apart, separation / broadcast(sweep.substep), zero), mass_scale = one, leak = zero;
    if constexpr (kind == Sweep::positions) {
        const Wide push = maximum(broadcast(sweep.bias_rate) * separation, broadcast(-sweep.push_speed));
        bias = select(is_apart, bias, push);
        mass_scale = select(is_apart, one, broadcast(sweep.mass_scale));
        leak = select(is_apart, zero, broadcast(sweep.impulse_scale));
    }
    const Wide speed = quantity(point, BatchPoint::start_speed) + dot(v.relative(arm_a, arm_b), frame.normal);
    const Wide wanted = old - mass * mass_scale * (speed + bias) - leak * old;
    const Wide allowed = select(is_active, maximum(wanted, zero), old);
    store(point + BatchPoint::impulse_normal * lanes, allowed);
    apply(v, m, arm_a, arm_b, frame.normal * (allowed - old));
}

// Solves the symmetric system for one vector by its adjugate; 0 where it is singular.
EMBODY_WIDE_INLINE Wide3 solve_symmetric(const WideSymmetric& s, const Wide3& v) {
    const Wide c_xx = s.yy * s.zz - s.yz * s.yz, c_xy = s.xz * s.yz - s.xy * s.zz, c_xz = s.xy * s.yz - s.xz * s.yy;
    const Wide c_yy = s.xx * s.zz - s.xz * s.xz, c_yz = s.xy * s.xz - s.xx * s.yz, c_zz = s.xx * s.yy - s.xy * s.xy;
    const Wide determinant = s.xx * c_xx + s.xy * c_xy + s.xz * c_xz;
    const Wide zero{};
    const Wide inverse = select(determinant > zero, broadcast(1) / determinant, zero);
    const WideSymmetric adjugate{c_xx, c_xy, c_xz, c_yy, c_yz, c_zz};
    return (adjugate * v) * inverse;
}

// Torsion of the patch and rolling resistance: angular impulses bounded by lever arm times normal impulse.
EMBODY_WIDE_INLINE void solve_turning(float* batch, int points, const Frame& frame, const Inertia& m, Velocities& v) {
    const Wide zero{};
    Wide load_sum{};
    for (int k = 0; k < points; ++k) load_sum += quantity(point_of(batch, k), BatchPoint::impulse_normal);
    const Wide torsion_limit = quantity(batch, BatchHead::friction_torsional) * load_sum;
    const Wide rolling_limit = quantity(batch, BatchHead::friction_rolling) * load_sum;
    const Wide3 old = quantity_3(batch, BatchHead::turning);

    // What would stop all relative turning, split along and across the normal, each part bounded.
    const WideSymmetric inverse{m.inertia_a.xx + m.inertia_b.xx, m.inertia_a.xy + m.inertia_b.xy,
                                m.inertia_a.xz + m.inertia_b.xz, m.inertia_a.yy + m.inertia_b.yy,
                                m.inertia_a.yz + m.inertia_b.yz, m.inertia_a.zz + m.inertia_b.zz};
    const Wide3 spin = quantity_3(batch, BatchHead::start_spin) + (v.angular_b() - v.angular_a());
    const Wide3 wanted = old - solve_symmetric(inverse, spin);
    const Wide along = dot(wanted, frame.normal);
    const Wide torsion = minimum(maximum(along, -torsion_limit), torsion_limit);
    const Wide3 across = wanted - frame.normal * along;
    const Wide size = square_root(dot(across, across));
    const Wide share =
        select(size > rolling_limit, rolling_limit / select(size > zero, size, broadcast(1)), broadcast(1));
    const Wide3 now = frame.normal * torsion + across * share;
    store_3(batch + BatchHead::turning * lanes, now);
    apply_turning(v, m, now - old);
}

template <Sweep kind>
EMBODY_WIDE_INLINE void solve(float* batch, int points, const ContactSweep& sweep) {
    const Frame frame = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    const Wide mu_static = quantity(batch, BatchHead::friction_static);
    const Wide mu_dynamic = quantity(batch, BatchHead::friction_dynamic);
    const Wide time = broadcast(sweep.time);
    Velocities v = Velocities::take(batch, sweep);
    const auto is_active = [&](const float* point) { return time > quantity(point, BatchPoint::inactive_until); };

    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        solve_friction(point, frame, m, mu_static, mu_dynamic, is_active(point), v);
    }
    // Non-penetration has the last word. Forwards and backwards: else the last point would win and a flat body lean.
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        solve_normal<kind>(point, frame, m, sweep, is_active(point), v);
    }
    // The way back begins at each contact's last point but one, whatever the batch's other contacts have.
    for (int k = points - 2; k >= 0; --k) {
        float* point = point_of(batch, k);
        const WideMask has_next = quantity(point_of(batch, k + 1), BatchPoint::normal_mass) > Wide{};
        solve_normal<kind>(point, frame, m, sweep, is_active(point) & has_next, v);
    }
    if (resists_turning(batch)) solve_turning(batch, points, frame, m, v);
    v.put_back(batch, sweep);
}

void solve_positions(float* batch, int points, const ContactSweep& sweep) {
    solve<Sweep::positions>(batch, points, sweep);
}
EMBODY_WIDE_INLINE void add_to_totals(float* batch, int points) {
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        for (int i = 0; i < 3; ++i) {
            float* total = point + (BatchPoint::total_normal + i) * lanes;
            store(total, load(total) + quantity(point, BatchPoint::impulse_normal + i));
        }
    }
}

void solve_velocities(float* batch, int points, const ContactSweep& sweep) {
    if (sweep.is_first) separate(batch, points, sweep);
    solve<Sweep::velocities>(batch, points, sweep);
    if (sweep.is_last) add_to_totals(batch, points);
}

// Rows of one body are eight numbers that are all treated alike; whatever the width, they are done in fours.
using Half = float __attribute__((vector_size(16)));
EMBODY_WIDE_INLINE Half load_half(const float* from) {
    Half value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

void kick(const BodyRows& rows, std::int32_t first, std::int32_t last) {
    for (std::int32_t i = first * row_floats; i < last * row_floats; i += 4) {
        const Half v = load_half(rows.velocity + i) * load_half(rows.damping + i) + load_half(rows.kick + i);
        std::memcpy(rows.velocity + i, &v, sizeof v);
        std::memcpy(rows.kicked + i, &v, sizeof v);
    }
}

void drift(const BodyRows& rows, float substep, std::int32_t first, std::int32_t last) {
    const Wide h = broadcast(substep), half = broadcast(0.5F), zero{};
    for (std::int32_t next = first; next < last; next += lanes) {
        // The last rows may be fewer than the lanes: the others repeat the last one and are not written.
        std::int32_t row[lanes];
        std::uint32_t writable = 0;
        for (int i = 0; i < lanes; ++i) {
            row[i] = next + i < last ? next + i : last - 1;
            writable |= (next + i < last ? 1u : 0u) << i;
        }
        Wide v[row_floats], x[row_floats], kicked[row_floats], kick_row[row_floats], start_row[row_floats];
        gather_rows(rows.velocity, row, v);
        gather_rows(rows.motion, row, x);
        gather_rows(rows.kicked, row, kicked);
        gather_rows(rows.kick, row, kick_row);
        gather_rows(rows.start, row, start_row);

        // A body near others that nothing touched: its mean velocity lies half a kick behind.
        const WideMask is_free = (v[0] == kicked[0]) & (v[1] == kicked[1]) & (v[2] == kicked[2]);
        const Wide behind = select(is_free, half * h, zero);
        for (int i = 0; i < 3; ++i) x[i] += (start_row[i] + v[i]) * h - kick_row[i] * behind;

        // q ← cay(ωh) q, normalised (equations_of_motion.h).
        const Wide half_h = half * h;
        const Wide3 p{(start_row[3] + v[3]) * half_h, (start_row[4] + v[4]) * half_h, (start_row[5] + v[5]) * half_h};
        const Wide3 q{x[3], x[4], x[5]};
        const Wide w = x[6];
        const Wide3 turned = q + p * w + cross(p, q);
        const Wide new_w = w - dot(p, q);
        const Wide scale = broadcast(1) / square_root(dot(turned, turned) + new_w * new_w);
        x[3] = turned.x * scale;
        x[4] = turned.y * scale;
        x[5] = turned.z * scale;
        x[6] = new_w * scale;
        scatter_rows(rows.motion, row, writable, x);
    }
}

}  // namespace

extern const physics::ContactKernels kernels;
const physics::ContactKernels kernels{lanes,    prepare,          warm_start, solve_positions,
                                      separate, solve_velocities, kick,       drift};

}  // namespace embody::EMBODY_WIDE
