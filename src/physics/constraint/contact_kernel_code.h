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

// Paper, eq. (6): an impulse and an angular impulse on b, their opposites on a.
EMBODY_WIDE_INLINE void apply(Velocities& v, const Inertia& m, const Wide3& arm_a, const Wide3& arm_b,
                              const Wide3& impulse, const Wide3& moment) {
    const Wide3 turn_a = m.inertia_a * (cross(arm_a, impulse) + moment);
    const Wide3 turn_b = m.inertia_b * (cross(arm_b, impulse) + moment);
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

EMBODY_WIDE_INLINE float* point_of(float* batch, int k) {
    return batch + (BatchHead::size + k * BatchPoint::size) * lanes;
}
EMBODY_WIDE_INLINE Wide quantity(const float* part, int which) { return load(part + which * lanes); }
EMBODY_WIDE_INLINE Wide3 quantity_3(const float* part, int which) { return load_3(part + which * lanes); }

/// Where a region lies: its axes and the arms to its anchor.
struct Frame {
    Wide3 normal, tangent_1, tangent_2, arm_a, arm_b;
    EMBODY_WIDE_INLINE Frame of(const float* batch) {
        return {quantity_3(batch, BatchHead::normal), quantity_3(batch, BatchHead::tangent_1),
                quantity_3(batch, BatchHead::tangent_2), quantity_3(batch, BatchHead::arm_a),
                quantity_3(batch, BatchHead::arm_b)};
    }
};

EMBODY_WIDE_INLINE bool resists_rolling(const float* batch) {
    return Velocities::rows_of(batch, BatchHead::writable)[2] != 0;
}

// Inverse of what is large enough to have one, else 0.
EMBODY_WIDE_INLINE Wide inverse(Wide number) {
    return select(number > broadcast(1e-30F), broadcast(1) / number, Wide{});
}
// By the adjugate; 0 where it is singular.
EMBODY_WIDE_INLINE WideSymmetric inverse(const WideSymmetric& s) {
    const Wide c_xx = s.yy * s.zz - s.yz * s.yz, c_xy = s.xz * s.yz - s.xy * s.zz, c_xz = s.xy * s.yz - s.xz * s.yy;
    const Wide c_yy = s.xx * s.zz - s.xz * s.xz, c_yz = s.xy * s.xz - s.xx * s.yz, c_zz = s.xx * s.yy - s.xy * s.xy;
    const Wide scale = inverse(s.xx * c_xx + s.xy * c_xy + s.xz * c_xz);
    return {c_xx * scale, c_xy * scale, c_xz * scale, c_yy * scale, c_yz * scale, c_zz * scale};
}

/// What impulses at the anchor do to the motion there.
struct Response {
    const Inertia& m;
    const Frame& frame;

    // dᵀ A e: velocity along d by a force along e.
    [[gnu::always_inline]] inline Wide shift(const Wide3& d, const Wide3& e) const {
        return (m.mass_a + m.mass_b) * dot(d, e) + dot(cross(frame.arm_a, d), m.inertia_a * cross(frame.arm_a, e)) +
               dot(cross(frame.arm_b, d), m.inertia_b * cross(frame.arm_b, e));
    }
    // Velocity along d by a moment about the axis.
    [[gnu::always_inline]] inline Wide mixed(const Wide3& d, const Wide3& axis) const {
        return dot(cross(frame.arm_a, d), m.inertia_a * axis) + dot(cross(frame.arm_b, d), m.inertia_b * axis);
    }
    // Spin about d by a moment about e.
    [[gnu::always_inline]] inline Wide spin(const Wide3& d, const Wide3& e) const {
        return dot(d, m.inertia_a * e) + dot(d, m.inertia_b * e);
    }
};

// A_ij and the mass of each point.
EMBODY_WIDE_INLINE void prepare_normals(float* batch, int points, const Response& response, const Frame& f) {
    const WideSymmetric k{response.shift(f.normal, f.normal),      response.mixed(f.normal, f.tangent_1),
                          response.mixed(f.normal, f.tangent_2),   response.spin(f.tangent_1, f.tangent_1),
                          response.spin(f.tangent_1, f.tangent_2), response.spin(f.tangent_2, f.tangent_2)};
    float* coupling = batch + BatchHead::coupling * lanes;
    for (int i = 0; i < points; ++i) {
        float* point = point_of(batch, i);
        const Wide3 row{broadcast(1), quantity(point, BatchPoint::along_2), -quantity(point, BatchPoint::along_1)};
        const Wide3 by_row = k * row;

        // Lanes without this point hold 0 there; the others 1.
        const WideMask exists = quantity(point, BatchPoint::normal_mass) > Wide{};
        const Wide own = dot(row, by_row);
        store(point + BatchPoint::normal_response * lanes, own);
        store(point + BatchPoint::normal_mass * lanes, select(exists, inverse(own), Wide{}));
        for (int j = i + 1; j < points; ++j) {
            const float* other = point_of(batch, j);
            const Wide3 column{broadcast(1), quantity(other, BatchPoint::along_2),
                               -quantity(other, BatchPoint::along_1)};
            const int place = i == 0 ? j - 1 : i + j;
            store(coupling + place * lanes, dot(column, by_row));
        }
    }
}

void prepare(float* batch, int points) {
    const Frame f = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    const Response response{m, f};
    prepare_normals(batch, points, response, f);

    // What stops the anchor's shift, with and without the spin.
    const Wide k11 = response.shift(f.tangent_1, f.tangent_1), k12 = response.shift(f.tangent_1, f.tangent_2);
    const Wide k22 = response.shift(f.tangent_2, f.tangent_2), k33 = response.spin(f.normal, f.normal);
    const Wide scale = inverse(k11 * k22 - k12 * k12);
    const Wide s11 = k22 * scale, s12 = -k12 * scale, s22 = k11 * scale;
    store_3(batch + BatchHead::stop_shift * lanes, {s11, s12, s22});
    const WideSymmetric all = inverse(WideSymmetric{k11, k12, response.mixed(f.tangent_1, f.normal), k22,
                                                    response.mixed(f.tangent_2, f.normal), k33});

    // Where neither body can spin the shift is all there is.
    const WideMask spins = all.xx > Wide{};
    store_3(batch + BatchHead::stop_all * lanes, {select(spins, all.xx, s11), select(spins, all.xy, s12), all.xz});
    store_3(batch + (BatchHead::stop_all + 3) * lanes, {select(spins, all.yy, s22), all.yz, all.zz});
    const Wide split = square_root((k11 - k22) * (k11 - k22) + broadcast(4) * k12 * k12);
    store(batch + BatchHead::shift_response * lanes, (k11 + k22 + split) * broadcast(0.5F));
    store(batch + BatchHead::twist_response * lanes, k33);
}

// Force and moments of the points' normal impulses at the anchor.
struct NormalLoad {
    Wide force{}, moment_1{}, moment_2{};
    [[gnu::always_inline]] inline void add(const float* point, Wide impulse) {
        force += impulse;
        moment_1 += quantity(point, BatchPoint::along_2) * impulse;
        moment_2 -= quantity(point, BatchPoint::along_1) * impulse;
    }
};

void warm_start(float* batch, int points, const ContactSweep& sweep) {
    const Frame f = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    const Wide zero{}, time = broadcast(sweep.time);
    Velocities v = Velocities::take(batch, sweep);
    NormalLoad load;
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const WideMask is_active = time > quantity(point, BatchPoint::inactive_until);
        const Wide impulse = select(is_active, quantity(point, BatchPoint::impulse), zero);
        store(point + BatchPoint::impulse * lanes, impulse);
        load.add(point, impulse);
    }

    // Friction goes with its load.
    const WideMask is_loaded = load.force > zero;
    const auto keep = [&](int which) {
        const Wide kept = select(is_loaded, quantity(batch, which), zero);
        store(batch + which * lanes, kept);
        return kept;
    };
    const Wide along_1 = keep(BatchHead::friction), along_2 = keep(BatchHead::friction + 1);
    const Wide twist = keep(BatchHead::friction + 2);
    Wide3 moment = f.tangent_1 * load.moment_1 + f.tangent_2 * load.moment_2 + f.normal * twist;
    if (resists_rolling(batch)) {
        moment = moment + Wide3{keep(BatchHead::rolling), keep(BatchHead::rolling + 1), keep(BatchHead::rolling + 2)};
    }
    apply(v, m, f.arm_a, f.arm_b, f.normal * load.force + f.tangent_1 * along_1 + f.tangent_2 * along_2, moment);
    v.put_back(batch, sweep);
}

