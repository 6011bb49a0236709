// SPDX-License-Identifier: MIT
// The drape of cloth as textile laboratories measure it (Cusick 1968).
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// Area of the shadow on the floor, m², by counting cells of half a millimetre whose middle lies under a triangle.
double shadow_area(std::span<const Vec3> nodes, const Cloth& cloth) {
    constexpr double cell = 5e-4, half = 0.2;
    constexpr int side = static_cast<int>(2 * half / cell);
    std::vector<bool> is_dark(static_cast<std::size_t>(side) * side, false);
    for (const auto& triangle : cloth.triangles) {
        std::array<Vec3, 3> p;
        Vec3 low{1, 0, 1}, high{-1, 0, -1};
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = nodes[triangle[k]];
            low = min(low, p[k]);
            high = max(high, p[k]);
        }
        const auto cell_of = [](double x) { return std::clamp(static_cast<int>((x + half) / cell), 0, side - 1); };
        for (int row = cell_of(low.z); row <= cell_of(high.z); ++row) {
            for (int column = cell_of(low.x); column <= cell_of(high.x); ++column) {
                const Vec3 at{(column + 0.5) * cell - half, 0, (row + 0.5) * cell - half};
                int left = 0, right = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3 edge = p[(k + 1) % 3] - p[k], way = at - p[k];
                    (edge.x * way.z - edge.z * way.x >= 0 ? left : right) += 1;
                }
                if (left == 3 || right == 3)
                    is_dark[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)] = true;
            }
        }
    }
    return cell * cell * static_cast<double>(std::ranges::count(is_dark, true));
}

// A disc of radius R, held between two plates of radius r, hangs over their border.
double drape_coefficient(double bend_stiffness, double edge) {
    const auto reference = reference_case("drape");
    const double outer = reference["setup"]["R"], inner = reference["setup"]["r"];
    auto disc = cloth_disc(outer, edge,
                           {.area_density = 0.15,
                            .stretch_stiffness = 1000,
                            .shear_stiffness = 40,
                            .bend_stiffness = bend_stiffness,
                            .rayleigh_damping = 0.02});
    for (std::uint32_t i = 0; i < disc.nodes.size(); ++i) {
        if (std::hypot(disc.nodes[i].x, disc.nodes[i].z) < inner + 1e-6) disc.pinned.push_back(i);
    }
    const auto world = make_world({.sleeping = false});
    const auto handle = world->create_deformable(disc).value();
    run(*world, 4);
    const double shadow = shadow_area(world->node_positions(handle), std::get<Cloth>(disc.matter));
    return (shadow - pi * inner * inner) / (pi * (outer * outer - inner * inner));
}

TEST(Drape, FallsWithTheBendingLengthFromOneToNothing) {
    const auto reference = reference_case("drape");
    const double rigid = drape_coefficient(1e-1, 0.015);
    EXPECT_NEAR(rigid, static_cast<double>(reference["expected"]["DC_rigid_limit"]), 0.01);
    double before = rigid;
    for (const double stiffness : {1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7}) {
        const double coefficient = drape_coefficient(stiffness, 0.015);
        EXPECT_LT(coefficient, before) << stiffness;
        RecordProperty("drape_at_" + std::to_string(static_cast<int>(std::lround(1e9 * stiffness))) + "_nNm",
                       std::to_string(coefficient));
        before = coefficient;
    }
    // Nothing would need edges that fold as tightly as the cloth: with a fourth and a sixteenth of the step 0.33 and
    // 0.40.
    EXPECT_LT(before, 0.3);
}

TEST(Drape, OfCottonIsThatOfCotton) {
    // 150 g/m² with a bending length of 20 mm.
    const auto reference = reference_case("drape");
    const double stiffness = 0.15 * gravity * 8e-6;
    for (const double edge : {0.015, 0.01, 0.0075}) {
        const double coefficient = drape_coefficient(stiffness, edge);
        RecordProperty("drape_at_edge_" + std::to_string(edge), std::to_string(coefficient));
        EXPECT_GT(coefficient, static_cast<double>(reference["expected"]["DC_cotton_range"][0])) << edge;
        EXPECT_LT(coefficient, static_cast<double>(reference["expected"]["DC_cotton_range"][1])) << edge;
    }
}

}  // namespace
}  // namespace embody::physics
