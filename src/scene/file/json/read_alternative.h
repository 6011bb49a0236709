// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "scene/file/json/field_reader.h"

namespace embody::scene {

/// Makes the variant the alternative, with its defaults, whose `name` the field "type" says; false where it is none.
template <class... Alternatives>
bool read_alternative(FieldReader& reader, std::variant<Alternatives...>& variant) {
    std::size_t type = 0, alternative = 0;
    if (!reader.choice("type", type, {Alternatives::name...})) return false;
    ((alternative++ == type ? (variant = Alternatives{}, true) : false) || ...);
    return true;
}

}  // namespace embody::scene
