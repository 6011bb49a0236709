// SPDX-License-Identifier: MIT
//
// With r(t) from the centre of mass to the lowest point of the ring that touches, rolling is v = −ω × r. The ground's
// force F = m (dv/dt − a) turns the body by r × F, so that
//     (I + m (r² − r rᵀ)) dω/dt = −ω × I ω − m r × (ω × dr/dt + a),
// where dr/dt is that of the place, not of the matter that passes through it. A cone on its side rolls about the line
// that touches: ω = σ l, and the work of the forces alone changes σ. Sources: H. Moffatt, "Euler's disk and its
// finite-time singularity", 2000 (steady rolling); E. Routh, "Advanced dynamics", 1905, chapter V (the equations).
#include "physics/constraint/rolling/rolling_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

constexpr double min_squared_sine =
    1e-12;  // of axis and normal: rounding leaves 1e-16, an upright axis has no lowest point

/// Where a ring is lowest, from the centre of mass, and how fast that place moves.
struct Lowest {
    Vec3 arm, rate;
};

/// The body while it is taken through the step.
struct Moving {
    Vec3 center;
    Quat rotation;
    Vec3 spin;
};

class Roller {
public:
    Roller(const BodyConstants& constants, const RollingBody& body, const RollingGround& ground,
           const RollingSettings& settings)
        : constants_(constants), body_(body), ground_(ground), limits_(settings), settings_(settings.body) {}

    std::optional<Vec3> roll(BodyState& state, double time);

private:
    [[nodiscard]] Lowest lowest(const RollingRing& ring, const Moving& at) const;
    [[nodiscard]] double gap(const RollingRing& ring, const Moving& at) const {
        return dot(at.center + lowest(ring, at).arm - ground_.point, ground_.normal);
    }
    [[nodiscard]] double allowed_slip(const Moving& at) const {
        return settings_.max_slip_speed +
               (ground_.holds ? settings_.max_slip_fraction * length(at.spin) * body_.size : 0);
    }
    bool choose_rings(const Moving& at);
    [[nodiscard]] bool on_side() const { return ring_ != end_; }
    [[nodiscard]] bool stays_on_rings(const Moving& at) const;
    bool begin(const BodyState& state, Moving& at);
    /// dω/dt; notes the ground's force.
    Vec3 spin_rate(const Moving& at);
    [[nodiscard]] bool force_is_allowed(const Moving& at, Vec3 spin_rate) const;
    bool advance(Moving& at, double time);
    [[nodiscard]] double energy(const Moving& at) const;
    [[nodiscard]] double rate_of(const Moving& at) const;
    [[nodiscard]] double axis_rate(const Moving& at) const;
    [[nodiscard]] Vec3 line(const Moving& at) const;

    const BodyConstants& constants_;
    const RollingBody& body_;
    const RollingGround& ground_;
    const RollingSettings& limits_;
    const RollingBodySettings& settings_;
    const RollingRing* ring_ = nullptr;  // that touches
    const RollingRing* end_ = nullptr;   // the other end of the line; the same ring, where the body is not on its side
    Vec3 force_;
};

Lowest Roller::lowest(const RollingRing& ring, const Moving& at) const {
    const Vec3 n = ground_.normal, center = rotate(at.rotation, ring.center), e = rotate(at.rotation, body_.axis);
    const Vec3 turning = cross(at.spin, e);
    const double along = dot(n, e), sine = std::sqrt(std::fmax(min_squared_sine, 1 - along * along));
    const double along_rate = dot(n, turning), sine_rate = -along * along_rate / sine;
    const Vec3 down = (e * along - n) / sine;
    const Vec3 down_rate = (e * along_rate + turning * along) / sine - down * (sine_rate / sine);
    return {center + down * ring.radius - n * ring.tube, cross(at.spin, center) + down_rate * ring.radius};
}

// Of the line on the ground, level, from the end to the ring.
Vec3 Roller::line(const Moving& at) const {
    const Vec3 displacement = lowest(*ring_, at).arm - lowest(*end_, at).arm;
    return normalized(displacement - ground_.normal * dot(displacement, ground_.normal));
}

