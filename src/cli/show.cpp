// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/registry.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "scene/model_json.h"

namespace embody::cli {
namespace {

using attributes::AttributeEntry;

void print_model(const catalog::ModelSummary& model) {
    std::string tags;
    for (const std::string& tag : model.tags) tags += (tags.empty() ? "" : ", ") + tag;
    fmt::print("{}  (id {}, key {})\n", model.name, model.id, model.key);
    fmt::print("  from      {}, by {}, licence {}\n", model.source, model.author.empty() ? "unknown" : model.author,
               model.licence.empty() ? "unknown" : model.licence);
    fmt::print("  category  {}{}{}\n", model.category, model.subcategory.empty() ? "" : " / ", model.subcategory);
    fmt::print("  size      {:.3f} × {:.3f} × {:.3f} m\n", model.size.x, model.size.y, model.size.z);
    fmt::print("  geometry  {} vertices, {} triangles, {} parts, quality {} of 3\n", model.vertices, model.triangles,
               model.parts, model.quality);
    if (!tags.empty()) fmt::print("  tags      {}\n", tags);
}

void print_entry(const AttributeEntry& entry) {
    const attributes::AttributeDescription* description = attributes::describe(entry.name);
    std::string value = attributes::to_text(entry.value);
    if (const double* number = std::get_if<double>(&entry.value)) value = short_number(*number);
    if (description != nullptr && !description->unit.empty() && description->unit != "1")
        value += " " + description->unit;
    if (entry.low && entry.high)
        value += fmt::format("  [{} … {}]", short_number(*entry.low), short_number(*entry.high));
    fmt::print("  {} {}\n      {}: {}\n", padded(entry.name, 24), value, attributes::level_name(entry.level),
               entry.source);
}

}  // namespace

int run_show(const ShowArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto model = (*catalog)->model(arguments.model);
    if (!model) return report(model.error());
    const auto attributes = (*catalog)->attributes(model->id);
    if (!attributes) return report(attributes.error());
    if (arguments.json) {
        print_json({{"model", scene::model_to_json(*model)}, {"attributes", attributes::to_json(*attributes)}});
        return exit_ok;
    }
    print_model(*model);
    print_line("");
    for (const AttributeEntry& entry : attributes->entries()) print_entry(entry);
    return exit_ok;
}

}  // namespace embody::cli
