// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec3.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// Films of liquid between obstacles that touch (docs/physics/fluids.md, "Films"): cells there that are shut all around
/// have the pressure of the liquid that the film begins at, with the film's weight.
class Films {
public:
    /// Before obstacles are placed on the grid.
    void begin(const FluidGrid& grid);
    /// An obstacle fills some of the control volume of the cell's lower face, where others are.
    void meet(FluidGrid& grid, int axis, const Cell& c);
    /// Thin walls shut lower faces of the cell (bits of ThinMark): they may hold liquid back.
    void close(const FluidGrid& grid, int cell, int faces);
    /// Once rows are known. `weight`: of the first liquid, density times gravity, N/m³.
    void find(const FluidGrid& grid, Vec3 weight);

    /// Pressure of a film: that of the row's cell and `head`, Pa.
    struct Pressure {
        std::int32_t row = -1;  ///< none: there is no film
        double head = 0;
    };
    [[nodiscard]] Pressure pressure(int cell) const;

private:
    struct FilmCell {
        int cell = 0;
        int closed = 0;  // lower faces
        int begin = -1;  // the liquid cell at which the film begins
        Pressure pressure;
    };
    FilmCell& at(const FluidGrid& grid, int cell);
    [[nodiscard]] bool is_closed(const FluidGrid& grid, int axis, int face) const;

    std::vector<FilmCell> cells_;
    std::vector<std::int32_t> place_;  // in cells_, by the grid's cell
};

}  // namespace embody::physics::fluid
