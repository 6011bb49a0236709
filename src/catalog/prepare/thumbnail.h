// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

inline constexpr int thumbnail_size = 256;  ///< pixels, width and height

/// The catalogue's icon as a PNG of thumbnail_size, its sides padded with nothing; empty where it is missing or
/// damaged.
std::vector<std::uint8_t> thumbnail_of_icon(const interchange::FileSource& source, const std::string& path);

/// The scene (model frame) seen from front, right and above under a soft sky and a sun, on a transparent ground; PNG.
/// Colours and textures as they are, metals and roughness not. Headless, one thread.
std::vector<std::uint8_t> render_thumbnail(const interchange::RawScene& scene);

}  // namespace embody::catalog
