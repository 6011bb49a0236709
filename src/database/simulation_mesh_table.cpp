// SPDX-License-Identifier: MIT
#include "database/simulation_mesh_table.h"

namespace embody::database {

Result<void> SimulationMeshTable::put(std::int64_t model, const StoredSimulationMesh& mesh) {
    auto row = connection_.prepare(
        "REPLACE INTO model_simulation_mesh (model, kind, revision, problem, mesh) VALUES (?,?,?,?,?)");
    if (!row) return row.error();
    row->bind(model).bind(mesh.kind).bind(mesh.revision);
    return row->bind(mesh.problem).bind(mesh.mesh).run();
}

Result<std::optional<StoredSimulationMesh>> SimulationMeshTable::find(std::int64_t model, const std::string& kind) {
    auto statement =
        connection_.prepare("SELECT revision, problem, mesh FROM model_simulation_mesh WHERE model = ? AND kind = ?");
    if (!statement) return statement.error();
    const auto row = statement->bind(model).bind(kind).step();
    if (!row) return row.error();
    if (!*row) return std::optional<StoredSimulationMesh>();
    return std::optional(
        StoredSimulationMesh{kind, static_cast<int>(statement->integer(0)), statement->text(1), statement->bytes(2)});
}

Result<void> SimulationMeshTable::forget(std::int64_t model) {
    auto statement = connection_.prepare("DELETE FROM model_simulation_mesh WHERE model = ?");
    if (!statement) return statement.error();
    return statement->bind(model).run();
}

}  // namespace embody::database
