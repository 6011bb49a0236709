// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "foundation/result.h"

namespace embody::scene {

/// Writes `text` to `file`, whole or not at all even at a power failure: a draft beside it is synced and renamed over
/// it. Makes missing folders. The file keeps its mode; a new one gets what the umask allows. Drafts that killed
/// programs left in the folder are removed.
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

/// The same in two parts: a draft is written beside `file`, and put in its place. Removed where that is not done.
class WholeFileDraft {
public:
    /// Syncing takes milliseconds to seconds; without it a power failure may leave an empty file.
    static Result<WholeFileDraft> write(const std::filesystem::path& file, std::string_view text,
                                        bool is_synced = true);
    WholeFileDraft(WholeFileDraft&& other) noexcept;
    WholeFileDraft& operator=(WholeFileDraft&&) = delete;
    ~WholeFileDraft();

    /// Appends `more`, which is not synced, and renames the draft over the file.
    Result<void> put_in_place(std::string_view more = {});

private:
    WholeFileDraft() = default;

    std::filesystem::path file_;
    std::string name_;     ///< empty: it is in place
    int descriptor_ = -1;  ///< locked, which tells others that the draft is in use
};

/// Makes a rename in the folder last through a power failure.
void sync_folder(const std::filesystem::path& folder);

/// Removes the drafts in `folder` that no running program writes any more. Other files and sub-folders are left alone.
void remove_abandoned_drafts(const std::filesystem::path& folder);

}  // namespace embody::scene
