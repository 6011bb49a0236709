// SPDX-License-Identifier: MIT
// Shapes that are not in the world, to look where there is room for them.
#include <algorithm>
#include <utility>

#include "attributes/physical_kind.h"
#include "scene/embody/entity_body.h"
#include "scene/embody/kept_fit.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

// The box of a kept form, in the entity's frame.
physics::ShapeDefinition box_of(const KeptForm& kept) {
    constexpr double min_half = 1e-3;  // m
    Bounds bounds;
    for (const Vec3 place : places_of(kept)) bounds.add(place);
    const Vec3 half = 0.5 * bounds.size();
    physics::CompoundShape box;
    box.children.push_back(
        {physics::BoxShape{{std::max(half.x, min_half), std::max(half.y, min_half), std::max(half.z, min_half)}},
         {bounds.center(), {}}});
    return box;
}

// Static things collide as triangles, which have no inside, and others change their form: for both their hull, or the
// box of the form that they begin with.
Entity as_solid(const Entity& entity, const attributes::AttributeSet& acting) {
    Entity solid = entity;
    const attributes::PhysicalKind kind = kind_of(acting);
    if (!is_static(kind) && !changes_form(kind)) return solid;
    if (changes_form(kind) && entity.kept) {
        solid.geometry = box_of(*entity.kept);
        solid.attributes.clear();
        solid.scale = 1;
    }
    solid.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    if (std::holds_alternative<ModelReference>(solid.geometry))
        solid.attributes["collision_shape"] = std::string("convex_hull");
    return solid;
}

}  // namespace

Result<physics::ShapeHandle> Simulation::solid_shape(const Entity& entity) {
    const Result<SharedAttributes> acting = state_->definitions.attributes.shared(entity);
    if (!acting.ok()) return of_entity(entity, acting.error());
    const Entity solid = as_solid(entity, *acting.value());
    const Result<SharedAttributes> set = state_->definitions.attributes.shared(solid);
    if (!set.ok()) return of_entity(entity, set.error());
    const GeometryKey key = shape_key(solid, *set.value());
    if (!state_->solid.is_null() && key.is_shared() && key == state_->solid_key) return state_->solid;
    Result<physics::ShapeHandle> shape =
        state_->shapes.take(key, [&] { return shape_of(solid, *set.value(), state_->definitions.models); });
    if (!shape.ok()) return of_entity(entity, shape.error());
    state_->shapes.release(state_->solid_key, std::exchange(state_->solid, shape.value()));
    state_->solid_key = key;
    return shape;
}

}  // namespace embody::scene
