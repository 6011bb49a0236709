// SPDX-License-Identifier: MIT
#include "scene/session/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string_view>
#include <utility>

#include "foundation/state_hash.h"
#include "scene/document/history.h"
#include "scene/file/json/change_json.h"
#include "scene/file/scene_file.h"
#include "scene/file/whole_file.h"
#include "scene/session/file_names.h"

namespace embody::scene {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* extension = ".journal";
constexpr int format_version = 1;
constexpr std::size_t kept_recoveries = 50;
/// The document is written anew once the lines behind it are larger than it and than this, bytes: reading stays short,
/// and writing at most doubles.
constexpr std::size_t min_lines_size = std::size_t{1} << 20;
constexpr auto sync_period = std::chrono::seconds(1);
constexpr std::size_t checksum_digits = 16;

// A line: the checksum of the text behind it, and the text, which has no line break in it.
std::string line_of(const json& value) {
    const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    StateHash hash;
    hash.add_bytes(text.data(), text.size());
    char digits[checksum_digits];
    const std::to_chars_result end = std::to_chars(digits, digits + checksum_digits, hash.value(), 16);
    std::string line(digits, end.ptr);
    line.insert(0, checksum_digits - line.size(), '0');
    return line + " " + text + "\n";
}

// The value of a line; empty where it is not whole.
std::optional<json> value_of(const std::string& line) {
    if (line.size() <= checksum_digits + 1) return std::nullopt;
    const std::string_view text = std::string_view(line).substr(checksum_digits + 1);
    StateHash hash;
    hash.add_bytes(text.data(), text.size());
    std::uint64_t told = 0;
    const std::from_chars_result read = std::from_chars(line.data(), line.data() + checksum_digits, told, 16);
    if (read.ptr != line.data() + checksum_digits || told != hash.value()) return std::nullopt;
    json value = json::parse(text, nullptr, false);
    if (value.is_discarded()) return std::nullopt;
    return value;
}

bool write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

Error can_not_write(const fs::path& file) {
    return Error{file.string(), std::string("edits can't be kept: ") + std::strerror(errno), "save the scene"};
}

// Whether a running program holds the journal.
bool is_held(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return true;
    const bool is_free = flock(descriptor, LOCK_SH | LOCK_NB) == 0;
    close(descriptor);
    return !is_free;
}

std::optional<json> head_of(std::istream& in) {
    std::string line;
    if (!std::getline(in, line)) return std::nullopt;
    std::optional<json> head = value_of(line);
    if (!head || !head->is_object() || !head->contains("embody_journal") ||
        (*head)["embody_journal"] != format_version || !head->contains("edits") ||
        !(*head)["edits"].is_number_unsigned())
        return std::nullopt;
    for (const char* field : {"scene", "title", "started"})
        if (!head->contains(field) || !(*head)[field].is_string()) return std::nullopt;
    return head;
}

std::vector<fs::path> journals_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem))
        // Only regular files: a pipe of that name would never be read to its end.
        if (std::error_code unreadable; entry->path().extension() == extension &&
                                        entry->symlink_status(unreadable).type() == fs::file_type::regular)
            files.push_back(entry->path());
    return files;
}

// Keeps the newest. By the times of the files: reading them would take long.
void remove_oldest(const fs::path& folder) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::error_code ignored;
    for (const fs::path& file : journals_in(folder)) files.emplace_back(fs::last_write_time(file, ignored), file);
    if (files.size() <= kept_recoveries) return;
    std::sort(files.begin(), files.end(), std::greater<>());
    for (std::size_t i = kept_recoveries; i < files.size(); ++i)
        if (!is_held(files[i].second)) fs::remove(files[i].second, ignored);
}

// A name that no other file has, nor one that another program makes in the same second.
fs::path free_file(const fs::path& folder, const std::string& name, std::string time) {
    std::erase(time, ':');
    char digits[8];
    const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, std::random_device()(), 16);
    return folder / (shortened_stem(name) + " " + time + " " + std::string(digits, end.ptr) + extension);
}

// Applies the edit of a line; false where it is none.
bool apply_edit(Document& document, const json& edit) {
    if (!edit.is_object() || !edit.contains("changes") || !edit.contains("next_index")) return false;
    const json& next = edit["next_index"];
    if (!next.is_number_unsigned() || !apply_changes(document, edit["changes"]).ok()) return false;
    document.next_index = next.get<EntityIndex>();
    return true;
}

}  // namespace

// Writing
// ----------------------------------------------------------------------------------------------------------------

Result<std::unique_ptr<Journal>> Journal::begin(const fs::path& folder, const std::string& scene,
                                                const Document& document) {
    remove_oldest(folder);
    std::unique_ptr<Journal> journal(new Journal);
    journal->scene_ = scene;
    journal->started_ = utc_text(std::chrono::system_clock::now());
    journal->file_ = free_file(folder, scene.empty() ? document.title : scene, journal->started_);
    // Nothing is lost by a power cut before the first sync but the last second.
    if (Result<void> written = journal->write_anew(document, false); !written.ok()) return written.error();
    journal->syncing_ = std::thread([&self = *journal] { self.sync_each_second(); });
    return journal;
}

Journal::~Journal() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    if (syncing_.joinable()) syncing_.join();
    if (descriptor_ >= 0) close(descriptor_);
}

// The head and the whole document.
std::string Journal::whole_text(const Document& document) const {
    const json head = {{"embody_journal", format_version},
                       {"scene", scene_},
                       {"title", document.title},
                       {"started", started_},
                       {"edits", edits_}};
    return line_of(head) + line_of({{"document", document_to_json(document)}});
}

