// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/impact/frictional_impact.h"
#include "physics/constraint/impact/impact_joints.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/impact_solver_settings.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// One place where two bodies collide or rest on each other while a neighbour collides.
struct ImpactSite {
    std::uint32_t a = 0, b = 0;       ///< body slots
    Vec3 arm_a, arm_b;                ///< from the centres of mass, world, at the moment of impact
    Vec3 normal;                      ///< from a to b, unit, world
    ImpactCoefficients coefficients;  ///< restitution 0 where the bodies only rest on each other
    Vec3 impulse;                     ///< out: on b, world, N s
};

struct ImpactReport {
    bool converged = true;     ///< false: some site still approaches after the allowed iterations
    double energy_change = 0;  ///< J, <= 0 up to rounding
};

/// How the path of each site's sliding over the normal impulse is found.
enum class SlidePath {
    followed,   ///< eq. (3) integrated
    estimated,  ///< by the impulse that ends in sticking, else along the slide's mean direction
};

/// A site at work: its frame and what has happened to it.
struct ImpactWork {
    ImpactSite* site = nullptr;
    Vec3 velocity_before;            ///< of b relative to a, world
    Vec3 turn_a, turn_b;             ///< arm × normal
    ImpactJoints* joints = nullptr;  ///< that pass its impulses on; null where neither body is jointed
    Vec6* response = nullptr;        ///< of the jointed bodies' velocities to 1 N s along each axis of the frame
    bool is_ready = false;           ///< the next two are valid
    Mat3 frame;                      ///< columns t1, t2, n
    Mat3 inverse_mass;               ///< A of eq. (3) in the frame
    ImpactState state;
    double compression_work = 0;
    double velocity = 0;          ///< along the normal, before several sites are compressed together, m/s
    std::size_t place = 0;        ///< among the sites of its pair of bodies
    Vec3 friction;                ///< in the expansion, in the frame
    Vec3 compression, expansion;  ///< impulses in the frame
};

/// Kept from group to group, so that a steady step allocates nothing.
struct ImpactGroupMemory {
    std::vector<ImpactWork> works;
    std::vector<Vec6> responses;
    std::vector<ImpactWork*> fastest;
    std::vector<Vec3> impulses;
    ImpactJoints joints;  ///< set before: what passes the impulses on
};

/// Solves the collision of all sites together and changes the velocities of their bodies, and of those that joints
/// connect with them (memory.joints).
ImpactReport solve_impact_group(std::span<ImpactSite> sites, std::span<BodyState> bodies, ImpactGroupMemory& memory,
                                const ImpactSolverSettings& settings, SlidePath path = SlidePath::followed);

}  // namespace embody::physics::constraint
