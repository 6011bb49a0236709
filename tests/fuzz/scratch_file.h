// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace embody::fuzz {

/// Folder for the files of one driver's children: in memory where the system has such a folder.
inline std::filesystem::path scratch_folder(pid_t driver) {
    const std::filesystem::path memory = "/dev/shm";
    const auto base = access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
    return base / ("embody-fuzz-" + std::to_string(driver));
}

/// Writes `bytes` to a file of this child; the next call with the name replaces it. The path is canonical.
inline std::filesystem::path scratch_file(const std::string& name, std::span<const std::uint8_t> bytes) {
    static const std::filesystem::path folder = [] {
        const auto made = scratch_folder(getppid());
        std::filesystem::create_directories(made);
        return std::filesystem::canonical(made);
    }();
    const auto file = folder / name;
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

}  // namespace embody::fuzz
