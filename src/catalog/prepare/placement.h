// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/prepare/prepared_model.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

/// Turns `scene` by the item's stated rotation, scales each axis to the stated size where there is one, else all by the
/// stated unit where there is one, and moves the origin to the centre of the base of the bounds. An axis along which
/// the model is flat is scaled by the unit only. Fails where the result would not be finite or larger than 10 km, which
/// no catalogue of things means.
Result<void> place(interchange::RawScene& scene, const ImportItem& item);

}  // namespace embody::catalog
