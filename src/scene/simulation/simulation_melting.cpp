// SPDX-License-Identifier: MIT
// Things that melt (docs/physics/melting.md): a thing's matter becomes drops of a liquid that is there, or a liquid of
// its own, which is an entity that came in the run, as pieces of broken things are.
#include <algorithm>
#include <cmath>
#include <utility>

#include "attributes/registry.h"
#include "scene/embody/entity_body.h"
#include "scene/matter/fluid_body.h"
#include "scene/matter/melting.h"
#include "scene/matter/soft_nodes.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

constexpr double min_cell = 1e-3;  // m, limit of the physics

const physics::SoftSolid* solid_of(const LiveEntity& thing) {
    const SoftNodes* soft = as_soft(thing.points.get());
    return soft ? std::get_if<physics::SoftSolid>(&soft->definition().matter) : nullptr;
}

Momenta momenta_of(const physics::World& world, physics::BodyHandle body) {
    const Quat rotation = world.pose(body).rotation;
    const Vec3 turns = world.angular_velocity(body);
    return {.mass = world.mass(body),
            .center = world.center_of_mass(body),
            .linear = world.mass(body) * world.linear_velocity(body),
            .angular = rotate(rotation, world.inertia(body) * rotate_inverse(rotation, turns))};
}

std::string who(const Entity& entity) {
    return "entity " + std::to_string(entity.index) + (entity.name.empty() ? "" : " (" + entity.name + ")");
}

// What a liquid of the thing's own matter has of it; its density and places are told later.
Entity liquid_like(const Entity& thing, const Transform& pose) {
    Entity liquid = thing;
    liquid.pose = pose;
    liquid.linear_velocity = liquid.angular_velocity = liquid.torque = {};
    liquid.kept.reset();
    liquid.start_asleep = liquid.locked = false;
    liquid.light = {};
    liquid.tap = {};
    liquid.drain = {};
    liquid.finish = Finish::plain;
    std::erase_if(liquid.attributes, [](const auto& entry) {
        const attributes::AttributeDescription* described = attributes::describe(entry.first);
        return described == nullptr || described->kind != "fluid";
    });
    liquid.attributes["kind"] = to_value(attributes::PhysicalKind::fluid);
    return liquid;
}

}  // namespace

// The thing is neither held nor without matter of its own.
Result<void> Simulation::State::check_meltable(const LiveEntity& thing) const {
    const EntityIndex index = thing.definition.index;
    if (!thing.definition.enabled)
        return Error{"enabled", "is false: what is not there cannot melt", "enable it first"};
    if (thing.points ? solid_of(thing) == nullptr : !std::isfinite(world->mass(thing.body)))
        return Error{"attributes.kind",
                     "is " + to_text(kind_of(*thing.attributes)) + ", and only rigid and soft things melt",
                     "set it to rigid or soft"};
    if (const auto& joined = holds.joints_of(index); !joined.empty())
        return Error{"joints", "hold it, such as joint " + std::to_string(*joined.begin()), "remove them first"};
    if (const auto& pinned = holds.pinned_to(index); !pinned.empty())
        return Error{"pins", "of " + who(live.at(*pinned.begin()).definition) + " hold on to it",
                     "take that pin away first"};
    if (!thing.definition.pins.empty()) return Error{"pins", "hold it", "take them away first"};
    return {};
}

Result<Melting> Simulation::State::melting(const LiveEntity& thing) {
    if (const physics::SoftSolid* elastic = solid_of(thing)) {
        const SoftNodes& soft = *as_soft(thing.points.get());
        const MeltingSolid matter{.tetrahedra = elastic->tetrahedra,
                                  .rest = soft.definition().nodes,
                                  .positions = world->node_positions(soft.handle()),
                                  .velocities = world->node_velocities(soft.handle()),
                                  .masses = world->node_masses(soft.handle())};
        return Melting{matter, momenta_of(matter)};
    }
    Result<physics::ShapeDefinition> shape = shape_of(thing.definition, *thing.attributes, definitions.models);
    if (!shape.ok()) return shape.error();
    return Melting{MeltingBody{.shape = std::move(shape).value(),
                               .pose = world->pose(thing.body),
                               .linear_velocity = world->linear_velocity(thing.body),
                               .angular_velocity = world->angular_velocity(thing.body)},
                   momenta_of(*world, thing.body)};
}

