// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/obstacle_region.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::fluid {

namespace {

// A surface farther from a cube's centre than this, in half edges, does not cut the cube: √3.
constexpr double half_diagonal = 1.7320508;

constexpr float on_surface = 1e-3f;  // cells: rounding of floats leaves 1e-6

// Whether a wall is between two places, and not the tip of an edge: a wall's sides face away from each other.
bool is_walled(const ObstacleProbe& probe, Vec3 a, Vec3 b) {
    // Cosine between the two normals: a wall's sides have −1, an edge of 90° has 0 and blunter ones have more.
    constexpr double min_opposed = -0.5;
    const auto entry = probe.crossing(a, b);
    if (!entry) return false;
    const auto exit = probe.crossing(b, a);
    return !exit || dot(entry->normal, exit->normal) < min_opposed;
}

}  // namespace

void ObstacleRegion::begin(const FluidGrid& grid, const Cell& lower, const Cell& upper) {
    grid_ = &grid;
    lower_ = lower;
    upper_ = upper;
    std::size_t cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = upper[axis] - lower[axis] + 2;
        cells *= static_cast<std::size_t>(size_[axis]);
    }
    distance_.assign(cells, static_cast<float>(reach));
    octants_.assign(8 * cells, 0);
    for (auto& fraction : fraction_) fraction.assign(cells, 0);
    thin_.assign(cells, 0);
    is_cut_.assign(cells, 0);
    any_thin_ = any_cut_ = false;
    ends_.clear();
}

bool ObstacleRegion::add(ObstacleProbe& probe) {
    const double h = grid_->cell_size();
    Cell low = lower_, high = upper_;
    for (int axis = 0; axis < 3; ++axis) --low[axis];
    const Vec3 half{h / 2, h / 2, h / 2};
    if (!probe.look_at({grid_->center(low) - half, grid_->center(high) + half}, reach * h)) return false;
    own_distance_.assign(distance_.size(), static_cast<float>(reach));
    for (int z = low[2], cell = 0; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
            for (int x = low[0]; x <= high[0]; ++x, ++cell) {
                const Vec3 center = grid_->center({x, y, z});
                const double distance = probe.nearest(center).distance;
                own_distance_[cell] = static_cast<float>(std::clamp(distance / h, -reach, reach));
                distance_[cell] = std::min(distance_[cell], own_distance_[cell]);
                if (distance > half_diagonal / 2 * h) continue;
                if (distance < -half_diagonal / 2 * h) {
                    std::fill_n(octants_.begin() + 8 * cell, 8, 1.0f);
                } else {
                    probe.add_octants(center, h, &octants_[8 * cell]);
                }
                is_cut_[cell] = 1;
                any_cut_ = true;
            }
        }
    }
    shut_thin(probe);
    return true;
}

// What the fractions do not show (docs/physics/fluids.md, "Thin walls"): surfaces between two centres that are both
// outside, and walls around a centre that end before the next one.
void ObstacleRegion::shut_thin(const ObstacleProbe& probe) {
    const double h = grid_->cell_size();
    constexpr double thickness = 1.9;   // cells: the faces beside a wall of two cells are wholly shut
    constexpr float max_apart = 1.05f;  // cells: a centre's distance from what is between it and the next, and rounding
    for (int z = 0, cell = 0; z < size_[2]; ++z) {
        for (int y = 0; y < size_[1]; ++y) {
            for (int x = 0; x < size_[0]; ++x, ++cell) {
                const float here = own_distance_[cell];
                if (here > max_apart || here < -1) continue;
                const Vec3 center = grid_->center({x + lower_[0] - 1, y + lower_[1] - 1, z + lower_[2] - 1});
                const Cell place{x, y, z};
                if (here < on_surface) {
                    // Near its edges the nearest surface may be another than those of the wall's two sides.
                    const bool is_thin = probe.is_thinner(center, probe.nearest(center).normal, (thickness + here) * h);
                    for (int axis = 0; axis < 3; ++axis) {
                        const bool has_both = place[axis] > 0 && place[axis] + 1 < size_[axis];
                        Vec3 step;
                        step[axis] = h;
                        const bool is_between = has_both && own_distance_[cell - stride(axis)] > on_surface &&
                                                own_distance_[cell + stride(axis)] > on_surface;
                        if (is_thin || (is_between && is_walled(probe, center - step, center + step))) {
                            shut(axis, cell);
                            if (place[axis] + 1 < size_[axis]) shut(axis, cell + stride(axis));
                        } else if (is_between) {
                            ends_.push_back({axis, cell});
                        }
                    }
                    continue;
                }
                for (int axis = 0; axis < 3; ++axis) {
                    if (place[axis] == 0) continue;
                    const float there = own_distance_[cell - stride(axis)];
                    if (there < on_surface || here + there > max_apart) continue;
                    Vec3 from = center;
                    from[axis] -= h;
                    if (is_walled(probe, from, center)) shut(axis, cell);
                }
            }
        }
    }
}

void ObstacleRegion::shut(int axis, int cell) {
    fraction_[axis][cell] = 1;
    thin_[cell] |= static_cast<std::uint8_t>(1 << axis);
    any_thin_ = true;
}

// Where a piece of a vessel ends beside the next one it is a wall as elsewhere, but where a box ends in another, as in
// the corner of a tank, there is no thin wall. (What moves has a region of its own, and sees nothing else.)
void ObstacleRegion::shut_ends() {
    for (const auto& [axis, cell] : ends_) {
        if (!(distance_[cell - stride(axis)] > on_surface && distance_[cell + stride(axis)] > on_surface)) continue;
        shut(axis, cell);
        shut(axis, cell + stride(axis));
    }
}