// Goes on in the file as it is in its folder now. The caller has locked the mutex.
bool Journal::take_file(std::size_t whole_size, std::size_t lines_size) {
    const int opened = open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (opened < 0) return false;
    // A file system without locks: another program may offer the journal as a recovery while this one runs.
    (void)flock(opened, LOCK_EX | LOCK_NB);
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = opened;
    whole_size_ = whole_size;
    lines_size_ = lines_size;
    is_torn_ = false;
    is_dirty_ = folder_is_dirty_ = true;
    return true;
}

// In place of what was there.
Result<void> Journal::write_anew(const Document& document, bool is_synced) {
    {
        const std::lock_guard lock(mutex_);
        ++renewals_;
        whole_.reset();
        is_renewed_ = false;
    }
    const std::string text = whole_text(document);
    {
        Result<WholeFileDraft> draft = WholeFileDraft::write(file_, text, is_synced);
        if (!draft.ok()) return draft.error();
        if (Result<void> placed = draft.value().put_in_place(); !placed.ok()) return placed;
    }
    {
        const std::lock_guard lock(mutex_);
        if (!take_file(text.size(), 0)) return can_not_write(file_);
    }
    changed_.notify_all();
    return {};
}

Result<void> Journal::add(const json& changes, const Document& document) {
    ++edits_;
    const std::string line = line_of({{"changes", changes}, {"next_index", document.next_index}});
    std::unique_lock lock(mutex_);
    if (is_torn_) {
        // Behind a line that was written in part no other could be read.
        lock.unlock();
        return write_anew(document, true);
    }
    is_torn_ = !write_all(descriptor_, line);
    if (is_torn_) return can_not_write(file_);
    lines_size_ += line.size();
    is_dirty_ = true;
    if (is_renewed_) {
        lines_since_ += line;
    } else if (lines_size_ > std::max(whole_size_, min_lines_size)) {
        whole_ = whole_text(document);
        is_renewed_ = true;
        lines_since_.clear();
        ++renewals_;
    }
    lock.unlock();
    changed_.notify_all();
    return {};
}

// Writes the document anew, for which no edit waits: what is edited meanwhile goes into the file that is there, and
// then behind the document.
void Journal::renew(std::unique_lock<std::mutex>& lock) {
    const std::string text = std::move(*whole_);
    whole_.reset();
    const std::uint64_t number = renewals_;
    lock.unlock();
    {
        Result<WholeFileDraft> draft = WholeFileDraft::write(file_, text);
        lock.lock();
        if (number != renewals_ || ends_) return;
        is_renewed_ = false;
        // Where that fails the file that is there goes on.
        if (!draft.ok() || !draft.value().put_in_place(lines_since_).ok()) return;
    }
    if (!take_file(text.size(), lines_since_.size())) is_torn_ = true;
    lines_since_ = {};
}

// Syncing takes milliseconds to seconds, for which no edit waits.
void Journal::sync_each_second() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ends_ || is_dirty_ || whole_; });
        if (whole_ && !ends_) renew(lock);
        if (is_dirty_) {
            is_dirty_ = false;
            const bool has_new_file = std::exchange(folder_is_dirty_, false);
            const int copy = dup(descriptor_);
            lock.unlock();
            if (copy >= 0) {
                (void)fdatasync(copy);
                close(copy);
            }
            if (has_new_file) sync_folder(file_.parent_path());
            lock.lock();
        }
        if (changed_.wait_for(lock, sync_period, [this] { return ends_; })) return;
    }
}

void Journal::remove() {
    const std::lock_guard lock(mutex_);
    ++renewals_;
    whole_.reset();
    std::error_code ignored;
    fs::remove(file_, ignored);
}

// Reading
// ----------------------------------------------------------------------------------------------------------------

std::vector<Recovery> list_recoveries(const fs::path& folder) {
    std::vector<Recovery> found;
    for (const fs::path& file : journals_in(folder)) {
        std::ifstream in(file, std::ios::binary);
        const std::optional<json> head = head_of(in);
        if (!head || is_held(file)) continue;
        std::error_code ignored;
        Recovery recovery{file, (*head)["scene"], (*head)["title"], utc_text(fs::last_write_time(file, ignored)),
                          (*head)["edits"].get<std::size_t>()};
        std::string line;
        std::getline(in, line);  // the document
        while (std::getline(in, line) && !in.eof()) ++recovery.edits;
        found.push_back(std::move(recovery));
    }
    std::sort(found.begin(), found.end(), [](const Recovery& a, const Recovery& b) {
        return a.modified != b.modified ? a.modified > b.modified : a.file > b.file;
    });
    return found;
}

Result<Recovered> read_journal(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::optional<json> head = head_of(in);
    if (!head) return Error{file.string(), "is no journal of this version of Embody"};
    std::string line;
    const std::optional<json> whole = std::getline(in, line) ? value_of(line) : std::nullopt;
    if (!whole || !whole->is_object() || !whole->contains("document"))
        return Error{file.string(), "ends before its document does"};
    Result<Document> document = document_from_json((*whole)["document"]);
    if (!document.ok())
        return Error{file.string() + ": " + document.error().where, document.error().why, document.error().remedy};
    Recovered recovered{std::move(document).value(), (*head)["scene"]};

    // Each line is all the changes of an edit. Behind one that is not whole nothing can be trusted.
    while (std::getline(in, line)) {
        const std::optional<json> edit = value_of(line);
        if (!edit || !apply_edit(recovered.document, *edit)) break;
    }
    // A kill in the middle of the last line lost an edit that nobody was told of.
    while (std::getline(in, line)) ++recovered.lost;
    return recovered;
}

}  // namespace embody::scene
