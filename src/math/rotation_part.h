// SPDX-License-Identifier: MIT
#pragma once

#include "math/mat3.h"
#include "math/quat.h"

namespace embody {

/// Turns `rotation` into the rotation R that is nearest to the deformation F, max tr(Rᵀ F), from where it was: by
/// Newton's method (near R: a few rounds to rounding), by the cautious step of M. Müller and others ("A robust method
/// to extract the rotational part of deformations", 2016) where F is so far or so flat that this leads nowhere. An F
/// turned inside out has a rotation too, and it is found without a jump.
void follow_rotation(const Mat3& deformation, Quat& rotation);

}  // namespace embody
