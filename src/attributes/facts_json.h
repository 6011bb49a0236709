// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::attributes {

/// The form in which the database keeps them; their numbers are finite, the tensor stands by columns, to the last bit.
nlohmann::json to_json(const ModelFacts& facts);
/// What is left out keeps its default, and what nobody knows is passed over: other versions wrote it. A field of the
/// wrong type is refused by its path, such as "facts.geometry.size".
Result<ModelFacts> facts_from_json(const nlohmann::json& document);

}  // namespace embody::attributes
