// SPDX-License-Identifier: MIT
#include "database/model_table.h"

namespace embody::database {
namespace {

std::string join_lines(const std::vector<std::string>& lines) {
    std::string joined;
    for (const std::string& line : lines) joined += joined.empty() ? line : "\n" + line;
    return joined;
}

// The values of `put` and `describe`, in the order of their parameters.
void bind_description(Statement& statement, const ModelRow& model) {
    statement.bind(model.name).bind(model.source).bind(model.licence).bind(model.author);
    statement.bind(model.category).bind(model.subcategory).bind(model.physical_kind).bind(join_lines(model.tags));
}

void bind_geometry(Statement& statement, const ModelRow& model) {
    for (const double length : model.size) statement.bind(length);
    statement.bind(model.geometry_kind);
    for (const std::uint32_t number : {model.vertices, model.triangles, model.parts, model.materials, model.images}) {
        statement.bind(std::int64_t{number});
    }
    statement.bind(model.quality).bind(model.file_hash).bind(model.geometry_hash);
}

}  // namespace

Result<std::int64_t> ModelTable::put(const ModelRow& model, const ModelKnowledge& knowledge, const ModelBlobs& blobs) {
    // An upsert keeps the id, so that what refers to the model goes on to do so.
    auto row = connection_.prepare(
        "INSERT INTO model (key, name, source, licence, author, category, subcategory, physical_kind, tags,"
        " size_x, size_y, size_z, geometry_kind, vertices, triangles, parts, materials, images, quality,"
        " file_hash, geometry_hash, changed_at)"
        " VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,unixepoch())"
        " ON CONFLICT (key) DO UPDATE SET name = excluded.name, source = excluded.source, licence = excluded.licence,"
        " author = excluded.author, category = excluded.category, subcategory = excluded.subcategory,"
        " physical_kind = excluded.physical_kind, tags = excluded.tags, size_x = excluded.size_x,"
        " size_y = excluded.size_y, size_z = excluded.size_z, geometry_kind = excluded.geometry_kind,"
        " vertices = excluded.vertices, triangles = excluded.triangles, parts = excluded.parts,"
        " materials = excluded.materials, images = excluded.images, quality = excluded.quality,"
        " file_hash = excluded.file_hash, geometry_hash = excluded.geometry_hash, changed_at = excluded.changed_at"
        " RETURNING id");
    if (!row) return row.error();
    row->bind(model.key);
    bind_description(*row, model);
    bind_geometry(*row, model);
    if (const auto stored = row->step(); !stored) return stored.error();
    const std::int64_t id = row->integer(0);
    if (const auto ended = row->step(); !ended) return ended.error();

    if (auto known = put_knowledge(id, knowledge); !known) return known.error();
    auto geometry = connection_.prepare("REPLACE INTO model_geometry (model, compact, hull_points) VALUES (?,?,?)");
    if (!geometry) return geometry.error();
    if (auto stored = geometry->bind(id).bind(blobs.geometry).bind(blobs.hull_points).run(); !stored)
        return stored.error();
    auto thumbnail = connection_.prepare("REPLACE INTO model_thumbnail (model, png) VALUES (?,?)");
    if (!thumbnail) return thumbnail.error();
    if (auto stored = thumbnail->bind(id).bind(blobs.thumbnail).run(); !stored) return stored.error();
    return id;
}

Result<void> ModelTable::describe(const ModelRow& model, const ModelKnowledge& knowledge) {
    auto row = connection_.prepare(
        "UPDATE model SET name = ?, source = ?, licence = ?, author = ?, category = ?, subcategory = ?,"
        " physical_kind = ?, tags = ?, changed_at = unixepoch() WHERE id = ?");
    if (!row) return row.error();
    bind_description(*row, model);
    if (auto stored = row->bind(model.id).run(); !stored) return stored;
    return put_knowledge(model.id, knowledge);
}

Result<void> ModelTable::put_knowledge(std::int64_t id, const ModelKnowledge& knowledge) {
    auto row = connection_.prepare("REPLACE INTO model_knowledge (model, facts, automatic) VALUES (?,?,?)");
    if (!row) return row.error();
    return row->bind(id).bind(knowledge.facts).bind(knowledge.automatic).run();
}

Result<void> ModelTable::remove(std::int64_t id) {
    auto row = connection_.prepare("DELETE FROM model WHERE id = ? RETURNING id");
    if (!row) return row.error();
    const auto removed = row->bind(id).step();
    if (!removed) return removed.error();
    if (!*removed) return no_such_model(id);
    return row->run();
}

Result<std::vector<std::int64_t>> ModelTable::ids() {
    auto statement = connection_.prepare("SELECT id FROM model ORDER BY id");
    if (!statement) return statement.error();
    std::vector<std::int64_t> found;
    while (true) {
        const auto row = statement->step();
        if (!row) return row.error();
        if (!*row) return found;
        found.push_back(statement->integer(0));
    }
}

Result<std::int64_t> ModelTable::count() { return connection_.query_integer("SELECT count(*) FROM model"); }

Result<ModelKnowledge> ModelTable::knowledge(std::int64_t id) {
    auto statement = connection_.prepare("SELECT facts, automatic FROM model_knowledge WHERE model = ?");
    if (!statement) return statement.error();
    const auto row = statement->bind(id).step();
    if (!row) return row.error();
    if (!*row) return no_such_model(id);
    return ModelKnowledge{statement->text(0), statement->text(1)};
}

Result<std::vector<std::uint8_t>> ModelTable::geometry(std::int64_t id) {
    return blob("SELECT compact FROM model_geometry WHERE model = ?", id);
}

Result<std::vector<std::uint8_t>> ModelTable::hull_points(std::int64_t id) {
    return blob("SELECT hull_points FROM model_geometry WHERE model = ?", id);
}

Result<std::vector<std::uint8_t>> ModelTable::thumbnail(std::int64_t id) {
    return blob("SELECT png FROM model_thumbnail WHERE model = ?", id);
}

Result<std::vector<std::uint8_t>> ModelTable::blob(std::string_view command, std::int64_t id) {
    auto statement = connection_.prepare(command);
    if (!statement) return statement.error();
    const auto row = statement->bind(id).step();
    if (!row) return row.error();
    if (!*row) return no_such_model(id);
    return statement->bytes(0);
}

Error ModelTable::no_such_model(std::int64_t id) const {
    return {connection_.file().string(), "has no model with id " + std::to_string(id), {}};
}

}  // namespace embody::database
