// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "scene/document/document_field.h"
#include "scene/embody/entity_definitions.h"
#include "scene/file/scene_file.h"
#include "scene/simulation/simulation.h"

namespace embody::cli {
namespace {

struct Checked {
    std::size_t entities = 0;
    std::vector<std::string> notes;  ///< differences between what is simulated and what the entity's kind asks for
    /// Between attributes that a person set, a kept form and its entity, or taps and liquids; the scene can be played.
    std::vector<Error> contradictions;
};

/// Reads the file and creates the world, as playing it would.
Result<Checked> check_scene(const std::filesystem::path& file, catalog::Catalog* catalog) {
    auto document = scene::load_document(file);
    if (!document) return document.error();
    auto simulation = scene::Simulation::create(*document, catalog);
    if (!simulation) return scene::in_place(file.string(), simulation.error());
    Checked checked{document->entities.size(), (*simulation)->notes(), {}};
    scene::EntityDefinitions definitions(catalog);
    for (std::size_t i = 0; i < document->entities.size(); ++i) {
        const scene::EntityIndex index = document->entities[i].index;
        const bool has_joint = std::ranges::any_of(document->joints, [index](const auto& joint) {
            return joint.entity_a == index || joint.entity_b == index;
        });
        const auto found = definitions.attributes.contradictions(
            document->entities[i], scene::circumstances_of(document->settings, has_joint));
        if (!found) return scene::in_place(file.string(), found.error());
        const std::string entity = file.string() + ": entities[" + std::to_string(i) + "].";
        const std::string where = entity + "attributes.";
        for (const attributes::Issue& issue : *found) {
            checked.contradictions.push_back(
                {where + issue.attribute, issue.why,
                 issue.remedy.empty() ? "change or reset one of these values" : issue.remedy});
        }
        const auto acting = definitions.attributes.acting(document->entities[i]);
        if (!acting) return scene::in_place(file.string(), acting.error());
        const Result<void> kept = definitions.points.check_kept(document->entities[i], *acting);
        if (!kept)
            checked.contradictions.push_back({entity + kept.error().where, kept.error().why, kept.error().remedy});
    }
    for (const scene::PortFault& fault : (*simulation)->port_faults()) {
        const auto at = std::ranges::find(document->entities, fault.entity, &scene::Entity::index);
        const std::string entity =
            file.string() + ": entities[" + std::to_string(at - document->entities.begin()) + "].";
        checked.contradictions.push_back({entity + fault.error.where, fault.error.why, fault.error.remedy});
    }
    return checked;
}

void print_row(const nlohmann::json& row, std::size_t entities) {
    if (row.contains("error")) return print_text("{}\n", row["error"].get<std::string>());
    for (const auto& contradiction : row["contradictions"]) print_text("{}\n", contradiction.get<std::string>());
    const std::string file = row["file"];
    for (const auto& note : row["notes"]) print_text("{}: note: {}\n", file, note.get<std::string>());
    if (row["right"]) return print_text("{}: right, {} entities\n", file, entities);
    print_text("{}: can be simulated, but what it says contradicts itself\n", file);
}

}  // namespace

int run_check(const CheckArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const std::filesystem::path& file : arguments.scenes) {
        const auto checked = check_scene(file, catalog->get());
        const bool right = checked.ok() && checked->contradictions.empty();
        all_right = all_right && right;
        nlohmann::json row = {{"file", file.string()},
                              {"right", right},
                              {"contradictions", nlohmann::json::array()},
                              {"notes", nlohmann::json::array()}};
        if (!checked) {
            row["error"] = checked.error().message();
        } else {
            row["notes"] = checked->notes;
            for (const Error& one : checked->contradictions) row["contradictions"].push_back(one.message());
        }
        if (!arguments.json) print_row(row, checked ? checked->entities : 0);
        rows.push_back(std::move(row));
    }
    if (arguments.json) print_json({{"scenes", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
