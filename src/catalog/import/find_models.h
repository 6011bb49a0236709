// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

/// A model that was found, before its file was read.
struct FoundModel {
    ImportItem item;             ///< a plain file's key is still empty: it comes from the content
    std::filesystem::path file;  ///< on disk, canonical: the model's own, or its archive's
    std::string location;        ///< canonical path, or archive!entry; the same however the path was typed
};

struct FoundModels {
    std::vector<FoundModel> models;       ///< folders in the order of their file names
    std::vector<ImportFailure> failures;  ///< paths that hold nothing to import, and why
};

/// Of models and of the archives that they come in: ".glb .gltf … .zip".
std::string readable_extensions();

/// Walks files, folders and catalogues; without paths, the folders of the collection. Reads the lists of archives, but
/// no model. A file of the collection's extensions has its unit, axes, licence and author; below a folder of the
/// collection also a key of its own, e.g. "kicad:Relay_THT.3dshapes/Relay_SPDT.wrl", the first folder's name as its
/// category, and what the collection says that files in this place are. In folders other files are left alone then.
/// Links in folders are followed to files in the same folder, or in those of the collection; one that leads elsewhere
/// is a failure, links to folders are not followed. `go_on` is asked again and again; false ends the search.
FoundModels find_models(const std::vector<std::filesystem::path>& paths,
                        const std::optional<Collection>& collection = {}, const std::function<bool()>& go_on = {});

}  // namespace embody::catalog
