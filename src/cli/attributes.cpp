// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/registry.h"
#include "cli/commands.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using attributes::AttributeDescription;

std::string range_text(const AttributeDescription& description) {
    const auto bound = [](const std::optional<double>& value, const char* open) {
        return value ? short_number(*value) : std::string(open);
    };
    if (!description.low && !description.high) return "";
    return bound(description.low, "-∞") + " … " + bound(description.high, "∞");
}

std::string choices_text(const AttributeDescription& description) {
    std::string text;
    for (const std::string& choice : description.choices) text += (text.empty() ? "" : ", ") + choice;
    return text;
}

std::string unit_text(const AttributeDescription& description) {
    return description.unit == "1" ? "" : description.unit;
}

std::string default_text(const AttributeDescription& description) {
    const bool is_computed =
        description.type == attributes::ValueType::vector || description.type == attributes::ValueType::tensor;
    if (is_computed) return "computed";
    if (const double* number = std::get_if<double>(&description.standard)) return short_number(*number);
    return attributes::to_text(description.standard);
}

// The kinds whose letters `applies_to` of the description holds.
std::string kinds_text(const AttributeDescription& description) {
    if (description.applies_to == attributes::every_kind.data()) return "all";
    std::string text;
    for (const attributes::PhysicalKind kind : attributes::physical_kinds)
        if (applies_to(description, kind)) text += (text.empty() ? "" : ", ") + to_text(kind);
    return text;
}

void print_row(const AttributeDescription& description) {
    const std::string range = description.choices.empty() ? range_text(description) : choices_text(description);
    print_text("{} {} {} {}\n", padded(description.name, 24), padded(unit_text(description), 7),
               padded(default_text(description), 14), range);
}

void print_description(const AttributeDescription& description) {
    print_text("{}: {}\n  {}\n", description.name, description.label, description.help);
    const auto line = [](const char* what, const std::string& text) {
        if (!text.empty()) print_text("  {} {}\n", padded(what, 10), text);
    };
    line("group", description.kind);
    line("unit", description.unit == "1" ? "1 (a pure number)" : description.unit);
    line("default", default_text(description));
    line("range", range_text(description));
    line("choices", choices_text(description));
    line("of", kinds_text(description));
}

void print_markdown() {
    std::string group;
    for (const AttributeDescription& description : attributes::registry()) {
        if (description.kind != group) {
            group = description.kind;
            print_text("\n### {}\n\n| name | unit | default | range or choices | kinds | what it is |\n", group);
            print_line("|---|---|---|---|---|---|");
        }
        const std::string range = description.choices.empty() ? range_text(description) : choices_text(description);
        print_text("| `{}` | {} | {} | {} | {} | {}: {} |\n", description.name, unit_text(description),
                   default_text(description), range, kinds_text(description), description.label, description.help);
    }
}

}  // namespace

int run_attributes(const AttributesArguments& arguments) {
    if (arguments.json) {
        print_json(attributes::registry_to_json());
        return exit_ok;
    }
    if (arguments.markdown) {
        print_markdown();
        return exit_ok;
    }
    if (!arguments.name.empty()) {
        const AttributeDescription* description = attributes::describe(arguments.name);
        if (description == nullptr) return report(attributes::validate(arguments.name, 0.0).error());
        print_description(*description);
        return exit_ok;
    }
    print_text("{} {} {} {}\n", padded("name", 24), padded("unit", 7), padded("default", 14), "range or choices");
    for (const AttributeDescription& description : attributes::registry()) print_row(description);
    print_text("\nMore of one: embody attributes NAME\n");
    return exit_ok;
}

}  // namespace embody::cli
