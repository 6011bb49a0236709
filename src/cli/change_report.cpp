// SPDX-License-Identifier: MIT
#include "cli/change_report.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/arguments.h"
#include "cli/interrupt.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using catalog::ChangedModel;
using catalog::ChangeReport;
using catalog::RefusedChange;

constexpr std::size_t most_listed = 100;

nlohmann::json to_json(const ChangeReport& report, bool dry_run) {
    nlohmann::json models = nlohmann::json::array();
    for (const ChangedModel& model : report.models) models.push_back({{"key", model.key}, {"name", model.name}});
    nlohmann::json refused = nlohmann::json::array();
    for (const RefusedChange& one : report.refused)
        refused.push_back({{"key", one.key}, {"name", one.name}, {"attribute", one.attribute}, {"why", one.why}});
    return {{"batch", report.batch != 0 ? nlohmann::json(report.batch) : nlohmann::json(nullptr)},
            {"command", report.command},
            {"dry_run", dry_run},
            {"chosen", report.chosen},
            {"changed", report.models.size()},
            {"values", report.values},
            {"unchanged", report.unchanged},
            {"models", std::move(models)},
            {"refused", std::move(refused)}};
}

void print_refused(const ChangeReport& report) {
    for (std::size_t i = 0; i < report.refused.size() && i < most_listed; ++i) {
        const RefusedChange& one = report.refused[i];
        print_error("embody: {} ({}): {} {}\n", one.name, one.key, one.attribute, one.why);
    }
    if (report.refused.size() > most_listed) print_error("embody: and {} more\n", report.refused.size() - most_listed);
}

void print_report(const ChangeReport& report, bool dry_run) {
    if (dry_run) {
        for (std::size_t i = 0; i < report.models.size() && i < most_listed; ++i)
            print_text("  {}  {}\n", padded(report.models[i].name, 36), report.models[i].key);
        if (report.models.size() > most_listed)
            print_text("  and {} more; --json lists all\n", report.models.size() - most_listed);
    }
    // To the reader "set many" and "set" are the same command.
    const std::string act = report.command.substr(0, report.command.find(' '));
    print_text("{}{}: {} of {} models, {} values", dry_run ? "Would " : "", act, report.models.size(), report.chosen,
               report.values);
    if (report.unchanged > 0) print_text("; {} are so already", report.unchanged);
    if (!report.refused.empty()) print_text("; {} refused", report.refused.size());
    if (report.batch != 0) print_text("; batch {}, take it back with: embody undo {}", report.batch, report.batch);
    print_text("\n");
}

}  // namespace

catalog::ChangeOptions watched_change(const char* title) {
    watch_interrupts();
    catalog::ChangeOptions options;
    options.progress = [bar = std::make_shared<ProgressBar>(title)](std::size_t done, std::size_t total) {
        // For one model a bar would be gone before anybody could read it.
        if (total > 1) bar->show(done, total, "");
        if (done == total) bar->finish();
        return !interrupted();
    };
    return options;
}

int print_changes(const Result<catalog::ChangeReport>& result, bool dry_run, bool json) {
    if (!result) return report(result.error());
    print_refused(*result);
    if (json) print_json(to_json(*result, dry_run));
    // Without a batch nothing was changed: it was a dry run, or all models had the value already, or some refused.
    const bool stopped = !result->refused.empty() && result->models.empty();
    if (stopped) {
        print_error("embody: nothing was changed: {} of {} models refuse\n", result->refused.size(), result->chosen);
        return exit_failed;
    }
    if (!json) print_report(*result, dry_run);
    return result->refused.empty() ? exit_ok : exit_partly;
}

}  // namespace embody::cli
