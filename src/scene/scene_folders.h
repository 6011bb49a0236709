// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/session.h"

namespace embody::scene {

/// A scene that can be opened by name.
struct ListedScene {
    std::string name;  ///< what scene.load takes; "autosave/NAME" of a recovered one
    std::string title;
    std::string kind;      ///< "saved", "demo" or "recovery"
    std::string modified;  ///< UTC, e.g. "2026-11-20T13:00:00Z"
};

/// The name as a file's: what a file system or a shell could take amiss becomes "_", "Untitled" where nothing is left.
std::string file_name_of(const std::string& name);

/// Saved ones first, then what an autosave left that is newer than its saved scene, then demos; each by name.
std::vector<ListedScene> list_scenes(const SessionOptions& options);
/// A saved scene, else the demo of that name; "autosave/NAME" and "demo/NAME" name theirs alone.
Result<std::filesystem::path> find_scene(const SessionOptions& options, const std::string& name);

std::filesystem::path saved_file(const SessionOptions& options, const std::string& name);
std::filesystem::path autosave_file(const SessionOptions& options, const std::string& name);

}  // namespace embody::scene
