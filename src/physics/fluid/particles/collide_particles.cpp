// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/collide_particles.h"

#include <algorithm>
#include <cmath>

#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

// Particles go no farther in a part of a step than this, in cells: the edge of a tile, as far as the box of cells
// reaches around them in any case.
constexpr double max_travel = 4;
// A move is cut into pieces no longer than this, in cells: the distances of obstacles, by which particles are pushed
// out of them, are known for two cells.
constexpr float max_stride = 1.5f;

void set_position(FluidParticle& particle, Vec3 p) {
    for (int axis = 0; axis < 3; ++axis) particle.position[axis] = static_cast<float>(p[axis]);
}

Cell cell_at(const FluidGrid& grid, const float* position) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = std::clamp(static_cast<int>(grid.in_cells(position[axis], axis)), 1, grid.size()[axis] - 2);
    }
    return cell;
}

}  // namespace

ParticleCollider::ParticleCollider(const FluidGrid& grid, const FluidObstacles& obstacles,
                                   const FluidCollisionSettings& settings, double dt)
    : grid_(grid), obstacles_(obstacles), settings_(settings), fixed_(obstacles.fixed()) {
    for (const MovingObstacle& moving : obstacles.moving()) {
        Mover mover{moving.probe, &moving, {}, {}};
        mover.before = mover.posed(moving.kept_center, moving.kept_rotation);
        mover.end = mover.posed(moving.center + moving.linear_velocity * (dt / 2), moving.end_rotation(dt));
        for (const Pose& pose : {mover.before, mover.end}) {
            const Quat turn = moving.rotation * conjugate(pose.rotation);
            mover.shift = std::max(mover.shift, length(pose.center - moving.center));
            mover.turn = std::max(mover.turn, 2 * length(Vec3{turn.x, turn.y, turn.z}));
        }
        moving_.push_back(std::move(mover));
    }
}

ParticleCollider::Pose ParticleCollider::Mover::posed(Vec3 center, Quat rotation) const {
    return {center, rotation, obstacle->center, to_matrix(obstacle->rotation * conjugate(rotation))};
}

ParticleCollider::Pose ParticleCollider::Mover::at(double fraction) const {
    if (fraction == 0) return before;
    if (fraction == 1) return end;
    const Pose middle{obstacle->center, obstacle->rotation, {}, {}};
    const Pose &from = fraction < 0.5 ? before : middle, &to = fraction < 0.5 ? middle : end;
    const double t = fraction < 0.5 ? 2 * fraction : 2 * fraction - 1;
    const double other = dot(from.rotation, to.rotation) < 0 ? -t : t;
    const Quat &a = from.rotation, &b = to.rotation;
    const Quat between = normalized({a.x * (1 - t) + b.x * other, a.y * (1 - t) + b.y * other,
                                     a.z * (1 - t) + b.z * other, a.w * (1 - t) + b.w * other});
    return posed(from.center + (to.center - from.center) * t, between);
}

bool ParticleCollider::is_near_thin(const float* position) const {
    return (grid_.thin[grid_.index(cell_at(grid_, position))] & near_thin) != 0;
}

// Particles are sorted by cell: the probes are prepared for several of them at once.
void ParticleCollider::look_around(const Bounds& swept) {
    if (contains(seen_, swept)) return;
    const double h = grid_.cell_size(), gap = settings_.wall_gap * h;
    seen_ = enlarged(swept, h);
    near_fixed_.clear();
    near_moving_.clear();
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        if (fixed_[i].look_at(enlarged(seen_, gap), gap)) near_fixed_.push_back(i);
    }
    for (std::size_t i = 0; i < moving_.size(); ++i) {
        Mover& mover = moving_[i];
        if (!mover.is_met()) continue;
        // Bound of the displacement of a place between its own time and the middle of the part.
        const double arm = length(seen_.center() - mover.obstacle->center) + length(seen_.half_extents());
        const double aside = mover.shift + mover.turn * (arm + mover.shift);
        if (mover.probe.look_at(enlarged(seen_, gap + aside), gap)) near_moving_.push_back(i);
    }
}

bool ParticleCollider::sees(Vec3 from, Vec3 to) {
    Bounds box;
    box.add(from);
    box.add(to);
    look_around(box);
    return std::ranges::none_of(near_fixed_, [&](std::size_t i) { return fixed_[i].crossing(from, to).has_value(); }) &&
           std::ranges::none_of(near_moving_,
                                [&](std::size_t i) { return moving_[i].probe.crossing(from, to).has_value(); });
}

