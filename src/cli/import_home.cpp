// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "interchange/sweethome/sweethome_home.h"
#include "scene/file/scene_file.h"
#include "scene/home/home_document.h"

namespace embody::cli {

int run_import_home(const ImportHomeArguments& arguments) {
    const auto home = interchange::read_sweethome_home(arguments.home);
    if (!home) return report(home.error());
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());

    // Its furniture first.
    std::size_t failed = 0;
    if (!home->furniture.pieces.empty()) {
        ProgressBar bar("Importing furniture");
        catalog::ImportOptions options;
        options.workers = arguments.workers;
        options.progress = [&](const catalog::ImportProgress& progress) {
            bar.show(progress.done, progress.total, progress.current);
            return !interrupted();
        };
        watch_interrupts();
        const auto imported = (*catalog)->import({arguments.home}, options);
        bar.finish();
        if (!imported) return report(imported.error());
        for (const catalog::ImportFailure& failure : imported->failures)
            print_error("embody: {}: {}\n", failure.path, failure.error.message());
        failed = imported->failures.size();
        if (imported->stopped) {
            print_error("embody: stopped; the same command goes on from here\n");
            return exit_failed;
        }
    }

    const scene::HomeDocument made = scene::document_of_home(
        *home, arguments.home.stem().string(), [&](const std::string& key) { return (*catalog)->model(key).ok(); });
    for (const std::string& note : made.notes) print_error("embody: {}: {}\n", arguments.home.string(), note);
    if (arguments.output.empty()) {
        print_json(scene::document_to_json(made.document));
    } else if (auto saved = scene::save_document(made.document, arguments.output); !saved) {
        return report(saved.error());
    } else {
        print_text("{} walls, {} rooms, {} pieces of furniture in {}\n", home->walls.size(), home->rooms.size(),
                   home->pieces.size(), arguments.output.string());
    }
    return failed == 0 ? exit_ok : exit_partly;
}

}  // namespace embody::cli
