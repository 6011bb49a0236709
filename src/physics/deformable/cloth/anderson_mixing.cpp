// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/anderson_mixing.h"

#include <algorithm>
#include <limits>

namespace embody::physics::deformable {

namespace {

/// A small symmetric, positive semidefinite system, row by row.
using Gram = std::vector<std::vector<double>>;

// Gauss's elimination. Directions that are nearly the same as others before them would come out at the noise.
std::vector<double> solve(Gram a, std::vector<double> x) {
    constexpr double min_pivot = 1e-9;  // of the largest: of squares of numbers that are solved in floats
    const std::size_t n = x.size();
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, a[i][i]);
    const double shift = min_pivot * largest + std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < n; ++i) a[i][i] += shift;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t row = i + 1; row < n; ++row) {
            const double factor = a[row][i] / a[i][i];
            for (std::size_t k = i; k < n; ++k) a[row][k] -= factor * a[i][k];
            x[row] -= factor * x[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    return x;
}

}  // namespace

std::vector<Vec3> AndersonMixing::next(std::span<const Vec3> x, std::span<const Vec3> error,
                                       std::span<const Vec3> weight) {
    const auto product = [&](std::span<const Vec3> a, std::span<const Vec3> b) {
        double sum = 0;
        for (std::size_t i = 0; i < weight.size(); ++i) sum += dot(scale(weight[i], a[i]), b[i]);
        return sum;
    };
    tried_.push_back({{x.begin(), x.end()}, {error.begin(), error.end()}});
    const std::size_t changes = tried_.size() - 1;
    std::vector<std::vector<Vec3>> change(changes, std::vector<Vec3>(error.size()));
    for (std::size_t j = 0; j < changes; ++j) {
        for (std::size_t i = 0; i < error.size(); ++i) change[j][i] = tried_[j + 1].error[i] - tried_[j].error[i];
    }
    Gram gram(changes, std::vector<double>(changes));
    std::vector<double> gamma(changes);
    for (std::size_t j = 0; j < changes; ++j) {
        gamma[j] = product(change[j], error);
        for (std::size_t k = 0; k < changes; ++k) gram[j][k] = product(change[j], change[k]);
    }
    gamma = solve(std::move(gram), std::move(gamma));
    std::vector<Vec3> next(x.size());
    for (std::size_t i = 0; i < next.size(); ++i) {
        next[i] = x[i] + error[i];
        for (std::size_t j = 0; j < changes; ++j)
            next[i] -= gamma[j] * (tried_[j + 1].x[i] - tried_[j].x[i] + change[j][i]);
    }
    return next;
}

}  // namespace embody::physics::deformable
