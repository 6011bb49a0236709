// SPDX-License-Identifier: MIT
#include <utility>

#include "foundation/assert.h"
#include "physics/inter/world.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

// The pieces of each broken body come into the world, and it goes.
void World::replace_broken_bodies() {
    state_->events.body_breaks.clear();
    for (PlannedBreak& planned : std::exchange(state_->fracture.planned, {})) {
        planned.event.body = state_->rigid.bodies.handle_at(planned.body);
        for (PlannedPiece& piece : planned.pieces) {
            piece.body.shape = state_->rigid.shapes.insert({std::move(piece.shape), 0, true});
            const Result<BodyHandle> made = create_body(piece.body);
            EMBODY_ASSERT(made.ok());  // the stage has checked each piece
            planned.event.pieces.push_back(made.value());
        }
        const ShapeHandle shape = state_->rigid.record(planned.body).definition.shape;
        const Result<void> gone = destroy_body(planned.event.body);
        EMBODY_ASSERT(gone.ok());
        const ShapeRecord* left = state_->rigid.shapes.find(shape);
        if (left != nullptr && left->is_of_piece && left->users == 0) state_->rigid.shapes.remove(shape);
        state_->events.body_breaks.push_back(std::move(planned.event));
    }
}

}  // namespace embody::physics
