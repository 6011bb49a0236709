// SPDX-License-Identifier: MIT
// The switches have no default, so that the compiler names each place that a new kind is missing in.
#include "attributes/physical_kind.h"

#include <algorithm>

namespace embody::attributes {

std::string to_text(PhysicalKind kind) {
    switch (kind) {
        case PhysicalKind::static_body:
            return "static";
        case PhysicalKind::rigid:
            return "rigid";
        case PhysicalKind::articulated:
            return "articulated";
        case PhysicalKind::soft:
            return "soft";
        case PhysicalKind::cloth:
            return "cloth";
        case PhysicalKind::rope:
            return "rope";
        case PhysicalKind::fluid:
            return "fluid";
        case PhysicalKind::granular:
            return "granular";
        case PhysicalKind::visual:
            return "visual";
    }
    return {};
}

std::optional<PhysicalKind> kind_from_text(std::string_view text) {
    const auto found = std::ranges::find_if(physical_kinds, [&](PhysicalKind kind) { return to_text(kind) == text; });
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

bool is_thin(PhysicalKind kind) {
    switch (kind) {
        case PhysicalKind::cloth:
        case PhysicalKind::rope:
            return true;
        case PhysicalKind::static_body:
        case PhysicalKind::rigid:
        case PhysicalKind::articulated:
        case PhysicalKind::soft:
        case PhysicalKind::fluid:
        case PhysicalKind::granular:
        case PhysicalKind::visual:
            return false;
    }
    return false;
}

bool flows(PhysicalKind kind) {
    switch (kind) {
        case PhysicalKind::fluid:
        case PhysicalKind::granular:
            return true;
        case PhysicalKind::static_body:
        case PhysicalKind::rigid:
        case PhysicalKind::articulated:
        case PhysicalKind::soft:
        case PhysicalKind::cloth:
        case PhysicalKind::rope:
        case PhysicalKind::visual:
            return false;
    }
    return false;
}

bool is_deformable(PhysicalKind kind) { return kind == PhysicalKind::soft || is_thin(kind); }

bool changes_form(PhysicalKind kind) { return is_deformable(kind) || flows(kind); }

}  // namespace embody::attributes
