// SPDX-License-Identifier: MIT
#include "catalog/catalog.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <set>

#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "catalog/describe_many.h"
#include "catalog/describe_model.h"
#include "catalog/import/importer.h"
#include "catalog/knowledge_json.h"
#include "catalog/manual_changes.h"
#include "catalog/prepare/confined_pool.h"
#include "catalog/primitives.h"
#include "catalog/stored_parts.h"
#include "database/model_schema.h"
#include "database/transaction.h"
#include "geometry/decomposition/decomposition.h"
#include "interchange/compact/compact_geometry.h"

namespace embody::catalog {
namespace {

constexpr const char* taxonomy_setting = "taxonomy_hash";
constexpr const char* refresh_setting = "taxonomy_refresh";  // how far the change to another taxonomy is
constexpr const char* primitives_setting = "primitives_revision";

ModelSummary summary_of(database::ModelRow row) {
    ModelSummary model;
    model.id = row.id;
    model.key = std::move(row.key);
    model.name = std::move(row.name);
    model.source = std::move(row.source);
    model.licence = std::move(row.licence);
    model.author = std::move(row.author);
    model.category = std::move(row.category);
    model.subcategory = std::move(row.subcategory);
    model.physical_kind = attributes::kind_from_text(row.physical_kind).value_or(model.physical_kind);
    model.tags = std::move(row.tags);
    model.size = {row.size[0], row.size[1], row.size[2]};
    model.geometry_kind = kind_from_name(row.geometry_kind);
    model.vertices = row.vertices;
    model.triangles = row.triangles;
    model.parts = row.parts;
    model.quality = row.quality;
    model.content_hash = row.geometry_hash;
    return model;
}

/// Who sets an attribute: the login name, else the user's number.
std::string current_person() {
    const char* name = std::getenv("USER");
    return name && *name ? valid_utf8(name) : "user " + std::to_string(geteuid());
}

}  // namespace

struct Catalog::State {
    State(std::unique_ptr<database::Connection> opened, std::unique_ptr<attributes::Taxonomy> loaded)
        : connection(std::move(opened)),
          taxonomy(std::move(loaded)),
          models(*connection),
          manual(*connection),
          changes(*connection, [this](std::int64_t id) { return classify_again(id); }) {}

    std::unique_ptr<database::Connection> connection;
    std::unique_ptr<attributes::Taxonomy> taxonomy;
    database::ModelTable models;
    database::ManualAttributeTable manual;
    ManualChanges changes;
    Author author{current_person(), {}};
    // The last change that changes_of_others() has read, and changes that it must not report.
    std::int64_t seen_version = -1, seen_batch = 0;
    std::set<std::int64_t> own_batches;
    TaskPool workers{TaskPool::workers_that_pay()};  ///< no threads before the first use