// The lowest ring, or the outermost two of those that touch where the body rolls along the line between them.
bool Roller::choose_rings(const Moving& at) {
    std::array<double, RollingBody::max_rings> gaps{};
    const auto count = static_cast<std::size_t>(body_.ring_count);
    for (std::size_t i = 0; i < count; ++i) gaps[i] = gap(body_.rings[i], at);
    const auto least = std::min_element(gaps.begin(), gaps.begin() + body_.ring_count);
    if (!(std::fabs(*least) <= limits_.touch_gap)) return false;
    double first = 1e300, last = -1e300;
    for (std::size_t i = 0; i < count; ++i) {
        if (gaps[i] > *least + settings_.side_gap) continue;
        const double place = dot(body_.rings[i].center, body_.axis);
        if (place < first) ring_ = &body_.rings[i];
        if (place > last) end_ = &body_.rings[i];
        first = std::min(first, place);
        last = std::max(last, place);
    }
    if (ring_->radius == 0 && end_->radius > 0) std::swap(ring_, end_);
    if (on_side() && !(length(cross(at.spin, line(at))) * body_.size <= allowed_slip(at))) {
        ring_ = end_ = &body_.rings[static_cast<std::size_t>(least - gaps.begin())];
    }
    const double along = dot(ground_.normal, rotate(at.rotation, body_.axis));
    return on_side() || ring_->radius == 0 || 1 - along * along > settings_.min_lean * settings_.min_lean;
}

// Stops the slip by the smallest impulse at the place that touches.
bool Roller::begin(const BodyState& state, Moving& at) {
    at = {state.center, state.rotation, state.angular_velocity};
    if (!choose_rings(at)) return false;
    const Vec3 arm = lowest(*ring_, at).arm, slip = velocity_at(state, arm);
    if (length(slip) > allowed_slip(at) || std::fabs(dot(slip, ground_.normal)) > limits_.max_approach_speed)
        return false;
    at.center -= ground_.normal * dot(at.center + arm - ground_.point, ground_.normal);

    // The angular momentum about the place that touches is conserved.
    const Mat3 inertia = rotate_tensor(at.rotation, constants_.inertia);
    const Mat3 about = inertia + (Mat3::identity() * length_squared(arm) - outer(arm, arm)) * constants_.mass;
    const Vec3 momentum = inertia * state.angular_velocity - cross(arm, state.linear_velocity) * constants_.mass;
    if (on_side()) {
        const Vec3 l = line(at);
        at.spin = l * (dot(l, momentum) / dot(l, about * l));
    } else {
        at.spin = solve(about, momentum);
    }
    return true;
}

double Roller::energy(const Moving& at) const {
    const Vec3 velocity = cross(lowest(*ring_, at).arm, at.spin);
    const Vec3 own = rotate_inverse(at.rotation, at.spin);
    return (constants_.mass * length_squared(velocity) + dot(own, constants_.inertia * own)) / 2 -
           constants_.mass * dot(constants_.acceleration, at.center);
}

// Rate at which the vectors of the motion turn, rad/s.
double Roller::rate_of(const Moving& at) const { return std::max(length(at.spin), axis_rate(at)); }

double Roller::axis_rate(const Moving& at) const {
    const Vec3 e = rotate(at.rotation, body_.axis);
    const double along = dot(ground_.normal, e), sine = std::sqrt(std::fmax(min_squared_sine, 1 - along * along));
    return length(cross(at.spin, e)) / sine;
}

Vec3 Roller::spin_rate(const Moving& at) {
    const Lowest low = lowest(*ring_, at);
    const Mat3 inertia = rotate_tensor(at.rotation, constants_.inertia);
    const Vec3 r = low.arm, a = constants_.acceleration, transport = cross(at.spin, low.rate);
    const double mass = constants_.mass;
    const Mat3 about = inertia + (Mat3::identity() * length_squared(r) - outer(r, r)) * mass;
    const Vec3 moment = -cross(at.spin, inertia * at.spin) - cross(r, transport + a) * mass;
    Vec3 result;
    if (on_side()) {
        // dω/dt = dσ/dt l + σ dl/dt; the line turns about the normal with the axis.
        const Vec3 l = line(at), e = rotate(at.rotation, body_.axis), n = ground_.normal;
        const double along = dot(n, e);
        const Vec3 turning =
            cross(n, l) * (dot(cross(n, e), cross(at.spin, e)) / std::fmax(min_squared_sine, 1 - along * along));
        const double sigma = dot(at.spin, l);
        result = turning * sigma;
        result += l * (dot(l, moment - about * result) / dot(l, about * l));
    } else {
        result = solve(about, moment);
    }
    force_ = (-cross(result, r) - transport - a) * mass;
    return result;
}

