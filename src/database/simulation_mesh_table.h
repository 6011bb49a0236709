// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "database/connection.h"

namespace embody::database {

/// The simulation mesh of a model that changes its form, or why there is none.
struct StoredSimulationMesh {
    std::string kind;                ///< of the thing: "soft"
    int revision = 0;                ///< of the rule that it was made by
    std::string problem;             ///< why there is none; empty where there is one
    std::vector<std::uint8_t> mesh;  ///< empty where there is none
};

/// Meshes that were computed, so that no one waits for them twice: one a model and kind. They go with the model's
/// geometry.
class SimulationMeshTable {
public:
    explicit SimulationMeshTable(Connection& connection) : connection_(connection) {}

    /// Adds, or replaces that of the same kind.
    Result<void> put(std::int64_t model, const StoredSimulationMesh& mesh);
    Result<std::optional<StoredSimulationMesh>> find(std::int64_t model, const std::string& kind);
    Result<void> forget(std::int64_t model);

private:
    Connection& connection_;
};

}  // namespace embody::database
