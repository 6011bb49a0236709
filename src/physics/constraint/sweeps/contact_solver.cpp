// SPDX-License-Identifier: MIT
//
// Contact and friction by sequential impulses with soft contacts and substeps.
// Sources: E. Catto, "Soft constraints: reinventing the spring", GDC 2011 (softness from frequency and damping), and
// "Solver2D", 2024 (one biased and one relaxing pass a substep); M. Macklin et al., "Small steps in physics
// simulation", 2019 (substeps instead of iterations). Paper: non-penetration is eq. (4), the opposite impulses are eq.
// (6), the cone is eq. (7), with the square that the print misses on its right side: |j_t|² <= μ² j_n².
//
//   position phase:  v_n + s/h >= 0 while apart,  v_n + bias(s) >= 0, soft, while overlapping
//   velocity phase:  v_n >= 0 at touching points: takes back the speed that the first phase gave to push bodies apart
//   both:            λ >= 0 for the sum over the substep
//
// A region is solved as one: its points lie on one plane of a rigid body, so six relative velocities at its anchor
// determine all of them (docs/physics/contact-solver.md). With the offsets s, t of a point along the tangents
//
//   u_i = u_n + t_i ω₁ − s_i ω₂,     u_i ← u_i + Σ_j A_ij Δλ_j,    A_ij = e_iᵀ K e_j,   e = (1, t, −s)
//
// and friction is a force and a moment about the normal within the ellipsoid (|f|/L)² + (τ/T)² <= 1 about the centre of
// pressure c, L = μ Σλ, T = μ Σλ|r − c| + torsion. Source: R. Howe, M. Cutkosky, "Practical force-motion models for
// sliding manipulation", 1996.
#include "physics/constraint/sweeps/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::constraint {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double critical_damping = 2;  // a₁ = 2 ζ, ζ = 1: with less a contact would oscillate
constexpr double unbounded = 1e30;      // ratio of a squared force to a bound of nothing

using Points = std::span<ContactPoint>;
Points points_of(Contact& contact) { return Points(contact.points).first(static_cast<std::size_t>(contact.count)); }

// Force and moment on b, their opposites on a, at the anchor.
void apply(const Contact& contact, const Anchor& anchor, Vec3 force, Vec3 moment, std::span<BodyState> bodies) {
    apply_impulse(bodies[contact.b], force, anchor.arm_b);
    apply_angular_impulse(bodies[contact.b], moment);
    apply_impulse(bodies[contact.a], -force, anchor.arm_a);
    apply_angular_impulse(bodies[contact.a], -moment);
}

// Motion of b relative to a at the anchor.
struct RelativeMotion {
    Vec3 velocity, spin;
};
RelativeMotion motion_at(const Contact& contact, const Anchor& anchor, std::span<const BodyState> bodies) {
    const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
    return {velocity_at(b, anchor.arm_b) - velocity_at(a, anchor.arm_a), b.angular_velocity - a.angular_velocity};
}

void apply_normals(const Contact& contact, const PreparedContact& prepared,
                   const std::array<double, Manifold::max_points>& impulses, std::span<BodyState> bodies) {
    double force = 0, moment_1 = 0, moment_2 = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
        force += impulses[i];
        moment_1 += prepared.along_2[i] * impulses[i];
        moment_2 -= prepared.along_1[i] * impulses[i];
    }
    apply(contact, prepared.anchor, contact.normal * force,
          contact.tangent_1 * moment_1 + tangent_2(contact) * moment_2, bodies);
}

