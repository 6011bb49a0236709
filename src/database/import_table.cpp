// SPDX-License-Identifier: MIT
#include "database/import_table.h"

namespace embody::database {

Result<std::optional<ImportSource>> ImportTable::first(Statement& statement) {
    const auto row = statement.step();
    if (!row) return row.error();
    if (!*row) return std::optional<ImportSource>();
    return std::optional<ImportSource>({statement.text(0), statement.integer(1), statement.text(2), statement.bits(3),
                                        statement.bits(4), statement.bits(5)});
}

Result<std::optional<ImportSource>> ImportTable::find(std::string_view location) {
    auto statement = connection_.prepare(
        "SELECT location, model, stamp, file_hash, prepare_hash, item_hash FROM import_source WHERE location = ?");
    if (!statement) return statement.error();
    return first(statement->bind(location));
}

Result<std::optional<ImportSource>> ImportTable::find_in_archive(std::string_view archive) {
    // Entries of one archive lie together in the order of locations: the first after "archive!" is one of them, or none
    // is.
    auto statement = connection_.prepare(
        "SELECT location, model, stamp, file_hash, prepare_hash, item_hash FROM import_source"
        " WHERE location >= ? AND location < ? LIMIT 1");
    if (!statement) return statement.error();
    const std::string start = std::string(archive) + "!", after = std::string(archive) + "\"";
    return first(statement->bind(start).bind(after));
}

Result<void> ImportTable::put(const ImportSource& source) {
    auto statement = connection_.prepare(
        "REPLACE INTO import_source (location, model, stamp, file_hash, prepare_hash, item_hash) VALUES (?,?,?,?,?,?)");
    if (!statement) return statement.error();
    statement->bind(source.location).bind(source.model).bind(source.stamp);
    return statement->bind(source.file_hash).bind(source.prepare_hash).bind(source.item_hash).run();
}

Result<std::vector<std::string>> ImportTable::locations_of(std::int64_t model) {
    auto statement = connection_.prepare("SELECT location FROM import_source WHERE model = ? ORDER BY location");
    if (!statement) return statement.error();
    statement->bind(model);
    std::vector<std::string> locations;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return locations;
        locations.push_back(statement->text(0));
    }
}

Result<bool> ImportTable::has_preparation(std::int64_t model, std::uint64_t prepare_hash) {
    auto statement = connection_.prepare("SELECT 1 FROM import_source WHERE model = ? AND prepare_hash = ?");
    if (!statement) return statement.error();
    return statement->bind(model).bind(prepare_hash).step();
}

Result<void> ImportTable::forget_other_preparations(std::int64_t model, std::uint64_t prepare_hash) {
    auto statement = connection_.prepare("DELETE FROM import_source WHERE model = ? AND prepare_hash <> ?");
    if (!statement) return statement.error();
    return statement->bind(model).bind(prepare_hash).run();
}

Result<std::string> SettingTable::get(std::string_view name) {
    auto statement = connection_.prepare("SELECT value FROM setting WHERE name = ?");
    if (!statement) return statement.error();
    const auto row = statement->bind(name).step();
    if (!row) return row.error();
    return *row ? statement->text(0) : std::string();
}

Result<void> SettingTable::put(std::string_view name, std::string_view value) {
    auto statement = connection_.prepare("REPLACE INTO setting (name, value) VALUES (?,?)");
    if (!statement) return statement.error();
    return statement->bind(name).bind(value).run();
}

}  // namespace embody::database
