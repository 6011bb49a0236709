// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "scene/scene_file.h"
#include "scene/simulation.h"

namespace embody::cli {
namespace {

/// Reads the file and brings it to life, as playing it would.
Result<std::size_t> check_scene(const std::filesystem::path& file, catalog::Catalog* catalog) {
    auto document = scene::load_document(file);
    if (!document) return document.error();
    auto simulation = scene::Simulation::create(*document, catalog);
    if (!simulation) {
        Error error = simulation.error();
        error.where = file.string() + ": " + error.where;
        return error;
    }
    return document->entities.size();
}

}  // namespace

int run_check(const CheckArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const std::filesystem::path& file : arguments.scenes) {
        const auto entities = check_scene(file, catalog->get());
        all_right = all_right && entities.ok();
        nlohmann::json row = {{"file", file.string()}, {"right", entities.ok()}};
        if (!entities) row["error"] = entities.error().message();
        rows.push_back(std::move(row));
        if (arguments.json) continue;
        if (entities)
            fmt::print("{}: right, {} entities\n", file.string(), *entities);
        else
            fmt::print("{}\n", entities.error().message());
    }
    if (arguments.json) print_json({{"scenes", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
