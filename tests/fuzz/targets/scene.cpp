// SPDX-License-Identifier: MIT
// Scene files.
#include <nlohmann/json.hpp>

#include "../target.h"
#include "scene/document/document_field.h"
#include "scene/file/json/print.h"
#include "scene/file/json/text.h"
#include "scene/file/scene_file.h"

using namespace embody;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto json = scene::parse_json(text, "scene");
    if (!json) {
        fuzz::require_reasons(json.error());
        return 0;
    }
    const auto document = scene::document_from_json(*json);
    if (!document) {
        // The error as load_document() reports it.
        fuzz::require_reasons(scene::in_place("scene", document.error()));
        return 0;
    }
    // A scene that was read can be saved, and read again as the same.
    const std::string saved = scene::print_json(scene::document_to_json(*document));
    const auto parsed = scene::parse_json(saved, "saved scene");
    fuzz::require(parsed.ok(), "a saved scene is JSON");
    const auto again = scene::document_from_json(*parsed);
    if (!again) std::fprintf(stderr, "%s\n%s\n", again.error().message().c_str(), saved.c_str());
    fuzz::require(again.ok(), "a saved scene can be read");
    fuzz::require(scene::print_json(scene::document_to_json(*again)) == saved,
                  "a scene that is saved twice is the same");
    return 0;
}
