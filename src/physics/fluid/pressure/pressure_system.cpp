// SPDX-License-Identifier: MIT
// The conjugate gradient's preconditioner is the modified incomplete Cholesky factor of level zero (R. Bridson, "Fluid
// Simulation for Computer Graphics", 2nd edition 2015, 5.3). Workers sweep strips of tiles side by side, each a layer
// behind the one before: what is computed is the same as row by row. Sums are taken by blocks, whose number depends on
// the rows alone.
#include "physics/fluid/pressure/pressure_system.h"

#include <algorithm>
#include <cmath>

#include "physics/fluid/grid/liquid_cells.h"
#include "physics/linear/conjugate_gradient.h"
#include "physics/linear/vectors.h"

namespace embody::physics::fluid {

namespace {

// Minimum rows of a block, and maximum number of blocks (an array's capacity): workers take sums by blocks.
constexpr std::size_t rows_of_block = 512, max_blocks = 16;

template <class Vector>
auto part_of(Vector& all, IndexRange block) {
    return std::span(all).subspan(block.first, block.last - block.first);
}

double largest_of(std::span<const double> values) {
    double largest = 0;
    for (const double value : values) largest = std::fabs(value) > largest ? std::fabs(value) : largest;
    return largest;
}

}  // namespace

float PressureSystem::gap_fraction(float inside, float outside) const {
    return std::clamp(inside / (inside - std::max(outside, 0.0f)), settings_.min_gap, 1.0f);
}

void PressureSystem::build_row(const FluidGrid& grid, std::size_t row) {
    const auto cell = static_cast<int>(liquid_.cells[row]), none = static_cast<int>(size());
    Row& own = rows_[row];
    own = {};
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(static_cast<int>(axis));
        const bool has_immersed = !grid.liquid_conductance[axis].empty();
        const auto& conductance = has_immersed ? grid.liquid_conductance[axis] : grid.open[axis];
        for (const bool up : {false, true}) {
            const int other = up ? cell + stride : cell - stride, face = up ? other : cell;
            const float mobility = grid.mobility_at(static_cast<int>(axis), face);
            const float liquid = conductance[face] * mobility,
                        solid = has_immersed ? grid.solid_conductance[axis][face] * mobility : 0;
            std::int32_t& neighbour = (up ? own.upper : own.lower)[axis];
            neighbour = none;
            if (liquid <= 0) continue;
            if (grid.row[other] < 0) {
                sum += static_cast<double>(liquid) / gap_fraction(grid.surface[cell], grid.surface[other]) + solid;
                continue;
            }
            neighbour = grid.row[other];
            (up ? own.to_upper : own.to_lower)[axis] = liquid + solid;
            sum += liquid + solid;
        }
    }
    // A small compressibility: liquid without any surface then has a definite pressure, too.
    diagonal_[row] = sum * (1 + 1e-8) + 1e-9;
}

void PressureSystem::build(FluidGrid& grid, const FluidSettings& settings, TaskPool& workers) {
    settings_ = settings.pressure;
    mark_liquid(grid, settings.cells, liquid_, workers);
    const std::size_t count = size();
    blocks_ = std::clamp<std::size_t>(count / rows_of_block, 1, max_blocks);
    rows_.resize(count + 1);
    const auto none = static_cast<std::int32_t>(count);
    rows_[count] = Row{{none, none, none}, {none, none, none}, {}, {}, {}, {}};
    diagonal_.resize(count);
    scaling_.resize(count);
    for (auto* vector : {&r_, &z_, &p_, &q_, &y_}) vector->assign(count + 1, 0);
    parallel_for(workers, blocks_, blocks_ > 1, [&](int, IndexRange range) {
        for (std::size_t block = range.first; block < range.last; ++block) {
            const IndexRange rows = block_of(block);
            for (std::size_t row = rows.first; row < rows.last; ++row) build_row(grid, row);
        }
    });
    factor();
    make_strips(grid, blocks_ > 1 ? workers.workers() : 1);
    set_bodies({}, 0);
}

// Two strips of tiles along one axis, layers along another: the axes with the largest number of tiles.
void PressureSystem::make_strips(const FluidGrid& grid, int workers) {
    strips_.assign(static_cast<std::size_t>(workers), {});
    if (workers == 1) {
        strips_[0].layers = {{IndexRange{0, size()}}};
        return;
    }
    const auto tiles = grid.tiles();
    std::array<std::vector<std::size_t>, 3> rows;  // by axis and tile along it
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int unit = FluidGrid::tile[axis];
        rows[axis].assign(static_cast<std::size_t>(grid.size()[axis] / unit), 0);
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            rows[axis][static_cast<std::size_t>(tiles[i][axis] / unit)] +=
                static_cast<std::size_t>(liquid_.first_row[i + 1] - liquid_.first_row[i]);
        }
    }
    const auto extent = [&](std::size_t axis) {
        return rows[axis].size() - static_cast<std::size_t>(std::count(rows[axis].begin(), rows[axis].end(), 0u));
    };
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](std::size_t a, std::size_t b) { return extent(a) > extent(b); });
    const std::size_t along = axes[0], across = axes[1];

    // Strips of as equal numbers of rows as tiles allow.
    std::vector<std::size_t> strip_of(rows[across].size());
    for (std::size_t i = 0, before = 0; i < strip_of.size(); before += rows[across][i++]) {
        const std::size_t middle = before + rows[across][i] / 2;
        strip_of[i] = std::min(strips_.size() - 1, middle * strips_.size() / std::max<std::size_t>(size(), 1));
    }
    for (Strip& strip : strips_) strip.layers.resize(rows[along].size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto first = static_cast<std::size_t>(liquid_.first_row[i]),
                   last = static_cast<std::size_t>(liquid_.first_row[i + 1]);
        if (first == last) continue;
        const std::size_t strip = strip_of[static_cast<std::size_t>(tiles[i][across] / FluidGrid::tile[across])];
        strips_[strip].layers[static_cast<std::size_t>(tiles[i][along] / FluidGrid::tile[along])].push_back(
            {first, last});
    }
}

