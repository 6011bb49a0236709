// SPDX-License-Identifier: MIT
#include "physics/fluid/grid/faces.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

// Where a face's centre is.
Vec3 face_center(const FluidGrid& grid, int axis, const Cell& c) {
    Vec3 center = grid.center(c);
    center[axis] -= grid.cell_size() / 2;
    return center;
}

// The flags of a row of eight faces at once.
std::uint64_t row_of(const std::vector<std::uint8_t>& known, int first) {
    static_assert(FluidGrid::tile[0] == sizeof(std::uint64_t));
    std::uint64_t flags = 0;
    std::memcpy(&flags, &known[static_cast<std::size_t>(first)], sizeof flags);
    return flags;
}

// Means of the known neighbours of unknown faces in a tile.
void list_next_layer(const FluidGrid& grid, const std::array<std::vector<float>, 3>& field, const Cell& corner,
                     std::vector<FaceValue>& found) {
    constexpr std::uint64_t all = 0x0101010101010101;  // eight flags that are set
    const int dy = grid.stride(1), dz = grid.stride(2);
    const int strides[3] = {1, dy, dz};
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint8_t>& known = grid.known[axis];
        grid.for_rows(corner, [&](int first, const Cell&) {
            // Most rows are wholly known or far from all known faces.
            const std::uint64_t own = row_of(known, first);
            if (own == all) return;
            const std::uint64_t beside = row_of(known, first - dy) | row_of(known, first + dy) |
                                         row_of(known, first - dz) | row_of(known, first + dz);
            if (own == 0 && beside == 0 && !known[first - 1] && !known[first + FluidGrid::tile[0]]) return;
            for (int cell = first; cell < first + FluidGrid::tile[0]; ++cell) {
                if (known[cell]) continue;
                float sum = 0;
                int count = 0;
                for (const int stride : strides) {
                    for (const int other : {cell - stride, cell + stride}) {
                        if (!known[other]) continue;
                        sum += field[axis][other];
                        ++count;
                    }
                }
                if (count > 0) found.push_back({axis, cell, sum / static_cast<float>(count)});
            }
        });
    }
}

// Gradient of the velocity at a known face, by known neighbours, 1/s.
Vec3 gradient_at(const FluidGrid& grid, int axis, int cell) {
    const std::vector<float>& u = grid.velocity[axis];
    const std::vector<std::uint8_t>& known = grid.known[axis];
    Vec3 gradient;
    for (int along = 0; along < 3; ++along) {
        const int stride = grid.stride(along);
        const int upper = known[cell + stride] ? cell + stride : cell,
                  lower = known[cell - stride] ? cell - stride : cell;
        const int cells = (upper != cell) + (lower != cell);
        if (cells > 0) gradient[along] = (u[upper] - u[lower]) / (cells * grid.cell_size());
    }
    return gradient;
}

// Velocity at a shut face that slides along the obstacle.
double sliding(const FluidGrid& grid, int axis, int cell, Vec3 center, Vec3 wall) {
    const float at[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
    float gradient[3];
    sample_center(grid, grid.obstacle, at, gradient);
    const Vec3 normal = normalized(Vec3{gradient[0], gradient[1], gradient[2]});
    const Vec3 velocity = velocity_around(grid, axis, cell);
    return velocity[axis] + normal[axis] * dot(wall - velocity, normal);
}

// Velocity at a shut face.
float followed(const FluidGrid& grid, const FluidObstacles& obstacles, const Sticking& sticking_at,
               const FaceValue& face, const Cell& c) {
    const int axis = face.axis, cell = face.cell, below = cell - grid.stride(axis);
    const int nearer = grid.obstacle[cell] < grid.obstacle[below] ? cell : below;
    const Vec3 center = face_center(grid, axis, c);
    const Vec3 wall = obstacles.velocity_at(grid.obstacle_owner[nearer], center);
    if (grid.thin[cell] & (1 << axis)) return static_cast<float>(wall[axis]);
    const double sticking = sticking_at(axis, cell);
    const double slides = sticking < 1 ? sliding(grid, axis, cell, center, wall) : 0;

    // Linear extrapolation from the velocity one face farther out through the obstacle's at its surface.
    const double inside = std::clamp(-0.5 * (grid.obstacle[cell] + grid.obstacle[below]), 0.0, 0.5);
    const double sticks = wall[axis] - (grid.velocity[axis][cell] - wall[axis]) * inside / (1 - inside);
    return static_cast<float>(slides + (sticks - slides) * sticking);
}

}  // namespace

Vec3 velocity_around(const FluidGrid& grid, int axis, int cell) {
    const int below = cell - grid.stride(axis);
    Vec3 velocity;
    for (int other = 0; other < 3; ++other) {
        const auto& field = grid.velocity[other];
        const int up = grid.stride(other);
        velocity[other] =
            other == axis ? field[cell] : 0.25 * (field[cell] + field[cell + up] + field[below] + field[below + up]);
    }
    return velocity;
}

