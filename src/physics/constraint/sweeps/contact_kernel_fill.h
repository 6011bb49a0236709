// SPDX-License-Identifier: MIT
//
// What the contact solver's kernels work on, and how batches are filled: rows of contacts and bodies to lanes, and what
// is derived from them once a step. Part of contact_kernel_code.h, which is included once for each width.
#pragma once

#include "math/wide.h"
#include "physics/constraint/sweeps/contact_batch.h"

namespace embody::EMBODY_WIDE {
namespace {

using physics::constraint::BatchHead;
using physics::constraint::BatchPoint;
using physics::constraint::BatchSource;
using physics::constraint::BodyRows;
using physics::constraint::ContactRow;
using physics::constraint::ContactSweep;
using physics::constraint::LaneBit;

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

// Inverse of numbers above 1e-30, whose inverse is a finite float, else 0.
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

// The bodies' relative motion at the step's start, along the axes of a frame.
EMBODY_WIDE_INLINE void fill_start_motion(float* batch, const float* start, const Frame& f) {
    Velocities v;
    gather_rows(start, Velocities::rows_of(batch, BatchHead::body_a), v.a);
    gather_rows(start, Velocities::rows_of(batch, BatchHead::body_b), v.b);
    const Wide3 velocity = v.relative(f.arm_a, f.arm_b), spin = v.angular_b() - v.angular_a();
    store_3(batch + BatchHead::start_speed * lanes,
            {dot(velocity, f.normal), dot(velocity, f.tangent_1), dot(velocity, f.tangent_2)});
    store_3(batch + BatchHead::start_spin * lanes,
            {dot(spin, f.tangent_1), dot(spin, f.tangent_2), dot(spin, f.normal)});
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
    fill_start_motion(batch, source.start, Frame::of(batch));
}

EMBODY_WIDE_INLINE void fill_inertia(float* batch, const float* inertia, const std::int32_t* rows, int mass,
                                     int first) {
    Wide row[row_floats];
    gather_rows(inertia, rows, row);
    for (int i = 0; i < 6; ++i) store(batch + (first + i) * lanes, row[i]);
    store(batch + mass * lanes, row[6]);
}

// Torsional friction is a lever times the force's bound: contacts with torsional friction alone get a coefficient of
// 1e-6.
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

// Rows of contacts to lanes. Lanes without a contact are zero where they would have an effect.
void fill(float* batch, int points, const BatchSource& source) {
    const auto take = [&](int row, Wide column[row_floats]) {
        gather_rows(source.contacts + row_floats * row, source.contact_row, column);
    };
    const Wide zero{}, one = broadcast(1);
    const WideMask exists = lanes_with(source.bits, LaneBit::first_point);
    std::memcpy(batch + BatchHead::body_a * lanes, source.body_a, sizeof(WideMask));
    std::memcpy(batch + BatchHead::body_b * lanes, source.body_b, sizeof(WideMask));

    // Points, and the anchor in their middle.
    Wide near_row[physics::constraint::BatchHead::max_points][row_floats], rest_row[row_floats];
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
    const Wide fraction = inverse(count);
    arm_a = arm_a * fraction;
    arm_b = arm_b * fraction;

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
    store_mask(batch + BatchHead::turns * lanes, lanes_with(source.bits, LaneBit::turns));
    store_3(batch + BatchHead::apart * lanes, arm_a - arm_b);

    // The bodies.
    fill_inertia(batch, source.inertia, source.body_a, BatchHead::inverse_mass_a, BatchHead::inverse_inertia_a);
    fill_inertia(batch, source.inertia, source.body_b, BatchHead::inverse_mass_b, BatchHead::inverse_inertia_b);
    prepare(batch, points);
}

}  // namespace
}  // namespace embody::EMBODY_WIDE
