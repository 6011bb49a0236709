// SPDX-License-Identifier: MIT
#pragma once

/// Linear algebra of what the solvers meet: the preconditioned conjugate gradient, block, band and dissected
/// factorisations (LDLᵀ, LU), the orders of elimination that keep them sparse, and kernels over columns of numbers for
/// each width of the processor's registers. Knows no body, only numbers.
namespace embody::physics::linear {}  // namespace embody::physics::linear
