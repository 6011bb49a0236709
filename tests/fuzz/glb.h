// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string_view>

#include "target.h"

namespace embody::fuzz {

/// Sets the lengths of a binary glTF to the true ones: the JSON ends at the last brace before the binary chunk's name.
inline std::size_t with_glb_lengths(std::uint8_t* data, std::size_t size) {
    constexpr std::string_view chunk_name("BIN\0", 4);
    if (size < 28) return size;
    const std::span bytes(data, size);
    set_word(bytes, 8, size);
    const auto found = std::search(data + 20, data + size, chunk_name.begin(), chunk_name.end());
    if (found == data + size || found - data < 24) {
        set_word(bytes, 12, size - 20);
        return size;
    }
    const auto name = static_cast<std::size_t>(found - data);
    set_word(bytes, 12, name - 4 - 20);
    set_word(bytes, name - 4, size - name - 4);
    return size;
}

}  // namespace embody::fuzz
