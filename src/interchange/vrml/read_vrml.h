// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Why this build reads no VRML, with the package to install; nothing where it does.
Result<void> can_read_vrml();

/// Reads a VRML 2.0 (VRML97) file through Coin: all shapes as triangles with materials and their DEF names, in the
/// file's unit and axes. Inline, EXTERNPROTO and scripts are not followed. Normals are the file's, or those that its
/// crease angles mean. One thread at a time.
Result<RawScene> read_vrml(const FileSource& source, const std::string& path);

}  // namespace embody::interchange
