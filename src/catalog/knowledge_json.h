// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::catalog {

// The facts of a model as the JSON text that the database keeps. Numbers survive to the last bit, infinities as
// "inf" and "-inf"; text that is not UTF-8 (old OBJ files) gets the replacement sign. Reading names the field that is
// wrong.

std::string to_json(const attributes::AttributeValue& value);
Result<attributes::AttributeValue> value_from_json(std::string_view text);

std::string to_json(const attributes::AttributeSet& set);
Result<attributes::AttributeSet> set_from_json(std::string_view text);

std::string to_json(const attributes::ModelFacts& facts);
Result<attributes::ModelFacts> facts_from_json(std::string_view text);

/// `text` with whatever is not UTF-8 replaced, so that every later reader can rely on it.
std::string valid_utf8(const std::string& text);

}  // namespace embody::catalog
