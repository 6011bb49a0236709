// SPDX-License-Identifier: MIT
// C. Batty, R. Bridson, "Accurate viscous free surfaces for buckling, coiling, and rotating liquids", 2008: the step
// minimises ½ ρ |u − u*|² + dt μ |D|² over the liquid, D the symmetric gradient, which needs no condition at the
// surface and keeps angular momentum. We add walls at their true distance, and bodies as unknowns.
#include "physics/fluid/pressure/viscosity.h"

#include <algorithm>
#include <cmath>

#include "physics/linear/vectors.h"

namespace embody::physics::fluid {

namespace {

Vec3 face_center(const FluidGrid& grid, int axis, const Cell& c) {
    Vec3 center = grid.center(c);
    center[axis] -= grid.cell_size() / 2;
    return center;
}

// Fraction of a cell below the surface.
float filled(const FluidGrid& grid, int cell) { return std::clamp(0.5f - grid.surface[cell], 0.0f, 1.0f); }

}  // namespace

bool is_viscous(const FluidProperties& liquid, const FluidViscositySettings& settings, double h, double dt) {
    return liquid.yield_stress > 0 || liquid.viscosity / liquid.density * dt / (h * h) > settings.min_diffusion_number;
}

double sticking_of(const FluidProperties& liquid, const FluidViscositySettings& settings, double h, double speed) {
    constexpr double min_viscosity = 1e-12;  // Pa s: only not zero; the thinnest liquids have 1e-4
    const double layer = settings.stick_reynolds, rate = std::max(speed, settings.min_stick_speed) / h;
    const double reynolds =
        liquid.density * rate * h * h / std::max(liquid.viscosity + liquid.yield_stress / rate, min_viscosity);
    return 1 / (1 + (reynolds / layer) * (reynolds / layer));
}

// The unknowns are the open faces of cells with liquid; their inertia is the liquid in their control volume.
void ViscositySystem::number_faces(const FluidGrid& grid, const FluidObstacles& obstacles) {
    faces_.clear();
    fixed_.clear();
    inertia_.clear();
    const float min_fraction = settings_.min_fraction;
    const std::size_t cells = grid.row.size();
    for (auto& numbers : number_) {
        if (numbers.size() != cells) numbers.assign(cells, -1);
    }
    if (viscosity_.size() != cells) viscosity_.assign(cells, 0);
    for (const Cell& corner : grid.tiles()) {
        for (int axis = 0; axis < 3; ++axis) {
            grid.for_cells(corner, [&](int cell, const Cell&) {
                number_[axis][cell] = -1;
                const int below = cell - grid.stride(axis);
                if (!(grid.open[axis][cell] > 0) || !grid.known[axis][cell]) return;
                if (grid.row[cell] < 0 && grid.row[below] < 0) return;
                const float liquid = (filled(grid, cell) + filled(grid, below)) / 2;
                number_[axis][cell] = static_cast<std::int32_t>(faces_.size());
                faces_.emplace_back(axis, cell);
                inertia_.push_back(std::max(min_fraction, grid.open[axis][cell] * liquid) *
                                   grid.relative_density(axis, cell));
            });
        }
    }
    body_of_.assign(obstacles.moving().size(), -1);
}

// Numbers a shut face, which moves as its obstacle does, after the unknown ones.
std::int32_t ViscositySystem::fixed_face(const FluidGrid& grid, const FluidObstacles& obstacles, int axis, int cell,
                                         const Cell& c) {
    std::int32_t& number = number_[axis][cell];
    if (number != -1) return number;
    const int below = cell - grid.stride(axis);
    const int owner = grid.obstacle_owner[grid.obstacle[cell] < grid.obstacle[below] ? cell : below];
    Vec3 arm;
    if (owner >= 0) arm = face_center(grid, axis, c) - obstacles.moving()[static_cast<std::size_t>(owner)].center;
    number = static_cast<std::int32_t>(faces_.size() + fixed_.size());
    fixed_.push_back({axis, owner, arm});
    return number;
}

// Bingham: μ + τ / rate, from the rates of strain before the step. Of several liquids in a cell the fluidities count by
// their volumes, as in layers that lie on each other.
void ViscositySystem::measure_rates(const Mixture& liquids, double dt, const FluidGrid& grid) {
    constexpr double min_rate = 1e-6, min_viscosity = 1e-9;  // 1/s, Pa s: only not zero
    const double h = grid.cell_size();
    const bool can_yield = std::ranges::any_of(liquids.liquids(), [](const auto& of) { return of.yield_stress > 0; });
    const float min_fraction = settings_.min_fraction;
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            const float fraction = filled(grid, cell);
            viscosity_[cell] = 0;
            if (grid.row[cell] < 0 && fraction < min_fraction) return;
            double squares = 0;
            if (can_yield) {
                const auto at_center = [&](int axis, int at) {
                    return 0.5 * (grid.velocity[axis][at] + grid.velocity[axis][at + grid.stride(axis)]);
                };
                for (int a = 0; a < 3; ++a) {
                    for (int b = a; b < 3; ++b) {
                        const int da = grid.stride(a), db = grid.stride(b);
                        const double rate = a == b ? (grid.velocity[a][cell + da] - grid.velocity[a][cell]) / h
                                                   : (at_center(a, cell + db) - at_center(a, cell - db) +
                                                      at_center(b, cell + da) - at_center(b, cell - da)) /
                                                         (4 * h);
                        squares += (a == b ? 2 : 4) * rate * rate;
                    }
                }
            }
            const auto viscosity_of = [&](const FluidProperties& liquid) {
                double viscosity = liquid.viscosity;
                if (liquid.yield_stress > 0) viscosity += liquid.yield_stress / std::max(std::sqrt(squares), min_rate);
                const double most = settings_.max_diffusion_number * liquid.density * h * h / dt;
                return std::max(std::min(viscosity, most), min_viscosity);
            };
            const auto fluidity_of = [&](const FluidProperties& liquid) { return 1 / viscosity_of(liquid); };
            viscosity_[cell] = static_cast<float>(liquids.is_one() ? viscosity_of(liquids.first())
                                                                   : 1 / liquids.mean(grid, cell, fluidity_of));
        });
    }
}

