// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::catalog {

/// A folder of models that a package installs.
struct CollectionFolder {
    std::filesystem::path path;
    std::string package;  ///< Debian package that brings it
};

/// The word for all files of a collection whose place below its folder matches: "Relay_*" are a "relay".
struct CollectionThings {
    std::string files;  ///< pattern of the shell (fnmatch, case does not matter, * matches / too)
    std::string are;    ///< word of the taxonomy
};

/// Facts about a collection of model files that do not contain them: their folder, the length of their
/// unit, their upward axis, their authors. Read from data/collections (schema: data/schema/collection.schema.json).
struct Collection {
    std::string name;   ///< short, e.g. "kicad"; the beginning of the keys of its models
    std::string title;  ///< source of its models, for people
    std::vector<CollectionFolder> folders;
    std::vector<std::string> extensions;  ///< of its model files, e.g. ".wrl"; others are left alone
    double unit = 1;                      ///< length of one unit of the files, m
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< rows; turns the files' axes to Y up
    std::string licence, author;
    std::vector<CollectionThings> things;  ///< the first that fits counts
    std::vector<std::string> leave_out;    ///< patterns of files that are no models of things
};

/// Reads the collection `name` of `folder`, or a description of the user's own where `name` ends in ".json". The error
/// names the file and the field; of an unknown name, those that are known.
Result<Collection> read_collection(const std::filesystem::path& folder, const std::string& name);

}  // namespace embody::catalog
