// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace embody::server {

static_assert(std::endian::native == std::endian::little, "frames are little-endian and written as they lie in memory");

/// Appends a number's bytes to a binary frame.
template <class T>
void append(std::string& frame, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    frame.append(bytes, sizeof(T));
}

}  // namespace embody::server
