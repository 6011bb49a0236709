// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Reads any of our formats that assimp knows; see read_model(). May throw.
Result<RawScene> read_by_assimp(const FileSource& source, const std::string& path);

}  // namespace embody::interchange
