// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace embody::interchange {

/// A material that a name alone stands for.
struct NamedMaterial {
    std::string_view name;
    std::array<float, 3> color;  ///< of the screen (sRGB)
    float exponent;              ///< of the highlight; 0: matt
    float opacity;
};

/// OBJ files that name no material library mean those that Java 3D's reader brings along: most of the furniture that
/// Sweet Home 3D itself comes with, and so most of what stands in people's homes. Null: no such name.
const NamedMaterial* named_material(std::string_view name);

}  // namespace embody::interchange
