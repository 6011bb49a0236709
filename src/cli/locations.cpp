// SPDX-License-Identifier: MIT
#include "cli/locations.h"

#include <cstdlib>

#include "cli/output.h"

namespace embody::cli {
namespace {

namespace fs = std::filesystem;

fs::path from_environment(const char* variable, const fs::path& otherwise) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0' ? fs::path(value) : otherwise;
}

}  // namespace

fs::path data_folder() { return from_environment("EMBODY_DATA", fs::path(EMBODY_SOURCE_DIR) / "data"); }
fs::path studio_folder() { return from_environment("EMBODY_STUDIO", fs::path(EMBODY_SOURCE_DIR) / "studio" / "dist"); }
fs::path saved_scenes_folder() { return catalog::Catalog::default_file().parent_path() / "scenes"; }

Result<std::unique_ptr<catalog::Catalog>> open_catalog(const fs::path& database) {
    // Ctrl+C ends the program as usual: attributes that are resolved stay resolved.
    ProgressBar bar("Resolving attributes by the changed taxonomy");
    catalog::OpenOptions options;
    options.progress = [&bar](std::size_t done, std::size_t total) {
        bar.show(done, total, {});
        return true;
    };
    auto catalog = catalog::Catalog::open(database, data_folder() / "taxonomy", options);
    bar.finish();
    if (catalog) (*catalog)->set_session("command line");
    return catalog;
}

}  // namespace embody::cli
