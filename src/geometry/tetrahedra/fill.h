// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "geometry/triangle_mesh.h"
#include "geometry/volume_estimate.h"

namespace embody::geometry {

inline constexpr int least_tetrahedra = 50, most_tetrahedra = 200000;

struct TetrahedralParameters {
    int tetrahedra = 2000;          ///< approximate number: 50 … 200,000; ignored if `cell` is given
    double cell = 0;                ///< m, side of the lattice's cubes; 0: as `tetrahedra` needs it
    double least_component = 0.01;  ///< parts of less than this fraction of the mesh's volume are left out, 0 … 1
};

struct TetrahedralFilling {
    TetrahedralMesh mesh;
    double cell = 0;                          ///< m, side of the lattice's cubes
    std::vector<std::uint32_t> component_of;  ///< for each tetrahedron; connected components, largest first
    std::vector<double> component_volumes;    ///< m³
    std::size_t left_out_components = 0;      ///< below `least_component`
    /// The mesh's fraction of the volume that the surface encloses (estimate_volume). Well below 1 where parts
    /// are thinner than a cell, which the lattice misses.
    double volume_fraction = 0;
    VolumeMethod method = VolumeMethod::no_volume;  ///< where that volume comes from
};

/// Tetrahedra that fill the volume that a surface encloses; it may be open, inverted or have overlapping parts: inside
/// is where its generalised winding number is above one half. Isosurface stuffing (F. Labelle, J. R. Shewchuk 2007) on
/// a lattice of one size: dihedral angles lie between 9° and 165°, edges and corners of the surface are cut off within
/// a cell. The surface of the result is closed (two faces at each edge; at some node two fans may touch) and faces
/// outwards; parts that only touch are not connected. Same mesh and parameters, same result. Errors: a parameter out of
/// its range, invalid indices or numbers, no triangles, nothing enclosed (a sheet), a cell so large that it misses all
/// or so small that there are above 4 million nodes.
Result<TetrahedralFilling> fill_with_tetrahedra(const TriangleMesh& surface,
                                                const TetrahedralParameters& parameters = {});

}  // namespace embody::geometry