// Whether the force presses, lies within the cone of friction and, on the side, acts between the line's ends.
bool Roller::force_is_allowed(const Moving& at, Vec3 spin_rate) const {
    const Vec3 n = ground_.normal;
    const double load = dot(force_, n);
    if (!(load > 0) || length(force_ - n * load) > ground_.friction * load) return false;
    if (!on_side()) return true;
    const Vec3 first = lowest(*ring_, at).arm, second = lowest(*end_, at).arm, l = line(at);
    const Mat3 inertia = rotate_tensor(at.rotation, constants_.inertia);
    const Vec3 moment = inertia * spin_rate + cross(at.spin, inertia * at.spin) - cross(second, force_);
    const double middle = dot(moment, cross(l, n)) / load;
    return middle > 0 && middle < dot(first - second, l);
}

// One part, by the classical Runge-Kutta method.
bool Roller::advance(Moving& at, double time) {
    struct Rates {
        Vec3 velocity, spin_rate;
        Quat turning;
    };
    const auto rates = [&](const Moving& m) -> Rates {
        const Vec3 change = spin_rate(m), w = m.spin * 0.5;
        return {cross(lowest(*ring_, m).arm, m.spin), change, Quat{w.x, w.y, w.z, 0} * m.rotation};
    };
    const auto moved = [&](const Rates& r, double t) -> Moving {
        const Quat q = at.rotation;
        return {
            at.center + r.velocity * t,
            normalized({q.x + r.turning.x * t, q.y + r.turning.y * t, q.z + r.turning.z * t, q.w + r.turning.w * t}),
            at.spin + r.spin_rate * t};
    };
    const Rates a = rates(at);
    if (!force_is_allowed(at, a.spin_rate)) return false;
    const Vec3 force = force_;
    const Rates b = rates(moved(a, time / 2)), c = rates(moved(b, time / 2)), d = rates(moved(c, time));
    const auto mean = [](auto p, auto q, auto r, auto s) { return (p + (q + r) * 2.0 + s) * (1.0 / 6); };
    const auto mean_turning = [&](double Quat::*i) {
        return mean(a.turning.*i, b.turning.*i, c.turning.*i, d.turning.*i);
    };
    const Rates all{mean(a.velocity, b.velocity, c.velocity, d.velocity),
                    mean(a.spin_rate, b.spin_rate, c.spin_rate, d.spin_rate),
                    {mean_turning(&Quat::x), mean_turning(&Quat::y), mean_turning(&Quat::z), mean_turning(&Quat::w)}};
    at = moved(all, time);
    force_ = force;
    return is_finite(at.spin) && is_finite(at.center);
}

// Whether no other ring has come to the ground.
bool Roller::stays_on_rings(const Moving& at) const {
    for (int i = 0; i < body_.ring_count && !on_side(); ++i) {
        const RollingRing& ring = body_.rings[static_cast<std::size_t>(i)];
        if (&ring != ring_ && gap(ring, at) < 0) return false;
    }
    return true;
}

std::optional<Vec3> Roller::roll(BodyState& state, double time) {
    Moving at;
    if (!begin(state, at)) return std::nullopt;
    const double rate = rate_of(at);
    const auto parts = static_cast<int>(std::ceil(rate * time / settings_.part_turn));
    const bool is_slow = axis_rate(at) * time < settings_.min_axis_turn && length(at.spin) * time < settings_.min_turn;
    if (is_slow || !(parts <= settings_.max_parts)) return std::nullopt;

    // The energy of lifting the body out of the ground is taken from its motion.
    const double start = energy(at) - constants_.mass * dot(constants_.acceleration, state.center - at.center);
    const double part = time / parts;
    Vec3 impulse;
    for (int i = 0; i < parts; ++i) {
        if (!advance(at, part)) return std::nullopt;
        impulse += force_ * part;
        if (!stays_on_rings(at)) return std::nullopt;
    }
    const double now = energy(at), kinetic = now + constants_.mass * dot(constants_.acceleration, at.center);
    const double fraction = 1 + (start - now) / kinetic;
    if (!(std::fabs(fraction - 1) < settings_.max_energy_error)) return std::nullopt;
    at.spin *= std::sqrt(fraction);

    const Vec3 arm = lowest(*ring_, at).arm;
    state.center = at.center;
    state.rotation = at.rotation;
    state.turn = state.rotation * conjugate(state.start_rotation);
    state.angular_velocity = at.spin;
    state.linear_velocity = cross(arm, at.spin);
    refresh_inertia(state, constants_);
    return impulse;
}

}  // namespace

std::optional<Vec3> roll(BodyState& state, const BodyConstants& constants, const RollingBody& body,
                         const RollingGround& ground, const RollingStep& step) {
    return Roller(constants, body, ground, step.settings).roll(state, step.time);
}

}  // namespace embody::physics::constraint