// The strain of axes a and b at the edge of the cell's lower faces of both.
void ViscositySystem::add_edge(const FluidGrid& grid, const FluidObstacles& obstacles, int a, int b, int cell,
                               const Cell& c, double scale) {
    const int da = grid.stride(a), db = grid.stride(b);
    const int cells[4] = {cell, cell - da, cell - db, cell - da - db};
    // The harmonic mean: liquid that does not yield must not hold liquid beside it that does.
    double fraction = 0, fluidity = 0;
    int count = 0, liquid = 0;
    for (const int other : cells) {
        if (viscosity_[other] > 0) {
            fluidity += 1 / viscosity_[other];
            fraction += filled(grid, other);
            ++liquid;
        }
        count += viscosity_[other] > 0 || grid.obstacle[other] >= 0;
    }
    if (!(fraction > 0)) return;
    const double viscosity = fraction / count * liquid / fluidity;

    // u_a above and below along b, u_b above and below along a. Faces in air carry no stress.
    struct Side {
        int axis, cell, across;
        bool is_upper;
    };
    const Side sides[4] = {{a, cell, b, true}, {a, cell - db, b, false}, {b, cell, a, true}, {b, cell - da, a, false}};
    Strain strain{};
    double nearest_wall = 1;
    bool any_free = false;
    for (int k = 0; k < 4; ++k) {
        const Side& side = sides[k];
        std::int32_t number = number_[side.axis][side.cell];
        if (number < 0) {
            if (grid.open[side.axis][side.cell] > 0) return;
            Cell place = c;
            if (!side.is_upper) --place[side.across];
            number = fixed_face(grid, obstacles, side.axis, side.cell, place);
        }
        const bool is_free = number < static_cast<std::int32_t>(faces_.size());
        any_free = any_free || is_free;
        strain.face[k] = number;
        const int partner = sides[k ^ 1].cell;
        if (is_free && !(grid.open[side.axis][partner] > 0)) {
            const double distance =
                0.5 * (grid.obstacle[side.cell] + grid.obstacle[side.cell - grid.stride(side.axis)]);
            nearest_wall = std::min(nearest_wall, std::max(distance, settings_.min_wall_distance));
        }
    }
    if (!any_free) return;
    strain.weight = scale * viscosity / nearest_wall;
    strains_.push_back(strain);
}

void ViscositySystem::list_strains(const FluidGrid& grid, const FluidObstacles& obstacles, double scale) {
    strains_.clear();
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell& c) {
            for (int a = 0; a < 3 && viscosity_[cell] > 0; ++a) {
                Cell next = c;
                ++next[a];
                const int above = cell + grid.stride(a);
                const auto number = [&](int at, const Cell& place) {
                    if (number_[a][at] >= 0) return number_[a][at];
                    return grid.open[a][at] > 0 ? -1 : fixed_face(grid, obstacles, a, at, place);
                };
                const std::int32_t upper = number(above, next), lower = number(cell, c);
                if (upper < 0 || lower < 0) continue;
                strains_.push_back({{upper, lower, -1, -1}, 2 * scale * viscosity_[cell] * filled(grid, cell)});
            }
            add_edge(grid, obstacles, 0, 1, cell, c, scale);
            add_edge(grid, obstacles, 1, 2, cell, c, scale);
            add_edge(grid, obstacles, 2, 0, cell, c, scale);
        });
    }
}

