// SPDX-License-Identifier: MIT
#include "catalog/import/importer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <system_error>

#include "attributes/physical_kind.h"
#include "catalog/describe_model.h"
#include "catalog/import/file_fingerprint.h"
#include "catalog/knowledge_json.h"
#include "catalog/stored_parts.h"
#include "database/transaction.h"
#include "foundation/state_hash.h"
#include "interchange/archive/archive.h"
#include "interchange/compact/compact_geometry.h"
#include "interchange/read_model.h"

namespace embody::catalog {
namespace {

namespace fs = std::filesystem;

// Raise when preparing gives another result from the same file: the next import prepares all models again.
constexpr std::uint64_t preparation_revision = 4;

void add_text(StateHash& hash, const std::string& text) {
    hash.add(std::uint64_t{text.size()});
    hash.add_bytes(text.data(), text.size());
}

/// All that the prepared geometry and thumbnail depend on.
std::uint64_t hash_preparation(const ImportItem& item, std::uint64_t file_hash) {
    StateHash hash;
    hash.add(preparation_revision);
    hash.add(file_hash);
    add_text(hash, item.archive.empty() ? std::string() : item.path);
    add_text(hash, item.icon_path);
    hash.add(std::uint64_t{item.stated_size.has_value()});
    for (const double length : item.stated_size.value_or(std::array<double, 3>{})) hash.add(length);
    if (item.stated_unit) hash.add(*item.stated_unit);
    for (const double number : item.stated_rotation) hash.add(number);
    for (const interchange::Recolor& recolor : item.recolors) {
        add_text(hash, recolor.material);
        for (const double part : recolor.color) hash.add(part);
    }
    return hash.value();
}

/// What is read from the catalogue alone and can be stored again without preparing.
std::uint64_t hash_words(const ImportItem& item) {
    StateHash hash;
    for (const std::string* text : {&item.name, &item.source, &item.licence, &item.author, &item.category}) {
        add_text(hash, *text);
    }
    for (const std::string& tag : item.tags) add_text(hash, tag);
    if (!item.stated_thing.empty()) add_text(hash, item.stated_thing);
    hash.add(std::uint64_t{item.movable ? 1u + *item.movable : 0u});
    hash.add(std::uint64_t{item.door_or_window});
    return hash.value();
}

std::uint64_t hash_bytes(std::span<const std::uint8_t> bytes) {
    StateHash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.value();
}

std::string hexadecimal(std::uint64_t number) {
    std::string text(16, '0');
    for (std::size_t i = 16; i-- > 0; number >>= 4) text[i] = "0123456789abcdef"[number & 15];
    return text;
}

std::vector<std::uint8_t> pack_points(const std::vector<Vec3f>& points) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(points.size() * 12);
    for (const Vec3f& point : points) {
        for (const float number : {point.x, point.y, point.z}) {
            const auto bits = std::bit_cast<std::uint32_t>(number);
            for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
        }
    }
    return bytes;
}

/// All of the row that needs no attributes.
database::ModelRow make_row(const ImportItem& item, const PreparedModel& prepared, const database::ImportSource& source,
                            GeometryKind kind) {
    database::ModelRow row;
    row.key = item.key;
    apply_item(row, item);
    const Vec3 size = prepared.facts.geometry.size;
    row.size = {size.x, size.y, size.z};
    row.geometry_kind = name_of(kind);
    row.vertices = prepared.vertices;
    row.triangles = prepared.triangles;
    row.parts = prepared.parts;
    row.materials = prepared.materials;
    row.images = prepared.images;
    row.quality = std::clamp(prepared.quality, 0, 3);
    row.file_hash = item.archive.empty() ? source.file_hash : prepared.content_hash;
    row.geometry_hash = hash_bytes(prepared.geometry);
    return row;
}

}  // namespace

database::ImportSource built_in_source(const ImportItem& item, const std::string& revision) {
    StateHash hash;
    add_text(hash, revision);
    database::ImportSource source;
    source.location = "built-in!" + item.key;
    source.prepare_hash = hash_preparation(item, hash.value());
    source.item_hash = hash_words(item);
    return source;
}

Importer::Importer(database::Connection& connection, const attributes::Taxonomy& taxonomy, PrepareModels prepare)
    : connection_(connection),
      taxonomy_(taxonomy),
      prepare_(std::move(prepare)),
      models_(connection),
      manual_(connection),
      imports_(connection) {}

