// SPDX-License-Identifier: MIT
//
// The contact solver on EMBODY_LANES contacts at once. Equations and sources: contact_solver.cpp; why in this shape:
// docs/physics/wide-solver.md. Included once by each of contact_kernel_4.cpp, _8.cpp and _16.cpp.
#include "math/wide.h"
#include "physics/constraint/sweeps/contact_batch.h"
#include "physics/constraint/sweeps/contact_kernel_fill.h"

namespace embody::EMBODY_WIDE {
namespace {

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

// m = Rᵀn − n, with m·r what a body's turn R since the step began adds to n·r of an arm r. On a round body only the
// tilt counts (as contact.cpp: motion_of).
EMBODY_WIDE_INLINE Wide3 turned_back(const Wide row[row_floats], const Wide3& n, WideMask is_round) {
    const Wide3 turn{row[3], row[4], row[5]};
    const Wide w = row[6], two = broadcast(2);
    const Wide3 by_tilt = cross(n, turn) * two;
    const Wide3 by_turn = by_tilt * w + cross(by_tilt, turn);
    return select(is_round, by_tilt, by_turn);
}

// The axes of two balls that moved by so much relative to each other turn with the line of their centres, and the
// tangents as little as they can; returns the change of the gap. Frozen for the step, the planes between grains that
// pass each other would stand in the way: docs/physics/grains.md.
EMBODY_WIDE_INLINE Wide turn_frame(float* batch, const Wide3& moved, WideMask turns, const ContactSweep& sweep) {
    const Wide zero{}, half = broadcast(0.5F), min_across = broadcast(0.01F);  // squared: below it, a direction is none
    const Frame old = Frame::of(batch);
    const Wide3 found = quantity_3(batch, BatchHead::apart), apart = found + moved;
    const Wide distance_found = square_root(dot(found, found)), distance = square_root(dot(apart, apart));
    turns &= distance > zero;
    const Wide3 n = apart * inverse(distance);
    const Wide3 across_1 = old.tangent_1 - n * dot(old.tangent_1, n),
                across_2 = old.tangent_2 - n * dot(old.tangent_2, n);
    const Wide3 across = select(dot(across_1, across_1) > min_across, across_1, across_2);
    const Wide3 tangent = across * inverse(square_root(dot(across, across)));

    // |c + d| − |c| without the digits that a difference of lengths would lose.
    const Wide opening = dot(found + apart, moved) * inverse(distance_found + distance);
    const Wide reach_a = dot(old.arm_a, old.normal), old_distance = reach_a - dot(old.arm_b, old.normal);
    const Wide3 arm_a = n * (reach_a + (distance - old_distance) * half);
    const Frame f{select(turns, n, old.normal), select(turns, tangent, old.tangent_1),
                  select(turns, cross(n, tangent), old.tangent_2), select(turns, arm_a, old.arm_a),
                  select(turns, arm_a - apart, old.arm_b)};
    store_3(batch + BatchHead::normal * lanes, f.normal);
    store_3(batch + BatchHead::tangent_1 * lanes, f.tangent_1);
    store_3(batch + BatchHead::tangent_2 * lanes, f.tangent_2);
    store_3(batch + BatchHead::arm_a * lanes, f.arm_a);
    store_3(batch + BatchHead::arm_b * lanes, f.arm_b);
    fill_start_motion(batch, sweep.start, f);
    return opening;
}

// What the contact did in this substep along its old axes it did along the new ones: so the bodies have the impulses
// that the batch holds.
EMBODY_WIDE_INLINE void turn_impulses(float* batch, const Frame& old, const ContactSweep& sweep) {
    const Wide3 friction = quantity_3(batch, BatchHead::friction);
    const Wide load = quantity(point_of(batch, 0), BatchPoint::impulse);
    const WideMask changes = load_mask(batch + BatchHead::turns * lanes) & (load > Wide{});
    if (!any(changes)) return;
    const Inertia m = Inertia::of(batch);
    const Velocities before = Velocities::take(batch, sweep);
    Velocities v = before;
    const auto add = [&](const Frame& f, const Wide3& by, Wide along) {
        apply(v, m, f.arm_a, f.arm_b, f.normal * along + f.tangent_1 * by.x + f.tangent_2 * by.y, f.normal * by.z);
    };
    add(old, friction * broadcast(-1), -load);
    add(Frame::of(batch), friction, load);
    for (int i = 0; i < row_floats; ++i) {
        v.a[i] = select(changes, v.a[i], before.a[i]);
        v.b[i] = select(changes, v.b[i], before.b[i]);
    }
    v.put_back(batch, sweep);
}

void separate(float* batch, int points, const ContactSweep& sweep) {
    Wide a[row_floats], b[row_floats];
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_a), a);
    gather_rows(sweep.motion, Velocities::rows_of(batch, BatchHead::body_b), b);
    const Wide3 n = quantity_3(batch, BatchHead::normal);
    const Wide3 by_arm_a = turned_back(a, n, load_mask(batch + BatchHead::round_a * lanes));
    const Wide3 by_arm_b = turned_back(b, n, load_mask(batch + BatchHead::round_b * lanes));

