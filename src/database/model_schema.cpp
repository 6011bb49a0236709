// SPDX-License-Identifier: MIT
#include "database/model_schema.h"

#include <array>

namespace embody::database {
namespace {

// Small rows in `model`, so that listing and searching read few pages; what is large or seldom asked for lies beside
// it. Times are seconds since 1970, UTC.
constexpr const char* first_version = R"sql(
CREATE TABLE model (
    id            INTEGER PRIMARY KEY,
    key           TEXT    NOT NULL UNIQUE,
    name          TEXT    NOT NULL,
    source        TEXT    NOT NULL,
    licence       TEXT    NOT NULL,
    author        TEXT    NOT NULL,
    category      TEXT    NOT NULL,
    subcategory   TEXT    NOT NULL,
    physical_kind TEXT    NOT NULL,
    tags          TEXT    NOT NULL,              -- one a line
    size_x        REAL    NOT NULL,              -- m
    size_y        REAL    NOT NULL,
    size_z        REAL    NOT NULL,
    geometry_kind TEXT    NOT NULL CHECK (geometry_kind IN ('mesh', 'point_cloud', 'voxel', 'analytical')),
    vertices      INTEGER NOT NULL,
    triangles     INTEGER NOT NULL,
    parts         INTEGER NOT NULL,
    materials     INTEGER NOT NULL,
    images        INTEGER NOT NULL,
    quality       INTEGER NOT NULL CHECK (quality BETWEEN 0 AND 3),
    file_hash     INTEGER NOT NULL,              -- of the model file's bytes
    geometry_hash INTEGER NOT NULL,              -- of the stored geometry
    changed_at    INTEGER NOT NULL
) STRICT;
CREATE INDEX model_by_name     ON model (name COLLATE NOCASE, id);
CREATE INDEX model_by_category ON model (category, name COLLATE NOCASE, id);
CREATE INDEX model_by_file     ON model (file_hash);

CREATE TABLE model_geometry (
    model       INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
    compact     BLOB NOT NULL,                   -- versioned in its own header
    hull_points BLOB NOT NULL                    -- x y z as little-endian floats, m
) STRICT;

CREATE TABLE model_thumbnail (
    model INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
    png   BLOB NOT NULL
) STRICT;

CREATE TABLE model_knowledge (
    model     INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
    facts     TEXT NOT NULL CHECK (json_valid(facts)),
    automatic TEXT NOT NULL CHECK (json_valid(automatic))
) STRICT;

-- By key and without a reference: a person's work outlives the deletion of the model and comes back with it.
CREATE TABLE manual_attribute (
    model_key TEXT    NOT NULL,
    name      TEXT    NOT NULL,
    value     TEXT    NOT NULL CHECK (json_valid(value)),
    set_by    TEXT    NOT NULL,
    set_at    INTEGER NOT NULL,
    PRIMARY KEY (model_key, name)
) STRICT, WITHOUT ROWID;

-- What was imported from where, to know at the next import what is done.
CREATE TABLE import_source (
    location     TEXT    PRIMARY KEY,            -- a file, or archive!entry
    model        INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
    stamp        TEXT    NOT NULL,               -- size and time of the file on disk
    file_hash    INTEGER NOT NULL,               -- of the file on disk: the model's own, or its archive's
    prepare_hash INTEGER NOT NULL,               -- of all that preparing depends on
    item_hash    INTEGER NOT NULL                -- of what the catalogue says beyond that
) STRICT, WITHOUT ROWID;
CREATE INDEX import_source_by_model ON import_source (model);

CREATE TABLE setting (
    name  TEXT PRIMARY KEY,
    value TEXT NOT NULL
) STRICT, WITHOUT ROWID;

-- The words of `model`, without a copy of the text.
CREATE VIRTUAL TABLE model_words USING fts5 (
    name, tags, category, subcategory, source,
    content = 'model', content_rowid = 'id', prefix = '1 2 3', tokenize = 'porter unicode61 remove_diacritics 2'
);
CREATE TRIGGER model_words_insert AFTER INSERT ON model BEGIN
    INSERT INTO model_words (rowid, name, tags, category, subcategory, source)
    VALUES (new.id, new.name, new.tags, new.category, new.subcategory, new.source);
END;
CREATE TRIGGER model_words_delete AFTER DELETE ON model BEGIN
    INSERT INTO model_words (model_words, rowid, name, tags, category, subcategory, source)
    VALUES ('delete', old.id, old.name, old.tags, old.category, old.subcategory, old.source);
END;
CREATE TRIGGER model_words_update AFTER UPDATE OF name, tags, category, subcategory, source ON model BEGIN
    INSERT INTO model_words (model_words, rowid, name, tags, category, subcategory, source)
    VALUES ('delete', old.id, old.name, old.tags, old.category, old.subcategory, old.source);
    INSERT INTO model_words (rowid, name, tags, category, subcategory, source)
    VALUES (new.id, new.name, new.tags, new.category, new.subcategory, new.source);
END;
)sql";

// Convex decompositions, by what they were made with. The error in whole micrometres, to be found by equality.
constexpr const char* with_decompositions = R"sql(
CREATE TABLE model_decomposition (
    model          INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
    max_hulls      INTEGER NOT NULL,
    hull_error_um  INTEGER NOT NULL,
    concavity      REAL    NOT NULL,               -- m, of the deepest hull
    hull_concavity REAL    NOT NULL,               -- m, of the single hull
    hulls          BLOB    NOT NULL,               -- count; for each hull: count, x y z as little-endian floats, m
    PRIMARY KEY (model, max_hulls, hull_error_um)
) STRICT;
)sql";

