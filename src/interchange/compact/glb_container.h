// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

/// The two chunks of a binary glTF file (glTF 2.0 specification, section 4).
struct GlbView {
    std::span<const std::uint8_t> json, binary;
};

/// Checks the header and the chunk lengths.
Result<GlbView> split_glb(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> join_glb(const nlohmann::json& json, std::span<const std::uint8_t> binary);

}  // namespace embody::interchange
