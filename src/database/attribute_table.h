// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "database/connection.h"

namespace embody::database {

/// A manual value.
struct ManualAttribute {
    std::string name, value;  ///< value as JSON
    std::string set_by;
    std::int64_t set_at = 0;  ///< seconds since 1970, UTC; given by the database
};

/// Manual values by model key: they outlive the model's deletion.
class ManualAttributeTable {
public:
    explicit ManualAttributeTable(Connection& connection) : connection_(connection) {}

    Result<std::vector<ManualAttribute>> of(std::string_view model_key);
    Result<std::optional<ManualAttribute>> find(std::string_view model_key, std::string_view name);
    /// Sets it with the present time.
    Result<void> put(std::string_view model_key, const ManualAttribute& attribute);
    /// Sets it with the time that `attribute` has.
    Result<void> restore(std::string_view model_key, const ManualAttribute& attribute);
    Result<void> erase(std::string_view model_key, std::string_view name);

private:
    Connection& connection_;
};

}  // namespace embody::database
