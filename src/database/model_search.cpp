// SPDX-License-Identifier: MIT
#include "database/model_table.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "database/search_words.h"

namespace embody::database {
namespace {

#define EMBODY_MODEL_COLUMNS                                                                             \
    "model.id, key, name, source, licence, author, category, subcategory, physical_kind, tags, size_x, " \
    "size_y, size_z, geometry_kind, vertices, triangles, parts, materials, images, quality, file_hash, " \
    "geometry_hash"

std::vector<std::string> split_lines(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        if (end > start) lines.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return lines;
}

// In the order of EMBODY_MODEL_COLUMNS.
ModelRow read_row(const Statement& statement) {
    int column = 0;
    const auto count = [&] { return static_cast<std::uint32_t>(statement.integer(column++)); };
    ModelRow row;
    row.id = statement.integer(column++);
    for (std::string* text : {&row.key, &row.name, &row.source, &row.licence, &row.author, &row.category,
                              &row.subcategory, &row.physical_kind}) {
        *text = statement.text(column++);
    }
    row.tags = split_lines(statement.text(column++));
    for (double& length : row.size) length = statement.real(column++);
    row.geometry_kind = statement.text(column++);
    for (std::uint32_t* number : {&row.vertices, &row.triangles, &row.parts, &row.materials, &row.images}) {
        *number = count();
    }
    row.quality = static_cast<int>(statement.integer(column++));
    row.file_hash = statement.bits(column++);
    row.geometry_hash = statement.bits(column++);
    return row;
}

// Above this many matches the order is by name instead of BM25, which would read the lengths of all that match (2 µs
// each).
constexpr std::size_t max_ranked = 1500;

// How well a name matches the words, best first; models that match only by tags and the like come last.
enum NameFit : std::uint8_t { is_the_words, has_the_words, has_their_beginnings, elsewhere };
constexpr std::size_t name_fits = 4;

// Ids in ascending order, with their fits beside them.
struct BroadMatches {
    std::vector<std::int64_t> ids;
    std::vector<std::uint8_t> fits;

