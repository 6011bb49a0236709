// SPDX-License-Identifier: MIT
//
// Source: A. Castro, F. Permenter, X. Han, "An unconstrained convex formulation of compliant contact", 2022, with the
// departures told in docs/physics/direct-solver.md.
#include "physics/constraint/contact_newton.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr double stiffness_share = 1e5;   // k over the heaviest mass
constexpr int most_rounds = 12;           // of Newton's method, over all lags
constexpr double force_tolerance = 1e-7;  // of the largest load: a step that misses the impulses by less is the last
constexpr std::uint32_t no_edge = 0xFFFFFFFFu;

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

void add(Vec6& to, const Vec6& other) {
    for (int i = 0; i < 6; ++i) to.value[i] += other.value[i];
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
    return s;
}

// Columns of m crossed by v from the left, v × m, and from the right, m v×.
Mat3 cross_left(Vec3 v, const Mat3& m) { return {cross(v, m.x), cross(v, m.y), cross(v, m.z)}; }
Mat3 cross_right(const Mat3& m, Vec3 v) {
    return {m.y * v.z - m.z * v.y, m.z * v.x - m.x * v.z, m.x * v.y - m.y * v.x};
}

}  // namespace

void ContactNewton::begin(std::span<const NewtonBody> bodies, std::span<const DirectPatch> patches) {
    bodies_ = bodies;
    double heaviest = 0;
    for (const NewtonBody& body : bodies) heaviest = std::max(heaviest, body.mass);
    stiffness_ = stiffness_share * heaviest;
    has_factors_ = false;
    direction_.resize(bodies.size());
    find_structure(patches);
}

void ContactNewton::find_structure(std::span<const DirectPatch> patches) {
    // Lists come in the same order in each step, as long as nothing changes.
    if (next_structure_ == structures_.size()) structures_.emplace_back();
    structure_ = &structures_[next_structure_++];
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

// M + Jᵀ S J and its factors, unless those at hand are of the same slopes.
void ContactNewton::factor(std::span<DirectPatch> patches) {
    const auto is_known = [](const DirectPatch& patch) {
        return patch.normal_slope == patch.factored_normal_slope &&
               patch.friction_slope == patch.factored_friction_slope;
    };
    if (has_factors_ && std::all_of(patches.begin(), patches.end(), is_known)) return;
    has_factors_ = true;
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
    // The first step goes where all that was loaded and stuck stays so.
    std::copy(free.begin(), free.end(), velocity.begin());
    set_patch_velocities(velocity, patches);
    for (DirectPatch& patch : patches) evaluate_as_before(patch, stiffness_);
    for (int round = 0; round < most_rounds; ++round) {
        if (!step(free, velocity, patches)) continue;

        // Friction under the loads that were found.
        bool is_wrong = false;
        for (DirectPatch& patch : patches) is_wrong = breaks_away(patch) || is_wrong;
        if (!is_wrong) return true;
        for (DirectPatch& patch : patches) evaluate(patch, stiffness_);
    }
    return false;
}

// One step of Newton's method from the impulses that the patches hold; whether it was the last one.
bool ContactNewton::step(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches) {
    // Downhill: Jᵀ λ − M (v − v*).
    std::vector<Vec6>& direction = direction_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        direction[i] = momentum_of(bodies_[i], difference(free[i], velocity[i]));
    }
    for (const DirectPatch& patch : patches) add_impulse(patch, patch.impulse, direction);
    factor(patches);
    structure_->matrix.solve(direction);
    if (!std::all_of(direction.begin(), direction.end(), is_finite)) return false;
    for (DirectPatch& patch : patches) patch.change = relative_twist(patch, direction);
    for (std::size_t i = 0; i < bodies_.size(); ++i) add(velocity[i], direction[i]);
    return evaluate_after(patches);
}

// The impulses after a step; whether they are what the slopes foretold.
bool ContactNewton::evaluate_after(std::span<DirectPatch> patches) const {
    double largest = 0, error = 0;
    for (DirectPatch& patch : patches) {
        const Vec3 foretold_normal = patch.impulse.normal_part - patch.normal_slope * patch.change.normal_part;
        const Vec3 foretold_friction = patch.impulse.friction_part - patch.friction_slope * patch.change.friction_part;
        foretell_loads(patch, stiffness_);
        patch.velocity = patch.velocity + patch.change;
        evaluate(patch, stiffness_);
        largest = std::max(largest, std::fabs(patch.impulse.normal_part.x));
        error = std::max(error, length_squared(patch.impulse.normal_part - foretold_normal));
        error = std::max(error, length_squared(patch.impulse.friction_part - foretold_friction));
    }
    return error <= force_tolerance * force_tolerance * largest * largest;
}

void ContactNewton::find_shifts(std::span<const DirectPatch> patches, double share, double most,
                                std::span<Vec6> shifts) {
    std::fill(shifts.begin(), shifts.end(), Vec6{});
    for (const DirectPatch& patch : patches) {
        PatchTwist pull;
        for (int i = 0; i < patch.count; ++i) {
            const DirectPatch::Point& point = patch.points[static_cast<std::size_t>(i)];
            if (!point.is_loaded) continue;
            const double way = std::clamp(-share * point.gap, -most, most);
            pull.normal_part += row_of(point) * (stiffness_ * way);
        }
        add_impulse(patch, pull, shifts);
    }
    structure_->matrix.solve(shifts);
    if (!std::all_of(shifts.begin(), shifts.end(), is_finite)) std::fill(shifts.begin(), shifts.end(), Vec6{});
}

}  // namespace embody::physics
