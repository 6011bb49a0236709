// SPDX-License-Identifier: MIT
// Liquids that freeze (docs/physics/melting.md): what of one lies together becomes a rigid entity that came in the run,
// as pieces of broken things are.
#include <utility>

#include "scene/matter/fluid_body.h"
#include "scene/matter/freezing.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

Entity piece_of(const Entity& liquid, FrozenPiece frozen) {
    Entity piece = liquid;
    piece.geometry = physics::ShapeDefinition(std::move(frozen.shape));
    piece.scale = 1;
    piece.pose = {frozen.momenta.center, {}};
    piece.linear_velocity = frozen.linear_velocity;
    piece.angular_velocity = frozen.angular_velocity;
    piece.force = {};
    piece.kept.reset();
    piece.start_asleep = piece.locked = piece.starts_empty = false;
    // The category is that of the liquid: what it says of surface and density is of no solid.
    piece.category.clear();
    piece.attributes = {{"kind", to_value(attributes::PhysicalKind::rigid)},
                        {"mass", frozen.momenta.mass},
                        {"center_of_mass", Vec3{}},
                        {"inertia", frozen.inertia}};
    return piece;
}

Result<void> check_freezable(const LiveEntity& liquid) {
    if (!liquid.definition.enabled)
        return Error{"enabled", "is false: what is not there cannot freeze", "enable it first"};
    const FluidBody* body = as_liquid(liquid.points.get());
    if (body == nullptr)
        return Error{"attributes.kind", "is " + to_text(kind_of(*liquid.attributes)) + ", and only liquids freeze",
                     "set it to fluid"};
    if (body->mass() > 0) return {};
    return Error{"starts_empty", "has left it without a drop that could freeze", "let liquid come to it first"};
}

}  // namespace

Result<void> Simulation::State::freeze(const LiveEntity& liquid) {
    const EntityIndex index = liquid.definition.index;
    if (Result<void> valid = check_freezable(liquid); !valid.ok()) return of_entity(liquid.definition, valid.error());
    const FluidBody& body = *as_liquid(liquid.points.get());
    std::vector<Vec3> places, velocities;
    body.read(places);
    body.read_velocities(velocities);
    std::vector<Entity> pieces;
    for (FrozenPiece& frozen : scene::freeze(places, velocities, body.particle_mass(), body.cell_size()))
        pieces.push_back(piece_of(liquid.definition, std::move(frozen)));

    std::vector<EntityIndex> came;
    for (Entity& piece : pieces) {
        Result<EntityIndex> next = new_index();
        if (next.ok()) piece.index = next.value();
        const Result<void> added = next.ok() ? add(piece) : Result<void>(next.error());
        if (!added.ok()) {
            remove_all(came);
            return of_entity(liquid.definition, added.error());
        }
        came.push_back(next_spawned++);
    }
    spawned.insert(spawned.end(), came.begin(), came.end());
    remove_all({index});
    despawned.push_back(index);
    return {};
}

}  // namespace embody::scene
