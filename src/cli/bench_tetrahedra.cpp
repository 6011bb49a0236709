// SPDX-License-Identifier: MIT
#include "cli/bench_tetrahedra.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/bench_models.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "geometry/tetrahedra/embedding.h"
#include "geometry/tetrahedra/fill.h"

namespace embody::cli {
namespace {

// Words for soft things of a household; the models that match each word best are filled.
constexpr const char* filled_words[] = {"cushion", "pillow", "sofa", "mattress", "teddy",
                                        "plush",   "ball",   "pouf", "armchair"};
constexpr int models_a_word = 6;

struct Row {
    catalog::ModelSummary model;
    geometry::TetrahedralFilling filling;
    geometry::DihedralAngles angles;
    double least_weight = 1;  // smallest weight of a drawn vertex; negative: it is outside of its tetrahedron
    double fill_seconds = 0, embed_seconds = 0;
};

Result<Row> run_one(const catalog::Catalog& catalog, catalog::ModelSummary model) {
    const auto mesh = catalog.mesh(model.id);
    if (!mesh) return mesh.error();
    const double start = processor_time();
    auto filled = geometry::fill_with_tetrahedra(*mesh);
    if (!filled) return filled.error();
    const double filled_at = processor_time();
    const auto points = geometry::embed(mesh->positions, filled->mesh);
    if (!points) return points.error();
    Row row{std::move(model), std::move(*filled), {}, 1, filled_at - start, processor_time() - filled_at};
    row.angles = geometry::measure_dihedral_angles(row.filling.mesh);
    for (const geometry::EmbeddedPoint& p : *points) {
        row.least_weight = std::min(row.least_weight, *std::min_element(p.weights.begin(), p.weights.end()));
    }
    return row;
}

nlohmann::json to_json(const Row& row) {
    return {{"model", row.model.key},
            {"name", row.model.name},
            {"triangles", row.model.triangles},
            {"tetrahedra", row.filling.mesh.tetrahedra.size()},
            {"nodes", row.filling.mesh.nodes.size()},
            {"cell_m", row.filling.cell},
            {"components", row.filling.component_volumes.size()},
            {"left_out_components", row.filling.left_out_components},
            {"volume_share", row.filling.volume_fraction},
            {"volume_method", geometry::name(row.filling.method)},
            {"least_angle_deg", row.angles.least},
            {"largest_angle_deg", row.angles.largest},
            {"least_weight", row.least_weight},
            {"fill_seconds", row.fill_seconds},
            {"embed_seconds", row.embed_seconds}};
}

void print_row(const Row& row) {
    print_text("{} {:>9} {:>6} {:>5} {:>6.1f} {:>3} {:>3} {:>6.1f} {:>6.1f} {:>6.1f} {:>6.1f} {:>7.3f} {:>7.3f}  {}\n",
               padded(row.model.name, 24), row.model.triangles, row.filling.mesh.tetrahedra.size(),
               row.filling.mesh.nodes.size(), 1e3 * row.filling.cell, row.filling.component_volumes.size(),
               row.filling.left_out_components, 100 * row.filling.volume_fraction, row.angles.least, row.angles.largest,
               row.least_weight, row.fill_seconds, row.embed_seconds, geometry::name(row.filling.method));
    std::fflush(stdout);
}

}  // namespace

int run_tetrahedra(const BenchArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto models = choose_bench_models(**catalog, filled_words, models_a_word, arguments);
    if (!models) return report(models.error());
    if (!arguments.json) {
        print_text(
            "Cells in mm, volume in % of the estimated, angles in degrees, smallest weight of a drawn vertex, "
            "processor time in s.\n");
        print_text("{} {:>9} {:>6} {:>5} {:>6} {:>3} {:>3} {:>6} {:>6} {:>6} {:>6} {:>7} {:>7}  volume from\n",
                   padded("model", 24), "triangles", "tetra", "nodes", "cell", "in", "out", "volume", "least", "most",
                   "weight", "fill", "embed");
    }
    nlohmann::json rows = nlohmann::json::array();
    std::vector<double> shares, seconds;
    nlohmann::json refused = nlohmann::json::array();
    for (const catalog::ModelSummary& model : *models) {
        const auto row = run_one(**catalog, model);
        if (!row) {
            // A model that is a sheet is a valid result here, not a failure.
            refused.push_back({{"model", model.key}, {"why", row.error().message()}});
            if (!arguments.json) print_text("{} {}\n", padded(model.name, 24), row.error().message());
            continue;
        }
        shares.push_back(row->filling.volume_fraction);
        seconds.push_back(row->fill_seconds);
        rows.push_back(to_json(*row));
        if (!arguments.json) print_row(*row);
    }
    const auto median = [](std::vector<double> of) {
        std::sort(of.begin(), of.end());
        return of.empty() ? 0 : of[of.size() / 2];
    };
    if (arguments.json) {
        print_json({{"suite", arguments.suite},
                    {"models", rows},
                    {"refused", refused},
                    {"median_volume_share", median(shares)},
                    {"median_fill_seconds", median(seconds)}});
    } else {
        print_text("{} models filled, {} not: median volume {:.1f} %, {:.2f} s\n", shares.size(), refused.size(),
                   100 * median(shares), median(seconds));
    }
    return shares.empty() ? exit_failed : exit_ok;
}

}  // namespace embody::cli
