// SPDX-License-Identifier: MIT
#include "scene/file/whole_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace embody::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view draft_suffix = ".embody-draft";
/// Maximum number of names tried for one draft: a name is taken only by a draft of a killed program or of another
/// computer.
constexpr int draft_attempts = 100;

// A file descriptor that closes itself.
struct Descriptor {
    int number = -1;
    explicit Descriptor(int opened) : number(opened) {}
    Descriptor(Descriptor&& other) noexcept : number(std::exchange(other.number, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

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
    return Error{file.string(), std::string("can't be written: ") + std::strerror(errno),
                 "the file that was there is unchanged"};
}

/// The permission bits of the file, none where there is no file. A rename over a device or a pipe would take it away.
Result<std::optional<mode_t>> mode_of(const fs::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return std::optional<mode_t>();
    if (!S_ISREG(status.st_mode))
        return Error{file.string(), "is a folder or a device, not a file", "name another file"};
    return std::optional<mode_t>(status.st_mode & 07777);
}

/// Whether the open file is still in its folder.
bool has_a_name(int descriptor) {
    struct stat status {};
    return fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

struct Draft {
    std::string name;
    Descriptor out;  ///< locked for as long as it is open, which tells others that the draft is in use
};

/// A new, empty, locked draft beside `file`. It is never readable by more people than the file will be. On failure
/// errno says why.
std::optional<Draft> open_draft(const fs::path& file, mode_t mode) {
    static std::atomic<unsigned> drafts{0};
    for (int attempt = 0; attempt < draft_attempts; ++attempt) {
        std::string name = file.string() + "." + std::to_string(getpid()) + "-" + std::to_string(++drafts);
        name += draft_suffix;
        Descriptor out(open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
        if (out.number < 0 && errno == EEXIST) continue;
        if (out.number < 0) return std::nullopt;
        // A file system without locks never has abandoned drafts removed. Another program may have taken the draft for
        // an abandoned one before it was locked; then the next name is tried.
        if (flock(out.number, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) continue;
        if (!has_a_name(out.number)) continue;
        return Draft{std::move(name), std::move(out)};
    }
    errno = EEXIST;
    return std::nullopt;
}

void remove_if_abandoned(const fs::path& draft) {
    const Descriptor opened(open(draft.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (opened.number < 0 || flock(opened.number, LOCK_EX | LOCK_NB) != 0) return;
    // If its writer renamed it meanwhile, no file has that name.
    unlink(draft.c_str());
}

}  // namespace

Result<WholeFileDraft> WholeFileDraft::write(const fs::path& file, std::string_view text, bool is_synced) {
    std::error_code problem;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    fs::create_directories(folder, problem);
    if (problem) return Error{folder.string(), "can't be made: " + problem.message()};
    remove_abandoned_drafts(folder);

    // The draft is in the file's folder: a rename across disks would not be atomic. It stays locked until it is
    // renamed.
    const auto found_mode = mode_of(file);
    if (!found_mode) return found_mode.error();
    const std::optional<mode_t> kept_mode = *found_mode;
    std::optional<Draft> opened = open_draft(file, kept_mode ? 0600 : 0666);
    if (!opened) return can_not_write(file);
    WholeFileDraft draft;
    draft.file_ = file;
    draft.name_ = std::move(opened->name);
    draft.descriptor_ = std::exchange(opened->out.number, -1);
    const int out = draft.descriptor_;
    if (!write_all(out, text) || (kept_mode && fchmod(out, *kept_mode) != 0) || (is_synced && fsync(out) != 0))
        return can_not_write(file);
    return draft;
}

WholeFileDraft::WholeFileDraft(WholeFileDraft&& other) noexcept
    : file_(std::move(other.file_)),
      name_(std::exchange(other.name_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

WholeFileDraft::~WholeFileDraft() {
    if (!name_.empty()) unlink(name_.c_str());
    if (descriptor_ >= 0) close(descriptor_);
}

Result<void> WholeFileDraft::put_in_place(std::string_view more) {
    if (!write_all(descriptor_, more) || rename(name_.c_str(), file_.c_str()) != 0) return can_not_write(file_);
    name_.clear();
    return {};
}

void sync_folder(const fs::path& folder) {
    const Descriptor entry(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (entry.number >= 0) fsync(entry.number);
}

Result<void> write_whole_file(const fs::path& file, std::string_view text) {
    Result<WholeFileDraft> draft = WholeFileDraft::write(file, text);
    if (!draft.ok()) return draft.error();
    if (Result<void> placed = draft.value().put_in_place(); !placed.ok()) return placed;
    // The rename changes the folder, which is synced as well.
    sync_folder(file.has_parent_path() ? file.parent_path() : ".");
    return {};
}

void remove_abandoned_drafts(const fs::path& folder) {
    // Listed before the first is removed: a folder that changes while it is read may skip entries.
    std::vector<fs::path> drafts;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        std::error_code unreadable;
        if (entry->path().native().ends_with(draft_suffix) &&
            entry->symlink_status(unreadable).type() == fs::file_type::regular)
            drafts.push_back(entry->path());
    }
    for (const fs::path& draft : drafts) remove_if_abandoned(draft);
}

}  // namespace embody::scene
