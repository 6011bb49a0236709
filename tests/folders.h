// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace embody {

// Where tests find files. Only folders.cpp knows these paths when it is compiled, so that other folders with the same
// sources share what a compiler cache has of all other tests.

/// The project's folder.
std::filesystem::path source_folder();
/// The folder that it is built in.
std::filesystem::path build_folder();

}  // namespace embody
