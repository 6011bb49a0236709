// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/collision/pairs/manifold.h"
#include "physics/constraint/impact/impact_group.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// A predicted impact. It is outdated once one of the bodies has had another one (the contact's version has increased).
struct ImpactEvent {
    double time;
    std::uint32_t contact;
    std::uint32_t version;
    bool operator>(const ImpactEvent& other) const {
        return time != other.time ? time > other.time : contact > other.contact;
    }
};

/// A contact's next impact in the step.
struct ImpactPrediction {
    static constexpr double never = 1e300;
    double time = never;     ///< s since the step began
    bool is_open = false;    ///< the bodies stay apart until the step's end
    bool is_certain = true;  ///< otherwise only the exact paths decide
    bool may_hide = false;   ///< no point meets, but other points of surfaces that turn this fast may
};

/// Memory of the impact stage, so that a steady step allocates nothing. From the last step it keeps held_accelerations.
struct ImpactMemory {
    // By body.
    std::vector<std::uint8_t> is_supported;     ///< a contact carried it in the last step
    std::vector<double> last_time;              ///< its last impact in this step, s
    std::vector<double> remaining_restitution;  ///< product of the restitutions of its bounces in this step
    std::vector<float> speed_gain;              ///< maximum that free motion can add to its approach in the step, m/s
    std::vector<std::uint32_t> path_of_body;    ///< first of its path's states, see BodyPaths
    std::vector<BodyState> path_states;         ///< with the inverse inertia of the start of the step
    std::vector<std::uint32_t> remembered_bodies;

    // By contact; the lists of each body's contacts once there is an impact at all.
    std::vector<ImpactPrediction> first;  ///< its first impact as predicted at the step's start
    std::vector<std::uint32_t> version;
    std::vector<double> next_time;         ///< time of the event in the queue, s; ImpactPrediction::never: none
    std::vector<std::uint8_t> impacts;     ///< in this step
    std::vector<std::uint8_t> is_open;     ///< its bodies stay apart for the rest of the step unless others hit them
    std::vector<std::uint32_t> uncertain;  ///< contacts whose first impact straight paths cannot decide
    std::vector<std::uint32_t> uncertain_bodies;
    std::vector<std::uint32_t> first_of_body, of_body;
    bool has_lists = false;

    // The active joints of each body, once an impact has asked for them: by body, then joint by joint.
    std::vector<std::uint32_t> first_joint_of_body, joint_of_body;
    bool has_joint_lists = false;

    std::vector<std::uint8_t> is_held;  ///< by body: something other than free flight moves it
    std::vector<std::uint8_t>
        has_jointed_path;  ///< by body: held by joints without limits and motors; empty where there are none
    std::vector<std::uint32_t> assembly_parent;  ///< by body: union-find over what joints connect
    /// Acceleration of a jointed body by joints and contacts in the last step.
    struct HeldAcceleration {
        Vec3f linear;       ///< of the centre of mass, m/s²
        float turning = 0;  ///< of the surface by the body's rotation, m/s²
    };
    std::vector<HeldAcceleration> held_accelerations;  ///< by body; empty without joints

    std::size_t pile_bounces = 0;    ///< bounces of bodies that others carry
    std::size_t assembly_nodes = 0;  ///< bodies and joints of all jointed assemblies that were solved in this step

    // Of the present impact.
    std::vector<ImpactEvent> events;  ///< binary heap, the earliest event on top
    std::vector<ImpactSite> sites;
    std::vector<std::uint32_t> site_contact;  ///< contact of each site
    std::vector<Manifold> manifolds;
    struct Moved {
        std::uint32_t body;
        bool has_changed;
        BodyState start;                         ///< state at the step's start, on the path that led to the impact
        Vec3 linear_velocity, angular_velocity;  ///< before the impact, at its time
    };
    std::vector<Moved> bodies;
    std::vector<std::uint32_t> neighbours;      ///< bodies that collide, and those jointed to them
    std::vector<std::uint32_t> jointed;         ///< those of `neighbours` that joints connect, ascending
    std::vector<std::uint32_t> jointed_joints;  ///< indices of these joints, ascending
    struct Carrier {
        std::uint32_t body;
        BodyState start;  ///< of the step
    };
    std::vector<Carrier> carriers;  ///< moving kinematic bodies that these joints are attached to
    std::vector<ImpactJoints::Push> pushes;
    bool is_flown = false;  ///< the jointed bodies fly to the impact and back as the substeps will move them
    struct Flight {
        std::vector<std::uint32_t> bodies, joints;  ///< as jointed and jointed_joints
        JointSystem system;
        std::uint64_t last_use = 0;
    };
    std::vector<Flight> flights;  ///< flights of the last assemblies: their systems are analysed
    std::uint64_t flight_uses = 0;
    std::vector<Joint> flown_joints;        ///< copies of their joints
    std::vector<std::uint32_t> flown_list;  ///< indices of these
    ImpactGroupMemory group;
};

}  // namespace embody::physics::state
