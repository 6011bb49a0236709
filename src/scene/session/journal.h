// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "foundation/result.h"
#include "scene/document/document.h"

namespace embody::scene {

/// The file that holds every edit of one open document (docs/session.md, "Journal"): a kill of the process loses none
/// that add() has returned for, a power cut at most those of the last second.
class Journal {
public:
    /// Begins a journal in the folder, which is made if missing, after the first edit of a document that is saved under
    /// `scene` (empty: not yet). Of journals that no running program holds the newest 50 are kept.
    static Result<std::unique_ptr<Journal>> begin(const std::filesystem::path& folder, const std::string& scene,
                                                  const Document& document);
    /// The file stays, and is a recovery from then on.
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// Appends the changes of an edit as a document event tells them; `document` is as it is after them. After an error
    /// the next call writes the whole document anew; until then the file keeps the edits before.
    Result<void> add(const nlohmann::json& changes, const Document& document);
    /// Removes the file: its document is saved.
    void remove();

private:
    Journal() = default;
    [[nodiscard]] std::string whole_text(const Document& document) const;
    Result<void> write_anew(const Document& document, bool is_synced);
    bool take_file(std::size_t whole_size, std::size_t lines_size);
    void renew(std::unique_lock<std::mutex>& lock);
    void sync_each_second();

    std::filesystem::path file_;
    std::string scene_, started_;
    std::size_t edits_ = 1;  ///< with that which began the journal

    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    int descriptor_ = -1;               ///< locked
    std::size_t whole_size_ = 0;        ///< bytes of the document as it was written last
    std::size_t lines_size_ = 0;        ///< bytes of the edits behind it
    bool is_torn_ = false;              ///< the last line was written in part
    std::optional<std::string> whole_;  ///< for the thread to write anew
    bool is_renewed_ = false;           ///< the thread has that in hand, or will
    std::uint64_t renewals_ = 0;        ///< another number: what it has in hand is not wanted any more
    std::string lines_since_;           ///< edits that `whole_` does not have in it
    bool is_dirty_ = false, folder_is_dirty_ = false, ends_ = false;
    std::thread syncing_;
};

/// A journal that no running program holds.
struct Recovery {
    std::filesystem::path file;
    std::string scene;  ///< name of the saved scene; empty: never saved
    std::string title;
    std::string modified;  ///< UTC
    std::size_t edits = 0;
};

/// The newest first. Files that are no journals are left out.
std::vector<Recovery> list_recoveries(const std::filesystem::path& folder);

struct Recovered {
    Document document;
    std::string scene;     ///< as in Recovery
    std::size_t lost = 0;  ///< number of edits behind a damaged line, which could not be read
};
/// The document with all edits up to the first line that is not whole.
Result<Recovered> read_journal(const std::filesystem::path& file);

}  // namespace embody::scene
