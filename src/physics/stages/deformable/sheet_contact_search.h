// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/deformable/thin_deformables.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Contacts with what of bodies pokes between the nodes of a sheet, once the contacts of its nodes are known: edges,
/// rims and round sides under its edges, corners and small balls under its triangles. Arguments as of
/// find_thin_contacts().
void find_sheet_contacts(std::span<const TouchedBody> bodies, const std::vector<bool>& may_collide,
                         const WorldSettings& settings, ThinDeformable& thin, TaskPool& workers);

}  // namespace embody::physics::stages
