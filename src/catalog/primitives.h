// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

/// A shape with a formula: no file, but a model like any other for those who search and build scenes.
struct Primitive {
    ImportItem item;  ///< key "primitive:box" …
    PreparedModel model;
};

/// Raise when the primitives change: databases take the new ones when they are opened next.
inline constexpr const char* primitives_revision = "1";

/// Box, sphere, capsule, cylinder, cone and plane in the sizes of their shape definitions' defaults. Volume, inertia
/// and centre are those of the formula, not of the triangles that are drawn.
Result<std::vector<Primitive>> make_primitives();

}  // namespace embody::catalog
