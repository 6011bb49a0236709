// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "attributes/attribute.h"
#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/embody/entity_meshes.h"
#include "scene/embody/geometry_key.h"
#include "scene/embody/known_models.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// Whether an entity is one body or points.
struct EntityForm {
    bool has_points = false;
    GeometryKey points_key;  ///< the same, the same points
    std::string note;        ///< what of its kind it is not simulated with, and why; empty: nothing
};

/// What stands for entities that are not one body, from their attributes as they act.
class EntityPoints {
public:
    /// `models` outlives this. `forms` may have been filled by others before.
    EntityPoints(KnownModels& models, std::shared_ptr<FormCache> forms)
        : models_(models), meshes_(models, std::move(forms)) {}

    /// What cannot be what its kind says is rigid, with a note why; so is what joints or pins hold as one body.
    EntityForm form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body);
    /// Of an entity whose form has points; everything but what its pins hold to other entities.
    Result<PointsDefinition> definition(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Forgets what was made of a model.
    void forget(const std::string& key) { meshes_.forget(key); }

private:
    /// Of an entity of kind soft; a note says where it is computed coarsely, or why not at all.
    EntityForm soft_form(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Balls of the shape that an entity of kind granular fills.
    Result<GrainDefinition> grains(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<LiquidDefinition> liquid(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<physics::DeformableDefinition> soft(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<physics::DeformableDefinition> thin(const Entity& entity, const attributes::AttributeSet& attributes);
    /// With pose, velocities and what its pins hold in the world.
    static Result<physics::DeformableDefinition> placed(const Entity& entity,
                                                        Result<physics::DeformableDefinition> made);

    KnownModels& models_;
    EntityMeshes meshes_;
};

/// Nodes at rest that the pin holds: those within its radius, or the nearest.
std::vector<std::uint32_t> pinned_nodes(const Pin& pin, const std::vector<Vec3>& nodes);

}  // namespace embody::scene
