// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

/// A file opened for reading that is surely a regular one: no folder, device, pipe or socket. No symbolic link is
/// followed on its path, so that the file found inside a folder is the one opened, whatever happens in between.
class RegularFile {
public:
    /// `file`: canonical path. Refuses files of more than `limit` bytes by name of the limit; never waits for a pipe.
    static Result<RegularFile> open(const std::filesystem::path& file, std::uint64_t limit);
    RegularFile(RegularFile&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_), path_(std::move(other.path_)) {}
    RegularFile& operator=(RegularFile&&) = delete;
    ~RegularFile();

    /// Size when it was opened, bytes.
    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// Fills as much of `block` as is left in the file; 0 at the end.
    Result<std::size_t> read(std::span<std::uint8_t> block);
    /// Reads all from here on, at most size() bytes.
    Result<std::vector<std::uint8_t>> read_all();
    /// Hands the open descriptor over to the caller, who closes it.
    int release() { return std::exchange(descriptor_, -1); }

private:
    RegularFile(int descriptor, std::uint64_t size, std::filesystem::path path)
        : descriptor_(descriptor), size_(size), path_(std::move(path)) {}

    int descriptor_;
    std::uint64_t size_;
    std::filesystem::path path_;
};

/// "512 MiB", "16 GiB": a limit for people, rounded down.
std::string in_binary_units(std::uint64_t bytes);

}  // namespace embody::interchange
