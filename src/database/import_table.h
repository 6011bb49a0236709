// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "database/connection.h"

namespace embody::database {

/// An import from one place.
struct ImportSource {
    std::string location;    ///< a file, or archive!entry
    std::int64_t model = 0;  ///< id
    std::string stamp;       ///< size and time of the file on disk when it was read
    std::uint64_t file_hash = 0, prepare_hash = 0, item_hash = 0;
};

/// Where the models came from, so that an import goes on where the last one ended.
class ImportTable {
public:
    explicit ImportTable(Connection& connection) : connection_(connection) {}

    Result<std::optional<ImportSource>> find(std::string_view location);
    /// Any entry of the archive, for its stamp and hash.
    Result<std::optional<ImportSource>> find_in_archive(std::string_view archive);
    Result<void> put(const ImportSource& source);
    /// Places from which this model was imported.
    Result<std::vector<std::string>> locations_of(std::int64_t model);
    /// Whether the model was imported from any place with this preparation.
    Result<bool> has_preparation(std::int64_t model, std::uint64_t prepare_hash);
    /// Call after a model was stored anew: places that contained something else no longer count as its.
    Result<void> forget_other_preparations(std::int64_t model, std::uint64_t prepare_hash);

private:
    Result<std::optional<ImportSource>> first(Statement& statement);
    Connection& connection_;
};

/// Named texts about the database as a whole.
class SettingTable {
public:
    explicit SettingTable(Connection& connection) : connection_(connection) {}

    /// Empty where it was never set.
    Result<std::string> get(std::string_view name);
    Result<void> put(std::string_view name, std::string_view value);

private:
    Connection& connection_;
};

}  // namespace embody::database
