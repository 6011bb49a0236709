// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A fixed amount of gas in a closed sheet, at one temperature: its pressure times its volume stays the same (R. Boyle,
/// 1662). Outside is air of `air_pressure`, p_o. With the volume V, which the nodes x enclose, the energy is
///   U = p_o (V - V_0) - (p_o + p_0) V_0 ln(V / V_0),       p = -dU/dV, above the air outside,
/// so nodes have the force p dV/dx and the stiffness
///   (p_o + p)/V dV/dx (dV/dx)ᵀ - p d²V/dx²,
/// the second term with a block for each edge. docs/physics/cloth.md, "Gas inside".
class SheetGas {
public:
    /// `definition` is valid and its matter is cloth.
    explicit SheetGas(const DeformableDefinition& definition);

    [[nodiscard]] bool is_active() const { return amount_ > 0; }
    /// m³ inside.
    [[nodiscard]] double volume(std::span<const Vec3> nodes) const;
    /// Above that of the air outside, Pa, in a volume of m³.
    [[nodiscard]] double pressure(double volume) const;
    /// J: 0 at the volume at rest.
    [[nodiscard]] double energy(double volume) const;

    /// Makes the equations about these places. `moves` (m, of all nodes, or none): on the way there in the part.
    void linearize(std::span<const Vec3> nodes, std::span<const Vec3> moves);
    /// dV/dx of each node, m², there: a third of the areas around it, along their normals. Together nothing.
    [[nodiscard]] std::span<const Vec3> gradient() const { return gradient_; }
    /// (p_o + p)/V there: the stiffness is that times the product of gradients, Pa/m³.
    [[nodiscard]] double compression() const { return compression_; }
    /// -p d²V/dx² there, N/m, of corner k of a triangle and the corner after it, or else the one before it.
    [[nodiscard]] Mat3 block(const std::array<std::uint32_t, 3>& corners, std::size_t k, bool is_after) const;
    /// By the equations, at the part's start: N.
    [[nodiscard]] Vec3 force_on(std::size_t node) const { return force_[node]; }
    /// By which these moves (m) raise the energy beyond what the equations say, J.
    [[nodiscard]] double unforeseen_energy(std::span<const Vec3> nodes, std::span<const Vec3> moves) const;

private:
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    double rest_volume_ = 0;  // m³
    double amount_ = 0;       // n R T = p V, J; 0: no gas

    // Of the last linearize().
    std::vector<Vec3> place_, gradient_, force_, moves_;
    double volume_ = 0, pressure_ = 0, compression_ = 0;
};

}  // namespace embody::physics::deformable
