// SPDX-License-Identifier: MIT
#include "scene/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace embody::scene {

namespace {

// A file descriptor that closes itself.
struct Descriptor {
    int number = -1;
    explicit Descriptor(int opened) : number(opened) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
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

Error can_not_write(const std::filesystem::path& file) {
    return Error{file.string(), std::string("can't be written: ") + std::strerror(errno),
                 "the file that was there is unchanged"};
}

}  // namespace

Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text) {
    std::error_code problem;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::filesystem::create_directories(folder, problem);
    if (problem) return Error{folder.string(), "can't be made: " + problem.message()};

    // The new file lies beside the old one: a rename across disks would not be whole. mkstemp opens it for us alone, so
    // the mode is set to what a new file would have.
    std::string draft = file.string() + ".XXXXXX";
    {
        const Descriptor out(mkstemp(draft.data()));
        if (out.number < 0) return can_not_write(file);
        if (!write_all(out.number, text) || fchmod(out.number, 0644) != 0 || fsync(out.number) != 0) {
            const Error error = can_not_write(file);
            unlink(draft.c_str());
            return error;
        }
    }
    if (rename(draft.c_str(), file.c_str()) != 0) {
        const Error error = can_not_write(file);
        unlink(draft.c_str());
        return error;
    }

    // The rename itself is in the folder.
    const Descriptor entry(open(folder.c_str(), O_RDONLY | O_DIRECTORY));
    if (entry.number >= 0) fsync(entry.number);
    return {};
}

}  // namespace embody::scene
