// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "physics/inter/definitions/deformable_definition.h"

namespace embody::physics {

/// A brick of `cells` bricks of six tetrahedra each, its lower corner at the origin; the split is mirrored from cell to
/// cell, so that the whole has no handedness.
inline DeformableDefinition tetrahedral_brick(Vec3 size, std::array<int, 3> cells) {
    DeformableDefinition brick;
    SoftSolid solid;
    const auto [nx, ny, nz] = cells;
    const auto at = [&](int x, int y, int z) { return static_cast<std::uint32_t>((z * (ny + 1) + y) * (nx + 1) + x); };
    for (int z = 0; z <= nz; ++z) {
        for (int y = 0; y <= ny; ++y) {
            for (int x = 0; x <= nx; ++x) brick.nodes.push_back({size.x * x / nx, size.y * y / ny, size.z * z / nz});
        }
    }
    // Kuhn's split along the diagonal from (0,0,0) to (1,1,1), mirrored in cells of odd place.
    constexpr int ways[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int z = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
            for (int x = 0; x < nx; ++x) {
                const std::array<int, 3> odd{x % 2, y % 2, z % 2};
                for (const auto& way : ways) {
                    std::array<int, 3> corner{0, 0, 0};
                    std::array<std::uint32_t, 4> element{};
                    for (std::size_t k = 0; k < 4; ++k) {
                        element[k] = at(x + (corner[0] ^ odd[0]), y + (corner[1] ^ odd[1]), z + (corner[2] ^ odd[2]));
                        if (k < 3) corner[static_cast<std::size_t>(way[k])] = 1;
                    }
                    solid.tetrahedra.push_back(element);
                }
            }
        }
    }
    brick.matter = std::move(solid);
    return brick;
}

}  // namespace embody::physics
