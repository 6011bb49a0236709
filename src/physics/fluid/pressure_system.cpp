// SPDX-License-Identifier: MIT
// Preconditioned conjugate gradients; the preconditioner is the modified incomplete Cholesky factor of level zero: R.
// Bridson, "Fluid Simulation for Computer Graphics", 2nd edition 2015, 5.8.
#include "physics/fluid/pressure_system.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

// Cells of which less than this is free have no surface of their own: they take it from their neighbours.
constexpr float least_room = 0.3f;

// How far the surface lies above a centre, in cells, if the half space below it fills this share of the tent kernel.
float height_of_surface(float filled) {
    if (filled <= 0.5f) return std::sqrt(2 * std::max(filled, 0.0f)) - 1;
    return 1 - std::sqrt(2 * std::max(1 - filled, 0.0f));
}

double dot(std::span<const double> a, std::span<const double> b) {
    // Four sums that do not wait for each other, always in this order.
    double sum[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

struct MarkedCell {
    int cell;
    float surface;
};

// What the open neighbours make of a cell that is not liquid by itself. Without `and_narrow` narrow ones do not count.
void look_around(const FluidGrid& grid, int cell, bool and_narrow, std::vector<MarkedCell>& marked) {
    if (grid.surface[cell] < 0) return;
    const bool is_narrow = grid.room[cell] < least_room;
    int liquid = 0, dry = 0;
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(axis);
        for (const int side : {-1, 1}) {
            if (grid.open[axis][side < 0 ? cell : cell + stride] <= 0) continue;
            const int other = cell + side * stride;
            const bool counts = and_narrow || grid.room[other] >= least_room;
            if (grid.surface[other] < 0 && counts) {
                ++liquid;
                sum += grid.surface[other];
            } else if (grid.room[other] >= least_room) {
                ++dry;
            }
        }
    }
    if (is_narrow && liquid > 0) marked.push_back({cell, sum / static_cast<float>(liquid)});
    if (!is_narrow && liquid > 0 && dry == 0) marked.push_back({cell, -0.05f});
}

void mark(FluidGrid& grid, const std::vector<MarkedCell>& marked) {
    for (const MarkedCell& cell : marked) grid.surface[cell.cell] = cell.surface;
}

// Narrow cells are liquid beside liquid, those in corners beside such ones; holes with liquid all around are none.
void mark_beside_liquid(FluidGrid& grid, TaskPool& workers) {
    const auto tiles = grid.tiles();
    struct Found {
        std::vector<MarkedCell> marked;
        std::vector<int> narrow;
    };
    std::vector<Found> found(static_cast<std::size_t>(workers.workers()));
    share_among(workers, tiles.size(), tiles.size() > 16, [&](int worker, Share share) {
        Found& own = found[static_cast<std::size_t>(worker)];
        for (std::size_t i = share.first; i < share.last; ++i) {
            grid.for_cells(tiles[i], [&](int cell, const Cell&) {
                const std::size_t before = own.marked.size();
                look_around(grid, cell, false, own.marked);
                const bool is_dry = own.marked.size() == before && grid.surface[cell] >= 0;
                if (is_dry && grid.room[cell] < least_room && grid.solid[cell] > -1) own.narrow.push_back(cell);
            });
        }
    });
    for (const Found& own : found) mark(grid, own.marked);
    constexpr int passes = 2;
    for (int pass = 0; pass < passes; ++pass) {
        std::vector<MarkedCell> marked;
        for (const Found& own : found) {
            for (const int cell : own.narrow) look_around(grid, cell, true, marked);
        }
        mark(grid, marked);
    }
}

}  // namespace

int mark_liquid(FluidGrid& grid, TaskPool& workers) {
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            const float room = grid.room[cell];
            grid.surface[cell] = room < least_room ? 1 : -height_of_surface(grid.density[cell] / room);
        });
    });

    mark_beside_liquid(grid, workers);
    int rows = 0;
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            grid.row[cell] = -1;
            if (!(grid.surface[cell] < 0)) return;
            float open = 0;
            for (int axis = 0; axis < 3; ++axis) {
                open += grid.open[axis][cell] + grid.open[axis][cell + grid.stride(axis)];
            }
            if (open > 1e-4f) grid.row[cell] = rows++;
        });
    }
    return rows;
}

float PressureSystem::gap_share(float inside, float outside) {
    constexpr float least = 0.005f;  // nearer surfaces would make the matrix stiff
    return std::clamp(inside / (inside - std::max(outside, 0.0f)), least, 1.0f);
}

