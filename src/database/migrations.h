// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "database/connection.h"

namespace embody::database {

/// One step of a schema's history. Never changed once released: a file in some user's folder stands at each of them.
struct Migration {
    int version;           ///< 1, 2, 3 … without a gap
    const char* commands;  ///< what leads from version - 1 to version
    /// Whether a program of this version can read a file of version - 1 as it is: a file that cannot be changed is
    /// then opened without the step.
    bool is_optional_for_reading = false;
};

/// Brings the file to the last version, each step in a transaction of its own; a step that another process takes at the
/// same moment is taken once. A file newer than the program is refused by its version and left as it is.
Result<void> migrate(Connection& connection, std::span<const Migration> migrations);

}  // namespace embody::database
