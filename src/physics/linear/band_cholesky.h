// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Symmetric positive definite matrix of 3 × 3 blocks in which row i has blocks up to column i ± 2, and its factor L
/// Lᵀ.
class BandCholesky {
public:
    /// Sets the matrix to zero, with that many block rows.
    void reset(std::size_t blocks);
    /// Adds to block (i, k), |i - k| <= 2; only i >= k are kept, so give each pair once.
    void add(std::size_t i, std::size_t k, const Mat3& block);
    void add_diagonal(std::size_t i, double value);
    /// Before factorize().
    [[nodiscard]] Mat3 diagonal_block(std::size_t i) const;
    [[nodiscard]] double diagonal_mean(std::size_t i) const;
    /// Number (i, k) of the lower triangle, i - 8 <= k <= i; rows and columns are those of numbers, three a block.
    [[nodiscard]] double element(std::size_t i, std::size_t k) const { return at(i, k); }
    /// The first column of a row of numbers that can be other than zero.
    [[nodiscard]] static std::size_t first_column(std::size_t i) { return i / 3 > 2 ? 3 * (i / 3 - 2) : 0; }
    /// Makes row and column i those of the identity: the unknown stays zero.
    void fix(std::size_t i);
    /// False where the matrix is not positive definite or not finite.
    bool factorize();
    /// Solves for one right side, in place.
    void solve(std::span<Vec3> rhs) const;

private:
    static constexpr std::size_t reach = 8;     // of a row to the left of the diagonal, in numbers
    using Row = std::array<double, reach + 1>;  // element (i, k) is rows_[i][k + reach - i]
    [[nodiscard]] double& at(std::size_t i, std::size_t k) { return rows_[i][k + reach - i]; }
    [[nodiscard]] double at(std::size_t i, std::size_t k) const { return rows_[i][k + reach - i]; }
    std::vector<Row> rows_;
};

}  // namespace embody::physics::linear
