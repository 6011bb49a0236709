// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "foundation/result.h"

namespace embody::physics {

/// What breaks a body, and what its cracks cost (docs/physics/fracture.md). One of the two limits must be finite.
struct Brittleness {
    /// An impact with a larger impulse breaks it, N s, > 0
    double break_impulse = std::numeric_limits<double>::infinity();
    /// An impact with more energy breaks it, J, > 0
    double break_energy = std::numeric_limits<double>::infinity();
    /// Of a crack, J/m², 0.1 … 1e6. 8: soda-lime glass, twice its surface energy of 3.5 to 5.3 J/m²
    /// (S. Wiederhorn, J. Am. Ceram. Soc. 52, 1969).
    double fracture_energy = 8;
    int max_pieces = 24;  ///< of one blow, 2 … 256; pieces of pieces and all, at most twice as many
};

/// The error's `where` is the field.
Result<void> validate(const Brittleness& brittleness);

}  // namespace embody::physics
