// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/prepare/convex_parts.h"
#include "database/decomposition_table.h"

namespace embody::catalog {

/// The error in the unit by which the database finds it.
std::int64_t micrometres(double length);

database::StoredDecomposition stored_form(const ConvexParts& parts);
Result<ConvexParts> parts_from(const database::StoredDecomposition& stored);

}  // namespace embody::catalog
