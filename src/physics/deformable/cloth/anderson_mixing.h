// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Anderson's acceleration of a fixed point x = g(x) of unknown derivative (D. G. Anderson, J. ACM 12, 1965, in the
/// form of H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49, 2011): the next x comes of the combination of those tried
/// whose error g(x) − x, taken as linear in x, is the smallest in the norm Σ w |error|². Sums are in one order.
class AndersonMixing {
public:
    /// Forgets what was tried.
    void clear() { tried_.clear(); }
    /// Notes an x with its error (all of one size) and returns the next x. `weight`, by component, > 0 where the error
    /// is not zero.
    std::vector<Vec3> next(std::span<const Vec3> x, std::span<const Vec3> error, std::span<const Vec3> weight);

private:
    struct Tried {
        std::vector<Vec3> x, error;
    };
    std::vector<Tried> tried_;
};

}  // namespace embody::physics::deformable
