// SPDX-License-Identifier: MIT
#include "catalog/collection.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "attributes/field_reader.h"
#include "attributes/json_text.h"

namespace embody::catalog {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// "flightgear, kicad"
std::string names_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
        if (at->path().extension() == ".json") names.push_back(at->path().stem().string());
    }
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

/// Quarter turns that bring a file's upward axis to Y, rows.
Result<std::array<double, 9>> rotation_from(const std::string& up) {
    if (up == "y") return std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (up == "z") return std::array<double, 9>{1, 0, 0, 0, 0, 1, 0, -1, 0};
    return Error{"up", "must be \"y\" or \"z\", got \"" + up + "\""};
}

std::optional<Error> read_folders(const Json& list, const std::string& where, Collection& collection) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        attributes::FieldReader reader(list[i], where + ".folders[" + std::to_string(i) + "]");
        CollectionFolder folder;
        std::string path;
        reader.require({"path", "package"});
        reader.word("path", path);
        reader.word("package", folder.package);
        if (!path.empty() && fs::path(path).is_relative()) reader.refuse("path", "must be an absolute path");
        if (!reader.finish()) return reader.error();
        folder.path = path;
        collection.folders.push_back(std::move(folder));
    }
    return std::nullopt;
}

std::optional<Error> read_things(const Json& list, const std::string& where, Collection& collection) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        attributes::FieldReader reader(list[i], where + ".things[" + std::to_string(i) + "]");
        CollectionThings things;
        reader.require({"files", "are"});
        reader.word("files", things.files);
        reader.word("are", things.are);
        if (!reader.finish()) return reader.error();
        collection.things.push_back(std::move(things));
    }
    return std::nullopt;
}

}  // namespace

Result<Collection> read_collection(const fs::path& folder, const std::string& name) {
    const bool own = fs::path(name).extension() == ".json";
    const fs::path file = own ? fs::path(name) : folder / (name + ".json");
    std::error_code failure;
    if (!own && (name.find('/') != std::string::npos || !fs::is_regular_file(file, failure))) {
        return Error{"collection \"" + name + "\"", "is not known", "known are " + names_in(folder)};
    }
    const auto document = attributes::read_json(file);
    if (!document) return document.error();

    // Every field, and none besides.
    Collection collection;
    std::string up;
    attributes::FieldReader reader(*document, file.string());
    reader.require({"name", "title", "licence", "author", "extensions", "unit", "up", "source", "folders"});
    reader.word("name", collection.name);
    reader.word("title", collection.title);
    reader.word("licence", collection.licence);
    reader.word("author", collection.author);
    reader.words("extensions", collection.extensions);
    reader.number("unit", collection.unit, {1e-6, 1e6});
    reader.word("up", up);
    std::string source;
    reader.word("source", source);
    reader.words("leave_out", collection.leave_out);
    const Json* folders = reader.list("folders");
    const Json* things = reader.list("things");
    if (!reader.finish()) return *reader.error();
    if (auto error = read_folders(*folders, file.string(), collection)) return *error;
    if (things != nullptr) {
        if (auto error = read_things(*things, file.string(), collection)) return *error;
    }
    const auto rotation = rotation_from(up);
    if (!rotation) return Error{file.string() + ".up", rotation.error().why};
    collection.rotation = *rotation;
    return collection;
}

}  // namespace embody::catalog
