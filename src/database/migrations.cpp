// SPDX-License-Identifier: MIT
#include "database/migrations.h"

#include <algorithm>

#include "database/transaction.h"

namespace embody::database {
namespace {

Result<void> take_step(Connection& connection, const Migration& migration) {
    auto transaction = Transaction::begin(connection);
    if (!transaction) return transaction.error();

    // Another process may have been here while this one waited for the lock.
    const auto version = connection.query_integer("PRAGMA user_version");
    if (!version) return version.error();
    if (*version >= migration.version) return {};

    if (auto changed = connection.execute(migration.commands); !changed) return changed;
    const std::string set_version = "PRAGMA user_version = " + std::to_string(migration.version);
    if (auto marked = connection.execute(set_version); !marked) return marked;
    return transaction->commit();
}

}  // namespace

Result<void> migrate(Connection& connection, std::span<const Migration> migrations) {
    const int known = migrations.empty() ? 0 : migrations.back().version;
    const auto version = connection.query_integer("PRAGMA user_version");
    if (!version) return version.error();
    if (*version > known) {
        return Error{connection.file().string(),
                     "has schema version " + std::to_string(*version) + ", this program knows versions up to " +
                         std::to_string(known),
                     "open it with the newer Embody that wrote it, or name another file with --database"};
    }
    const bool is_needed = std::any_of(migrations.begin(), migrations.end(), [&](const Migration& migration) {
        return migration.version > *version && !migration.is_optional_for_reading;
    });
    if (connection.is_read_only() && !is_needed) return {};
    if (connection.is_read_only()) {
        return Error{connection.file().string(),
                     "has schema version " + std::to_string(*version) + ", this program needs " +
                         std::to_string(known) + " and cannot change the file: it is read-only",
                     "make file and folder writable, or open a copy with --database"};
    }
    for (const Migration& migration : migrations) {
        if (migration.version <= *version) continue;
        if (auto step = take_step(connection, migration); !step) return step;
    }
    return {};
}

}  // namespace embody::database
