// SPDX-License-Identifier: MIT
//
// Source: A. Castro, F. Permenter, X. Han, "An unconstrained convex formulation of compliant contact", 2022, with the
// departures described in docs/physics/direct-solver.md.
#include "physics/constraint/direct/contact_newton.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::constraint {

namespace {

constexpr std::uint32_t no_edge = 0xFFFFFFFFu;  // of a patch with one movable body

Mat3 symmetric_outer(Vec3 a, Vec3 b) { return outer(a, b) + outer(b, a); }

bool is_finite(const Vec6& v) { return embody::is_finite(v.linear()) && embody::is_finite(v.angular()); }

Vec6 momentum_of(const NewtonBody& body, const Vec6& v) {
    return make_vec6(v.linear() * body.mass, body.inertia * v.angular());
}

Vec6 difference(const Vec6& a, const Vec6& b) {
    Vec6 result;
    for (int i = 0; i < 6; ++i) result.value[i] = a.value[i] - b.value[i];
    return result;
}

void add(Vec6& to, const Vec6& other, double factor) {
    for (int i = 0; i < 6; ++i) to.value[i] += other.value[i] * factor;
}

double dot(const Vec6& a, const Vec6& b) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += a.value[i] * b.value[i];
    return sum;
}

/// The patch's stiffness at its anchor in world axes, for the relative velocity u and spin w.
struct WorldStiffness {
    Mat3 uu, uw, ww;
};

WorldStiffness world_stiffness(const DirectPatch& patch) {
    const Vec3 n = patch.normal, t1 = patch.tangent_1, t2 = patch.tangent_2;
    const Mat3 &p = patch.normal_slope, &f = patch.friction_slope;
    WorldStiffness s;
    s.uu = outer(n, n * p.x.x) + outer(t1, t1 * f.x.x) + outer(t2, t2 * f.y.y) + symmetric_outer(t1, t2 * f.x.y);
    s.uw = outer(n, t1 * p.x.y + t2 * p.x.z) + outer(t1 * f.x.z + t2 * f.y.z, n);
    s.ww = outer(n, n * f.z.z) + outer(t1, t1 * p.y.y) + outer(t2, t2 * p.z.z) + symmetric_outer(t1, t2 * p.y.z);
    const Mat3& c = patch.coupling_slope;
    if (c == Mat3::zero()) return s;
    s.uu += symmetric_outer(n, t1 * c(0, 0) + t2 * c(0, 1));
    s.uw += outer(n, n * c(0, 2)) + outer(t1, t1 * c(1, 0) + t2 * c(2, 0)) + outer(t2, t1 * c(1, 1) + t2 * c(2, 1));
    s.ww += symmetric_outer(t1 * c(1, 2) + t2 * c(2, 2), n);
    return s;
}

// Columns of m crossed by v from the left, v × m, and from the right, m v×.
Mat3 cross_left(Vec3 v, const Mat3& m) { return {cross(v, m.x), cross(v, m.y), cross(v, m.z)}; }
Mat3 cross_right(const Mat3& m, Vec3 v) {
    return {m.y * v.z - m.z * v.y, m.z * v.x - m.x * v.z, m.x * v.y - m.y * v.x};
}

}  // namespace

void ContactNewton::begin(std::uint32_t key, std::span<const NewtonBody> bodies, std::span<const DirectPatch> patches) {
    bodies_ = bodies;
    double heaviest = 0;
    for (const NewtonBody& body : bodies) heaviest = std::max(heaviest, body.mass);
    full_stiffness_ = settings_.stiffness_per_mass * heaviest;
    has_factors_ = false;
    direction_.resize(bodies.size());
    right_side_.resize(bodies.size());
    find_structure(key, patches);
}

bool ContactNewton::has_given_up(std::uint32_t key) const {
    if (key >= structure_of_key_.size()) return false;
    const std::uint32_t index = structure_of_key_[key];
    return index < structures_.size() && structures_[index].key == key && step_ < structures_[index].idle_until;
}

