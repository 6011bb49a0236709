// SPDX-License-Identifier: MIT
#pragma once

#include "interchange/file_source.h"

namespace Assimp {
class IOSystem;
}

namespace embody::interchange {

/// Lets assimp see one FileSource, which must outlive it, and nothing else; nothing can be written. Made for
/// Assimp::Importer::SetIOHandler, which takes ownership.
Assimp::IOSystem* new_source_files(const FileSource& source);

}  // namespace embody::interchange
