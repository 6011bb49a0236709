// SPDX-License-Identifier: MIT
#include "database/model_table.h"

#include "foundation/state_hash.h"

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

Result<std::int64_t> ModelTable::put_row(const ModelRow& model) {
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
    return id;
}

Result<std::int64_t> ModelTable::put(const ModelRow& model, const ModelKnowledge& knowledge, const ModelBlobs& blobs) {
    const auto row = put_row(model);
    if (!row) return row;
    const std::int64_t id = *row;
    if (auto known = put_knowledge(id, knowledge); !known) return known.error();
    const auto geometry = store_geometry(blobs, model.geometry_hash);
    if (!geometry) return geometry.error();
    const auto picture = store_picture(blobs.thumbnail);
    if (!picture) return picture.error();
    if (auto linked = link(id, *geometry, *picture); !linked) return linked.error();
    return id;
}

Result<std::int64_t> ModelTable::put_like(std::int64_t like, const ModelRow& model, const ModelKnowledge& knowledge) {
    const auto id = put_row(model);
    if (!id) return id;
    if (auto known = put_knowledge(*id, knowledge); !known) return known.error();
    auto contents = connection_.prepare(
        "SELECT geometry, picture FROM model_geometry AS g JOIN model_thumbnail AS t ON t.model = g.model"
        " WHERE g.model = ?");
    if (!contents) return contents.error();
    const auto row = contents->bind(like).step();
    if (!row) return row.error();
    if (!*row) return no_such_model(like);
    if (auto linked = link(*id, contents->integer(0), contents->integer(1)); !linked) return linked.error();
    return *id;
}

Result<void> ModelTable::link(std::int64_t id, std::int64_t geometry, std::int64_t picture) {
    // Upserts, since what REPLACE deletes calls no trigger.
    auto row = connection_.prepare(
        "INSERT INTO model_geometry (model, geometry) VALUES (?,?)"
        " ON CONFLICT (model) DO UPDATE SET geometry = excluded.geometry");
    if (!row) return row.error();
    if (auto stored = row->bind(id).bind(geometry).run(); !stored) return stored;
    auto thumbnail = connection_.prepare(
        "INSERT INTO model_thumbnail (model, picture) VALUES (?,?)"
        " ON CONFLICT (model) DO UPDATE SET picture = excluded.picture");
    if (!thumbnail) return thumbnail.error();
    return thumbnail->bind(id).bind(picture).run();
}

Result<std::int64_t> ModelTable::store_geometry(const ModelBlobs& blobs, std::uint64_t hash) {
    auto same = connection_.prepare(
        "SELECT id FROM stored_geometry WHERE hash = ? AND compact = ? AND hull_points = ? LIMIT 1");
    if (!same) return same.error();
    const auto found = same->bind(hash).bind(blobs.geometry).bind(blobs.hull_points).step();
    if (!found) return found.error();
    if (*found) return same->integer(0);
    auto row = connection_.prepare("INSERT INTO stored_geometry (hash, compact, hull_points) VALUES (?,?,?)");
    if (!row) return row.error();
    if (auto stored = row->bind(hash).bind(blobs.geometry).bind(blobs.hull_points).run(); !stored)
        return stored.error();
    return connection_.last_row_id();
}

Result<std::int64_t> ModelTable::store_picture(std::span<const std::uint8_t> png) {
    StateHash hash;
    hash.add_bytes(png.data(), png.size());
    auto same = connection_.prepare("SELECT id FROM stored_picture WHERE hash = ? AND png = ? LIMIT 1");
    if (!same) return same.error();
    const auto found = same->bind(hash.value()).bind(png).step();
    if (!found) return found.error();
    if (*found) return same->integer(0);
    auto row = connection_.prepare("INSERT INTO stored_picture (hash, png) VALUES (?,?)");
    if (!row) return row.error();
    if (auto stored = row->bind(hash.value()).bind(png).run(); !stored) return stored.error();
    return connection_.last_row_id();
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
    return blob(
        "SELECT compact FROM model_geometry AS m JOIN stored_geometry AS s ON s.id = m.geometry WHERE m.model = ?", id);
}

Result<std::vector<std::uint8_t>> ModelTable::hull_points(std::int64_t id) {
    return blob(
        "SELECT hull_points FROM model_geometry AS m JOIN stored_geometry AS s ON s.id = m.geometry WHERE m.model = ?",
        id);
}

Result<std::vector<std::uint8_t>> ModelTable::thumbnail(std::int64_t id) {
    return blob("SELECT png FROM model_thumbnail AS m JOIN stored_picture AS s ON s.id = m.picture WHERE m.model = ?",
                id);
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