void ObstacleRegion::mark_near_thin() {
    const auto mark_around = [&](int x, int y, int z) {
        for (int dz = std::max(z - 1, 0); dz <= std::min(z + 1, size_[2] - 1); ++dz) {
            for (int dy = std::max(y - 1, 0); dy <= std::min(y + 1, size_[1] - 1); ++dy) {
                for (int dx = std::max(x - 1, 0); dx <= std::min(x + 1, size_[0] - 1); ++dx) {
                    thin_[dx + size_[0] * (dy + size_[1] * dz)] |= near_thin;
                }
            }
        }
    };
    for (int z = 0, cell = 0; z < size_[2]; ++z) {
        for (int y = 0; y < size_[1]; ++y) {
            for (int x = 0; x < size_[0]; ++x, ++cell) {
                const int bits = thin_[cell];
                if (!(bits & (closed_x | closed_y | closed_z))) continue;
                mark_around(x, y, z);
                if (bits & closed_x) mark_around(x - 1, y, z);
                if (bits & closed_y) mark_around(x, y - 1, z);
                if (bits & closed_z) mark_around(x, y, z - 1);
            }
        }
    }
}

void ObstacleRegion::finish() {
    shut_ends();
    if (any_thin_) filled_ = fraction_;
    for (int z = 1; z < size_[2]; ++z) {
        for (int y = 1; y < size_[1]; ++y) {
            for (int x = 1; x < size_[0]; ++x) {
                const int cell = x + size_[0] * (y + size_[1] * z);
                for (int axis = 0; axis < 3; ++axis) {
                    const bool is_shut = fraction_[axis][cell] == 1;
                    const int below = cell - stride(axis);
                    float sum = 0;
                    if (is_cut_[cell] || is_cut_[below]) {
                        for (int octant = 0; octant < 8; ++octant) {
                            const bool is_upper = octant >> axis & 1;
                            sum += octants_[8 * (is_upper ? below : cell) + octant];
                        }
                    }
                    if (!is_shut) fraction_[axis][cell] = sum / 8;
                    if (any_thin_) filled_[axis][cell] = sum / 8;
                }
            }
        }
    }
    if (any_thin_) mark_near_thin();
    measure_room();
}

// The tent kernel over octants: 1/8, 3/8, 3/8, 1/8 along each axis, one axis after the other.
void ObstacleRegion::measure_room() {
    const auto cells = distance_.size();
    room_.assign(cells, 1);
    if (!any_cut_) return;
    const auto fold = [&](int axis, int octants, const std::vector<float>& from, std::vector<float>& to) {
        // An eighth, a quarter … of each cell's values remains: those of the other axes' octants.
        const auto below = static_cast<std::size_t>(stride(axis));
        const auto width = static_cast<std::size_t>(octants);
        to.assign(cells * width, 0);
        for (std::size_t cell = below; cell + below < cells; ++cell) {
            const float *own = &from[cell * 2 * width], *lower = own - below * 2 * width,
                        *upper = own + below * 2 * width;
            for (std::size_t i = 0; i < width; ++i) {
                to[cell * width + i] =
                    0.125f * (lower[2 * i + 1] + upper[2 * i]) + 0.375f * (own[2 * i] + own[2 * i + 1]);
            }
        }
    };
    fold(0, 4, octants_, folded_[0]);
    fold(1, 2, folded_[0], folded_[1]);
    fold(2, 1, folded_[1], folded_[0]);
    for (std::size_t cell = 0; cell < cells; ++cell) room_[cell] = std::max(0.0f, 1 - folded_[0][cell]);
}

void ObstacleRegion::spread(Vec3 place, double volume) {
    const double h = grid_->cell_size();
    room_.assign(distance_.size(), 1);
    for (int axis = 0; axis <= 3; ++axis) {  // 3: centres
        Cell corner{};
        float upper[3];
        for (int a = 0; a < 3; ++a) {
            const double at = place[a] / h - grid_->lower()[a] - (a == axis ? 0.0 : 0.5);
            corner[a] = static_cast<int>(std::floor(at));
            upper[a] = static_cast<float>(at - corner[a]);
        }
        for (int k = 0; k < 8; ++k) {
            Cell c = corner;
            auto weight = static_cast<float>(volume / (h * h * h));
            for (int a = 0; a < 3; ++a) {
                const bool is_upper = k >> a & 1;
                c[a] += is_upper;
                weight *= is_upper ? upper[a] : 1 - upper[a];
            }
            if (axis < 3) {
                fraction_[axis][index(c)] += weight;
            } else {
                room_[index(c)] -= weight;
            }
        }
    }
}

float ObstacleRegion::room(int cell) const {
    if (distance_[cell] > 1.75f) return room_[cell];

    // Behind a thin wall nothing counts, and what lies before it is taken to the centre (ParticleCollider::place_of).
    for (int axis = 0; axis < 3 && any_thin_; ++axis) {
        const int bit = 1 << axis;
        if ((thin_[cell] & bit) || (thin_[cell + stride(axis)] & bit)) {
            return std::clamp(0.5f + distance_[cell], 0.0f, 1.5f);
        }
    }
    return room_[cell];
}

}  // namespace embody::physics::fluid
