// SPDX-License-Identifier: MIT
#include "catalog/stored_parts.h"

#include <cmath>

namespace embody::catalog {

std::int64_t micrometres(double length) { return std::llround(length * 1e6); }

database::StoredDecomposition stored_form(const ConvexParts& parts) {
    return {parts.max_hulls, micrometres(parts.hull_error), parts.concavity, parts.hull_concavity,
            pack_hulls(parts.hulls)};
}

Result<ConvexParts> parts_from(const database::StoredDecomposition& stored) {
    auto hulls = unpack_hulls(stored.hulls);
    if (!hulls) return hulls.error();
    return ConvexParts{stored.max_hulls, static_cast<double>(stored.hull_error_um) * 1e-6, stored.concavity,
                       stored.hull_concavity, std::move(*hulls)};
}

}  // namespace embody::catalog