std::array<float, 3> ParticleCollider::place_of(const FluidParticle& particle) {
    std::array<float, 3> place{particle.position[0], particle.position[1], particle.position[2]};
    if (!is_near_thin(particle.position)) return place;

    // The cell whose centre the particle can reach: its own, or the nearest one beside it. A cell that is shut all
    // around holds no particle: its centre lies in a wall, or on its surface.
    const Vec3 p = to_vec(particle.position);
    Cell cell = cell_at(grid_, particle.position);
    const auto is_shut = [&](const Cell& c) {
        constexpr int all = closed_x | closed_y | closed_z;  // bits of the lower faces
        const int index = grid_.index(c);
        bool shut = (grid_.thin[index] & all) == all;
        for (int axis = 0; axis < 3; ++axis) shut = shut && (grid_.thin[index + grid_.stride(axis)] & (1 << axis)) != 0;
        return shut;
    };
    if (is_shut(cell) || !sees(p, grid_.center(cell))) {
        double nearest = 1e300;
        Cell found = cell;
        for (int k = 0; k < 6; ++k) {
            Cell other = cell;
            other[k / 2] += k % 2 == 0 ? -1 : 1;
            const double distance = length_squared(grid_.center(other) - p);
            if (distance >= nearest || is_shut(other) || !sees(p, grid_.center(other))) continue;
            nearest = distance;
            found = other;
        }
        if (nearest == 1e300) return place;
        cell = found;
    }

    // Towards shut faces the particle reaches no farther than the centre.
    const int index = grid_.index(cell);
    const Vec3 center = grid_.center(cell);
    for (int axis = 0; axis < 3; ++axis) {
        const int bit = 1 << axis;
        const auto middle = static_cast<float>(center[axis]);
        if (grid_.thin[index] & bit) place[axis] = std::max(place[axis], middle);
        if (grid_.thin[index + grid_.stride(axis)] & bit) place[axis] = std::min(place[axis], middle);
    }
    return place;
}

// Removes the velocity into the wall.
void ParticleCollider::stop_at(FluidParticle& particle, const Wall& wall) {
    const double inwards = std::min(0.0, dot(to_vec(particle.velocity) - wall.velocity, wall.normal));
    is_stopped_ = is_stopped_ || (inwards < 0 && !wall.is_free);
    for (int axis = 0; axis < 3; ++axis) particle.velocity[axis] -= static_cast<float>(wall.normal[axis] * inwards);
}

