// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "attributes/attribute.h"

namespace embody::attributes {

/// What a thing is to the simulation: the attribute "kind". Text is only in files, in the database and in messages.
enum class PhysicalKind : std::uint8_t {
    static_body,
    rigid,
    articulated,
    soft,
    cloth,
    rope,
    fluid,
    granular,
    visual,  ///< only drawn
};

/// All, in the order in which they are offered to people.
inline constexpr std::array physical_kinds{PhysicalKind::static_body, PhysicalKind::rigid,    PhysicalKind::articulated,
                                           PhysicalKind::soft,        PhysicalKind::cloth,    PhysicalKind::rope,
                                           PhysicalKind::fluid,       PhysicalKind::granular, PhysicalKind::visual};
static_assert(physical_kinds.size() == static_cast<std::size_t>(PhysicalKind::visual) + 1);

/// "static", "rigid", "articulated", "soft", "cloth", "rope", "fluid", "granular" or "visual".
std::string to_text(PhysicalKind kind);
/// Nothing for any other text.
std::optional<PhysicalKind> kind_from_text(std::string_view text);

/// The kind as the value of the attribute "kind".
AttributeValue to_value(PhysicalKind kind);
/// Nothing for a value that is no kind.
std::optional<PhysicalKind> kind_from_value(const AttributeValue& value);
/// Of a thing with these attributes; rigid where they say nothing, as the registry's default is.
PhysicalKind kind_of(const AttributeSet& set);

/// Whether such things are sheets or lines, which weigh by their area or length: cloth, rope.
bool is_thin(PhysicalKind kind);
/// Whether such things keep their parts together and bend: soft, cloth, rope.
bool is_deformable(PhysicalKind kind);
/// Whether such things flow and have the form of what holds them: fluid, granular.
bool flows(PhysicalKind kind);
/// Whether such things are no rigid body: those that bend or flow.
bool changes_form(PhysicalKind kind);

}  // namespace embody::attributes
