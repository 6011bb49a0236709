// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

/// One line: the model, then the reason, without a repetition of the model's file name.
std::string text_of(const catalog::ImportFailure& failure) {
    std::string why = failure.error.message();
    if (why.starts_with(failure.path)) return why;
    const std::string file = failure.path.substr(0, failure.path.find('!')) + ": ";
    if (why.starts_with(file)) why.erase(0, file.size());
    return failure.path + ": " + why;
}

nlohmann::json to_json(const catalog::ImportReport& report) {
    nlohmann::json failures = nlohmann::json::array();
    for (const catalog::ImportFailure& failure : report.failures)
        failures.push_back({{"path", failure.path}, {"why", failure.error.message()}});
    return {{"added", report.added},           {"updated", report.updated},     {"unchanged", report.unchanged},
            {"failures", std::move(failures)}, {"shapeless", report.shapeless}, {"seconds", report.seconds},
            {"stopped", report.stopped}};
}

}  // namespace

int run_import(const ImportArguments& arguments) {
    catalog::ImportOptions options;
    if (!arguments.collection.empty()) {
        auto collection = catalog::read_collection(data_folder() / "collections", arguments.collection);
        if (!collection) return report(collection.error());
        options.collection = std::move(*collection);
    } else if (arguments.paths.empty()) {
        return report({"import", "nothing is named", "name files or folders, or a collection with --collection"});
    }
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    ProgressBar bar("Importing");
    options.workers = arguments.workers;
    options.again = arguments.again;
    options.progress = [&](const catalog::ImportProgress& progress) {
        bar.show(progress.done, progress.total, progress.current);
        // Ctrl+C ends the import after the current model; what is in the database stays.
        return !interrupted();
    };
    watch_interrupts();
    const auto result = (*catalog)->import(arguments.paths, options);
    bar.finish();
    if (!result) return report(result.error());
    for (const catalog::ImportFailure& failure : result->failures) print_error("embody: {}\n", text_of(failure));
    if (arguments.json) {
        print_json(to_json(*result));
    } else {
        print_text("{} added, {} updated, {} unchanged, {} failed in {:.1f} s; {} models in {}\n", result->added,
                   result->updated, result->unchanged, result->failures.size(), result->seconds,
                   (*catalog)->model_count(), arguments.database.string());
    }
    if (result->shapeless > 0 && !arguments.json)
        print_text("{} light sources have no shape and were left out\n", result->shapeless);
    if (result->stopped) {
        print_error("embody: stopped; the same command goes on from here\n");
        return exit_failed;
    }
    return result->failures.empty() ? exit_ok : exit_partly;
}

}  // namespace embody::cli
