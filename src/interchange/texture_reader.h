// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Adds the textures that a model file names to a scene, each once, as PNG or JPEG. A texture that is missing,
/// unreadable or outside the model's folder is left out with a warning. The source and the scene must outlive it.
class TextureReader {
public:
    /// `model_path` is the model's in `source`; textures are looked for beside it.
    TextureReader(const FileSource& source, const std::string& model_path, RawScene& scene);

    /// Index of the image in the scene, -1 where it could not be read.
    int index_of(const std::string& reference);
    /// As above for an image that the model file contains.
    int index_of(const std::string& reference, Result<std::vector<std::uint8_t>> bytes);

private:
    [[nodiscard]] Result<std::vector<std::uint8_t>> read(const std::string& reference) const;

    const FileSource& source_;
    RawScene& scene_;
    std::string folder_;
    std::map<std::string, int> indices_;
};

}  // namespace embody::interchange
