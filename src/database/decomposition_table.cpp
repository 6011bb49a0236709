// SPDX-License-Identifier: MIT
#include "database/decomposition_table.h"

namespace embody::database {

Result<void> DecompositionTable::put(std::int64_t model, const StoredDecomposition& decomposition) {
    auto row = connection_.prepare(
        "REPLACE INTO model_decomposition (model, max_hulls, hull_error_um, concavity, hull_concavity, hulls)"
        " VALUES (?,?,?,?,?,?)");
    if (!row) return row.error();
    row->bind(model).bind(decomposition.max_hulls).bind(decomposition.hull_error_um);
    return row->bind(decomposition.concavity).bind(decomposition.hull_concavity).bind(decomposition.hulls).run();
}

Result<std::optional<StoredDecomposition>> DecompositionTable::find(std::int64_t model, int max_hulls,
                                                                    std::int64_t hull_error_um) {
    auto statement = connection_.prepare(
        "SELECT concavity, hull_concavity, hulls FROM model_decomposition"
        " WHERE model = ? AND max_hulls = ? AND hull_error_um = ?");
    if (!statement) return statement.error();
    const auto row = statement->bind(model).bind(max_hulls).bind(hull_error_um).step();
    if (!row) return row.error();
    if (!*row) return std::optional<StoredDecomposition>();
    return std::optional(
        StoredDecomposition{max_hulls, hull_error_um, statement->real(0), statement->real(1), statement->bytes(2)});
}

Result<void> DecompositionTable::forget(std::int64_t model) {
    auto statement = connection_.prepare("DELETE FROM model_decomposition WHERE model = ?");
    if (!statement) return statement.error();
    return statement->bind(model).run();
}

}  // namespace embody::database
