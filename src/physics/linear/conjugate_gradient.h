// SPDX-License-Identifier: MIT
//
// The preconditioned conjugate gradient for A x = b, A symmetric positive definite (M. Hestenes, E. Stiefel, "Methods
// of conjugate gradients for solving linear systems", 1952; as in Y. Saad, "Iterative methods for sparse linear
// systems", 2nd edition 2003, algorithm 9.1):
//
//   x  solution                      α = r·z / p·q               how far to go along p
//   r  residual b − A x              β = r·z now / r·z before    what the next p keeps of the last one
//   z  M⁻¹ r, M the preconditioner
//   p  search direction, q = A p
//
// The loop is here. Vectors and their sums belong to the system: numbers of a fluid's cells, planes of floats of a
// sheet of cloth, three numbers a contact. Where systems depart from the algorithm:
// - x begins with the last solution (warm start).
// - What must not move has z = 0, so that x keeps its value there, and r is not driven to zero (D. Baraff, A. Witkin,
//   "Large steps in cloth simulation", 1998, 5.3, the filter).
// - Several workers run the loop side by side, each on its part of the vectors. Functions of the system wait for all
//   workers before they return a sum, which is taken in one order: all workers see the same numbers, take the same
//   branches, and any number of them comes to the same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// What is left of the equations: the residual.
struct GradientResidual {
    double product = 0;  ///< r·z
    double size = 0;     ///< what the limits apply to: r·z, or a norm of r
};

/// What a system does with its vectors, called by each worker.
template <class System>
concept GradientSystem = requires(System& system, double alpha, double beta) {
    { system.begin() } -> std::same_as<GradientResidual>;         // r = b − A x, z = M⁻¹ r
    { system.turn(beta) } -> std::same_as<void>;                  // p = z + β p; β = 0 the first time
    { system.multiply() } -> std::same_as<double>;                // q = A p; p·q
    { system.advance(alpha) } -> std::same_as<GradientResidual>;  // x += α p, r −= α q, z = M⁻¹ r
};

/// The loop ends where the residual's size is at most `absolute`, and at most `relative` times the size at the
/// beginning.
struct GradientLimits {
    int iterations = 0;
    double absolute = 0, relative = 0;
};

enum class GradientEnd {
    converged,
    iteration_limit,
    indefinite,  ///< p·q is not positive, or r·z is negative: A or M is not positive definite, or only rounding is left
    not_finite  ///< x is not usable
};

struct GradientResult {
    GradientEnd end = GradientEnd::converged;
    int iterations = 0;  ///< that moved x
};

template <GradientSystem System>
GradientResult conjugate_gradient(System& system, const GradientLimits& limits) {
    GradientResidual residual = system.begin();
    const double enough = std::max(limits.absolute, limits.relative * residual.size);
    double beta = 0;
    for (int iteration = 0;; ++iteration) {
        if (!std::isfinite(residual.product) || !std::isfinite(residual.size))
            return {GradientEnd::not_finite, iteration};
        if (residual.product < 0) return {GradientEnd::indefinite, iteration};
        if (residual.size <= enough) return {GradientEnd::converged, iteration};
        if (iteration >= limits.iterations) return {GradientEnd::iteration_limit, iteration};
        system.turn(beta);
        const double curvature = system.multiply();
        if (!std::isfinite(curvature)) return {GradientEnd::not_finite, iteration};
        if (!(curvature > 0)) return {GradientEnd::indefinite, iteration};
        const double alpha = residual.product / curvature;
        const GradientResidual next = system.advance(alpha);
        beta = next.product / residual.product;
        residual = next;
    }
}

}  // namespace embody::physics::linear
