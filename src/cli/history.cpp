// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <charconv>
#include <ctime>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/registry.h"
#include "cli/change_report.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using catalog::ChangeRecord;

constexpr std::int64_t day_seconds = 86400;

std::string time_text(std::int64_t seconds, const char* form) {
    const std::time_t time = seconds;
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[32];
    std::strftime(text, sizeof text, form, &utc);
    return text;
}

// A date "2026-11-22", a time "2026-11-22T14:30" (UTC), or a number of days or hours ago: "7d", "2h".
Result<std::int64_t> read_since(const std::string& text) {
    if (text.empty()) return std::int64_t{0};
    for (const char* form : {"%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M", "%Y-%m-%d"}) {
        std::tm utc{};
        const char* end = strptime(text.c_str(), form, &utc);
        if (end != nullptr && *end == '\0') return static_cast<std::int64_t>(timegm(&utc));
    }
    std::int64_t count = 0;
    const auto [unit, problem] = std::from_chars(text.data(), text.data() + text.size(), count);
    const bool one_letter = unit + 1 == text.data() + text.size();
    if (problem == std::errc() && one_letter && (*unit == 'd' || *unit == 'h') && count >= 0 && count < 100'000) {
        return static_cast<std::int64_t>(std::time(nullptr)) - count * (*unit == 'd' ? day_seconds : 3600);
    }
    return Error{"--since", "\"" + text + "\" is no time", "for example 2026-11-22, 2026-11-22T14:30 (UTC), 7d or 2h"};
}

std::string value_text(const std::optional<attributes::AttributeValue>& value) {
    if (!value) return "automatic";
    if (const double* number = std::get_if<double>(&*value)) return short_number(*number);
    return attributes::to_text(*value);
}

nlohmann::json to_json(const ChangeRecord& record) {
    const auto value = [](const std::optional<attributes::AttributeValue>& held) {
        return held ? attributes::to_json(*held) : nlohmann::json(nullptr);
    };
    const auto number = [](std::int64_t held) { return held != 0 ? nlohmann::json(held) : nlohmann::json(nullptr); };
    return {{"batch", record.batch},           {"time", time_text(record.made_at, "%Y-%m-%dT%H:%M:%SZ")},
            {"person", record.author.person},  {"session", record.author.session},
            {"command", record.command},       {"asked", record.asked},
            {"undoes", number(record.undoes)}, {"undone_by", number(record.undone_by)},
            {"key", record.model_key},         {"name", record.model_name},
            {"attribute", record.attribute},   {"before", value(record.before)},
            {"after", value(record.after)}};
}

void print_batch(const ChangeRecord& record) {
    std::string what = record.command;
    if (record.undoes != 0) what += " of batch " + std::to_string(record.undoes);
    if (!record.asked.empty()) what += ", " + record.asked;
    if (record.undone_by != 0) what += fmt::format(" (undone by batch {})", record.undone_by);
    print_text("batch {}  {}  {}{}  {}\n", record.batch, time_text(record.made_at, "%Y-%m-%d %H:%M:%S UTC"),
               record.author.person, record.author.session.empty() ? "" : " (" + record.author.session + ")", what);
}

}  // namespace

int run_history(const HistoryArguments& arguments) {
    const auto since = read_since(arguments.since);
    if (!since) return report(since.error());
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    catalog::HistoryQuery query{.since = *since, .batch = arguments.batch, .limit = arguments.limit};
    // A model that was removed still has its history under its key.
    if (!arguments.model.empty()) {
        const auto model = (*catalog)->model(arguments.model);
        query.model_key = model ? model->key : arguments.model;
    }
    const auto records = (*catalog)->history(query);
    if (!records) return report(records.error());
    if (arguments.json) {
        nlohmann::json changes = nlohmann::json::array();
        for (const ChangeRecord& record : *records) changes.push_back(to_json(record));
        print_json({{"changes", std::move(changes)}});
        return exit_ok;
    }
    if (records->empty()) print_line("Nothing was changed by hand.");
    std::int64_t batch = 0;
    for (const ChangeRecord& record : *records) {
        if (record.batch != batch) print_batch(record);
        batch = record.batch;
        const std::string& name = record.model_name.empty() ? record.model_key : record.model_name;
        print_text("  {}  {}  {} → {}\n", padded(name, 36), padded(record.attribute, 20), value_text(record.before),
                   value_text(record.after));
    }
    return exit_ok;
}

int run_undo(const UndoArguments& arguments) {
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    catalog::ChangeOptions options = watched_change("Undoing");
    options.dry_run = arguments.dry_run;
    return print_changes((*catalog)->undo_changes(arguments.batch, options), arguments.dry_run, arguments.json);
}

}  // namespace embody::cli
