// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/events.h"
#include "physics/dynamic/body_state.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// A piece that is to come into the world.
struct PlannedPiece {
    std::unique_ptr<CollisionShape> shape;
    BodyDefinition body;  ///< but for the shape's handle
};

/// A body that is to be replaced by pieces.
struct PlannedBreak {
    std::uint32_t body = 0;  ///< slot
    BodyBreakEvent event;    ///< but for the handles
    double paid = 0;         ///< energy of the step's losses that the cracks took, J
    std::vector<PlannedPiece> pieces;
};

/// Brittle bodies: how they moved when the step began, and what becomes of those that its blows break.
struct FractureState {
    std::vector<BodyState> before;      // fracture: by slot; empty where nothing is brittle
    std::vector<PlannedBreak> planned;  // fracture; taken by the face
};

}  // namespace embody::physics::state
