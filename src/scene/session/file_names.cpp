// SPDX-License-Identifier: MIT
#include "scene/session/file_names.h"

#include <cctype>
#include <charconv>
#include <ctime>
#include <string_view>

#include "foundation/state_hash.h"

namespace embody::scene {

namespace fs = std::filesystem;

namespace {

/// Number of bytes of a longer name in its stem.
constexpr std::size_t kept_of_long_name = 150;

// Whether a file's name may contain the byte in every file system and shell.
bool is_plain(unsigned char byte) {
    return std::isalnum(byte) != 0 || byte >= 0x80 ||
           std::string_view(" -_().").find(static_cast<char>(byte)) != std::string_view::npos;
}

}  // namespace

std::string encoded(const std::string& name) {
    static constexpr char digits[] = "0123456789ABCDEF";
    std::string stem;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (is_plain(byte) && !(c == '.' && stem.empty())) {
            stem += c;
        } else {
            stem += {'%', digits[byte >> 4], digits[byte & 15]};
        }
    }
    return stem;
}

std::string decoded(const std::string& stem) {
    std::string name;
    for (std::size_t i = 0; i < stem.size(); ++i) {
        unsigned code = 0;
        const char* begin = stem.data() + i + 1;
        const bool is_code =
            stem[i] == '%' && i + 2 < stem.size() && std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2;
        name += is_code ? static_cast<char>(code) : stem[i];
        if (is_code) i += 2;
    }
    return name;
}

std::string shortened_stem(const std::string& name) {
    const std::string stem = encoded(name);
    if (stem.size() <= max_stem_bytes) return stem;
    // encoded() never makes a "%~".
    std::size_t kept = kept_of_long_name;
    while ((static_cast<unsigned char>(stem[kept]) & 0xC0) == 0x80) --kept;
    StateHash hash;
    hash.add_bytes(stem.data(), stem.size());
    return stem.substr(0, kept) + "%~" + std::to_string(hash.value());
}

std::string utc_text(std::chrono::system_clock::time_point time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::string utc_text(fs::file_time_type time) {
    return utc_text(std::chrono::time_point_cast<std::chrono::system_clock::duration>(
        time - fs::file_time_type::clock::now() + std::chrono::system_clock::now()));
}

}  // namespace embody::scene