void solve_normals(Contact& contact, const PreparedContact& prepared, SolvePhase phase, double time,
                   const ContactSoftness& softness, std::span<BodyState> bodies) {
    // Speed and target of each point.
    const RelativeMotion motion = motion_at(contact, prepared.anchor, bodies);
    const double middle = dot(motion.velocity, contact.normal);
    const double tilt_1 = dot(motion.spin, contact.tangent_1), tilt_2 = dot(motion.spin, tangent_2(contact));
    std::array<double, Manifold::max_points> speed{}, bias{}, change{};
    const Points points = points_of(contact);
    for (std::size_t i = 0; i < points.size(); ++i) {
        speed[i] = middle + prepared.along_2[i] * tilt_1 - prepared.along_1[i] * tilt_2;
        const double separation = current_separation(contact, points[i], bodies);
        const double push =
            phase == SolvePhase::position ? std::max(softness.bias_rate * separation, -softness.push_speed) : 0;
        bias[i] = separation > 0 ? separation / softness.substep : push;
    }

    // Forwards and backwards: else the last point would dominate and a flat body lean.
    const auto solve_point = [&](std::size_t i) {
        ContactPoint& point = points[i];
        if (!(time > point.inactive_until)) return;
        const bool is_soft = phase == SolvePhase::position && bias[i] <= 0;
        const double mass_scale = is_soft ? softness.mass_scale : 1, leak = is_soft ? softness.impulse_scale : 0;
        const double wanted =
            point.impulse - prepared.normal_mass[i] * mass_scale * (speed[i] + bias[i]) - leak * point.impulse;
        const double step = std::max(wanted, 0.0) - point.impulse;
        point.impulse = static_cast<float>(point.impulse + step);
        change[i] += step;
        for (std::size_t j = 0; j < points.size(); ++j) speed[j] += prepared.coupling[i][j] * step;
    };
    for (std::size_t i = 0; i < points.size(); ++i) solve_point(i);
    for (std::size_t i = points.size() - 1; i-- > 0;) solve_point(i);
    apply_normals(contact, prepared, change, bodies);
}

/// Where the load of a region presses and how far from there on average: m from the anchor, N s.
struct Pressure {
    double along_1 = 0, along_2 = 0, lever = 0, load = 0;
};
Pressure pressure_of(const Contact& contact, const PreparedContact& prepared) {
    Pressure p;
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
        const double impulse = contact.points[i].impulse;
        p.load += impulse;
        p.along_1 += prepared.along_1[i] * impulse;
        p.along_2 += prepared.along_2[i] * impulse;
    }
    if (p.load <= 0) return p;
    p.along_1 /= p.load;
    p.along_2 /= p.load;
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
        const double x = prepared.along_1[i] - p.along_1, y = prepared.along_2[i] - p.along_2;
        p.lever += contact.points[i].impulse * std::sqrt(x * x + y * y);
    }
    p.lever /= p.load;
    return p;
}