void find_convection(FluidGrid& grid, double dt, TaskPool& workers) {
    grid.for_tiles(workers, [&](const Cell& corner) {
        for (int axis = 0; axis < 3; ++axis) {
            grid.for_cells(corner, [&](int cell, const Cell&) {
                float& convection = grid.convection[axis][cell];
                convection = 0;
                if (grid.row[cell] < 0 || grid.row[cell - grid.stride(axis)] < 0) return;
                const Vec3 gradient = gradient_at(grid, axis, cell);
                // Paths that turn by a radian in a part are not resolved.
                const double turn = length(gradient) * dt, resolved = std::max(0.0, 1 - turn * turn);
                convection = static_cast<float>(dt / 2 * resolved * dot(gradient, velocity_around(grid, axis, cell)));
            });
        }
    });
}

void find_surface_change(const FluidGrid& grid, std::vector<FaceValue>& change, TaskPool& workers) {
    const auto tiles = grid.tiles();
    std::vector<std::vector<FaceValue>> found(static_cast<std::size_t>(workers.workers()));
    const auto look_at = [&](int axis, int cell, const Cell& c, std::vector<FaceValue>& list) {
        const auto is_liquid = [&](int face) {
            return grid.open[axis][face] > 0 && (grid.row[face] >= 0 || grid.row[face - grid.stride(axis)] >= 0);
        };
        if (!(grid.mass[axis][cell] > 1e-6f) || grid.open[axis][cell] <= 0 || is_liquid(cell)) return;
        Vec3 offset;
        int count = 0;
        for (int along = 0; along < 3; ++along) {
            const int upper = is_liquid(cell + grid.stride(along)), lower = is_liquid(cell - grid.stride(along));
            offset[along] = lower - upper;
            count += lower + upper;
        }
        if (count < 2) return;
        const Vec3 center = face_center(grid, axis, c);
        const float at[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
        float gradient[3];
        (void)sample_center(grid, grid.surface, at, gradient);
        const Vec3 normal = normalized(Vec3{gradient[0], gradient[1], gradient[2]});
        offset = (offset - normal * dot(offset, normal)) * (grid.cell_size() / count);
        list.push_back({axis, cell, static_cast<float>(dot(gradient_at(grid, axis, cell), offset))});
    };
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int worker, IndexRange range) {
        auto& list = found[static_cast<std::size_t>(worker)];
        for (std::size_t i = range.first; i < range.last; ++i) {
            grid.for_cells(tiles[i], [&](int cell, const Cell& c) {
                if (grid.row[cell] >= 0) return;
                for (int axis = 0; axis < 3; ++axis) look_at(axis, cell, c, list);
            });
        }
    });
    change.clear();
    for (const auto& list : found) change.insert(change.end(), list.begin(), list.end());
}

void add_to_faces(FluidGrid& grid, std::span<const FaceValue> change) {
    for (const FaceValue& face : change) grid.velocity[face.axis][face.cell] += face.value;
}

void extrapolate(FluidGrid& grid, std::array<std::vector<float>, 3>& field, int layers, TaskPool& workers) {
    const auto tiles = grid.tiles();
    std::vector<std::vector<FaceValue>> found(static_cast<std::size_t>(workers.workers()));
    for (int layer = 0; layer < layers; ++layer) {
        parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int worker, IndexRange range) {
            auto& list = found[static_cast<std::size_t>(worker)];
            list.clear();
            for (std::size_t i = range.first; i < range.last; ++i) list_next_layer(grid, field, tiles[i], list);
        });
        for (auto& list : found) {
            for (const FaceValue& face : list) {
                field[face.axis][face.cell] = face.value;
                grid.known[face.axis][face.cell] = 1;
            }
            list.clear();
        }
    }
}

void admit_drops(FluidGrid& grid, TaskPool& workers) {
    grid.for_tiles(workers, [&](const Cell& corner) {
        for (int axis = 0; axis < 3; ++axis) {
            grid.for_cells(corner, [&](int cell, const Cell&) {
                const bool has_drops = grid.open[axis][cell] > 0 && grid.mass[axis][cell] > 1e-6f;
                grid.known[axis][cell] = grid.known[axis][cell] || has_drops;
            });
        }
    });
}

void follow_obstacles(FluidGrid& grid, const FluidObstacles& obstacles, const Sticking& sticking, TaskPool& workers) {
    const auto tiles = grid.tiles();
    std::vector<std::vector<FaceValue>> found(static_cast<std::size_t>(workers.workers()));
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int worker, IndexRange range) {
        auto& list = found[static_cast<std::size_t>(worker)];
        for (std::size_t i = range.first; i < range.last; ++i) {
            grid.for_cells(tiles[i], [&](int cell, const Cell& c) {
                for (int axis = 0; axis < 3; ++axis) {
                    if (grid.open[axis][cell] > 0 || !grid.known[axis][cell]) continue;
                    list.push_back({axis, cell, followed(grid, obstacles, sticking, {axis, cell, 0}, c)});
                }
            });
        }
    });
    for (const auto& list : found) {
        for (const FaceValue& face : list) grid.velocity[face.axis][face.cell] = face.value;
    }
}