// L Lᵀ with L = (D − lower part) / D, D = 1 / scaling²; rows are scaled such that L has ones on its diagonal.
void PressureSystem::factor() {
    const double modification = settings_.cholesky_modification, safety = settings_.cholesky_safety;
    const auto none = static_cast<std::int32_t>(size());
    for (std::size_t i = 0; i < size(); ++i) {
        Row& row = rows_[i];
        double e = diagonal_[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (row.lower[axis] == none) continue;
            const auto j = static_cast<std::size_t>(row.lower[axis]);
            const auto& upper = rows_[j].to_upper;
            const double s = scaling_[j], a = upper[axis], all = static_cast<double>(upper[0]) + upper[1] + upper[2];
            e -= a * s * s * (a + modification * (all - a));
        }
        if (e < safety * diagonal_[i]) e = diagonal_[i];
        scaling_[i] = 1 / std::sqrt(e);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (row.lower[axis] == none) continue;
            const auto j = static_cast<std::size_t>(row.lower[axis]);
            row.factor_lower[axis] = static_cast<float>(row.to_lower[axis] * (scaling_[i] * scaling_[j]));
            rows_[j].factor_upper[axis] = row.factor_lower[axis];
        }
    }
}

void PressureSystem::substitute_forward(IndexRange rows) {
    for (std::size_t i = rows.first; i < rows.last; ++i) {
        const Row& row = rows_[i];
        // The previous row's term comes last: the wait for its result takes the time.
        double t = r_[i] * scaling_[i];
        t += row.factor_lower[2] * y_[row.lower[2]];
        t += row.factor_lower[1] * y_[row.lower[1]];
        y_[i] = t + row.factor_lower[0] * y_[row.lower[0]];
    }
}

void PressureSystem::substitute_backward(IndexRange rows) {
    for (std::size_t i = rows.last; i-- > rows.first;) {
        const Row& row = rows_[i];
        double t = y_[i];
        t += row.factor_upper[2] * y_[row.upper[2]];
        t += row.factor_upper[1] * y_[row.upper[1]];
        t += row.factor_upper[0] * y_[row.upper[0]];
        y_[i] = t;
        z_[i] = t * scaling_[i];
    }
}

void PressureSystem::multiply(IndexRange block, std::span<const double> x, std::span<double> y) const {
    for (std::size_t i = block.first; i < block.last; ++i) {
        const Row& row = rows_[i];
        double sum = diagonal_[i] * x[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum -= row.to_lower[axis] * x[row.lower[axis]];
            sum -= row.to_upper[axis] * x[row.upper[axis]];
        }
        y[i] = sum;
    }
}

void PressureSystem::set_bodies(std::span<const MovingObstacle> bodies, double scale) {
    scale_ = scale;
    bodies_.clear();
    parts_.clear();
    for (const MovingObstacle& body : bodies) {
        if (body.obstacle->inverse_mass <= 0 || body.areas.empty()) continue;
        for (const ObstacleArea& area : body.areas) {
            parts_.push_back({area.row, static_cast<std::int32_t>(bodies_.size()), area.area, area.moment});
        }
        bodies_.push_back(&body);
    }
    velocities_.resize(bodies_.size());
    std::stable_sort(parts_.begin(), parts_.end(), [](const BodyPart& a, const BodyPart& b) { return a.row < b.row; });
    first_part_.clear();
    for (std::size_t block = 0, part = 0; block <= blocks_; ++block) {
        const std::size_t row = block < blocks_ ? block_of(block).first : size();
        while (part < parts_.size() && static_cast<std::size_t>(parts_[part].row) < row) ++part;
        first_part_.push_back(static_cast<std::uint32_t>(part));
    }
}

// Change of a body's velocity by the pressure x.
void PressureSystem::move_body(std::size_t body, std::span<const double> x) {
    Vec3 impulse, moment;
    for (const ObstacleArea& area : bodies_[body]->areas) {
        impulse += area.area * x[area.row];
        moment += area.moment * x[area.row];
    }
    const ObstacleResponse& response = bodies_[body]->response;
    velocities_[body] = {response.linear_change(impulse, moment) * scale_,
                         response.angular_change(impulse, moment) * scale_};
}

