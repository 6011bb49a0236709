// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "foundation/handle_table.h"
#include "foundation/task_pool.h"
#include "physics/collision/broad_phase/broad_phase.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/constraint/contact/contact.h"
#include "physics/constraint/direct/direct_contact_solver.h"
#include "physics/constraint/joint/joint_system.h"
#include "physics/constraint/sweeps/wide_contact_solver.h"
#include "physics/definitions/events.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/deformable/cloth/cloth_solver.h"
#include "physics/deformable/contact/pair_springs.h"
#include "physics/deformable/solid/solid_contacts.h"
#include "physics/dynamic/wind.h"
#include "physics/optimization/island_sleep.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/solve_schedule.h"
#include "physics/state/ball_memory.h"
#include "physics/state/deformable_record.h"
#include "physics/state/fluid_record.h"
#include "physics/state/impact_memory.h"
#include "physics/state/ledger.h"
#include "physics/state/namespace.h"
#include "physics/state/substep_memory.h"
#include "physics/state/touch_memory.h"

namespace embody::physics::state {

struct ShapeRecord {
    std::unique_ptr<CollisionShape> shape;
    std::uint32_t users = 0;
};

/// What a body was told to be. Pose and velocities in it are stale: BodyState has them.
struct BodyRecord {
    BodyDefinition definition;
    const CollisionShape* shape = nullptr;  ///< nullptr: none
    double reach = 0;                       ///< farthest surface point from the centre of mass, m
    bool is_round = false;                  ///< rolls: its contacts do not stay where they are on it
    bool is_ball = false;                   ///< a sphere about its centre of mass: turning changes nothing
    std::uint32_t version = 0;     ///< another one after each change of the body's shape, kind or pose by the user
    double inner_radius = 0;       ///< half the thinnest extent: a body that moves farther in a step may tunnel, m
    Vec3 next_force, next_torque;  ///< for the next step only, cleared by report; N, N m about the centre of mass
    Vec3 start_linear_velocity, start_angular_velocity;  ///< when the step began, where there are deformables
    Vec3 deformable_force, deformable_torque;            ///< pushes of deformables in the last step, N, N m
    Vec3 late_force, late_torque;                        ///< of these, those of sheets that take the step as a whole
    Vec3 drag;                                           ///< of the air in this step, or when it fell asleep, N
    Vec3 fluid_force, fluid_torque;                      ///< of fluids in this step, N, N m
    Vec3 last_center;                                    ///< last finite pose, to freeze the body at
    Quat last_rotation;
};

struct JointRecord {
    JointDefinition definition;
    Joint constraint;  ///< written by substeps; sleeps with its bodies
};

/// An island that sleeps: its bodies and the contacts that it fell asleep with.
struct SleepingGroup {
    std::vector<std::uint32_t> bodies;
    std::vector<Contact> contacts;
};

/// A body that has left the bounds that the broad phase knows of it.
struct LeavingBody {
    std::uint32_t body = 0;
    Bounds bounds;  ///< of its way in this step
    Vec3 motion;    ///< m, in this step
};

/// Two touching bodies as the contact events know them.
struct TouchingPair {
    BodyHandle a, b;
    friend auto operator<=>(const TouchingPair&, const TouchingPair&) = default;
};

/// When the last impulses of a body's island held it where it was.
struct HeldRecord {
    std::uint64_t step = 0;
    std::uint32_t contacts = 0;  ///< of the island
};

/// Everything a world remembers. Arrays over bodies are indexed by slot. Each array names the stage that writes it;
/// "face" is World, between steps.
struct WorldState {
    WorldSettings settings;
    SurfacePairs surface_pairs;  // face

    HandleTable<struct ShapeTag, ShapeRecord> shapes;                 // face
    HandleTable<struct BodyTag, BodyRecord> bodies;                   // face
    HandleTable<struct JointTag, JointRecord> joints;                 // face; impulses: substeps
    HandleTable<struct DeformableTag, DeformableRecord> deformables;  // face; nodes: deformables
    HandleTable<struct FluidTag, FluidRecord> fluids;                 // face; particles: fluids
    std::vector<FluidTouch> fluid_touches;                            // fluids: by slot of the body
    std::vector<std::uint32_t> pushed_by_fluids;                      // fluids: slots whose fluid_force is not zero
    std::set<std::pair<std::uint32_t, std::uint32_t>> jointed_pairs;  // face: slots whose bodies must not collide