Result<void> Simulation::State::melt_into(const Melting& melting, EntityIndex into) {
    LiveEntity* there = find(into);
    const auto wrong = [&](const std::string& why) {
        return Error{"effect.into", "is " + (there ? who(there->definition) : "entity " + std::to_string(into)) + why,
                     "set it to a liquid of the scene, or to 0: it becomes one of its own"};
    };
    if (!there) return wrong(", which is not there");
    FluidBody* liquid = as_liquid(there->points.get());
    if (!liquid) return wrong(", which is no liquid");
    if (!liquid->part()) return wrong(", which is not enabled");
    const Result<void> gained =
        liquid->gain(melting.momenta, [&](std::size_t count) { return drops_of(melting, count); });
    return gained.ok() ? gained : of_entity(there->definition, gained.error());
}

// A liquid of its own: as many drops as fill its volume, of such a density that they have its mass.
Result<EntityIndex> Simulation::State::melt_alone(const LiveEntity& thing, const Melting& melting) {
    if (const Result<EntityIndex> index = new_index(); !index.ok()) return index.error();
    Entity liquid = liquid_like(thing.definition, pose_of(thing));
    liquid.index = next_spawned;
    Result<SharedAttributes> acting = definitions.attributes.shared(liquid);
    if (!acting.ok()) return acting.error();
    const Result<PointsDefinition> points = definitions.points.definition(liquid, *acting.value());
    if (!points.ok()) return points.error();
    const auto& modelled = std::get<LiquidDefinition>(points.value());

    const Result<Filled> filled = filled_by(melting, modelled.matter.cell_size, modelled.particle_budget);
    if (!filled.ok()) return filled.error();
    const auto& [volume, own_cell] = filled.value();
    physics::FluidDefinition matter = modelled.matter;
    matter.cell_size = std::max(own_cell, min_cell);
    matter.density = melting.momenta.mass / volume;
    const Bounds bounds = thing.points ? thing.points->bounds() : world->bounds(thing.body);
    const double cell = liquids.cell_size(matter, modelled.set_cell_size, bounds);
    const double drop = cell * cell * cell / 8, count = std::round(volume / drop);
    if (count > static_cast<double>(modelled.particle_budget * max_particles_ratio))
        return Error{"attributes.particle_budget",
                     "is too small for the cells of the liquid that it comes to: it would have " +
                         std::to_string(std::llround(count)) + " drops",
                     "raise it"};
    // Fewer than one: the error is that of no drop.
    const Result<std::vector<physics::FluidDrop>> drops =
        count < 1 ? std::vector<physics::FluidDrop>() : drops_of(melting, static_cast<std::size_t>(count));
    if (!drops.ok()) return drops.error();
    const double density = melting.momenta.mass / (std::max(count, 1.0) * drop);
    if (Result<void> valid = validate(physics::LiquidMatter{.density = density}); !valid.ok())
        return Error{"attributes.mass", "is wrong for a liquid of its volume: the density " + valid.error().why,
                     "change the mass, or let it melt into a liquid"};
    liquid.attributes["rest_density"] = density;
    KeptForm form{.fingerprint = definitions.points.form(liquid, *acting.value(), false).kept_fit.fingerprint,
                  .cell_size = cell};
    std::vector<Vec3> places;
    for (const physics::FluidDrop& each : drops.value())
        places.push_back(inverse_transform_point(liquid.pose, each.position));
    form.places = packed(places);
    liquid.kept = std::move(form);
    if (Result<void> added = add(liquid); !added.ok()) return added.error();
    FluidBody& body = *as_liquid(live.at(liquid.index).points.get());
    if (Result<void> moves = body.begin_with(drops.value(), melting.momenta); !moves.ok()) {
        remove_all({liquid.index});
        return moves.error();
    }
    spawned.push_back(next_spawned);
    return next_spawned++;
}

Result<void> Simulation::State::melt(const LiveEntity& thing, const Melt& melt) {
    const EntityIndex index = thing.definition.index;
    if (Result<void> meltable = check_meltable(thing); !meltable.ok())
        return of_entity(thing.definition, meltable.error());
    const Result<Melting> matter = melting(thing);
    if (!matter.ok()) return of_entity(thing.definition, matter.error());
    EntityIndex liquid = melt.into;
    if (liquid != 0) {
        if (Result<void> gained = melt_into(matter.value(), liquid); !gained.ok()) return gained;
    } else {
        const Result<EntityIndex> alone = melt_alone(thing, matter.value());
        if (!alone.ok()) return of_entity(thing.definition, alone.error());
        liquid = alone.value();
    }
    melted.push_back({index, liquid});
    remove_all({index});
    despawned.push_back(index);
    return {};
}

}  // namespace embody::scene