// Coulomb's law of the whole region. All in (tangent 1, tangent 2, moment), the moment about the centre of pressure.
void solve_friction(Contact& contact, const PreparedContact& prepared, std::span<BodyState> bodies) {
    const Pressure pressure = pressure_of(contact, prepared);
    const Vec3 old{contact.friction.along_1, contact.friction.along_2, contact.friction.twist};
    if (pressure.load == 0 && old == Vec3{}) return;
    const auto about_center = [&](Vec3 f) {
        return Vec3{f.x, f.y, f.z - (pressure.along_1 * f.y - pressure.along_2 * f.x)};
    };

    // What would stop the region; a sticking one holds up to the static limit.
    const RelativeMotion motion = motion_at(contact, prepared.anchor, bodies);
    const Vec3 u{dot(motion.velocity, contact.tangent_1), dot(motion.velocity, tangent_2(contact)),
                 dot(motion.spin, contact.normal)};
    const auto limits = [&](double mu) {
        return std::array{mu * pressure.load, (mu * pressure.lever + contact.friction_torsional) * pressure.load};
    };
    const auto excess = [](Vec3 f, const std::array<double, 2>& limit) {
        const auto ratio = [](double squared, double bound) {
            return bound > 0 ? squared / (bound * bound) : (squared > 0 ? unbounded : 0);
        };
        return ratio(f.x * f.x + f.y * f.y, limit[0]) + ratio(f.z * f.z, limit[1]);
    };
    const auto limit = limits(contact.sticks ? contact.friction_static : contact.friction_dynamic);
    Vec3 now = about_center(limit[1] > 0 ? old - prepared.stop_all * u
                                         : Vec3{old.x, old.y, 0} - prepared.stop_shift * Vec3{u.x, u.y, 0});
    if (limit[1] == 0) now.z = 0;
    contact.sticks = excess(now, limit) <= 1;

    // Sliding: opposite to the motion of the centre of pressure, in the metric of the ellipsoid.
    if (!contact.sticks) {
        const auto slide_limit = limits(contact.friction_dynamic);
        const double lever = slide_limit[0] > 0 ? slide_limit[1] / slide_limit[0] : 0;
        const double response = prepared.shift_response + lever * lever * prepared.twist_response;
        const double mass = response > 0 ? 1 / response : 0;
        const Vec3 before = about_center(old);
        const double free_mass = prepared.twist_response > 0 ? 1 / prepared.twist_response : 0;
        now = {before.x - mass * (u.x - u.z * pressure.along_2), before.y - mass * (u.y + u.z * pressure.along_1),
               before.z - (lever > 0 ? mass * lever * lever : free_mass) * u.z};
        if (slide_limit[0] == 0) now.x = now.y = 0;
        if (slide_limit[1] == 0) now.z = 0;
        const double beyond = excess(now, slide_limit);
        if (beyond > 1) now *= 1 / std::sqrt(beyond);
    }
    now.z += pressure.along_1 * now.y - pressure.along_2 * now.x;
    contact.friction = {static_cast<float>(now.x), static_cast<float>(now.y), static_cast<float>(now.z)};
    const Vec3 change = now - old;
    apply(contact, prepared.anchor, contact.tangent_1 * change.x + tangent_2(contact) * change.y,
          contact.normal * change.z, bodies);
}

// Rolling resistance: a moment across the normal, bounded by lever arm times normal impulse.
void solve_rolling(Contact& contact, std::span<BodyState> bodies) {
    double load = 0;
    for (const ContactPoint& point : points_of(contact)) load += point.impulse;
    BodyState &a = bodies[contact.a], &b = bodies[contact.b];

    // What would stop the rolling, bounded.
    const Mat3 inverse_inertia = a.inverse_inertia + b.inverse_inertia;
    const Vec3 n = contact.normal;
    const auto across = [&](Vec3 v) { return v - dot(v, n) * n; };
    Vec3 now = across(contact.rolling - solve(inverse_inertia, across(b.angular_velocity - a.angular_velocity)));
    const double limit = contact.friction_rolling * load, size = length(now);
    if (size > limit) now *= limit / size;

    const Vec3 change = now - contact.rolling;
    contact.rolling = to_vec3f(now);
    apply_angular_impulse(b, change);
    apply_angular_impulse(a, -change);
}

}  // namespace

ContactSoftness ContactPlan::softness(double time_step, const ContactSettings& settings) const {
    // ω by the load of the contact, and so much damping that the penetration decays at the recovery rate.
    const double substep = time_step / substeps;
    const double omega = 2 * pi * stiffness / substep;
    const double a1 = std::max(omega / settings.recovery_rate, critical_damping);
    const double a2 = substep * omega * a1;
    return {.substep = substep,
            .bias_rate = omega / a1,
            .mass_scale = a2 / (1 + a2),
            .impulse_scale = 1 / (1 + a2),
            .push_speed = settings.max_correction_speed,
            .penetration_slop = settings.penetration_slop};
}

ContactPlan contact_plan(std::size_t contacts, int substeps, const ContactSettings& settings) {
    if (contacts <= settings.long_list_contacts)
        return {substeps, settings.short_list_passes, settings.short_list_stiffness};
    return {settings.long_list_substeps * substeps, settings.long_list_passes, settings.long_list_stiffness};
}

ContactPlan jointed_contact_plan(std::size_t contacts, int substeps, const ContactSettings& settings) {
    if (contacts <= settings.long_list_contacts) return {substeps, settings.jointed_passes, settings.jointed_stiffness};
    return {substeps, settings.long_list_passes, settings.long_list_stiffness};
}

