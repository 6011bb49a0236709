// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <utility>

#include "attributes/model_facts.h"
#include "physics/definitions/shape_definition.h"
#include "scene/embody/geometry_key.h"

namespace embody::scene {

/// Facts of a primitive's form that the physics knows; zero volume for planes, heightfields and meshes.
attributes::ModelFacts primitive_facts(const physics::ShapeDefinition& shape);

/// The collision shape of a mesh that moves.
physics::ShapeDefinition hull_of(const physics::MeshShape& mesh);

/// The same facts, computed once for each primitive. A returned reference is valid until the next call.
class PrimitiveFacts {
public:
    /// Kept at most: a size that is dragged makes a new primitive with each edit.
    static constexpr std::size_t max_known = 1024;

    const attributes::ModelFacts& of(const physics::ShapeDefinition& shape);
    /// Facts of a mesh that moves, with its enclosed volume.
    const attributes::ModelFacts& of_enclosed(const physics::MeshShape& mesh);
    [[nodiscard]] std::size_t known() const { return known_.size(); }

private:
    std::map<GeometryKey, attributes::ModelFacts> known_;
    attributes::ModelFacts last_;                                      ///< of a primitive whose key is not shared
    std::pair<physics::MeshShape, attributes::ModelFacts> last_mesh_;  ///< of a mesh that moves
};

}  // namespace embody::scene
