// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "attributes/attribute.h"

namespace embody::attributes {

/// What a thing is to the simulation: the attribute "kind", in the order in which people see the kinds. The text form
/// is used only in files, in the database and in messages. traits_of() has the properties of each kind.
enum class PhysicalKind : std::uint8_t { static_body, rigid, articulated, soft, cloth, rope, fluid, granular, visual };

/// How things of a kind are simulated. Several kinds may have the same.
enum class Matter : std::uint8_t { none, body, solid, sheet, line, liquid, grains };

/// The properties of a kind.
struct KindTraits {
    std::string_view text = {};     ///< in files, databases and messages: it must not change
    std::string_view meaning = {};  ///< for people, after the text: "rope is a line"
    /// Letters of the attributes that concern this kind, as in AttributeDescription::applies_to: the kind's own letter,
    /// then those of kinds whose attributes it has too. Empty: only the attributes of identity concern it.
    std::string_view letters = {};
    Matter matter = Matter::body;
    bool never_moves = false;
};

/// The table of kinds. The switch has no default, so that the compiler refuses a kind without a row.
constexpr KindTraits traits_of(PhysicalKind kind) {
    switch (kind) {
        case PhysicalKind::static_body:
            return {.text = "static", .meaning = "never moves", .letters = "S", .never_moves = true};
        case PhysicalKind::rigid:
            return {.text = "rigid", .meaning = "moves and keeps its form", .letters = "R"};
        case PhysicalKind::articulated:
            return {.text = "articulated", .meaning = "is one rigid body for now", .letters = "A"};
        case PhysicalKind::soft:
            return {.text = "soft",
                    .meaning = "changes its form and springs back",
                    .letters = "V",
                    .matter = Matter::solid};
        case PhysicalKind::cloth:
            return {.text = "cloth", .meaning = "is a sheet", .letters = "C", .matter = Matter::sheet};
        case PhysicalKind::rope:
            return {.text = "rope", .meaning = "is a line", .letters = "P", .matter = Matter::line};
        case PhysicalKind::fluid:
            return {.text = "fluid", .meaning = "is liquid", .letters = "F", .matter = Matter::liquid};
        case PhysicalKind::granular:
            return {.text = "granular", .meaning = "is filled with grains", .letters = "G", .matter = Matter::grains};
        case PhysicalKind::visual:
            return {.text = "visual", .meaning = "is only drawn", .matter = Matter::none};
    }
    return {};
}

/// The number of kinds: the first value without a row ends the count.
inline constexpr std::size_t kind_count = [] {
    std::size_t count = 0;
    while (!traits_of(static_cast<PhysicalKind>(count)).text.empty()) ++count;
    return count;
}();

/// All kinds, in the order of the enumeration.
inline constexpr auto physical_kinds = [] {
    std::array<PhysicalKind, kind_count> kinds{};
    for (std::size_t i = 0; i < kind_count; ++i) kinds[i] = static_cast<PhysicalKind>(i);
    return kinds;
}();

/// "static", "rigid", …
std::string to_text(PhysicalKind kind);
/// Empty for any other text.
std::optional<PhysicalKind> kind_from_text(std::string_view text);

/// The kind as the value of the attribute "kind".
AttributeValue to_value(PhysicalKind kind);
/// Empty for a value that is no kind.
std::optional<PhysicalKind> kind_from_value(const AttributeValue& value);
/// The kind of a thing with these attributes; rigid, the registry's default, where they have none.
PhysicalKind kind_of(const AttributeSet& set);
/// How a thing with these attributes is simulated.
Matter matter_of(const AttributeSet& set);

/// Whether such things never move.
bool is_static(PhysicalKind kind);
/// Whether such things are sheets or lines, which weigh by their area or length.
bool is_thin(PhysicalKind kind);
/// Whether such things keep their parts together and bend: soft solids, sheets, lines.
bool is_deformable(PhysicalKind kind);
/// Whether such things flow and take the form of their container: liquids, grains.
bool flows(PhysicalKind kind);
/// Whether such things are no rigid body: those that bend or flow.
bool changes_form(PhysicalKind kind);

}  // namespace embody::attributes
