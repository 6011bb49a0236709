// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
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

/// Description of an attribute: the one source of truth for the API, the scene schema, the command line, the Studio's
/// panel and the documentation.
struct AttributeDescription {
    std::string name;  ///< e.g. "friction_dynamic"
    std::string
        kind;  ///< the paper's attr_kind: identity, mass, shape, surface, motion, soft, cloth, rope, fluid, grain
    std::string kind_label;  ///< the kind, for people: "Soft body"
    ValueType type = ValueType::number;
    std::string unit;                 ///< SI, "1" for a pure number, "" for words
    AttributeValue standard;          ///< default value
    std::optional<double> low, high;  ///< valid range of a number or of each component
    int size_power = 0;  ///< power of a thing's size that the value grows with; 0: a property of the material
    bool whole = false;  ///< a count or a set of bits: a number without fraction
    std::vector<std::string> choices;  ///< of a word; empty: any word
    std::string applies_to;            ///< letters of the physical kinds that it concerns, as in KindTraits
    std::string label;                 ///< for people, e.g. "Sliding friction"
    std::string help;                  ///< one sentence
};

/// The own letters of all physical kinds that have one, for AttributeDescription::applies_to; ends with a zero.
inline constexpr auto every_kind = [] {
    std::array<char, kind_count + 1> letters{};
    std::size_t count = 0;
    for (const PhysicalKind kind : physical_kinds)
        if (!traits_of(kind).letters.empty()) letters[count++] = traits_of(kind).letters.front();
    return letters;
}();

/// Whether an attribute concerns things of this physical kind; things that are only drawn have the identity attributes.
bool applies_to(const AttributeDescription& attribute, PhysicalKind kind);

/// All attributes in the order in which they are shown.
const std::vector<AttributeDescription>& registry();
const AttributeDescription* describe(std::string_view name);

/// Whether the name exists, the type is right and the value is in range. The error says the range or the choices, and
/// for a wrong name the nearest right one.
Result<void> validate(std::string_view name, const AttributeValue& value);

/// Reads a value typed by a person ("0.5", "true", "oak", "1,2,3") and validates it.
Result<AttributeValue> parse_value(std::string_view name, std::string_view text);
/// The value as text that parse_value reads back.
std::string to_text(const AttributeValue& value);

}  // namespace embody::attributes
