// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "attributes/physical_kind.h"
#include "attributes/resolver.h"
#include "catalog/collection.h"
#include "catalog/geometry_kind.h"
#include "catalog/manual_change.h"
#include "catalog/prepare/convex_parts.h"
#include "catalog/soft_mesh.h"
#include "foundation/result.h"
#include "geometry/triangle_mesh.h"

namespace embody::catalog {

struct ModelSummary {
    std::int64_t id = 0;  ///< in this database
    std::string key;      ///< the same in every database and after re-import; what a scene file names
    std::string name, source, licence, author, category, subcategory;
    attributes::PhysicalKind physical_kind = attributes::PhysicalKind::rigid;
    std::vector<std::string> tags;
    Vec3 size;  ///< m
    GeometryKind geometry_kind = GeometryKind::mesh;
    std::uint32_t vertices = 0, triangles = 0, parts = 0;
    int quality = 0;                 ///< 0 broken … 3 precise
    std::uint64_t content_hash = 0;  ///< changes when the model's geometry does: for caches
};

struct SearchQuery {
    std::string words = {};     ///< full text over name, tags, category, source; prefixes match; empty: all
    std::string category = {};  ///< exact; empty: all
    int limit = 50;             ///< 1 … 1000
    int offset = 0;
};
struct SearchPage {
    std::vector<ModelSummary> models;  ///< best match first; by name where there are no words
    std::int64_t total = 0;
};
struct CategoryCount {
    std::string category;
    std::int64_t models = 0;
};

struct ImportProgress {
    std::size_t done = 0, total = 0, failed = 0, unchanged = 0;  ///< total 0: files are still looked for
    std::string current;  ///< name of the model just finished, or of the file that is read for changes
};
struct ImportFailure {
    std::string path;
    Error error;
};
struct ImportReport {
    std::size_t added = 0, updated = 0, unchanged = 0;
    std::vector<std::string> keys;  ///< of the models added, updated or found unchanged; the first 1000
    std::vector<ImportFailure> failures;
    std::size_t shapeless = 0;  ///< light sources of catalogues that are nothing but light: left out, no failures
    double seconds = 0;
    bool stopped = false;  ///< the progress callback asked to stop; the next import goes on from there
};
struct ImportOptions {
    int workers = 0;                                           ///< 0: one a core
    bool again = false;                                        ///< prepare also what is in the database unchanged
    std::filesystem::path worker_program = {};                 ///< empty: beside the running program
    std::set<std::string> wanted = {};                         ///< keys of models that are prepared before all others
    bool in_background = false;                                ///< what else runs on this machine goes first
    std::optional<Collection> collection = {};                 ///< facts about the files; see catalog/collection.h
    std::function<bool(const ImportProgress&)> progress = {};  ///< returns false to stop; may be empty
};

struct OpenOptions {
    /// Called again and again while all models are resolved anew, because the taxonomy has changed; false ends that
    /// with an error, and the next opening goes on from there. May be empty.
    std::function<bool(std::size_t done, std::size_t total)> progress = {};
};

/// Another model with the form and the picture of one that is there: for large catalogues to measure with.
struct ModelVariant {
    std::int64_t like = 0;  ///< id of the model that it is like
    std::string key, name;
    std::vector<std::string> tags, material_names;  ///< no material names: those of `like`
    double scale = 1;                               ///< of the size and of all that attributes are resolved from
};

/// The model database: what exists, what it looks like, what it is made of. One instance a thread; any number of
/// processes may have the same file open.
class Catalog {
public:
    /// Opens or creates the file (and its folder); migrates an older schema; refuses a newer one by name. Where the
    /// taxonomy is not that of last time, resolves all models anew: 60,000 take some tens of seconds.
    static Result<std::unique_ptr<Catalog>> open(const std::filesystem::path& file,
                                                 const std::filesystem::path& taxonomy_folder,
                                                 const OpenOptions& options = {},
                                                 const std::filesystem::path& user_taxonomy = user_taxonomy_folder());
    /// $XDG_DATA_HOME/embody/models.sqlite, or ~/.local/share/embody/models.sqlite.
    static std::filesystem::path default_file();
    /// Folder of the user's own categories: $EMBODY_TAXONOMY, else $XDG_CONFIG_HOME/embody/taxonomy or
    /// ~/.config/embody/taxonomy where that folder exists, else empty.
    static std::filesystem::path user_taxonomy_folder();
    ~Catalog();

