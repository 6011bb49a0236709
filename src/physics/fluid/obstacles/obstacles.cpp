// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/obstacles.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::fluid {

namespace {

// Of volume, of equal spheres: G. D. Scott, D. M. Kilgour, "The density of random close packing of spheres", J. Phys. D
// 2 (1969). Test: RandomMatter.GrainsThatLieCloseAreNoWallsForLiquid.
constexpr float closest_packing = 0.64f;  // a fraction

Quat turned(Quat rotation, Vec3 angular_velocity, double dt) {
    const Vec3 half = angular_velocity * (dt / 2);
    const Quat change = Quat{half.x, half.y, half.z, 0} * rotation;
    return normalized({rotation.x + change.x, rotation.y + change.y, rotation.z + change.z, rotation.w + change.w});
}

Transform moved(const FluidObstacle& obstacle, Vec3 origin, Vec3 center, Quat rotation) {
    // The body's origin relative to its centre of mass turns along.
    const Vec3 arm = rotate_inverse(obstacle.pose.rotation, obstacle.pose.position - obstacle.center);
    return {center - origin + rotate(rotation, arm), rotation};
}

// The rotation vector that turned() makes of it: exact for one part, and for small ones.
Vec3 turn_between(Quat from, Quat to) {
    const Quat turn = to * conjugate(from);
    return Vec3{turn.x, turn.y, turn.z} * (turn.w < 0 ? -2.0 : 2.0);
}

// A face that is shut though `fraction` of its control volume lies outside of the obstacle.
void bind_face(MovingObstacle& moving, const FluidGrid& grid, int axis, const Cell& c, float fraction) {
    const Vec3 n{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
    const Vec3 place = grid.center(c) - n * (grid.cell_size() / 2);
    moving.bound.push_back(
        {.axis = axis, .cell = grid.index(c), .fraction = fraction, .turn = cross(place - moving.center, n)});
}

}  // namespace

// Pose in which the last step left a body that has not been moved otherwise since.
const FluidObstacles::LeftBody* FluidObstacles::left(const FluidObstacle& obstacle) const {
    const auto found = std::ranges::lower_bound(left_, obstacle.body, {}, &LeftBody::body);
    if (found == left_.end() || found->body != obstacle.body) return nullptr;
    if (found->version == obstacle.version) return &*found;
    return length(found->center + origin_ - obstacle.center) < settings_.max_jump ? &*found : nullptr;
}

void FluidObstacles::put_where_it_is(MovingObstacle& moving) const {
    const FluidObstacle& obstacle = *moving.obstacle;
    moving.center = obstacle.center - origin_;
    moving.rotation = obstacle.pose.rotation;
    moving.linear_velocity = obstacle.linear_velocity;
    moving.angular_velocity = obstacle.angular_velocity;
}

void FluidObstacles::begin(std::span<FluidObstacle> obstacles, const FluidObstacleSettings& settings, FluidGrid& grid) {
    const bool are_settings_same = settings == settings_;
    settings_ = settings;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> versions;
    std::size_t count = 0;
    for (FluidObstacle& obstacle : obstacles) {
        if (obstacle.is_static) {
            versions.emplace_back(obstacle.body, obstacle.version);
            continue;
        }
        if (count == moving_.size()) {
            moving_.push_back({.probe = ObstacleProbe(*obstacle.shape, obstacle.pose, settings)});
        }
        MovingObstacle& moving = moving_[count++];
        moving.obstacle = &obstacle;
        put_where_it_is(moving);
        const LeftBody* before = left(obstacle);
        moving.kept_center = before != nullptr ? before->center : moving.center;
        moving.kept_rotation = before != nullptr ? before->rotation : moving.rotation;
    }
    moving_.erase(moving_.begin() + static_cast<std::ptrdiff_t>(count), moving_.end());
    if (versions == fixed_versions_ && are_settings_same) return;
    fixed_versions_ = std::move(versions);
    fixed_.clear();
    for (const FluidObstacle& obstacle : obstacles) {
        if (!obstacle.is_static) continue;
        const Transform placed{obstacle.pose.position - origin_, obstacle.pose.rotation};
        fixed_.emplace_back(*obstacle.shape, placed, settings);
    }
    std::fill(grid.is_static_known.begin(), grid.is_static_known.end(), 0);
}

double FluidObstacles::unexpected_displacement() const {
    double farthest = 0;
    for (const MovingObstacle& moving : moving_) {
        const double reach = length(moving.obstacle->shape->bounds(moving.obstacle->pose).half_extents());
        const Vec3 turn = turn_between(moving.kept_rotation, moving.rotation);
        farthest = std::max(farthest, length(moving.center - moving.kept_center) + length(turn) * reach);
    }
    return farthest;
}

void FluidObstacles::begin_catching_up() {
    for (MovingObstacle& moving : moving_) {
        moving.linear_velocity = moving.center - moving.kept_center;
        moving.angular_velocity = turn_between(moving.kept_rotation, moving.rotation);
        moving.center = moving.kept_center;
        moving.rotation = moving.kept_rotation;
    }
}

void FluidObstacles::end_catching_up() {
    for (MovingObstacle& moving : moving_) put_where_it_is(moving);
}

void FluidObstacles::measure_static_tile(FluidGrid& grid, const Cell& corner, std::vector<ObstacleProbe>& probes,
                                         ObstacleRegion& region) {
    Cell upper = corner;
    for (int axis = 0; axis < 3; ++axis) upper[axis] += FluidGrid::tile[axis];
    region.begin(grid, corner, upper);
    for (ObstacleProbe& probe : probes) region.add(probe);
    region.finish();
    grid.for_cells(corner, [&](int cell, const Cell& c) {
        const int here = region.index(c);
        for (int axis = 0; axis < 3; ++axis) grid.static_fraction[axis][cell] = region.fraction(axis, here);
        grid.static_distance[cell] = region.distance(here);
        grid.static_room[cell] = region.room(here);
        grid.static_thin[cell] = region.thin(here);
    });
    grid.is_static_known[grid.tile_of(corner)] = 1;
    grid.clear_tile(corner);
}

void FluidObstacles::measure_static(FluidGrid& grid, TaskPool& workers) {
    std::vector<Cell> unknown;
    for (const Cell& corner : grid.tiles()) {
        if (!grid.is_static_known[grid.tile_of(corner)]) unknown.push_back(corner);
    }
    const auto around_drops = grid.unknown_around_drops();
    unknown.insert(unknown.end(), around_drops.begin(), around_drops.end());
    if (unknown.empty()) return;
    // Neighbours cost about the same: with n workers each takes every n-th.
    const auto number = static_cast<std::size_t>(workers.workers());
    parallel_for(workers, number, unknown.size() > 4, [&](int, IndexRange range) {
        std::vector<ObstacleProbe> probes = fixed_;
        ObstacleRegion region;
        for (std::size_t first = range.first; first < range.last; ++first) {
            for (std::size_t i = first; i < unknown.size(); i += number) {
                measure_static_tile(grid, unknown[i], probes, region);
            }
        }
    });
}

// Fractions and distances of one obstacle alone.
void FluidObstacles::measure_moving(MovingObstacle& moving, const FluidGrid& grid) {
    // The cells in reach, within the box and away from its rim.
    const double h = grid.cell_size();
    const Bounds wide = enlarged(moving.probe.bounds(), ObstacleRegion::reach * h);
    Cell lower{}, upper{};
    const Vec3 extent = moving.probe.bounds().half_extents() * 2;
    moving.is_small = std::max({extent.x, extent.y, extent.z}) < h && !moving.probe.is_surface();
    moving.is_in_reach = true;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor(wide.lower[axis] / h) - grid.lower()[axis];
        const double high = std::ceil(wide.upper[axis] / h) - grid.lower()[axis];
        lower[axis] = static_cast<int>(std::clamp(low, 1.0, grid.size()[axis] - 1.0));
        upper[axis] = static_cast<int>(std::clamp(high, 1.0, grid.size()[axis] - 1.0));
        moving.is_in_reach = moving.is_in_reach && lower[axis] < upper[axis];
        // The spread volume reaches a cell around the centre.
        const double at = moving.center[axis] / h;
        const bool is_inside = at > grid.lower()[axis] + lower[axis] + 1 && at < grid.lower()[axis] + upper[axis] - 1;
        moving.is_in_reach = moving.is_in_reach && (is_inside || !moving.is_small);
    }
    if (!moving.is_in_reach) return;
    ObstacleRegion& region = moving.region;
    region.begin(grid, lower, upper);
    if (moving.is_small) {
        region.spread(moving.center, moving.obstacle->shape->mass_properties().volume);
        return;
    }
    moving.is_in_reach = region.add(moving.probe);
    if (!moving.is_in_reach) return;
    region.finish();
}