void ContactNewton::abandon() {
    structure_->rests = 0;
    const std::uint64_t least = settings_.min_idle_steps;
    structure_->idle = std::clamp(2 * structure_->idle, least, std::max(least, settings_.max_idle_steps));
    structure_->idle_until = step_ + structure_->idle;
}

void ContactNewton::note_rest() {
    if (structure_->last_rest + 1 != step_) structure_->rests = 0;
    structure_->last_rest = step_;
    ++structure_->rests;
    if (structure_->rests < settings_.max_rest_steps) {
        structure_->idle = 0;
    } else {
        abandon();
    }
}

// The structure of that key, or one that was not needed for a while, or a new one.
ContactNewton::Structure& ContactNewton::structure_of(std::uint32_t key) {
    if (key >= structure_of_key_.size()) structure_of_key_.resize(key + 1, 0);
    std::uint32_t& index = structure_of_key_[key];
    if (index < structures_.size() && structures_[index].key == key) return structures_[index];
    const auto is_old = [&](const Structure& structure) {
        return structure.last_step + settings_.memory_steps < step_;
    };
    const auto place = std::find_if(structures_.begin(), structures_.end(), is_old);
    index = static_cast<std::uint32_t>(place - structures_.begin());
    if (place == structures_.end()) structures_.emplace_back();
    structures_[index].key = key;
    structures_[index].idle_until = structures_[index].idle = 0;
    return structures_[index];
}

void ContactNewton::find_structure(std::uint32_t key, std::span<const DirectPatch> patches) {
    structure_ = &structure_of(key);
    structure_->last_step = step_;
    const auto is_same = [](const std::array<std::int32_t, 2>& ends, const DirectPatch& patch) {
        return ends[0] == patch.a && ends[1] == patch.b;
    };
    const std::vector<std::array<std::int32_t, 2>>& known = structure_->ends;
    if (structure_->bodies == bodies_.size() &&
        std::equal(known.begin(), known.end(), patches.begin(), patches.end(), is_same)) {
        return;
    }
    structure_->bodies = bodies_.size();
    structure_->ends.clear();
    structure_->edge_of_patch.clear();
    std::vector<BlockCholesky::Edge> edges;
    for (const DirectPatch& patch : patches) {
        structure_->ends.push_back({patch.a, patch.b});
        const bool is_edge = patch.a >= 0 && patch.b >= 0;
        structure_->edge_of_patch.push_back(is_edge ? static_cast<std::uint32_t>(edges.size()) : no_edge);
        if (is_edge) edges.push_back({static_cast<std::uint16_t>(patch.a), static_cast<std::uint16_t>(patch.b)});
    }
    structure_->matrix.analyse(bodies_.size(), edges);
}

// M + Jᵀ S J and its factors, unless the present factors have the same slopes.
void ContactNewton::factor(std::span<DirectPatch> patches) {
    const auto is_known = [](const DirectPatch& patch) {
        return patch.normal_slope == patch.factored_normal_slope &&
               patch.friction_slope == patch.factored_friction_slope &&
               patch.coupling_slope == patch.factored_coupling_slope;
    };
    if (has_factors_ && std::all_of(patches.begin(), patches.end(), is_known)) return;
    has_factors_ = true;
    work_ += block_products();
    BlockCholesky& matrix = structure_->matrix;
    matrix.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Mat3 zero = Mat3::zero();
        add_to(matrix.diagonal(i), Mat3::identity() * bodies_[i].mass, zero, zero, bodies_[i].inertia);
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
        DirectPatch& patch = patches[i];
        patch.factored_normal_slope = patch.normal_slope;
        patch.factored_friction_slope = patch.friction_slope;
        patch.factored_coupling_slope = patch.coupling_slope;
        const WorldStiffness s = world_stiffness(patch);
        const Mat3 wu = transpose(s.uw);

        // With the shift from the anchor to the centre of each body, T = (1 −r×; 0 1): Tᵀ S T, and −Tₐᵀ S T_b.
        const auto add_diagonal = [&](std::int32_t body, Vec3 arm) {
            const Mat3 uw = s.uw - cross_right(s.uu, arm);
            const Mat3 ww = s.ww - cross_right(wu, arm) + cross_left(arm, uw);
            add_to(matrix.diagonal(static_cast<std::size_t>(body)), s.uu, uw, transpose(uw), ww);
        };
        if (patch.a >= 0) add_diagonal(patch.a, patch.arm_a);
        if (patch.b >= 0) add_diagonal(patch.b, patch.arm_b);
        const std::uint32_t edge = structure_->edge_of_patch[i];
        if (edge == no_edge) continue;
        const bool a_has_rows = matrix.row_end(edge) == 0;
        const Vec3 row_arm = a_has_rows ? patch.arm_a : patch.arm_b;
        const Vec3 column_arm = a_has_rows ? patch.arm_b : patch.arm_a;
        const Mat3 uw = s.uw - cross_right(s.uu, column_arm);
        const Mat3 ww = s.ww - cross_right(wu, column_arm) + cross_left(row_arm, uw);
        const Mat3 below = wu + cross_left(row_arm, s.uu);
        add_to(matrix.off_diagonal(edge), s.uu * -1, uw * -1, below * -1, ww * -1);
    }
    matrix.factor();
}

