// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/definitions/settings/fluid_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/grid/liquid_cells.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"

namespace embody::physics::fluid {

/// A x = b over the liquid's cells: (A x)_c = Σ_f β_f w_f / θ_f (x_c − x_neighbour), with w the open fraction of a
/// face, β the first liquid's density over that there and x = 0 at a distance θ in air, plus the effect of the pressure
/// on bodies that it moves. Symmetric, positive definite.
class PressureSystem {
public:
    /// Marks and numbers the liquid's cells; computes coefficients and preconditioner from the grid's open fractions
    /// and surface.
    void build(FluidGrid& grid, const FluidSettings& settings, TaskPool& workers);
    [[nodiscard]] std::size_t size() const { return liquid_.cells.size(); }
    /// Cell of a row.
    [[nodiscard]] std::uint32_t cell(std::size_t row) const { return liquid_.cells[row]; }
    /// θ of the face between two cells, one of which is liquid, the other air.
    [[nodiscard]] float gap_fraction(float inside, float outside) const;

    /// The bodies that take part: adds `scale` J M⁻¹ Jᵀ. None, as after build(): the liquid alone.
    void set_bodies(std::span<const MovingObstacle> bodies, double scale);
    /// Starts from x. Stops at residuals (largest component) below `tolerance`. Returns the iterations; the maximum + 1
    /// where they did not suffice.
    int solve(std::span<const double> b, std::vector<double>& x, double tolerance, int most, TaskPool& workers);

private:
    /// Neighbours' rows and coefficients. No neighbour: the row behind the last, in which everything is zero.
    struct Row {
        std::array<std::int32_t, 3> lower, upper;
        std::array<float, 3> to_lower, to_upper;          // coefficients, >= 0
        std::array<float, 3> factor_lower, factor_upper;  // scaled
    };
    /// Coefficients of a body's velocity in a row.
    struct BodyPart {
        std::int32_t row, body;
        Vec3 area, moment;
    };
    /// Rows of tiles that one worker solves, by layers: those of a layer need the same layer of the strip before and
    /// the layer before of their own.
    struct Strip {
        std::vector<std::vector<IndexRange>> layers;
    };
    struct BodyVelocity {
        Vec3 linear, angular;
    };
    struct Run;
    struct WorkerSystem;
    void build_row(const FluidGrid& grid, std::size_t row);
    void factor();
    void make_strips(const FluidGrid& grid, int workers);
    void substitute_forward(IndexRange rows);
    void substitute_backward(IndexRange rows);
    void precondition(Run& run, int worker, std::uint64_t time);
    void multiply(IndexRange block, std::span<const double> x, std::span<double> y) const;
    void move_body(std::size_t body, std::span<const double> x);
    [[nodiscard]] IndexRange block_of(std::size_t block) const {
        return range_of(size(), static_cast<int>(block), static_cast<int>(blocks_));
    }

    FluidPressureSettings settings_;  // of the last build()
    LiquidCells liquid_;
    std::vector<Strip> strips_;  // by worker
    std::vector<Row> rows_;
    std::size_t blocks_ = 1;
    std::vector<double> diagonal_, scaling_;
    std::vector<double> r_, z_, p_, q_;  // of the conjugate gradient
    std::vector<double> y_;              // L y = r
    std::vector<const MovingObstacle*> bodies_;
    std::vector<BodyVelocity> velocities_;
    std::vector<BodyPart> parts_;            // by row, then by body
    std::vector<std::uint32_t> first_part_;  // by block, and one more
    double scale_ = 0;
};

}  // namespace embody::physics::fluid
