// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "database/connection.h"

namespace embody::database {

/// All or nothing: what is written between begin() and commit() is undone unless commit() succeeds. Takes the write
/// lock at once, so that it cannot fail half-way because another process was faster.
class Transaction {
public:
    static Result<Transaction> begin(Connection& connection);
    Transaction(Transaction&& other) noexcept : connection_(std::exchange(other.connection_, nullptr)) {}
    Transaction& operator=(Transaction&&) = delete;
    ~Transaction();

    Result<void> commit();

private:
    explicit Transaction(Connection& connection) : connection_(&connection) {}
    Connection* connection_;  ///< null once committed
};

}  // namespace embody::database
