// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

/// Another colour for what a model is made of.
struct Recolor {
    std::string material;           ///< of this name in the model; empty: all that light does not pass through
    std::array<double, 3> color{};  ///< linear red, green, blue; takes a texture's place
    auto operator<=>(const Recolor&) const = default;
};

/// One piece of a Sweet Home 3D furniture catalogue, everything in SI units.
struct SweethomePiece {
    std::string id;    ///< e.g. "Blend Swap CC-0#armchair"; unique in its catalogue
    std::string name;  ///< English
    std::vector<std::string> tags;
    std::string category;          ///< e.g. "Bedroom"
    std::string creator;           ///< of the model; may be empty
    std::string model_path;        ///< OBJ inside the archive
    std::string icon_path;         ///< PNG inside the archive; may be empty
    std::array<double, 3> size{};  ///< width X, height Y, depth Z, m; each > 0
    double elevation = 0;          ///< of its base above the floor when new, m
    std::array<double, 9> rotation{1, 0, 0, 0, 1,
                                   0, 0, 0, 1};  ///< rows; turns the file's axes before the size is measured
    std::vector<Recolor> recolors;               ///< of a home, in the order in which they are done
    bool movable = true;
    bool door_or_window = false;
    bool light_source = false;
};

/// A catalogue: a .sh3f library or the program's own jar.
struct SweethomeCatalogue {
    std::string id, name, licence, provider, version;
    std::vector<SweethomePiece> pieces;
    std::vector<std::string> warnings;  ///< pieces left out, and why
};

/// Whether the file name looks like one: *.sh3f, or a *.jar.
bool is_sweethome_catalogue(const std::filesystem::path& file);

/// Reads the list of pieces (PluginFurnitureCatalog.properties or DefaultFurnitureCatalog.properties); the models stay
/// packed. A piece without model or size is left out with a warning; an archive that has no such list is an error.
Result<SweethomeCatalogue> read_sweethome_catalogue(const std::filesystem::path& file);

}  // namespace embody::interchange
