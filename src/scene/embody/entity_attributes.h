// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/check.h"
#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/embody/known_models.h"
#include "scene/embody/primitive_facts.h"

namespace embody::scene {

using SharedAttributes = std::shared_ptr<const attributes::AttributeSet>;

/// What entities are made of.
class EntityAttributes {
public:
    /// `models` outlives this.
    explicit EntityAttributes(KnownModels& models) : models_(models) {}

    /// The attributes as they act: the model's or the primitive's, with the entity's own over them. Errors name the
    /// field of the entity.
    Result<attributes::AttributeSet> acting(const Entity& entity);
    /// The same; those that have the same have one set between them.
    Result<SharedAttributes> shared(const Entity& entity);
    /// What they would be without the entity's own.
    Result<attributes::AttributeSet> automatic(const Entity& entity);
    /// What of the attributes as they act contradicts each other: a person can set what cannot be.
    Result<std::vector<attributes::Issue>> contradictions(const Entity& entity);
    /// Whether its kind is fluid; false where the model is unknown.
    bool is_liquid(const Entity& entity);

    /// A model has changed: sets that were shared may be old.
    void forget_shared() { sets_.clear(); }

private:
    [[nodiscard]] attributes::AttributeSet lay_over(const attributes::AttributeSet& automatic,
                                                    const std::vector<attributes::AttributeEntry>& own,
                                                    const attributes::ModelFacts& facts) const;
    /// Without its own: what its category says where that is no rigid thing's, else those of something solid.
    [[nodiscard]] attributes::AttributeSet primitive_attributes(const Entity& entity,
                                                                const physics::ShapeDefinition& shape,
                                                                const attributes::ModelFacts& facts) const;
    const attributes::ModelFacts& facts_of(const Entity& entity, const physics::ShapeDefinition& shape);

    KnownModels& models_;
    PrimitiveFacts primitives_;
    std::map<GeometryKey, SharedAttributes> sets_;  ///< by all that they follow from
};

/// The value of an attribute of an entity that is drawn at `scale`, as the model itself has it.
attributes::AttributeValue value_of_model(const std::string& name, const attributes::AttributeValue& value,
                                          double scale);

}  // namespace embody::scene
