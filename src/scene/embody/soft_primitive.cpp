// SPDX-License-Identifier: MIT
#include "scene/embody/soft_primitive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <type_traits>

#include "geometry/tetrahedra/body_centred_grid.h"
#include "physics/definitions/mass_properties.h"

namespace embody::scene {

namespace {

using physics::ShapeDefinition;
using Cells = std::array<int, 3>;

// Length of a cell over its width across the smallest extent. Bars and rods bend and twist as theory says, within 5 %,
// with this one; with cubes too softly, by up to 7 % where two lie across, with 1.5 times too stiffly, by up to 7 %
// (docs/physics/deformables.md). Test: SoftLaws.CantileversBendAsTimoshenkoSays.
constexpr double cell_elongation = 1.25;

// Cells across the smallest extent, how long these are, and the maximum number of tetrahedra: the first that fits is
// taken. What is compact has smaller dents with three; the limit is what a bar of eight times its width has with two.
// Beyond 3,000, some 2 ms a step, cells are made longer.
struct Choice {
    int resolution = 0;
    double elongation = 1;
    std::size_t max_tetrahedra = 0;
};
constexpr Choice choices[] = {{3, cell_elongation, 1200},
                              {2, cell_elongation, 3000},
                              {2, 2.5, 3000},
                              {1, 2.5, 3000},
                              {1, 5, 3000},
                              {1, 10, 3000}};

using Place = std::function<Vec3(Vec3)>;

struct Plan {
    Vec3 size;
    Vec3 roundness;  // of the surface across each axis, 0 … 1
    Place (*place)(Vec3 size, Cells cells) = nullptr;
    double straight = 0;  // m, between two round ends along y; 0: those are flat
};

// Of a round end along the axis.
int cap_cells(Cells cells) { return (cells[0] + 1) / 2; }

// Cells along the extents, `resolution` along the smallest one.
Cells cells_of(const Plan& plan, int resolution, double elongation) {
    const double width = std::min({plan.size.x, plan.size.y, plan.size.z}) / resolution;
    // Beyond any limit where the number would be too large for an int.
    const auto along = [&](double extent) {
        return static_cast<int>(std::min(std::ceil(extent / (elongation * width) - 1e-9), 1e6));
    };
    Cells cells{};
    for (int i = 0; i < 3; ++i) cells[static_cast<std::size_t>(i)] = std::max(resolution, along(plan.size[i]));
    if (plan.straight > 0) cells[1] = 2 * cap_cells(cells) + std::max(1, along(plan.straight));
    return cells;
}

struct Division {
    Cells cells{};
    double flatness = 1;
};

Result<Division> divide(const Plan& plan, int resolution) {
    if (resolution > 0) {
        const Cells cells = cells_of(plan, resolution, cell_elongation);
        const std::size_t count = geometry::grid_tetrahedra(cells);
        if (count > catalog::max_resolved_tetrahedra) return catalog::too_fine(resolution, count);
        return Division{cells, 1};
    }
    for (const Choice& choice : choices) {
        const Cells cells = cells_of(plan, choice.resolution, choice.elongation);
        if (geometry::grid_tetrahedra(cells) <= choice.max_tetrahedra)
            return Division{cells, choice.elongation > cell_elongation ? choice.elongation : 1};
    }
    return Error{"soft mesh",
                 "it is too thin: even with cells 10 times as wide as thick it takes more than 3,000 tetrahedra",
                 "make it rigid, or cloth or a rope"};
}

// Of the square [-1, 1]² to the unit disc, and of the cube to the unit ball, whose restriction to y = 0 is the former
// (P. Nowell, "Mapping a cube to a sphere", 2005).
Vec3 in_ball(Vec3 p) {
    const Vec3 q{p.x * p.x, p.y * p.y, p.z * p.z};
    return {p.x * std::sqrt(1 - q.y / 2 - q.z / 2 + q.y * q.z / 3),
            p.y * std::sqrt(1 - q.z / 2 - q.x / 2 + q.z * q.x / 3),
            p.z * std::sqrt(1 - q.x / 2 - q.y / 2 + q.x * q.y / 3)};
}

Plan plan_of(const physics::BoxShape& box) {
    return {2 * box.half_extents, {}, [](Vec3 size, Cells) -> Place {
                return [size](Vec3 p) { return 0.5 * scale(p, size); };
            }};
}
Plan plan_of(const physics::SphereShape& sphere) {
    const double side = 2 * sphere.radius;
    return {{side, side, side}, {1, 1, 1}, [](Vec3 size, Cells) -> Place {
                return [size](Vec3 p) { return 0.5 * scale(in_ball(p), size); };
            }};
}
Plan plan_of(const physics::CylinderShape& cylinder) {
    const double side = 2 * cylinder.radius;
    return {{side, 2 * cylinder.half_height, side}, {1, 0, 1}, [](Vec3 size, Cells) -> Place {
                return [size](Vec3 p) {
                    const Vec3 disc = in_ball({p.x, 0, p.z});
                    return 0.5 * scale({disc.x, p.y, disc.z}, size);
                };
            }};
}
// A cylinder with half a ball at each end, which has half as many cells along the axis as lie across.
Plan plan_of(const physics::CapsuleShape& capsule) {
    const double side = 2 * capsule.radius;
    const double height = 2 * capsule.half_height + side;
    return {{side, height, side},
            {1, side / height, 1},
            [](Vec3 size, Cells cells) -> Place {
                const double cap = cap_cells(cells), straight = cells[1] / 2.0 - cap;
                const double half_height = (size.y - size.x) / 2, radius = size.x / 2;
                return [=](Vec3 p) {
                    const double from_middle = std::abs(p.y) * (straight + cap);  // in cells
                    const double along = std::min(from_middle / straight, 1.0);
                    const double up = std::min(std::max(from_middle - straight, 0.0) / cap, 1.0);
                    const Vec3 ball = radius * in_ball({p.x, up, p.z});
                    return Vec3{ball.x, std::copysign(along * half_height + ball.y, p.y), ball.z};
                };
            },
            2 * capsule.half_height};
}

// Nodes lie on round surfaces, so that faces cut off a part of the volume; a little wider all round it is right.
void widen(geometry::TetrahedralMesh& mesh, Vec3 roundness, double volume) {
    const double axes = roundness.x + roundness.y + roundness.z;
    if (axes == 0) return;
    const double ratio = volume / geometry::volume(mesh);
    Vec3 factor;
    for (int i = 0; i < 3; ++i) factor[i] = std::pow(ratio, roundness[i] / axes);
    for (Vec3& node : mesh.nodes) node = scale(factor, node);
}

Result<catalog::SoftMesh> mesh_of(const Plan& plan, double volume, int resolution) {
    const Result<Division> division = divide(plan, resolution);
    if (!division) return division.error();
    catalog::SoftMesh soft;
    soft.mesh = geometry::body_centred_grid(division->cells, plan.place(plan.size, division->cells));
    widen(soft.mesh, plan.roundness, volume);
    soft.cell = plan.size.x / division->cells[0];
    for (int i = 1; i < 3; ++i)
        soft.cell = std::min(soft.cell, plan.size[i] / division->cells[static_cast<std::size_t>(i)]);
    soft.flatness = division->flatness;
    soft.volume_fraction = 1;
    return soft;
}

}  // namespace

std::optional<Result<catalog::SoftMesh>> soft_primitive(const ShapeDefinition& shape, int resolution) {
    return std::visit(
        [&](const auto& one) -> std::optional<Result<catalog::SoftMesh>> {
            if constexpr (requires { plan_of(one); }) {
                const auto solid = physics::mass_properties(shape);
                if (!solid.ok()) return solid.error();
                return mesh_of(plan_of(one), solid->volume, resolution);
            } else {
                return std::nullopt;
            }
        },
        shape);
}

}  // namespace embody::scene
