// SPDX-License-Identifier: MIT
#include "server/upload_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace embody::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "in-use";

/// Locks the folder; the system releases the lock when the process ends. -1: another process has it, or there is no
/// lock file and `flags` do not create one.
int lock_folder(const fs::path& folder, int flags) {
    const int lock = open((folder / lock_name).c_str(), O_RDWR | O_CLOEXEC | flags, 0600);
    if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
    if (lock >= 0) close(lock);
    return -1;
}

/// Removes folders of processes that ended without removing them; a folder without a lock file is not ours.
void remove_abandoned(const fs::path& folder_of_all) {
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_of_all, problem)) {
        const int lock = lock_folder(entry.path(), 0);
        if (lock < 0) continue;
        std::error_code ignored;
        fs::remove_all(entry.path(), ignored);
        close(lock);
    }
}

Error cannot_be_kept(const std::string& what, int reason) {
    return {what, std::string("cannot be kept for the import: ") + std::strerror(reason),
            reason == ENOSPC || reason == EDQUOT ? "make room on the disk" : ""};
}

}  // namespace

Result<std::shared_ptr<UploadStore>> UploadStore::open(const fs::path& folder_of_all) {
    std::error_code problem;
    fs::create_directories(folder_of_all, problem);
    if (problem) return Error{folder_of_all.string(), "can't be made: " + problem.message(), ""};
    remove_abandoned(folder_of_all);
    std::string folder = (folder_of_all / "XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return cannot_be_kept(folder_of_all.string(), errno);
    const int lock = lock_folder(folder, O_CREAT);
    if (lock < 0) return cannot_be_kept(folder, errno);
    return std::shared_ptr<UploadStore>(new UploadStore(folder, lock));
}

UploadStore::~UploadStore() {
    remove_all();
    close(lock_);
}

void UploadStore::remove_all() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove(folder_.parent_path(), ignored);  // succeeds where no other process has uploads
}

Result<std::shared_ptr<Upload>> UploadStore::begin(const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (uploads_.size() >= most_uploads)
        return Error{name, std::to_string(most_uploads) + " other files are being uploaded or imported",
                     "try again when one of them is done"};
    const fs::path folder = folder_ / std::to_string(next_++);
    std::error_code problem;
    if (!fs::create_directory(folder, problem)) return cannot_be_kept(name, problem.value());
    const fs::path file = folder / name;
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0) {
        const int reason = errno;
        fs::remove(folder, problem);
        return cannot_be_kept(name, reason);
    }
    uploads_.insert(folder);
    return std::shared_ptr<Upload>(new Upload(shared_from_this(), file, descriptor));
}

void UploadStore::forget(const fs::path& upload_folder) {
    std::error_code ignored;
    fs::remove_all(upload_folder, ignored);
    const std::lock_guard lock(mutex_);
    uploads_.erase(upload_folder);
}

Upload::~Upload() {
    if (descriptor_ >= 0) close(descriptor_);
    store_->forget(file_.parent_path());
}

Result<void> Upload::write(std::span<const char> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return cannot_be_kept(file_.filename().string(), errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Result<void> Upload::finish() {
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) return cannot_be_kept(file_.filename().string(), errno);
    return {};
}

}  // namespace embody::server
