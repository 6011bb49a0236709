// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "attributes/attribute.h"
#include "foundation/result.h"

namespace embody::attributes {

// The codec of attributes: the only code that turns values, entries and sets into JSON and back. Numbers keep every bit
// in both forms.

enum class AttributeForm : std::uint8_t {
    /// For people and programs: the value under "value", with kind, unit, label and help of the registry, which are not
    /// read back. Infinity is "infinity", tensors are [xx, yy, zz, xy, xz, yz]. Values that are read are validated.
    told,
    /// As the database keeps it: the value under its type ("number", "word", "truth", "vector" or "tensor"). Infinity
    /// is "inf", tensors are stored by columns. A value that an older registry accepted is read unchanged.
    stored,
};

/// Form `told`: the bare value. Form `stored`: an object with the value under its type.
nlohmann::json to_json(const AttributeValue& value, AttributeForm form = AttributeForm::told);
/// A value of the named attribute in the form `told`. The error says what the value must be, and for a wrong name the
/// nearest one.
Result<AttributeValue> value_from_json(std::string_view name, const nlohmann::json& document);
/// A value in the form `stored`; `where` names the object in errors.
Result<AttributeValue> stored_value_from_json(const nlohmann::json& document, const std::string& where);

/// {name, value, low, high, source, level}.
nlohmann::json to_json(const AttributeEntry& entry, AttributeForm form = AttributeForm::told);
/// The error's `where` is the given `where` with the field, such as "attributes[3].level".
Result<AttributeEntry> entry_from_json(const nlohmann::json& document, const std::string& where,
                                       AttributeForm form = AttributeForm::told);

/// A list of entries.
nlohmann::json to_json(const AttributeSet& set, AttributeForm form = AttributeForm::told);
/// Refuses a name that occurs twice.
Result<AttributeSet> set_from_json(const nlohmann::json& document, const std::string& where = "attributes",
                                   AttributeForm form = AttributeForm::told);

/// The whole registry, for the Studio and for programs.
nlohmann::json registry_to_json();

}  // namespace embody::attributes
