// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::attributes {

/// The form in which the database keeps the facts. Their numbers are finite; the tensor is stored by columns and keeps
/// every bit.
nlohmann::json to_json(const ModelFacts& facts);
/// A missing field keeps its default. Unknown fields are ignored, since other versions wrote them. A field of the wrong
/// type is refused by its path, such as "facts.geometry.size".
Result<ModelFacts> facts_from_json(const nlohmann::json& document);

}  // namespace embody::attributes