// What a body's turn since the step began adds to an arm (as contact.cpp: motion_of): on a round body only the tilt
// counts.
EMBODY_WIDE_INLINE Wide3 turn_of(const Wide row[row_floats], const Wide3& arm, WideMask is_round) {
    const Wide3 turn{row[3], row[4], row[5]};
    const Wide w = row[6], two = broadcast(2);
    const Wide3 by_tilt = cross(turn, arm) * two;
    const Wide3 by_turn = by_tilt * w + cross(turn, by_tilt);
    return select(is_round, by_tilt, by_turn);
}

void separate(float* batch, int points, const ContactSweep& sweep) {
    Wide a[row_floats], b[row_floats];
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_a), a);
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_b), b);
    const WideMask round_a = load_mask(batch + BatchHead::round_a * lanes);
    const WideMask round_b = load_mask(batch + BatchHead::round_b * lanes);
    const Frame f = Frame::of(batch);

    // The gap changes linearly over the region: at the anchor, and a metre along each tangent.
    const Wide3 shift =
        Wide3{b[0] - a[0], b[1] - a[1], b[2] - a[2]} + turn_of(b, f.arm_b, round_b) - turn_of(a, f.arm_a, round_a);
    const Wide middle = dot(f.normal, shift);
    const auto tilt = [&](const Wide3& tangent) {
        return dot(f.normal, turn_of(b, tangent, round_b) - turn_of(a, tangent, round_a));
    };
    const Wide tilt_1 = points > 1 ? tilt(f.tangent_1) : Wide{}, tilt_2 = points > 1 ? tilt(f.tangent_2) : Wide{};
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const Wide change =
            middle + (tilt_1 * quantity(point, BatchPoint::along_1) + tilt_2 * quantity(point, BatchPoint::along_2));
        store(point + BatchPoint::separation * lanes, quantity(point, BatchPoint::separation_found) + change);
    }
}

