// SPDX-License-Identifier: MIT
//
// Balls that roll close to each other: each follows its own path (ball_path.cpp), all in equal parts of the step. Where
// two of them meet within a part, all move on only to that time, and the two collide there (rolling_ball.cpp). The
// impact stage would lead each through the impact on a straight path and the contact solver back onto the ground: both
// change the energy of what lies on curved ground by several percent a collision.
#include "physics/stages/rigid/ball_cluster.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/rigid/ball_ground.h"
#include "physics/state/ball_memory.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

constexpr double min_fraction = 1e-6;  // of a part: a shorter remainder is none, and each collision takes this much
                                       // time

class BallCluster {
public:
    BallCluster(const RollAccess& world, BallMemory& memory, std::span<const std::uint32_t> members,
                std::span<BallMemory::Pair> pairs)
        : world_(world),
          memory_(memory),
          members_(members),
          pairs_(pairs),
          settings_(world.settings.solver.constraint) {}
    bool roll();
    /// Whether the cluster was given up because its collisions did not end.
    [[nodiscard]] bool is_exhausted() const { return is_exhausted_; }

private:
    using Candidate = BallMemory::Candidate;
    using Pair = BallMemory::Pair;
    [[nodiscard]] Candidate& ball(std::uint32_t index) const { return memory_.candidates[index]; }
    [[nodiscard]] double radii(const Pair& pair) const {
        return ball(pair.a).at.motion.radius + ball(pair.b).at.motion.radius;
    }
    [[nodiscard]] double size(const Pair& pair) const {
        return std::min(ball(pair.a).at.motion.radius, ball(pair.b).at.motion.radius);
    }
    [[nodiscard]] double gap(const Pair& pair) const {
        return length(ball(pair.b).at.center - ball(pair.a).at.center) - radii(pair);
    }
    [[nodiscard]] bool is_too_deep(const Pair& pair) const;
    [[nodiscard]] bool is_quiet() const;
    [[nodiscard]] double energy(const Candidate& own) const { return own.path->mass() * own.at.motion.energy(); }
    bool begin();
    [[nodiscard]] int count_parts() const;
    bool advance(double time);
    [[nodiscard]] double meeting(const Pair& pair) const;
    bool collide(Pair& pair);
    bool collide_all();
    bool end();

    const RollAccess world_;
    BallMemory& memory_;
    const std::span<const std::uint32_t> members_;
    const std::span<BallMemory::Pair> pairs_;
    const ConstraintSettings& settings_;
    std::size_t collisions_ = 0;
    bool is_exhausted_ = false;
};

bool BallCluster::begin() {
    for (const std::uint32_t index : members_) {
        Candidate& own = ball(index);
        own.received = {};
        own.path.emplace(path_of_ball(world_, own.body, own.contacts, own.surroundings));
        if (!own.path->begin(own.at, true)) return false;
    }
    for (Pair& pair : pairs_) {
        pair.impulse = {};
        pair.energy_change = 0;
        if (is_too_deep(pair)) return false;
    }
    return !is_quiet() && collide_all();
}

// Balls whose collision was not predicted overlap for a while.
bool BallCluster::is_too_deep(const Pair& pair) const {
    const BallPlace &a = ball(pair.a).at, &b = ball(pair.b).at;
    const double parting = dot(normalized(b.center - a.center), b.motion.velocity - a.motion.velocity);
    const BallClusterSettings& limits = settings_.rolling.cluster;
    const bool stay = std::fabs(parting) < settings_.impact.min_impact_speed;
    return gap(pair) < -(stay ? limits.max_rest_depth_fraction : limits.max_depth_fraction) * size(pair);
}

// The contact solver takes balls that have come to rest.
bool BallCluster::is_quiet() const {
    return std::all_of(members_.begin(), members_.end(), [&](std::uint32_t index) {
        return length(ball(index).at.motion.velocity) < settings_.impact.min_impact_speed;
    });
}

int BallCluster::count_parts() const {
    int parts = 1;
    for (const std::uint32_t index : members_) parts = std::max(parts, ball(index).path->count_parts(ball(index).at));
    return parts;
}

// Moves all of them to their next places.
bool BallCluster::advance(double time) {
    return std::all_of(members_.begin(), members_.end(), [&](std::uint32_t index) {
        Candidate& own = ball(index);
        own.next = own.at;
        return own.path->advance(own.next, time);
    });
}

