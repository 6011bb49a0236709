// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/events.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/fluid_port.h"
#include "physics/definitions/joint_definition.h"
#include "physics/definitions/shape_definition.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/surface_pairs.h"
#include "physics/definitions/world_settings.h"

namespace embody::physics {

class DebugDraw;
struct DebugDrawCount;
struct DebugDrawOptions;

namespace state {
struct WorldState;
}

/// The paper's Inter module: the interface of the physics for users and all other parts. Owns shapes, bodies, joints
/// and advances them. One thread at a time; several worlds are independent. Setters that are given a bad number or a
/// stale handle refuse it with the field's name and change nothing.
class World {
public:
    static Result<std::unique_ptr<World>> create(const WorldSettings& settings = {});
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    [[nodiscard]] const WorldSettings& settings() const;
    Result<void> set_settings(const WorldSettings& settings);
    /// Friction and restitution by pair of surfaces, for bodies whose combine rule is pair_table. Refused once there
    /// are bodies.
    Result<void> set_surface_pairs(SurfacePairs pairs);

    // Shapes: built once, shared by any number of bodies.
    Result<ShapeHandle> create_shape(const ShapeDefinition& definition);
    /// Refused while a body uses it.
    Result<void> destroy_shape(ShapeHandle shape);
    /// Its definition; nullptr if stale. Valid until it is destroyed.
    [[nodiscard]] const ShapeDefinition* shape(ShapeHandle shape) const;
    /// Unit density; zero volume for static-only shapes.
    [[nodiscard]] std::optional<double> volume(ShapeHandle shape) const;

    // Bodies.
    Result<BodyHandle> create_body(const BodyDefinition& definition);
    /// Destroys its joints too.
    Result<void> destroy_body(BodyHandle body);
    /// As destroy_body() for many bodies, each named once, in the time of one. All or none.
    Result<void> destroy_bodies(std::span<const BodyHandle> bodies);
    [[nodiscard]] bool contains(BodyHandle body) const;
    [[nodiscard]] std::vector<BodyHandle> bodies() const;
    /// The present definition: pose, velocities and everything that was set since; std::nullopt if stale.
    [[nodiscard]] std::optional<BodyDefinition> body(BodyHandle body) const;
    /// Replaces everything but the handle (kind, shape, mass, material, pose, …) and wakes the bodies that it touches.
    Result<void> set_body(BodyHandle body, const BodyDefinition& definition);
    /// As set_body() for many, each named once: `change` is given each one's present definition. All or none.
    Result<void> change_bodies(std::span<const BodyHandle> bodies, const std::function<void(BodyDefinition&)>& change);
    /// Cheap reads for streaming; identity, zero and asleep for a stale handle.
    [[nodiscard]] Transform pose(BodyHandle body) const;
    [[nodiscard]] Vec3 linear_velocity(BodyHandle body) const;
    [[nodiscard]] Vec3 angular_velocity(BodyHandle body) const;
    [[nodiscard]] SleepState sleep_state(BodyHandle body) const;
    /// kg; infinite for static and kinematic bodies.
    [[nodiscard]] double mass(BodyHandle body) const;
    /// World position of the centre of mass.
    [[nodiscard]] Vec3 center_of_mass(BodyHandle body) const;
    /// About the centre of mass in the body's axes, kg m².
    [[nodiscard]] Mat3 inertia(BodyHandle body) const;
    Result<void> set_pose(BodyHandle body, const Transform& pose);  ///< teleports and wakes
    Result<void> set_velocity(BodyHandle body, Vec3 linear, Vec3 angular);
    Result<void> set_force(BodyHandle body, Vec3 force, Vec3 torque);  ///< constant until set again
    Result<void> apply_impulse(BodyHandle body, Vec3 impulse, std::optional<Vec3> at_world_point = std::nullopt);
    Result<void> apply_angular_impulse(BodyHandle body, Vec3 impulse);
    /// A force for the next step only, N, at a world point or the centre of mass.
    Result<void> apply_force(BodyHandle body, Vec3 force, std::optional<Vec3> at_world_point = std::nullopt);
    Result<void> set_enabled(BodyHandle body, bool enabled);
    Result<void> wake(BodyHandle body);