    /// The taxonomy that it resolves attributes by.
    [[nodiscard]] const attributes::Taxonomy& taxonomy() const;

    Result<SearchPage> search(const SearchQuery& query) const;
    Result<std::vector<CategoryCount>> categories() const;
    /// Finds a model by key, id as decimal text, or a name that only one model has.
    Result<ModelSummary> model(std::string_view key_or_id_or_name) const;
    [[nodiscard]] std::int64_t model_count() const;

    Result<attributes::ModelFacts> facts(std::int64_t id) const;
    /// Automatic attributes, replaced by the manual ones.
    Result<attributes::AttributeSet> attributes(std::int64_t id) const;
    /// Without the manual ones: the values after a reset.
    Result<attributes::AttributeSet> automatic_attributes(std::int64_t id) const;
    /// A manual change by a person; survives re-import. Refused where the attribute does not concern the model's kind.
    Result<void> set_attribute(std::int64_t id, std::string_view name, const attributes::AttributeValue& value);
    Result<void> reset_attribute(std::int64_t id, std::string_view name);

    /// Which models a change is for: these, or all that the query finds, whatever its limit and offset.
    using ModelChoice = std::variant<std::vector<std::int64_t>, SearchQuery>;
    /// Manual changes of many models, all or nothing. Where models refuse and options do not skip them, the report
    /// names them and its batch is 0. Where one model was changed, the decomposition or the tetrahedra that it
    /// then needs are made at once. Errors: a wrong name or value, a model that is not there, stopped.
    Result<ChangeReport> change_attributes(const ModelChoice& models, const std::vector<AttributeChange>& changes,
                                           const ChangeOptions& options = {});
    /// Restores the manual values from before a batch of changes; of an undo: does again what it took back. 0: the last
    /// batch of this person. Where values were changed since, the report names them and nothing is done. Errors: no
    /// such batch, undone already.
    Result<ChangeReport> undo_changes(std::int64_t batch, const ChangeOptions& options = {});
    /// Who changed what when, newest first.
    Result<std::vector<ChangeRecord>> history(const HistoryQuery& query) const;
    /// As above by acts, newest first.
    Result<std::vector<ChangeBatchRecord>> history_batches(const BatchQuery& query) const;
    /// What others (another instance or process) changed by hand in this file since the last call, oldest first. Costs
    /// little where nobody wrote.
    Result<std::vector<ChangeBatchRecord>> changes_of_others();
    /// Sets the program or client through which the person acts from now on, for the history: "Studio client 2".
    void set_session(std::string session);

    Result<std::vector<std::uint8_t>> thumbnail(std::int64_t id) const;  ///< PNG
    Result<std::vector<std::uint8_t>> geometry_glb(
        std::int64_t id) const;                                    ///< with materials and textures, for drawing
    Result<std::vector<Vec3>> hull_points(std::int64_t id) const;  ///< model frame
    Result<geometry::TriangleMesh> mesh(std::int64_t id) const;    ///< model frame, all parts
    /// The convex decomposition with these limits (1 … 256 hulls; hull_error in m, at least 1e-4): as the import made
    /// it, or made now (some tenths of a second) and kept for the next time.
    Result<ConvexParts> convex_parts(std::int64_t id, int max_hulls, double hull_error) const;

    /// The tetrahedra of a soft model: as the import made them, or made now (some tenths of a second) and kept for the
    /// next time. Why it cannot be soft is kept, too.
    Result<SoftMesh> soft_mesh(std::int64_t id, int resolution = 0) const;

    /// Imports files, folders and catalogues (.sh3f, the Sweet Home 3D jar); without paths, the folders of the
    /// collection in the options. Fails only if nothing can be imported at all; what is wrong with single files is in
    /// the report.
    Result<ImportReport> import(const std::vector<std::filesystem::path>& paths, const ImportOptions& options);
    Result<void> remove(std::int64_t id);
    /// Adds all of them or none. Variants use one stored geometry, so its size is not the variant's.
    Result<void> add_variants(const std::vector<ModelVariant>& variants);

private:
    Catalog();
    /// Makes the decomposition or the tetrahedra that a change of one model requires, so that no one waits later.
    void prepare_shape(const ChangeReport& report) const;
    void after_change(const ChangeReport& report);
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::catalog
