// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "attributes/attribute.h"
#include "foundation/result.h"

namespace embody::attributes {

// The codec of attributes: the only code that turns values, entries and sets into JSON and back. Numbers survive to the
// last bit in either form.

enum class AttributeForm : std::uint8_t {
    /// For people and programs: the value under "value", with kind, unit, label and help of the registry, which are not
    /// read back. Infinity is "infinity", tensors are [xx, yy, zz, xy, xz, yz]. Values that are read are validated.
    told,
    /// As the database keeps it: the value under its type ("number", "word", "truth", "vector" or "tensor"). Infinity
    /// is
    /// "inf", tensors stand by columns. What an older registry let in is read as it is.
    stored,
};

/// Told: the bare value. Stored: an object with the value under its type.
nlohmann::json to_json(const AttributeValue& value, AttributeForm form = AttributeForm::told);
/// A value of the named attribute, as it is told. The error says what it must be, and for a wrong name the nearest.
Result<AttributeValue> value_from_json(std::string_view name, const nlohmann::json& document);
/// A value as it is stored; `where` names the object in errors.
Result<AttributeValue> stored_value_from_json(const nlohmann::json& document, const std::string& where);

/// {name, value, low, high, source, level}.
nlohmann::json to_json(const AttributeEntry& entry, AttributeForm form = AttributeForm::told);
/// The error's `where` is `where` with the field, such as "attributes[3].level".
Result<AttributeEntry> entry_from_json(const nlohmann::json& document, const std::string& where,
                                       AttributeForm form = AttributeForm::told);

/// A list of entries.
nlohmann::json to_json(const AttributeSet& set, AttributeForm form = AttributeForm::told);
/// Refuses a name that is there twice.
Result<AttributeSet> set_from_json(const nlohmann::json& document, const std::string& where = "attributes",
                                   AttributeForm form = AttributeForm::told);

/// The whole registry, for the Studio and for programs.
nlohmann::json registry_to_json();

}  // namespace embody::attributes
