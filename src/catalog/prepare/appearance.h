// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/prepare/prepared_model.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

/// Makes glass of what Sweet Home 3D takes for the panes of windows by its name, and gives the other materials the
/// colours that the item asks for.
void set_appearance(interchange::RawScene& scene, const ImportItem& item);

}  // namespace embody::catalog
