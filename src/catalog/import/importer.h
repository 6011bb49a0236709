// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <set>

#include "attributes/resolver.h"
#include "catalog/catalog.h"
#include "catalog/import/find_models.h"
#include "database/attribute_table.h"
#include "database/import_table.h"
#include "database/model_table.h"

namespace embody::catalog {

/// Prepares items and hands each over as it is done; false from `done` stops. The program's is prepare_confined.
using PrepareModels =
    std::function<Result<void>(const std::vector<ImportItem>& items,
                               const std::function<bool(std::size_t item, Result<PreparedModel> prepared)>& done)>;

/// One import: finds models, leaves out what is in the database unchanged, has the others prepared, and stores each in
/// a transaction of its own as soon as it is done. So a kill at any moment loses only the models in work, and the next
/// import goes on from there. Several processes may import at once: whoever stores a model first has done it.
class Importer {
public:
    Importer(database::Connection& connection, const attributes::Taxonomy& taxonomy, PrepareModels prepare);

    Result<ImportReport> run(const std::vector<std::filesystem::path>& paths, const ImportOptions& options);

    enum class Stored : std::uint8_t { added, updated, there_already };
    /// Stores one model, unless another process has stored the same meanwhile. `source.model` need not be filled in.
    Result<Stored> store(const ImportItem& item, const PreparedModel& prepared, database::ImportSource source,
                         GeometryKind kind = GeometryKind::mesh);

private:
    // A model that is to be prepared, and what to remember of where it came from.
    struct Planned {
        ImportItem item;
        database::ImportSource source;
        bool unit_is_guessed = false;  ///< the stated size is ours, not the catalogue's
    };
    struct Identity {
        std::string key;
        std::optional<database::ModelRow> model;  ///< the one that is there
    };

    Result<void> plan(std::vector<FoundModel> found, const ImportOptions& options);
    Result<void> plan_model(FoundModel model, database::ImportSource source);
    Result<database::ImportSource> read_source(const FoundModel& model, const ImportOptions& options);
    Result<std::optional<std::uint64_t>> hash_content(const FoundModel& model, const ImportOptions& options);
    Result<Identity> identify(const FoundModel& model, const database::ImportSource& source);
    Result<Identity> identify_by_content(const database::ImportSource& source);
    Result<void> keep(const ImportItem& item, const database::ModelRow& model, const database::ImportSource& source);
    Result<bool> is_stored(std::int64_t model, const database::ImportSource& source);
    Result<void> prepare_planned(const std::vector<Planned>& planned, const ImportOptions& options);
    Result<void> take(const Planned& planned, Result<PreparedModel> prepared);
    Result<void> store_convex_parts(std::int64_t id, const ConvexParts& parts);
    Result<void> store_soft_mesh(std::int64_t id, bool is_soft, const PreparedModel& prepared);
    void name_in_report(const std::string& key);
    bool needs_other_unit(const Planned& planned, const PreparedModel& prepared);
    bool tell_progress(const ImportOptions& options, const std::string& name);

    database::Connection& connection_;
    const attributes::Taxonomy& taxonomy_;
    PrepareModels prepare_;
    database::ModelTable models_;
    database::ManualAttributeTable manual_;
    database::ImportTable imports_;

    // Of the running import.
    bool again_ = false;
    std::vector<Planned> planned_;
    std::set<std::string> planned_keys_;
    std::vector<Planned> in_other_unit_;  ///< to be prepared once more, larger or smaller
    ImportReport report_;
    ImportProgress progress_;
    struct {
        std::filesystem::path file;
        std::string stamp;
        std::uint64_t hash = 0;
    } last_file_;  ///< hashed last: a new archive is read once, not once a piece
};

/// A source that is no file, for models that the program brings along; another revision replaces the stored one.
database::ImportSource built_in_source(const ImportItem& item, const std::string& revision);

}  // namespace embody::catalog
