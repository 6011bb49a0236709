// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace embody {

// Folders with the tests' files. Only folders.cpp contains these paths, so that a compiler cache serves all other tests
// in other folders with the same sources.

/// The project's folder.
std::filesystem::path source_folder();
/// The build folder.
std::filesystem::path build_folder();

}  // namespace embody
