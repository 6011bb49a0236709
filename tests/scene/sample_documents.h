// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/document/document.h"

namespace embody::scene::samples {

/// A static floor with its top at height 0 and a box of 0.5 m above it.
Document floor_and_box(double height = 1);
/// A document with every shape, joint, trigger, effect and field of a scene file.
Document everything();
/// Adds a primitive to a document.
Entity& add(Document& document, const std::string& name, const physics::ShapeDefinition& shape, Vec3 position);

}  // namespace embody::scene::samples
