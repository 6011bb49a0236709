// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mass_properties.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// A surface as two bodies: as walls without thickness, and as the solid that it encloses. A hollow body is between
/// them.
struct SolidAndShell {
    MassProperties shell;  ///< 1 kg/m² all over the surface: `volume` is its area, m²
    MassProperties solid;  ///< 1 kg/m³ inside; nothing where the surface is a sheet
};

/// The surface's area, centre and inertia at 1 kg/m², exact.
MassProperties integrate_shell(const TriangleMesh& mesh);

/// For a mesh whose vertices are welded and whose triangles face outwards. Openings are closed by fans from the middle
/// of their rims, which is exact where a rim is flat (a table leg without its ends). A surface with openings wider than
/// a third of the surface so closed (a lampshade, a curtain, a sheet) encloses nothing. Overlapping parts count twice.
SolidAndShell integrate_solid_and_shell(const TriangleMesh& mesh);

}  // namespace embody::geometry
