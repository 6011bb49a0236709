// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "math/vec3.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/particles/mixture.h"
#include "physics/fluid/particles/particle.h"

namespace embody::physics::fluid {

/// Liquid that the drag of a point of something thin holds, which goes along with the point when elastic forces change
/// its velocity (docs/physics/coupling.md, "Liquids and what bends").
struct PointBond {
    Vec3 place;  ///< of the point when the liquid's step ends, in the fluid's frame, m
    Vec3 drag;   ///< c of the step, by axis, kg

    Vec3 bound;     ///< B: mass of liquid that it holds, by axis, kg; at most c
    Vec3 velocity;  ///< mean of that liquid, m/s
};

/// Finds `bound` and `velocity`: the particles are collected on the points of a lattice of cells around the bonds, and
/// each is a parcel that all drag at it holds together: no liquid is bound twice.
void find_bonds(double cell, const Mixture& liquids, std::span<const FluidParticle> particles,
                std::span<PointBond> bonds);
/// Gives each bond's liquid an impulse (N s), for the bonds and particles of find_bonds(). Energy changes by no more
/// than that of one parcel of the mass and velocity of the bond.
void push_bonds(double cell, const Mixture& liquids, std::span<const PointBond> bonds, std::span<const Vec3> impulses,
                std::span<FluidParticle> particles);

}  // namespace embody::physics::fluid