void ParticleCollider::push_out(FluidParticle& particle, Vec3 before, const Span& when) {
    const float gap = settings_.wall_gap;
    // The grid has a moving obstacle at its place in the middle of the part.
    const int owner = grid_.obstacle_owner[grid_.index(cell_at(grid_, particle.position))];
    const Mover* mover = owner >= 0 ? &moving_[static_cast<std::size_t>(owner)] : nullptr;
    const Pose pose = mover != nullptr ? mover->at(when.last) : Pose{};
    float gradient[3];
    const auto distance_at = [&](Vec3 p) {
        const float at[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        return sample_center(grid_, grid_.obstacle, at, gradient);
    };
    const Vec3 inside = pose.seen(to_vec(particle.position));
    const float distance = distance_at(inside);
    if (distance >= gap) return;
    const Vec3 normal = normalized(Vec3{gradient[0], gradient[1], gradient[2]});
    const Vec3 outside = inside + normal * ((gap - distance) * grid_.cell_size());
    const Vec3 wall = obstacles_.velocity_at(owner, outside);
    const bool is_free = mover != nullptr && mover->is_free();
    set_position(particle, pose.back(outside));
    stop_at(particle, {normal, wall, is_free});

    // Where that does not lead out (the seam of two obstacles) the particle stops.
    const float now = distance_at(outside);
    if (now > -settings_.seam_depth) return;
    const Vec3 stayed = mover != nullptr ? mover->at(when.first).seen(before) : before;
    if (distance_at(stayed) < now) return;
    set_position(particle, pose.back(stayed));
    is_stopped_ = is_stopped_ || !is_free;
    for (int axis = 0; axis < 3; ++axis) particle.velocity[axis] = static_cast<float>(wall[axis]);
}

// Shortens the path from `from` to `to` where the probe blocks it, and slides on along the surface.
bool ParticleCollider::bar(const ObstacleProbe& probe, Vec3 from, Vec3& to, Vec3& normal) const {
    const int max_slides = settings_.max_slides;
    const double gap = settings_.wall_gap * grid_.cell_size();
    bool is_barred = false;
    Vec3 start = from;
    for (int slide = 0; slide < max_slides; ++slide) {
        const auto hit = probe.crossing(start, to);
        if (!hit) break;
        is_barred = true;
        normal = hit->normal;
        const Vec3 place = start + (to - start) * hit->fraction + normal * gap, rest = to - place;
        start = place;
        to = slide + 1 < max_slides ? place + rest - normal * std::min(0.0, dot(rest, normal)) : place;
    }
    // Too close without having gone through, or inside since the start.
    const ObstacleDistance near = probe.nearest(to);
    const bool is_behind = probe.is_surface() && near.distance < 0;
    const double distance = is_behind ? -near.distance : near.distance;
    if (distance >= gap) return is_barred;
    normal = is_behind ? -near.normal : near.normal;
    to += normal * (gap - distance);
    // At a seam of two pieces that led from one into the other.
    if (!probe.is_surface() && probe.nearest(from).distance >= 0 && probe.nearest(to).distance < 0) to = from;
    return true;
}

// By the true shapes; a moving one is taken in the middle of its path. The probes are exact in what was looked at
// alone, which also depends on the particles before: one that was in a solid may be pushed beyond it, and is looked
// around again there. One that comes from outside is at most as deep in a solid as its path is long.
void ParticleCollider::sweep(FluidParticle& particle, Vec3 from, Vec3 to, const Span& when) {
    const double gap = settings_.wall_gap * grid_.cell_size();
    Vec3 normal;
    for (int iteration = 0; iteration < settings_.max_sweeps; ++iteration) {
        Bounds reached;
        reached.add(from);
        reached = enlarged(reached, 2 * length(to - from) + settings_.max_slides * gap);
        look_around(reached);
        bool any = false;
        for (const std::size_t i : near_fixed_) {
            if (!contains(reached, to)) break;
            if (!bar(fixed_[i], from, to, normal)) continue;
            any = true;
            stop_at(particle, {normal, {}});
        }
        for (const std::size_t i : near_moving_) {
            if (!contains(reached, to)) break;
            const Mover& mover = moving_[i];
            const MovingObstacle& moving = *mover.obstacle;
            const Pose before = mover.at(when.first), after = mover.at(when.last);
            Vec3 seen_to = after.seen(to);
            if (!bar(mover.probe, before.seen(from), seen_to, normal)) continue;
            any = true;
            to = after.back(seen_to);
            stop_at(particle, {normal, moving.velocity_at(seen_to), mover.is_free()});
        }
        if (!any) break;
    }
    set_position(particle, to);
}

bool ParticleCollider::move(FluidParticle& particle, const float* end) {
    is_stopped_ = false;
    // No particle moves farther than the tiles around the particles reach, nor by more than two cells at once.
    const auto longest = static_cast<float>(max_travel * grid_.cell_size());
    float displacement[3], size = 0;
    for (int axis = 0; axis < 3; ++axis) {
        displacement[axis] = std::clamp(end[axis] - particle.position[axis], -longest, longest);
        if (!std::isfinite(displacement[axis])) return false;  // the solver learns of it by the velocity
        size = std::max(size, std::fabs(displacement[axis]));
    }
    const int strides = 1 + static_cast<int>(size / (max_stride * static_cast<float>(grid_.cell_size())));
    const double piece = 1.0 / strides;
    for (int i = 0; i < strides; ++i) {
        float to[3];
        for (int axis = 0; axis < 3; ++axis) {
            to[axis] = particle.position[axis] + displacement[axis] / static_cast<float>(strides);
        }
        stride(particle, to, {i * piece, i + 1 < strides ? (i + 1) * piece : 1});
    }
    return is_stopped_;
}

void ParticleCollider::stride(FluidParticle& particle, const float* to, const Span& when) {
    if (is_near_thin(particle.position) || is_near_thin(to)) {
        sweep(particle, to_vec(particle.position), to_vec(to), when);
        return;
    }
    const Vec3 before = to_vec(particle.position);
    std::copy_n(to, 3, particle.position);
    if (grid_.obstacle[grid_.index(cell_at(grid_, to))] < 1.5f) push_out(particle, before, when);
}

}  // namespace embody::physics::fluid
