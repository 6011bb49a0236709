// SPDX-License-Identifier: MIT
#include "catalog/import/find_models.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "interchange/archive/archive.h"
#include "interchange/sweethome/sweethome_catalogue.h"

namespace embody::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> model_extensions{".obj", ".gltf", ".glb", ".stl", ".ply", ".dae"};
constexpr std::array<std::string_view, 3> archive_extensions{".sh3f", ".jar", ".zip"};
constexpr const char* readable = ".obj .gltf .glb .stl .ply .dae .sh3f .jar .zip";

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return extension;
}

bool is_model(const fs::path& path) {
    return std::find(model_extensions.begin(), model_extensions.end(), lower_extension(path)) != model_extensions.end();
}
bool is_archive(const fs::path& path) {
    return std::find(archive_extensions.begin(), archive_extensions.end(), lower_extension(path)) !=
           archive_extensions.end();
}

// "office_chair-2.obj" → "office chair 2".
std::string name_of(const fs::path& path) {
    std::string name = path.stem().string();
    std::replace(name.begin(), name.end(), '_', ' ');
    std::replace(name.begin(), name.end(), '-', ' ');
    return name;
}

/// One walk's memory.
struct Walk {
    FoundModels found;

    void fail(const fs::path& path, std::string why, std::string remedy = {}) {
        found.failures.push_back({path.string(), {path.string(), std::move(why), std::move(remedy)}});
    }

    void add_file(const fs::path& file) {
        FoundModel model;
        model.file = file;
        model.location = file.string();
        model.item.path = file.string();
        model.item.name = name_of(file);
        model.item.source = file.parent_path().filename().string();
        found.models.push_back(std::move(model));
    }

    void add_catalogue(const fs::path& file, interchange::SweethomeCatalogue catalogue) {
        for (std::string& warning : catalogue.warnings) fail(file, std::move(warning));
        for (interchange::SweethomePiece& piece : catalogue.pieces) {
            FoundModel model;
            model.file = file;
            model.location = file.string() + "!" + piece.id;
            ImportItem& item = model.item;
            // A piece without an id of its own is named by its catalogue and path.
            const bool has_id = piece.id != piece.model_path;
            item.key = "sweethome3d:" + (has_id ? piece.id : catalogue.name + "#" + piece.id);
            item.archive = file.string();
            item.path = std::move(piece.model_path);
            item.icon_path = std::move(piece.icon_path);
            item.name = std::move(piece.name);
            item.source = catalogue.name.empty() ? file.stem().string() : catalogue.name;
            item.licence = catalogue.licence;
            item.author = piece.creator.empty() ? catalogue.provider : std::move(piece.creator);
            item.category = std::move(piece.category);
            item.tags = std::move(piece.tags);
            item.stated_size = piece.size;
            item.stated_rotation = piece.rotation;
            item.movable = piece.movable;
            item.door_or_window = piece.door_or_window;
            found.models.push_back(std::move(model));
        }
    }

    // A zip that is no catalogue: its model files, each by archive and path. False where it holds none.
    bool add_packed_files(const fs::path& file, const interchange::Archive& archive) {
        bool any = false;
        for (const interchange::ArchiveMember& member : archive.members()) {
            if (!is_model(member.path)) continue;
            any = true;
            FoundModel model;
            model.file = file;
            model.location = file.string() + "!" + member.path;
            model.item.archive = file.string();
            model.item.path = member.path;
            model.item.name = name_of(member.path);
            model.item.source = file.stem().string();
            found.models.push_back(std::move(model));
        }
        return any;
    }

    // In a folder, a jar or zip without models is somebody else's and no failure.
    void add_archive(const fs::path& file, bool named_by_user) {
        auto catalogue = interchange::read_sweethome_catalogue(file);
        if (catalogue) return add_catalogue(file, std::move(*catalogue));
        auto archive = interchange::Archive::open(file);
        if (!archive) {
            if (named_by_user || lower_extension(file) != ".jar")
                fail(file, archive.error().why, archive.error().remedy);
            return;
        }
        if (add_packed_files(file, *archive) || !named_by_user) return;
        fail(file, "holds neither a furniture catalogue nor model files", {});
    }

    void add_folder(const fs::path& folder) {
        std::error_code failure;
        std::vector<fs::path> files;
        const auto options = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator at(folder, options, failure), end; !failure && at != end;
             at.increment(failure)) {
            std::error_code no_matter;
            if (at->is_regular_file(no_matter) && (is_model(at->path()) || is_archive(at->path()))) {
                files.push_back(at->path());
            }
        }
        if (failure) fail(folder, "cannot be read: " + failure.message());
        if (files.empty() && !failure) fail(folder, "holds no model files", std::string("readable are ") + readable);
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files) is_model(file) ? add_file(file) : add_archive(file, false);
    }

    void add_path(const fs::path& typed) {
        std::error_code failure;
        const fs::path path = fs::weakly_canonical(typed, failure);
        if (failure || !fs::exists(path, failure)) return fail(typed, "does not exist");
        if (fs::is_directory(path, failure)) return add_folder(path);
        if (!fs::is_regular_file(path, failure)) return fail(typed, "is neither a file nor a folder");
        if (is_model(path)) return add_file(path);
        if (is_archive(path)) return add_archive(path, true);
        fail(typed, "is not a kind of file that can be imported", std::string("readable are ") + readable);
    }
};

}  // namespace

FoundModels find_models(const std::vector<fs::path>& paths) {
    Walk walk;
    for (const fs::path& path : paths) walk.add_path(path);
    return std::move(walk.found);
}

}  // namespace embody::catalog
