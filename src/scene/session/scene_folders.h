// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/session/session.h"

namespace embody::scene {

/// A scene that can be opened by name.
struct ListedScene {
    std::string name;  ///< what scene.load takes; "autosave/NAME" of a recovered one
    std::string title;
    std::string kind;      ///< "saved", "demo" or "recovery"
    std::string modified;  ///< UTC, e.g. "2026-11-20T13:00:00Z"
};

/// The name without spaces around it; "Untitled" if nothing is left.
std::string trimmed_name(const std::string& name);

/// Saved scenes first, then autosaves that are newer than their saved scenes, then demos; each by name.
std::vector<ListedScene> list_scenes(const SessionOptions& options);
/// A saved scene, else the demo of that name; "autosave/NAME" and "demo/NAME" select only these.
Result<std::filesystem::path> find_scene(const SessionOptions& options, const std::string& name);

/// The file of a scene of that name. Different names have different files: bytes that a file system or a shell could
/// misread are written as "%" and two hexadecimal digits ("a/b" in "a%2Fb.json"). Error: the name is too long, or
/// begins with the prefix of demos or autosaves.
Result<std::filesystem::path> saved_file(const SessionOptions& options, const std::string& name);
/// The file of its autosave; the name may be a title of any length.
std::filesystem::path autosave_file(const SessionOptions& options, const std::string& name);
/// The name by which a file of one of the folders is found.
std::string name_of_scene(const std::filesystem::path& file);

}  // namespace embody::scene
