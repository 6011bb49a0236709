// SPDX-License-Identifier: MIT
#include "folders.h"

namespace embody {

std::filesystem::path source_folder() { return EMBODY_SOURCE_DIR; }
std::filesystem::path build_folder() { return EMBODY_BINARY_DIR; }

}  // namespace embody