Result<ImportReport> Importer::run(const std::vector<fs::path>& paths, const ImportOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    planned_.clear();
    planned_keys_.clear();
    in_other_unit_.clear();
    report_ = {};
    progress_ = {};
    again_ = options.again;

    // Finds the items, and what is to be done with each.
    FoundModels found = find_models(paths, options.collection, [&] { return tell_progress(options, {}); });
    report_.failures = std::move(found.failures);
    progress_.total = found.models.size();
    if (auto planned = plan(std::move(found.models), options); !planned) return planned.error();
    std::stable_partition(planned_.begin(), planned_.end(),
                          [&](const Planned& planned) { return options.wanted.contains(planned.item.key); });
    progress_.done = progress_.total - planned_.size();
    progress_.unchanged = report_.unchanged;
    progress_.failed = report_.failures.size();

    // Does it.
    if (report_.stopped || !tell_progress(options, {})) {
        report_.stopped = true;
    } else if (!planned_.empty()) {
        if (auto prepared = prepare_planned(planned_, options); !prepared) return prepared.error();
        const std::vector<Planned> once_more = std::move(in_other_unit_);
        if (!once_more.empty() && !report_.stopped) {
            if (auto prepared = prepare_planned(once_more, options); !prepared) return prepared.error();
        }
    }
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(report_);
}

Result<void> Importer::plan(std::vector<FoundModel> found, const ImportOptions& options) {
    // A file that cannot be read is one failure and no reason to stop.
    std::vector<std::pair<FoundModel, database::ImportSource>> readable;
    readable.reserve(found.size());
    for (FoundModel& model : found) {
        constexpr std::size_t asked_every = 256;
        if (readable.size() % asked_every == 0 && !tell_progress(options, {})) report_.stopped = true;
        if (report_.stopped) return {};
        auto source = read_source(model, options);
        if (source && report_.stopped) return {};
        if (source) {
            readable.emplace_back(std::move(model), std::move(*source));
        } else {
            report_.failures.push_back({model.location, source.error()});
        }
    }

    // One transaction: nine hundred small ones would take longer than all else that an import without news does.
    auto transaction = database::Transaction::begin(connection_);
    if (!transaction) return transaction.error();
    for (auto& [model, source] : readable) {
        if (auto planned = plan_model(std::move(model), std::move(source)); !planned) return planned;
    }
    return transaction->commit();
}

Result<database::ImportSource> Importer::read_source(const FoundModel& model, const ImportOptions& options) {
    database::ImportSource source;
    source.location = model.location;
    auto stamp = stamp_file(model.file);
    if (!stamp) return stamp.error();
    source.stamp = std::move(*stamp);

    // A file that looks as it did at the last import is not read again.
    auto before =
        model.item.archive.empty() ? imports_.find(model.location) : imports_.find_in_archive(model.item.archive);
    if (!before) return before.error();
    if (*before && (*before)->stamp == source.stamp) {
        source.file_hash = (*before)->file_hash;
    } else if (last_file_.file == model.file && last_file_.stamp == source.stamp) {
        source.file_hash = last_file_.hash;
    } else {
        const auto hash = hash_content(model, options);
        if (!hash) return hash.error();
        report_.stopped = !hash->has_value();
        source.file_hash = hash->value_or(0);
    }
    last_file_ = {model.file, source.stamp, source.file_hash};
    source.prepare_hash = hash_preparation(model.item, source.file_hash);
    source.item_hash = hash_words(model.item);
    return source;
}

Result<std::optional<std::uint64_t>> Importer::hash_content(const FoundModel& model, const ImportOptions& options) {
    const std::uint64_t limit =
        model.item.archive.empty() ? interchange::Archive::default_limit : interchange::Archive::max_file_bytes;
    return hash_file(model.file, limit, [&](std::uint64_t done, std::uint64_t total) {
        // Small files are read at once; for large ones a person sees the progress.
        const std::uint64_t percent = total == 0 ? 100 : 100 * done / total;
        const std::string far = done == 0 ? "" : ", read to " + std::to_string(percent) + " %";
        return tell_progress(options, model.file.filename().string() + far);
    });
}

Result<void> Importer::plan_model(FoundModel model, database::ImportSource source) {
    auto identity = identify(model, source);
    if (!identity) return identity.error();
    model.item.key = identity->key;

    // The same content twice in one import.
    if (planned_keys_.contains(identity->key)) {
        ++report_.unchanged;
        return {};
    }

    // In the database as it is: from here, or the same from somewhere else.
    if (identity->model) {
        source.model = identity->model->id;
        const auto stored = is_stored(source.model, source);
        if (!stored) return stored.error();
        if (*stored) {
            ++report_.unchanged;
            name_in_report(identity->key);
            return keep(model.item, *identity->model, source);
        }
    }
    planned_keys_.insert(identity->key);
    planned_.push_back({std::move(model.item), std::move(source)});
    return {};
}