    // The stored facts of one model, read from the database.
    struct Known {
        database::ModelRow row;
        attributes::ModelFacts facts;
        attributes::AttributeSet automatic;
        std::vector<attributes::AttributeEntry> manual;
    };
    Result<database::ModelRow> row(std::int64_t id);
    Result<Known> known(std::int64_t id);
    Result<Description> description(std::int64_t id);
    Result<void> refresh_attributes(const std::string& hash, const OpenOptions& options);
    Result<bool> refresh_batch(const std::string& hash, const std::vector<std::int64_t>& ids, std::size_t& done);
    Result<void> store_primitives();
    Result<void> classify_again(std::int64_t id);
};

Catalog::Catalog() = default;
Catalog::~Catalog() = default;

const attributes::Taxonomy& Catalog::taxonomy() const { return *state_->taxonomy; }

Result<std::unique_ptr<Catalog>> Catalog::open(const std::filesystem::path& file,
                                               const std::filesystem::path& taxonomy_folder, const OpenOptions& options,
                                               const std::filesystem::path& user_taxonomy) {
    auto taxonomy = attributes::Taxonomy::load(taxonomy_folder, user_taxonomy);
    if (!taxonomy) return taxonomy.error();
    auto connection = database::open_model_database(file);
    if (!connection) return connection.error();

    std::unique_ptr<Catalog> catalog(new Catalog);
    catalog->state_ = std::make_unique<State>(std::move(*connection), std::move(*taxonomy));
    const auto newest = catalog->state_->changes.newest_batch();
    if (!newest) return newest.error();
    catalog->state_->seen_batch = *newest;

    if (catalog->state_->connection->is_read_only()) return catalog;

    // Another taxonomy than the one that the stored attributes come from: resolve them all again.
    const std::string hash = taxonomy_hash(taxonomy_folder, user_taxonomy);
    const auto stored_hash = database::SettingTable(*catalog->state_->connection).get(taxonomy_setting);
    if (!stored_hash) return stored_hash.error();
    if (*stored_hash != hash) {
        if (auto refreshed = catalog->state_->refresh_attributes(hash, options); !refreshed) return refreshed.error();
    }
    if (auto stored = catalog->state_->store_primitives(); !stored) return stored.error();
    return catalog;
}

std::filesystem::path Catalog::default_file() {
    // The XDG base directory specification: a relative XDG_DATA_HOME is to be ignored.
    const char* data = std::getenv("XDG_DATA_HOME");
    const char* home = std::getenv("HOME");
    std::filesystem::path folder = data ? data : "";
    if (!folder.is_absolute()) folder = std::filesystem::path(home ? home : ".") / ".local" / "share";
    return folder / "embody" / "models.sqlite";
}

std::filesystem::path Catalog::user_taxonomy_folder() {
    const char* named = std::getenv("EMBODY_TAXONOMY");
    if (named != nullptr && *named != '\0') return named;
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    std::filesystem::path folder = config ? config : "";
    if (!folder.is_absolute()) folder = std::filesystem::path(home ? home : ".") / ".config";
    folder = folder / "embody" / "taxonomy";
    std::error_code ignored;
    return std::filesystem::is_directory(folder, ignored) ? folder : std::filesystem::path();
}

Result<SearchPage> Catalog::search(const SearchQuery& query) const {
    auto matches = state_->models.search({.words = query.words,
                                          .category = query.category,
                                          .limit = std::clamp(query.limit, 1, 1000),
                                          .offset = std::max(query.offset, 0)});
    if (!matches) return matches.error();
    SearchPage page;
    page.total = matches->total;
    for (database::ModelRow& row : matches->models) page.models.push_back(summary_of(std::move(row)));
    return page;
}

Result<std::vector<CategoryCount>> Catalog::categories() const {
    auto counts = state_->models.count_categories();
    if (!counts) return counts.error();
    std::vector<CategoryCount> categories;
    for (auto& [category, models] : *counts) categories.push_back({std::move(category), models});
    return categories;
}

Result<ModelSummary> Catalog::model(std::string_view key_or_id_or_name) const {
    auto by_key = state_->models.find_key(key_or_id_or_name);
    if (!by_key) return by_key.error();
    if (*by_key) return summary_of(std::move(**by_key));

    std::int64_t id = 0;
    const char* end = key_or_id_or_name.data() + key_or_id_or_name.size();
    const auto [parsed, problem] = std::from_chars(key_or_id_or_name.data(), end, id);
    if (problem == std::errc() && parsed == end) {
        auto by_id = state_->models.find(id);
        if (!by_id) return by_id.error();
        if (*by_id) return summary_of(std::move(**by_id));
    }

    auto by_name = state_->models.find_name(key_or_id_or_name);
    if (!by_name) return by_name.error();
    if (by_name->size() == 1) return summary_of(std::move(by_name->front()));
    if (by_name->empty()) {
        return Error{std::string(key_or_id_or_name), "no model has this key, id or name", "embody search finds models"};
    }
    return Error{std::string(key_or_id_or_name), "more than one model has this name",
                 "name it by its key, such as " + by_name->front().key};
}

std::int64_t Catalog::model_count() const {
    const auto count = state_->models.count();
    return count ? *count : 0;
}

Result<database::ModelRow> Catalog::State::row(std::int64_t id) {
    auto found = models.find(id);
    if (!found) return found.error();
    if (!*found) return Error{connection->file().string(), "has no model with id " + std::to_string(id), {}};
    return std::move(**found);
}

Result<Catalog::State::Known> Catalog::State::known(std::int64_t id) {
    Known known;
    auto found = row(id);
    if (!found) return found.error();
    known.row = std::move(*found);
    const auto knowledge = models.knowledge(id);
    if (!knowledge) return knowledge.error();
    auto facts = facts_from_json(knowledge->facts);
    if (!facts) return facts.error();
    known.facts = std::move(*facts);
    auto automatic = set_from_json(knowledge->automatic);
    if (!automatic) return automatic.error();
    known.automatic = std::move(*automatic);
    const auto stored = manual.of(known.row.key);
    if (!stored) return stored.error();
    known.manual = manual_entries(*stored);
    return known;
}

Result<attributes::ModelFacts> Catalog::facts(std::int64_t id) const {
    const auto knowledge = state_->models.knowledge(id);
    if (!knowledge) return knowledge.error();
    return facts_from_json(knowledge->facts);
}

Result<attributes::AttributeSet> Catalog::automatic_attributes(std::int64_t id) const {
    const auto knowledge = state_->models.knowledge(id);
    if (!knowledge) return knowledge.error();
    return set_from_json(knowledge->automatic);
}

Result<attributes::AttributeSet> Catalog::attributes(std::int64_t id) const {
    auto known = state_->known(id);
    if (!known) return known.error();
    if (known->manual.empty()) return std::move(known->automatic);
    return attributes::with_manual(*state_->taxonomy, known->automatic, known->manual, known->facts);
}

namespace {

// A change of one model either happens or is an error.
Result<void> need_done(const Result<ChangeReport>& report) {
    if (!report) return report.error();
    if (report->refused.empty()) return {};
    const RefusedChange& refused = report->refused.front();
    return Error{refused.attribute, refused.why + ", as " + refused.name + " is"};
}

std::string in_words(const SearchQuery& query) {
    std::string asked = query.words.empty() ? "all models" : "models found by \"" + valid_utf8(query.words) + "\"";
    if (!query.category.empty()) asked += " of the category " + valid_utf8(query.category);
    return asked;
}

}  // namespace

Result<void> Catalog::set_attribute(std::int64_t id, std::string_view name, const attributes::AttributeValue& value) {
    return need_done(change_attributes(std::vector{id}, {{std::string(name), value}}));
}

Result<void> Catalog::reset_attribute(std::int64_t id, std::string_view name) {
    return need_done(change_attributes(std::vector{id}, {{std::string(name)}}));
}

void Catalog::prepare_shape(const ChangeReport& report) const {
    const auto is_of_shape = [](const std::string& name) {
        return name == "collision_shape" || name == "max_hulls" || name == "hull_error" || name == "kind" ||
               name == "category";
    };
    if (report.batch == 0 || report.models.size() != 1 || report.models.front().id == 0 ||
        std::none_of(report.attributes.begin(), report.attributes.end(), is_of_shape))
        return;
    const auto set = attributes(report.models.front().id);
    if (!set) return;
    if (attributes::matter_of(*set) == attributes::Matter::solid) (void)soft_mesh(report.models.front().id);
    if (set->word("collision_shape", "") != "decomposition") return;
    // An error here occurs again where the shape is needed, and is reported there.
    const geometry::DecompositionParameters usual;
    (void)convex_parts(report.models.front().id, static_cast<int>(set->number("max_hulls", usual.max_hulls)),
                       set->number("hull_error", usual.hull_error));
}

Result<ChangeReport> Catalog::change_attributes(const ModelChoice& models, const std::vector<AttributeChange>& asked,
                                                const ChangeOptions& options) {
    std::vector<AttributeChange> changes = asked;
    for (AttributeChange& change : changes) {
        if (!change.value) continue;
        auto known = attributes::known_value(*state_->taxonomy, change.name, std::move(*change.value));
        if (!known) return known.error();
        change.value = std::move(*known);
    }
    const auto find_all = [&](database::ModelTable& table) -> Result<std::vector<database::ModelRow>> {
        if (const auto* query = std::get_if<SearchQuery>(&models)) {
            auto found = table.search({.words = query->words,
                                       .category = query->category,
                                       .limit = std::numeric_limits<int>::max(),
                                       .offset = 0});
            if (!found) return found.error();
            return std::move(found->models);
        }
        std::vector<database::ModelRow> rows;
        for (const std::int64_t id : std::get<std::vector<std::int64_t>>(models)) {
            auto row = state_->row(id);
            if (!row) return row.error();
            rows.push_back(std::move(*row));
        }
        return rows;
    };
    const auto* query = std::get_if<SearchQuery>(&models);
    auto report = state_->changes.change(find_all, changes, options, state_->author, query ? in_words(*query) : "");
    if (report) after_change(*report);
    return report;
}

Result<ChangeReport> Catalog::undo_changes(std::int64_t batch, const ChangeOptions& options) {
    auto report = state_->changes.undo(batch, options, state_->author);
    if (report) after_change(*report);
    return report;
}

void Catalog::after_change(const ChangeReport& report) {
    if (report.batch != 0) state_->own_batches.insert(report.batch);
    prepare_shape(report);
}

Result<std::vector<ChangeRecord>> Catalog::history(const HistoryQuery& query) const {
    return state_->changes.history(query);
}

Result<std::vector<ChangeBatchRecord>> Catalog::history_batches(const BatchQuery& query) const {
    return state_->changes.batches(query);
}

Result<std::vector<ChangeBatchRecord>> Catalog::changes_of_others() {
    State& state = *state_;
    // SQLite's count of commits by other connections: reading it costs no query.
    const auto version = state.connection->query_integer("PRAGMA data_version");
    if (!version) return version.error();
    if (*version == state.seen_version) return std::vector<ChangeBatchRecord>();
    auto batches = state.changes.batches({.after = state.seen_batch, .limit = 1000, .changes = 1000});
    if (!batches) return batches;
    state.seen_version = *version;
    if (!batches->empty()) state.seen_batch = batches->front().changes.front().batch;
    std::erase_if(*batches, [&](const ChangeBatchRecord& batch) {
        return state.own_batches.contains(batch.changes.front().batch);
    });
    std::erase_if(state.own_batches, [&](std::int64_t batch) { return batch <= state.seen_batch; });
    std::reverse(batches->begin(), batches->end());
    return batches;
}

void Catalog::set_session(std::string session) { state_->author.session = valid_utf8(session); }

Result<void> Catalog::State::classify_again(std::int64_t id) {
    // A person may have changed the category or the kind, by which the model is listed.
    auto model = known(id);
    if (!model) return model.error();
    classify(model->row, model->facts, model->automatic, model->manual);
    const auto knowledge = models.knowledge(id);
    if (!knowledge) return knowledge.error();
    return models.describe(model->row, *knowledge);
}

Result<Description> Catalog::State::description(std::int64_t id) {
    Description description;
    auto model = row(id);
    if (!model) return model.error();
    auto knowledge = models.knowledge(id);
    if (!knowledge) return knowledge.error();
    const auto stored = manual.of(model->key);
    if (!stored) return stored.error();
    description.row = std::move(*model);
    description.knowledge = std::move(*knowledge);
    description.manual = manual_entries(*stored);
    return description;
}

Result<void> Catalog::State::refresh_attributes(const std::string& hash, const OpenOptions& options) {
    const auto ids = models.ids();
    if (!ids) return ids.error();
    for (std::size_t done = 0;;) {
        const auto more = refresh_batch(hash, *ids, done);
        if (!more) return more.error();
        if (!*more) return {};
        if (options.progress && !options.progress(done, ids->size())) {
            return Error{connection->file().string(),
                         "resolving all models by the changed taxonomy was stopped at " + std::to_string(done) +
                             " of " + std::to_string(ids->size()),
                         "the next start goes on from there"};
        }
    }
}

Result<bool> Catalog::State::refresh_batch(const std::string& hash, const std::vector<std::int64_t>& ids,
                                           std::size_t& done) {
    // The progress is stored in the database, and changes with the models: neither a kill nor another process that does
    // the same makes a difference. Until all is done, the database counts as of no taxonomy.
    constexpr std::size_t batch = 512;
    auto transaction = database::Transaction::begin(*connection);
    if (!transaction) return transaction.error();
    database::SettingTable settings(*connection);
    const auto whole = settings.get(taxonomy_setting);
    if (!whole) return whole.error();
    if (*whole == hash) return false;
    const auto part = settings.get(refresh_setting);
    if (!part) return part.error();
    const std::string mark = hash + " up to model ";
    const std::int64_t last = part->starts_with(mark) ? std::atoll(part->c_str() + mark.size()) : 0;
    const auto first = std::upper_bound(ids.begin(), ids.end(), last);
    const auto end = first + std::min<std::ptrdiff_t>(batch, ids.end() - first);
    done = static_cast<std::size_t>(end - ids.begin());

    // Models that another process has removed meanwhile are left out.
    std::vector<Description> descriptions;
    for (auto id = first; id != end; ++id) {
        const auto there = models.find(*id);
        if (!there) return there.error();
        if (!*there) continue;
        auto one = description(*id);
        if (!one) return one.error();
        descriptions.push_back(std::move(*one));
    }
    describe_all(descriptions, *taxonomy, workers);
    for (const Description& one : descriptions) {
        if (one.problem) return Error{one.row.key, one.problem->message(), "import the model again"};
        const auto put =
            one.row_is_new ? models.describe(one.row, one.knowledge) : models.put_knowledge(one.row.id, one.knowledge);
        if (!put) return put.error();
    }

    const bool more = end != ids.end();
    if (auto noted = settings.put(taxonomy_setting, more ? std::string() : hash); !noted) return noted.error();
    if (auto noted = settings.put(refresh_setting, more ? mark + std::to_string(*(end - 1)) : std::string()); !noted)
        return noted.error();
    if (auto committed = transaction->commit(); !committed) return committed.error();
    return more;
}

Result<void> Catalog::add_variants(const std::vector<ModelVariant>& variants) {
    auto transaction = database::Transaction::begin(*state_->connection);
    if (!transaction) return transaction.error();
    std::vector<Description> descriptions;
    descriptions.reserve(variants.size());
    for (const ModelVariant& variant : variants) {
        auto one = state_->description(variant.like);
        if (!one) return one.error();
        one->variant = &variant;
        descriptions.push_back(std::move(*one));
    }
    describe_all(descriptions, *state_->taxonomy, state_->workers);
    for (const Description& one : descriptions) {
        if (one.problem) return Error{one.row.key, one.problem->message(), "import the model again"};
        const auto put = state_->models.put_like(one.variant->like, one.row, one.knowledge);
        if (!put) return put.error();
    }
    return transaction->commit();
}

Result<void> Catalog::State::store_primitives() {
    // Once a database: a person who removed a model does not want it back at the next start.
    database::SettingTable settings(*connection);
    const auto stored_revision = settings.get(primitives_setting);
    if (!stored_revision) return stored_revision.error();
    if (*stored_revision == primitives_revision) return {};
    const auto primitives = make_primitives();
    if (!primitives) return primitives.error();
    Importer importer(*connection, *taxonomy, nullptr);
    for (const Primitive& primitive : *primitives) {
        const auto stored =
            importer.store(primitive.item, primitive.model, built_in_source(primitive.item, primitives_revision),
                           GeometryKind::analytical);
        if (!stored) return stored.error();
    }
    return settings.put(primitives_setting, primitives_revision);
}

Result<std::vector<std::uint8_t>> Catalog::thumbnail(std::int64_t id) const { return state_->models.thumbnail(id); }

Result<std::vector<Vec3>> Catalog::hull_points(std::int64_t id) const {
    const auto bytes = state_->models.hull_points(id);
    if (!bytes) return bytes.error();
    if (bytes->size() % 12 != 0) {
        return Error{state_->connection->file().string(), "hull of model " + std::to_string(id) + " is damaged",
                     "import the model again"};
    }
    const auto number = [&](std::size_t at) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{(*bytes)[at + i]} << (8 * i);
        return static_cast<double>(std::bit_cast<float>(bits));
    };
    std::vector<Vec3> points;
    points.reserve(bytes->size() / 12);
    for (std::size_t at = 0; at < bytes->size(); at += 12)
        points.push_back({number(at), number(at + 4), number(at + 8)});
    return points;
}

