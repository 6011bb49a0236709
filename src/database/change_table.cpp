// SPDX-License-Identifier: MIT
#include "database/change_table.h"

namespace embody::database {
namespace {

#define EMBODY_BATCH_COLUMNS \
    "b.id, b.made_at, b.person, b.session, b.command, b.asked, ifnull(b.undoes, 0), ifnull(b.undone_by, 0)"
#define EMBODY_CHANGE_COLUMNS                                                                             \
    "c.id, c.model_key, c.name, c.old_value IS NOT NULL, ifnull(c.old_value, ''), ifnull(c.old_by, ''), " \
    "ifnull(c.old_at, 0), c.new_value IS NOT NULL, ifnull(c.new_value, '')"

// In the order of EMBODY_BATCH_COLUMNS.
ChangeBatch read_batch(const Statement& statement, int column) {
    ChangeBatch batch;
    batch.id = statement.integer(column++);
    batch.made_at = statement.integer(column++);
    for (std::string* text : {&batch.person, &batch.session, &batch.command, &batch.asked}) {
        *text = statement.text(column++);
    }
    batch.undoes = statement.integer(column++);
    batch.undone_by = statement.integer(column);
    return batch;
}

// In the order of EMBODY_CHANGE_COLUMNS, from column 0.
ManualChange read_change(const Statement& statement) {
    ManualChange change{statement.integer(0), statement.text(1), statement.text(2), {}, {}};
    if (statement.integer(3) != 0) {
        change.before = ManualAttribute{change.name, statement.text(4), statement.text(5), statement.integer(6)};
    }
    if (statement.integer(7) != 0) change.value = statement.text(8);
    return change;
}

Result<std::optional<ChangeBatch>> first_batch(Statement& statement) {
    const auto row = statement.step();
    if (!row) return row.error();
    if (!*row) return std::optional<ChangeBatch>();
    return std::optional<ChangeBatch>(read_batch(statement, 0));
}

}  // namespace

Result<std::int64_t> ChangeTable::begin_batch(const ChangeBatch& batch) {
    auto statement = connection_.prepare(
        "INSERT INTO manual_batch (made_at, person, session, command, asked, undoes)"
        " VALUES (unixepoch(),?,?,?,?,nullif(?,0))");
    if (!statement) return statement.error();
    statement->bind(batch.person).bind(batch.session).bind(batch.command).bind(batch.asked).bind(batch.undoes);
    if (auto stored = statement->run(); !stored) return stored.error();
    return connection_.last_row_id();
}

Result<void> ChangeTable::add(std::int64_t batch, const ManualChange& change) {
    // A missing value is distinguished from an empty one by a text that is not JSON.
    auto statement = connection_.prepare(
        "INSERT INTO manual_change (batch, model_key, name, old_value, old_by, old_at, new_value)"
        " VALUES (?1, ?2, ?3, nullif(?4, ''), iif(?4 = '', NULL, ?5), iif(?4 = '', NULL, ?6), nullif(?7, ''))");
    if (!statement) return statement.error();
    const ManualAttribute before = change.before.value_or(ManualAttribute{});
    statement->bind(batch).bind(change.model_key).bind(change.name);
    statement->bind(before.value).bind(before.set_by).bind(before.set_at).bind(change.value.value_or(""));
    return statement->run();
}

Result<void> ChangeTable::mark_undone(std::int64_t batch, std::int64_t undone_by) {
    auto statement = connection_.prepare("UPDATE manual_batch SET undone_by = nullif(?, 0) WHERE id = ?");
    if (!statement) return statement.error();
    return statement->bind(undone_by).bind(batch).run();
}

Result<std::optional<ChangeBatch>> ChangeTable::find_batch(std::int64_t id) {
    auto statement = connection_.prepare("SELECT " EMBODY_BATCH_COLUMNS " FROM manual_batch AS b WHERE id = ?");
    if (!statement) return statement.error();
    statement->bind(id);
    return first_batch(*statement);
}

Result<std::optional<ChangeBatch>> ChangeTable::last_batch(std::string_view person) {
    auto statement = connection_.prepare("SELECT " EMBODY_BATCH_COLUMNS
                                         " FROM manual_batch AS b WHERE person = ? AND undoes IS NULL"
                                         " AND undone_by IS NULL ORDER BY id DESC LIMIT 1");
    if (!statement) return statement.error();
    statement->bind(person);
    return first_batch(*statement);
}

Result<std::vector<ManualChange>> ChangeTable::changes_of(std::int64_t batch) {
    auto statement =
        connection_.prepare("SELECT " EMBODY_CHANGE_COLUMNS " FROM manual_change AS c WHERE batch = ? ORDER BY id");
    if (!statement) return statement.error();
    statement->bind(batch);
    std::vector<ManualChange> found;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back(read_change(*statement));
    }
}

Result<std::optional<ChangeBatch>> ChangeTable::changed_since(const ManualChange& change) {
    auto statement = connection_.prepare("SELECT " EMBODY_BATCH_COLUMNS
                                         " FROM manual_change AS c CROSS JOIN manual_batch AS b ON b.id = c.batch"
                                         " WHERE c.model_key = ? AND c.name = ? AND c.id > ? AND b.undoes IS NULL"
                                         " AND b.undone_by IS NULL ORDER BY c.id DESC LIMIT 1");
    if (!statement) return statement.error();
    statement->bind(change.model_key).bind(change.name).bind(change.id);
    return first_batch(*statement);
}

Result<std::vector<RecordedChange>> ChangeTable::search(const ChangeSearch& search) {
    // Empty and 0 mean all; batches rise with time, so the newest rows are those with the highest numbers.
    auto statement =
        connection_.prepare("SELECT " EMBODY_CHANGE_COLUMNS ", " EMBODY_BATCH_COLUMNS
                            ", ifnull((SELECT m.name FROM model AS m WHERE m.key = c.model_key), '')"
                            " FROM manual_change AS c CROSS JOIN manual_batch AS b ON b.id = c.batch"
                            " WHERE (?1 = '' OR c.model_key = ?1) AND b.made_at >= ?2 AND (?3 = 0 OR c.batch = ?3)"
                            " ORDER BY c.id DESC LIMIT ?4");
    if (!statement) return statement.error();
    statement->bind(search.model_key).bind(search.since).bind(search.batch).bind(search.limit);
    std::vector<RecordedChange> found;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back({read_change(*statement), read_batch(*statement, 9), statement->text(17)});
    }
}

Result<std::vector<CountedBatch>> ChangeTable::batches(const BatchSearch& search) {
    auto statement = connection_.prepare(
        "SELECT " EMBODY_BATCH_COLUMNS
        ", (SELECT count(*) FROM manual_change AS c WHERE c.batch = b.id)"
        ", (SELECT count(DISTINCT c.model_key) FROM manual_change AS c WHERE c.batch = b.id)"
        " FROM manual_batch AS b WHERE b.id > ?1 AND (?2 = 0 OR b.id < ?2) AND b.made_at >= ?3 AND (?4 = '' OR EXISTS"
        " (SELECT 1 FROM manual_change AS c WHERE c.batch = b.id AND c.model_key = ?4)) ORDER BY b.id DESC LIMIT ?5");
    if (!statement) return statement.error();
    statement->bind(search.after).bind(search.before).bind(search.since).bind(search.model_key).bind(search.limit);
    std::vector<CountedBatch> found;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back({read_batch(*statement, 0), statement->integer(8), statement->integer(9)});
    }
}

Result<std::int64_t> ChangeTable::newest_batch() {
    return connection_.query_integer("SELECT ifnull(max(id), 0) FROM manual_batch");
}

}  // namespace embody::database