    // Joints.
    Result<JointHandle> create_joint(const JointDefinition& definition);
    Result<void> destroy_joint(JointHandle joint);
    [[nodiscard]] std::vector<JointHandle> joints() const;
    [[nodiscard]] std::optional<JointDefinition> joint(JointHandle joint) const;
    Result<void> set_joint(JointHandle joint, const JointDefinition& definition);
    /// Force and torque that body_a exerts on body_b through the joint, mean over the last step, world axes, N and N m.
    struct JointReaction {
        Vec3 force, torque;
    };
    [[nodiscard]] JointReaction joint_reaction(JointHandle joint) const;
    /// Hinge angle (rad) or slider displacement (m); 0 for others.
    [[nodiscard]] double joint_coordinate(JointHandle joint) const;
    // Deformables: soft solids, cloth and ropes.
    Result<DeformableHandle> create_deformable(const DeformableDefinition& definition);
    Result<void> destroy_deformable(DeformableHandle deformable);
    [[nodiscard]] std::vector<DeformableHandle> deformables() const;
    /// Its definition, of a sheet as torn as it is; nullptr if stale.
    [[nodiscard]] const DeformableDefinition* deformable(DeformableHandle deformable) const;
    /// World positions (m) and velocities (m/s) of its nodes; empty if stale. Valid until the next step or change.
    [[nodiscard]] std::span<const Vec3> node_positions(DeformableHandle deformable) const;
    [[nodiscard]] std::span<const Vec3> node_velocities(DeformableHandle deformable) const;
    [[nodiscard]] std::span<const double> node_masses(DeformableHandle deformable) const;  ///< kg
    /// The pose of its frame by the rigid motion nearest to that of its nodes, weighted by mass.
    [[nodiscard]] Transform pose(DeformableHandle deformable) const;
    [[nodiscard]] double mass(DeformableHandle deformable) const;  ///< kg, pinned nodes too
    [[nodiscard]] Vec3 center_of_mass(DeformableHandle deformable) const;
    [[nodiscard]] bool is_asleep(DeformableHandle deformable) const;
    Result<void> wake(DeformableHandle deformable);
    /// Sets the positions and velocities of all its nodes, as many as it has, and wakes it. Pinned ones stay at rest.
    Result<void> set_nodes(DeformableHandle deformable, std::span<const Vec3> positions,
                           std::span<const Vec3> velocities);
    /// Its plastic strain, broken segments, folds and tears; empty if stale.
    [[nodiscard]] LastingDeformation lasting_deformation(DeformableHandle deformable) const;
    /// Sets these; the nodes stay where they are. Strains beyond `max_plastic_strain` are shortened to it. A sheet
    /// that has torn can only tear on. Wakes it.
    Result<void> set_lasting_deformation(DeformableHandle deformable, const LastingDeformation& lasting);
    /// Sets matter, pins, friction and the like for the same nodes and elements; the nodes keep their positions and
    /// velocities, whatever the definition says of pose and velocity. A torn sheet stays torn: the definition has the
    /// whole nodes and triangles, or the torn ones. Wakes it.
    Result<void> set_deformable(DeformableHandle deformable, const DeformableDefinition& definition);
    /// Sets only the attachments, ties and a rope's clamps: costs nothing. Between clamps that stay, a rope stays
    /// twisted.
    Result<void> set_attachments(DeformableHandle deformable, const std::vector<Attachment>& attachments,
                                 const std::vector<Clamp>& clamps = {}, const std::vector<Tie>& ties = {});
    /// For `node` of a sheet or rope: a tie to the point of the other's surface or line that is nearest to the place
    /// (m); nothing if stale or broken all over.
    [[nodiscard]] std::optional<Tie> nearest_tie(std::uint32_t node, DeformableHandle other, Vec3 place) const;
    /// Tension of each segment of a rope, from node k to k + 1, N; below zero: pressed; 0 where it is broken. Empty for
    /// other deformables. Valid until the next step or change.
    [[nodiscard]] std::span<const double> rope_tensions(DeformableHandle rope) const;
    /// Twist of each span between two of a rope's clamps, in the last step. Empty where there are none, and for other
    /// deformables. Valid until the next step or change.
    [[nodiscard]] std::span<const RopeTwist> rope_twists(DeformableHandle rope) const;
    /// Gas in a closed sheet now; std::nullopt without (Cloth::internal_pressure).
    [[nodiscard]] std::optional<GasInside> gas_inside(DeformableHandle sheet) const;
    /// Indices of broken segments, ascending.
    [[nodiscard]] std::vector<std::uint32_t> broken_segments(DeformableHandle rope) const;