void ContactNewton::set_patch_velocities(std::span<const Vec6> velocity, std::span<DirectPatch> patches) const {
    for (DirectPatch& patch : patches) patch.velocity = relative_twist(patch, velocity);
}

bool ContactNewton::find_velocities(std::span<const Vec6> free, std::span<Vec6> velocity,
                                    std::span<DirectPatch> patches) {
    stiffness_ = full_stiffness_;
    begin_from(free, velocity, patches);
    bound_ = FrictionBound::undamped;
    if (iterate(free, settings_.undamped_iterations, velocity, patches)) return true;
    bound_ = FrictionBound::lagged;
    return iterate(free, settings_.lagged_iterations, velocity, patches);
}

bool ContactNewton::find_rest(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches) {
    const bool is_settling = structure_->rests > 0 && structure_->last_rest + 1 == step_;
    stiffness_ =
        full_stiffness_ * (is_settling ? settings_.settling_stiffness_fraction : settings_.rest_stiffness_fraction);
    bound_ = FrictionBound::coupled;
    std::fill(velocity.begin(), velocity.end(), Vec6{});
    set_patch_velocities(velocity, patches);
    for (DirectPatch& patch : patches) {
        begin_coupled(patch, settings_);
        evaluate(patch, stiffness_, bound_, settings_);
    }
    return iterate(free, settings_.rest_iterations, velocity, patches);
}

// The first step takes the loaded points as loaded and the sticking ones as sticking.
void ContactNewton::begin_from(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches) {
    std::copy(free.begin(), free.end(), velocity.begin());
    set_patch_velocities(velocity, patches);
    for (DirectPatch& patch : patches) evaluate_as_before(patch, stiffness_, settings_);
}

// Iterates until the impulses are right for this stiffness.
bool ContactNewton::iterate(std::span<const Vec6> free, int iterations, std::span<Vec6> velocity,
                            std::span<DirectPatch> patches) {
    for (int iteration = 0; iteration < iterations; ++iteration) {
        if (!step(free, velocity, patches)) continue;

        // Friction under the loads that were found.
        bool is_wrong = false;
        for (DirectPatch& patch : patches) is_wrong = breaks_away(patch) || is_wrong;
        if (!is_wrong) return true;
        for (DirectPatch& patch : patches) evaluate(patch, stiffness_, bound_, settings_);
    }
    return false;
}

// One step of Newton's method from the impulses that the patches hold; returns whether it was the last one.
bool ContactNewton::step(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches) {
    // Descent direction: Jᵀ λ − M (v − v*).
    std::vector<Vec6>& direction = direction_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        right_side_[i] = momentum_of(bodies_[i], difference(free[i], velocity[i]));
    }
    std::copy(right_side_.begin(), right_side_.end(), direction.begin());
    for (const DirectPatch& patch : patches) add_impulse(patch, patch.impulse, direction);
    factor(patches);
    structure_->matrix.solve(direction);
    if (!std::all_of(direction.begin(), direction.end(), is_finite)) return false;
    for (DirectPatch& patch : patches) patch.change = relative_twist(patch, direction);

    // Line search.
    double fraction = 1;
    if (bound_ != FrictionBound::undamped) {
        slope_by_mass_ = curvature_by_mass_ = 0;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            slope_by_mass_ -= dot(right_side_[i], direction[i]);
            curvature_by_mass_ += dot(momentum_of(bodies_[i], direction[i]), direction[i]);
        }
        fraction = find_fraction(patches);
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) add(velocity[i], direction[i], fraction);
    return evaluate_after(fraction, patches) && fraction == 1;
}

