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

/// What a thing of kind cloth or rope is computed on.
using ThinForm = std::variant<attributes::SheetMesh, LineForm>;

/// What things that bend are computed on: made once, however often the scene is reset. Used by one thread.
struct FormCache {
    /// Without a key of its own: the last that nobody else has.
    std::map<GeometryKey, Result<catalog::SoftMesh>> soft_meshes;
    std::map<GeometryKey, std::map<std::string, Result<ThinForm>>> thin_forms;  ///< the same; in it by kind and count
    std::size_t made = 0;                                                       ///< soft meshes so far

    /// For a new simulation: models may have been imported again, and of primitives that were tried out no more are
    /// kept than a scene may have.
    void begin();
};

}  // namespace embody::scene
