// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/manual_change.h"
#include "foundation/result.h"

namespace embody::cli {

/// Prints what a change of many models did, or would do; returns the program's exit code.
int print_changes(const Result<catalog::ChangeReport>& result, bool dry_run, bool json);

/// Options that show progress under this title and stop at Ctrl+C.
catalog::ChangeOptions watched_change(const char* title);

}  // namespace embody::cli
