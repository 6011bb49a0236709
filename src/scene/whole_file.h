// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "foundation/result.h"

namespace embody::scene {

/// Puts `text` in `file`, whole or not at all, whenever the power goes: a new file beside it, synced, renamed over it.
/// Makes missing folders.
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

}  // namespace embody::scene
