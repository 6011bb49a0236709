// SPDX-License-Identifier: MIT
#include "physics/definitions/surface_pairs.h"

#include <algorithm>
#include <cstddef>

#include "physics/definitions/field_check.h"

namespace embody::physics {
namespace {

// Place of a pair of surfaces, counted from 1, in the lower triangle.
std::size_t row_of(SurfaceId a, SurfaceId b) {
    const std::size_t high = std::max(a, b), low = std::min(a, b);
    return high * (high - 1) / 2 + low - 1;
}

}  // namespace

Result<void> SurfacePairs::set(SurfaceId a, SurfaceId b, const PairCoefficients& coefficients) {
    if (a == 0 || b == 0) return Error{"surface", "must not be 0, which stands for none"};
    auto valid = first_error(check_number("friction_static", coefficients.friction_static, 0, 2),
                             check_number("friction_dynamic", coefficients.friction_dynamic, 0, 2),
                             check_number("restitution", coefficients.restitution, 0, 1));
    if (!valid) return valid;
    if (coefficients.friction_static < coefficients.friction_dynamic)
        return Error{"friction_static", "must not be less than friction_dynamic"};
    const std::size_t row = row_of(a, b);
    if (row >= rows_.size()) rows_.resize(row + 1);
    rows_[row] = coefficients;
    return {};
}

const PairCoefficients* SurfacePairs::find(SurfaceId a, SurfaceId b) const {
    if (a == 0 || b == 0) return nullptr;
    const std::size_t row = row_of(a, b);
    return row < rows_.size() && rows_[row] ? &*rows_[row] : nullptr;
}

}  // namespace embody::physics
