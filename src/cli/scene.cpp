// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output.h"
#include "scene/file/scene_file.h"
#include "scenes/scene_builders.h"

namespace embody::cli {
namespace {

int list_scenes(bool json) {
    nlohmann::json rows = nlohmann::json::array();
    for (const scenes::SceneBuilder& builder : scenes::scene_builders()) {
        rows.push_back({{"name", builder.name}, {"title", builder.title}, {"figure", builder.figure}});
        if (!json) print_text("{} {} {}\n", padded(builder.name, 16), padded(builder.figure, 13), builder.title);
    }
    if (json) print_json({{"scenes", std::move(rows)}});
    return exit_ok;
}

}  // namespace

int run_scene(const SceneArguments& arguments) {
    if (arguments.name.empty()) return list_scenes(arguments.json);
    const scenes::SceneBuilder* builder = scenes::find_scene_builder(arguments.name);
    if (builder == nullptr)
        return report({arguments.name, "there is no such built-in scene", "embody scene lists them"});
    const scene::Document document = builder->build();
    if (arguments.output.empty()) {
        print_json(scene::document_to_json(document));
        return exit_ok;
    }
    if (auto saved = scene::save_document(document, arguments.output); !saved) return report(saved.error());
    return exit_ok;
}

}  // namespace embody::cli
