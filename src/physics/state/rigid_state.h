// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "foundation/handle_table.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/surface_pairs.h"
#include "physics/dynamic/body_state.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

struct ShapeRecord {
    std::unique_ptr<CollisionShape> shape;
    std::uint32_t users = 0;
    bool is_of_piece = false;  ///< made for a piece of a broken body: goes where that breaks again
};

/// A body as its user defined it. Its pose and velocities are out of date: BodyState has the present ones.
struct BodyRecord {
    BodyDefinition definition;
    const CollisionShape* shape = nullptr;  ///< nullptr: none
    double reach = 0;                       ///< farthest surface point from the centre of mass, m
    bool is_round = false;                  ///< rolls: its contacts move over its surface
    bool is_ball = false;                   ///< a sphere about its centre of mass: rotation changes nothing
    std::uint32_t version = 0;              ///< changes with each change of the body's shape, kind or pose by the user
    double inner_radius = 0;       ///< half the thinnest extent: a body that moves farther in a step may tunnel, m
    Vec3 next_force, next_torque;  ///< for the next step only, cleared by report; N, N m about the centre of mass
    Vec3 start_linear_velocity, start_angular_velocity;  ///< when the step began, where there are deformables
    Vec3 deformable_force, deformable_torque;            ///< pushes of deformables for the next step, N, N m
    Vec3 whole_push, whole_push_torque;                  ///< all of their pushes in the last step, N, N m
    Vec3 late_force, late_torque;                        ///< the part of these by sheets that take the step as a whole
    Vec3 drag;                                           ///< of the air in this step, or when it fell asleep, N
    Vec3 fluid_force, fluid_torque;                      ///< of fluids in this step, N, N m
    Vec3 last_center;                                    ///< last finite pose, to freeze the body at
    Quat last_rotation;
};

/// The bodies: their definitions by users, and their motion. The arrays are indexed by the body's slot.
struct RigidState {
    SurfacePairs surface_pairs;                        // face
    HandleTable<struct ShapeTag, ShapeRecord> shapes;  // face
    HandleTable<struct BodyTag, BodyRecord> bodies;    // face
    std::set<std::uint32_t> brittle;                   // face: slots of bodies that blows may break
    std::uint32_t last_body_version = 0;               // face
    std::vector<BodyState> motion;                     // impact, substeps, continuous
    std::vector<BodyConstants> constants;              // face; acceleration, torque: wake

    [[nodiscard]] bool is_used(std::uint32_t body) const { return bodies.used(body); }
    [[nodiscard]] const BodyRecord& record(std::uint32_t body) const { return bodies.at(body); }
    [[nodiscard]] BodyRecord& record(std::uint32_t body) { return bodies.at(body); }
    [[nodiscard]] Transform pose(std::uint32_t body) const {
        return body_pose(motion[body], constants[body].local_center);
    }
    [[nodiscard]] bool is_dynamic(std::uint32_t body) const {
        return bodies.at(body).definition.kind == BodyKind::dynamic_body;
    }
};

}  // namespace embody::physics::state
