// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "foundation/result.h"

namespace embody::catalog {

/// Size and time of change; a file with the same stamp is taken to have the same bytes.
Result<std::string> stamp_file(const std::filesystem::path& file);

/// Called again and again with the number of bytes done; false stops.
using HashProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// Hash of the bytes of the regular file at this canonical path; nothing where `progress` stopped it. Refuses files of
/// more than `limit` bytes before the first one is read, and never reads more.
Result<std::optional<std::uint64_t>> hash_file(const std::filesystem::path& file, std::uint64_t limit,
                                               const HashProgress& progress);

}  // namespace embody::catalog