/// State that is common to the workers of a solve.
struct PressureSystem::Run {
    std::span<const double> b;
    std::vector<double>& x;
    Barrier barrier;
    std::array<double, max_blocks> curvature{};           // by block
    std::array<GradientResidual, max_blocks> residual{};  // by block
    std::vector<Progress> progress;                       // by worker
};

// z = (L Lᵀ)⁻¹ r. `time`: number of such solves before.
void PressureSystem::precondition(Run& run, int worker, std::uint64_t time) {
    const auto own = static_cast<std::size_t>(worker);
    const auto& layers = strips_[own].layers;
    std::uint64_t done = 2 * time * layers.size();
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
        ++done;
        if (own > 0) run.progress[own - 1].wait_for(done);
        for (const IndexRange rows : layers[layer]) substitute_forward(rows);
        run.progress[own].reach(done);
    }
    for (std::size_t layer = layers.size(); layer-- > 0;) {
        ++done;
        if (own + 1 < strips_.size()) run.progress[own + 1].wait_for(done);
        for (std::size_t i = layers[layer].size(); i-- > 0;) substitute_backward(layers[layer][i]);
        run.progress[own].reach(done);
    }
}

/// The system for one worker. When a function returns, all vectors but q are complete for all workers.
struct PressureSystem::WorkerSystem {
    PressureSystem& of;
    Run& run;
    int worker;
    IndexRange blocks, bodies;
    std::uint64_t times = 0;  // number of times that z was found

    GradientResidual begin() {
        apply(run.x);
        for_blocks([&](std::size_t, IndexRange rows) {
            for (std::size_t i = rows.first; i < rows.last; ++i) of.r_[i] = run.b[i] - of.q_[i];
        });
        return precondition();
    }
    void turn(double beta) {
        for_blocks(
            [&](std::size_t, IndexRange rows) { turn_direction(beta, part_of(of.z_, rows), part_of(of.p_, rows)); });
        run.barrier.wait();
    }
    double multiply() {
        apply(of.p_);
        for_blocks([&](std::size_t block, IndexRange rows) {
            run.curvature[block] = dot_product(part_of(of.p_, rows), part_of(of.q_, rows));
        });
        run.barrier.wait();
        double sum = 0;
        for (std::size_t block = 0; block < of.blocks_; ++block) sum += run.curvature[block];
        return sum;
    }
    GradientResidual advance(double alpha) {
        for_blocks([&](std::size_t, IndexRange rows) {
            step_along(alpha, part_of(of.p_, rows), part_of(of.q_, rows), part_of(run.x, rows), part_of(of.r_, rows));
        });
        return precondition();
    }

private:
    template <class Work>
    void for_blocks(const Work& work) {
        for (std::size_t block = blocks.first; block < blocks.last; ++block) work(block, of.block_of(block));
    }
    // q = A x.
    void apply(const std::vector<double>& x) {
        for (std::size_t i = bodies.first; i < bodies.last; ++i) of.move_body(i, x);
        if (!of.bodies_.empty()) run.barrier.wait();
        for_blocks([&](std::size_t block, IndexRange rows) {
            of.multiply(rows, x, of.q_);
            for (std::uint32_t i = of.first_part_[block]; i < of.first_part_[block + 1]; ++i) {
                const BodyPart& part = of.parts_[i];
                const BodyVelocity& v = of.velocities_[static_cast<std::size_t>(part.body)];
                of.q_[part.row] += dot(part.area, v.linear) + dot(part.moment, v.angular);
            }
        });
    }
    GradientResidual precondition() {
        run.barrier.wait();
        of.precondition(run, worker, times++);
        run.barrier.wait();
        for_blocks([&](std::size_t block, IndexRange rows) {
            const auto r = part_of(of.r_, rows);
            run.residual[block] = {dot_product(r, part_of(of.z_, rows)), largest_of(r)};
        });
        run.barrier.wait();
        GradientResidual all;
        for (std::size_t block = 0; block < of.blocks_; ++block) {
            const GradientResidual& own = run.residual[block];
            all.product += own.product;
            all.size = own.size > all.size ? own.size : all.size;
        }
        return all;
    }
};

int PressureSystem::solve(std::span<const double> b, std::vector<double>& x, double tolerance, int most,
                          TaskPool& workers) {
    const int number = static_cast<int>(strips_.size());
    Run run{b, x, Barrier(number), {}, {}, std::vector<Progress>(strips_.size())};
    x.push_back(0);
    std::fill(p_.begin(), p_.end(), 0);
    GradientResult result;
    const auto work = [&](int worker) {
        WorkerSystem system{*this, run, worker, range_of(blocks_, worker, number),
                            range_of(bodies_.size(), worker, number)};
        const GradientResult own = conjugate_gradient(system, {.iterations = most, .absolute = tolerance});
        if (worker == 0) result = own;
    };
    if (number == 1) {
        work(0);
    } else {
        workers.run(work);
    }
    x.pop_back();
    return result.end == GradientEnd::converged ? result.iterations : most + 1;
}

}  // namespace embody::physics::fluid
