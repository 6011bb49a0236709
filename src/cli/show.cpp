// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "attributes/attribute_json.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "geometry/decomposition/decomposition.h"
#include "scene/session/model_json.h"

namespace embody::cli {
namespace {

using attributes::AttributeEntry;

void print_model(const catalog::ModelSummary& model) {
    std::string tags;
    for (const std::string& tag : model.tags) tags += (tags.empty() ? "" : ", ") + tag;
    print_text("{}  (id {}, key {})\n", model.name, model.id, model.key);
    print_text("  from      {}, by {}, licence {}\n", model.source, model.author.empty() ? "unknown" : model.author,
               model.licence.empty() ? "unknown" : model.licence);
    print_text("  category  {}{}{}\n", model.category, model.subcategory.empty() ? "" : " / ", model.subcategory);
    print_text("  size      {:.3f} × {:.3f} × {:.3f} m\n", model.size.x, model.size.y, model.size.z);
    print_text("  geometry  {} vertices, {} triangles, {} parts, quality {} of 3\n", model.vertices, model.triangles,
               model.parts, model.quality);
    if (!tags.empty()) print_text("  tags      {}\n", tags);
}

void print_entry(const AttributeEntry& entry) {
    const attributes::AttributeDescription* description = attributes::describe(entry.name);
    std::string value = attributes::to_text(entry.value);
    if (const double* number = std::get_if<double>(&entry.value)) value = short_number(*number);
    if (description != nullptr && !description->unit.empty() && description->unit != "1")
        value += " " + description->unit;
    if (entry.low && entry.high)
        value += fmt::format("  [{} … {}]", short_number(*entry.low), short_number(*entry.high));
    print_text("  {} {}\n      {}: {}\n", padded(entry.name, 24), value, attributes::level_name(entry.level),
               entry.source);
}

// The convex parts that the model collides by; none where something else is its collision shape. Computed now where the
// import has not done so.
Result<std::optional<catalog::ConvexParts>> collision_parts(const catalog::Catalog& catalog, std::int64_t id,
                                                            const attributes::AttributeSet& set) {
    if (set.word("collision_shape", "") != "decomposition") return std::optional<catalog::ConvexParts>();
    const geometry::DecompositionParameters usual;
    auto parts = catalog.convex_parts(id, static_cast<int>(set.number("max_hulls", usual.max_hulls)),
                                      set.number("hull_error", usual.hull_error));
    if (!parts) return parts.error();
    return std::optional<catalog::ConvexParts>(std::move(*parts));
}

void print_parts(const catalog::ConvexParts& parts) {
    print_text(
        "  collides  as {} convex part{}; the deepest hollow that they fill is {:.1f} mm, of one hull {:.1f} mm\n",
        parts.hulls.size(), parts.hulls.size() == 1 ? "" : "s", 1e3 * parts.concavity, 1e3 * parts.hull_concavity);
}

// The tetrahedra that a soft model is simulated with, or the reason why it cannot be soft. Computed now where the
// import has not done so.
std::optional<Result<catalog::SoftMesh>> soft_mesh(const catalog::Catalog& catalog, std::int64_t id,
                                                   const attributes::AttributeSet& set) {
    if (matter_of(set) != attributes::Matter::solid) return std::nullopt;
    return catalog.soft_mesh(id);
}

void print_soft_mesh(const Result<catalog::SoftMesh>& soft) {
    if (!soft) {
        print_text("  soft      no, simulated as rigid: {}\n", soft.error().why);
        return;
    }
    print_text("  soft      as {} tetrahedra of cells of {:.1f} mm, which hold {:.0f} % of its volume\n",
               soft->mesh.tetrahedra.size(), 1e3 * soft->cell, 100 * soft->volume_fraction);
}

nlohmann::json soft_mesh_json(const std::optional<Result<catalog::SoftMesh>>& soft) {
    if (!soft) return nullptr;
    if (!*soft) return {{"problem", soft->error().why}};
    return {{"tetrahedra", (*soft)->mesh.tetrahedra.size()},
            {"nodes", (*soft)->mesh.nodes.size()},
            {"cell", (*soft)->cell},
            {"volume_share", (*soft)->volume_fraction},
            {"left_out", (*soft)->left_out}};
}

nlohmann::json parts_json(const std::optional<catalog::ConvexParts>& parts) {
    if (!parts) return nullptr;
    return {{"parts", parts->hulls.size()},
            {"concavity", parts->concavity},
            {"hull_concavity", parts->hull_concavity},
            {"max_hulls", parts->max_hulls},
            {"hull_error", parts->hull_error}};
}

}  // namespace

int run_show(const ShowArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto model = (*catalog)->model(arguments.model);
    if (!model) return report(model.error());
    const auto attributes = (*catalog)->attributes(model->id);
    if (!attributes) return report(attributes.error());
    const auto parts = collision_parts(**catalog, model->id, *attributes);
    if (!parts) return report(parts.error());
    const auto soft = soft_mesh(**catalog, model->id, *attributes);
    if (arguments.json) {
        print_json({{"model", scene::model_to_json(*model)},
                    {"attributes", attributes::to_json(*attributes)},
                    {"decomposition", parts_json(*parts)},
                    {"soft_mesh", soft_mesh_json(soft)}});
        return exit_ok;
    }
    print_model(*model);
    if (*parts) print_parts(**parts);
    if (soft) print_soft_mesh(*soft);
    print_line("");
    for (const AttributeEntry& entry : attributes->entries()) print_entry(entry);
    return exit_ok;
}

}  // namespace embody::cli