// The fraction of the part after which the two meet, on straight lines; 1 if they do not.
double BallCluster::meeting(const Pair& pair) const {
    const Candidate &a = ball(pair.a), &b = ball(pair.b);
    const Vec3 start = b.at.center - a.at.center, change = b.next.center - a.next.center - start;
    const double along = dot(start, change), square = length_squared(change), both = radii(pair);
    const double rest = length_squared(start) - both * both;
    if (gap(pair) <= settings_.rolling.cluster.touch_fraction * size(pair) || along >= 0) return 1;
    const double discriminant = along * along - square * rest;
    return discriminant < 0 ? 1 : std::min(1.0, (-along - std::sqrt(discriminant)) / square);
}

// False where the impact lifts one of them off its ground.
bool BallCluster::collide(Pair& pair) {
    Candidate &a = ball(pair.a), &b = ball(pair.b);
    const Vec3 direction = normalized(b.at.center - a.at.center);
    const Material material = combine(world_.rigid.record(a.body).definition.material,
                                      world_.rigid.record(b.body).definition.material, world_.rigid.surface_pairs);
    const double before = energy(a) + energy(b);
    const double closing = dot(direction, a.at.motion.velocity - b.at.motion.velocity);
    const double restitution = closing >= material.restitution_threshold ? material.restitution : 0;
    const std::optional<Vec3> impulse = collide_balls(
        {a.at.motion, a.path->mass(), a.at.touch.normal}, {b.at.motion, b.path->mass(), b.at.touch.normal},
        {direction, restitution, material.friction_dynamic, settings_.rolling.max_parting_speed});
    is_exhausted_ = ++collisions_ > settings_.rolling.cluster.max_collisions * pairs_.size();
    if (!impulse || is_exhausted_) return false;
    a.at.rolls = b.at.rolls = false;
    a.at.centripetal = b.at.centripetal = 0;
    a.received -= *impulse;
    b.received += *impulse;
    pair.impulse += *impulse;
    pair.energy_change += energy(a) + energy(b) - before;
    return true;
}

// Collides all pairs that touch and approach each other, until none does.
bool BallCluster::collide_all() {
    constexpr double rounding = 1e-9;  // m/s: that of speeds of 1e6 m/s; slower balls only touch
    const double touch = 2 * settings_.rolling.cluster.touch_fraction;
    for (bool any = true; any;) {
        any = false;
        for (Pair& pair : pairs_) {
            if (gap(pair) > touch * size(pair)) continue;
            const BallPlace &a = ball(pair.a).at, &b = ball(pair.b).at;
            if (dot(b.center - a.center, a.motion.velocity - b.motion.velocity) <= rounding * radii(pair)) continue;
            if (!collide(pair)) return false;
            any = true;
        }
    }
    return true;
}

bool BallCluster::end() {
    for (const std::uint32_t index : members_) {
        Candidate& own = ball(index);
        if (!own.path->write(own.at, own.received, own.rolled)) return false;
        own.rolled.candidate = index;
    }
    return true;
}

bool BallCluster::roll() {
    if (!begin()) return false;
    const int parts = count_parts();
    if (parts > settings_.rolling.ball.max_parts) return false;
    const double part = world_.settings.time_step / parts;
    for (const std::uint32_t index : members_) {
        if (!ball(index).path->see_curvature(ball(index).at, part)) return false;
    }
    int left_parts = settings_.rolling.cluster.part_budget * (parts + static_cast<int>(pairs_.size()));
    for (double left = world_.settings.time_step; left > min_fraction * part;) {
        is_exhausted_ = left_parts-- == 0;
        if (is_exhausted_) return false;
        const double time = std::min(part, left);
        if (!advance(time)) return false;
        double fraction = 1;
        for (const Pair& pair : pairs_) fraction = std::min(fraction, meeting(pair));
        if (fraction < 1 && !advance(std::max(fraction, min_fraction) * time)) return false;
        for (const std::uint32_t index : members_) ball(index).at = ball(index).next;
        left -= std::max(fraction, min_fraction) * time;
        if (!collide_all()) return false;
    }
    return end();
}

}  // namespace

bool roll_cluster(const RollAccess& world, std::span<const std::uint32_t> members, std::span<BallMemory::Pair> pairs) {
    BallCluster cluster(world, world.balls, members, pairs);
    const bool has_rolled = cluster.roll();
    if (cluster.is_exhausted()) {
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted);
    }
    return has_rolled;
}

}  // namespace embody::physics::stages
