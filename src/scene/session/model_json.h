// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "catalog/catalog.h"

namespace embody::scene {

/// The protocol's ModelSummary (docs/protocol.md).
nlohmann::json model_to_json(const catalog::ModelSummary& model);

}  // namespace embody::scene
