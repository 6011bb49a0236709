// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// How a renderer treats a texture's alpha (glTF's alphaMode).
enum class Transparency : std::uint8_t { opaque, cut_out, blended };

struct StoredTexture {
    std::vector<std::uint8_t> bytes;
    std::string mime_type;  ///< image/png or image/jpeg
    Transparency transparency = Transparency::opaque;
};

/// At most `largest` pixels on the longer side; small files stay as they are, large opaque PNGs become JPEG. Cut-out:
/// nearly all pixels are either clear or solid, as of leaves; drawing them needs no sorting.
Result<StoredTexture> reduce_texture(const RawImage& image, int largest);

}  // namespace embody::interchange
