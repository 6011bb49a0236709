// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "math/mat3.h"
#include "physics/definitions/settings/thin_contact_settings.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/substep.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A deformable in a substep: what is given to its nodes from outside (N s, by node), and their moves (m).
struct FreePart {
    const Nodes* nodes = nullptr;
    std::vector<Vec3> given;
    std::span<Vec3> moves;
};
/// For deformables that nothing but each other holds: changes their moves (of a substep of h seconds) by a small move
/// and turn of the whole, so that momentum and angular momentum are those before plus what is given. Forces within and
/// between them change neither; a solve that ended early does, and backward Euler slows turning.
void keep_momenta(std::span<const FreePart> parts, double h, const ThinContactSettings& settings);

/// Impulses of the flow around the nodes in a substep in which they move by `moves` (m), N s; none without a flow. Held
/// nodes have none.
[[nodiscard]] std::vector<Vec3> impulses_of_flow(const Nodes& nodes, std::span<const Vec3> moves,
                                                 const Substep& substep);
/// Its energy in the function that a substep minimises: the derivative by the move is minus its force, J.
[[nodiscard]] double flow_energy(const NodeFlow& flow, Vec3 move, const Substep& substep);

/// Motion of all nodes, weighted by mass.
struct WholeMotion {
    Vec3 velocity, spin;  ///< m/s, rad/s
    double mass = 0;      ///< kg
    Vec3 center;          ///< m
    Mat3 inertia = Mat3::zero();

    [[nodiscard]] Vec3 velocity_at(Vec3 place) const { return velocity + cross(spin, place - center); }
    /// Change of that velocity along n by an impulse of 1 N s along n, 1/kg.
    [[nodiscard]] double inverse_mass_at(Vec3 place, Vec3 n) const;
    /// After an impulse (N s) there.
    void strike(Vec3 impulse, Vec3 place);
};
[[nodiscard]] WholeMotion motion_of_whole(const Nodes& nodes);

/// Makes the mean velocities those of a substep of h seconds that ends now: the velocity of h/2 ago. So what begins
/// with the velocity of an instant, or goes on with substeps of another length, falls on as it did. Turns are not taken
/// back: either the angular momentum or the energy would be another one than was given.
/// `acceleration`: of all nodes, m/s². `is_free`: whether nothing else acts on them; else what goes on is not changed.
/// Nor is what begins at rest: it may lie or hang in balance, which a fall taken back would disturb.
void change_substep(Nodes& nodes, double h, Vec3 acceleration, bool is_free);

/// Sets the velocities after a substep of h seconds in which nodes have moved by `moves` (m): the mean ones; those at
/// the end are these plus half of the last change of the whole's velocity, which is exact for a free fall. Half of each
/// node's own change would make a fast spin look faster than it is.
void set_velocities(Nodes& nodes, std::span<const Vec3> moves, double h);

}  // namespace embody::physics::deformable
