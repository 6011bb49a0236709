// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

/// A model that lies somewhere, before anybody looked into its file.
struct FoundModel {
    ImportItem item;             ///< a plain file's key is still empty: it comes from the content
    std::filesystem::path file;  ///< on disk: the model's own, or its archive's
    std::string location;        ///< absolute path, or archive!entry; the same however the path was typed
};

struct FoundModels {
    std::vector<FoundModel> models;       ///< folders in the order of their file names
    std::vector<ImportFailure> failures;  ///< paths that hold nothing to import, and why
};

/// Walks files, folders and catalogues. Reads the lists of archives, but no model.
FoundModels find_models(const std::vector<std::filesystem::path>& paths);

}  // namespace embody::catalog
