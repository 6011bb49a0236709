// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "math/mat3.h"
#include "math/quat.h"

namespace embody {

/// Turns each of `rotations` into the rotation R that is nearest to its deformation F, max tr(Rᵀ F), from its last
/// value: by Newton's method (close to R: a few iterations to rounding), by the damped step of M. Müller and others ("A
/// robust method to extract the rotational part of deformations", 2016) where F is so far or so flat that Newton's
/// method fails. An inverted F has a rotation too, and it is found without a jump. As many of one as of the other; what
/// is found for one does not depend on the others, nor on the processor.
void follow_rotations(std::span<const Mat3> deformations, std::span<Quat> rotations);
/// The same for one.
void follow_rotation(const Mat3& deformation, Quat& rotation);

}  // namespace embody
