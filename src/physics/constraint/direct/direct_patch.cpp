// SPDX-License-Identifier: MIT
#include "physics/constraint/direct/direct_patch.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::constraint {

namespace {

constexpr double below_any_load = -1e300;  // N s: unbounded impulse of an inactive point

double wanted_load(const DirectPatch::Point& point, Vec3 normal_part, double stiffness) {
    return point.guess - stiffness * (dot(row_of(point), normal_part) + point.limit);
}

// Friction is bounded in the metric of (u_1, u_2, ρ w_n) at the centre of pressure: r = R friction_part.
Mat3 metric(const DirectPatch& patch) {
    return {{1, 0, 0}, {0, 1, 0}, {-patch.center_t, patch.center_s, patch.spin_arm}};
}

Vec3 wanted_friction(const DirectPatch& patch, Vec3 friction_part, double stiffness) {
    const Vec3 f = patch.friction_guess;
    const double spin = f.z - patch.center_s * f.y + patch.center_t * f.x;
    const Vec3 guess{f.x, f.y, patch.spin_arm > 0 ? spin / patch.spin_arm : 0};
    return guess - stiffness * (metric(patch) * friction_part);
}

double coefficient(const DirectPatch& patch) { return patch.sticks ? patch.friction_static : patch.friction_dynamic; }

// In the metric ℓ (w_1, w_2).
Vec3 wanted_rolling(const DirectPatch& patch, Vec3 normal_part, double stiffness) {
    const double arm = patch.rolling_arm;
    return patch.rolling_guess / arm - Vec3{normal_part.y, normal_part.z, 0} * (stiffness * arm);
}

Vec3 bounded(Vec3 wanted, double bound) {
    const double size = length(wanted);
    return size <= bound ? wanted : wanted * (bound / size);
}

// −∂ bounded(y) / ∂u for y = … − k u.
Mat3 slope_of(Vec3 wanted, double bound, double stiffness) {
    const double size = length(wanted);
    if (size <= bound) return Mat3::identity() * stiffness;
    const Vec3 direction = wanted / size;
    return (Mat3::identity() - outer(direction, direction)) * (stiffness * bound / size);
}

// From the metric back to the anchor.
Vec3 friction_at_anchor(const DirectPatch& patch, Vec3 y) { return transpose(metric(patch)) * y; }

Vec3 rolling_at_anchor(const DirectPatch& patch, Vec3 y) {
    return {y.x * patch.rolling_arm, y.y * patch.rolling_arm, 0};
}

// Writes down friction and rolling resistance and adds them to the normal part.
void note_impulse(DirectPatch& patch, Vec3 normal_part, Vec3 friction_y, Vec3 rolling_y) {
    patch.friction = friction_at_anchor(patch, friction_y);
    patch.rolling = rolling_at_anchor(patch, rolling_y);
    patch.impulse = {normal_part + Vec3{0, patch.rolling.x, patch.rolling.y}, patch.friction};
}

void add_rolling_slope(DirectPatch& patch, const Mat3& slope) {
    const double square = patch.rolling_arm * patch.rolling_arm;
    patch.normal_slope.y += Vec3{0, slope.x.x, slope.x.y} * square;
    patch.normal_slope.z += Vec3{0, slope.y.x, slope.y.y} * square;
}

}  // namespace

DirectPatch make_patch(std::uint32_t index, const Contact& contact, double substep_fraction) {
    DirectPatch patch;
    patch.contact = index;
    patch.normal = contact.normal;
    patch.tangent_1 = contact.tangent_1;
    patch.tangent_2 = tangent_2(contact);
    patch.friction_static = contact.friction_static;
    patch.friction_dynamic = contact.friction_dynamic;
    patch.rolling_arm = contact.friction_rolling;
    patch.torsion_arm = contact.friction_torsional;
    patch.count = contact.count;

    const Anchor anchor = anchor_of(contact);
    patch.arm_a = anchor.arm_a;
    patch.arm_b = anchor.arm_b;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& from = contact.points[static_cast<std::size_t>(i)];
        DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        const Vec3 offset = Vec3(from.arm_a) - patch.arm_a;
        point.s = dot(offset, patch.tangent_1);
        point.t = dot(offset, patch.tangent_2);
        point.gap = from.separation;
        point.guess = from.impulse * substep_fraction;
        point.total = from.total;
        point.inactive_until = from.inactive_until;
    }
    patch.sticks = contact.sticks;
    const PatchFriction& friction = contact.friction;
    patch.friction_guess = Vec3{friction.along_1, friction.along_2, friction.twist} * substep_fraction;
    const Vec3 rolling = contact.rolling * substep_fraction;
    patch.rolling_guess = {dot(rolling, patch.tangent_1), dot(rolling, patch.tangent_2), 0};
    return patch;
}

