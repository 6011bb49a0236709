// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mass_properties.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// A surface taken two ways: as walls of no thickness, and as what it encloses. A hollow thing lies between the two.
struct SolidAndShell {
    MassProperties shell;  ///< 1 kg/m² all over the surface: `volume` is its area, m²
    MassProperties solid;  ///< 1 kg/m³ inside; nothing where the surface is a sheet
};

/// The surface's area, centre and inertia at 1 kg/m², exact.
MassProperties integrate_shell(const TriangleMesh& mesh);

/// Of a mesh whose vertices are welded and whose triangles face outwards. Openings are closed by fans from the middle
/// of their rims, which is exact where a rim is flat (a table leg without its ends). What opens wider than a third of
/// the surface so closed (a lampshade, a curtain, a sheet) encloses nothing. Overlapping parts count twice.
SolidAndShell integrate_solid_and_shell(const TriangleMesh& mesh);

}  // namespace embody::geometry
