// SPDX-License-Identifier: MIT
#include "interchange/ply/ply_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace embody::interchange {
namespace {

template <class T>
double number_of(const std::array<char, 8>& bytes) {
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
}

double number_of(PlyType type, const std::array<char, 8>& bytes) {
    switch (type) {
        case PlyType::int8:
            return number_of<std::int8_t>(bytes);
        case PlyType::uint8:
            return number_of<std::uint8_t>(bytes);
        case PlyType::int16:
            return number_of<std::int16_t>(bytes);
        case PlyType::uint16:
            return number_of<std::uint16_t>(bytes);
        case PlyType::int32:
            return number_of<std::int32_t>(bytes);
        case PlyType::uint32:
            return number_of<std::uint32_t>(bytes);
        case PlyType::float32:
            return number_of<float>(bytes);
        case PlyType::float64:
            return number_of<double>(bytes);
    }
    return 0;
}

}  // namespace

std::optional<double> PlyNumbers::next(PlyType type) {
    if (encoding_ == PlyEncoding::ascii) return next_in_text();
    const std::size_t size = size_of(type);
    if (left_.size() < size) return std::nullopt;
    std::array<char, 8> bytes{};
    std::copy_n(left_.begin(), size, bytes.begin());
    constexpr bool little = std::endian::native == std::endian::little;
    if ((encoding_ == PlyEncoding::little_endian) != little) std::reverse(bytes.begin(), bytes.begin() + size);
    left_.remove_prefix(size);
    return number_of(type, bytes);
}

std::optional<double> PlyNumbers::next_in_text() {
    while (!left_.empty() && std::string_view(" \t\r\n").find(left_.front()) != std::string_view::npos) {
        if (left_.front() == '\n') ++line_;
        left_.remove_prefix(1);
    }
    const std::size_t sign = !left_.empty() && left_.front() == '+' ? 1 : 0;
    double value = 0;
    const char* end = left_.data() + left_.size();
    const auto read = std::from_chars(left_.data() + sign, end, value);
    if (read.ec != std::errc()) return std::nullopt;
    left_.remove_prefix(static_cast<std::size_t>(read.ptr - left_.data()));
    if (!left_.empty() && std::string_view(" \t\r\n").find(left_.front()) == std::string_view::npos)
        return std::nullopt;
    return value;
}

bool PlyNumbers::next_list(const PlyProperty& property, std::vector<double>& list) {
    list.clear();
    const auto count = next(*property.count_type);
    // Each number takes a byte at least.
    if (!count || !(*count >= 0) || *count > static_cast<double>(left_.size())) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(*count); ++i) {
        const auto number = next(property.type);
        if (!number) return false;
        list.push_back(*number);
    }
    return true;
}

std::string PlyNumbers::place() const {
    if (encoding_ == PlyEncoding::ascii) return "line " + std::to_string(line_);
    return "byte " + std::to_string(file_size_ - left_.size());
}

}  // namespace embody::interchange
