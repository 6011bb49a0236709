// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "scene/embody/entity_attributes.h"
#include "scene/embody/entity_points.h"
#include "scene/embody/known_models.h"

namespace embody::scene {

/// Turns geometric and physical attributes into definitions of the physics: attributes, and points for entities that
/// are not one body. Bodies and shapes: entity_body.h.
struct EntityDefinitions {
    /// `catalog` may be null; it outlives this. `forms` may have been filled by others before.
    explicit EntityDefinitions(catalog::Catalog* catalog,
                               std::shared_ptr<FormCache> forms = std::make_shared<FormCache>())
        : models(catalog), attributes(models), points(models, std::move(forms)) {}
    EntityDefinitions(const EntityDefinitions&) = delete;
    EntityDefinitions& operator=(const EntityDefinitions&) = delete;

    KnownModels models;
    EntityAttributes attributes;
    EntityPoints points;

    /// Forgets a model whose attributes were changed.
    void forget(const std::string& key) {
        models.forget(key);
        attributes.forget_shared();
        points.forget(key);
    }
};

}  // namespace embody::scene
