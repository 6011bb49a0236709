// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "scene/file/json/field_reader.h"

namespace embody::scene {

/// Sets the variant to the alternative, with its defaults, whose `name` is in the field "type"; false where none has
/// that name.
template <class... Alternatives>
bool read_alternative(FieldReader& reader, std::variant<Alternatives...>& variant) {
    std::size_t type = 0, alternative = 0;
    if (!reader.choice("type", type, {Alternatives::name...})) return false;
    ((alternative++ == type ? (variant = Alternatives{}, true) : false) || ...);
    return true;
}

}  // namespace embody::scene
