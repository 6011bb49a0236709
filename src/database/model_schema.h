// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "database/connection.h"
#include "database/migrations.h"

namespace embody::database {

/// The history of the model database's tables; docs/database.md says what each table is for.
std::span<const Migration> model_migrations();

/// Opens or creates a model database and brings it to the last version.
Result<std::unique_ptr<Connection>> open_model_database(const std::filesystem::path& file);

/// The mark of a model database in its file's header: "Embd".
inline constexpr std::uint32_t model_application_id = 0x456D6264;

}  // namespace embody::database
