// SPDX-License-Identifier: MIT
#include "physics/linear/envelope_cholesky.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::linear {

void EnvelopeCholesky::reset(std::span<const std::size_t> first) {
    first_.assign(first.begin(), first.end());
    begin_.resize(first.size());
    std::size_t size = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        begin_[i] = size;
        size += i - first[i] + 1;
    }
    values_.assign(size, 0);
}

bool EnvelopeCholesky::factorize() {
    for (std::size_t i = 0; i < rows(); ++i) {
        double* const own = values_.data() + begin_[i] - first_[i];  // own[k] is element (i, k)
        for (std::size_t k = first_[i]; k <= i; ++k) {
            const double* const other = row(k) - first_[k];
            double sum = own[k];
            for (std::size_t j = std::max(first_[i], first_[k]); j < k; ++j) sum -= own[j] * other[j];
            if (k < i) {
                own[k] = sum / other[k];
            } else {
                if (!(sum > 0) || !std::isfinite(sum)) return false;
                own[i] = std::sqrt(sum);
            }
        }
    }
    return true;
}

void EnvelopeCholesky::solve(std::span<double> rhs) const {
    for (std::size_t i = 0; i < rows(); ++i) {
        const double* const own = row(i) - first_[i];
        double sum = rhs[i];
        for (std::size_t k = first_[i]; k < i; ++k) sum -= own[k] * rhs[k];
        rhs[i] = sum / own[i];
    }
    for (std::size_t i = rows(); i-- > 0;) {
        const double* const own = row(i) - first_[i];
        rhs[i] /= own[i];
        for (std::size_t k = first_[i]; k < i; ++k) rhs[k] -= own[k] * rhs[i];
    }
}

}  // namespace embody::physics::linear
