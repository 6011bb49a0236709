// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "attributes/model_facts.h"
#include "catalog/prepare/convex_parts.h"
#include "foundation/result.h"
#include "interchange/sweethome/sweethome_catalogue.h"

namespace embody::catalog {

/// One model to import: where its file is and what the catalogue that it came from says about it.
struct ImportItem {
    std::string key;        ///< stable name of the model, e.g. "sweethome3d:Blend Swap CC-0#armchair" or "file:<hash>"
    std::string archive;    ///< path of the .sh3f, .jar or .zip that holds the file; empty: a plain file
    std::string path;       ///< of the model file, inside the archive or on disk
    std::string icon_path;  ///< of a ready thumbnail inside the archive; may be empty
    std::string name, source, licence, author, category;
    std::vector<std::string> tags;
    std::string stated_thing;  ///< word of the taxonomy for what its collection says that it is; may be empty
    std::optional<std::array<double, 3>> stated_size;  ///< width X, height Y, depth Z, m
    std::optional<double> stated_unit;                 ///< m a unit of the file, where its collection states it
    std::array<double, 9> stated_rotation{1, 0, 0, 0, 1,
                                          0, 0, 0, 1};  ///< rows; the catalogue's correction of the file's axes
    std::vector<interchange::Recolor> recolors;         ///< of the place that it comes from
    std::optional<bool> movable;
    bool door_or_window = false;
    bool light_source = false;  ///< what shines may have no shape; not sent to the worker
};

/// A model ready for the database: everything that needs the file, computed by a confined worker.
struct PreparedModel {
    std::vector<std::uint8_t> geometry;   ///< compact geometry, versioned; see interchange/compact/compact_geometry.h
    std::vector<std::uint8_t> thumbnail;  ///< PNG, 256 × 256
    std::vector<Vec3f> hull_points;       ///< at most 256, model frame
    ConvexParts convex_parts;             ///< no hulls where the hull of all is enough, or nothing moves it
    attributes::ModelFacts facts;
    std::uint64_t content_hash = 0;  ///< of the model file's bytes
    std::uint32_t vertices = 0, triangles = 0, parts = 0, materials = 0, images = 0;
    int quality = 0;  ///< 0 broken … 3 precise; see catalog/prepare/quality.h
    std::vector<std::string> warnings;
};

}  // namespace embody::catalog
