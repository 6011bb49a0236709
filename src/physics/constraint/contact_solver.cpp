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
#include "physics/constraint/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr double damping_ratio = 10;  // overdamped: penetration fades without a bounce
// Contact frequency over substep frequency: the stiffest that stays quiet with one pass and with many.
constexpr double stiffness_one_pass = 0.15, stiffness_many_passes = 0.5;
constexpr double pi = 3.14159265358979323846;

void apply(const Contact& contact, const ContactPoint& point, Vec3 impulse, std::span<BodyState> bodies) {
    apply_impulse(bodies[contact.b], impulse, point.arm_b);
    apply_impulse(bodies[contact.a], -impulse, point.arm_a);
}

void solve_normal(const Contact& contact, ContactPoint& point, SolvePhase phase, const ContactSoftness& softness,
                  std::span<BodyState> bodies) {
    if (!point.is_active) return;
    const double separation = current_separation(contact, point, bodies);
    double bias = 0, mass_scale = 1, impulse_scale = 0;
    if (separation > 0) {
        bias = separation / softness.substep;
    } else if (phase == SolvePhase::position) {
        bias = std::max(softness.bias_rate * separation, -softness.push_speed);
        mass_scale = softness.mass_scale;
        impulse_scale = softness.impulse_scale;
    }
    const double speed = dot(relative_velocity(contact, point, bodies), contact.normal);
    PointImpulse& impulse = point.impulse;
    const double wanted =
        impulse.normal - point.normal_mass * mass_scale * (speed + bias) - impulse_scale * impulse.normal;
    const double allowed = std::max(wanted, 0.0);
    const double change = allowed - impulse.normal;
    impulse.normal = allowed;
    if (change != 0) apply(contact, point, contact.normal * change, bodies);
}

// Coulomb's cone with the full 2×2 tangent block: a pyramid or two separate rows would make friction depend on the
// choice of tangents.
void solve_friction(const Contact& contact, ContactPoint& point, std::span<BodyState> bodies) {
    PointImpulse& impulse = point.impulse;
    if (!point.is_active) return;
    if (impulse.normal == 0 && impulse.tangent_1 == 0 && impulse.tangent_2 == 0) return;

    // What would stop the point.
    const Vec3 velocity = relative_velocity(contact, point, bodies);
    const double u1 = dot(velocity, contact.tangent_1), u2 = dot(velocity, contact.tangent_2);
    double sum_1 = impulse.tangent_1 - (point.tangent_11 * u1 + point.tangent_12 * u2);
    double sum_2 = impulse.tangent_2 - (point.tangent_12 * u1 + point.tangent_22 * u2);

    // A sticking point holds up to the static limit; once it slides, it must fall below the dynamic one to stick again.
    const Material& material = contact.material;
    const double limit = (point.sticks ? material.friction_static : material.friction_dynamic) * impulse.normal;
    point.sticks = sum_1 * sum_1 + sum_2 * sum_2 <= limit * limit;
    if (!point.sticks) {
        // Sliding friction opposes the velocity, not the impulse that would stop it: the block would mix the tangents.
        sum_1 = impulse.tangent_1 - point.slide_mass * u1;
        sum_2 = impulse.tangent_2 - point.slide_mass * u2;
        const double size = std::sqrt(sum_1 * sum_1 + sum_2 * sum_2);
        const double share = size > 0 ? material.friction_dynamic * impulse.normal / size : 0;
        sum_1 *= share;
        sum_2 *= share;
    }
    const double change_1 = sum_1 - impulse.tangent_1;
    const double change_2 = sum_2 - impulse.tangent_2;
    impulse.tangent_1 = sum_1;
    impulse.tangent_2 = sum_2;
    apply(contact, point, contact.tangent_1 * change_1 + contact.tangent_2 * change_2, bodies);
}