    [[nodiscard]] std::optional<std::size_t> position(std::int64_t id) const {
        // Often all of a row of ids match.
        if (ids.empty() || id < ids.front() || id > ids.back()) return {};
        if (ids.back() - ids.front() + 1 == static_cast<std::int64_t>(ids.size()))
            return static_cast<std::size_t>(id - ids.front());
        const auto at = std::lower_bound(ids.begin(), ids.end(), id);
        if (*at != id) return {};
        return static_cast<std::size_t>(at - ids.begin());
    }
    void note(std::int64_t id, NameFit fit) {
        if (const auto at = position(id)) fits[*at] = std::min<std::uint8_t>(fits[*at], fit);
    }
};

Result<std::vector<std::int64_t>> read_ids(Statement& statement) {
    std::vector<std::int64_t> ids;
    while (true) {
        const auto row = statement.step();
        if (!row) return row.error();
        if (!*row) return ids;
        ids.push_back(statement.integer(0));
    }
}

bool names_no_words(const ModelSearch& search) {
    return search.words.find_first_not_of(" \t\r\n") == std::string::npos;
}

std::string_view without_outer_spaces(std::string_view text) {
    constexpr std::string_view spaces = " \t\r\n";
    text.remove_prefix(std::min(text.find_first_not_of(spaces), text.size()));
    return text.substr(0, text.find_last_not_of(spaces) + 1);
}

}  // namespace

Result<ModelMatches> ModelTable::search(const ModelSearch& search) {
    // Words without a letter or digit match nothing; no words match all.
    if (names_no_words(search)) return search_without_words(search);
    const MatchExpressions expressions = match_expressions(search.words);
    if (expressions.ranked.empty()) return ModelMatches{};

    // All matches, by the index alone, and of these those of the category.
    auto ids = ids_that_match(expressions.anywhere);
    if (!ids) return ids.error();
    const bool broad = ids->size() > max_ranked;
    if (!search.category.empty()) {
        auto narrowed = ids_in_category(*ids, search.category);
        if (!narrowed) return narrowed.error();
        *ids = std::move(*narrowed);
    }
    ModelMatches matches;
    matches.total = static_cast<std::int64_t>(ids->size());
    if (matches.total <= search.offset) return matches;

    // The best of few, or the first of many.
    auto page = broad ? broad_page(expressions, std::move(*ids), search) : ranked_page(expressions.ranked, search);
    if (!page) return page.error();
    for (const std::int64_t id : *page) {
        auto model = find(id);
        if (!model) return model.error();
        if (*model) matches.models.push_back(std::move(**model));
    }
    return matches;
}

Result<ModelMatches> ModelTable::search_without_words(const ModelSearch& search) {
    const bool all = search.category.empty();
    auto total =
        connection_.prepare(all ? "SELECT count(*) FROM model" : "SELECT count(*) FROM model WHERE category = ?");
    auto page = connection_.prepare(
        all ? "SELECT " EMBODY_MODEL_COLUMNS " FROM model ORDER BY name COLLATE NOCASE, id LIMIT ? OFFSET ?"
            : "SELECT " EMBODY_MODEL_COLUMNS
              " FROM model WHERE category = ? ORDER BY name COLLATE NOCASE, id LIMIT ? OFFSET ?");
    if (!total) return total.error();
    if (!page) return page.error();
    if (!all) {
        total->bind(search.category);
        page->bind(search.category);
    }
    if (const auto row = total->step(); !row) return row.error();
    ModelMatches matches;
    matches.total = total->integer(0);
    if (matches.total <= search.offset) return matches;
    page->bind(search.limit).bind(search.offset);
    auto models = rows(*page);
    if (!models) return models.error();
    matches.models = std::move(*models);
    return matches;
}

Result<std::vector<std::int64_t>> ModelTable::ids_that_match(std::string_view expression) {
    auto statement = connection_.prepare("SELECT rowid FROM model_words WHERE model_words MATCH ? ORDER BY rowid");
    if (!statement) return statement.error();
    return read_ids(statement->bind(expression));
}

Result<std::vector<std::int64_t>> ModelTable::ids_in_category(const std::vector<std::int64_t>& ids,
                                                              std::string_view category) {
    auto statement = connection_.prepare("SELECT id FROM model WHERE category = ?");
    if (!statement) return statement.error();
    auto all = read_ids(statement->bind(category));
    if (!all) return all;
    std::sort(all->begin(), all->end());
    std::vector<std::int64_t> both;
    std::set_intersection(ids.begin(), ids.end(), all->begin(), all->end(), std::back_inserter(both));
    return both;
}

Result<std::vector<std::int64_t>> ModelTable::ranked_page(std::string_view expression, const ModelSearch& search) {
    // Words weigh most in the name, then in tags, category, subcategory, source.
#define EMBODY_RANKED(CONDITION)                                                                         \
    "SELECT w.rowid, bm25(model_words, 10, 5, 4, 4, 1) AS score, m.name AS title"                        \
    " FROM model_words AS w CROSS JOIN model AS m ON m.id = w.rowid WHERE model_words MATCH ?" CONDITION \
    " ORDER BY score, title COLLATE NOCASE, w.rowid LIMIT ? OFFSET ?"
    auto statement =
        connection_.prepare(search.category.empty() ? EMBODY_RANKED("") : EMBODY_RANKED(" AND m.category = ?"));
#undef EMBODY_RANKED
    if (!statement) return statement.error();
    statement->bind(expression);
    if (!search.category.empty()) statement->bind(search.category);
    statement->bind(search.limit).bind(search.offset);
    return read_ids(*statement);
}

Result<std::vector<std::int64_t>> ModelTable::broad_page(const MatchExpressions& expressions,
                                                         std::vector<std::int64_t> ids, const ModelSearch& search) {
    BroadMatches matches;
    matches.ids = std::move(ids);
    matches.fits.assign(matches.ids.size(), elsewhere);
    for (const auto& [expression, fit] : {std::pair(&expressions.beginnings_in_name, has_their_beginnings),
                                          std::pair(&expressions.in_name, has_the_words)}) {
        const auto fitting = ids_that_match(*expression);
        if (!fitting) return fitting.error();
        for (const std::int64_t id : *fitting) matches.note(id, fit);
    }
    auto same = connection_.prepare("SELECT id FROM model WHERE name = ? COLLATE NOCASE");
    if (!same) return same.error();
    const auto named = read_ids(same->bind(without_outer_spaces(search.words)));
    if (!named) return named.error();
    for (const std::int64_t id : *named) matches.note(id, is_the_words);

    // How many of each fit the page needs, counted from the fit's first.
    std::array<std::size_t, name_fits> needed{}, skipped{};
    for (const std::uint8_t fit : matches.fits) ++needed[fit];
    std::size_t open_fits = 0, start = 0;
    const auto first = static_cast<std::size_t>(search.offset), last = first + static_cast<std::size_t>(search.limit);
    for (std::size_t fit = 0; fit < name_fits; ++fit) {
        const std::size_t size = needed[fit];
        skipped[fit] = std::clamp(first, start, start + size) - start;
        needed[fit] = std::clamp(last, start, start + size) - start;
        if (needed[fit] == skipped[fit]) needed[fit] = skipped[fit] = 0;
        if (needed[fit] > 0) ++open_fits;
        start += size;
    }

    // The index by name is walked until all of them were met; usually that is soon.
    auto walk = connection_.prepare(search.category.empty()
                                        ? "SELECT id FROM model ORDER BY name COLLATE NOCASE, id"
                                        : "SELECT id FROM model WHERE category = ? ORDER BY name COLLATE NOCASE, id");
    if (!walk) return walk.error();
    if (!search.category.empty()) walk->bind(search.category);
    std::array<std::vector<std::int64_t>, name_fits> pages;
    std::array<std::size_t, name_fits> seen{};
    while (open_fits > 0) {
        const auto row = walk->step();
        if (!row) return row.error();
        if (!*row) break;
        const auto at = matches.position(walk->integer(0));
        if (!at) continue;
        const std::uint8_t fit = matches.fits[*at];
        if (seen[fit] >= needed[fit]) continue;
        if (seen[fit] >= skipped[fit]) pages[fit].push_back(matches.ids[*at]);
        if (++seen[fit] == needed[fit]) --open_fits;
    }
    std::vector<std::int64_t> page;
    for (const auto& part : pages) page.insert(page.end(), part.begin(), part.end());
    return page;
}

Result<std::vector<ModelRow>> ModelTable::rows(Statement& statement) {
    std::vector<ModelRow> found;
    while (true) {
        const auto row = statement.step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back(read_row(statement));
    }
}

Result<std::optional<ModelRow>> ModelTable::first(Result<Statement> statement) {
    if (!statement) return statement.error();
    const auto row = statement->step();
    if (!row) return row.error();
    if (!*row) return std::optional<ModelRow>();
    return std::optional<ModelRow>(read_row(*statement));
}

Result<std::optional<ModelRow>> ModelTable::find(std::int64_t id) {
    auto statement = connection_.prepare("SELECT " EMBODY_MODEL_COLUMNS " FROM model WHERE id = ?");
    if (statement) statement->bind(id);
    return first(std::move(statement));
}

Result<std::optional<ModelRow>> ModelTable::find_key(std::string_view key) {
    auto statement = connection_.prepare("SELECT " EMBODY_MODEL_COLUMNS " FROM model WHERE key = ?");
    if (statement) statement->bind(key);
    return first(std::move(statement));
}

Result<std::optional<ModelRow>> ModelTable::find_file(std::uint64_t file_hash) {
    auto statement = connection_.prepare("SELECT " EMBODY_MODEL_COLUMNS
                                         " FROM model WHERE file_hash = ? AND key GLOB 'file:*' ORDER BY id LIMIT 1");
    if (statement) statement->bind(file_hash);
    return first(std::move(statement));
}

Result<std::vector<ModelRow>> ModelTable::find_name(std::string_view name) {
    auto statement = connection_.prepare("SELECT " EMBODY_MODEL_COLUMNS
                                         " FROM model WHERE name = ? COLLATE NOCASE ORDER BY id LIMIT 2");
    if (!statement) return statement.error();
    statement->bind(name);
    return rows(*statement);
}

Result<std::vector<std::pair<std::string, std::int64_t>>> ModelTable::count_categories() {
    auto statement = connection_.prepare("SELECT category, count(*) FROM model GROUP BY category ORDER BY category");
    if (!statement) return statement.error();
    std::vector<std::pair<std::string, std::int64_t>> counts;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return counts;
        counts.emplace_back(statement->text(0), statement->integer(1));
    }
}

}  // namespace embody::database
