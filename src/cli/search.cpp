// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "scene/session/model_json.h"

namespace embody::cli {

int run_search(const SearchArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    catalog::SearchQuery query;
    for (const std::string& word : arguments.words) query.words += (query.words.empty() ? "" : " ") + word;
    query.category = arguments.category;
    query.limit = arguments.limit;
    query.offset = arguments.offset;
    const auto page = (*catalog)->search(query);
    if (!page) return report(page.error());
    if (arguments.json) {
        nlohmann::json models = nlohmann::json::array();
        for (const catalog::ModelSummary& model : page->models) models.push_back(scene::model_to_json(model));
        print_json({{"total", page->total}, {"models", std::move(models)}});
        return exit_ok;
    }
    if (page->models.empty()) {
        if ((*catalog)->model_count() == 0)
            return report(
                {arguments.database.string(), "the database holds no models", "fill it with: embody import PATH…"});
        print_line("No model matches.");
        return exit_ok;
    }
    print_text("{:>6}  {}  {}  {}  {}\n", "id", padded("name", 30), padded("category", 18), padded("kind", 8),
               "size (m)");
    for (const catalog::ModelSummary& model : page->models) {
        print_text("{:>6}  {}  {}  {}  {:.2f} × {:.2f} × {:.2f}\n", model.id, padded(model.name, 30),
                   padded(model.category, 18), padded(to_text(model.physical_kind), 8), model.size.x, model.size.y,
                   model.size.z);
    }
    print_text("{} of {}\n", page->models.size(), page->total);
    return exit_ok;
}

}  // namespace embody::cli