// Where obstacles overlap, the space counts for the first one.
void FluidObstacles::place_moving(MovingObstacle& moving, int owner, FluidGrid& grid) {
    const float min_open = settings_.min_open;
    if (!moving.is_in_reach) return;
    const bool is_convex = moving.probe.is_convex();
    const ObstacleRegion& region = moving.region;
    const Cell &lower = region.lower(), &upper = region.upper();
    moving.bound.clear();
    for (auto& fraction : moving.fraction) fraction.assign(static_cast<std::size_t>(region.index(upper)) + 1, 0);
    for (int z = lower[2]; z < upper[2]; ++z) {
        for (int y = lower[1]; y < upper[1]; ++y) {
            for (int x = lower[0]; x < upper[0]; ++x) {
                const Cell c{x, y, z};
                if (!grid.is_active(c)) continue;
                const int cell = grid.index(c), here = region.index(c);
                for (int axis = 0; axis < 3; ++axis) {
                    float& open = grid.open[axis][cell];
                    if (!moving.is_small && region.fraction(axis, here) > 0 && open < 1) films_.meet(grid, axis, c);
                    // The spread volume of grains leaves the room between spheres that lie as close as they can.
                    const float wide = 1 - grid.static_fraction[axis][cell];
                    const float kept = moving.is_small ? std::max(min_open, (1 - closest_packing) * wide) : 0;
                    float fraction = std::min(region.fraction(axis, here), std::max(0.0f, open - kept));
                    if (!moving.is_small && open - fraction < min_open) fraction = open;
                    moving.fraction[axis][here] = fraction;
                    open -= fraction;
                    const float unfilled = fraction - region.filled(axis, here);
                    if (unfilled >= min_open) bind_face(moving, grid, axis, c, unfilled);
                }
                if (region.distance(here) < grid.obstacle[cell]) {
                    grid.obstacle[cell] = region.distance(here);
                    grid.obstacle_owner[cell] = static_cast<std::int16_t>(owner);
                }
                grid.room[cell] *= region.room(here);
                grid.thin[cell] |= region.thin(here);
                if (!is_convex && region.thin(here) != 0) films_.close(grid, cell, region.thin(here));
            }
        }
    }
}