/// Change of the relative motion at the anchor since the step began.
struct RelativeMotion {
    Wide3 velocity, spin;
    EMBODY_WIDE_INLINE RelativeMotion of(const Velocities& v, const Frame& f) {
        const Wide3 spin_a = v.angular_a(), spin_b = v.angular_b();
        return {v.linear_b() + cross(spin_b, f.arm_b) - (v.linear_a() + cross(spin_a, f.arm_a)), spin_b - spin_a};
    }
};

/// Where the load of a region presses and how far from there on average.
struct Pressure {
    Wide along_1{}, along_2{}, lever{}, load{};
};
EMBODY_WIDE_INLINE Pressure pressure_of(float* batch, int points) {
    Pressure p;
    for (int k = 0; k < points; ++k) {
        const float* point = point_of(batch, k);
        const Wide impulse = quantity(point, BatchPoint::impulse);
        p.load += impulse;
        p.along_1 += quantity(point, BatchPoint::along_1) * impulse;
        p.along_2 += quantity(point, BatchPoint::along_2) * impulse;
    }
    if (points == 1) return {Wide{}, Wide{}, Wide{}, p.load};
    const Wide scale = inverse(p.load);
    p.along_1 *= scale;
    p.along_2 *= scale;
    for (int k = 0; k < points; ++k) {
        const float* point = point_of(batch, k);
        const Wide x = quantity(point, BatchPoint::along_1) - p.along_1;
        const Wide y = quantity(point, BatchPoint::along_2) - p.along_2;
        p.lever += quantity(point, BatchPoint::impulse) * square_root(x * x + y * y);
    }
    p.lever *= scale;
    return p;
}