    // The gap changes linearly over the region: at the anchor, and a metre along each tangent.
    const Wide3 by_place = by_arm_b - by_arm_a;
    const Wide middle =
        dot(n, Wide3{b[0] - a[0], b[1] - a[1], b[2] - a[2]}) +
        (dot(by_arm_b, quantity_3(batch, BatchHead::arm_b)) - dot(by_arm_a, quantity_3(batch, BatchHead::arm_a)));
    const Wide tilt_1 = dot(by_place, quantity_3(batch, BatchHead::tangent_1));
    const Wide tilt_2 = dot(by_place, quantity_3(batch, BatchHead::tangent_2));
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        const Wide change =
            middle + (tilt_1 * quantity(point, BatchPoint::along_1) + tilt_2 * quantity(point, BatchPoint::along_2));
        store(point + BatchPoint::separation * lanes, quantity(point, BatchPoint::separation_found) + change);
    }

    const WideMask turns = load_mask(batch + BatchHead::turns * lanes);
    if (!any(turns)) return;
    const Wide opening = turn_frame(batch, {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, turns, sweep);
    float* point = point_of(batch, 0);
    const Wide gap = quantity(point, BatchPoint::separation);
    store(point + BatchPoint::separation * lanes,
          select(turns, quantity(point, BatchPoint::separation_found) + opening, gap));
}

