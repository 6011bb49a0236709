// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/prepare/geometry_measurement.h"

namespace embody::catalog {

/// How far a model's geometry can be trusted by physics:
///   3 precise  every part closed, without overlaps: volume, centre and inertia are exact
///   2 good     encloses a volume that is known within 20 %
///   1 usable   open or flat: it draws and collides by its hull, its volume is a guess
///   0 broken   more than half of the triangles have no area or are copies, or nothing is left of its extent in two
///   directions
int grade_quality(const GeometryMeasurement& measured);

}  // namespace embody::catalog
