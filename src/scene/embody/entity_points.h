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
#include "scene/embody/kept_fit.h"
#include "scene/embody/known_models.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// Whether an entity is one body or points.
struct EntityForm {
    bool has_points = false;
    GeometryKey points_key;  ///< entities with the same key have the same points
    std::string note;        ///< the part of its kind that is not simulated, and why; empty: none
    KeptFit kept_fit;        ///< what a kept form of its points is like
};

/// Points of entities that are not one body, from their attributes in effect.
class EntityPoints {
public:
    /// `models` outlives this. `forms` may have been filled by others before.
    EntityPoints(KnownModels& models, std::shared_ptr<FormCache> forms)
        : models_(models), meshes_(models, std::move(forms)) {}

    /// An entity that cannot be simulated as its kind is rigid, with a note why. An entity that joints or pins hold as
    /// one body is rigid, too.
    EntityForm form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body);
    /// Whether the entity's kept form, if it has one, belongs to its points; the error's `where` is the field.
    Result<void> check_kept(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Definition of an entity whose form has points; everything but its pins to other entities, and the places of a
    /// deformable's nodes where it has a kept form, which belongs to its points.
    Result<PointsDefinition> definition(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Forgets everything that was made of a model.
    void forget(const std::string& key) { meshes_.forget(key); }

private:
    /// Form of an entity of kind soft; a note says where it is simulated coarsely, or why not at all.
    EntityForm soft_form(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Balls of the shape that an entity of kind granular fills.
    Result<GrainDefinition> grains(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<LiquidDefinition> liquid(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<physics::DeformableDefinition> soft(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<physics::DeformableDefinition> thin(const Entity& entity, const attributes::AttributeSet& attributes);
    /// The definition with pose, velocities and pins to the world.
    static Result<physics::DeformableDefinition> placed(const Entity& entity,
                                                        Result<physics::DeformableDefinition> made);

    KnownModels& models_;
    EntityMeshes meshes_;
};

/// Nodes at rest that the pin holds: those within its radius, else the nearest one.
std::vector<std::uint32_t> pinned_nodes(const Pin& pin, const std::vector<Vec3>& nodes);

}  // namespace embody::scene
