// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "foundation/handle_table.h"
#include "physics/constraint/joint/joint.h"
#include "physics/definitions/joint_definition.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

struct JointRecord {
    JointDefinition definition;
    Joint constraint;  ///< written by substeps; sleeps with its bodies
};

/// The joints, and the joints that a step solves.
struct JointState {
    HandleTable<struct JointTag, JointRecord> records;                // face; impulses: substeps
    std::set<std::pair<std::uint32_t, std::uint32_t>> jointed_pairs;  // face: slots whose bodies must not collide
    std::vector<Joint> active;                                        // islands; impulses: impact, substeps
    std::vector<std::uint32_t> active_slots;                          // islands
};

}  // namespace embody::physics::state
