// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>

namespace embody {

/// A typed reference to an element of a HandleTable. All zero is null; a handle whose element was removed
/// is detectably stale, because the slot's generation has increased.
template <class Tag>
struct Handle {
    std::uint32_t index = 0;       ///< slot in the table
    std::uint32_t generation = 0;  ///< 0 only for the null handle

    [[nodiscard]] bool is_null() const { return generation == 0; }
    friend auto operator<=>(const Handle&, const Handle&) = default;
};

}  // namespace embody