// df/dα at v + α d.
double ContactNewton::slope_at(double fraction, std::span<const DirectPatch> patches) const {
    double slope = slope_by_mass_ + fraction * curvature_by_mass_;
    for (const DirectPatch& patch : patches) {
        slope -= dot(impulse_at(patch, patch.velocity + patch.change * fraction, stiffness_, bound_), patch.change);
    }
    return slope;
}

// Length at which f stops falling along the step, by the regula falsi (Illinois); the whole step where f falls all
// along it.
double ContactNewton::find_fraction(std::span<const DirectPatch> patches) const {
    double low = 0, high = 1, at_low = slope_at(0, patches), at_high = slope_at(1, patches);
    const double enough = settings_.line_search_tolerance * std::fabs(at_low);
    if (!(at_low < 0) || !(at_high > enough)) return 1;
    double fraction = 1;
    for (int i = 0; i < settings_.line_search_iterations; ++i) {
        fraction = (low * at_high - high * at_low) / (at_high - at_low);
        const double slope = slope_at(fraction, patches);
        if (std::fabs(slope) <= enough) break;
        (slope < 0 ? low : high) = fraction;
        (slope < 0 ? at_low : at_high) = slope;
        (slope < 0 ? at_high : at_low) /= 2;
    }
    return fraction;
}

// The impulses after a step; whether they are what the slopes predicted.
bool ContactNewton::evaluate_after(double fraction, std::span<DirectPatch> patches) {
    double largest = 0, error = 0;
    for (DirectPatch& patch : patches) {
        patch.change = patch.change * fraction;
        const PatchTwist change = patch.change;
        const Vec3 predicted_normal = patch.impulse.normal_part - patch.normal_slope * change.normal_part -
                                      patch.coupling_slope * change.friction_part;
        const Vec3 predicted_friction = patch.impulse.friction_part - patch.friction_slope * change.friction_part -
                                        transpose(patch.coupling_slope) * change.normal_part;
        predict_loads(patch, stiffness_);
        patch.velocity = patch.velocity + patch.change;
        evaluate(patch, stiffness_, bound_, settings_);
        largest = std::max(largest, std::fabs(patch.impulse.normal_part.x));
        error = std::max(error, length_squared(patch.impulse.normal_part - predicted_normal));
        error = std::max(error, length_squared(patch.impulse.friction_part - predicted_friction));
    }
    return std::sqrt(error) <= settings_.force_tolerance * std::max(largest, std::sqrt(error));
}

void ContactNewton::drop_friction(std::span<DirectPatch> patches) {
    for (DirectPatch& patch : patches) physics::constraint::drop_friction(patch, stiffness_);
    factor(patches);
}

void ContactNewton::find_shifts(std::span<const DirectPatch> patches, double fraction, double most,
                                std::span<Vec6> shifts) {
    std::fill(shifts.begin(), shifts.end(), Vec6{});
    for (const DirectPatch& patch : patches) {
        PatchTwist pull;
        for (int i = 0; i < patch.count; ++i) {
            const DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
            if (!point.is_loaded) continue;
            const double travel = std::clamp(-fraction * point.gap, -most, most);
            pull.normal_part += row_of(point) * (stiffness_ * travel);
        }
        add_impulse(patch, pull, shifts);
    }
    structure_->matrix.solve(shifts);
    if (!std::all_of(shifts.begin(), shifts.end(), is_finite)) std::fill(shifts.begin(), shifts.end(), Vec6{});
}

}  // namespace embody::physics::constraint
