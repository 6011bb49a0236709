// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "catalog/catalog.h"
#include "foundation/result.h"

namespace embody::cli {

/// Folder of taxonomy, demo scenes and schemas: $EMBODY_DATA, or `data` of the source tree that the program was built
/// from.
std::filesystem::path data_folder();
/// The built front-end: $EMBODY_STUDIO, or `studio/dist` of the source tree.
std::filesystem::path studio_folder();
/// Folder of the user's own scenes, next to the default database.
std::filesystem::path saved_scenes_folder();

/// Opens the database with the taxonomy of data_folder().
Result<std::unique_ptr<catalog::Catalog>> open_catalog(const std::filesystem::path& database);

}  // namespace embody::cli
