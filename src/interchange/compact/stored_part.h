// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "interchange/compact/glb_container.h"

namespace embody::interchange {

using GridPoint = std::array<std::uint16_t, 4>;  ///< x y z on the model's grid, and padding to 4 bytes
using OctNormal = std::array<std::int8_t, 4>;    ///< octahedral, as glTF packs it
using ExpTexture = std::array<std::uint32_t, 2>;

/// One part of the stored form, unpacked. What is asked for has one value a vertex; indices are below their number.
struct StoredPart {
    std::vector<GridPoint> positions;
    std::vector<OctNormal> normals;      ///< x y z of unit length 127; empty where not asked for
    std::vector<ExpTexture> textures;    ///< as packed, only equal or not; empty without texture or where not asked for
    std::vector<std::uint32_t> indices;  ///< three a triangle
};

enum class PartContent : std::uint8_t { surface, all };

/// Unpacks a primitive that encode() wrote. Safe on any bytes; reads beyond the JSON's ends throw json::exception.
Result<StoredPart> unpack_part(const nlohmann::json& document, const nlohmann::json& primitive, const GlbView& glb,
                               PartContent content);

}  // namespace embody::interchange