Result<std::vector<std::uint8_t>> Catalog::geometry_glb(std::int64_t id) const {
    const auto compact = state_->models.geometry(id);
    if (!compact) return compact.error();
    return interchange::to_glb(*compact);
}

Result<geometry::TriangleMesh> Catalog::mesh(std::int64_t id) const {
    const auto compact = state_->models.geometry(id);
    if (!compact) return compact.error();
    return interchange::decode_mesh(*compact);
}

Result<ConvexParts> Catalog::convex_parts(std::int64_t id, int max_hulls, double hull_error) const {
    database::DecompositionTable table(*state_->connection);
    const double error = std::max(hull_error, geometry::min_hull_error);
    const auto stored = table.find(id, max_hulls, micrometres(error));
    if (!stored) return stored.error();
    if (*stored) {
        // Unreadable data is made again.
        if (auto parts = parts_from(**stored)) return parts;
    }
    const auto model = mesh(id);
    if (!model) return model.error();
    auto parts = make_convex_parts(*model, max_hulls, error);
    if (!parts || state_->connection->is_read_only()) return parts;
    if (auto kept = table.put(id, stored_form(*parts)); !kept) return kept.error();
    return parts;
}

Result<SoftMesh> Catalog::soft_mesh(std::int64_t id, int resolution) const {
    if (resolution > 0) {
        const auto surface = mesh(id);
        if (!surface) return surface.error();
        return make_soft_mesh(*surface, resolution);
    }
    database::SimulationMeshTable table(*state_->connection);
    const auto stored = table.find(id, attributes::to_text(attributes::PhysicalKind::soft));
    if (!stored) return stored.error();
    if (*stored && is_current(**stored)) {
        auto mesh = soft_mesh_from(**stored);
        // Unreadable data is made again.
        if (mesh || !(*stored)->problem.empty()) return mesh;
    }
    const auto model = mesh(id);
    if (!model) return model.error();
    auto made = make_soft_mesh(*model);
    if (state_->connection->is_read_only()) return made;
    if (auto kept = table.put(id, stored_form(made)); !kept) return kept.error();
    return made;
}

Result<ImportReport> Catalog::import(const std::vector<std::filesystem::path>& paths, const ImportOptions& options) {
    if (auto writable = state_->connection->need_writable(); !writable) return writable.error();
    ConfinedPoolOptions pool;
    pool.workers = options.workers;
    pool.worker_program = options.worker_program;
    pool.in_background = options.in_background;
    // Repeats the last progress, so that a person can stop within a model, too.
    ImportOptions watched = options;
    ImportProgress last;
    if (options.progress) {
        watched.progress = [&](const ImportProgress& progress) { return options.progress(last = progress); };
        pool.go_on = [&] { return options.progress(last); };
    }
    Importer importer(*state_->connection, *state_->taxonomy,
                      [&pool](const auto& items, const auto& done) { return prepare_confined(items, pool, done); });
    return importer.run(paths, watched);
}

Result<void> Catalog::remove(std::int64_t id) { return state_->models.remove(id); }

}  // namespace embody::catalog
