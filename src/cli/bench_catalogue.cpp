// SPDX-License-Identifier: MIT
#include "cli/bench_catalogue.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/catalogue_variants.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

constexpr std::uint64_t seed = 60'000;

double milliseconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Resident set of this process, MB. `key`: of /proc/self/status.
double resident_megabytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(key + ":")) return std::atof(line.c_str() + key.size() + 1) / 1024;
    }
    return 0;
}

struct Timed {
    std::string what;
    std::vector<double> milliseconds;
    std::string worst;
};

std::string text_of(const catalog::SearchQuery& query) {
    return fmt::format("\"{}\"{}{}", query.words, query.category.empty() ? "" : " in " + query.category,
                       query.offset > 0 ? fmt::format(" from {}", query.offset) : "");
}

Result<Timed> time_queries(const catalog::Catalog& catalog, const std::vector<catalog::SearchQuery>& queries) {
    // The best of three runs, because other programs take time, too.
    Timed timed{"search", {}, {}};
    double worst = 0;
    for (const catalog::SearchQuery& query : queries) {
        double best = 1e9;
        std::optional<Error> problem;
        for (int round = 0; round < 3; ++round) {
            best = std::min(best, milliseconds_of([&] {
                                const auto page = catalog.search(query);
                                if (!page) problem = page.error();
                            }));
        }
        if (problem) return *problem;
        timed.milliseconds.push_back(best);
        if (best > worst) timed.worst = text_of(query);
        worst = std::max(worst, best);
    }
    return timed;
}

Result<Timed> time_scrolling(const catalog::Catalog& catalog) {
    // A browser that scrolls from the first model to the last asks for these rows and pictures.
    Timed timed{"scroll a page of 60, with pictures", {}, {}};
    for (catalog::SearchQuery query{.limit = 60};; query.offset += query.limit) {
        std::optional<Error> problem;
        std::int64_t total = 0;
        timed.milliseconds.push_back(milliseconds_of([&] {
            const auto page = catalog.search(query);
            if (!page) {
                problem = page.error();
                return;
            }
            total = page->total;
            for (const catalog::ModelSummary& model : page->models) {
                if (const auto picture = catalog.thumbnail(model.id); !picture) problem = picture.error();
            }
        }));
        if (problem) return *problem;
        if (query.offset + query.limit >= total) return timed;
    }
}

Result<Timed> time_categories(const catalog::Catalog& catalog) {
    Timed timed{"list of categories", {}, {}};
    std::optional<Error> problem;
    for (int round = 0; round < 20; ++round) {
        timed.milliseconds.push_back(milliseconds_of([&] {
            if (const auto categories = catalog.categories(); !categories) problem = categories.error();
        }));
    }
    if (problem) return *problem;
    return timed;
}

nlohmann::json to_json(Timed timed) {
    std::sort(timed.milliseconds.begin(), timed.milliseconds.end());
    return {{"what", timed.what},
            {"count", timed.milliseconds.size()},
            {"median_ms", timed.milliseconds[timed.milliseconds.size() / 2]},
            {"p95_ms", timed.milliseconds[timed.milliseconds.size() * 95 / 100]},
            {"worst_ms", timed.milliseconds.back()},
            {"worst", timed.worst}};
}

}  // namespace

int run_catalogue_bench(const BenchArguments& arguments) {
    if (arguments.models > 0 && arguments.database == catalog::Catalog::default_file())
        return report({"bench catalogue", "the database of your own models would be filled with variants",
                       "name another one: embody bench catalogue --models 60000 --database FILE"});
    Result<std::unique_ptr<catalog::Catalog>> catalog = Error{};
    std::vector<Timed> rows;
    rows.push_back({"open the database", {milliseconds_of([&] { catalog = open_catalog(arguments.database); })}, {}});
    if (!catalog) return report(catalog.error());

    // Fill the database.
    const std::int64_t before = (*catalog)->model_count();
    ProgressBar bar("Adding variants");
    std::optional<Error> problem;
    const double filling = milliseconds_of([&] {
        const auto added = add_seeded_variants(**catalog, arguments.models, seed, [&](std::int64_t done) {
            bar.show(static_cast<std::size_t>(done), static_cast<std::size_t>(arguments.models), {});
        });
        if (!added) problem = added.error();
    });
    bar.finish();
    if (problem) return report(*problem);
    const std::int64_t count = (*catalog)->model_count();

    // Open it on a new connection, as a server does at its start.
    rows.push_back({"open it again", {milliseconds_of([&] { catalog = open_catalog(arguments.database); })}, {}});
    if (!catalog) return report(catalog.error());
    const double at_start = resident_megabytes("VmRSS");
    const auto some = (*catalog)->search({.limit = 1000});
    if (!some) return report(some.error());
    const auto categories = (*catalog)->categories();
    if (!categories) return report(categories.error());
    auto searched = time_queries(**catalog, seeded_queries(some->models, *categories, seed));
    if (!searched) return report(searched.error());
    rows.push_back(std::move(*searched));
    auto listed = time_categories(**catalog);
    if (!listed) return report(listed.error());
    rows.push_back(std::move(*listed));
    auto scrolled = time_scrolling(**catalog);
    if (!scrolled) return report(scrolled.error());
    rows.push_back(std::move(*scrolled));

    nlohmann::json table = nlohmann::json::array();
    for (const Timed& row : rows) table.push_back(to_json(row));
    const double peak = resident_megabytes("VmHWM");
    if (arguments.json) {
        print_json({{"suite", arguments.suite},
                    {"models", count},
                    {"added", count - before},
                    {"added_per_second", static_cast<double>(count - before) * 1e3 / filling},
                    {"resident_mb_at_start", at_start},
                    {"resident_mb_at_end", resident_megabytes("VmRSS")},
                    {"resident_mb_most", peak},
                    {"rows", table}});
        return exit_ok;
    }
    print_text("{} models", count);
    if (count > before) print_text("; {} variants added in {:.1f} s", count - before, filling / 1e3);
    print_text("\n{} {:>6} {:>10} {:>10} {:>10}   worst\n", padded("milliseconds", 36), "count", "median", "95 %",
               "worst");
    for (const nlohmann::json& row : table) {
        print_text("{} {:>6} {:>10.2f} {:>10.2f} {:>10.2f}   {}\n", padded(row["what"].get<std::string>(), 36),
                   row["count"].get<std::size_t>(), row["median_ms"].get<double>(), row["p95_ms"].get<double>(),
                   row["worst_ms"].get<double>(), row["worst"].get<std::string>());
    }
    print_text("resident memory: {:.0f} MB at the start, {:.0f} MB at the end, {:.0f} MB at most\n", at_start,
               resident_megabytes("VmRSS"), peak);
    return exit_ok;
}

}  // namespace embody::cli
