// SPDX-License-Identifier: MIT
#include "interchange/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace embody::interchange {
namespace {

/// A descriptor of `file`, or -1 with errno. Folder by folder, each refused where it is a link: openat2() could do it
/// in one call, but system call filters cannot look into its arguments (see catalog/prepare/confinement.cpp).
int open_without_links(const std::filesystem::path& file) {
    int folder = open(file.is_absolute() ? "/" : ".", O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (const std::filesystem::path& part : file.parent_path().relative_path()) {
        if (folder < 0) break;
        const int next = openat(folder, part.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        const int problem = errno;
        close(folder);
        errno = problem;
        folder = next;
    }
    if (folder < 0) return -1;
    // Does not wait: a pipe without a writer would block the caller for ever.
    const int opened =
        openat(folder, file.filename().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    const int problem = errno;
    close(folder);
    errno = problem;
    return opened;
}

}  // namespace

Result<RegularFile> RegularFile::open(const std::filesystem::path& file, std::uint64_t limit) {
    RegularFile opened(open_without_links(file), 0, file);
    if (opened.descriptor_ < 0) {
        const bool is_link = errno == ELOOP;
        return Error{file.string(), is_link ? "is a symbolic link" : std::string("cannot be read: ") + strerror(errno)};
    }
    struct stat status {};
    if (fstat(opened.descriptor_, &status) != 0) {
        return Error{file.string(), std::string("cannot be read: ") + strerror(errno)};
    }
    if (!S_ISREG(status.st_mode)) return Error{file.string(), "is no regular file"};
    opened.size_ = static_cast<std::uint64_t>(status.st_size);
    if (opened.size_ > limit) {
        return Error{file.string(), "is larger than the limit of " + in_binary_units(limit), "split or simplify it"};
    }
    return opened;
}

RegularFile::~RegularFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

Result<std::size_t> RegularFile::read(std::span<std::uint8_t> block) {
    std::size_t filled = 0;
    while (filled < block.size()) {
        const ssize_t got = ::read(descriptor_, block.data() + filled, block.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return Error{path_.string(), std::string("cannot be read: ") + strerror(errno)};
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
    }
    return filled;
}

Result<std::vector<std::uint8_t>> RegularFile::read_all() {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size_));
    const auto got = read(bytes);
    if (!got) return got.error();
    if (*got != bytes.size()) return Error{path_.string(), "became shorter while it was read"};
    return bytes;
}

std::string in_binary_units(std::uint64_t bytes) {
    constexpr std::array<const char*, 5> units{"bytes", "KiB", "MiB", "GiB", "TiB"};
    std::size_t unit = 0;
    while (bytes >= 1024 && unit + 1 < units.size()) {
        bytes /= 1024;
        ++unit;
    }
    return std::to_string(bytes) + " " + units[unit];
}

}  // namespace embody::interchange
