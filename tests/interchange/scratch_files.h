// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <zip.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace embody::test {

/// A folder for the running test, removed at its end.
class ScratchFolder {
public:
    ScratchFolder() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() /
                ("embody-" + std::string(info->name()) + "-" + std::to_string(getpid()));
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Writes a file and its folders; returns its path.
    std::filesystem::path write(const std::string& name, const std::string& content) const {
        const auto file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << content;
        return file;
    }
    /// Writes a zip archive of these names and contents, deflated.
    std::filesystem::path write_zip(const std::string& name,
                                    const std::vector<std::pair<std::string, std::string>>& members) const {
        const auto file = path_ / name;
        zipFile zip = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
        for (const auto& [member, content] : members) {
            zipOpenNewFileInZip(zip, member.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, 8, 6);
            zipWriteInFileInZip(zip, content.data(), static_cast<unsigned>(content.size()));
            zipCloseFileInZip(zip);
        }
        zipClose(zip, nullptr);
        return file;
    }

private:
    std::filesystem::path path_;
};

/// A unit cube around the origin, as an OBJ with quads; `extra` goes before the faces.
inline std::string cube_obj(const std::string& extra = {}) {
    return "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\nv -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 .5\nv -.5 .5 "
           ".5\n" +
           extra + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";
}

}  // namespace embody::test
