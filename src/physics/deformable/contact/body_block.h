// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A body's own block of the equations: its inertia and the springs on it, for a direct solve.
class BodyBlock {
public:
    /// Inertia alone; the identity for a body that does not move.
    explicit BodyBlock(const BodyInertia& body);
    /// Adds the stiffness of a spring at `arm` from the centre of mass, N/m.
    void add(const Mat3& stiffness, Vec3 arm);
    [[nodiscard]] double& at(std::size_t row, std::size_t column) { return values_[6 * row + column]; }
    /// Before solve(), once all is added.
    void factorize();
    [[nodiscard]] BodyMove solve(const BodyMove& rhs) const;

private:
    std::array<double, 36> values_{};  // by row; then the lower factor
};

/// Solves the equations of the bodies alone, exactly, for these moves of nodes: what an iterative solve leaves of them
/// is small for the nodes that it is measured by, but would throw a body much lighter than these.
void balance_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies,
                    std::span<const Vec3> moves, std::span<BodyMove> body_moves);

}  // namespace embody::physics::deformable
