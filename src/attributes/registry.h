// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/physical_kind.h"
#include "foundation/result.h"

namespace embody::attributes {

enum class ValueType : std::uint8_t { number, word, truth, vector, tensor };

/// What an attribute is: the one source of truth for the API, the scene schema, the command line, the Studio's panel
/// and the documentation.
struct AttributeDescription {
    std::string name;  ///< e.g. "friction_dynamic"
    std::string
        kind;  ///< the paper's attr_kind: identity, mass, shape, surface, motion, soft, cloth, rope, fluid, grain
    ValueType type = ValueType::number;
    std::string unit;                  ///< SI, "1" for a pure number, "" for words
    AttributeValue standard;           ///< default value
    std::optional<double> low, high;   ///< valid range of a number or of each component
    bool whole = false;                ///< a count or a set of bits: a number without fraction
    std::vector<std::string> choices;  ///< of a word; empty: any word
    std::string applies_to;            ///< letters of the physical kinds: S R A V C P F G
    std::string label;                 ///< for people, e.g. "Sliding friction"
    std::string help;                  ///< one sentence
};

/// Letters of all physical kinds, as in AttributeDescription::applies_to.
inline constexpr std::string_view every_kind = "SRAVCPFG";
/// 'R' for rigid; '\0' for visual.
char letter_of_kind(PhysicalKind kind);
/// Rigid for 'R'; nothing for what is no such letter.
std::optional<PhysicalKind> kind_of_letter(char letter);

/// All attributes in the order in which they are shown.
const std::vector<AttributeDescription>& registry();
const AttributeDescription* describe(std::string_view name);

/// Whether the name exists, the type fits and the value is in range; the error says range or choices, and for a wrong
/// name the nearest right one.
Result<void> validate(std::string_view name, const AttributeValue& value);

/// Reads a value typed by a person ("0.5", "true", "oak", "1,2,3") and validates it.
Result<AttributeValue> parse_value(std::string_view name, std::string_view text);
/// The value as text that parse_value reads back.
std::string to_text(const AttributeValue& value);

}  // namespace embody::attributes
