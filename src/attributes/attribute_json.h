// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::attributes {

// Numbers are JSON numbers, infinity the string "infinity", vectors [x, y, z], tensors [xx, yy, zz, xy, xz, yz].

nlohmann::json to_json(const AttributeValue& value);
/// A value of the named attribute, validated.
Result<AttributeValue> value_from_json(std::string_view name, const nlohmann::json& document);

/// {name, kind, value, unit, low, high, source, level, label, help}; kind, unit, label and help come from the registry
/// and are not read back.
nlohmann::json to_json(const AttributeEntry& entry);
Result<AttributeEntry> entry_from_json(const nlohmann::json& document);

/// A list of entries.
nlohmann::json to_json(const AttributeSet& set);
Result<AttributeSet> set_from_json(const nlohmann::json& document);

/// The whole registry, for the Studio and for programs.
nlohmann::json registry_to_json();

/// The form in which the database keeps them; their numbers are finite, the tensor stands by columns, to the last bit.
nlohmann::json to_json(const ModelFacts& facts);
/// What is left out keeps its default; a field of the wrong type is refused by name.
Result<ModelFacts> facts_from_json(const nlohmann::json& document);

}  // namespace embody::attributes