PreparedContact prepare_contact(const Contact& contact, std::span<const BodyState> bodies) {
    const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
    PreparedContact p;
    p.anchor = anchor_of(contact);

    // Response of the motion at the anchor, row by row of (velocity along d₁, spin about d₂).
    const Vec3 n = contact.normal, t1 = contact.tangent_1, t2 = tangent_2(contact);
    const Mat3 linear = inverse_mass_at(a, p.anchor.arm_a, b, p.anchor.arm_b);
    const Mat3 angular = a.inverse_inertia + b.inverse_inertia;
    const auto mixed = [&](Vec3 direction, Vec3 axis) {
        return dot(cross(p.anchor.arm_a, direction), a.inverse_inertia * axis) +
               dot(cross(p.anchor.arm_b, direction), b.inverse_inertia * axis);
    };

    // Normals.
    const Mat3 k = {{dot(n, linear * n), mixed(n, t1), mixed(n, t2)},
                    {mixed(n, t1), dot(t1, angular * t1), dot(t1, angular * t2)},
                    {mixed(n, t2), dot(t1, angular * t2), dot(t2, angular * t2)}};
    const auto count = static_cast<std::size_t>(contact.count);
    const auto row = [&](std::size_t i) { return Vec3{1, p.along_2[i], -p.along_1[i]}; };
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 offset = Vec3(contact.points[i].arm_a) - p.anchor.arm_a;
        p.along_1[i] = dot(offset, t1);
        p.along_2[i] = dot(offset, t2);
        for (std::size_t j = 0; j <= i; ++j) p.coupling[i][j] = p.coupling[j][i] = dot(row(i), k * row(j));
        p.normal_mass[i] = p.coupling[i][i] > 0 ? 1 / p.coupling[i][i] : 0;
    }

    // Friction.
    const double k11 = dot(t1, linear * t1), k12 = dot(t1, linear * t2), k22 = dot(t2, linear * t2);
    const double k13 = mixed(t1, n), k23 = mixed(t2, n);
    p.twist_response = dot(n, angular * n);
    p.stop_all = inverse_or_zero({{k11, k12, k13}, {k12, k22, k23}, {k13, k23, p.twist_response}});
    p.stop_shift = inverse_or_zero({{k11, k12, 0}, {k12, k22, 0}, {0, 0, 1}});
    if (p.stop_all == Mat3::zero()) p.stop_all = p.stop_shift;  // neither body can spin
    p.shift_response = (k11 + k22 + std::sqrt((k11 - k22) * (k11 - k22) + 4 * k12 * k12)) / 2;
    return p;
}

void warm_start_contact(Contact& contact, const PreparedContact& prepared, double time, std::span<BodyState> bodies) {
    std::array<double, Manifold::max_points> impulses{};
    double load = 0;
    const Points points = points_of(contact);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(time > points[i].inactive_until)) points[i].impulse = 0;
        impulses[i] = points[i].impulse;
        load += impulses[i];
    }
    if (load == 0) {
        contact.friction = {};
        contact.rolling = {};
    }
    apply_normals(contact, prepared, impulses, bodies);
    apply(contact, prepared.anchor, friction_force(contact, contact.friction),
          contact.normal * contact.friction.twist + contact.rolling, bodies);
}

void solve_contact(Contact& contact, const PreparedContact& prepared, SolvePhase phase, double time,
                   const ContactSoftness& softness, std::span<BodyState> bodies) {
    // Non-penetration has the last word but for what resists rolling.
    solve_friction(contact, prepared, bodies);
    solve_normals(contact, prepared, phase, time, softness, bodies);
    if (resists_rolling(contact)) solve_rolling(contact, bodies);
}

void add_to_totals(Contact& contact) {
    for (ContactPoint& point : points_of(contact)) point.total += point.impulse;
    contact.friction_total.along_1 += contact.friction.along_1;
    contact.friction_total.along_2 += contact.friction.along_2;
    contact.friction_total.twist += contact.friction.twist;
}

}  // namespace embody::physics::constraint