void write_patch(const DirectPatch& patch, double substep_fraction, Contact& contact) {
    const auto to_float = [](double number) { return static_cast<float>(number); };
    for (int i = 0; i < contact.count; ++i) {
        const DirectPatch::Point& from = patch.points[static_cast<std::size_t>(i)];
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        point.impulse = to_float(from.guess * substep_fraction);
        point.total = to_float(from.total);
    }
    const Vec3 f = patch.friction_guess * substep_fraction, total = patch.friction_total;
    contact.friction = {to_float(f.x), to_float(f.y), to_float(f.z)};
    contact.friction_total.along_1 += to_float(total.x);
    contact.friction_total.along_2 += to_float(total.y);
    contact.friction_total.twist += to_float(total.z);
    const Vec3 rolling = patch.rolling_guess * substep_fraction;
    contact.rolling = to_vec3f(rolling.x * patch.tangent_1 + rolling.y * patch.tangent_2);
    contact.sticks = patch.sticks;
}

namespace {

// Normal load, centre of pressure and lever arm of the spin.
void lag_loads(DirectPatch& patch, bool from_guess, const DirectSettings& settings) {
    double sum = 0, s = 0, t = 0;
    const auto points = std::span(patch.points).first(static_cast<std::size_t>(patch.count));
    const auto load_of = [&](const DirectPatch::Point& point) {
        return from_guess ? point.guess : std::max(point.predicted, 0.0);
    };
    for (const DirectPatch::Point& point : points) {
        sum += load_of(point);
        s += load_of(point) * point.s;
        t += load_of(point) * point.t;
    }
    patch.lagged_load = sum;
    if (sum > 0) {
        s /= sum;
        t /= sum;
    }
    double arm = 0, extent = 0;
    for (const DirectPatch::Point& point : points) {
        const double along = point.s - s, across = point.t - t;
        const double distance = std::sqrt(along * along + across * across);
        arm += load_of(point) * distance;
        extent = std::max(extent, distance);
    }
    arm = sum > 0 ? arm / sum : 0;
    if (arm < settings.min_spin_arm_fraction * extent) arm = 0;
    if (patch.friction_dynamic > 0) arm += patch.torsion_arm / patch.friction_dynamic;

    // A centre of pressure that hardly moved is kept, so that the factors can be used again.
    const double change =
        std::fabs(s - patch.center_s) + std::fabs(t - patch.center_t) + std::fabs(arm - patch.spin_arm);
    if (change <= settings.metric_tolerance * patch.spin_arm) return;
    patch.center_s = s;
    patch.center_t = t;
    patch.spin_arm = arm;
}

double predicted_load(const DirectPatch& patch) {
    double load = 0;
    for (int i = 0; i < patch.count; ++i) {
        load += std::max(patch.points[static_cast<std::size_t>(i)].predicted, 0.0);
    }
    return load;
}

// The loads that the last step predicted bound the friction: loads at a velocity that has not converged may be
// anything. A sticking patch keeps its metric, so that the factors can be used again.
void lag_predicted_loads(DirectPatch& patch, const DirectSettings& settings) {
    if (patch.is_new || patch.is_sliding || patch.is_rolling) {
        lag_loads(patch, false, settings);
    } else {
        patch.lagged_load = predicted_load(patch);
    }
}

}  // namespace

void begin_substep(DirectPatch& patch, const PatchSubstep& substep, const DirectSettings& settings) {
    for (int i = 0; i < patch.count; ++i) {
        DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        point.is_active = substep.time > point.inactive_until;
        if (!point.is_active) point.guess = 0;
        const bool touches = point.guess > 0 && point.gap <= substep.slack;
        point.limit = touches ? 0 : std::max(point.gap, 0.0) / substep.duration;
    }
    lag_loads(patch, true, settings);
    patch.is_new = patch.lagged_load == 0;
}

void begin_coupled(DirectPatch& patch, const DirectSettings& settings) {
    patch.is_sliding = !patch.sticks;
    lag_loads(patch, true, settings);
}

