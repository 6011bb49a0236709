// SPDX-License-Identifier: MIT
#include "database/attribute_table.h"

namespace embody::database {

Result<std::vector<ManualAttribute>> ManualAttributeTable::of(std::string_view model_key) {
    auto statement = connection_.prepare(
        "SELECT name, value, set_by, set_at FROM manual_attribute WHERE model_key = ? ORDER BY name");
    if (!statement) return statement.error();
    statement->bind(model_key);
    std::vector<ManualAttribute> found;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back({statement->text(0), statement->text(1), statement->text(2), statement->integer(3)});
    }
}

Result<void> ManualAttributeTable::put(std::string_view model_key, const ManualAttribute& attribute) {
    auto statement = connection_.prepare(
        "REPLACE INTO manual_attribute (model_key, name, value, set_by, set_at) VALUES (?,?,?,?,unixepoch())");
    if (!statement) return statement.error();
    return statement->bind(model_key).bind(attribute.name).bind(attribute.value).bind(attribute.set_by).run();
}

Result<std::optional<ManualAttribute>> ManualAttributeTable::find(std::string_view model_key, std::string_view name) {
    auto statement = connection_.prepare(
        "SELECT name, value, set_by, set_at FROM manual_attribute WHERE model_key = ? AND name = ?");
    if (!statement) return statement.error();
    const auto row = statement->bind(model_key).bind(name).step();
    if (!row) return row.error();
    if (!*row) return std::optional<ManualAttribute>();
    return std::optional<ManualAttribute>(
        {statement->text(0), statement->text(1), statement->text(2), statement->integer(3)});
}

Result<void> ManualAttributeTable::restore(std::string_view model_key, const ManualAttribute& attribute) {
    auto statement = connection_.prepare(
        "REPLACE INTO manual_attribute (model_key, name, value, set_by, set_at) VALUES (?,?,?,?,?)");
    if (!statement) return statement.error();
    statement->bind(model_key).bind(attribute.name).bind(attribute.value).bind(attribute.set_by).bind(attribute.set_at);
    return statement->run();
}

Result<void> ManualAttributeTable::erase(std::string_view model_key, std::string_view name) {
    auto statement = connection_.prepare("DELETE FROM manual_attribute WHERE model_key = ? AND name = ?");
    if (!statement) return statement.error();
    return statement->bind(model_key).bind(name).run();
}

}  // namespace embody::database
