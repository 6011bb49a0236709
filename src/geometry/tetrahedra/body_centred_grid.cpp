// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/body_centred_grid.h"

#include "foundation/assert.h"
#include "geometry/tetrahedra/separation.h"

namespace embody::geometry {

namespace {

class Grid {
public:
    Grid(std::array<int, 3> cells, const std::function<Vec3(Vec3)>& place) : cells_(cells), place_(place) {
        for (int z = 0; z <= cells[2]; ++z) {
            for (int y = 0; y <= cells[1]; ++y) {
                for (int x = 0; x <= cells[0]; ++x) (void)add_node({2.0 * x, 2.0 * y, 2.0 * z});
            }
        }
        first_middle_ = static_cast<std::uint32_t>(mesh_.nodes.size());
        for_each_cell([&](std::array<int, 3> c) { (void)add_node({2.0 * c[0] + 1, 2.0 * c[1] + 1, 2.0 * c[2] + 1}); });
        for_each_cell([&](std::array<int, 3> c) { fill(c); });
    }

    TetrahedralMesh take() {
        find_surface(mesh_);
        return std::move(mesh_);
    }

private:
    void for_each_cell(const auto& visit) {
        for (int z = 0; z < cells_[2]; ++z) {
            for (int y = 0; y < cells_[1]; ++y) {
                for (int x = 0; x < cells_[0]; ++x) visit(std::array{x, y, z});
            }
        }
    }

    // At half cells from the grid's lowest corner.
    std::uint32_t add_node(Vec3 half_cells) {
        Vec3 at;
        for (int i = 0; i < 3; ++i) at[i] = half_cells[i] / cells_[static_cast<std::size_t>(i)] - 1;
        mesh_.nodes.push_back(place_(at));
        return static_cast<std::uint32_t>(mesh_.nodes.size() - 1);
    }
    [[nodiscard]] std::uint32_t corner(std::array<int, 3> c) const {
        return static_cast<std::uint32_t>((c[2] * (cells_[1] + 1) + c[1]) * (cells_[0] + 1) + c[0]);
    }
    [[nodiscard]] std::uint32_t middle(std::array<int, 3> c) const {
        return first_middle_ + static_cast<std::uint32_t>((c[2] * cells_[1] + c[1]) * cells_[0] + c[0]);
    }

    // A cell's middle and each edge of its faces make tetrahedra, with the middle of the neighbour behind the face,
    // which are added once, or that of the outer face.
    void fill(std::array<int, 3> cell) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                std::array<int, 3> neighbour = cell;
                neighbour[axis] += 2 * side - 1;
                const bool is_outer = neighbour[axis] < 0 || neighbour[axis] >= cells_[axis];
                if (!is_outer && side == 0) continue;
                // Counter-clockwise seen from outside.
                std::array<int, 3> base = cell;
                base[axis] += side;
                const std::size_t u = (axis + (side == 1 ? 1 : 2)) % 3, v = 3 - axis - u;
                std::array<std::uint32_t, 4> ring{};
                Vec3 center;
                for (std::size_t k = 0; k < 4; ++k) {
                    std::array<int, 3> at = base;
                    at[u] += k == 1 || k == 2 ? 1 : 0;
                    at[v] += k >= 2 ? 1 : 0;
                    ring[k] = corner(at);
                    center += 0.5 * Vec3{1.0 * at[0], 1.0 * at[1], 1.0 * at[2]};
                }
                const std::uint32_t behind = is_outer ? add_node(center) : middle(neighbour);
                for (std::size_t k = 0; k < 4; ++k)
                    mesh_.tetrahedra.push_back({middle(cell), ring[k], ring[(k + 1) % 4], behind});
            }
        }
    }

    std::array<int, 3> cells_;
    const std::function<Vec3(Vec3)>& place_;
    TetrahedralMesh mesh_;
    std::uint32_t first_middle_ = 0;
};

}  // namespace

std::size_t grid_tetrahedra(std::array<int, 3> cells) {
    const auto x = static_cast<std::size_t>(cells[0]), y = static_cast<std::size_t>(cells[1]),
               z = static_cast<std::size_t>(cells[2]);
    // Twelve a cell, of which each face between two has two halves, and two more for each outer face.
    return 12 * x * y * z + 4 * (x * y + y * z + z * x);
}

TetrahedralMesh body_centred_grid(std::array<int, 3> cells, const std::function<Vec3(Vec3)>& place) {
    for (const int count : cells) EMBODY_ASSERT(count >= 1);
    return Grid(cells, place).take();
}

}  // namespace embody::geometry
