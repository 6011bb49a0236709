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
using physics::BatchSource;
using physics::BodyRows;
using physics::ContactRow;
using physics::ContactSweep;
using physics::LaneBit;

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

    // What friction does to the normal speed and to the tilt.
    float* by_friction = batch + BatchHead::friction_coupling * lanes;
    const auto couple = [&](int row, Wide by_1, Wide by_2, Wide by_twist) {
        store_3(by_friction + 3 * row * lanes, {by_1, by_2, by_twist});
    };
    couple(0, response.shift(f.normal, f.tangent_1), response.shift(f.normal, f.tangent_2),
           response.mixed(f.normal, f.normal));
    couple(1, response.mixed(f.tangent_1, f.tangent_1), response.mixed(f.tangent_2, f.tangent_1),
           response.spin(f.tangent_1, f.normal));
    couple(2, response.mixed(f.tangent_1, f.tangent_2), response.mixed(f.tangent_2, f.tangent_2),
           response.spin(f.tangent_2, f.normal));

    // What stops the anchor's shift, with and without the spin.
    const Wide k11 = response.shift(f.tangent_1, f.tangent_1), k12 = response.shift(f.tangent_1, f.tangent_2);
    const Wide k22 = response.shift(f.tangent_2, f.tangent_2), k33 = response.spin(f.normal, f.normal);
    const Wide scale = inverse(k11 * k22 - k12 * k12);
    const Wide s11 = k22 * scale, s12 = -k12 * scale, s22 = k11 * scale;
    const WideSymmetric all = inverse(WideSymmetric{k11, k12, response.mixed(f.tangent_1, f.normal), k22,
                                                    response.mixed(f.tangent_2, f.normal), k33});

    // Where neither body can spin, or nothing resists the spin, the shift is all there is.
    const Wide zero{}, second = points > 1 ? quantity(point_of(batch, 1), BatchPoint::normal_mass) : zero;
    const WideMask has_lever = (second > zero) | (quantity(batch, BatchHead::torsion_static) > zero);
    const WideMask spins = has_lever & (all.xx > zero);
    store_3(batch + BatchHead::stop * lanes,
            {select(spins, all.xx, s11), select(spins, all.xy, s12), select(spins, all.xz, zero)});
    store_3(batch + (BatchHead::stop + 3) * lanes,
            {select(spins, all.yy, s22), select(spins, all.yz, zero), select(spins, all.zz, zero)});
    const Wide split = square_root((k11 - k22) * (k11 - k22) + broadcast(4) * k12 * k12);
    store(batch + BatchHead::shift_response * lanes, (k11 + k22 + split) * broadcast(0.5F));
    store(batch + BatchHead::twist_response * lanes, k33);
}

/// Lanes that have a bit.
EMBODY_WIDE_INLINE WideMask lanes_with(const std::int32_t* bits, int bit) {
    WideMask all;
    std::memcpy(&all, bits, sizeof all);
    return (all & bit) != 0;
}

// The region's frame, and its motion at the step's start.
EMBODY_WIDE_INLINE void fill_frame(float* batch, const BatchSource& source, const Wide3& arm_a, const Wide3& arm_b,
                                   const Wide frame_row[row_floats]) {
    const Wide3 n{frame_row[0], frame_row[1], frame_row[2]}, t1{frame_row[3], frame_row[4], frame_row[5]};
    const Wide3 t2 = cross(n, t1);
    store_3(batch + BatchHead::normal * lanes, n);
    store_3(batch + BatchHead::tangent_1 * lanes, t1);
    store_3(batch + BatchHead::tangent_2 * lanes, t2);
    store_3(batch + BatchHead::arm_a * lanes, arm_a);
    store_3(batch + BatchHead::arm_b * lanes, arm_b);
    Velocities v;
    gather_rows(source.start, source.body_a, v.a);
    gather_rows(source.start, source.body_b, v.b);
    const Wide3 velocity = v.relative(arm_a, arm_b), spin = v.angular_b() - v.angular_a();
    store_3(batch + BatchHead::start_speed * lanes, {dot(velocity, n), dot(velocity, t1), dot(velocity, t2)});
    store_3(batch + BatchHead::start_spin * lanes, {dot(spin, t1), dot(spin, t2), dot(spin, n)});
}

EMBODY_WIDE_INLINE void fill_inertia(float* batch, const float* inertia, const std::int32_t* rows, int mass,
                                     int first) {
    Wide row[row_floats];
    gather_rows(inertia, rows, row);
    for (int i = 0; i < 6; ++i) store(batch + (first + i) * lanes, row[i]);
    store(batch + mass * lanes, row[6]);
}

// Torsion is known as a lever beside the force's bound: what has the one must have a trace of the other.
EMBODY_WIDE_INLINE void fill_coefficients(float* batch, Wide friction_static, Wide friction_dynamic, Wide torsional,
                                          Wide rolling) {
    const Wide zero{}, least = select(torsional > zero, broadcast(1e-6F), zero);
    const Wide bound_static = maximum(friction_static, least), bound_dynamic = maximum(friction_dynamic, least);
    store(batch + BatchHead::friction_static * lanes, bound_static);
    store(batch + BatchHead::friction_dynamic * lanes, bound_dynamic);
    store(batch + BatchHead::torsion_static * lanes, torsional * inverse(bound_static));
    store(batch + BatchHead::torsion_dynamic * lanes, torsional * inverse(bound_dynamic));
    store(batch + BatchHead::friction_rolling * lanes, rolling);
}