std::vector<Bounds> FluidObstacles::in_reach(double dt, double cell_size) const {
    // Cells: a particle goes no farther than 4 in a part (ParticleCollider::move), and queries 2 cells around it.
    constexpr double cells = 6;
    std::vector<Bounds> boxes;
    for (const MovingObstacle& moving : moving_) {
        const FluidObstacle& obstacle = *moving.obstacle;
        const Bounds bounds = obstacle.shape->bounds(obstacle.pose);
        const double radius = length(bounds.half_extents()) + length(bounds.center() - obstacle.center);
        const double travel = length(moving.linear_velocity) * dt + length(moving.center - moving.kept_center);
        boxes.push_back(enlarged(Bounds{moving.center, moving.center}, radius + travel + cells * cell_size));
    }
    return boxes;
}

void FluidObstacles::place() {
    for (MovingObstacle& moving : moving_) {
        const FluidObstacle& obstacle = *moving.obstacle;
        const Transform placed = moved(obstacle, origin_, moving.center + origin_, moving.rotation);
        moving.probe = ObstacleProbe(*obstacle.shape, placed, settings_);
    }
}

void FluidObstacles::measure(double dt, FluidGrid& grid, TaskPool& workers) {
    const float min_open = settings_.min_open;
    measure_static(grid, workers);
    for (const Cell& corner : grid.left()) grid.clear_tile(corner);
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_rows(corner, [&](int first, const Cell&) {
            for (int cell = first; cell < first + FluidGrid::tile[0]; ++cell) {
                for (int axis = 0; axis < 3; ++axis) {
                    const float open = 1 - grid.static_fraction[axis][cell];
                    grid.open[axis][cell] = open < min_open ? 0 : open;
                }
                grid.obstacle[cell] = grid.static_distance[cell];
                grid.room[cell] = grid.static_room[cell];
                grid.thin[cell] = grid.static_thin[cell];
                grid.obstacle_owner[cell] = -1;
            }
        });
    });
    for (MovingObstacle& moving : moving_) {
        moving.center += moving.linear_velocity * (dt / 2);
        moving.rotation = turned(moving.rotation, moving.angular_velocity, dt / 2);
    }
    place();
    parallel_for(workers, moving_.size(), moving_.size() > 1, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) measure_moving(moving_[i], grid);
    });
    films_.begin(grid);
    // Small ones last: particles pass through them, so liquid needs no film to be between them.
    for (const bool are_small : {false, true}) {
        for (std::size_t i = 0; i < moving_.size(); ++i) {
            if (moving_[i].is_small == are_small) place_moving(moving_[i], static_cast<int>(i), grid);
        }
    }

    // A cell that is shut all around is obstacle, even if its centre is on the seam of two obstacles.
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            if (grid.obstacle[cell] > 0.5f) return;
            for (int axis = 0; axis < 3; ++axis) {
                if (grid.open[axis][cell] > 0 || grid.open[axis][cell + grid.stride(axis)] > 0) return;
            }
            grid.obstacle[cell] = std::min(grid.obstacle[cell], -0.5f);
        });
    });
}

