// SPDX-License-Identifier: MIT
#pragma once

#include "database/simulation_mesh_table.h"
#include "foundation/result.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "geometry/triangle_mesh.h"

namespace embody::catalog {

/// The simulation mesh of a soft body.
struct SoftMesh {
    geometry::TetrahedralMesh mesh;  ///< in the thing's frame; nodes have single precision, as stored ones have
    double cell = 0;                 ///< m, side of the cubes of the lattice that it is cut from
    double flatness = 1;             ///< how many times as wide as thick the cells are where cubes would be too many
    double volume_fraction = 0;      ///< fraction of the enclosed volume: the rest is thinner than a cell
    std::size_t left_out = 0;        ///< pieces of the body that are not connected to it and move with it
};

inline constexpr int min_soft_tetrahedra = 300, max_soft_tetrahedra = 2000;
/// Maximum with a resolution that a person chose: some 15 ms a step.
inline constexpr std::size_t max_resolved_tetrahedra = 20000;
/// The error of a resolution that takes so many tetrahedra.
Error too_fine(int resolution, std::size_t tetrahedra);

/// Fills what the surface encloses, two cells across its thickness where 300 to 2,000 tetrahedra allow it
/// (docs/import.md: Soft things); what is so flat that cubes would be too many is cut from flat cells, up to 8 times as
/// wide as thick. With a `resolution` there are so many cubes across the thickness instead. Same surface, same mesh.
/// The error says why the thing cannot be soft: nothing enclosed, nearly all of it too thin, or several things that do
/// not hang together.
Result<SoftMesh> make_soft_mesh(const geometry::TriangleMesh& surface, int resolution = 0);

/// The mesh as the database has it, or why there is none.
database::StoredSimulationMesh stored_form(const Result<SoftMesh>& mesh);
/// Whether it was made by the present rule: others are made again.
bool is_current(const database::StoredSimulationMesh& stored);
/// The mesh, or the stored problem. Unreadable data is an error whose `where` is "soft mesh".
Result<SoftMesh> soft_mesh_from(const database::StoredSimulationMesh& stored);

}  // namespace embody::catalog
