// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "interchange/raw_scene.h"

namespace embody::catalog {

/// Completes what a file left out for drawing: normals where there are none (smooth across edges below 40°, sharp
/// above), and both sides only for materials whose surface is open. A closed surface, or one modelled on both sides,
/// has no visible back; drawing it would cost time and flicker where the two sides coincide.
void finish_surfaces(interchange::RawScene& scene);

/// Names of the materials, largest area first; materials without triangles are left out.
std::vector<std::string> material_names_by_area(const interchange::RawScene& scene);

}  // namespace embody::catalog
