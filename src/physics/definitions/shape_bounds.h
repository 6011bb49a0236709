// SPDX-License-Identifier: MIT
#pragma once

#include "math/bounds.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics {

/// The smallest axis-aligned box around a shape, in its own frame; empty for a plane, which has no end.
Bounds bounds_of(const ShapeDefinition& shape);

}  // namespace embody::physics
