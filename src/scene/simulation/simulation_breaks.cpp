// SPDX-License-Identifier: MIT
// Things that break: the pieces that the physics makes of a body become entities, with which recording, going back in
// time and the Studio do what they do with entities that actions spawn.
#include <array>
#include <cmath>
#include <utility>

#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

// What a piece has of the thing as it is; its mass and strength are its own.
constexpr std::array kept_attributes{
    "surface_material",      "friction_static", "friction_dynamic",      "friction_rolling",
    "friction_torsional",    "restitution",     "restitution_threshold", "friction_combine",
    "restitution_combine",   "linear_damping",  "angular_damping",       "gravity_factor",
    "sleep_energy_per_mass", "continuous",      "collision_group",       "collision_mask",
    "drag_coefficient",      "density",         "fracture_energy"};

Entity piece_of(const LiveEntity& whole, const physics::BodyDefinition& body, const physics::ShapeDefinition& shape) {
    Entity piece = whole.definition;
    piece.geometry = shape;
    piece.scale = 1;
    piece.light = {};
    piece.tap = {};
    piece.drain = {};
    piece.pose = {body.position, body.rotation};
    piece.linear_velocity = body.linear_velocity;
    piece.angular_velocity = body.angular_velocity;
    piece.force = body.force;
    piece.torque = body.torque;
    piece.start_asleep = false;
    piece.locked = false;

    auto& attributes = piece.attributes;
    attributes.clear();
    for (const char* name : kept_attributes)
        if (const auto* entry = whole.attributes->find(name)) attributes[name] = entry->value;
    attributes["kind"] = std::string("rigid");
    attributes["mass"] = *body.mass.mass;
    attributes["center_of_mass"] = *body.mass.center_of_mass;
    attributes["inertia"] = *body.mass.inertia;
    const double drag = whole.attributes->number("drag_coefficient", 1);
    attributes["drag_area"] = drag > 0 ? body.drag_area / drag : 0.0;
    attributes["breaks"] = body.brittleness.has_value();
    if (body.brittleness) {
        attributes["break_impulse"] = body.brittleness->break_impulse;
        attributes["break_energy"] = body.brittleness->break_energy;
        attributes["break_pieces"] = static_cast<double>(body.brittleness->max_pieces);
    }
    return piece;
}

}  // namespace

Result<void> Simulation::State::add_pieces(const physics::BodyBreakEvent& event) {
    // The world's own pieces go: each entity makes its body from its attributes, as it does when time goes back to it.
    const LiveEntity& whole = live.at(static_cast<EntityIndex>(event.user_data));
    std::vector<Entity> pieces;
    for (const physics::BodyHandle handle : event.pieces) {
        const auto body = world->body(handle);  // it has just come
        pieces.push_back(piece_of(whole, *body, *world->shape(body->shape)));
        if (auto gone = world->destroy_body(handle); !gone.ok()) return gone;
        if (auto gone = world->destroy_shape(body->shape); !gone.ok()) return gone;
    }
    for (Entity& piece : pieces) {
        const Result<EntityIndex> index = new_index();
        if (!index.ok()) return index.error();
        piece.index = index.value();
        if (Result<void> added = add(piece); added.ok())
            spawned.push_back(next_spawned++);
        else
            actions->problems.push_back(added.error());
    }
    return {};
}

void Simulation::State::take_pieces() {
    const auto span = world->body_break_events();
    const std::vector<physics::BodyBreakEvent> events(span.begin(), span.end());
    for (const physics::BodyBreakEvent& event : events) {
        const auto index = static_cast<EntityIndex>(event.user_data);
        LiveEntity* whole = find(index);
        if (!whole) continue;  // a body of no entity
        const std::string& name = whole->definition.name;
        broke.push_back({index, name.empty() ? "Entity " + std::to_string(index) : name, event.position, event.impulse,
                         event.energy, event.pieces.size()});
        if (Result<void> added = add_pieces(event); !added.ok()) actions->problems.push_back(added.error());
        // Its body is gone already.
        shapes.release(whole->shape_key, std::exchange(whole->shape, {}));
        whole->body = {};
        remove_all({index});
        despawned.push_back(index);
    }
}

}  // namespace embody::scene
