// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/check.h"
#include "attributes/plausible.h"
#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/embody/known_models.h"
#include "scene/embody/primitive_facts.h"

namespace embody::scene {

using SharedAttributes = std::shared_ptr<const attributes::AttributeSet>;

/// Attributes of entities.
class EntityAttributes {
public:
    /// `models` outlives this.
    explicit EntityAttributes(KnownModels& models) : models_(models) {}

    /// The attributes in effect: the model's or the primitive's, overridden by the entity's own. Errors name the field
    /// of the entity.
    Result<attributes::AttributeSet> acting(const Entity& entity);
    /// The same; entities with equal attributes share one set.
    Result<SharedAttributes> shared(const Entity& entity);
    /// The attributes without the entity's own.
    Result<attributes::AttributeSet> automatic(const Entity& entity);
    /// Contradictions between the attributes in effect, and values that no real thing has: a person can set such. Each
    /// has a remedy. `around` says what else decides; its box is found here.
    Result<std::vector<attributes::Issue>> contradictions(const Entity& entity, attributes::Circumstances around = {});
    /// Whether its kind is fluid; false where the model is unknown.
    bool is_liquid(const Entity& entity);

    /// Sets that are kept for entities to come: those that entities hold, and a few more.
    [[nodiscard]] std::size_t kept() const { return sets_.size(); }

    /// Call when a model has changed: shared sets may be out of date.
    void forget_shared() { sets_.clear(); }

private:
    void keep(GeometryKey key, SharedAttributes set);
    [[nodiscard]] attributes::AttributeSet override_by(const attributes::AttributeSet& automatic,
                                                       const std::vector<attributes::AttributeEntry>& own,
                                                       const attributes::ModelFacts& facts) const;
    /// Attributes without the entity's own: those of its category if that is not rigid, else those of a solid body.
    [[nodiscard]] attributes::AttributeSet primitive_attributes(const Entity& entity,
                                                                const physics::ShapeDefinition& shape,
                                                                const attributes::ModelFacts& facts) const;
    const attributes::ModelFacts& facts_of(const Entity& entity, const physics::ShapeDefinition& shape);
    /// The box of the entity's form in its own frame; empty where it has no end.
    Bounds box_of(const Entity& entity);

    KnownModels& models_;
    PrimitiveFacts primitives_;
    std::map<GeometryKey, SharedAttributes> sets_;  ///< by everything that they follow from
    std::size_t max_kept_ = 0;                      ///< where the sets are as many, those that nobody holds go
};

/// What decides in a scene with these settings whether an entity's values make sense.
attributes::Circumstances circumstances_of(const physics::WorldSettings& settings, bool has_joint);

/// The value for the model itself of an attribute of an entity that is drawn at `scale`.
attributes::AttributeValue value_of_model(const std::string& name, const attributes::AttributeValue& value,
                                          double scale);

}  // namespace embody::scene