// Who changed what by hand, when: an act is a batch, each value that it changed is a row. By key and without a
// reference to the model, as manual_attribute.
constexpr const char* audit_of_manual_changes = R"sql(
CREATE TABLE manual_batch (
    id        INTEGER PRIMARY KEY AUTOINCREMENT,
    made_at   INTEGER NOT NULL,
    person    TEXT    NOT NULL,
    session   TEXT    NOT NULL,                  -- the program or client through which the person acted
    command   TEXT    NOT NULL,
    asked     TEXT    NOT NULL,                  -- which models were meant, in words
    undoes    INTEGER REFERENCES manual_batch (id),  -- of an undo or redo: the batch that it takes back or does again
    undone_by INTEGER REFERENCES manual_batch (id)   -- the undo that is in force
) STRICT;
CREATE TABLE manual_change (
    id        INTEGER PRIMARY KEY,
    batch     INTEGER NOT NULL REFERENCES manual_batch (id),
    model_key TEXT    NOT NULL,
    name      TEXT    NOT NULL,
    old_value TEXT    CHECK (old_value IS NULL OR json_valid(old_value)),  -- null: there was no manual value
    old_by    TEXT,
    old_at    INTEGER,
    new_value TEXT    CHECK (new_value IS NULL OR json_valid(new_value))   -- null: the automatic value acts again
) STRICT;
CREATE INDEX manual_change_by_model ON manual_change (model_key, name, id);
CREATE INDEX manual_change_by_batch ON manual_change (batch);
)sql";

// Geometry and pictures are separate from their models: data that is the same for many is stored once, and is removed
// with the last of them. `hash` only finds candidates; 0 where it was not computed. `model_words` follows changes of
// words only.
constexpr const char* shared_contents = R"sql(
CREATE TABLE stored_geometry (
    id          INTEGER PRIMARY KEY,
    hash        INTEGER NOT NULL,
    compact     BLOB    NOT NULL,                -- versioned in its own header
    hull_points BLOB    NOT NULL                 -- x y z as little-endian floats, m
) STRICT;
CREATE TABLE stored_picture (
    id   INTEGER PRIMARY KEY,
    hash INTEGER NOT NULL,
    png  BLOB    NOT NULL
) STRICT;
INSERT INTO stored_geometry SELECT model, 0, compact, hull_points FROM model_geometry;
INSERT INTO stored_picture SELECT model, 0, png FROM model_thumbnail;
DROP TABLE model_geometry;
DROP TABLE model_thumbnail;
CREATE TABLE model_geometry (
    model    INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
    geometry INTEGER NOT NULL REFERENCES stored_geometry (id)
) STRICT;
CREATE TABLE model_thumbnail (
    model   INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
    picture INTEGER NOT NULL REFERENCES stored_picture (id)
) STRICT;
INSERT INTO model_geometry SELECT id, id FROM stored_geometry;
INSERT INTO model_thumbnail SELECT id, id FROM stored_picture;
CREATE INDEX stored_geometry_by_hash    ON stored_geometry (hash);
CREATE INDEX stored_picture_by_hash     ON stored_picture (hash);
CREATE INDEX model_geometry_by_geometry ON model_geometry (geometry);
CREATE INDEX model_thumbnail_by_picture ON model_thumbnail (picture);

