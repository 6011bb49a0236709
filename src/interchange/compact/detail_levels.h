// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "interchange/compact/stored_part.h"

namespace embody::interchange {

/// Levels of detail beside the full one, coarser and coarser: how far a level's surface may be from the full one's, as
/// a fraction of the model's largest extent. Drawn where that is less than a pixel, a level is good for models of 1000,
/// 500, 250 … 16 pixels.
inline constexpr std::array level_errors{0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.064};

/// A coarser surface on the vertices of a part.
struct DetailLevel {
    std::vector<std::uint32_t> indices;  ///< empty: the part is too small to be seen on this level
    double error = 0;                    ///< estimated distance from the full surface, steps of the model's grid
};

/// The part on each level of `level_errors`, never finer than on the one before. Needs the part's normals.
/// Deterministic.
std::vector<DetailLevel> detail_levels(const StoredPart& part);

/// The stored form with its levels: each primitive's `extras.embody.levels` has an object a level with the accessor of
/// its indices (none: nothing is drawn) and its `error` in m. What has them already stays as it is.
Result<std::vector<std::uint8_t>> with_detail_levels(std::span<const std::uint8_t> bytes);

}  // namespace embody::interchange
