// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "attributes/registry.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

/// The model after the change, as `embody show` prints it.
int show(const std::filesystem::path& database, const std::string& model, bool json) {
    return run_show({database, model, json});
}

struct Change {
    std::string name;
    attributes::AttributeValue value;
};
Result<Change> parse_assignment(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) return Error{assignment, "is not name=value", "for example mass=12.5"};
    const std::string name = assignment.substr(0, equals);
    auto value = attributes::parse_value(name, assignment.substr(equals + 1));
    if (!value) return value.error();
    return Change{name, std::move(*value)};
}

}  // namespace

int run_set(const SetArguments& arguments) {
    // All are read before the first is written: a slip in the last one changes nothing.
    std::vector<Change> changes;
    for (const std::string& assignment : arguments.assignments) {
        auto change = parse_assignment(assignment);
        if (!change) return report(change.error());
        changes.push_back(std::move(*change));
    }
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto model = (*catalog)->model(arguments.model);
    if (!model) return report(model.error());
    for (const Change& change : changes) {
        if (auto set = (*catalog)->set_attribute(model->id, change.name, change.value); !set)
            return report(set.error());
    }
    return show(arguments.database, model->key, arguments.json);
}

int run_reset(const ResetArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto model = (*catalog)->model(arguments.model);
    if (!model) return report(model.error());
    std::vector<std::string> names = arguments.names;
    if (names.empty()) {
        const auto present = (*catalog)->attributes(model->id);
        if (!present) return report(present.error());
        for (const attributes::AttributeEntry& entry : present->entries())
            if (entry.level == attributes::AttributeLevel::manual) names.push_back(entry.name);
    }
    for (const std::string& name : names) {
        if (auto reset = (*catalog)->reset_attribute(model->id, name); !reset) return report(reset.error());
    }
    return show(arguments.database, model->key, arguments.json);
}

}  // namespace embody::cli
