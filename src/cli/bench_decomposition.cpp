// SPDX-License-Identifier: MIT
#include "cli/bench_decomposition.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/bench_models.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "geometry/decomposition/decomposition.h"
#include "geometry/decomposition/measure_decomposition.h"

namespace embody::cli {
namespace {

constexpr int samples = 6000;

// Words for hollow things of a household; the models that match each word best are decomposed.
constexpr const char* decomposed_words[] = {"mug",  "cup",   "glass",   "chair", "armchair", "table", "desk",
                                            "lamp", "shelf", "cabinet", "sofa",  "bottle",   "shoe",  "toy"};
constexpr int models_a_word = 3;

struct Row {
    catalog::ModelSummary model;
    geometry::Decomposition made;
    geometry::DecompositionMeasure measure;
    double seconds = 0;
};

Result<Row> run_one(const catalog::Catalog& catalog, catalog::ModelSummary model) {
    const auto mesh = catalog.mesh(model.id);
    if (!mesh) return mesh.error();
    const double start = processor_time();
    auto made = geometry::decompose(*mesh);
    if (!made) return made.error();
    Row row{std::move(model), std::move(*made), {}, processor_time() - start};
    row.measure = geometry::measure_decomposition(*mesh, row.made.hulls, samples);
    return row;
}

nlohmann::json to_json(const Row& row) {
    return {{"model", row.model.key},
            {"name", row.model.name},
            {"triangles", row.model.triangles},
            {"hulls", row.made.hulls.size()},
            {"vertices", row.measure.vertices},
            {"hull_concavity_m", row.made.hull_concavity},
            {"concavity_m", row.made.concavity},
            {"added_m", row.measure.added},
            {"added_95_m", row.measure.added_95},
            {"left_out_m", row.measure.left_out},
            {"seconds", row.seconds}};
}

void print_row(const Row& row) {
    print_text("{} {:>9} {:>9.1f} {:>6} {:>9.1f} {:>9.1f} {:>8.1f} {:>9.1f} {:>8.3f}\n", padded(row.model.name, 24),
               row.model.triangles, 1e3 * row.made.hull_concavity, row.made.hulls.size(), 1e3 * row.made.concavity,
               1e3 * row.measure.added, 1e3 * row.measure.added_95, 1e3 * row.measure.left_out, row.seconds);
    std::fflush(stdout);
}

}  // namespace

int run_decomposition(const BenchArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto models = choose_bench_models(**catalog, decomposed_words, models_a_word, arguments);
    if (!models) return report(models.error());
    if (!arguments.json) {
        print_text("Lengths in mm, processor time in s. Added: from the hulls' union to the model; left out: back.\n");
        print_text("{} {:>9} {:>9} {:>6} {:>9} {:>9} {:>8} {:>9} {:>8}\n", padded("model", 24), "triangles", "one hull",
                   "hulls", "concavity", "added", "95 %", "left out", "time");
    }
    nlohmann::json rows = nlohmann::json::array();
    double hulls = 0, added = 0, added_95 = 0, seconds = 0;
    int done = 0, failed = 0;
    for (const catalog::ModelSummary& model : *models) {
        const auto row = run_one(**catalog, model);
        if (!row) {
            ++failed;
            report(Error{model.name, row.error().message(), {}});
            continue;
        }
        ++done;
        hulls += static_cast<double>(row->made.hulls.size());
        added += row->measure.added;
        added_95 += row->measure.added_95;
        seconds += row->seconds;
        rows.push_back(to_json(*row));
        if (!arguments.json) print_row(*row);
    }
    const double n = std::max(done, 1);
    const double rate = seconds > 0 ? done / seconds : 0;
    if (arguments.json) {
        print_json({{"suite", "decomposition"},
                    {"models", std::move(rows)},
                    {"mean_hulls", hulls / n},
                    {"mean_added_m", added / n},
                    {"mean_added_95_m", added_95 / n},
                    {"models_a_second", rate}});
    } else {
        print_text("{} models: {:.1f} hulls, {:.1f} mm added, {:.1f} mm at 95 %, {:.1f} models per second\n", done,
                   hulls / n, 1e3 * added / n, 1e3 * added_95 / n, rate);
    }
    return failed == 0 && done > 0 ? exit_ok : exit_failed;
}

}  // namespace embody::cli
