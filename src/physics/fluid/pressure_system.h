// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/fluid/grid.h"
#include "physics/fluid/solids.h"

namespace embody::physics {

/// Marks the liquid's cells: grid.surface from the density and the room around, grid.row by number. Returns how many.
int mark_liquid(FluidGrid& grid, TaskPool& workers);

/// A x = b over the liquid's cells: (A x)_c = Σ_f w_f / θ_f (x_c − x_neighbour), with w the open share of a face and x
/// = 0 at a distance θ in air, plus what the pressure does to bodies that it moves. Symmetric, positive definite.
class PressureSystem {
public:
    /// Coefficients and preconditioner from the grid's rows, open shares and surface.
    void build(const FluidGrid& grid, int rows);
    [[nodiscard]] std::size_t size() const { return diagonal_.size(); }
    /// Cell of a row.
    [[nodiscard]] std::uint32_t cell(std::size_t row) const { return cells_[row]; }
    /// θ of the face between two cells, one of which is liquid, the other air.
    [[nodiscard]] static float gap_share(float inside, float outside);

    /// The bodies that take part: adds `scale` J M⁻¹ Jᵀ. None: the liquid alone.
    void set_bodies(std::span<const MovingSolid> bodies, double scale);
    /// Starts from x. Stops at residuals (largest component) below `tolerance`. Returns the iterations; most + 1 where
    /// they did not suffice.
    int solve(std::span<const double> b, std::span<double> x, double tolerance, int most);

private:
    struct Row {
        std::array<std::int32_t, 3> lower{-1, -1, -1}, upper{-1, -1, -1};  // neighbours' rows
        std::array<double, 3> to_lower{}, to_upper{};                      // coefficients, >= 0
    };
    void factor();
    void precondition(std::span<const double> r, std::span<double> z);
    void multiply(std::span<const double> x, std::span<double> y) const;
    void add_bodies(std::span<const double> x, std::span<double> y) const;

    std::vector<std::uint32_t> cells_;
    std::vector<Row> rows_;
    std::vector<double> diagonal_, scaling_;
    std::vector<double> r_, z_, p_, ap_, q_;
    std::vector<const MovingSolid*> bodies_;
    double scale_ = 0;
};

}  // namespace embody::physics
