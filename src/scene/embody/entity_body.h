// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/attribute.h"
#include "foundation/result.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/shape_definition.h"
#include "scene/document/document.h"
#include "scene/embody/geometry_key.h"
#include "scene/embody/known_models.h"

namespace embody::scene {

// Bodies of entities, from their attributes in effect.

/// Everything but the shape's handle. A thing that is only drawn becomes a disabled static body. `taxonomy` may be
/// null.
Result<physics::BodyDefinition> body_of(const Entity& entity, const attributes::AttributeSet& attributes,
                                        const attributes::Taxonomy* taxonomy);
Result<physics::ShapeDefinition> shape_of(const Entity& entity, const attributes::AttributeSet& attributes,
                                          KnownModels& models);
/// Entities with the same key have the same shape.
GeometryKey shape_key(const Entity& entity, const attributes::AttributeSet& attributes);

}  // namespace embody::scene
