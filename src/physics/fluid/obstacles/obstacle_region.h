// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacle_probe.h"

namespace embody::physics::fluid {

/// Obstacles measured on a box of cells: the distance of each centre from them and the fraction of each octant (an
/// eighth of a cell) that they fill. From these come the fractions of the faces' control volumes and of the density's
/// kernel.
class ObstacleRegion {
public:
    static constexpr double reach = FluidGrid::obstacle_reach;  ///< cells: maximum of stored distances

    /// Cells from `lower` to below `upper` of the grid; measured is one more all around.
    void begin(const FluidGrid& grid, const Cell& lower, const Cell& upper);
    /// Adds an obstacle; false if it is out of reach.
    bool add(ObstacleProbe& probe);
    /// Faces from octants, once all obstacles are in.
    void finish();
    /// Instead of both: a volume, m³, that is less than a cell and spread by trilinear weights around a place that is
    /// two cells within the box.
    void spread(Vec3 place, double volume);

    [[nodiscard]] const Cell& lower() const { return lower_; }
    [[nodiscard]] const Cell& upper() const { return upper_; }
    /// Of a cell of the grid, within the box (and one around it for `distance`).
    [[nodiscard]] int index(const Cell& c) const {
        return (c[0] - lower_[0] + 1) + size_[0] * ((c[1] - lower_[1] + 1) + size_[1] * (c[2] - lower_[2] + 1));
    }
    /// Obstacle fraction of the control volume of the lower face along `axis`; valid from lower() to upper(), that
    /// included.
    [[nodiscard]] float fraction(int axis, int cell) const { return fraction_[axis][cell]; }
    /// The same without what is shut because it is thin.
    [[nodiscard]] float filled(int axis, int cell) const {
        return any_thin_ ? filled_[axis][cell] : fraction_[axis][cell];
    }
    [[nodiscard]] float distance(int cell) const { return distance_[cell]; }  ///< cells
    [[nodiscard]] std::uint8_t thin(int cell) const { return thin_[cell]; }   ///< ThinMark
    /// Free fraction of the density's kernel around the centre; within the box.
    [[nodiscard]] float room(int cell) const;

private:
    void shut_thin(const ObstacleProbe& probe);
    void shut_ends();
    void shut(int axis, int cell);
    void mark_near_thin();
    void measure_room();
    [[nodiscard]] int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size_[0] : size_[0] * size_[1]; }

    const FluidGrid* grid_ = nullptr;
    Cell lower_{}, upper_{}, size_{};
    std::vector<float> distance_, own_distance_;
    std::vector<float> octants_;                // eight a cell
    std::array<std::vector<float>, 2> folded_;  // octants summed along axes
    std::vector<float> room_;
    std::array<std::vector<float>, 3> fraction_, filled_;
    std::vector<std::uint8_t> thin_;
    std::vector<std::uint8_t> is_cut_;
    bool any_thin_ = false, any_cut_ = false;
    std::vector<std::array<int, 2>> ends_;  // axis and cell: inside an obstacle whose edge ends between its neighbours
};

}  // namespace embody::physics::fluid