Result<bool> Importer::is_stored(std::int64_t model, const database::ImportSource& source) {
    if (again_) return false;
    return imports_.has_preparation(model, source.prepare_hash);
}

Result<Importer::Identity> Importer::identify(const FoundModel& model, const database::ImportSource& source) {
    // A catalogue or collection names its models; a file in a plain archive is named by both.
    if (!model.item.archive.empty() || !model.item.key.empty()) {
        Identity named{model.item.key, {}};
        if (named.key.empty()) named.key = "archive:" + hexadecimal(source.file_hash) + "#" + model.item.path;
        auto there = models_.find_key(named.key);
        if (!there) return there.error();
        named.model = std::move(*there);
        return named;
    }

    // A plain file that changed goes on being the model it was, unless another file still has the old content.
    auto before = imports_.find(model.location);
    if (!before) return before.error();
    if (!*before) return identify_by_content(source);
    if ((*before)->file_hash != source.file_hash) {
        auto locations = imports_.locations_of((*before)->model);
        if (!locations) return locations.error();
        for (const std::string& location : *locations) {
            std::error_code failure;
            if (location != model.location && fs::exists(location, failure)) return identify_by_content(source);
        }
    }
    auto there = models_.find((*before)->model);
    if (!there) return there.error();
    if (!*there) return identify_by_content(source);
    std::string key = (*there)->key;
    return Identity{std::move(key), std::move(*there)};
}

Result<Importer::Identity> Importer::identify_by_content(const database::ImportSource& source) {
    auto same = models_.find_file(source.file_hash);
    if (!same) return same.error();
    if (*same) {
        std::string key = (*same)->key;
        return Identity{std::move(key), std::move(*same)};
    }
    // The name by content may belong to a model whose file was changed since.
    Identity fresh{"file:" + hexadecimal(source.file_hash), {}};
    auto taken = models_.find_key(fresh.key);
    if (!taken) return taken.error();
    if (*taken)
        fresh.key += "-" + hexadecimal(hash_bytes({reinterpret_cast<const std::uint8_t*>(source.location.data()),
                                                   source.location.size()}));
    return fresh;
}

Result<void> Importer::keep(const ImportItem& item, const database::ModelRow& model,
                            const database::ImportSource& source) {
    auto before = imports_.find(source.location);
    if (!before) return before.error();
    const bool same_words = *before && (*before)->item_hash == source.item_hash;
    if (same_words && (*before)->stamp == source.stamp && (*before)->prepare_hash == source.prepare_hash) return {};

    // The catalogue has other facts than last time: cheap, because the geometry stays.
    if (*before && !same_words) {
        const auto knowledge = models_.knowledge(model.id);
        if (!knowledge) return knowledge.error();
        auto facts = facts_from_json(knowledge->facts);
        if (!facts) return facts.error();
        const auto manual = manual_.of(model.key);
        if (!manual) return manual.error();
        database::ModelRow row = model;
        apply_item(row, item);
        apply_item(*facts, item);
        const database::ModelKnowledge described = describe(row, *facts, taxonomy_, manual_entries(*manual));
        if (auto stored = models_.describe(row, described); !stored) return stored;
    }
    return imports_.put(source);
}

Result<void> Importer::prepare_planned(const std::vector<Planned>& planned, const ImportOptions& options) {
    std::vector<ImportItem> items;
    items.reserve(planned.size());
    for (const Planned& one : planned) items.push_back(one.item);

    // A file that cannot be prepared is one failure; a database that cannot be written ends the import.
    Result<void> stored;
    std::size_t told = 0;
    auto prepared = prepare_(items, [&](std::size_t index, Result<PreparedModel> model) {
        ++told;
        const std::size_t waiting = in_other_unit_.size();
        stored = take(planned[index], std::move(model));
        if (!stored) return false;
        if (in_other_unit_.size() == waiting) ++progress_.done;
        progress_.failed = report_.failures.size();
        progress_.unchanged = report_.unchanged;
        if (tell_progress(options, planned[index].item.name)) return true;
        report_.stopped = true;
        return false;
    });
    if (!stored) return stored;
    // Stopped within a model.
    if (prepared && told < items.size()) report_.stopped = true;
    return prepared;
}

