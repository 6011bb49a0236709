// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace embody {

/// Order-dependent 64-bit hash of simulation state (FNV-1a), to tell whether two runs are bit for bit equal
/// and to key content. Not cryptographic.
class StateHash {
public:
    void add_bytes(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) {
            value_ ^= bytes[i];
            value_ *= 0x100000001B3ull;
        }
    }
    void add(std::uint64_t word) { add_bytes(&word, sizeof word); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ull;
};

}  // namespace embody
