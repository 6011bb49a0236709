// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "database/connection.h"

namespace embody::database {

/// One model as it is listed and found: small.
struct ModelRow {
    std::int64_t id = 0;  ///< given by the database
    std::string key;      ///< unique
    std::string name, source, licence, author, category, subcategory, physical_kind;
    std::vector<std::string> tags;        ///< without line breaks
    std::array<double, 3> size{0, 0, 0};  ///< m
    std::string geometry_kind = "mesh";   ///< mesh, point_cloud, voxel or analytical
    std::uint32_t vertices = 0, triangles = 0, parts = 0, materials = 0, images = 0;
    int quality = 0;  ///< 0 … 3
    std::uint64_t file_hash = 0, geometry_hash = 0;
};

/// The stored facts of a model, as JSON text.
struct ModelKnowledge {
    std::string facts, automatic;
};

/// The large parts of a model.
struct ModelBlobs {
    std::span<const std::uint8_t> geometry, hull_points, thumbnail;
};

struct ModelSearch {
    std::string words = {};     ///< as a person typed them; empty: all models
    std::string category = {};  ///< exact; empty: all
    int limit = 50, offset = 0;
};
struct ModelMatches {
    std::vector<ModelRow> models;  ///< best first; by name without words and among very many
    std::int64_t total = 0;        ///< of all pages
};

struct MatchExpressions;

/// The tables about models. Writers are to be called inside a Transaction.
class ModelTable {
public:
    explicit ModelTable(Connection& connection) : connection_(connection) {}

    /// Adds the model, or replaces the one of the same key, whose id stays.
    Result<std::int64_t> put(const ModelRow& model, const ModelKnowledge& knowledge, const ModelBlobs& blobs);
    /// As `put`, with the geometry and picture of the model `like`, which are not stored again.
    Result<std::int64_t> put_like(std::int64_t like, const ModelRow& model, const ModelKnowledge& knowledge);
    /// Replaces the stored facts of a model; its geometry and pictures stay.
    Result<void> describe(const ModelRow& model, const ModelKnowledge& knowledge);
    Result<void> put_knowledge(std::int64_t id, const ModelKnowledge& knowledge);
    Result<void> remove(std::int64_t id);

    Result<std::optional<ModelRow>> find(std::int64_t id);
    Result<std::optional<ModelRow>> find_key(std::string_view key);
    /// At most two, enough to know whether a name belongs to one model.
    Result<std::vector<ModelRow>> find_name(std::string_view name);
    /// The model imported from a plain file with these bytes.
    Result<std::optional<ModelRow>> find_file(std::uint64_t file_hash);

    /// Any text is a valid search; quotes, operators and stars mean nothing special.
    Result<ModelMatches> search(const ModelSearch& search);
    Result<std::vector<std::pair<std::string, std::int64_t>>> count_categories();
    Result<std::int64_t> count();
    Result<std::vector<std::int64_t>> ids();

    // Data of one model; an error if there is no such model.
    Result<ModelKnowledge> knowledge(std::int64_t id);
    Result<std::vector<std::uint8_t>> geometry(std::int64_t id);
    Result<std::vector<std::uint8_t>> hull_points(std::int64_t id);
    Result<std::vector<std::uint8_t>> thumbnail(std::int64_t id);

private:
    Result<std::int64_t> put_row(const ModelRow& model);
    // The id of these bytes, which are stored unless they already are.
    Result<std::int64_t> store_geometry(const ModelBlobs& blobs, std::uint64_t hash);
    Result<std::int64_t> store_picture(std::span<const std::uint8_t> png);
    Result<void> link(std::int64_t id, std::int64_t geometry, std::int64_t picture);
    Result<ModelMatches> search_without_words(const ModelSearch& search);
    /// Ascending.
    Result<std::vector<std::int64_t>> ids_that_match(std::string_view expression);
    Result<std::vector<std::int64_t>> ids_in_category(const std::vector<std::int64_t>& ids, std::string_view category);
    Result<std::vector<std::int64_t>> ranked_page(std::string_view expression, const ModelSearch& search);
    Result<std::vector<std::int64_t>> broad_page(const MatchExpressions& expressions, std::vector<std::int64_t> ids,
                                                 const ModelSearch& search);
    Result<std::vector<ModelRow>> rows(Statement& statement);
    Result<std::optional<ModelRow>> first(Result<Statement> statement);
    Result<std::vector<std::uint8_t>> blob(std::string_view command, std::int64_t id);
    [[nodiscard]] Error no_such_model(std::int64_t id) const;

    Connection& connection_;
};

}  // namespace embody::database
