// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "foundation/result.h"

namespace embody::scene {

/// Writes `text` to `file`, whole or not at all even at a power failure: a draft beside it is synced and renamed over
/// it. Makes missing folders. The file keeps its mode; a new one gets what the umask allows. Drafts that killed
/// programs left in the folder are removed.
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

/// Removes the drafts in `folder` that no running program writes any more. Other files and sub-folders are left alone.
void remove_abandoned_drafts(const std::filesystem::path& folder);

}  // namespace embody::scene
