// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/deformable/cloth/anderson_mixing.h"
#include "physics/stages/access.h"
#include "physics/stages/fluid/immersed_deformables.h"
#include "physics/stages/namespace.h"
#include "physics/state/deformable_record.h"

namespace embody::physics::stages {

/// What elastic forces of sheets do while a liquid presses them, found together with its pressure
/// (docs/physics/coupling.md, "Liquids and what bends"). Of sheets that touch anything else the last step tells.
class SheetResponse {
public:
    /// `immersed`: its points are told what holds them.
    SheetResponse(const FluidAccess& world, ImmersedDeformables& immersed);
    [[nodiscard]] bool is_empty() const { return sheets_.empty(); }
    /// PointResponse of FluidSolver: before the first solve of a part of a step and after each.
    bool operator()(double dt, const ImmersedPoints& found);

private:
    struct Sheet {
        ImmersedDeformables::Part part;
        std::vector<Vec3> pressed, supported;     // impulses of liquid and elastic forces in the parts before, N s
        std::vector<Vec3> impulse;                // of elastic forces that this part was solved with, N s
        std::vector<Vec3> by_liquid;              // that it found, N s
        std::vector<Vec3> moves;                  // last found in this part, m; none before
        std::vector<Vec3> bound, bound_of_point;  // liquid that nodes and points hold in this part, by axis, kg
        AndersonMixing mixing;
    };
    [[nodiscard]] const Nodes& nodes_of(const Sheet& sheet) const;
    [[nodiscard]] Vec3 pull_on(const Sheet& sheet) const;
    void bind(Sheet& sheet, const ImmersedPoints& found) const;
    void set_supports(const Sheet& sheet, double dt);
    [[nodiscard]] std::vector<Vec3> free_velocities(Sheet& sheet, double h, const ImmersedPoints& found) const;
    [[nodiscard]] bool solve(Sheet& sheet, double h, const std::vector<Vec3>& free) const;
    [[nodiscard]] bool improve(Sheet& sheet, double dt, const ImmersedPoints& found);
    void end_part(double dt);

    const FluidAccess& world_;
    ImmersedDeformables& immersed_;
    std::vector<Sheet> sheets_;
    double elapsed_ = 0;  // when the part begins, s
    int solves_ = 0;      // of this part
    bool is_in_part_ = false;
};

}  // namespace embody::physics::stages
