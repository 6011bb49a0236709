// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "foundation/random.h"

namespace embody::physics::linear {

/// A plain matrix, and Gauss's elimination with pivots of rows: what solvers are compared with.
struct DenseMatrix {
    std::size_t size;
    std::vector<double> element;

    explicit DenseMatrix(std::size_t rows) : size(rows), element(rows * rows, 0.0) {}
    double& at(std::size_t r, std::size_t c) { return element[r * size + c]; }
    [[nodiscard]] double at(std::size_t r, std::size_t c) const { return element[r * size + c]; }

    [[nodiscard]] std::vector<double> times(std::span<const double> x) const {
        std::vector<double> y(size, 0.0);
        for (std::size_t r = 0; r < size; ++r) {
            for (std::size_t c = 0; c < size; ++c) y[r] += at(r, c) * x[c];
        }
        return y;
    }

    [[nodiscard]] std::vector<double> solve(std::vector<double> b) const {
        DenseMatrix a = *this;
        for (std::size_t p = 0; p < size; ++p) {
            std::size_t best = p;
            for (std::size_t r = p + 1; r < size; ++r) {
                if (std::fabs(a.at(r, p)) > std::fabs(a.at(best, p))) best = r;
            }
            for (std::size_t c = 0; c < size; ++c) std::swap(a.at(p, c), a.at(best, c));
            std::swap(b[p], b[best]);
            for (std::size_t r = p + 1; r < size; ++r) {
                const double factor = a.at(r, p) / a.at(p, p);
                for (std::size_t c = p; c < size; ++c) a.at(r, c) -= factor * a.at(p, c);
                b[r] -= factor * b[p];
            }
        }
        for (std::size_t r = size; r-- > 0;) {
            for (std::size_t c = r + 1; c < size; ++c) b[r] -= a.at(r, c) * b[c];
            b[r] /= a.at(r, r);
        }
        return b;
    }
};

inline std::vector<double> random_vector(std::size_t size, Random& random) {
    std::vector<double> all(size);
    for (double& value : all) value = random.between(-1, 1);
    return all;
}

/// G Gᵀ + least · 1 of a random G: positive definite.
inline DenseMatrix random_positive_definite(std::size_t size, double least, Random& random) {
    DenseMatrix g(size), a(size);
    g.element = random_vector(size * size, random);
    for (std::size_t r = 0; r < size; ++r) {
        for (std::size_t c = 0; c < size; ++c) {
            for (std::size_t k = 0; k < size; ++k) a.at(r, c) += g.at(r, k) * g.at(c, k);
        }
        a.at(r, r) += least;
    }
    return a;
}

inline double largest_difference(std::span<const double> a, std::span<const double> b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
    return largest;
}

}  // namespace embody::physics::linear
