// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

struct ArchiveMember {
    std::string path;        ///< with '/', relative, without "." and ".."; UTF-8, whatever the archive stores
    std::uint64_t size = 0;  ///< unpacked, as the archive states it, bytes
};

/// A zip file (.zip, .sh3f, .jar) opened for reading members in any order. Members whose names would leave the archive
/// ("../x", "C:\x") are not listed and cannot be read.
class Archive {
public:
    /// Reads the list of members of the file at this canonical path, nothing else. Refuses files that are no zip or
    /// larger than max_file_bytes, and lists of more than a million members.
    static Result<Archive> open(const std::filesystem::path& file);
    Archive(Archive&&) noexcept;
    Archive& operator=(Archive&&) noexcept;
    ~Archive();

    /// Members in the order of the archive's own list, without folders.
    [[nodiscard]] const std::vector<ArchiveMember>& members() const;
    /// The member's path, found exactly or else without regard to case; empty where there is none. `path` is UTF-8, or
    /// the bytes that an old zip program stored: both are read as the members' names are.
    [[nodiscard]] std::string find(std::string_view path) const;
    /// Unpacks one member. More than `limit` bytes, whatever the archive states, is an error, and nothing is kept.
    Result<std::vector<std::uint8_t>> read(std::string_view path, std::uint64_t limit = default_limit) const;

    static constexpr std::uint64_t default_limit = std::uint64_t{512} << 20;  ///< bytes unpacked
    static constexpr std::uint64_t max_file_bytes = std::uint64_t{16} << 30;  ///< bytes packed

private:
    struct State;
    explicit Archive(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// `path` with '/' only and "." and ".." resolved; empty where it is absolute on a drive, or leaves its root, or is
/// empty. A leading '/' is dropped: catalogues write "/folder/model.obj" for a path from the archive's root.
std::string normalized_member_path(std::string_view path);

}  // namespace embody::interchange