    // Fluids.
    Result<FluidHandle> create_fluid(const FluidDefinition& definition);
    Result<void> destroy_fluid(FluidHandle fluid);
    [[nodiscard]] std::vector<FluidHandle> fluids() const;
    /// Its definition, or the one last set; nullptr if stale.
    [[nodiscard]] const FluidDefinition* fluid(FluidHandle fluid) const;
    /// Sets density, viscosity, yield stress, … of all its particles, whose places do not change; cell_size must not.
    Result<void> set_fluid(FluidHandle fluid, const FluidDefinition& definition);
    /// Adds particles of its particle_volume at these places (m), except those inside solids, at rest.
    /// Their ids are consecutive; an error where there is room for none. They are of the definition's matter.
    Result<FluidIds> add_to_fluid(FluidHandle fluid, std::span<const Vec3> places);
    /// Adds particles exactly there, also where solids are.
    Result<FluidIds> add_drops(FluidHandle fluid, std::span<const FluidDrop> drops);
    /// Gives the particles with these ids new ones, in their order and without gaps, and keeps so many more behind them
    /// free for sources. Returns all of these. They keep their liquids.
    Result<FluidIds> make_room(FluidHandle fluid, FluidIds ids, std::uint32_t room);
    /// The particles with these ids are of this liquid from now on. Where the liquids of a fluid are several, its
    /// definition tells the matter of the first. Wakes the fluid.
    Result<void> set_liquid(FluidHandle fluid, FluidIds ids, const LiquidMatter& matter);
    /// Calls `change` for each particle with one of these ids; those for which it returns false are removed. Wakes the
    /// fluid.
    Result<void> change_fluid(FluidHandle fluid, FluidIds ids, const FluidChange& change);
    /// Moves the particles with these ids into another fluid of equal particles and cell_size; without one, into a new
    /// fluid. They keep their liquids. Both wake. Returns their ids there, in the order of the old ids.
    Result<FluidPart> move_between_fluids(FluidHandle from, FluidIds ids, FluidHandle to = {});
    /// Its particles; empty if stale.
    [[nodiscard]] FluidParticles fluid_particles(FluidHandle fluid) const;
    /// Pressure at a world point, Pa above the air's; 0 outside the liquid.
    [[nodiscard]] double fluid_pressure(FluidHandle fluid, Vec3 point) const;
    /// Force of all fluids on a dynamic or kinematic body; on static ones it is not measured.
    [[nodiscard]] FluidForce fluid_force(BodyHandle body) const;
    Result<void> wake(FluidHandle fluid);
    // Sources and drains of liquid.
    Result<FluidPortHandle> create_fluid_port(const FluidPort& port);
    /// What went through it so far stays.
    Result<void> set_fluid_port(FluidPortHandle handle, const FluidPort& port);
    Result<void> destroy_fluid_port(FluidPortHandle handle);
    /// nullptr if stale.
    [[nodiscard]] const FluidPort* fluid_port(FluidPortHandle handle) const;
    /// Particles that came out of it, or went into it, so far; 0 if stale.
    [[nodiscard]] std::uint64_t passed_particles(FluidPortHandle handle) const;
    /// Whether a source gave less than its rate in the last step, as its fluid has as many particles as it allows.
    [[nodiscard]] bool is_waiting(FluidPortHandle handle) const;

    /// Advances by settings().time_step.
    const StepReport& step();
    [[nodiscard]] const StepReport& last_report() const;
    /// Sets the simulated time (s) and the number of steps: for a world that goes on from a recorded moment.
    void set_clock(double time, std::uint64_t step);
    /// Whether each report has the account of the energy and momenta of the rigid bodies by cause
    /// (docs/physics/energy.md). Changes no state; off, it costs nothing.
    void keep_account(bool is_wanted);
    // Events of the last step; valid until the next call that changes the world.
    [[nodiscard]] std::span<const ContactEvent> contact_events() const;
    [[nodiscard]] std::span<const SleepEvent> sleep_events() const;
    [[nodiscard]] std::span<const RopeBreakEvent> rope_break_events() const;
    [[nodiscard]] std::span<const BodyBreakEvent> body_break_events() const;
    [[nodiscard]] std::span<const SheetTearEvent> sheet_tear_events() const;
    [[nodiscard]] std::vector<ContactView> contacts() const;
    [[nodiscard]] Conserved conserved() const;
    /// Draws what the options select (debug_draw.h) in its present state; changes nothing.
    DebugDrawCount debug_draw(DebugDraw& draw, const DebugDrawOptions& options) const;

    // Queries.
    /// The nearest body the ray meets within `max_distance`; `direction` need not be unit. `ignore` may be null.
    [[nodiscard]] std::optional<RayHit> cast_ray(Vec3 origin, Vec3 direction, double max_distance,
                                                 BodyHandle ignore = {}) const;
    /// Bodies whose shapes overlap the box.
    [[nodiscard]] std::vector<BodyHandle> overlap_box(const Bounds& box) const;
    /// World bounds of a body's shape, and of a shape at a pose; empty where there is none.
    [[nodiscard]] Bounds bounds(BodyHandle body) const;
    [[nodiscard]] Bounds bounds(ShapeHandle shape, const Transform& pose) const;
    using IgnoresBody = std::function<bool(BodyHandle)>;
    /// The distance that the body can move down (-Y) until it touches another; std::nullopt if it meets none within
    /// `max_distance`. 0 where it overlaps one. It passes through the bodies that `ignores` (if given) names.
    [[nodiscard]] std::optional<double> drop_distance(BodyHandle body, double max_distance,
                                                      const IgnoresBody& ignores = {}) const;
    /// The same for a shape of this world, from a pose along a unit direction. It passes by what it does not approach.
    [[nodiscard]] std::optional<double> cast_shape(ShapeHandle shape, const Transform& pose, Vec3 direction,
                                                   double max_distance, const IgnoresBody& ignores = {}) const;
    /// Whether the shape overlaps a body there. False for planes, triangles and heightfields, which have no inside.
    [[nodiscard]] bool overlaps(ShapeHandle shape, const Transform& pose, const IgnoresBody& ignores = {}) const;
    /// Equal iff the states of all bodies are bit for bit equal.
    [[nodiscard]] std::uint64_t state_hash() const;

private:
    World();
    void replace_broken_bodies();
    void tear_sheets();
    std::unique_ptr<state::WorldState> state_;
};

}  // namespace embody::physics