bool Importer::needs_other_unit(const Planned& planned, const PreparedModel& prepared) {
    // A chair of 900 m is in millimetres. Files do not say their unit; what things of the category usually measure
    // does.
    if (planned.item.stated_size || planned.item.stated_unit || planned.unit_is_guessed) return false;
    attributes::ModelFacts facts = prepared.facts;
    apply_item(facts, planned.item);
    const std::optional<double> scale = attributes::suggested_scale(taxonomy_, facts);
    if (!scale) return false;
    Planned scaled = planned;
    const Vec3 size = *scale * facts.geometry.size;
    scaled.item.stated_size = {size.x, size.y, size.z};
    scaled.unit_is_guessed = true;
    in_other_unit_.push_back(std::move(scaled));
    return true;
}

void Importer::name_in_report(const std::string& key) {
    constexpr std::size_t max_keys = 1000;
    if (report_.keys.size() < max_keys) report_.keys.push_back(key);
}

Result<void> Importer::take(const Planned& planned, Result<PreparedModel> prepared) {
    if (!prepared) {
        if (planned.item.light_source && interchange::is_without_triangles(prepared.error())) {
            ++report_.shapeless;
            return {};
        }
        report_.failures.push_back({planned.source.location, prepared.error()});
        return {};
    }
    if (needs_other_unit(planned, *prepared)) return {};
    const auto stored = store(planned.item, *prepared, planned.source);
    if (!stored) return stored.error();
    name_in_report(planned.item.key);
    switch (*stored) {
        case Stored::added:
            ++report_.added;
            break;
        case Stored::updated:
            ++report_.updated;
            break;
        case Stored::there_already:
            ++report_.unchanged;
            break;
    }
    return {};
}

Result<Importer::Stored> Importer::store(const ImportItem& item, const PreparedModel& prepared,
                                         database::ImportSource source, GeometryKind kind) {
    auto transaction = database::Transaction::begin(connection_);
    if (!transaction) return transaction.error();

    // Another process may import the same and have been faster.
    const auto before = models_.find_key(item.key);
    if (!before) return before.error();
    if (*before) {
        const auto stored = is_stored((*before)->id, source);
        if (!stored) return stored.error();
        if (*stored) return Stored::there_already;
    }

    // Attributes from facts and words, with what persons set on top.
    database::ModelRow row = make_row(item, prepared, source, kind);
    attributes::ModelFacts facts = prepared.facts;
    apply_item(facts, item);
    const auto manual = manual_.of(row.key);
    if (!manual) return manual.error();
    const database::ModelKnowledge knowledge = describe(row, facts, taxonomy_, manual_entries(*manual));

    const std::vector<std::uint8_t> hull = pack_points(prepared.hull_points);
    const auto id = models_.put(row, knowledge, {prepared.geometry, hull, prepared.thumbnail});
    if (!id) return id.error();
    source.model = *id;
    if (auto stored = store_convex_parts(*id, prepared.convex_parts); !stored) return stored.error();
    const auto physical_kind = attributes::kind_from_text(row.physical_kind);
    const bool is_soft = physical_kind && attributes::traits_of(*physical_kind).matter == attributes::Matter::solid;
    if (auto stored = store_soft_mesh(*id, is_soft, prepared); !stored) return stored.error();
    if (auto forgotten = imports_.forget_other_preparations(*id, source.prepare_hash); !forgotten) {
        return forgotten.error();
    }
    if (auto noted = imports_.put(source); !noted) return noted.error();
    if (auto committed = transaction->commit(); !committed) return committed.error();
    return before->has_value() ? Stored::updated : Stored::added;
}

Result<void> Importer::store_convex_parts(std::int64_t id, const ConvexParts& parts) {
    // Those of another geometry, or asked for by hand, are made again when they are needed.
    database::DecompositionTable table(connection_);
    if (auto forgotten = table.forget(id); !forgotten) return forgotten;
    if (parts.hulls.empty()) return {};
    return table.put(id, stored_form(parts));
}

Result<void> Importer::store_soft_mesh(std::int64_t id, bool is_soft, const PreparedModel& prepared) {
    database::SimulationMeshTable table(connection_);
    if (auto forgotten = table.forget(id); !forgotten) return forgotten;
    if (!is_soft) return {};
    const auto surface = interchange::decode_mesh(prepared.geometry);
    if (!surface) return surface.error();
    // Why there is none is stored as well.
    return table.put(id, stored_form(make_soft_mesh(*surface)));
}

bool Importer::tell_progress(const ImportOptions& options, const std::string& name) {
    if (!options.progress) return true;
    progress_.current = name;
    return options.progress(progress_);
}

}  // namespace embody::catalog