void PressureSystem::build(const FluidGrid& grid, int rows) {
    const auto count = static_cast<std::size_t>(rows);
    cells_.resize(count);
    rows_.assign(count, Row{});
    diagonal_.assign(count, 0);
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            const int row = grid.row[cell];
            if (row < 0) return;
            cells_[row] = static_cast<std::uint32_t>(cell);
            double sum = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int stride = grid.stride(axis);
                for (const bool up : {false, true}) {
                    const int other = up ? cell + stride : cell - stride;
                    const double open = grid.open[axis][up ? other : cell];
                    if (open <= 0) continue;
                    if (grid.row[other] >= 0) {
                        (up ? rows_[row].upper : rows_[row].lower)[axis] = grid.row[other];
                        (up ? rows_[row].to_upper : rows_[row].to_lower)[axis] = open;
                        sum += open;
                    } else {
                        sum += open / gap_share(grid.surface[cell], grid.surface[other]);
                    }
                }
            }
            // A trace of compressibility: a body of liquid without any surface has a pressure too.
            diagonal_[row] = sum * (1 + 1e-8) + 1e-9;
        });
    }
    factor();
    for (auto* vector : {&r_, &z_, &p_, &ap_, &q_}) vector->resize(count);
    bodies_.clear();
}

void PressureSystem::factor() {
    constexpr double modification = 0.97, safety = 0.25;
    scaling_.resize(diagonal_.size());
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
        double e = diagonal_[i];
        for (int axis = 0; axis < 3; ++axis) {
            const int j = rows_[i].lower[axis];
            if (j < 0) continue;
            const Row& other = rows_[static_cast<std::size_t>(j)];
            const double s = scaling_[static_cast<std::size_t>(j)], a = other.to_upper[axis];
            const double all = other.to_upper[0] + other.to_upper[1] + other.to_upper[2];
            e -= a * s * s * (a + modification * (all - a));
        }
        if (e < safety * diagonal_[i]) e = diagonal_[i];
        scaling_[i] = 1 / std::sqrt(e);
    }
}

void PressureSystem::precondition(std::span<const double> r, std::span<double> z) {
    const std::size_t count = diagonal_.size();
    for (std::size_t i = 0; i < count; ++i) {
        double t = r[i];
        for (int axis = 0; axis < 3; ++axis) {
            const int j = rows_[i].lower[axis];
            if (j >= 0) t += rows_[i].to_lower[axis] * scaling_[j] * q_[j];
        }
        q_[i] = t * scaling_[i];
    }
    for (std::size_t i = count; i-- > 0;) {
        double t = q_[i];
        for (int axis = 0; axis < 3; ++axis) {
            const int j = rows_[i].upper[axis];
            if (j >= 0) t += rows_[i].to_upper[axis] * scaling_[i] * z[j];
        }
        z[i] = t * scaling_[i];
    }
}

void PressureSystem::multiply(std::span<const double> x, std::span<double> y) const {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
        double sum = diagonal_[i] * x[i];
        for (int axis = 0; axis < 3; ++axis) {
            const Row& row = rows_[i];
            if (row.lower[axis] >= 0) sum -= row.to_lower[axis] * x[row.lower[axis]];
            if (row.upper[axis] >= 0) sum -= row.to_upper[axis] * x[row.upper[axis]];
        }
        y[i] = sum;
    }
    add_bodies(x, y);
}

void PressureSystem::set_bodies(std::span<const MovingSolid> bodies, double scale) {
    bodies_.clear();
    for (const MovingSolid& body : bodies) {
        if (body.solid->inverse_mass > 0 && !body.areas.empty()) bodies_.push_back(&body);
    }
    scale_ = scale;
}

void PressureSystem::add_bodies(std::span<const double> x, std::span<double> y) const {
    for (const MovingSolid* body : bodies_) {
        Vec3 impulse, moment;
        for (const SolidArea& area : body->areas) {
            impulse += area.area * x[area.row];
            moment += area.moment * x[area.row];
        }
        const Vec3 linear = impulse * (body->solid->inverse_mass * scale_);
        const Vec3 angular = body->solid->inverse_inertia * moment * scale_;
        for (const SolidArea& area : body->areas) {
            y[area.row] += embody::dot(area.area, linear) + embody::dot(area.moment, angular);
        }
    }
}

int PressureSystem::solve(std::span<const double> b, std::span<double> x, double tolerance, int most) {
    const std::size_t count = diagonal_.size();
    const auto largest = [&] {
        double value = 0;
        for (const double r : r_) value = std::fabs(r) > value ? std::fabs(r) : value;
        return value;
    };
    multiply(x, r_);
    for (std::size_t i = 0; i < count; ++i) r_[i] = b[i] - r_[i];
    if (largest() <= tolerance) return 0;
    precondition(r_, z_);
    p_ = z_;
    double rz = dot(r_, z_);
    for (int iteration = 1; iteration <= most; ++iteration) {
        multiply(p_, ap_);
        const double curvature = dot(p_, ap_);
        if (!(curvature > 0)) return most + 1;
        const double alpha = rz / curvature;
        for (std::size_t i = 0; i < count; ++i) {
            x[i] += alpha * p_[i];
            r_[i] -= alpha * ap_[i];
        }
        if (largest() <= tolerance) return iteration;
        precondition(r_, z_);
        const double next = dot(r_, z_), beta = next / rz;
        rz = next;
        for (std::size_t i = 0; i < count; ++i) p_[i] = z_[i] + beta * p_[i];
    }
    return most + 1;
}

}  // namespace embody::physics