void FluidObstacles::accelerate(double dt) {
    for (MovingObstacle& moving : moving_) {
        moving.linear_velocity += moving.obstacle->acceleration * dt;
        moving.angular_velocity += moving.obstacle->angular_acceleration * dt;
    }
}

void FluidObstacles::list_areas(const FluidGrid& grid, Vec3 weight) {
    films_.find(grid, weight);
    const double h = grid.cell_size();
    for (MovingObstacle& moving : moving_) {
        moving.areas.clear();
        if (!moving.is_in_reach) continue;
        const ObstacleRegion& region = moving.region;
        const Cell &low = region.lower(), &high = region.upper();
        for (int z = low[2]; z < high[2]; ++z) {
            for (int y = low[1]; y < high[1]; ++y) {
                for (int x = low[0]; x < high[0]; ++x) {
                    const Cell c{x, y, z};
                    if (!grid.is_active(c)) continue;
                    const int cell = grid.index(c);
                    const Films::Pressure pressure =
                        grid.row[cell] < 0 ? films_.pressure(cell) : Films::Pressure{grid.row[cell], 0};
                    if (pressure.row < 0) continue;
                    Vec3 area;
                    for (int axis = 0; axis < 3; ++axis) {
                        Cell next = c;
                        ++next[axis];
                        const double above = next[axis] < high[axis] ? moving.fraction[axis][region.index(next)] : 0.0f;
                        area[axis] = (above - moving.fraction[axis][region.index(c)]) * h * h;
                    }
                    if (area == Vec3{}) continue;
                    const Vec3 moment = cross(grid.center(c) - moving.center, area);
                    moving.areas.push_back({pressure.row, area, moment, pressure.head});
                }
            }
        }
    }
}

void FluidObstacles::advance(double dt) {
    for (MovingObstacle& moving : moving_) {
        moving.center += moving.linear_velocity * (dt / 2);
        moving.rotation = moving.end_rotation(dt);
        moving.kept_center = moving.center;
        moving.kept_rotation = moving.rotation;
    }
}

void FluidObstacles::end() {
    left_.clear();
    for (const MovingObstacle& moving : moving_) {
        left_.push_back({moving.obstacle->body, moving.obstacle->version, moving.kept_center, moving.kept_rotation});
    }
}

Quat MovingObstacle::end_rotation(double dt) const { return turned(rotation, angular_velocity, dt / 2); }

}  // namespace embody::physics::fluid