/// The bounds of friction and their inverses: an ellipsoid of force and moment.
struct FrictionLimit {
    Wide force, moment;
    EMBODY_WIDE_INLINE FrictionLimit of(Wide mu, Wide torsional, const Pressure& p) {
        return {mu * p.load, (mu * p.lever + torsional) * p.load};
    }
    // Above 1 outside. Where there is no bound there must be nothing.
    [[gnu::always_inline]] inline Wide excess(const Wide3& f) const {
        const Wide by_force = inverse(force);
        const Wide x = f.x * by_force, y = f.y * by_force, z = f.z * inverse(moment);
        return x * x + y * y + z * z;
    }
};

// Coulomb's law of the whole region (paper, eq. 7; contact_solver.cpp). Friction is (tangent 1, tangent 2, moment), the
// moment about the centre of pressure.
EMBODY_WIDE_INLINE void solve_friction(float* batch, int points, const Frame& f, const Inertia& m, Velocities& v) {
    const Wide zero{}, one = broadcast(1);
    const Pressure p = pressure_of(batch, points);
    const Wide3 old = quantity_3(batch, BatchHead::friction);
    const auto about_center = [&](const Wide3& w) {
        return points == 1 ? w : Wide3{w.x, w.y, w.z - (p.along_1 * w.y - p.along_2 * w.x)};
    };
    const RelativeMotion motion = RelativeMotion::of(v, f);
    const float* start = batch + BatchHead::start_speed * lanes;
    const Wide u1 = quantity(start, 1) + dot(motion.velocity, f.tangent_1);
    const Wide u2 = quantity(start, 2) + dot(motion.velocity, f.tangent_2);
    const Wide spin = quantity(batch, BatchHead::start_spin + 2) + dot(motion.spin, f.normal);

    // What would stop the region; a sticking one holds up to the static limit. Without a lever the spin is free.
    const Wide mu_static = quantity(batch, BatchHead::friction_static);
    const Wide mu_dynamic = quantity(batch, BatchHead::friction_dynamic);
    const Wide torsional = quantity(batch, BatchHead::friction_torsional);
    const WideMask stuck = load_mask(batch + BatchHead::sticks * lanes);
    const FrictionLimit hold = FrictionLimit::of(select(stuck, mu_static, mu_dynamic), torsional, p);
    const WideSymmetric all = Inertia::load_symmetric(batch + BatchHead::stop_all * lanes);
    const Wide3 shift = quantity_3(batch, BatchHead::stop_shift);
    const WideMask has_lever = hold.moment > zero;
    const Wide3 stop_all = all * Wide3{u1, u2, spin};
    const Wide3 stop_shift{shift.x * u1 + shift.y * u2, shift.y * u1 + shift.z * u2, zero};
    Wide3 stop = about_center(old - select(has_lever, stop_all, stop_shift));
    stop.z = select(has_lever, stop.z, zero);
    const WideMask holds = (hold.force > zero) & (hold.excess(stop) <= one);

    // Sliding: opposite to the motion of the centre of pressure, in the metric of the ellipsoid.
    const FrictionLimit slide = FrictionLimit::of(mu_dynamic, torsional, p);
    const Wide lever = slide.moment * inverse(slide.force);
    const Wide twist_response = quantity(batch, BatchHead::twist_response);
    const Wide mass = inverse(quantity(batch, BatchHead::shift_response) + lever * lever * twist_response);
    const Wide twist_mass = select(lever > zero, mass * lever * lever, inverse(twist_response));
    const Wide3 before = about_center(old);
    Wide3 slid{before.x - mass * (u1 - spin * p.along_2), before.y - mass * (u2 + spin * p.along_1),
               before.z - twist_mass * spin};
    const WideMask has_force = slide.force > zero, has_moment = slide.moment > zero;
    slid = {select(has_force, slid.x, zero), select(has_force, slid.y, zero), select(has_moment, slid.z, zero)};
    const Wide beyond = slide.excess(slid);
    slid = slid * select(beyond > one, one / square_root(maximum(beyond, one)), one);

    // An unloaded region neither sticks nor slides.
    const WideMask idle = (p.load == zero) & (old.x == zero) & (old.y == zero) & (old.z == zero);
    Wide3 now = select(holds, stop, slid);
    if (points > 1) now.z += p.along_1 * now.y - p.along_2 * now.x;
    now = select(idle, old, now);
    store_mask(batch + BatchHead::sticks * lanes, (idle & stuck) | (~idle & holds));
    store_3(batch + BatchHead::friction * lanes, now);
    const Wide3 change = now - old;
    apply(v, m, f.arm_a, f.arm_b, f.tangent_1 * change.x + f.tangent_2 * change.y, f.normal * change.z);
}

