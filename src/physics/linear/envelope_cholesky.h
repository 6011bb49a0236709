// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Symmetric positive definite matrix of numbers whose row i is zero before column first(i), and its factor L Lᵀ, which
/// has the same envelope. (A. George, J. W. Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981,
/// ch. 4.)
class EnvelopeCholesky {
public:
    /// Sets the matrix to zero. `first`: a row's first column, at most the row's own.
    void reset(std::span<const std::size_t> first);
    [[nodiscard]] std::size_t rows() const { return first_.size(); }
    /// Element (i, k) of the lower triangle, first(i) <= k <= i.
    [[nodiscard]] double& at(std::size_t i, std::size_t k) { return values_[begin_[i] + k - first_[i]]; }
    /// False where the matrix is not positive definite or not finite.
    bool factorize();
    /// Solves for one right side, in place; after factorize().
    void solve(std::span<double> rhs) const;

private:
    [[nodiscard]] const double* row(std::size_t i) const { return values_.data() + begin_[i]; }

    std::vector<std::size_t> first_, begin_;  // of each row: its first column, and where that is in values_
    std::vector<double> values_;              // row by row, from the first column to the diagonal
};

}  // namespace embody::physics::linear
