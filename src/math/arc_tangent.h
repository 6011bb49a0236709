// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// Angle of the vector (x, y) from the X axis, rad, in (−π, π]; 0 for the zero vector. To a few units in the last
/// place, and the same bits on every machine: the library's atan2 differs from one C library to the next.
double arc_tangent(double y, double x);

}  // namespace embody
