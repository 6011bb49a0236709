// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/json_text.h"

namespace embody::scene {

// Scene files and commands are read as every other JSON that people write.
using attributes::parse_json;

}  // namespace embody::scene
