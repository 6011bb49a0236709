// SPDX-License-Identifier: MIT
#include "physics/linear/band_cholesky.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::linear {

void BandCholesky::reset(std::size_t blocks) { rows_.assign(3 * blocks, Row{}); }

void BandCholesky::add(std::size_t i, std::size_t k, const Mat3& block) {
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = block(static_cast<int>(r), static_cast<int>(c));
            if (3 * i + r >= 3 * k + c) at(3 * i + r, 3 * k + c) += value;
        }
    }
}

void BandCholesky::add_diagonal(std::size_t i, double value) {
    for (std::size_t r = 3 * i; r < 3 * i + 3; ++r) at(r, r) += value;
}

double BandCholesky::diagonal_mean(std::size_t i) const {
    return (at(3 * i, 3 * i) + at(3 * i + 1, 3 * i + 1) + at(3 * i + 2, 3 * i + 2)) / 3;
}

Mat3 BandCholesky::diagonal_block(std::size_t i) const {
    const auto element = [&](std::size_t r, std::size_t c) {
        return at(3 * i + std::max(r, c), 3 * i + std::min(r, c));
    };
    const auto column = [&](std::size_t c) { return Vec3{element(0, c), element(1, c), element(2, c)}; };
    return {column(0), column(1), column(2)};
}

void BandCholesky::fix(std::size_t i) {
    for (std::size_t r = 3 * i; r < 3 * i + 3; ++r) {
        rows_[r] = Row{};
        for (std::size_t below = r + 1; below < std::min(rows_.size(), r + reach + 1); ++below) at(below, r) = 0;
        at(r, r) = 1;
    }
}

bool BandCholesky::factorize() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const std::size_t first = i > reach ? i - reach : 0;
        for (std::size_t k = first; k <= i; ++k) {
            double sum = at(i, k);
            for (std::size_t j = std::max(first, k > reach ? k - reach : 0); j < k; ++j) sum -= at(i, j) * at(k, j);
            if (k < i) {
                at(i, k) = sum / at(k, k);
            } else {
                if (!(sum > 0) || !std::isfinite(sum)) return false;
                at(i, i) = std::sqrt(sum);
            }
        }
    }
    return true;
}

void BandCholesky::solve(std::span<Vec3> rhs) const {
    const auto value = [&](std::size_t i) -> double& { return rhs[i / 3][static_cast<int>(i % 3)]; };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        double sum = value(i);
        for (std::size_t k = i > reach ? i - reach : 0; k < i; ++k) sum -= at(i, k) * value(k);
        value(i) = sum / at(i, i);
    }
    for (std::size_t i = rows_.size(); i-- > 0;) {
        double sum = value(i);
        for (std::size_t k = i + 1; k < std::min(rows_.size(), i + reach + 1); ++k) sum -= at(k, i) * value(k);
        value(i) = sum / at(i, i);
    }
}

}  // namespace embody::physics::linear