void ViscositySystem::list_bodies(double density, const FluidGrid& grid, const FluidObstacles& obstacles) {
    bodies_.clear();
    const double h = grid.cell_size(), unit = density * h * h * h;
    for (const FixedFace& face : fixed_) {
        if (face.owner < 0 || body_of_[face.owner] >= 0) continue;
        const MovingObstacle& moving = obstacles.moving()[static_cast<std::size_t>(face.owner)];
        if (!(moving.obstacle->inverse_mass > 0)) continue;
        body_of_[face.owner] = static_cast<std::int32_t>(bodies_.size());
        bodies_.push_back({face.owner, 1 / moving.obstacle->inverse_mass / unit,
                           inverse_or_zero(moving.obstacle->inverse_inertia) * (1 / unit), moving.linear_velocity,
                           moving.angular_velocity});
    }
}

// Fixed faces from the bodies' unknowns.
void ViscositySystem::set_fixed(std::vector<double>& x) const {
    const std::size_t free = faces_.size();
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        const FixedFace& face = fixed_[i];
        const int body = face.owner < 0 ? -1 : body_of_[face.owner];
        if (body < 0) continue;
        const double* unknown = &x[free + fixed_.size() + 6 * static_cast<std::size_t>(body)];
        const Vec3 linear{unknown[0], unknown[1], unknown[2]}, angular{unknown[3], unknown[4], unknown[5]};
        x[free + i] = (linear + cross(angular, face.arm))[face.axis];
    }
}

// y = A x. x: free faces, fixed faces (set here where a body moves them), bodies. Fixed ones have no row of their own.
void ViscositySystem::multiply(std::vector<double>& x, std::vector<double>& y) {
    const std::size_t free = faces_.size(), faces = free + fixed_.size();
    set_fixed(x);
    for (std::size_t i = 0; i < free; ++i) y[i] = inertia_[i] * x[i];
    std::fill(y.begin() + static_cast<std::ptrdiff_t>(free), y.end(), 0.0);
    for (const Strain& strain : strains_) {
        if (strain.face[2] < 0) {
            const double stress = strain.weight * (x[strain.face[0]] - x[strain.face[1]]);
            y[strain.face[0]] += stress;
            y[strain.face[1]] -= stress;
            continue;
        }
        const double stress =
            strain.weight * (x[strain.face[0]] - x[strain.face[1]] + x[strain.face[2]] - x[strain.face[3]]);
        y[strain.face[0]] += stress;
        y[strain.face[1]] -= stress;
        y[strain.face[2]] += stress;
        y[strain.face[3]] -= stress;
    }
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        const FixedFace& face = fixed_[i];
        const int body = face.owner < 0 ? -1 : body_of_[face.owner];
        if (body >= 0) {
            Vec3 axis;
            axis[face.axis] = y[free + i];
            double* row = &y[faces + 6 * static_cast<std::size_t>(body)];
            const Vec3 moment = cross(face.arm, axis);
            for (int k = 0; k < 3; ++k) {
                row[k] += axis[k];
                row[3 + k] += moment[k];
            }
        }
        y[free + i] = 0;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double* unknown = &x[faces + 6 * i];
        const Vec3 spin = bodies_[i].inertia * Vec3{unknown[3], unknown[4], unknown[5]};
        for (int k = 0; k < 3; ++k) {
            y[faces + 6 * i + static_cast<std::size_t>(k)] += bodies_[i].mass * unknown[k];
            y[faces + 6 * i + 3 + static_cast<std::size_t>(k)] += spin[k];
        }
    }
}

// The present velocities of faces, obstacles and bodies.
void ViscositySystem::start_from(const FluidGrid& grid, const FluidObstacles& obstacles) {
    const std::size_t free = faces_.size(), faces = free + fixed_.size();
    for (std::size_t i = 0; i < free; ++i) x_[i] = grid.velocity[faces_[i].first][faces_[i].second];
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        if (fixed_[i].owner < 0) continue;
        const MovingObstacle& moving = obstacles.moving()[static_cast<std::size_t>(fixed_[i].owner)];
        x_[free + i] = (moving.linear_velocity + cross(moving.angular_velocity, fixed_[i].arm))[fixed_[i].axis];
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            x_[faces + 6 * i + static_cast<std::size_t>(k)] = bodies_[i].linear_before[k];
            x_[faces + 6 * i + 3 + static_cast<std::size_t>(k)] = bodies_[i].angular_before[k];
        }
    }
}

