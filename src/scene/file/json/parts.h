// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "attributes/attribute.h"
#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/shape_definition.h"
#include "scene/document/document.h"

namespace embody::scene {

// The parts of a scene file, each with its reader and its writer; docs/scene-format.md. Readers fail with the path of
// the field.

nlohmann::json vector_to_json(Vec3 vector);
nlohmann::json rotation_to_json(Quat rotation);
nlohmann::json transform_to_json(const Transform& transform);
/// A float as the shortest decimal that reads back as the same float.
nlohmann::json float_to_json(float value);

/// Read as by attributes/attribute_json.h, with `where` as the place of the error.
Result<attributes::AttributeValue> attribute_from_json(const std::string& name, const nlohmann::json& json,
                                                       const std::string& where);

Result<physics::ShapeDefinition> shape_from_json(const nlohmann::json& json, const std::string& where);
nlohmann::json shape_to_json(const physics::ShapeDefinition& shape);

/// Entities are named by index or by a name that is unique in `document`. The index is 0 where the field is missing.
Result<SceneJoint> joint_from_json(const nlohmann::json& json, const std::string& where, const Document& document);
nlohmann::json joint_to_json(const SceneJoint& joint);

/// The id is 0 where the field is missing.
Result<Action> action_from_json(const nlohmann::json& json, const std::string& where);
nlohmann::json action_to_json(const Action& action);

/// Reads the fields of `json` over those of `entity`; the index is kept. Only an entity without geometry (`is_new`)
/// needs one in `json`.
Result<void> change_entity_from_json(Entity& entity, const nlohmann::json& json, const std::string& where, bool is_new);

}  // namespace embody::scene
