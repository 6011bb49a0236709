// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "database/connection.h"

namespace embody::database {

/// One convex decomposition of a model, by what it was made with.
struct StoredDecomposition {
    int max_hulls = 0;
    std::int64_t hull_error_um = 0;  ///< micrometres: whole numbers compare exactly
    double concavity = 0;            ///< m
    double hull_concavity = 0;       ///< m
    std::vector<std::uint8_t> hulls;
};

/// Decompositions that were computed, so that no one waits for them twice. They go with the model's geometry.
class DecompositionTable {
public:
    explicit DecompositionTable(Connection& connection) : connection_(connection) {}

    /// Adds, or replaces the one made with the same limits.
    Result<void> put(std::int64_t model, const StoredDecomposition& decomposition);
    Result<std::optional<StoredDecomposition>> find(std::int64_t model, int max_hulls, std::int64_t hull_error_um);
    Result<void> forget(std::int64_t model);

private:
    Connection& connection_;
};

}  // namespace embody::database
