// SPDX-License-Identifier: MIT
#pragma once

/// Linear algebra for the solvers: the preconditioned conjugate gradient, block, band and dissected
/// factorisations (LDLᵀ, LU), the orders of elimination that keep them sparse, and kernels over columns of numbers for
/// each width of the processor's registers. It knows numbers only, no bodies.
namespace embody::physics::linear {}  // namespace embody::physics::linear
