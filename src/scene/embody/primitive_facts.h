// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <utility>

#include "attributes/model_facts.h"
#include "physics/definitions/shape_definition.h"
#include "scene/embody/geometry_key.h"

namespace embody::scene {

/// What the physics knows of a primitive's form; zero volume for planes, heightfields and meshes.
attributes::ModelFacts primitive_facts(const physics::ShapeDefinition& shape);

/// What a mesh that moves collides as.
physics::ShapeDefinition hull_of(const physics::MeshShape& mesh);

/// The same facts, found once for each primitive. What is returned is valid until the next call.
class PrimitiveFacts {
public:
    const attributes::ModelFacts& of(const physics::ShapeDefinition& shape);
    /// Of triangles that move with what they enclose.
    const attributes::ModelFacts& of_enclosed(const physics::MeshShape& mesh);

private:
    std::map<GeometryKey, attributes::ModelFacts> known_;
    attributes::ModelFacts last_;                                      ///< of one that nobody else has
    std::pair<physics::MeshShape, attributes::ModelFacts> last_mesh_;  ///< that moves
};

}  // namespace embody::scene