void end_substep(DirectPatch& patch) {
    for (int i = 0; i < patch.count; ++i) {
        DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        point.guess = point.load;
        point.total += point.load;
    }
    patch.friction_guess = patch.friction;
    patch.friction_total += patch.friction;
    patch.rolling_guess = patch.rolling;
    if (patch.lagged_load > 0) patch.sticks = !patch.is_sliding;
}

void predict_loads(DirectPatch& patch, double stiffness) {
    for (int i = 0; i < patch.count; ++i) {
        DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        const double change = stiffness * dot(row_of(point), patch.change.normal_part);
        point.predicted = point.is_loaded ? point.load - change : 0;
    }
}

bool breaks_away(DirectPatch& patch) {
    const bool breaks = patch.is_sliding && patch.sticks && patch.friction_static > patch.friction_dynamic;
    if (breaks) patch.sticks = false;
    return breaks;
}

namespace {

/// Loads and friction within Coulomb's cone.
struct InCone {
    std::array<double, Manifold::max_points> load{};
    int loaded = 0;         // points
    Vec3 friction;          // y, in the metric
    bool is_inside = true;  // inside the cone; else on it:
    Vec3 direction;         // of y
    double shorter = 0;     // s, by which y is shorter than y', N s
    double size = 0;        // |y'|, N s
};

// The nearest to the wanted λ', y' with λ >= 0 and |y| <= μ Σ λ (paper, eqs. 4 and 7 together): λ_i = max(0, λ'_i + μ
// s), |y| = |y'| − s. On the cone μ Σ max(0, λ'_i + μ s) = |y'| − s, whose left side is convex and rises: Newton's
// method from s = 0 oversteps once, then comes down through one set of loaded points after the other.
InCone nearest_in_cone(const DirectPatch& patch, const PatchTwist& velocity, double stiffness) {
    InCone cone;
    const double mu = coefficient(patch);
    std::array<double, Manifold::max_points> wanted{};
    const auto points = std::span(patch.points).first(static_cast<std::size_t>(patch.count));
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        wanted[i] = points[i].is_active ? wanted_load(points[i], velocity.normal_part, stiffness) : below_any_load;
        sum += std::max(wanted[i], 0.0);
    }
    cone.friction = wanted_friction(patch, velocity.friction_part, stiffness);
    cone.size = length(cone.friction);
    cone.is_inside = cone.size <= mu * sum;
    for (std::size_t iteration = 0; !cone.is_inside && iteration < points.size() + 2; ++iteration) {
        double load = 0, loaded = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (wanted[i] + mu * cone.shorter <= 0) continue;
            load += wanted[i];
            loaded += 1;
        }
        const double next = std::min((cone.size - mu * load) / (1 + mu * mu * loaded), cone.size);
        if (next == cone.shorter) break;
        cone.shorter = next;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        cone.load[i] = std::max(wanted[i] + mu * cone.shorter, 0.0);
        if (cone.load[i] > 0) ++cone.loaded;
    }
    if (cone.is_inside) return cone;
    cone.direction = cone.friction / cone.size;
    cone.friction = cone.direction * (cone.size - cone.shorter);
    return cone;
}

// Writes down the points' loads; returns their force and moments, and the sum of their rows.
template <class LoadOf>
std::pair<Vec3, Vec3> note_loads(DirectPatch& patch, double stiffness, LoadOf load_of) {
    Vec3 normal_part, rows;
    patch.normal_slope = patch.coupling_slope = Mat3::zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
        DirectPatch::Point& point = patch.points[i];
        point.load = load_of(i);
        point.is_loaded = point.load > 0;
        if (!point.is_loaded) continue;
        const Vec3 row = row_of(point);
        normal_part += row * point.load;
        rows += row;
        patch.normal_slope += outer(row, row * stiffness);
    }
    return {normal_part, rows};
}

// Rolling resistance in its metric, under the lagged load.
Vec3 note_rolling(DirectPatch& patch, double stiffness) {
    patch.is_rolling = false;
    if (patch.rolling_arm <= 0) return {};
    const Vec3 wanted = wanted_rolling(patch, patch.velocity.normal_part, stiffness);
    patch.is_rolling = length_squared(wanted) > patch.lagged_load * patch.lagged_load;
    add_rolling_slope(patch, slope_of(wanted, patch.lagged_load, stiffness));
    return bounded(wanted, patch.lagged_load);
}

