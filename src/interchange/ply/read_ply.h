// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Reads a PLY file in any of its three encodings: faces and triangle strips, normals, texture coordinates of vertices
/// or of faces' corners with the texture that MeshLab names, in the file's unit and axes. Colours of vertices become
/// their mean, the colour of the one material. The error's `where` ends with element and line, or byte.
Result<RawScene> read_ply(const FileSource& source, const std::string& path);

}  // namespace embody::interchange