void ViscositySystem::fill_diagonal() {
    const std::size_t free = faces_.size(), faces = free + fixed_.size();
    for (std::size_t i = 0; i < free; ++i) diagonal_[i] = inertia_[i];
    for (const Strain& strain : strains_) {
        for (const std::int32_t face : strain.face) {
            if (face >= 0) diagonal_[face] += strain.weight;
        }
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
            diagonal_[faces + 6 * i + k] = k < 3 ? bodies_[i].mass : trace(bodies_[i].inertia) / 3;
        }
    }
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        const int body = fixed_[i].owner < 0 ? -1 : body_of_[fixed_[i].owner];
        if (body < 0) continue;
        for (std::size_t k = 0; k < 6; ++k) {
            diagonal_[faces + 6 * static_cast<std::size_t>(body) + k] +=
                diagonal_[free + i] * (k < 3 ? 1 : length_squared(fixed_[i].arm)) / 3;
        }
    }
}

// r = M u* − A u*: the effect of the strains on the present velocities.
void ViscositySystem::fill_residual() {
    const std::size_t free = faces_.size(), faces = free + fixed_.size();
    multiply(x_, r_);
    for (std::size_t i = 0; i < free; ++i) r_[i] = inertia_[i] * x_[i] - r_[i];
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double* u = &x_[faces + 6 * i];
        const Vec3 spin = bodies_[i].inertia * Vec3{u[3], u[4], u[5]};
        for (int k = 0; k < 3; ++k) {
            double* row = &r_[faces + 6 * i];
            row[k] = bodies_[i].mass * u[k] - row[k];
            row[3 + k] = spin[k] - row[3 + k];
        }
    }
}

// z = D⁻¹ r, D the diagonal; r·z.
GradientResidual ViscositySystem::precondition() {
    const std::size_t free = faces_.size(), faces = free + fixed_.size();
    for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = i >= free && i < faces ? 0 : r_[i] / diagonal_[i];
    const double product = dot_product(r_, z_);
    return {product, product};
}

int ViscositySystem::iterate() {
    struct System {
        ViscositySystem& of;
        GradientResidual begin() { return of.precondition(); }
        void turn(double beta) { turn_direction(beta, of.z_, of.p_); }
        double multiply() {
            of.multiply(of.p_, of.q_);
            return dot_product(of.p_, of.q_);
        }
        GradientResidual advance(double alpha) {
            step_along(alpha, of.p_, of.q_, of.x_, of.r_);
            return of.precondition();
        }
    };
    const double tolerance = settings_.tolerance;
    const int most = settings_.max_iterations;
    System system{*this};
    const auto result = conjugate_gradient(system, {.iterations = most, .relative = tolerance * tolerance});
    return result.end == GradientEnd::converged ? result.iterations : most + 1;
}

void ViscositySystem::begin(const Mixture& liquids, double dt, const FluidViscositySettings& settings,
                            const FluidGrid& grid, const FluidObstacles& obstacles) {
    settings_ = settings;
    number_faces(grid, obstacles);
    measure_rates(liquids, dt, grid);
}

int ViscositySystem::solve(const Mixture& liquids, double dt, FluidGrid& grid, FluidObstacles& obstacles) {
    const double h = grid.cell_size(), density = liquids.first().density;
    list_strains(grid, obstacles, dt / (density * h * h));
    list_bodies(density, grid, obstacles);
    const std::size_t size = faces_.size() + fixed_.size() + 6 * bodies_.size();
    for (auto* vector : {&x_, &r_, &z_, &p_, &q_, &diagonal_}) vector->assign(size, 0);
    start_from(grid, obstacles);
    fill_diagonal();
    fill_residual();
    const int iterations = iterate();
    write_back(density, grid, obstacles);
    return iterations;
}

void ViscositySystem::write_back(double density, FluidGrid& grid, FluidObstacles& obstacles) {
    const std::size_t faces = faces_.size() + fixed_.size();
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        grid.velocity[faces_[i].first][faces_[i].second] = static_cast<float>(x_[i]);
    }
    const double h = grid.cell_size(), unit = density * h * h * h;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        MovingObstacle& moving = obstacles.moving()[static_cast<std::size_t>(body.owner)];
        const double* u = &x_[faces + 6 * i];
        moving.linear_velocity = {u[0], u[1], u[2]};
        moving.angular_velocity = {u[3], u[4], u[5]};
        moving.obstacle->impulse += (moving.linear_velocity - body.linear_before) * (body.mass * unit);
        moving.obstacle->angular_impulse += body.inertia * (moving.angular_velocity - body.angular_before) * unit;
    }
}

}  // namespace embody::physics::fluid
