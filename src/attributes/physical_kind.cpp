// SPDX-License-Identifier: MIT
#include "attributes/physical_kind.h"

#include <algorithm>

namespace embody::attributes {

std::string to_text(PhysicalKind kind) { return std::string(traits_of(kind).text); }

std::optional<PhysicalKind> kind_from_text(std::string_view text) {
    const auto found = std::ranges::find(physical_kinds, text, [](PhysicalKind kind) { return traits_of(kind).text; });
    return found == physical_kinds.end() ? std::nullopt : std::optional(*found);
}

AttributeValue to_value(PhysicalKind kind) { return to_text(kind); }

std::optional<PhysicalKind> kind_from_value(const AttributeValue& value) {
    const auto* word = std::get_if<std::string>(&value);
    return word == nullptr ? std::nullopt : kind_from_text(*word);
}

PhysicalKind kind_of(const AttributeSet& set) {
    const AttributeEntry* held = set.find("kind");
    return (held == nullptr ? std::nullopt : kind_from_value(held->value)).value_or(PhysicalKind::rigid);
}

Matter matter_of(const AttributeSet& set) { return traits_of(kind_of(set)).matter; }

bool is_static(PhysicalKind kind) { return traits_of(kind).never_moves; }

bool is_thin(PhysicalKind kind) {
    const Matter matter = traits_of(kind).matter;
    return matter == Matter::sheet || matter == Matter::line;
}

bool is_deformable(PhysicalKind kind) { return traits_of(kind).matter == Matter::solid || is_thin(kind); }

bool flows(PhysicalKind kind) {
    const Matter matter = traits_of(kind).matter;
    return matter == Matter::liquid || matter == Matter::grains;
}

bool changes_form(PhysicalKind kind) { return is_deformable(kind) || flows(kind); }

}  // namespace embody::attributes
