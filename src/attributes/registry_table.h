// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "attributes/registry.h"

namespace embody::attributes {

/// The rows of the registry; registry() keeps them.
std::vector<AttributeDescription> make_registry_table();

}  // namespace embody::attributes
