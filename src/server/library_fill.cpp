// SPDX-License-Identifier: MIT
#include "server/library_fill.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace embody::server {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr auto tell_period = std::chrono::milliseconds(500);
/// The list's reader looks so often whether the server ends, ms.
constexpr int list_period = 200;
/// An event names at most this many failures.
constexpr std::size_t max_told_failures = 50;

const char* name_of(FillState state) {
    return state == FillState::running ? "running" : state == FillState::done ? "done" : "stopped";
}

}  // namespace

json fill_json(const FillProgress& progress) {
    json failures = json::array();
    for (const catalog::ImportFailure& failure : progress.failures) {
        if (failures.size() == max_told_failures) break;
        failures.push_back({{"path", fs::path(failure.path).filename().string()}, {"why", failure.error.why}});
    }
    return {{"event", "import"},
            {"state", name_of(progress.state)},
            {"done", progress.done},
            {"total", progress.total},
            {"seconds_left", progress.seconds_left ? json(std::ceil(*progress.seconds_left)) : json(nullptr)},
            {"file", progress.file},
            {"added", progress.added},
            {"skipped", progress.shapeless},
            {"failures", std::move(failures)},
            {"notes", progress.notes}};
}

LibraryFill::LibraryFill(FillOptions options, fs::path database, fs::path taxonomy_folder, ImportRequests& imports,
                         std::function<void(std::string)> broadcast)
    : options_(std::move(options)),
      database_(std::move(database)),
      taxonomy_folder_(std::move(taxonomy_folder)),
      imports_(imports),
      broadcast_(std::move(broadcast)),
      catalogues_(options_.catalogues),
      list_ended_(options_.list.empty()) {
    if (!catalogues_.empty() || !list_ended_) told_ = FillProgress{};
}

void LibraryFill::start() {
    if (!options_.catalogues.empty()) wake();
    if (!list_ended_) reader_ = std::thread([this] { read_list(); });
}

LibraryFill::~LibraryFill() {
    if (reader_.joinable()) reader_.join();
}

json LibraryFill::state() const {
    const std::lock_guard lock(mutex_);
    return told_ ? fill_json(*told_) : json(nullptr);
}

// On a thread of its own, because the list may be the output of a program that is still downloading.
void LibraryFill::read_list() {
    // A pipe whose writer has not come yet must not stop the opening.
    const int file = open(options_.list.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    std::string text;
    bool ended = file < 0;
    while (!ended && !imports_.stops()) {
        pollfd wanted{file, POLLIN, 0};
        if (poll(&wanted, 1, list_period) <= 0) continue;
        std::array<char, 4096> bytes{};
        const ssize_t size = read(file, bytes.data(), bytes.size());
        if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        ended = size <= 0;
        text.append(bytes.data(), ended ? 0 : static_cast<std::size_t>(size));
        if (ended && !text.empty()) text += '\n';
        take_lines(text);
    }
    {
        const std::lock_guard lock(mutex_);
        list_ended_ = true;
        if (file < 0) notes_.push_back("The list of catalogues cannot be read: " + options_.list.string());
    }
    if (file >= 0) close(file);
    wake();
}

void LibraryFill::take_lines(std::string& text) {
    bool has_catalogue = false;
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
            const std::string line = text.substr(0, end);
            text.erase(0, end + 1);
            if (line.starts_with("# ")) {
                notes_.push_back(line.substr(2));
            } else if (!line.empty()) {
                catalogues_.emplace_back(line);
                has_catalogue = true;
            }
        }
    }
    if (has_catalogue) wake();
}

void LibraryFill::wake() {
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(working_, true)) return;
    }
    imports_.run_between_uploads([this] {
        try {
            return work();
        } catch (const std::exception& thrown) {
            FillProgress failed;
            failed.state = FillState::stopped;
            failed.notes = {std::string("The library could not be filled: ") + thrown.what()};
            tell(failed);
            return false;
        }
    });
}

// Imports all catalogues so far; what is in the database already costs little. Returns whether it is to be called
// again.
bool LibraryFill::work() {
    std::vector<fs::path> catalogues;
    bool is_whole = false;
    FillProgress result;
    {
        const std::lock_guard lock(mutex_);
        catalogues = catalogues_;
        is_whole = list_ended_;
        result.notes = notes_;
    }
    auto catalog = catalog::Catalog::open(database_, taxonomy_folder_);
    if (!catalog) throw std::runtime_error(catalog.error().message());
    if (!models_before_) models_before_ = (*catalog)->model_count();
    time_.pause();
    catalog::ImportReport report;
    if (!catalogues.empty()) {
        auto imported = (*catalog)->import(catalogues, import_options());
        if (!imported) throw std::runtime_error(imported.error().message());
        report = std::move(*imported);
    }
    if (report.stopped && !imports_.stops()) return true;
    const std::int64_t added = (*catalog)->model_count() - *models_before_;
    result.added = static_cast<std::size_t>(std::max<std::int64_t>(added, 0));
    result.shapeless = report.shapeless;
    result.done = result.total =
        report.added + report.updated + report.unchanged + report.shapeless + report.failures.size();
    result.failures = std::move(report.failures);
    result.state = report.stopped ? FillState::stopped : FillState::running;
    {
        const std::lock_guard lock(mutex_);
        if (!report.stopped && (catalogues_.size() > catalogues.size() || list_ended_ != is_whole)) return true;
        working_ = false;
    }
    if (is_whole && !report.stopped) {
        result.state = FillState::done;
        if (result.notes.empty()) write_mark();
    }
    tell(result);
    return false;
}

catalog::ImportOptions LibraryFill::import_options() {
    catalog::ImportOptions options;
    options.in_background = true;
    if (options_.wanted) wanted_ = options_.wanted();
    options.wanted = wanted_;
    options.progress = [this](const catalog::ImportProgress& made) {
        const Clock::time_point now = Clock::now();
        if (imports_.must_give_way()) return false;
        if (now < next_tell_) return true;
        next_tell_ = now + tell_period;
        if (made.total > 0) time_.note(made.done, made.unchanged, now);
        FillProgress progress;
        progress.done = made.done;
        progress.total = made.total;
        progress.added = made.done - std::min(made.done, made.unchanged + made.failed);
        progress.file = made.current;
        if (made.total > 0) progress.seconds_left = time_.seconds(made.total - std::min(made.done, made.total));
        {
            const std::lock_guard lock(mutex_);
            progress.notes = notes_;
            // While it looks for files once more, the numbers of before are the better ones.
            if (made.total == 0 && told_)
                std::tie(progress.done, progress.total, progress.added) =
                    std::tie(told_->done, told_->total, told_->added);
        }
        tell(progress);
        return !wants_others();
    };
    return options;
}

// Another scene may have been opened: the import begins again, in another order, and finds what is done.
bool LibraryFill::wants_others() {
    if (!options_.wanted) return false;
    const std::set<std::string> now = options_.wanted();
    return !std::includes(wanted_.begin(), wanted_.end(), now.begin(), now.end());
}

void LibraryFill::tell(const FillProgress& progress) {
    {
        const std::lock_guard lock(mutex_);
        told_ = progress;
    }
    broadcast_(fill_json(progress).dump(-1, ' ', false, json::error_handler_t::replace));
    if (options_.tell) options_.tell(progress);
}

// A failure costs the next start the time to look through the catalogues once more.
void LibraryFill::write_mark() {
    if (options_.mark.empty()) return;
    std::ofstream mark(options_.mark);
    mark << "All catalogues of the first start are in the database beside this file.\n";
}

}  // namespace embody::server
