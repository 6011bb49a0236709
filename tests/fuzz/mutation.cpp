// SPDX-License-Identifier: MIT
#include "mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace embody::fuzz {
namespace {

constexpr std::array<std::uint64_t, 22> words{0,
                                              1,
                                              2,
                                              3,
                                              4,
                                              7,
                                              16,
                                              0x7F,
                                              0x80,
                                              0xFF,
                                              0x100,
                                              0x7FFF,
                                              0x8000,
                                              0xFFFF,
                                              0x10000,
                                              0x7FFFFFFF,
                                              0x80000000,
                                              0xFFFFFFFF,
                                              0x7F800000,  // infinite as 32 bits
                                              0x7FC00000,  // no number as 32 bits
                                              0x7FF0000000000000,
                                              0xFFFFFFFFFFFFFFFF};
constexpr std::array<std::string_view, 22> numerals{
    "0",          "-0",          "1",          "-1",         "2",
    "3",          "65535",       "65536",      "-32768",     "2147483647",
    "2147483648", "-2147483649", "4294967295", "4294967296", "18446744073709551615",
    "1e308",      "-1e308",      "1e999",      "1e-320",     "nan",
    "inf",        "0.1e"};
constexpr std::array<std::string_view, 16> texts{"\"", "\\",      "{",       "}",           "[",        "]",
                                                 "\n", "\\ud800", "../",     "/etc/passwd", "\xFF\xFE", "\xC0\x80",
                                                 "<",  "&a;",     "\x1b[2J", "\xE2\x80\xAE"};

std::size_t any_place(const Bytes& bytes, Random& random) {
    return static_cast<std::size_t>(random.below(bytes.size()));
}

/// A block of `from`; short ones are more likely than long ones.
std::span<const std::uint8_t> any_block(std::span<const std::uint8_t> from, Random& random) {
    if (from.empty()) return {};
    const std::size_t begin = static_cast<std::size_t>(random.below(from.size()));
    const std::uint64_t longest = std::uint64_t{1} << random.below(12);
    const std::size_t length = static_cast<std::size_t>(1 + random.below(longest));
    return from.subspan(begin, std::min(length, from.size() - begin));
}

/// Inserts `block` at `at` in the place of `replaced` bytes.
void put(Bytes& bytes, std::size_t at, std::size_t replaced, std::span<const std::uint8_t> block) {
    const Bytes copy(block.begin(), block.end());  // the block may be a part of `bytes`
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(replaced, bytes.size() - at));
    bytes.insert(bytes.erase(begin, end), copy.begin(), copy.end());
}

void put(Bytes& bytes, std::size_t at, std::size_t replaced, std::string_view text) {
    put(bytes, at, replaced, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

/// Changes a word of 1, 2, 4 or 8 bytes in either byte order: replaces it, or adds or subtracts a small number.
void change_word(Bytes& bytes, Random& random) {
    const std::size_t size = std::min(std::size_t{1} << random.below(4), bytes.size());
    const std::size_t at = static_cast<std::size_t>(random.below(bytes.size() - size + 1));
    const bool big_endian = random.below(2) == 0;
    const auto place = [&](std::size_t i) { return at + (big_endian ? size - 1 - i : i); };
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < size; ++i) word |= static_cast<std::uint64_t>(bytes[place(i)]) << (8 * i);
    word = random.below(2) == 0 ? words[random.below(words.size())] : word + random.below(33) - 16;
    for (std::size_t i = 0; i < size; ++i) bytes[place(i)] = static_cast<std::uint8_t>(word >> (8 * i));
}

/// Changes a number that is written in digits.
void change_numeral(Bytes& bytes, Random& random) {
    const auto is_digit = [](std::uint8_t c) { return std::isdigit(c) != 0; };
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(any_place(bytes, random));
    auto begin = std::find_if(from, bytes.end(), is_digit);
    if (begin == bytes.end()) begin = std::find_if(bytes.begin(), from, is_digit);
    const auto end = std::find_if_not(begin, bytes.end(), is_digit);
    put(bytes, static_cast<std::size_t>(begin - bytes.begin()), static_cast<std::size_t>(end - begin),
        numerals[random.below(numerals.size())]);
}

void change_once(Bytes& bytes, std::span<const std::uint8_t> other, Random& random) {
    const std::uint64_t way = random.below(12);
    if (bytes.empty()) return put(bytes, 0, 0, any_block(other, random));
    const std::size_t at = any_place(bytes, random);
    switch (way) {
        case 0:
            bytes[at] ^= static_cast<std::uint8_t>(1u << random.below(8));
            break;
        case 1:
            bytes[at] = static_cast<std::uint8_t>(random.next());
            break;
        case 2:
        case 3:
            change_word(bytes, random);
            break;
        case 4:
        case 5:
            change_numeral(bytes, random);
            break;
        case 6:
            put(bytes, at, random.below(3), texts[random.below(texts.size())]);
            break;
        case 7:
            put(bytes, at, any_block(bytes, random).size(), std::string_view());
            break;
        case 8:
            put(bytes, at, 0, any_block(bytes, random));
            break;
        case 9: {
            const auto block = any_block(bytes, random);
            put(bytes, at, block.size(), block);
            break;
        }
        case 10:
            put(bytes, at, random.below(2) == 0 ? 0 : any_block(bytes, random).size(), any_block(other, random));
            break;
        default:
            // Rarely, because little of the input is left.
            if (random.below(4) == 0) bytes.resize(at);
            break;
    }
}

}  // namespace

Bytes damaged(const Bytes& input, std::span<const std::uint8_t> other, Random& random) {
    Bytes bytes = input;
    const std::uint64_t times = std::uint64_t{1} << random.below(4);
    for (std::uint64_t i = 0; i < times; ++i) change_once(bytes, other, random);
    if (bytes.size() > largest_input) bytes.resize(largest_input);
    return bytes;
}

}  // namespace embody::fuzz
