// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vec3.h"

namespace embody::physics {

/// What a line or point stands for. The user of DebugDraw chooses its colour. The numbers are part of docs/protocol.md.
enum class DebugMeaning : std::uint8_t {
    static_shape,
    kinematic_shape,
    active_shape,
    wants_to_sleep_shape,
    asleep_shape,
    bounds,          ///< of a body's shape
    contact,         ///< where two things touch; number: 0 bodies, 1 something soft, 2 a drop of a liquid
    contact_normal,  ///< from the first to the second, to what is soft, to the drop; number: as of contact
    impulse,         ///< of the last step on what the normal points to, of liquids on the body; number: as of contact
    island,          ///< number: of the island
    joint,           ///< from a centre of mass to the joint's frame
    joint_axis,      ///< number: 0, 1, 2 for X, Y, Z of a joint frame; that of the second body is dim
    joint_limit,     ///< range of the joint's coordinate
    center_of_mass,
    inertia_axis,  ///< number: 0, 1, 2, the smallest moment first
    particle,      ///< of a fluid
    node,          ///< of a deformable; number: 1 where it is pinned
    edge,          ///< between two nodes
    attachment,    ///< from a node to the body or node that holds it
    tree,          ///< box of the broad phase; number: depth, 0 the topmost
    velocity,      ///< of a centre of mass: to where it would be in a fifth of a second
    force,         ///< on a body; number: 0 its weight, 1 its constant force, 2 of a contact
    count
};

struct DebugColor {
    DebugMeaning meaning = DebugMeaning::bounds;
    std::uint16_t number = 0;  ///< where the meaning has one; modulo 65,536
    bool is_dim = false;       ///< asleep, disabled, or less important
};

/// Receives the drawing of World::debug_draw(). Positions are in the world, m.
class DebugDraw {
public:
    virtual ~DebugDraw() = default;
    virtual void line(Vec3 from, Vec3 to, DebugColor color) = 0;
    virtual void point(Vec3 at, DebugColor color) = 0;
};

/// What can be drawn, as bits.
enum class DebugDrawFlag : std::uint32_t {
    shapes = 1u << 0,       ///< of bodies, as wires; coloured by island if `islands` is set too
    bounds = 1u << 1,       ///< boxes around the shapes
    contacts = 1u << 2,     ///< points and normals: of bodies, deformables and drops
    impulses = 1u << 3,     ///< arrows, as long as told by DebugDrawOptions::longest_arrow
    islands = 1u << 4,      ///< a box around each
    joints = 1u << 5,       ///< frames, axes, limits
    masses = 1u << 6,       ///< centres, and axes of the box of equal mass and inertia
    particles = 1u << 7,    ///< of fluids
    deformables = 1u << 8,  ///< nodes, edges and attachments
    trees = 1u << 9,        ///< boxes of the broad phase
    velocities = 1u << 10,  ///< arrows at centres of mass
    forces = 1u << 11,      ///< arrows, as long as told by DebugDrawOptions::longest_arrow
};
/// Names of the flags: element i is the name of bit i.
inline constexpr std::array debug_draw_names{"shapes", "bounds",    "contacts",    "impulses", "islands",    "joints",
                                             "masses", "particles", "deformables", "trees",    "velocities", "forces"};

struct DebugDrawOptions {
    std::uint32_t flags = 0;          ///< DebugDrawFlag
    double mark_length = 0.1;         ///< of normals and joint axes, m
    double longest_arrow = 0.5;       ///< of the largest impulse; others in proportion, m
    double plane_half_size = 10;      ///< of the square that shows an endless plane, m
    std::size_t max_lines = 100'000;  ///< lines beyond this are left out: shapes come last, static ones at the end
    std::size_t max_points = 200'000;
    /// Of bodies with these user data alone are contacts, impulses, masses, velocities and forces drawn; ascending;
    /// empty: of all.
    std::vector<std::uint64_t> only = {};
};

struct DebugDrawCount {
    std::size_t lines = 0, points = 0;                    ///< number drawn
    std::size_t lines_left_out = 0, points_left_out = 0;  ///< beyond what the options allow
};

}  // namespace embody::physics
