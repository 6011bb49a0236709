// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "foundation/handle_table.h"
#include "physics/deformable/cloth/cloth_solver.h"
#include "physics/deformable/contact/pair_springs.h"
#include "physics/deformable/solid/solid_contacts.h"
#include "physics/state/deformable_record.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// The soft solids, sheets and ropes.
struct DeformableState {
    HandleTable<struct DeformableTag, DeformableRecord> records;  // face; nodes: deformables
    SolidContacts solid_contacts;                                 // deformables: memory only
    ThinContacts thin_contacts;                                   // deformables: contacts between sheets and ropes
    ClothSolver pair_solver;                                      // deformables: memory only
    std::vector<std::uint32_t> pushed_bodies;  // deformables: slots whose deformable_force is not zero
};

}  // namespace embody::physics::state
