// SPDX-License-Identifier: MIT
#include "attributes/registry.h"
#include "cli/change_report.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using catalog::AttributeChange;

Result<AttributeChange> parse_assignment(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) return Error{assignment, "is not name=value", "for example mass=12.5"};
    const std::string name = assignment.substr(0, equals);
    auto value = attributes::parse_value(name, assignment.substr(equals + 1));
    if (!value) return value.error();
    return AttributeChange{name, std::move(*value)};
}

// The first word after the command names the model, unless many are chosen.
Result<catalog::Catalog::ModelChoice> chosen_models(const catalog::Catalog& catalog, const ManyArguments& many,
                                                    std::vector<std::string>& words) {
    if (many.are_chosen()) {
        if (many.all && !(many.query.empty() && many.category.empty()))
            return Error{"--all", "means every model, and --query or --category only some", "leave one of them out"};
        return catalog::Catalog::ModelChoice(catalog::SearchQuery{.words = many.query, .category = many.category});
    }
    if (words.empty()) return Error{"models", "none is named", "name one, or choose with --query, --category or --all"};
    const auto model = catalog.model(words.front());
    if (!model) return model.error();
    words.erase(words.begin());
    return catalog::Catalog::ModelChoice(std::vector{model->id});
}

// Prints one model after its change as `embody show` does; for many models prints their number.
int change(const std::filesystem::path& database, const ManyArguments& many, std::vector<std::string> words, bool json,
           const std::function<Result<std::vector<AttributeChange>>(const std::vector<std::string>&)>& read) {
    auto catalog = open_catalog(database);
    if (!catalog) return report(catalog.error());
    const auto models = chosen_models(**catalog, many, words);
    if (!models) return report(models.error());
    // All changes are read before the first is written: a mistake in the last one changes nothing.
    const auto changes = read(words);
    if (!changes) return report(changes.error());

    catalog::ChangeOptions options = watched_change("Changing");
    options.reset_all = changes->empty();
    options.dry_run = many.dry_run;
    options.skip_refused = many.skip;
    const auto result = (*catalog)->change_attributes(*models, *changes, options);
    if (many.are_chosen() || many.dry_run || !result || !result->refused.empty())
        return print_changes(result, many.dry_run, json);
    return run_show({database, std::to_string(std::get<std::vector<std::int64_t>>(*models).front()), json});
}

}  // namespace

int run_set(const SetArguments& arguments) {
    const auto read = [](const std::vector<std::string>& words) -> Result<std::vector<AttributeChange>> {
        if (words.empty()) return Error{"attributes", "none is named", "for example mass=12.5"};
        std::vector<AttributeChange> changes;
        for (const std::string& word : words) {
            auto change = parse_assignment(word);
            if (!change) return change.error();
            changes.push_back(std::move(*change));
        }
        return changes;
    };
    return change(arguments.database, arguments.many, arguments.words, arguments.json, read);
}

int run_reset(const ResetArguments& arguments) {
    const auto read = [](const std::vector<std::string>& words) -> Result<std::vector<AttributeChange>> {
        std::vector<AttributeChange> changes;
        for (const std::string& word : words) changes.push_back({word});
        return changes;
    };
    return change(arguments.database, arguments.many, arguments.words, arguments.json, read);
}

}  // namespace embody::cli
