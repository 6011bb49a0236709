// SPDX-License-Identifier: MIT
#include "catalog/import/find_models.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <system_error>

#include "interchange/archive/archive.h"
#include "interchange/read_model.h"
#include "interchange/sweethome/sweethome_catalogue.h"
#include "interchange/sweethome/sweethome_home.h"

namespace embody::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> archive_extensions{".sh3f", ".sh3d", ".jar", ".zip"};

bool is_archive(const fs::path& path) {
    return std::find(archive_extensions.begin(), archive_extensions.end(), interchange::extension_of(path)) !=
           archive_extensions.end();
}

// "office_chair-2.obj" → "office chair 2".
std::string name_of(const fs::path& path) {
    std::string name = path.stem().string();
    std::replace(name.begin(), name.end(), '_', ' ');
    std::replace(name.begin(), name.end(), '-', ' ');
    return name;
}

bool fits(const std::string& pattern, const std::string& text) {
    return fnmatch(pattern.c_str(), text.c_str(), FNM_CASEFOLD) == 0;
}

/// Whether `path` lies in `folder`; both canonical.
bool lies_in(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// Applies the collection's facts to a file.
void describe_by(const Collection& collection, ImportItem& item) {
    item.source = collection.title;
    item.licence = collection.licence;
    item.author = collection.author;
    item.stated_unit = collection.unit;
    item.stated_rotation = collection.rotation;
}

/// The file's path below the collection's folder that contains it; empty where none does.
fs::path place_in(const Collection& collection, const fs::path& file) {
    for (const CollectionFolder& folder : collection.folders) {
        std::error_code failure;
        const fs::path root = fs::weakly_canonical(folder.path, failure);
        if (!failure && lies_in(file, root)) return file.lexically_relative(root);
    }
    return {};
}

/// Applies the collection's facts for that place.
void describe_by_place(const Collection& collection, const fs::path& place, ImportItem& item) {
    const std::string inside = place.generic_string();
    item.key = collection.name + ":" + inside;
    if (place.has_parent_path()) item.category = name_of(*place.begin());
    for (const CollectionThings& things : collection.things) {
        if (!fits(things.files, inside)) continue;
        item.stated_thing = things.are;
        return;
    }
}

bool is_left_out(const Collection& collection, const fs::path& place) {
    return std::any_of(collection.leave_out.begin(), collection.leave_out.end(),
                       [&](const std::string& pattern) { return fits(pattern, place.generic_string()); });
}

/// Memory of one search.
struct Walk {
    const std::optional<Collection>& collection;
    const std::function<bool()>& go_on;
    FoundModels found;
    bool stopped = false;

    /// Called before each step that may take long.
    bool is_stopped() {
        stopped = stopped || (go_on && !go_on());
        return stopped;
    }

    bool is_of_collection(const fs::path& file) const {
        if (!collection) return false;
        const auto& extensions = collection->extensions;
        return std::find(extensions.begin(), extensions.end(), interchange::extension_of(file)) != extensions.end();
    }

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
        if (is_of_collection(file)) {
            const fs::path place = place_in(*collection, file);
            if (is_left_out(*collection, place)) return;
            describe_by(*collection, model.item);
            if (!place.empty()) describe_by_place(*collection, place, model.item);
        }
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
            item.recolors = std::move(piece.recolors);
            item.movable = piece.movable;
            item.door_or_window = piece.door_or_window;
            item.light_source = piece.light_source;
            found.models.push_back(std::move(model));
        }
    }

    // A zip that is no catalogue: its model files, each by archive and path. False where it holds none.
    bool add_packed_files(const fs::path& file, const interchange::Archive& archive) {
        bool any = false;
        for (const interchange::ArchiveMember& member : archive.members()) {
            if (!interchange::is_model_file(member.path)) continue;
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

    // In a folder, a jar or zip without models belongs to something else and is no failure.
    void add_archive(const fs::path& file, bool named_by_user) {
        if (interchange::is_sweethome_home(file)) {
            auto home = interchange::read_sweethome_home(file);
            if (home) return add_catalogue(file, std::move(home->furniture));
            return fail(file, home.error().why, home.error().remedy);
        }
        auto catalogue = interchange::read_sweethome_catalogue(file);
        if (catalogue) return add_catalogue(file, std::move(*catalogue));
        auto archive = interchange::Archive::open(file);
        if (!archive) {
            if (named_by_user || interchange::extension_of(file) != ".jar")
                fail(file, archive.error().why, archive.error().remedy);
            return;
        }
        if (add_packed_files(file, *archive) || !named_by_user) return;
        fail(file, "holds neither a furniture catalogue nor model files", {});
    }

    bool is_wanted(const fs::path& file) const {
        return collection ? is_of_collection(file) : interchange::is_model_file(file) || is_archive(file);
    }

    /// Whether a file may be read for an import of `folder`; both canonical.
    bool may_read(const fs::path& file, const fs::path& folder) const {
        return lies_in(file, folder) || (collection && !place_in(*collection, file).empty());
    }

    /// The file that a link in `folder` leads to, where that is a wanted file which may be read.
    std::optional<fs::path> target_of(const fs::path& link, const fs::path& folder) {
        std::error_code failure;
        const fs::path target = fs::canonical(link, failure);
        if (failure || !fs::is_regular_file(target, failure)) return std::nullopt;
        if (!may_read(target, folder)) {
            fail(link, "is a symbolic link that leaves the imported folder",
                 "import the file that it leads to by name, or copy it into the folder");
            return std::nullopt;
        }
        return is_wanted(target) ? std::optional(target) : std::nullopt;
    }

    /// All files below that are models or archives; of a collection, those that are its own. Nothing twice.
    std::set<fs::path> files_below(const fs::path& folder) {
        std::error_code failure;
        std::set<fs::path> files;
        const std::size_t failures = found.failures.size();
        const auto options = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator at(folder, options, failure), end; !failure && at != end && !is_stopped();
             at.increment(failure)) {
            std::error_code no_matter;
            if (!is_wanted(at->path())) continue;
            if (at->is_symlink(no_matter)) {
                if (const auto target = target_of(at->path(), folder)) files.insert(*target);
            } else if (at->is_regular_file(no_matter)) {
                files.insert(at->path());
            }
        }
        if (failure) fail(folder, "cannot be read: " + failure.message());
        if (files.empty() && !stopped && found.failures.size() == failures) {
            fail(folder, "holds no model files", "readable are " + readable_extensions());
        }
        return files;
    }

    void add_folder(const fs::path& folder) {
        for (const fs::path& file : files_below(folder)) {
            if (is_stopped()) return;
            interchange::is_model_file(file) ? add_file(file) : add_archive(file, false);
        }
    }

    void add_collection() {
        for (const std::string& extension : collection->extensions) {
            const auto able = interchange::can_read("model" + extension);
            if (!able) return fail(collection->title, able.error().why, able.error().remedy);
        }
        for (const CollectionFolder& folder : collection->folders) {
            std::error_code failure;
            const fs::path path = fs::weakly_canonical(folder.path, failure);
            if (!failure && fs::is_directory(path, failure)) {
                add_folder(path);
            } else {
                fail(folder.path, "does not exist", "install it with: apt-get install " + folder.package);
            }
        }
    }

    void add_path(const fs::path& typed) {
        std::error_code failure;
        const fs::path path = fs::weakly_canonical(typed, failure);
        if (failure || !fs::exists(path, failure)) return fail(typed, "does not exist");
        if (fs::is_directory(path, failure)) return add_folder(path);
        if (!fs::is_regular_file(path, failure)) return fail(typed, "is neither a file nor a folder");
        if (interchange::is_model_file(path)) return add_file(path);
        if (is_archive(path)) return add_archive(path, true);
        fail(typed, "is not a kind of file that can be imported", "readable are " + readable_extensions());
    }
};

}  // namespace

std::string readable_extensions() {
    std::string list;
    for (const std::string& extension : interchange::model_extensions()) list += extension + " ";
    for (const std::string_view extension : archive_extensions) list += std::string(extension) + " ";
    list.pop_back();
    return list;
}

FoundModels find_models(const std::vector<fs::path>& paths, const std::optional<Collection>& collection,
                        const std::function<bool()>& go_on) {
    Walk walk{collection, go_on, {}};
    if (paths.empty() && collection) walk.add_collection();
    for (const fs::path& path : paths) {
        if (!walk.is_stopped()) walk.add_path(path);
    }
    return std::move(walk.found);
}

}  // namespace embody::catalog
