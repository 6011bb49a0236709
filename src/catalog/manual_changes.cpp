// SPDX-License-Identifier: MIT
#include "catalog/manual_changes.h"

#include <algorithm>
#include <ctime>

#include "attributes/assemble.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "catalog/knowledge_json.h"
#include "database/transaction.h"

namespace embody::catalog {
namespace {

using database::ManualAttribute;

/// Attributes by which a model is listed and found.
bool is_listed_by(std::string_view name) { return name == "category" || name == "subcategory" || name == "kind"; }

// Each a valid value of the registry, none named twice; to take back any attribute will do.
Result<void> check_changes(const std::vector<AttributeChange>& changes, const ChangeOptions& options) {
    if (changes.empty() && !options.reset_all) return Error{"attributes", "none is named", "for example mass=12.5"};
    if (!changes.empty() && options.reset_all) {
        return Error{changes.front().name, "is named although all are to be reset", "name attributes or reset all"};
    }
    for (auto one = changes.begin(); one != changes.end(); ++one) {
        if (one->value) {
            if (auto valid = attributes::validate(one->name, *one->value); !valid) return valid;
        } else if (attributes::describe(one->name) == nullptr) {
            return attributes::parse_value(one->name, "").error();
        }
        const auto same_name = [&](const AttributeChange& other) { return other.name == one->name; };
        if (std::any_of(changes.begin(), one, same_name)) return Error{one->name, "is named twice"};
    }
    return {};
}

// The physical kind that the model has once the changes are made.
attributes::PhysicalKind kind_after(const database::ModelRow& model, const std::vector<AttributeChange>& changes) {
    for (const AttributeChange& change : changes) {
        if (change.name == "kind" && change.value)
            return attributes::kind_from_value(*change.value).value_or(attributes::PhysicalKind::rigid);
    }
    return attributes::kind_from_text(model.physical_kind).value_or(attributes::PhysicalKind::rigid);
}

std::string time_text(std::int64_t seconds) {
    const std::time_t time = seconds;
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
    return text;
}

std::optional<attributes::AttributeValue> read_value(const std::optional<std::string>& json) {
    if (!json) return std::nullopt;
    auto value = value_from_json(*json);
    if (!value) return std::nullopt;
    return std::move(*value);
}

std::optional<std::string> value_of(const std::optional<ManualAttribute>& entry) {
    return entry ? std::optional<std::string>(entry->value) : std::nullopt;
}

}  // namespace

/// A change of one value of one model.
struct ManualChanges::Step {
    ChangedModel model;
    std::string name;
    std::optional<ManualAttribute> before, after;
    bool keep_time = false;  ///< `after` has been there before and keeps its time
};

ManualChanges::ManualChanges(database::Connection& connection, std::function<Result<void>(std::int64_t)> list_again)
    : connection_(connection),
      models_(connection),
      manual_(connection),
      audit_(connection),
      list_again_(std::move(list_again)) {}

Result<ChangeReport> ManualChanges::change(const Choose& choose, const std::vector<AttributeChange>& changes,
                                           const ChangeOptions& options, const Author& author,
                                           const std::string& asked) {
    if (auto checked = check_changes(changes, options); !checked) return checked.error();
    auto transaction = database::Transaction::begin(connection_);
    if (!transaction) return transaction.error();
    const auto chosen = choose(models_);
    if (!chosen) return chosen.error();

    // Finds what is to do before anything is done: one refusal may stop it all.
    ChangeReport report;
    report.chosen = chosen->size();
    const bool sets =
        std::any_of(changes.begin(), changes.end(), [](const auto& one) { return one.value.has_value(); });
    report.command = std::string(sets ? "set" : "reset") + (chosen->size() == 1 ? "" : " many");
    std::vector<Step> steps;
    for (const database::ModelRow& model : *chosen) {
        const std::size_t refused_before = report.refused.size();
        auto planned = plan(model, changes, options, report.refused);
        if (!planned) return planned.error();
        if (report.refused.size() > refused_before) continue;
        if (planned->empty()) ++report.unchanged;
        for (Step& step : *planned) {
            if (step.after) step.after->set_by = author.person;
            steps.push_back(std::move(step));
        }
    }
    if (!report.refused.empty() && !options.skip_refused) return report;

    const database::ChangeBatch batch{0, 0, author.person, author.session, report.command, asked, 0, 0};
    if (auto done = carry_out(steps, batch, options, report); !done) return done.error();
    if (options.dry_run || report.batch == 0) return report;
    if (auto committed = transaction->commit(); !committed) return committed.error();
    return report;
}

Result<std::vector<ManualChanges::Step>> ManualChanges::plan(const database::ModelRow& model,
                                                             const std::vector<AttributeChange>& changes,
                                                             const ChangeOptions& options,
                                                             std::vector<RefusedChange>& refused) {
    std::vector<Step> steps;
    const ChangedModel named{model.id, model.key, model.name};
    if (options.reset_all) {
        auto present = manual_.of(model.key);
        if (!present) return present.error();
        for (ManualAttribute& entry : *present) steps.push_back({named, entry.name, std::move(entry), {}, false});
        return steps;
    }
    const attributes::PhysicalKind kind = kind_after(model, changes);
    for (const AttributeChange& change : changes) {
        if (change.value && !attributes::applies_to(change.name, kind)) {
            refused.push_back(
                {model.key, model.name, change.name, "does not concern things of the kind " + to_text(kind)});
            continue;
        }
        auto before = manual_.find(model.key, change.name);
        if (!before) return before.error();
        std::optional<ManualAttribute> after;
        if (change.value) after = ManualAttribute{change.name, to_json(*change.value), {}};
        if (value_of(*before) != value_of(after)) {
            steps.push_back({named, change.name, std::move(*before), std::move(after), false});
        }
    }
    return steps;
}

Result<void> ManualChanges::carry_out(std::vector<Step>& steps, const database::ChangeBatch& batch,
                                      const ChangeOptions& options, ChangeReport& report) {
    // Counted by model, whose steps lie together.
    report.values = steps.size();
    for (const Step& step : steps) {
        if (report.models.empty() || report.models.back().key != step.model.key) report.models.push_back(step.model);
        if (std::find(report.attributes.begin(), report.attributes.end(), step.name) == report.attributes.end())
            report.attributes.push_back(step.name);
    }
    if (options.dry_run || steps.empty()) return {};

    auto begun = audit_.begin_batch(batch);
    if (!begun) return begun.error();
    const bool listed = std::any_of(steps.begin(), steps.end(), [](const Step& s) { return is_listed_by(s.name); });
    std::size_t done = 0;
    for (auto step = steps.begin(); step != steps.end(); ++step) {
        if (auto carried = carry_out(*step, *begun); !carried) return carried;
        const auto next = step + 1;
        if (next != steps.end() && next->model.key == step->model.key) continue;
        if (listed && step->model.id != 0) {
            if (auto again = list_again_(step->model.id); !again) return again;
        }
        if (options.progress && !options.progress(++done, report.models.size())) {
            return Error{report.command, "stopped; nothing was changed"};
        }
    }
    report.batch = *begun;
    return {};
}

Result<void> ManualChanges::carry_out(const Step& step, std::int64_t batch) {
    Result<void> changed;
    if (!step.after) {
        changed = manual_.erase(step.model.key, step.name);
    } else {
        changed =
            step.keep_time ? manual_.restore(step.model.key, *step.after) : manual_.put(step.model.key, *step.after);
    }
    if (!changed) return changed;
    return audit_.add(batch, {0, step.model.key, step.name, step.before, value_of(step.after)});
}

Result<database::ChangeBatch> ManualChanges::meant(std::int64_t batch, const Author& author) {
    const std::string where = connection_.file().string();
    auto found = batch != 0 ? audit_.find_batch(batch) : audit_.last_batch(author.person);
    if (!found) return found.error();
    if (*found) return std::move(**found);
    if (batch != 0) {
        return Error{where, "has no batch " + std::to_string(batch) + " of manual changes",
                     "embody history lists them"};
    }
    return Error{where, "nothing by " + author.person + " is left to undo", "embody history lists what was changed"};
}

Result<ChangeReport> ManualChanges::undo(std::int64_t number, const ChangeOptions& options, const Author& author) {
    auto transaction = database::Transaction::begin(connection_);
    if (!transaction) return transaction.error();
    auto named = meant(number, author);
    if (!named) return named.error();

    // An undo of an undo repeats what that one reverted, an undo of a redo reverts it again.
    database::ChangeBatch target = *named;
    if (named->undoes != 0) {
        auto found = audit_.find_batch(named->undoes);
        if (!found) return found.error();
        if (*found) target = std::move(**found);
    }
    const bool again = named->command == "undo";
    const bool is_undone = target.undone_by != 0;
    if (again != is_undone) {
        const std::string what = "batch " + std::to_string(named->id);
        if (again) return Error{what, "what it took back was done again already"};
        return Error{what, "was undone already, by batch " + std::to_string(target.undone_by),
                     "embody undo " + std::to_string(target.undone_by) + " does it again"};
    }

    ChangeReport report;
    report.command = again ? "redo" : "undo";
    auto steps = plan_undo(target, again, report);
    if (!steps) return steps.error();
    if (!report.refused.empty()) return report;
    const database::ChangeBatch batch{0, 0, author.person, author.session, report.command, target.asked, target.id, 0};
    if (auto done = carry_out(*steps, batch, options, report); !done) return done.error();
    if (options.dry_run || report.batch == 0) return report;
    if (auto marked = audit_.mark_undone(target.id, again ? 0 : report.batch); !marked) return marked.error();
    if (auto committed = transaction->commit(); !committed) return committed.error();
    return report;
}

Result<std::vector<ManualChanges::Step>> ManualChanges::plan_undo(const database::ChangeBatch& target, bool again,
                                                                  ChangeReport& report) {
    const auto changes = audit_.changes_of(target.id);
    if (!changes) return changes.error();
    std::vector<Step> steps;
    for (const database::ManualChange& change : *changes) {
        const auto model = models_.find_key(change.model_key);
        if (!model) return model.error();
        ChangedModel named{0, change.model_key, change.model_key};
        if (*model) named = {(*model)->id, (*model)->key, (*model)->name};
        if (report.models.empty() || report.models.back().key != named.key) report.models.push_back(named);

        // Only what this batch left, or what it found, may go.
        const auto later = audit_.changed_since(change);
        if (!later) return later.error();
        auto present = manual_.find(change.model_key, change.name);
        if (!present) return present.error();
        const std::optional<std::string> expected = again ? value_of(change.before) : change.value;
        if (*later || value_of(*present) != expected) {
            const std::string who = *later ? "by " + (*later)->person + " in batch " + std::to_string((*later)->id) +
                                                 " on " + time_text((*later)->made_at)
                                           : "by taking back an earlier batch";
            report.refused.push_back({change.model_key, named.name, change.name, "was changed since, " + who});
            continue;
        }
        std::optional<ManualAttribute> after = change.before;
        if (again) {
            after.reset();
            if (change.value) after = ManualAttribute{change.name, *change.value, target.person, target.made_at};
        }
        steps.push_back({std::move(named), change.name, std::move(*present), std::move(after), true});
    }
    report.chosen = report.models.size();
    report.models.clear();
    return steps;
}

Result<std::vector<ChangeRecord>> ManualChanges::history(const HistoryQuery& query) {
    const auto found = audit_.search({.model_key = query.model_key,
                                      .since = query.since,
                                      .batch = query.batch,
                                      .limit = std::clamp(query.limit, 1, 1'000'000)});
    if (!found) return found.error();
    std::vector<ChangeRecord> records;
    records.reserve(found->size());
    for (const database::RecordedChange& row : *found) {
        ChangeRecord record;
        record.batch = row.batch.id;
        record.made_at = row.batch.made_at;
        record.author = {row.batch.person, row.batch.session};
        record.command = row.batch.command;
        record.asked = row.batch.asked;
        record.undoes = row.batch.undoes;
        record.undone_by = row.batch.undone_by;
        record.model_key = row.change.model_key;
        record.model_name = row.model_name;
        record.attribute = row.change.name;
        record.before = read_value(value_of(row.change.before));
        record.after = read_value(row.change.value);
        records.push_back(std::move(record));
    }
    return records;
}

Result<std::vector<ChangeBatchRecord>> ManualChanges::batches(const BatchQuery& query) {
    const auto found = audit_.batches({.model_key = query.model_key,
                                       .since = query.since,
                                       .after = query.after,
                                       .before = query.before,
                                       .limit = std::clamp(query.limit, 1, 1'000'000)});
    if (!found) return found.error();
    std::vector<ChangeBatchRecord> batches;
    for (const database::CountedBatch& row : *found) {
        auto first = history({.model_key = query.model_key, .batch = row.batch.id, .limit = query.changes});
        if (!first) return first.error();
        batches.push_back(
            {static_cast<std::size_t>(row.values), static_cast<std::size_t>(row.models), std::move(*first)});
    }
    return batches;
}

}  // namespace embody::catalog
