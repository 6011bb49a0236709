// SPDX-License-Identifier: MIT
#include "catalog/prepare/prepare.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "catalog/prepare/appearance.h"
#include "catalog/prepare/geometry_measurement.h"
#include "catalog/prepare/placement.h"
#include "catalog/prepare/quality.h"
#include "catalog/prepare/surface_finish.h"
#include "catalog/prepare/thumbnail.h"
#include "foundation/state_hash.h"
#include "interchange/compact/compact_geometry.h"
#include "interchange/read_model.h"

namespace embody::catalog {
namespace {

std::uint64_t hash_of(const std::vector<std::uint8_t>& bytes) {
    StateHash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.value();
}

/// Folders that say where files lie, not what they are: a model on the desktop is no computer. Of the systems' own,
/// also as German and French systems call them, those that are things.
bool is_only_a_place(const std::filesystem::path& folder) {
    constexpr auto places = std::to_array<std::string_view>(
        {"desktop", "schreibtisch", "bureau",    "documents", "dokumente",   "downloads", "pictures",
         "bilder",  "images",       "music",     "musik",     "videos",      "public",    "templates",
         "media",   "temp",         "tmp",       "home",      "users",       "root",      "new folder",
         "models",  "model",        "meshes",    "mesh",      "scenes",      "scene",     "objects",
         "assets",  "files",        "3d models", "stuff",     "neuer ordner"});
    std::string name = folder.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::filesystem::path above = folder.parent_path();
    return std::ranges::find(places, name) != places.end() || above == "/home" || above == "/Users";
}

/// The last two folders of the model's path, as far as they say what it is: often the only words that do.
std::string last_folders(const ImportItem& item) {
    const std::filesystem::path folder = std::filesystem::path(item.path).parent_path();
    std::filesystem::path said;
    for (const auto& one : {folder.parent_path(), folder}) {
        if (!is_only_a_place(one)) said /= one.filename();
    }
    return said.generic_string();
}

Result<PreparedModel> prepare_from(const interchange::FileSource& source, const std::string& path,
                                   const ImportItem& item) {
    auto scene = interchange::read_model(source, path);
    if (!scene) return scene.error();
    const auto bytes = source.read(path);
    if (!bytes) return bytes.error();

    // Into the model's frame, and complete for drawing.
    set_appearance(*scene, item);
    if (const auto placed = place(*scene, item); !placed) return Error{source.describe(path), placed.error().why};
    finish_surfaces(*scene);

    PreparedModel model;
    model.content_hash = hash_of(*bytes);
    model.facts = stated_facts(item);
    model.facts.material_names = material_names_by_area(*scene);
    const bool is_fixed = item.door_or_window || item.movable == false;
    const GeometryMeasurement measured = measure_geometry(*scene, is_fixed ? Decompose::no : Decompose::where_hollow);
    model.facts.geometry = measured.facts;
    model.hull_points = measured.hull_points;
    model.convex_parts = measured.convex_parts;
    model.quality = grade_quality(measured);

    const auto compact = interchange::encode(*scene);
    if (!compact) return Error{source.describe(path), compact.error().message()};
    model.geometry = compact->bytes;
    model.vertices = compact->vertices;
    model.triangles = compact->triangles;
    model.parts = compact->parts;
    model.materials = compact->materials;
    model.images = compact->images;
    model.warnings = scene->warnings;
    model.warnings.insert(model.warnings.end(), compact->warnings.begin(), compact->warnings.end());

    // The catalogue's own picture where it has one.
    auto thumbnail = item.icon_path.empty() ? std::vector<std::uint8_t>() : thumbnail_of_icon(source, item.icon_path);
    model.thumbnail = thumbnail.empty() ? render_thumbnail(*scene) : std::move(thumbnail);
    return model;
}

}  // namespace

struct Preparation::State {
    std::string archive_path;
    std::optional<interchange::Archive> archive;
};

Preparation::Preparation() : state_(std::make_unique<State>()) {}
Preparation::~Preparation() = default;

Result<PreparedModel> Preparation::prepare(const ImportItem& item) {
    if (item.archive.empty()) {
        const std::filesystem::path file(item.path);
        return prepare_from(interchange::FolderSource(file.parent_path()), file.filename().string(), item);
    }
    if (!state_->archive || state_->archive_path != item.archive) {
        auto archive = interchange::Archive::open(item.archive);
        if (!archive) return archive.error();
        state_->archive.emplace(std::move(*archive));
        state_->archive_path = item.archive;
    }
    return prepare_from(interchange::ArchiveSource(*state_->archive, item.archive), item.path, item);
}

attributes::ModelFacts stated_facts(const ImportItem& item) {
    attributes::ModelFacts facts;
    facts.name = item.name.empty() ? std::filesystem::path(item.path).stem().string() : item.name;
    facts.tags = item.tags;
    facts.catalogue_category = item.category;
    facts.folder = last_folders(item);
    facts.movable = item.movable;
    facts.door_or_window = item.door_or_window;
    facts.size_is_stated = item.stated_size.has_value() || item.stated_unit.has_value();
    return facts;
}

}  // namespace embody::catalog