void outflow(const FluidGrid& grid, const FluidObstacles& obstacles, const PressureSystem& system,
             std::vector<double>& flow, TaskPool& workers) {
    flow.resize(system.size());
    const double area = grid.cell_size() * grid.cell_size();
    parallel_for(workers, flow.size(), flow.size() > 2000, [&](int, IndexRange range) {
        for (std::size_t row = range.first; row < range.last; ++row) {
            const auto cell = static_cast<int>(system.cell(row));
            double sum = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int above = cell + grid.stride(axis);
                const auto& open = grid.open[axis];
                const auto &velocity = grid.velocity[axis], &convection = grid.convection[axis];
                sum += static_cast<double>(open[above]) * (velocity[above] - convection[above]);
                sum -= static_cast<double>(open[cell]) * (velocity[cell] - convection[cell]);
            }
            flow[row] = sum * area;
        }
    });
    for (const MovingObstacle& obstacle : obstacles.moving()) {
        for (const ObstacleArea& part : obstacle.areas) {
            flow[part.row] += dot(part.area, obstacle.linear_velocity) + dot(part.moment, obstacle.angular_velocity);
        }
    }
}

void add_surface_pressure(const FluidGrid& grid, const PressureSystem& system, const SurfacePressure& surface,
                          std::vector<double>& b, TaskPool& workers) {
    parallel_for(workers, b.size(), b.size() > 2000, [&](int, IndexRange range) {
        for (std::size_t row = range.first; row < range.last; ++row) {
            const auto cell = static_cast<int>(system.cell(row));
            for (int axis = 0; axis < 3; ++axis) {
                const int stride = grid.stride(axis);
                for (const int other : {cell - stride, cell + stride}) {
                    const float open = grid.open[axis][std::max(cell, other)];
                    if (open <= 0 || grid.row[other] >= 0) continue;
                    const float gap = system.gap_fraction(grid.surface[cell], grid.surface[other]);
                    b[row] += static_cast<double>(open * grid.mobility_at(axis, std::max(cell, other))) / gap *
                              surface.at(cell, other, gap);
                }
            }
        }
    });
}

void subtract_gradient(FluidGrid& grid, const PressureGradient& gradient, std::array<std::vector<float>, 3>& field,
                       TaskPool& workers) {
    const PressureSystem& system = gradient.system;
    const std::span<const double> x = gradient.x;
    const SurfacePressure& surface = gradient.surface;
    const double scale = gradient.scale;
    grid.for_tiles(workers, [&](const Cell& corner) {
        for (int axis = 0; axis < 3; ++axis) {
            const int stride = grid.stride(axis);
            grid.for_cells(corner, [&](int cell, const Cell&) {
                const int below = cell - stride, upper = grid.row[cell], lower = grid.row[below];
                std::uint8_t& known = grid.known[axis][cell];
                if (grid.open[axis][cell] <= 0) {
                    known = 0;
                    return;
                }
                if (upper < 0 && lower < 0) {
                    known = 0;
                    return;
                }
                double difference = 0;
                if (upper >= 0 && lower >= 0) {
                    difference = x[upper] - x[lower];
                } else {
                    const int liquid = upper >= 0 ? cell : below, air = upper >= 0 ? below : cell;
                    const float gap = system.gap_fraction(grid.surface[liquid], grid.surface[air]);
                    const double outside = surface.is_none() ? 0 : surface.at(liquid, air, gap);
                    difference = (x[grid.row[liquid]] - outside) / (upper >= 0 ? gap : -gap);
                }
                field[axis][cell] -= static_cast<float>(difference * scale * grid.mobility_at(axis, cell));
                known = 1;
            });
        }
    });
}

void subtract_last_gradient(FluidGrid& grid, double scale, TaskPool& workers) {
    grid.for_tiles(workers, [&](const Cell& corner) {
        for (int axis = 0; axis < 3; ++axis) {
            const int stride = grid.stride(axis);
            const auto has_pressure = [&](int cell) { return grid.row[cell] >= 0 && grid.pressure[cell] != 0; };
            const auto difference = [&](int cell) -> float {
                if (grid.open[axis][cell] <= 0 || !has_pressure(cell) || !has_pressure(cell - stride)) return 0;
                return grid.pressure[cell] - grid.pressure[cell - stride];
            };
            grid.for_cells(corner, [&](int cell, const Cell&) {
                if (!grid.known[axis][cell] || grid.open[axis][cell] <= 0) return;
                const bool above = has_pressure(cell), below = has_pressure(cell - stride);
                float change = 0;
                if (above && below) {
                    change = difference(cell);
                } else if (above || below) {
                    change = difference(above ? cell + stride : cell - stride);
                }
                grid.velocity[axis][cell] -= static_cast<float>(change * scale * grid.mobility_at(axis, cell));
            });
        }
    });
}

}  // namespace embody::physics::fluid
