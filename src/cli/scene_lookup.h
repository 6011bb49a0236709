// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"
#include "scene/document/document.h"

namespace embody::cli {

/// Looks the scene up as a file, then as a built-in scene, then as a demo or saved scene of that name.
Result<scene::Document> find_scene(const std::string& file_or_name);

}  // namespace embody::cli
