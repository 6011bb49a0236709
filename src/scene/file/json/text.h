// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/json_text.h"

namespace embody::scene {

// Scene files and commands use the parser of all JSON that people write.
using attributes::parse_json;

}  // namespace embody::scene
