// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "math/quat.h"

namespace embody::fuzz {

/// Reads bytes as choices and numbers. After the end all bytes are zero, and zero means the usual value: the first
/// choice, the lowest number.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool is_at_end() const { return at_ >= bytes_.size(); }

    std::uint8_t byte() { return is_at_end() ? std::uint8_t{0} : bytes_[at_++]; }
    /// 0 … count - 1; 1 <= count <= 256.
    std::size_t below(std::size_t count) { return byte() % count; }
    /// True with probability 1 / `times`.
    bool is_one_of(std::size_t times) { return below(times) == times - 1; }

    /// For most bytes a number from `lowest` to `highest`; one byte in 16 yields a number that often causes errors.
    double number(double lowest, double highest) {
        const std::uint8_t chosen = byte();
        if (chosen >= first_odd) return odd_numbers[chosen - first_odd];
        return lowest + (highest - lowest) * chosen / (first_odd - 1);
    }
    Vec3 vector(double lowest, double highest) {
        const double x = number(lowest, highest), y = number(lowest, highest), z = number(lowest, highest);
        return {x, y, z};
    }
    Quat rotation() {
        if (is_one_of(8)) return {number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1)};
        const Vec3 axis = normalized(Vec3{1, byte() / 255.0, byte() / 255.0});
        return from_axis_angle(axis, byte() / 64.0);
    }

private:
    static constexpr std::size_t first_odd = 240;
    static constexpr std::array<double, 256 - first_odd> odd_numbers{0.0,
                                                                     -0.0,
                                                                     1,
                                                                     -1,
                                                                     1e-5,
                                                                     -1e-5,
                                                                     1e5,
                                                                     1e9,
                                                                     -1e9,
                                                                     1e15,
                                                                     -1e38,
                                                                     std::numeric_limits<double>::max(),
                                                                     std::numeric_limits<double>::denorm_min(),
                                                                     std::numeric_limits<double>::quiet_NaN(),
                                                                     std::numeric_limits<double>::infinity(),
                                                                     -std::numeric_limits<double>::infinity()};

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace embody::fuzz
