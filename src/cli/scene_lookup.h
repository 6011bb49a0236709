// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"
#include "scene/document/document.h"

namespace embody::cli {

/// The scene of a file, a built-in scene of that name, or a demo or saved scene of that name, in this order.
Result<scene::Document> find_scene(const std::string& file_or_name);

}  // namespace embody::cli
