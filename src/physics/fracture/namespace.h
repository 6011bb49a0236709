// SPDX-License-Identifier: MIT
#pragma once

/// How brittle solids break: when a blow breaks one, into how many pieces, and the Voronoi cells that these are
/// (docs/physics/fracture.md). It knows no world.
namespace embody::physics::fracture {}  // namespace embody::physics::fracture
