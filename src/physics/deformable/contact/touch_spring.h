// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "physics/deformable/contact/substep.h"
#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Displacement of a body off its path by the pushes of a substep: m, rad.
struct BodyMove {
    Vec3 shift, turn;
};

/// The move of a point at `arm` when the body's unknown c (three of its place, three of its turn) goes by one.
inline Vec3 unit_move(std::size_t c, Vec3 arm) {
    Vec3 axis;
    axis[static_cast<int>(c % 3)] = 1;
    return c < 3 ? axis : cross(axis, arm);
}

inline constexpr std::uint32_t no_body = 0xFFFFFFFFu;
inline constexpr std::uint32_t no_node = 0xFFFFFFFFu;

/// Inertia of bodies within a substep of h seconds, for those that pushes move.
struct BodyInertia {
    bool moves = false;
    double mass = 0;  ///< over the substep squared, kg/s²
    Mat3 inertia = Mat3::zero();
};
std::vector<BodyInertia> inertias_of(std::span<const TouchedBody> bodies, double h);

/// Feature of a deformable that touches, the same from substep to substep: a node and no_node, the two ends of an edge,
/// or no_node and the number of a body's feature that pokes into a triangle.
using TouchFeature = std::array<std::uint32_t, 2>;

/// What holds a point of a deformable, Σ weight x, off a plane or to an anchor of a body: the force
///   load - matrix s
/// on the point, where s is its displacement in the substep beyond that of the touched body by its pushes.
struct TouchSpring {
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};
    int count = 1;                 ///< of nodes
    TouchFeature feature{};        ///< with the body: its anchor; about that direction: what is remembered
    std::uint32_t body = no_body;  ///< index in the list of bodies
    bool is_attachment = false;    ///< pulls too, in every direction
    bool is_recovery = false;      ///< of a point that began inside: its force is forgotten
    Vec3 normal;                   ///< unit, towards the point, at the end of the substep
    Vec3 arm;                      ///< from the body's centre of mass to what is touched, then
    PairFriction friction;         ///< of the two surfaces
    bool sticks = true;            ///< holds by static friction until its limit is left
    bool predicts_slip = false;    ///< as of TouchSprings
    double gap = 0;                ///< at the end of the substep if the point stays, m
    double overlap = 0;            ///< at the substep's start, of a contact with a body, m
    double returned = 0;           ///< part of an overlap that the substep takes back and that is not remembered, m
    Vec3 carried;                  ///< displacement of the body's surface in the substep on its path, m
    double stiffness = 0;          ///< maximum of both directions, N/m
    double inertia = 0;            ///< mass of the point over the substep squared, N/m
    double body_compliance = 0;    ///< of a body that moves, across the normal, at most, m/N
    Vec3 pull;                     ///< force that the spring had at the last substep's end, N: the push is along n
    Vec3 hold;                     ///< tangential stretch of the spring while it sticks, m

    bool acts = false;
    Vec3 felt;                   ///< force on the point in the substep that finish() ended, N
    Mat3 matrix = Mat3::zero();  ///< symmetric, not negative, N/m
    Vec3 load;

    /// Force on the point for that displacement relative to the body.
    [[nodiscard]] Vec3 force(Vec3 s) const { return load - matrix * s; }
    [[nodiscard]] Vec3 lead(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves) const;
};

inline bool moves_body(const TouchSpring& spring, std::span<const BodyInertia> bodies) {
    return spring.body != no_body && bodies[spring.body].moves;
}

/// Terms of the function that a solve minimises: of a spring that acts, of a body's moves; J.
double energy_of(const TouchSpring& spring, std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves);
double energy_of(const BodyInertia& inertia, const BodyMove& move);
/// The same for a spring regardless of whether it acted in the solve: for a contact, which only pushes, without
/// friction.
double energy_pressed(const TouchSpring& spring, std::span<const Vec3> node_moves,
                      std::span<const BodyMove> body_moves);

/// One of these two ways to count a spring's energy.
using SpringEnergy = double (*)(const TouchSpring&, std::span<const Vec3>, std::span<const BodyMove>);

/// For each body, the fraction of the springs' push for these moves that it may get: 1 where the push moves it as in
/// the solve, less where a solve that has not converged left stiff springs with far more.
std::vector<double> fractions_of(std::span<const TouchSpring> springs, std::span<const Vec3> node_moves,
                                 std::span<const BodyMove> body_moves, std::span<const BodyInertia> inertias,
                                 const Substep& substep);

/// Change of the contacts' forces, N, the forces of contacts that act, and the forces of all contacts that might act:
/// the finer and the coarser measure.
struct SpringChange {
    double change = 0, acting = 0, near = 0;
};
/// Determines whether a contact acts, and how its friction does, for that relative displacement (m). `is_predicted`:
/// the moves are by inertia alone and no measure of forces; the forces of the last substep are.
void choose_contact(TouchSpring& spring, Vec3 s, bool is_predicted, SpringChange& sum);
/// After a substep: returns what is left of a tangential stretch (m) that the contact cannot hold with that push (N);
/// stores whether it sticks. `h`: of the substep, s.
Vec3 held_stretch(TouchSpring& spring, Vec3 stretch, double push, double h);
/// Of a contact or tie between sheets and ropes, N/m: over the inertia of the heavier point (`mass`, kg), or of the
/// load on it by `force` (N), in a substep of h seconds. `gravity`: m/s².
double contact_stiffness(double mass, double force, double h, double gravity, const ThinContactSettings& settings);
/// What a contact remembers of that push, N: all but what `returned` took.
double kept_push(const TouchSpring& spring, double push);
/// The part of v along a plane.
inline Vec3 across(Vec3 v, Vec3 normal) { return v - dot(v, normal) * normal; }

}  // namespace embody::physics::deformable
