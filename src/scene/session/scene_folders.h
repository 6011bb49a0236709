// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/session/journal.h"
#include "scene/session/session.h"

namespace embody::scene {

/// A file of one of the folders.
struct ListedScene {
    std::string name;  ///< what scene.load takes
    std::string title, description;
    std::string kind;      ///< "saved", "demo" or "version"
    std::string modified;  ///< UTC, e.g. "2026-11-20T13:00:00Z"
};

/// The name without spaces around it; "Untitled" if nothing is left.
std::string trimmed_name(const std::string& name);

/// The `scenes` of scene.list: saved scenes, recoveries, demos; the first and last by name, recoveries newest first.
nlohmann::json scenes_to_json(const SessionOptions& options);
/// A saved scene, else the demo of that name; "demo/NAME" selects only these.
Result<std::filesystem::path> find_scene(const SessionOptions& options, const std::string& name);

/// The file of a scene of that name. Different names have different files: bytes that a file system or a shell could
/// misread are written as "%" and two hexadecimal digits ("a/b" in "a%2Fb.json"). Error: the name is too long, or
/// begins with the prefix of demos or recoveries.
Result<std::filesystem::path> saved_file(const SessionOptions& options, const std::string& name);
/// The name by which a file of one of the folders is found.
std::string name_of_scene(const std::filesystem::path& file);

/// The folder of journals.
std::filesystem::path recovery_folder(const SessionOptions& options);
/// The `recovered` of hello.
nlohmann::json recoveries_to_json(const SessionOptions& options);
/// Whether the name is that of a recovery: "autosave/…".
bool is_recovery(const std::string& name);
Result<std::filesystem::path> recovery_file(const SessionOptions& options, const std::string& name);
/// A journal, or an autosave of a version of Embody before journals.
Result<Recovered> read_recovery(const std::filesystem::path& file);

/// The file of a named version of a saved scene, existing or not.
Result<std::filesystem::path> version_file(const SessionOptions& options, const std::string& scene,
                                           const std::string& version);
/// By name.
std::vector<ListedScene> list_versions(const SessionOptions& options, const std::string& scene);

}  // namespace embody::scene