    std::vector<BodyState> motion;         // impact, substeps, continuous
    std::vector<BodyConstants> constants;  // face; acceleration, torque: wake
    std::vector<SleepRecord> sleep;        // sleep, wake

    BroadPhase broad_phase;                                // find pairs
    std::vector<std::vector<LeavingBody>> leaving;         // find pairs: memory only, by worker
    const std::vector<BroadPhase::Pair>* pairs = nullptr;  // find pairs
    TouchMemory touch_memory;                              // touch
    std::uint32_t last_body_version = 0;                   // face
    std::vector<std::uint32_t> awake;                      // wake: slots of moving bodies, ascending
    std::uint32_t asleep_when_gathered = 0;                // wake: dynamic bodies that slept when awake was listed
    bool awake_changed = true;                             // face, wake, substeps, sleep: awake must be listed anew
    std::uint64_t awake_version = 0;                       // wake: counts the lists of awake
    std::vector<Contact> contacts;                         // touch; impulses: impact, substeps
    std::vector<ContactGlance> contact_glances;            // touch, substeps, sleep: one for each of contacts
    ImpactMemory impact_memory;                            // impact
    BallMemory ball_memory;                                // touch, for substeps
    std::vector<Joint> active_joints;                      // islands; impulses: substeps
    std::vector<std::uint32_t> active_joint_slots;         // islands
    Islands islands;                                       // islands
    std::vector<std::uint32_t> movable;                    // islands: memory only

    std::unique_ptr<TaskPool> workers = std::make_unique<TaskPool>(1);
    WideContactSolver wide_solver{widest_contact_kernels()};  // substeps: memory only
    DirectContactSolver direct_solver;                        // substeps: memory, and which islands it gave up
    std::vector<HeldRecord> held;                             // substeps: by slot
    std::map<std::uint32_t, JointSystem> joint_systems;       // substeps: by an island's first body; memory only
    SolveSchedule schedule;                                   // substeps: memory only
    std::vector<PreparedContact> prepared_contacts;           // substeps: memory only
    std::vector<Vec3> kicked_velocity;                        // substeps: linear velocity before the constraints, m/s
    SubstepMemory substep_memory;                             // substeps: memory only

    SolidContacts solid_contacts;              // deformables: memory only
    ThinContacts thin_contacts;                // deformables: contacts between sheets and ropes
    ClothSolver pair_solver;                   // deformables: memory only
    std::vector<std::uint32_t> pushed_bodies;  // deformables: slots whose deformable_force is not zero

    std::map<std::uint32_t, SleepingGroup> sleepers;  // sleep, wake
    std::uint32_t next_group = 1;                     // sleep
    std::vector<std::uint32_t> to_wake;               // face, touch: slots

    std::vector<TouchingPair> touching;             // report: awake pairs that touch, sorted
    std::vector<TouchingPair> touching_now;         // report: memory only
    std::vector<ContactEvent> contact_events;       // report
    std::vector<RopeBreakEvent> rope_break_events;  // deformables
    std::vector<SleepEvent> sleep_events;           // wake, sleep
    StepReport report;                              // all
    std::unique_ptr<Ledger> ledger;                 // face; all: what changed energy and momenta; null: not asked for

    [[nodiscard]] bool is_used(std::uint32_t body) const { return bodies.used(body); }
    [[nodiscard]] const BodyRecord& record(std::uint32_t body) const { return bodies.at(body); }
    [[nodiscard]] BodyRecord& record(std::uint32_t body) { return bodies.at(body); }
    [[nodiscard]] Transform pose(std::uint32_t body) const {
        return body_pose(motion[body], constants[body].local_center);
    }
    /// The air now.
    [[nodiscard]] Wind wind() const { return {settings.wind, settings.gustiness, settings.gust_time, report.time}; }
    [[nodiscard]] bool is_dynamic(std::uint32_t body) const {
        return bodies.at(body).definition.kind == BodyKind::dynamic_body;
    }
    [[nodiscard]] bool is_asleep(std::uint32_t body) const { return sleep[body].state == SleepState::asleep; }
};

}  // namespace embody::physics::state
