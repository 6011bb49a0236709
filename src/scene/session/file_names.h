// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>

namespace embody::scene {

/// Maximum length of a file's name without its extension, bytes: file systems allow 255, and a draft's name is longer.
inline constexpr std::size_t max_stem_bytes = 200;

/// A name as a file's stem, the inverse of decoded(): bytes that a file system or a shell could misread become "%" and
/// two hexadecimal digits, and so does a dot at the front, which would hide the file. Different names have different
/// stems.
std::string encoded(const std::string& name);
std::string decoded(const std::string& stem);

/// The stem of a name of any length: of a long one its beginning, up to a whole character, and a number that tells it
/// from others.
std::string shortened_stem(const std::string& name);

/// In UTC, for example "2026-11-24T03:10:00Z".
std::string utc_text(std::chrono::system_clock::time_point time);
std::string utc_text(std::filesystem::file_time_type time);

}  // namespace embody::scene