// Torsion of the patch and rolling resistance: angular impulses bounded by lever arm times normal impulse.
void solve_turning(Contact& contact, std::span<BodyState> bodies) {
    double normal = 0;
    for (int i = 0; i < contact.count; ++i) normal += contact.points[static_cast<std::size_t>(i)].impulse.normal;
    BodyState& a = bodies[contact.a];
    BodyState& b = bodies[contact.b];
    const Mat3 inverse_inertia = a.inverse_inertia + b.inverse_inertia;
    const Vec3 spin = b.angular_velocity - a.angular_velocity;
    const Vec3 n = contact.normal;

    // What would stop all relative turning, split along and across the normal, each part bounded.
    const Vec3 wanted = contact.turning - solve(inverse_inertia, spin);
    const double torsion_limit = contact.material.friction_torsional * normal;
    const double torsion = std::clamp(dot(wanted, n), -torsion_limit, torsion_limit);
    Vec3 rolling = wanted - dot(wanted, n) * n;
    const double rolling_limit = contact.material.friction_rolling * normal;
    const double size = length(rolling);
    if (size > rolling_limit) rolling *= rolling_limit / size;

    const Vec3 change = torsion * n + rolling - contact.turning;
    contact.turning = to_vec3f(contact.turning + change);
    apply_angular_impulse(b, change);
    apply_angular_impulse(a, -change);
}

}  // namespace

bool has_few_contacts(std::size_t contacts) { return contacts <= 64; }

int contact_passes(std::size_t contacts) { return has_few_contacts(contacts) ? 8 : 1; }

ContactSoftness contact_softness(double substep, std::size_t contacts) {
    const double share = has_few_contacts(contacts) ? stiffness_many_passes : stiffness_one_pass;
    const double omega = 2 * pi * share / substep;
    const double a1 = 2 * damping_ratio + substep * omega;
    const double a2 = substep * omega * a1;
    return {substep, omega / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

void prepare_contact(Contact& contact, std::span<const BodyState> bodies) {
    const BodyState& a = bodies[contact.a];
    const BodyState& b = bodies[contact.b];
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const Mat3 inverse_mass = inverse_mass_at(a, point.arm_a, b, point.arm_b);
        const double nn = dot(contact.normal, inverse_mass * contact.normal);
        point.normal_mass = nn > 0 ? 1 / nn : 0;

        const Vec3 by_1 = inverse_mass * contact.tangent_1;
        const Vec3 by_2 = inverse_mass * contact.tangent_2;
        const double k11 = dot(contact.tangent_1, by_1), k22 = dot(contact.tangent_2, by_2);
        const double k12 = dot(contact.tangent_1, by_2);
        const double det = k11 * k22 - k12 * k12;
        if (det > 0) {
            point.tangent_11 = k22 / det;
            point.tangent_12 = -k12 / det;
            point.tangent_22 = k11 / det;
            point.slide_mass = 2 / (k11 + k22 + std::sqrt((k11 - k22) * (k11 - k22) + 4 * k12 * k12));
        }
    }
}

void warm_start_contact(const Contact& contact, std::span<BodyState> bodies) {
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const PointImpulse& impulse = point.impulse;
        apply(contact, point,
              contact.normal * impulse.normal + contact.tangent_1 * impulse.tangent_1 +
                  contact.tangent_2 * impulse.tangent_2,
              bodies);
    }
    if (!resists_turning(contact)) return;
    apply_angular_impulse(bodies[contact.b], contact.turning);
    apply_angular_impulse(bodies[contact.a], -contact.turning);
}

void solve_contact(Contact& contact, SolvePhase phase, const ContactSoftness& softness, std::span<BodyState> bodies) {
    const auto points = std::span(contact.points).first(static_cast<std::size_t>(contact.count));
    if (contact.material.friction_static > 0) {
        for (ContactPoint& point : points) solve_friction(contact, point, bodies);
    }

    // Non-penetration has the last word. Forwards and backwards: else the last point would win and a flat body lean.
    for (ContactPoint& point : points) solve_normal(contact, point, phase, softness, bodies);
    for (auto point = points.rbegin(); point != points.rend(); ++point) {
        solve_normal(contact, *point, phase, softness, bodies);
    }
    if (resists_turning(contact)) solve_turning(contact, bodies);
}

void add_to_totals(Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        point.total.normal += point.impulse.normal;
        point.total.tangent_1 += point.impulse.tangent_1;
        point.total.tangent_2 += point.impulse.tangent_2;
    }
}

}  // namespace embody::physics
