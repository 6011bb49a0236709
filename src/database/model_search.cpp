// SPDX-License-Identifier: MIT
#include "database/model_table.h"
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

// One search's commands: `page` takes the values of `total` and then limit and offset.
struct SearchCommands {
    const char* total;
    const char* page;
};

SearchCommands commands_for(bool has_words, bool has_category) {
    // Words weigh most in the name, then in tags, category, subcategory, source. Ids, ranks and names are sorted first
    // and the full rows read only for the page.
#define EMBODY_RANKED(CONDITION)                                                                          \
    "WITH best AS (SELECT w.rowid AS id, bm25(model_words, 10, 5, 4, 4, 1) AS score, m.name AS title"     \
    " FROM model_words AS w CROSS JOIN model AS m ON m.id = w.rowid WHERE model_words MATCH ? " CONDITION \
    " ORDER BY score, title COLLATE NOCASE, w.rowid LIMIT ? OFFSET ?)"                                    \
    " SELECT " EMBODY_MODEL_COLUMNS                                                                       \
    " FROM best CROSS JOIN model ON model.id = best.id"                                                   \
    " ORDER BY score, title COLLATE NOCASE, model.id"
    if (has_words && has_category) {
        return {
            "SELECT count(*) FROM model_words AS w CROSS JOIN model AS m ON m.id = w.rowid"
            " WHERE model_words MATCH ? AND m.category = ?",
            EMBODY_RANKED("AND m.category = ?")};
    }
    if (has_words) return {"SELECT count(*) FROM model_words WHERE model_words MATCH ?", EMBODY_RANKED("")};
    if (has_category) {
        return {"SELECT count(*) FROM model WHERE category = ?", "SELECT " EMBODY_MODEL_COLUMNS
                                                                 " FROM model WHERE category = ?"
                                                                 " ORDER BY name COLLATE NOCASE, id LIMIT ? OFFSET ?"};
    }
    return {"SELECT count(*) FROM model",
            "SELECT " EMBODY_MODEL_COLUMNS " FROM model ORDER BY name COLLATE NOCASE, id LIMIT ? OFFSET ?"};
#undef EMBODY_RANKED
}

}  // namespace

Result<ModelMatches> ModelTable::search(const ModelSearch& search) {
    // Words without a letter or digit match nothing; no words match all.
    const bool has_words = search.words.find_first_not_of(" \t\r\n") != std::string::npos;
    const std::string expression = has_words ? match_expression(search.words) : std::string();
    if (has_words && expression.empty()) return ModelMatches{};
    const SearchCommands commands = commands_for(has_words, !search.category.empty());
    const auto bind_filters = [&](Statement& statement) {
        if (has_words) statement.bind(expression);
        if (!search.category.empty()) statement.bind(search.category);
    };

    ModelMatches matches;
    auto total = connection_.prepare(commands.total);
    if (!total) return total.error();
    bind_filters(*total);
    if (const auto row = total->step(); !row) return row.error();
    matches.total = total->integer(0);
    if (matches.total <= search.offset) return matches;

    auto page = connection_.prepare(commands.page);
    if (!page) return page.error();
    bind_filters(*page);
    page->bind(search.limit).bind(search.offset);
    auto models = rows(*page);
    if (!models) return models.error();
    matches.models = std::move(*models);
    return matches;
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

Result<void> ModelTable::tidy() {
    return connection_.execute("INSERT INTO model_words (model_words) VALUES ('optimize')");
}

}  // namespace embody::database
