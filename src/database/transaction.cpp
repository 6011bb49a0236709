// SPDX-License-Identifier: MIT
#include "database/transaction.h"

namespace embody::database {

Result<Transaction> Transaction::begin(Connection& connection) {
    if (auto begun = connection.execute("BEGIN IMMEDIATE"); !begun) return begun.error();
    return Transaction(connection);
}

Transaction::~Transaction() {
    // A full disk may have rolled back already; then there is nothing left to undo and the answer does not matter.
    if (connection_) (void)connection_->execute("ROLLBACK");
}

Result<void> Transaction::commit() {
    if (auto committed = connection_->execute("COMMIT"); !committed) return committed;
    connection_ = nullptr;
    return {};
}

}  // namespace embody::database
