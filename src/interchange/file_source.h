// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "interchange/archive/archive.h"

namespace embody::interchange {

/// The source of a model file and of the files that it refers to (materials, buffers, textures): one folder or one
/// archive.
/// Nothing outside it can be reached: not by "..", not by an absolute path, not by a link in the folder.
class FileSource {
public:
    virtual ~FileSource() = default;
    /// The stored path of `path`, which may differ in case; empty where there is no such file inside the source.
    [[nodiscard]] virtual std::string find(std::string_view path) const = 0;
    /// The bytes of a file that find() returned, at most 512 MiB.
    [[nodiscard]] virtual Result<std::vector<std::uint8_t>> read(std::string_view path) const = 0;
    /// The whole place for people, e.g. "models.sh3f: chair/chair.obj".
    [[nodiscard]] virtual std::string describe(std::string_view path) const = 0;
};

class FolderSource final : public FileSource {
public:
    explicit FolderSource(std::filesystem::path folder);
    [[nodiscard]] std::string find(std::string_view path) const override;
    [[nodiscard]] Result<std::vector<std::uint8_t>> read(std::string_view path) const override;
    [[nodiscard]] std::string describe(std::string_view path) const override;

private:
    std::filesystem::path folder_;  // canonical, so that links can be detected
};

class ArchiveSource final : public FileSource {
public:
    ArchiveSource(const Archive& archive, std::string name) : archive_(&archive), name_(std::move(name)) {}
    [[nodiscard]] std::string find(std::string_view path) const override { return archive_->find(path); }
    [[nodiscard]] Result<std::vector<std::uint8_t>> read(std::string_view path) const override {
        return archive_->read(path);
    }
    [[nodiscard]] std::string describe(std::string_view path) const override {
        return name_ + ": " + std::string(path);
    }

private:
    const Archive* archive_;
    std::string name_;
};

}  // namespace embody::interchange
