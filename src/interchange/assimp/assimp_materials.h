// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

struct aiScene;

namespace embody::interchange {

/// Conventions of a format for its materials.
struct MaterialReading {
    bool linear_colors =
        false;  ///< glTF's factors are linear; the colours of older formats are meant for the screen (sRGB)
    bool texture_replaces_color = true;      ///< older exporters leave a gray or black colour beside a texture
    bool double_sided = true;                ///< where the format cannot say: both, as its surfaces are often open
    bool names_stand_for_materials = false;  ///< an OBJ without a material library (named_materials.h)
};

/// Adds the scene's materials and the images that they use to `scene`, in assimp's order. `model_path` is the model's
/// in `source`; textures are looked for beside it. A missing or unreadable texture is left out with a warning.
void add_materials(const aiScene& read, const FileSource& source, const std::string& model_path,
                   const MaterialReading& reading, RawScene& scene);

}  // namespace embody::interchange
