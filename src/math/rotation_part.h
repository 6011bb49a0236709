// SPDX-License-Identifier: MIT
#pragma once

#include "math/mat3.h"
#include "math/quat.h"

namespace embody {

/// Turns `rotation` into the rotation R that is nearest to the deformation F, max tr(Rᵀ F), from its last value: by
/// Newton's method (close to R: a few iterations to rounding), by the damped step of M. Müller and others ("A robust
/// method to extract the rotational part of deformations", 2016) where F is so far or so flat that Newton's method
/// fails. An inverted F has a rotation too, and it is found without a jump.
void follow_rotation(const Mat3& deformation, Quat& rotation);

}  // namespace embody
