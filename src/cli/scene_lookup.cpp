// SPDX-License-Identifier: MIT
#include "cli/scene_lookup.h"

#include <filesystem>

#include "cli/locations.h"
#include "scene/file/scene_file.h"
#include "scene/session/scene_folders.h"
#include "scenes/scene_builders.h"

namespace embody::cli {

Result<scene::Document> find_scene(const std::string& file_or_name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::exists(file_or_name, ignored)) return scene::load_document(file_or_name);
    if (const scenes::SceneBuilder* builder = scenes::find_scene_builder(file_or_name)) return builder->build();
    const scene::SessionOptions folders{.saved_scenes = saved_scenes_folder(), .demo_scenes = data_folder() / "scenes"};
    for (const std::string& name : {"demo/" + file_or_name, file_or_name})
        if (const auto file = scene::find_scene(folders, name)) return scene::load_document(*file);
    return Error{file_or_name, "is neither a file nor the name of a scene", "embody scene lists the built-in ones"};
}

}  // namespace embody::cli