// Rows of contacts to lanes. What a lane has no contact for is zero where it would do something.
void fill(float* batch, int points, const BatchSource& source) {
    const auto take = [&](int row, Wide column[row_floats]) {
        gather_rows(source.contacts + row_floats * row, source.contact_row, column);
    };
    const Wide zero{}, one = broadcast(1);
    const WideMask exists = lanes_with(source.bits, LaneBit::first_point);
    std::memcpy(batch + BatchHead::body_a * lanes, source.body_a, sizeof(WideMask));
    std::memcpy(batch + BatchHead::body_b * lanes, source.body_b, sizeof(WideMask));

    // Points, and the anchor in their middle.
    Wide near_row[physics::BatchHead::most_points][row_floats], rest_row[row_floats];
    Wide3 arm_a{zero, zero, zero}, arm_b{zero, zero, zero};
    Wide count = zero;
    for (int k = 0; k < points; ++k) {
        const int row = ContactRow::point + k * ContactRow::rows_of_point;
        Wide* near = near_row[k];
        take(row, near);
        take(row + 1, rest_row);
        const WideMask is_there = lanes_with(source.bits, LaneBit::first_point << k);
        arm_a = arm_a + select(is_there, Wide3{near[0], near[1], near[2]}, Wide3{zero, zero, zero});
        arm_b = arm_b + select(is_there, Wide3{near[3], near[4], near[5]}, Wide3{zero, zero, zero});
        count += select(is_there, one, zero);
        float* point = point_of(batch, k);
        store(point + BatchPoint::separation_found * lanes, near[6]);
        store(point + BatchPoint::impulse * lanes, select(is_there, near[7], zero));
        store(point + BatchPoint::total * lanes, rest_row[4]);
        store(point + BatchPoint::inactive_until * lanes, rest_row[5]);
        store(point + BatchPoint::normal_mass * lanes, select(is_there, one, zero));  // prepare() puts the mass here
    }
    const Wide share = inverse(count);
    arm_a = arm_a * share;
    arm_b = arm_b * share;

    // The region.
    Wide row[row_floats];
    take(ContactRow::frame, row);
    fill_frame(batch, source, arm_a, arm_b, row);
    const Wide friction_static = row[6], friction_dynamic = row[7];
    const Frame f = Frame::of(batch);
    for (int k = 0; k < points; ++k) {
        const Wide3 offset = Wide3{near_row[k][0], near_row[k][1], near_row[k][2]} - arm_a;
        const WideMask is_there = lanes_with(source.bits, LaneBit::first_point << k);
        float* point = point_of(batch, k);
        store(point + BatchPoint::along_1 * lanes, select(is_there, dot(offset, f.tangent_1), zero));
        store(point + BatchPoint::along_2 * lanes, select(is_there, dot(offset, f.tangent_2), zero));
    }
    take(ContactRow::friction, row);
    for (int i = 0; i < 3; ++i) {
        store(batch + (BatchHead::friction + i) * lanes, select(exists, row[i], zero));
        store(batch + (BatchHead::friction_total + i) * lanes, row[3 + i]);
    }
    fill_coefficients(batch, friction_static, friction_dynamic, row[6], row[7]);
    take(ContactRow::rolling, row);
    for (int i = 0; i < 3; ++i) store(batch + (BatchHead::rolling + i) * lanes, select(exists, row[i], zero));
    store_mask(batch + BatchHead::sticks * lanes, lanes_with(source.bits, LaneBit::sticks));
    store_mask(batch + BatchHead::round_a * lanes, lanes_with(source.bits, LaneBit::round_a));
    store_mask(batch + BatchHead::round_b * lanes, lanes_with(source.bits, LaneBit::round_b));

    // The bodies.
    fill_inertia(batch, source.inertia, source.body_a, BatchHead::inverse_mass_a, BatchHead::inverse_inertia_a);
    fill_inertia(batch, source.inertia, source.body_b, BatchHead::inverse_mass_b, BatchHead::inverse_inertia_b);
    prepare(batch, points);
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

// m with n·(what a body's turn R since the step began adds to an arm r) = m·r: m = Rᵀn − n. On a round body only the
// tilt counts (as contact.cpp: motion_of).
EMBODY_WIDE_INLINE Wide3 turned_back(const Wide row[row_floats], const Wide3& n, WideMask is_round) {
    const Wide3 turn{row[3], row[4], row[5]};
    const Wide w = row[6], two = broadcast(2);
    const Wide3 by_tilt = cross(n, turn) * two;
    const Wide3 by_turn = by_tilt * w + cross(by_tilt, turn);
    return select(is_round, by_tilt, by_turn);
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
/// bound, and any r will do.
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
// moment about the centre of pressure; returns what it changed, the moment about the anchor.
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

    // Forwards and backwards: else the last point would win and a flat body lean.
    const auto solve_point = [&](int k, Wide wanted) __attribute__((always_inline)) {
        const Wide change = wanted - impulse[k];
        impulse[k] = wanted;
        for (int j = 0; j < points; ++j) speed[j] += coupling[j][k] * change;
    };
    const auto wanted = [&](int k) __attribute__((always_inline)) {
        const Wide rest = kind == Sweep::positions ? impulse[k] * kept[k] : impulse[k];
        return maximum(rest - speed[k], zero);
    };
    for (int round = 0; round < physics::normal_rounds; ++round) {
        for (int k = 0; k < points; ++k) solve_point(k, wanted(k));
        // The way back begins at each contact's last point but one, whatever the batch's other contacts have.
        for (int k = points - 2; k >= 0; --k) {
            const WideMask is_last = quantity(point_of(batch, k + 1), BatchPoint::normal_mass) == zero;
            solve_point(k, select(is_last, impulse[k], wanted(k)));
        }
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
    RegionMotion motion = RegionMotion::of(batch, v, f);

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
const physics::ContactKernels kernels{lanes, fill, warm_start, solve_positions, separate, solve_velocities,
                                      kick,  drift};

}  // namespace embody::EMBODY_WIDE
