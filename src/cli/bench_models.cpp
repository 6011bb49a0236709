// SPDX-License-Identifier: MIT
#include "cli/bench_models.h"

#include <algorithm>
#include <ctime>

namespace embody::cli {

Result<std::vector<catalog::ModelSummary>> choose_bench_models(const catalog::Catalog& catalog,
                                                               std::span<const char* const> words, int models_a_word,
                                                               const BenchArguments& arguments) {
    std::vector<catalog::ModelSummary> chosen;
    if (!arguments.scene.empty()) {
        auto model = catalog.model(arguments.scene);
        if (!model) return model.error();
        chosen.push_back(std::move(*model));
        return chosen;
    }
    for (const char* word : words) {
        auto page = catalog.search({.words = word, .limit = models_a_word});
        if (!page) return page.error();
        for (catalog::ModelSummary& model : page->models) {
            const bool known =
                std::any_of(chosen.begin(), chosen.end(), [&](const auto& m) { return m.id == model.id; });
            if (!known && model.geometry_kind == catalog::GeometryKind::mesh) chosen.push_back(std::move(model));
        }
    }
    if (chosen.empty())
        return Error{"bench " + arguments.suite, "the database has none of the usual models",
                     "embody import a Sweet Home 3D catalogue, or name a model with --scene"};
    return chosen;
}

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace embody::cli