// On the cone, with r = Σ row over the loaded points, m of them, d the direction of y and D = 1 + μ² m:
//   −∂n/∂u_n = k (Σ row rowᵀ − (μ²/D) r rᵀ),   −∂n/∂u_t = k (μ/D) r (Rᵀ d)ᵀ,
//   −∂f/∂u_t = k Rᵀ ((|y|/|y'|) (1 − d dᵀ) + (1 − 1/D) d dᵀ) R.
void evaluate_coupled(DirectPatch& patch, double stiffness) {
    const InCone cone = nearest_in_cone(patch, patch.velocity, stiffness);
    const auto [normal_part, rows] = note_loads(patch, stiffness, [&](std::size_t i) { return cone.load[i]; });
    patch.lagged_load = predicted_load(patch);
    patch.is_sliding = !cone.is_inside;
    const Mat3 r = metric(patch);
    Mat3 slope = Mat3::identity();
    if (!cone.is_inside) {
        const double mu = coefficient(patch), spread = 1 + mu * mu * cone.loaded;
        const Mat3 along = outer(cone.direction, cone.direction);
        slope = (slope - along) * ((cone.size - cone.shorter) / cone.size) + along * (1 - 1 / spread);
        patch.normal_slope += outer(rows, rows * (-stiffness * mu * mu / spread));
        patch.coupling_slope = outer(rows, transpose(r) * cone.direction * (stiffness * mu / spread));
    }
    patch.friction_slope = transpose(r) * slope * r * stiffness;
    const Vec3 rolling = note_rolling(patch, stiffness);
    note_impulse(patch, normal_part, cone.friction, rolling);
}

// Friction under the lagged load. With undamped steps a new contact sticks, and sliding that reverses within the step
// stops: else it would slide to and fro for ever.
void evaluate_lagged(DirectPatch& patch, double stiffness, bool is_undamped, const DirectSettings& settings) {
    const PatchTwist& velocity = patch.velocity;
    const Vec3 normal_part = note_loads(patch, stiffness, [&](std::size_t i) {
                                 const DirectPatch::Point& point = patch.points[i];
                                 if (!point.is_active) return 0.0;
                                 return std::max(wanted_load(point, velocity.normal_part, stiffness), 0.0);
                             }).first;
    lag_predicted_loads(patch, settings);
    const bool is_new = patch.lagged_load == 0 && normal_part.x > 0;
    const Vec3 wanted = wanted_friction(patch, velocity.friction_part, stiffness);
    const bool turned_round = patch.is_sliding && dot(wanted, patch.slide_direction) < 0;
    const double bound =
        is_undamped && (is_new || turned_round) ? length(wanted) : coefficient(patch) * patch.lagged_load;
    patch.bound = bound;
    patch.is_sliding = length(wanted) > bound;
    if (patch.is_sliding) patch.slide_direction = normalized(wanted);
    const Mat3 r = metric(patch);
    patch.friction_slope = transpose(r) * slope_of(wanted, bound, stiffness) * r;
    const Vec3 rolling = note_rolling(patch, stiffness);
    note_impulse(patch, normal_part, bounded(wanted, bound), rolling);
}

}  // namespace

void evaluate(DirectPatch& patch, double stiffness, FrictionBound bound, const DirectSettings& settings) {
    if (bound == FrictionBound::coupled) return evaluate_coupled(patch, stiffness);
    evaluate_lagged(patch, stiffness, bound == FrictionBound::undamped, settings);
}

PatchTwist impulse_at(const DirectPatch& patch, const PatchTwist& velocity, double stiffness, FrictionBound bound) {
    Vec3 normal_part, friction;
    if (bound == FrictionBound::coupled) {
        const InCone cone = nearest_in_cone(patch, velocity, stiffness);
        for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
            normal_part += row_of(patch.points[i]) * cone.load[i];
        }
        friction = cone.friction;
    } else {
        for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
            const DirectPatch::Point& point = patch.points[i];
            const double wanted = wanted_load(point, velocity.normal_part, stiffness);
            if (point.is_active && wanted > 0) normal_part += row_of(point) * wanted;
        }
        friction = bounded(wanted_friction(patch, velocity.friction_part, stiffness), patch.bound);
    }
    if (patch.rolling_arm > 0) {
        const Vec3 y = bounded(wanted_rolling(patch, velocity.normal_part, stiffness), patch.lagged_load);
        const Vec3 rolling = rolling_at_anchor(patch, y);
        normal_part += Vec3{0, rolling.x, rolling.y};
    }
    return {normal_part, friction_at_anchor(patch, friction)};
}

