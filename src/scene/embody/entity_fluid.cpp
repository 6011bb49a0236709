// SPDX-License-Identifier: MIT
#include "attributes/to_physics.h"
#include "physics/definitions/field_check.h"
#include "scene/embody/entity_body.h"
#include "scene/embody/entity_points.h"

namespace embody::scene {

Result<LiquidDefinition> EntityPoints::liquid(const Entity& entity, const attributes::AttributeSet& attributes) {
    Result<physics::ShapeDefinition> filled = shape_of(entity, attributes, models_);
    if (!filled.ok()) return filled.error();
    if (Result<void> fits = physics::check_vector("force", entity.force, physics::largest_force, "N"); !fits.ok())
        return fits.error();
    LiquidDefinition liquid;
    liquid.shape = std::move(filled).value();
    liquid.pose = entity.pose;
    liquid.matter = attributes::fluid_from_attributes(attributes);
    liquid.matter.allow_sleep = entity.allow_sleep;
    const attributes::AttributeEntry* cells = attributes.find("fluid_cell_size");
    if (cells != nullptr && cells->level == attributes::AttributeLevel::manual)
        liquid.set_cell_size = liquid.matter.cell_size;
    liquid.starts_empty = entity.kept ? entity.kept->places.values.empty() : entity.starts_empty;
    if (entity.kept) {
        liquid.places = places_of(*entity.kept);
        liquid.matter.cell_size = entity.kept->cell_size;
    }
    liquid.particle_budget = static_cast<std::size_t>(attributes.number("particle_budget", 20000));
    liquid.linear_velocity = entity.linear_velocity;
    liquid.angular_velocity = entity.angular_velocity;
    liquid.force = entity.force;
    liquid.enabled = entity.enabled;
    return liquid;
}

}  // namespace embody::scene
