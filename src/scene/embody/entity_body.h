// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <unordered_map>

#include "attributes/attribute.h"
#include "attributes/check.h"
#include "attributes/model_facts.h"
#include "catalog/catalog.h"
#include "foundation/result.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/shape_definition.h"
#include "scene/document/document.h"
#include "scene/embody/form_cache.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// Whether an entity is one body or points.
struct EntityForm {
    bool has_points = false;
    std::string points_key;  ///< the same, the same points; empty: nobody else has them
    std::string note;        ///< what of its kind it is not simulated with, and why; empty: nothing
};

using SharedAttributes = std::shared_ptr<const attributes::AttributeSet>;

/// Makes bodies of entities: the way from geometric and physical attributes to what the physics needs. Remembers the
/// models it has looked up.
class EntityBodies {
public:
    /// `catalog` may be null; it outlives this. `forms` may have been filled by others before.
    explicit EntityBodies(catalog::Catalog* catalog, std::shared_ptr<FormCache> forms = std::make_shared<FormCache>())
        : catalog_(catalog),
          forms_(std::move(forms)),
          soft_meshes_(forms_->soft_meshes),
          thin_forms_(forms_->thin_forms) {}

    /// The attributes as they act: the model's or the primitive's, with the entity's own over them. Errors name the
    /// field of the entity.
    Result<attributes::AttributeSet> attributes(const Entity& entity);
    /// The same; those that have the same have one set between them.
    Result<SharedAttributes> shared_attributes(const Entity& entity);
    /// What of the attributes as they act contradicts each other: a person can set what cannot be.
    Result<std::vector<attributes::Issue>> contradictions(const Entity& entity);
    /// What they would be without the entity's own.
    Result<attributes::AttributeSet> automatic_attributes(const Entity& entity);
    /// Everything but the shape's handle. What is only drawn becomes a disabled static body.
    Result<physics::BodyDefinition> body(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<physics::ShapeDefinition> shape(const Entity& entity, const attributes::AttributeSet& attributes);
    /// What cannot be what its kind says is rigid, with a note why; so is what joints or pins hold as one body.
    EntityForm form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body);
    /// Whether its kind is fluid; false where the model is unknown.
    bool is_liquid(const Entity& entity);
    /// What stands for an entity whose form has points; everything but what its pins hold to other entities.
    Result<PointsDefinition> points(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Entities with the same key have the same shape; empty: nobody else has it.
    static std::string shape_key(const Entity& entity, const attributes::AttributeSet& attributes);
    /// The model's summary; fails for what is not a model.
    Result<catalog::ModelSummary> model(const Entity& entity);

    /// The catalogue's; null without one.
    [[nodiscard]] const attributes::Taxonomy* taxonomy() const;

    /// Forgets a model whose attributes were changed.
    void forget(const std::string& key) {
        models_.erase(key);
        sets_.clear();
        soft_meshes_.erase(key);
        thin_forms_.erase(key);
    }

private:
    struct Model {
        catalog::ModelSummary summary;
        attributes::ModelFacts facts;
        attributes::AttributeSet attributes;
    };
    Result<const Model*> find(const std::string& key);
    [[nodiscard]] attributes::AttributeSet lay_over(const attributes::AttributeSet& automatic,
                                                    const std::vector<attributes::AttributeEntry>& own,
                                                    const attributes::ModelFacts& facts) const;
    /// Balls of the shape that an entity of kind granular fills.
    Result<GrainDefinition> grains(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<LiquidDefinition> liquid(const Entity& entity, const attributes::AttributeSet& attributes);
    /// The tetrahedra of an entity of kind soft, without its scale; the error says why it cannot be soft. Valid until
    /// the next call.
    Result<const catalog::SoftMesh*> soft_mesh(const Entity& entity);
    /// Of an entity of kind soft; a note says where it is computed coarsely, or why not at all.
    EntityForm soft_form(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<catalog::SoftMesh> make_soft_mesh(const Entity& entity);
    Result<physics::DeformableDefinition> soft(const Entity& entity, const attributes::AttributeSet& attributes);
    /// The sheet of an entity of kind cloth, the line of one of kind rope, without its scale. As of soft_mesh().
    Result<const ThinForm*> thin_form(const Entity& entity, const attributes::AttributeSet& attributes);
    Result<ThinForm> make_thin_form(const Entity& entity, bool is_cloth, int count);
    Result<physics::DeformableDefinition> thin(const Entity& entity, const attributes::AttributeSet& attributes);
    /// With pose, velocities and what its pins hold in the world.
    Result<physics::DeformableDefinition> deformable(const Entity& entity, const attributes::AttributeSet& attributes);
    const attributes::ModelFacts& primitive(const physics::ShapeDefinition& shape);
    /// The same, of triangles that move with what they enclose.
    const attributes::ModelFacts& primitive(const Entity& entity, const physics::ShapeDefinition& shape);
    /// Without its own: what its category says where that is no rigid thing's, else those of something solid.
    [[nodiscard]] attributes::AttributeSet primitive_attributes(const Entity& entity,
                                                                const physics::ShapeDefinition& shape,
                                                                const attributes::ModelFacts& facts) const;

    catalog::Catalog* catalog_;
    std::map<std::string, Model> models_;
    std::unordered_map<std::string, SharedAttributes> sets_;           ///< by all that they follow from
    std::map<std::string, attributes::ModelFacts> primitives_;         ///< by their text
    attributes::ModelFacts last_primitive_;                            ///< of one without a short text
    std::pair<physics::MeshShape, attributes::ModelFacts> last_mesh_;  ///< that moves
    std::shared_ptr<FormCache> forms_;
    std::map<std::string, Result<catalog::SoftMesh>>& soft_meshes_;
    std::map<std::string, std::map<std::string, Result<ThinForm>>>& thin_forms_;
};

/// Nodes at rest that the pin holds: those within its radius, or the nearest.
std::vector<std::uint32_t> pinned_nodes(const Pin& pin, const std::vector<Vec3>& nodes);

/// The value of an attribute of an entity that is drawn at `scale`, as the model itself has it.
attributes::AttributeValue value_of_model(const std::string& name, const attributes::AttributeValue& value,
                                          double scale);

/// What the physics knows of a primitive's form; zero volume for planes, heightfields and meshes.
attributes::ModelFacts primitive_facts(const physics::ShapeDefinition& shape);

}  // namespace embody::scene
