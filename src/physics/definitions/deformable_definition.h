// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/handles.h"
#include "physics/definitions/material.h"

namespace embody::physics {

/// A solid of tetrahedra: foam, rubber, flesh.
struct SoftSolid {
    std::vector<std::array<std::uint32_t, 4>> tetrahedra;           ///< nodes, in any orientation, with volume
    double density = 1000;                                          ///< kg/m³, 0.1 … 22600
    double youngs_modulus = 1e5;                                    ///< Pa, 100 … 1e12
    double poisson_ratio = 0.3;                                     ///< -0.9 … 0.495
    double rayleigh_damping = 0;                                    ///< stiffness-proportional, s, 0 … 100
    double yield_stress = std::numeric_limits<double>::infinity();  ///< von Mises, Pa, > 0: beyond it the solid stays
                                                                    ///< deformed
    double internal_pressure = 0;  ///< pressure above that of the air around, Pa, 0 …
                                   ///< 1e8
};

/// A sheet of triangles: cloth, paper, foil. The nodes' places at rest are the cut.
struct Cloth {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< nodes, with area
    double area_density = 0.2;                            ///< kg/m², 1e-4 … 1000
    double thickness = 5e-4;                              ///< m, 1e-6 … 0.1
    double stretch_stiffness = 500;                       ///< force per width and strain, N/m, 1e-3 … 1e9
    double shear_stiffness = 50;                          ///< force per width and shear, N/m, 1e-3 … 1e9
    double bend_stiffness = 2e-5;                         ///< moment per width and curvature, N m, 1e-9 … 1e6
    double rayleigh_damping = 0;                          ///< stiffness-proportional, s, 0 … 100
    double drag_coefficient = 1.2;                        ///< of a flat piece across the air's stream, 0 … 10
    double bend_friction = 0;  ///< the most that friction between the threads resists bending with, as the curvature
                               ///< that the bend stiffness resists with as much, 1/m, 0 … 1e6
    double bend_yield = std::numeric_limits<double>::infinity();  ///< curvature beyond which a fold stays, 1/m, > 0
    double internal_pressure = 0;  ///< of gas in a closed sheet, above that of the air around, while the nodes have
                                   ///< their form, Pa, 0 … 1e8; 0: no gas
    double prestretch = 1;  ///< length of its threads in the form of the nodes over that without tension, 1 … 2: of
                            ///< what is modelled blown up
    double tear_strength = std::numeric_limits<double>::infinity();  ///< tension beyond which a tear starts, N/m, > 0
    double tear_energy = std::numeric_limits<double>::infinity();    ///< that a tear takes for its length, J/m, > 0;
                                                                     ///< infinite: it goes on by tension, too
};

/// A line of nodes, each joined to the next: rope, cable, thread. Straight at rest.
struct Rope {
    double diameter = 0.01;                                          ///< m, 1e-4 … 1
    double linear_density = 0.07;                                    ///< kg/m, 1e-6 … 1e4
    double axial_stiffness = 1e4;                                    ///< EA, N, 1e-3 … 1e12
    double bend_rigidity = 1e-3;                                     ///< EI, N m², 1e-12 … 1e9
    double twist_rigidity = 1e-3;                                    ///< GJ, N m², 1e-12 … 1e9
    double rayleigh_damping = 0;                                     ///< stiffness-proportional, s, 0 … 100
    double break_tension = std::numeric_limits<double>::infinity();  ///< N, > 0
    double bend_yield = std::numeric_limits<double>::infinity();     ///< of wires: curvature beyond which a bend stays,
                                                                     ///< 1/m, > 0
    double slack = 0;  ///< extra length at rest, as a fraction of the length along the nodes, 0 … 10
};

/// A node held to a point of a body.
struct Attachment {
    std::uint32_t node = 0;
    BodyHandle body;
    Vec3 anchor;  ///< in the body's frame, m
};

/// A node of a sheet or rope held to a point of another deformable, which lies between up to three of its nodes. Where
/// the two are apart, the tie draws them together.
struct Tie {
    std::uint32_t node = 0;
    DeformableHandle other;
    std::array<std::uint32_t, 3> other_nodes{};
    std::array<double, 3> weight{1, 0, 0};  ///< of these, each 0 … 1, together 1; nodes of weight 0 do not count
};

/// A rope's direction that is held by what holds its node: the world for a pinned node, the body for an attached one.
/// The rope bends from there on as a clamped rod, and is twisted where its clamps turn against each other.
struct Clamp {
    std::uint32_t node = 0;
    Vec3 direction{1, 0, 0};  ///< unit, along the rope towards its later nodes; in the world's or the body's frame
    friend bool operator==(const Clamp&, const Clamp&) = default;
};

/// How far a rope is twisted between two neighbouring clamps.
struct RopeTwist {
    std::uint32_t from = 0, to = 0;  ///< nodes
    double angle = 0;                ///< of the second against the first, about the rope's direction, rad; turns count
    double moment = 0;               ///< N m: acts on the second clamp as -moment and on the first as moment
};

/// Pressure of the air around things with gas inside, Pa. Source: standard atmosphere, ISO 2533:1975
inline constexpr double air_pressure = 101'325;

/// Gas in a closed sheet.
struct GasInside {
    double volume = 0;    ///< m³
    double pressure = 0;  ///< above that of the air around, Pa
};

/// A deformable body: nodes, and elastic matter between them. Lengths in m, in the deformable's own frame.
struct DeformableDefinition {
    std::vector<Vec3> nodes;  ///< at rest
    std::variant<SoftSolid, Cloth, Rope> matter;
    std::vector<std::uint32_t> pinned;    ///< nodes that stay where they are placed
    std::vector<Attachment> attachments;  ///< at most one a node, and none for a pinned node
    std::vector<Clamp> clamps;            ///< of a rope: at most one a node, which is pinned or attached
    std::vector<Tie> ties;                ///< of a sheet or rope: at most one a node, which nothing else holds
    Transform pose;                       ///< of its frame at the start
    Vec3 linear_velocity;                 ///< of all nodes at the start, m/s
    Vec3 angular_velocity;                ///< about the centre of mass, world axes, rad/s
    double gravity_factor = 1;            ///< -10 … 10
    Vec3 force;                           ///< constant, N, world axes, distributed over the nodes by mass
    Material material;                    ///< of its surface, as of bodies; its matter determines how it bounces
    double contact_radius = 1e-3;         ///< distance that nodes keep from other surfaces, m, 1e-5 … 1
    bool enabled = true;                  ///< a disabled one neither moves nor collides
    std::uint32_t collision_group = 1;    ///< bits; as of bodies
    std::uint32_t collision_mask = 0xFFFFFFFFu;
    std::uint64_t user_data = 0;  ///< the library never reads it
};

/// A corner of a sheet's triangle that a tear has given another node (docs/physics/tearing.md).
struct TornCorner {
    std::uint32_t corner = 0;  ///< 3 t + k: of triangle t its k-th
    std::uint32_t from = 0;    ///< the node that it had
    std::uint32_t node = 0;    ///< at the same place at rest
    friend bool operator==(const TornCorner&, const TornCorner&) = default;
};

/// What a deformable does not recover from by itself.
struct LastingDeformation {
    /// Of a solid's tetrahedra in their order, then of its nodes: xx, yy, xy, xz and yz of the plastic strain in the
    /// axes at rest; zz is -(xx + yy). Empty: none.
    std::vector<std::array<double, 5>> plastic_strain;
    std::vector<std::uint32_t> broken_segments;  ///< of a rope, ascending
    /// Of a sheet's triangles in their order, in 1/m: the curvature that friction holds, then that of folds that stay,
    /// each as xx, yy and √2 xy in the triangle's plane with x along the warp. Of a rope's nodes in their order: the
    /// changes of direction that stay at the node, and where it is clamped before and after it, each as two parts
    /// across the wire. Empty: none.
    std::vector<std::array<double, 6>> bend;
    /// Of a sheet, in the order in which it tore. New nodes follow those of the definition.
    std::vector<TornCorner> torn_corners;
};

/// Whether each edge is between two triangles that run along it in opposite directions: the sheet can hold gas.
bool is_closed(const Cloth& cloth);

/// What closed triangles enclose, m³: negative where their corners run clockwise seen from outside.
double enclosed_volume(std::span<const Vec3> nodes, std::span<const std::array<std::uint32_t, 3>> triangles);

/// Tears a sheet: its corners get these nodes, in this order; a node that is new begins where the corner's was. A sheet
/// that is closed no more has no gas. The definition stays as it was where the answer is an error.
Result<void> tear(DeformableDefinition& definition, std::span<const TornCorner> corners);

/// Whether every number is finite and in range, every index points to a node, every node belongs to an element and
/// every element has its volume, area or length; the error's `where` is the field. Bodies are checked by the world.
Result<void> validate(const DeformableDefinition& definition);

}  // namespace embody::physics