void drop_friction(DirectPatch& patch, double stiffness) {
    patch.friction_slope = patch.coupling_slope = patch.normal_slope = Mat3::zero();
    for (int i = 0; i < patch.count; ++i) {
        const DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        if (point.is_loaded) patch.normal_slope += outer(row_of(point), row_of(point) * stiffness);
    }
}

void evaluate_as_before(DirectPatch& patch, double stiffness, const DirectSettings& settings) {
    const double parting_load = -settings.new_contact_speed * stiffness;

    // A new patch has no memory: points that do not separate are loaded, and stick.
    const PatchTwist& velocity = patch.velocity;
    Vec3 normal_part;
    patch.normal_slope = patch.coupling_slope = Mat3::zero();
    for (int i = 0; i < patch.count; ++i) {
        DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
        const double wanted = wanted_load(point, velocity.normal_part, stiffness);
        point.is_loaded = point.is_active && (point.guess > 0 || (patch.is_new && wanted > parting_load));
        point.load = point.is_loaded ? wanted : 0;
        if (!point.is_loaded) continue;
        const Vec3 row = row_of(point);
        normal_part += row * point.load;
        patch.normal_slope += outer(row, row * stiffness);
    }
    const bool is_loaded = patch.normal_slope != Mat3::zero();
    if (!is_loaded) patch.sticks = true;

    // A sliding patch goes on with the same friction; the next iteration turns it.
    const Mat3 r = metric(patch);
    patch.is_sliding = !patch.sticks;
    patch.slide_direction = {};
    patch.is_rolling = false;
    const bool has_friction = is_loaded && patch.friction_static > 0;
    Vec3 stopping;
    if (has_friction) stopping = wanted_friction(patch, patch.sticks ? velocity.friction_part : Vec3{}, stiffness);
    patch.friction_slope = has_friction && patch.sticks ? transpose(r) * r * stiffness : Mat3::zero();
    Vec3 rolling;
    if (patch.rolling_arm > 0 && is_loaded) {
        rolling = wanted_rolling(patch, velocity.normal_part, stiffness);
        add_rolling_slope(patch, Mat3::identity() * stiffness);
    }
    note_impulse(patch, normal_part, stopping, rolling);
}

PatchTwist relative_twist(const DirectPatch& patch, std::span<const Vec6> bodies) {
    Vec3 velocity, spin;
    if (patch.b >= 0) {
        const Vec6& b = bodies[static_cast<std::size_t>(patch.b)];
        spin = b.angular();
        velocity = b.linear() + cross(spin, patch.arm_b);
    }
    if (patch.a >= 0) {
        const Vec6& a = bodies[static_cast<std::size_t>(patch.a)];
        spin = spin - a.angular();
        velocity = velocity - (a.linear() + cross(a.angular(), patch.arm_a));
    }
    return {{dot(velocity, patch.normal), dot(spin, patch.tangent_1), dot(spin, patch.tangent_2)},
            {dot(velocity, patch.tangent_1), dot(velocity, patch.tangent_2), dot(spin, patch.normal)}};
}

void add_impulse(const DirectPatch& patch, const PatchTwist& impulse, std::span<Vec6> bodies) {
    const Vec3 n = impulse.normal_part, f = impulse.friction_part;
    const Vec3 force = n.x * patch.normal + f.x * patch.tangent_1 + f.y * patch.tangent_2;
    const Vec3 torque = f.z * patch.normal + n.y * patch.tangent_1 + n.z * patch.tangent_2;
    const auto add = [](Vec6& to, Vec3 linear, Vec3 angular) {
        for (int i = 0; i < 3; ++i) {
            to.value[i] += linear[i];
            to.value[i + 3] += angular[i];
        }
    };
    if (patch.b >= 0) add(bodies[static_cast<std::size_t>(patch.b)], force, torque + cross(patch.arm_b, force));
    if (patch.a >= 0) add(bodies[static_cast<std::size_t>(patch.a)], -force, -(torque + cross(patch.arm_a, force)));
}

}  // namespace embody::physics::constraint