/// The two kinds of sweep.
enum class Sweep { positions, velocities };

// Non-penetration of all points of a region (paper, eq. 4).
template <Sweep kind, int points>
EMBODY_WIDE_INLINE void solve_normals(float* batch, const Frame& f, const Inertia& m, const ContactSweep& sweep,
                                      Velocities& v) {
    const Wide zero{}, one = broadcast(1), time = broadcast(sweep.time);
    const RelativeMotion motion = RelativeMotion::of(v, f);
    const float* start = batch + BatchHead::start_speed * lanes;
    const float* spin = batch + BatchHead::start_spin * lanes;
    const Wide middle = quantity(start, 0) + dot(motion.velocity, f.normal);
    const Wide tilt_1 = quantity(spin, 0) + dot(motion.spin, f.tangent_1);
    const Wide tilt_2 = quantity(spin, 1) + dot(motion.spin, f.tangent_2);

    // Speed and target of each point. Apart: the gap may close in this substep. Overlapping: pushed apart, softly,
    // before the drift only.
    Wide speed[points], mass[points], leak[points], impulse[points];
    WideMask is_active[points];
    for (int k = 0; k < points; ++k) {
        const float* point = point_of(batch, k);
        const Wide separation = quantity(point, BatchPoint::separation);
        const WideMask is_apart = separation > zero;
        Wide bias = select(is_apart, separation / broadcast(sweep.substep), zero);
        mass[k] = quantity(point, BatchPoint::normal_mass);
        leak[k] = zero;
        if constexpr (kind == Sweep::positions) {
            const Wide push = maximum(broadcast(sweep.bias_rate) * separation, broadcast(-sweep.push_speed));
            bias = select(is_apart, bias, push);
            mass[k] *= select(is_apart, one, broadcast(sweep.mass_scale));
            leak[k] = select(is_apart, zero, broadcast(sweep.impulse_scale));
        }
        speed[k] = middle +
                   (quantity(point, BatchPoint::along_2) * tilt_1 - quantity(point, BatchPoint::along_1) * tilt_2) +
                   bias;
        impulse[k] = quantity(point, BatchPoint::impulse);
        is_active[k] = time > quantity(point, BatchPoint::inactive_until);
    }

    // Forwards and backwards: else the last point would win and a flat body lean.
    Wide coupling[6];
    if constexpr (points > 1) {
        for (int i = 0; i < 6; ++i) coupling[i] = quantity(batch, BatchHead::coupling + i);
    }
    const auto solve_point = [&](int k, WideMask is_wanted) __attribute__((always_inline)) {
        const Wide wanted = impulse[k] - mass[k] * speed[k] - leak[k] * impulse[k];
        const Wide allowed = select(is_wanted, maximum(wanted, zero), impulse[k]);
        const Wide change = allowed - impulse[k];
        impulse[k] = allowed;
        for (int j = 0; j < points; ++j) {
            const int low = j < k ? j : k, high = j < k ? k : j;
            if (j != k) speed[j] += coupling[low == 0 ? high - 1 : low + high] * change;
        }
        speed[k] += quantity(point_of(batch, k), BatchPoint::normal_response) * change;
    };
    for (int round = 0; round < physics::normal_rounds; ++round) {
        for (int k = 0; k < points; ++k) solve_point(k, is_active[k]);
        // The way back begins at each contact's last point but one, whatever the batch's other contacts have.
        for (int k = points - 2; k >= 0; --k) solve_point(k, is_active[k] & (mass[k + 1] > zero));
    }

    NormalLoad change;
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        change.add(point, impulse[k] - quantity(point, BatchPoint::impulse));
        store(point + BatchPoint::impulse * lanes, impulse[k]);
    }
    apply(v, m, f.arm_a, f.arm_b, f.normal * change.force,
          f.tangent_1 * change.moment_1 + f.tangent_2 * change.moment_2);
}