/// Motion of b relative to a at the anchor, in the axes of the region.
struct RegionMotion {
    Wide3 velocity;  // along normal, tangent 1, tangent 2
    Wide3 spin;      // about tangent 1, tangent 2, normal
    EMBODY_WIDE_INLINE RegionMotion of(const float* batch, const Velocities& v, const Frame& f) {
        const Wide3 start_speed = quantity_3(batch, BatchHead::start_speed);
        const Wide3 start_spin = quantity_3(batch, BatchHead::start_spin);
        const Wide3 velocity = v.relative(f.arm_a, f.arm_b), spin = v.angular_b() - v.angular_a();
        return {{start_speed.x + dot(velocity, f.normal), start_speed.y + dot(velocity, f.tangent_1),
                 start_speed.z + dot(velocity, f.tangent_2)},
                {start_spin.x + dot(spin, f.tangent_1), start_spin.y + dot(spin, f.tangent_2),
                 start_spin.z + dot(spin, f.normal)}};
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

/// The bounds of friction: forces f and moments τ with (|f| r)² + τ² <= (F r)². Without a lever r there is no moment to
/// bound, and any r is right.
struct FrictionLimit {
    Wide force, lever;
    EMBODY_WIDE_INLINE FrictionLimit of(Wide force, Wide lever) {
        return {force, select(lever > Wide{}, lever, broadcast(1))};
    }
    [[gnu::always_inline]] inline Wide bound() const { return force * lever; }
    [[gnu::always_inline]] inline Wide squared(const Wide3& f) const {
        return (f.x * f.x + f.y * f.y) * (lever * lever) + f.z * f.z;
    }
};

// Coulomb's law of the whole region (paper, eq. 7; contact_solver.cpp). Friction is (tangent 1, tangent 2, moment), the
// moment about the centre of pressure; returns its change, the moment about the anchor.
EMBODY_WIDE_INLINE Wide3 solve_friction(float* batch, int points, const RegionMotion& motion) {
    const Wide zero{}, one = broadcast(1);
    const Pressure p = pressure_of(batch, points);
    const Wide3 old = quantity_3(batch, BatchHead::friction);
    const auto about_center = [&](const Wide3& w) {
        return points == 1 ? w : Wide3{w.x, w.y, w.z - (p.along_1 * w.y - p.along_2 * w.x)};
    };
    const Wide u1 = motion.velocity.y, u2 = motion.velocity.z, spin = motion.spin.z;

    // What would stop the region; a sticking one holds up to the static limit. Without a lever the spin is free.
    const Wide mu_dynamic = quantity(batch, BatchHead::friction_dynamic);
    const Wide torsion_dynamic = quantity(batch, BatchHead::torsion_dynamic);
    const WideMask stuck = load_mask(batch + BatchHead::sticks * lanes);
    const Wide hold_lever = p.lever + select(stuck, quantity(batch, BatchHead::torsion_static), torsion_dynamic);
    const Wide hold_force = select(stuck, quantity(batch, BatchHead::friction_static), mu_dynamic) * p.load;
    const FrictionLimit hold = FrictionLimit::of(hold_force, hold_lever);
    const WideSymmetric stops = Inertia::load_symmetric(batch + BatchHead::stop * lanes);
    const WideMask has_lever = hold_force * hold_lever > zero;
    Wide3 stop = about_center(old - stops * Wide3{u1, u2, spin});
    stop.z = select(has_lever, stop.z, zero);
    const Wide most = hold.bound();
    const WideMask holds = (hold_force > zero) & (hold.squared(stop) <= most * most);

    // Sliding: opposite to the motion of the centre of pressure, in the metric of the ellipsoid.
    const Wide lever = p.lever + torsion_dynamic;
    const FrictionLimit slide = FrictionLimit::of(mu_dynamic * p.load, lever);
    const Wide twist_response = quantity(batch, BatchHead::twist_response), lever_squared = lever * lever;
    const Wide mass = inverse(quantity(batch, BatchHead::shift_response) + lever_squared * twist_response);
    const Wide3 before = about_center(old);
    Wide3 slid{before.x - mass * (u1 - spin * p.along_2), before.y - mass * (u2 + spin * p.along_1),
               select(lever > zero, before.z - mass * lever_squared * spin, zero)};
    // At least 1e-37, the smallest float but for denormal ones: no division by 0.
    const Wide bound = slide.bound(), size = slide.squared(slid);
    slid = slid * select(size > bound * bound, bound / square_root(maximum(size, broadcast(1e-37F))), one);

    // An unloaded region neither sticks nor slides.
    const WideMask idle = (p.load == zero) & (old.x == zero) & (old.y == zero) & (old.z == zero);
    Wide3 now = select(holds, stop, slid);
    if (points > 1) now.z += p.along_1 * now.y - p.along_2 * now.x;
    now = select(idle, old, now);
    store_mask(batch + BatchHead::sticks * lanes, (idle & stuck) | (~idle & holds));
    store_3(batch + BatchHead::friction * lanes, now);
    return now - old;
}

// What the friction's change does to the motion that the normals meet.
EMBODY_WIDE_INLINE void add_friction(RegionMotion& motion, const float* batch, const Wide3& friction) {
    const auto change = [&](int row) {
        return dot(quantity_3(batch, BatchHead::friction_coupling + 3 * row), friction);
    };
    motion.velocity.x += change(0);
    motion.spin.x += change(1);
    motion.spin.y += change(2);
}

/// The two kinds of sweep.
enum class Sweep { positions, velocities };

// Non-penetration of all points of a region (paper, eq. 4). Speeds are counted in the impulses that would stop them.
template <Sweep kind, int points>
EMBODY_WIDE_INLINE NormalLoad solve_normals(float* batch, const RegionMotion& motion, const ContactSweep& sweep) {
    const Wide zero{}, one = broadcast(1), time = broadcast(sweep.time);
    const Wide middle = motion.velocity.x, tilt_1 = motion.spin.x, tilt_2 = motion.spin.y;

    // Speed and target of each point. Apart: the gap may close in this substep. Overlapping: pushed apart, softly,
    // before the drift only. A point whose time has not come has no mass, and so keeps its impulse.
    Wide speed[points], mass[points], kept[points], impulse[points], coupling[points][points];
    const bool may_wait = Velocities::rows_of(batch, BatchHead::writable)[3] != 0;
    for (int k = 0; k < points; ++k) {
        const float* point = point_of(batch, k);
        const Wide separation = quantity(point, BatchPoint::separation);
        const WideMask is_apart = separation > zero;
        Wide bias = select(is_apart, separation * broadcast(sweep.inverse_substep), zero);
        mass[k] = quantity(point, BatchPoint::normal_mass);
        kept[k] = one;
        Wide hardness = select(mass[k] > zero, one, zero);
        if constexpr (kind == Sweep::positions) {
            const Wide push = maximum(broadcast(sweep.bias_rate) * separation, broadcast(-sweep.push_speed));
            bias = select(is_apart, bias, push);
            hardness *= select(is_apart, one, broadcast(sweep.mass_scale));
            kept[k] = select(is_apart, one, broadcast(1 - sweep.impulse_scale));
        }
        if (may_wait) {
            const WideMask is_active = time > quantity(point, BatchPoint::inactive_until);
            hardness = select(is_active, hardness, zero);
            kept[k] = select(is_active, kept[k], one);
        }
        mass[k] *= hardness;
        coupling[k][k] = hardness;
        speed[k] =
            mass[k] *
            (middle + (quantity(point, BatchPoint::along_2) * tilt_1 - quantity(point, BatchPoint::along_1) * tilt_2) +
             bias);
        impulse[k] = quantity(point, BatchPoint::impulse);
    }
    for (int i = 0; i < points; ++i) {
        for (int j = i + 1; j < points; ++j) {
            const Wide response = quantity(batch, BatchHead::coupling + (i == 0 ? j - 1 : i + j));
            coupling[i][j] = mass[i] * response;
            coupling[j][i] = mass[j] * response;
        }
    }

    // Forwards and backwards: else the last point would dominate and a flat body lean.
    const auto solve_point = [&](int k, Wide wanted) __attribute__((always_inline)) {
        const Wide change = wanted - impulse[k];
        impulse[k] = wanted;
        for (int j = 0; j < points; ++j) speed[j] += coupling[j][k] * change;
    };
    const auto wanted = [&](int k) __attribute__((always_inline)) {
        const Wide rest = kind == Sweep::positions ? impulse[k] * kept[k] : impulse[k];
        return maximum(rest - speed[k], zero);
    };
    for (int k = 0; k < points; ++k) solve_point(k, wanted(k));
    // The backward pass begins at each contact's last point but one, however many points the batch's other contacts
    // have.
    for (int k = points - 2; k >= 0; --k) {
        const WideMask is_last = quantity(point_of(batch, k + 1), BatchPoint::normal_mass) == zero;
        solve_point(k, select(is_last, impulse[k], wanted(k)));
    }

    NormalLoad change;
    for (int k = 0; k < points; ++k) {
        float* point = point_of(batch, k);
        change.add(point, impulse[k] - quantity(point, BatchPoint::impulse));
        store(point + BatchPoint::impulse * lanes, impulse[k]);
    }
    return change;
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
    const RegionMotion motion = RegionMotion::of(batch, v, f);
    const Wide3 spin = f.tangent_1 * motion.spin.x + f.tangent_2 * motion.spin.y;
    Wide3 now = old - stop * spin;
    now = now - f.normal * dot(now, f.normal);
    const Wide size = square_root(dot(now, now));
    // A contact without load keeps nothing, also of what is so small that its square is 0: such a lane is left alone
    // where the whole batch is idle, and must come to the same where it is not.
    const Wide3 none{zero, zero, zero};
    now = select(limit > zero, now * select(size > limit, limit / select(size > zero, size, one), one), none);
    store_3(batch + BatchHead::rolling * lanes, now);
    apply(v, m, f.arm_a, f.arm_b, none, now - old);
}

// Whether no lane carries a load or friction, and no point's gap closes in this substep: then the region changes
// nothing.
template <int points>
EMBODY_WIDE_INLINE bool is_idle(float* batch, const RegionMotion& motion, const ContactSweep& sweep) {
    const Wide zero{};
    const Wide3 friction = quantity_3(batch, BatchHead::friction);
    WideMask acts = (friction.x != zero) | (friction.y != zero) | (friction.z != zero);
    for (int k = 0; k < points; ++k) {
        const float* point = point_of(batch, k);
        const Wide separation = quantity(point, BatchPoint::separation);
        const Wide speed = motion.velocity.x + (quantity(point, BatchPoint::along_2) * motion.spin.x -
                                                quantity(point, BatchPoint::along_1) * motion.spin.y);
        const WideMask may_act = (quantity(point, BatchPoint::impulse) != zero) | (separation < zero) |
                                 (speed + separation * broadcast(sweep.inverse_substep) < zero);
        acts |= may_act & (quantity(point, BatchPoint::normal_mass) > zero);
    }
    return !any(acts);
}

template <Sweep kind, int points>
EMBODY_WIDE_INLINE void solve_region(float* batch, const ContactSweep& sweep) {
    const Frame f = Frame::of(batch);
    const Inertia m = Inertia::of(batch);
    Velocities v = Velocities::take(batch, sweep);
    RegionMotion motion = RegionMotion::of(batch, v, f);
    if (is_idle<points>(batch, motion, sweep)) return;

    // Non-penetration has the last word but for what resists rolling.
    const Wide3 friction = solve_friction(batch, points, motion);
    add_friction(motion, batch, friction);
    const NormalLoad normal = solve_normals<kind, points>(batch, motion, sweep);
    apply(v, m, f.arm_a, f.arm_b, f.normal * normal.force + f.tangent_1 * friction.x + f.tangent_2 * friction.y,
          f.tangent_1 * normal.moment_1 + f.tangent_2 * normal.moment_2 + f.normal * friction.z);
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
    if (sweep.is_first) {
        const Frame old = Frame::of(batch);
        separate(batch, points, sweep);
        turn_impulses(batch, old, sweep);
    }
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

        // A body that touched nothing: its mean velocity is half a kick behind.
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

constexpr physics::constraint::ContactKernels kernels{
    lanes, fill, warm_start, solve_positions, separate, solve_velocities, kick, drift};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const physics::constraint::ContactKernels physics::constraint::ContactKernels::EMBODY_WIDE =
    EMBODY_WIDE::kernels;
}
