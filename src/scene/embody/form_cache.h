// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <variant>

#include "catalog/soft_mesh.h"
#include "foundation/result.h"
#include "scene/embody/geometry_key.h"
#include "scene/embody/thin_form.h"

namespace embody::scene {

/// Simulation mesh of a thing of kind cloth or rope.
using ThinForm = std::variant<attributes::SheetMesh, LineForm>;

/// Simulation meshes of deformable things: made once, however often the scene is reset. Used by one thread.
struct FormCache {
    // Under the key of unshared things is the mesh that was made last.
    std::map<GeometryKey, std::map<int, Result<catalog::SoftMesh>>> soft_meshes;  ///< by resolution
    std::map<GeometryKey, std::map<std::string, Result<ThinForm>>> thin_forms;    ///< by geometry, then kind and count
    std::size_t made = 0;                                                         ///< soft meshes so far

    /// Call before a new simulation: removes meshes of models, which may have been imported again, and all meshes if
    /// there are more of primitives than a scene may have.
    void begin();
};

}  // namespace embody::scene
