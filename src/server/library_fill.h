// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "catalog/catalog.h"
#include "server/import_request.h"
#include "server/remaining_time.h"

namespace embody::server {

enum class FillState : std::uint8_t { running, done, stopped };

/// How far the filling of the library is.
struct FillProgress {
    FillState state = FillState::running;
    std::size_t done = 0, total = 0, added = 0;    ///< total 0: files are still looked for
    std::size_t shapeless = 0;                     ///< light sources that are nothing but light
    std::optional<double> seconds_left;            ///< none: not known yet
    std::string file;                              ///< model just finished
    std::vector<catalog::ImportFailure> failures;  ///< of what was read to its end
    std::vector<std::string> notes;                ///< what could not be had, in sentences
};

/// The `import` event of docs/protocol.md.
nlohmann::json fill_json(const FillProgress& progress);

/// What the server imports by itself, while it is used.
struct FillOptions {
    std::vector<std::filesystem::path> catalogues;
    /// Names more catalogues, one a line, and may be a pipe that is still written; a line "# text" says what could not
    /// be had. Empty: none.
    std::filesystem::path list;
    /// Written when all was read, and nothing was missing; empty: none.
    std::filesystem::path mark;
    /// Keys of models that are missing now, which are imported before others; asked about twice a second, from its
    /// thread. May be empty.
    std::function<std::set<std::string>()> wanted = {};
    std::function<void(const FillProgress&)> tell = {};  ///< about twice a second, from its thread; may be empty
};

/// Fills the model database in the background, between uploads. What was imported stays, whenever it is stopped.
class LibraryFill {
public:
    /// `imports` outlives this and has ended, or stops, when this is destroyed; `broadcast` gets events for all
    /// clients.
    LibraryFill(FillOptions options, std::filesystem::path database, std::filesystem::path taxonomy_folder,
                ImportRequests& imports, std::function<void(std::string)> broadcast);
    ~LibraryFill();
    void start();

    /// The last `import` event; null where nothing is, or was, to be filled. Thread-safe.
    [[nodiscard]] nlohmann::json state() const;

private:
    void read_list();
    void take_lines(std::string& text);
    void wake();
    bool work();
    bool wants_others();
    catalog::ImportOptions import_options();
    void tell(const FillProgress& progress);
    void write_mark();

    FillOptions options_;
    std::filesystem::path database_, taxonomy_folder_;
    ImportRequests& imports_;
    std::function<void(std::string)> broadcast_;

    mutable std::mutex mutex_;                       ///< guards these four and `told_`
    std::vector<std::filesystem::path> catalogues_;  ///< all so far
    std::vector<std::string> notes_;
    bool list_ended_ = false, working_ = false;
    std::optional<FillProgress> told_;

    // Of the import thread.
    RemainingTime time_;
    std::set<std::string> wanted_;  ///< what the import in hand goes by
    std::chrono::steady_clock::time_point next_tell_{};
    std::optional<std::int64_t> models_before_;

    std::thread reader_;
};

}  // namespace embody::server