// Rolling resistance: a moment across the normal, bounded by lever arm times normal impulse.
EMBODY_WIDE_INLINE void solve_rolling(float* batch, int points, const Frame& f, const Inertia& m, Velocities& v) {
    const Wide zero{}, one = broadcast(1);
    Wide load{};
    for (int k = 0; k < points; ++k) load += quantity(point_of(batch, k), BatchPoint::impulse);
    const Wide limit = quantity(batch, BatchHead::friction_rolling) * load;
    const Wide3 old = quantity_3(batch, BatchHead::rolling);

    // What would stop the rolling, bounded.
    const WideSymmetric stop = inverse(WideSymmetric{m.inertia_a.xx + m.inertia_b.xx, m.inertia_a.xy + m.inertia_b.xy,
                                                     m.inertia_a.xz + m.inertia_b.xz, m.inertia_a.yy + m.inertia_b.yy,
                                                     m.inertia_a.yz + m.inertia_b.yz, m.inertia_a.zz + m.inertia_b.zz});
    const RelativeMotion motion = RelativeMotion::of(v, f);
    const Wide3 start = quantity_3(batch, BatchHead::start_spin);
    const Wide3 spin = f.tangent_1 * (start.x + dot(motion.spin, f.tangent_1)) +
                       f.tangent_2 * (start.y + dot(motion.spin, f.tangent_2));
    Wide3 now = old - stop * spin;
    now = now - f.normal * dot(now, f.normal);
    const Wide size = square_root(dot(now, now));
    now = now * select(size > limit, limit / select(size > zero, size, one), one);
    store_3(batch + BatchHead::rolling * lanes, now);
    const Wide3 none{zero, zero, zero};
    apply(v, m, f.arm_a, f.arm_b, none, now - old);
}

template <Sweep kind, int points>
EMBODY_WIDE_INLINE void solve_region(float* batch, const ContactSweep& sweep) {
    const Frame f = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    Velocities v = Velocities::take(batch, sweep);
    // Non-penetration has the last word but for what resists rolling.
    solve_friction(batch, points, f, m, v);
    solve_normals<kind, points>(batch, f, m, sweep, v);
    if (resists_rolling(batch)) solve_rolling(batch, points, f, m, v);
    v.put_back(batch, sweep);
}

template <Sweep kind>
EMBODY_WIDE_INLINE void solve(float* batch, int points, const ContactSweep& sweep) {
    switch (points) {
        case 1:
            return solve_region<kind, 1>(batch, sweep);
        case 2:
            return solve_region<kind, 2>(batch, sweep);
        case 3:
            return solve_region<kind, 3>(batch, sweep);
        default:
            return solve_region<kind, 4>(batch, sweep);
    }
}

void solve_positions(float* batch, int points, const ContactSweep& sweep) {
    solve<Sweep::positions>(batch, points, sweep);
}

EMBODY_WIDE_INLINE void add_to_total(float* total, const float* impulse) { store(total, load(total) + load(impulse)); }
EMBODY_WIDE_INLINE void add_to_totals(float* batch, int points) {
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        add_to_total(point + BatchPoint::total * lanes, point + BatchPoint::impulse * lanes);
    }
    for (int i = 0; i < 3; ++i) {
        add_to_total(batch + (BatchHead::friction_total + i) * lanes, batch + (BatchHead::friction + i) * lanes);
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
        // What the contacts added in the last substep is the first guess for this one.
        const Half before = load_half(rows.velocity + i), by_contacts = before - load_half(rows.kicked + i);
        const Half kicked = before * load_half(rows.damping + i) + load_half(rows.kick + i), v = kicked + by_contacts;
        std::memcpy(rows.kicked + i, &kicked, sizeof kicked);
        std::memcpy(rows.velocity + i, &v, sizeof v);
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