CREATE TRIGGER model_geometry_delete AFTER DELETE ON model_geometry
WHEN NOT EXISTS (SELECT 1 FROM model_geometry WHERE geometry = old.geometry) BEGIN
    DELETE FROM stored_geometry WHERE id = old.geometry;
END;
CREATE TRIGGER model_geometry_update AFTER UPDATE OF geometry ON model_geometry
WHEN NOT EXISTS (SELECT 1 FROM model_geometry WHERE geometry = old.geometry) BEGIN
    DELETE FROM stored_geometry WHERE id = old.geometry;
END;
CREATE TRIGGER model_thumbnail_delete AFTER DELETE ON model_thumbnail
WHEN NOT EXISTS (SELECT 1 FROM model_thumbnail WHERE picture = old.picture) BEGIN
    DELETE FROM stored_picture WHERE id = old.picture;
END;
CREATE TRIGGER model_thumbnail_update AFTER UPDATE OF picture ON model_thumbnail
WHEN NOT EXISTS (SELECT 1 FROM model_thumbnail WHERE picture = old.picture) BEGIN
    DELETE FROM stored_picture WHERE id = old.picture;
END;

DROP TRIGGER model_words_update;
CREATE TRIGGER model_words_update AFTER UPDATE OF name, tags, category, subcategory, source ON model
WHEN (new.name, new.tags, new.category, new.subcategory, new.source)
     IS NOT (old.name, old.tags, old.category, old.subcategory, old.source) BEGIN
    INSERT INTO model_words (model_words, rowid, name, tags, category, subcategory, source)
    VALUES ('delete', old.id, old.name, old.tags, old.category, old.subcategory, old.source);
    INSERT INTO model_words (rowid, name, tags, category, subcategory, source)
    VALUES (new.id, new.name, new.tags, new.category, new.subcategory, new.source);
END;
)sql";

// What things that change their form are computed on (tetrahedra of soft ones), or why that could not be made.
constexpr const char* with_simulation_meshes = R"sql(
CREATE TABLE model_simulation_mesh (
    model    INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
    kind     TEXT    NOT NULL,                   -- physical kind that it is for
    revision INTEGER NOT NULL,                   -- of the rule that it was made by
    problem  TEXT    NOT NULL,                   -- why there is none; empty where there is one
    mesh     BLOB    NOT NULL,
    PRIMARY KEY (model, kind)
) STRICT;
)sql";

// Versions up to 5 merged the index of words with FTS5's 'optimize' at the end of each import. SQLite 3.40 puts the
// result one level higher each time, and takes an index of more than 2000 levels for damaged: after about 1000 imports
// none could be made any more. What merges by itself while words come in stays at a few levels, and searching is as
// fast. The first command writes the structure of an empty index (cookie, levels, segments, counter), without which
// FTS5 would refuse to rebuild it.
constexpr const char* rebuilt_words = R"sql(
UPDATE model_words_data SET block = x'00000000000000' WHERE id = 10;
INSERT INTO model_words (model_words) VALUES ('rebuild');
)sql";

constexpr std::array<Migration, 6> migrations{{{1, first_version},
                                               {2, with_decompositions},
                                               {3, audit_of_manual_changes},
                                               {4, shared_contents},
                                               {5, with_simulation_meshes},
                                               {6, rebuilt_words, true}}};

}  // namespace

std::span<const Migration> model_migrations() { return migrations; }

Result<std::unique_ptr<Connection>> open_model_database(const std::filesystem::path& file) {
    auto connection = Connection::open(file, {.application_id = model_application_id, .content = "a model database"});
    if (!connection) return connection;
    if (auto migrated = migrate(**connection, migrations); !migrated) return migrated.error();
    return connection;
}

}  // namespace embody::database
