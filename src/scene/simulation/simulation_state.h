// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "attributes/physical_kind.h"
#include "scene/document/hold_index.h"
#include "scene/embody/entity_definitions.h"
#include "scene/matter/liquids.h"
#include "scene/matter/melting.h"
#include "scene/matter/moving_points.h"
#include "scene/simulation/action_runner.h"
#include "scene/simulation/shared_shapes.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

/// An entity in the world: one body, or points.
struct LiveEntity {
    Entity definition;
    SharedAttributes attributes;
    EntityForm form;
    std::unique_ptr<MovingPoints> points;  ///< null: it is a body
    physics::BodyHandle body;              ///< null: it has points
    physics::ShapeHandle shape;            ///< the body's
    GeometryKey shape_key;
    Transform frame;  ///< of points without a pose of their own: the pose that was set last
};

struct LiveJoint {
    SceneJoint definition;
    physics::JointHandle joint;
};

/// A tap or a drain in the world, and what went through it.
struct LivePort {
    physics::FluidPortHandle handle;  ///< null while it is shut or nothing can come
    std::uint64_t seen = 0;           ///< of the handle's particles
    std::uint64_t passed = 0;         ///< particles ever
};

/// Those of an entity.
struct LivePorts {
    LivePort tap, drain;
    Liquids::Part* fed = nullptr;  ///< by the tap in this step
};

/// A push by an action, until a given time.
struct TimedForce {
    EntityIndex entity = 0;
    Vec3 force;
    double until = 0;
};

/// A hand's ball in the world.
struct HandBall {
    physics::BodyHandle body;
    physics::ShapeHandle shape;
    double radius = 0;  ///< m
};

/// State of a simulation. Entities are made and changed in simulation_entities.cpp, their connections in
/// simulation_holds.cpp, hands in simulation_hands.cpp, taps and drains in simulation_ports.cpp, effects of actions in
/// simulation_effects.cpp, what melts and freezes in simulation_melting.cpp and simulation_freezing.cpp.
struct Simulation::State {
    State(std::unique_ptr<physics::World> made, const physics::WorldSettings& asked, catalog::Catalog* catalog,
          std::shared_ptr<FormCache> forms)
        : world(std::move(made)),
          settings(asked),
          definitions(catalog, std::move(forms)),
          shapes(*world),
          liquids(*world) {}

    std::unique_ptr<physics::World> world;
    physics::WorldSettings settings;  ///< the document's
    double finest_grain = 1e300;      ///< smallest ever in this world, m
    EntityDefinitions definitions;
    SharedShapes shapes;
    Liquids liquids;
    std::map<EntityIndex, Entity> templates;  ///< the document's entities, for actions that spawn
    GeometryKey solid_key;       ///< of solid_shape(), kept since a drag asks for the same one again and again
    physics::ShapeHandle solid;  ///< null: none yet
    std::map<EntityIndex, LiveEntity> live;
    std::vector<EntityIndex> indices;
    std::map<std::uint32_t, LiveJoint> joints;
    bool may_wait = false;                               ///< for models that are not in the catalogue
    std::map<EntityIndex, Entity> waiting;               ///< for their models
    std::map<std::uint32_t, SceneJoint> waiting_joints;  ///< of waiting entities
    HoldIndex holds;                                     ///< of pins and joints of all live entities
    std::set<EntityIndex> remarkable;                    ///< entities with a note, and liquids
    std::set<EntityIndex> liquid_entities;
    std::map<EntityIndex, LivePorts> ports;
    std::set<EntityIndex> to_be_held;  ///< entities that joints or pins need as one body, before these exist
    std::vector<TimedForce> timed_forces;
    std::vector<HandBall> hands;
    std::vector<EntityIndex> spawned, despawned;
    std::size_t spawned_by_actions = 0;  ///< of `spawned`; the others are pieces
    std::vector<ThingBroke> broke;
    std::vector<ThingMelted> melted;
    EntityIndex next_spawned = last_document_index + 1;
    std::unique_ptr<ActionRunner> actions;

    // Entities --------------------------------------------------------------------------------------------------------

    /// Null for an entity that is not in the world.
    [[nodiscard]] LiveEntity* find(EntityIndex index);
    [[nodiscard]] const LiveEntity* find(EntityIndex index) const;
    Result<void> add(const Entity& entity);
    Result<void> update(const Entity& entity, bool keep_motion);
    /// All of them must be in the world.
    void remove_all(const std::vector<EntityIndex>& gone);
    Result<void> place(LiveEntity& entity, const Transform& pose);
    Result<void> set_velocity(LiveEntity& entity, Vec3 linear, Vec3 angular);
    [[nodiscard]] Transform pose_of(const LiveEntity& entity) const;
    /// Piles of small grains need shorter substeps than the document's.
    Result<void> apply_settings();

    // Entities whose models are missing -------------------------------------------------------------------------------

    /// Whether the entity's model is not in the catalogue, and it may wait for it.
    [[nodiscard]] bool must_wait(const Entity& entity);
    /// Names the models that the document needs and the catalogue has not.
    Result<void> check_models(const Document& document);
    /// Adds the entity with its pins and those to it, or none of that.
    Result<void> add_whole(const Entity& entity);
    /// Adds the entity or lets it wait.
    Result<void> add_or_wait(const Entity& entity);
    /// The entity has changed: it is in the world or waits, and does either afterwards.
    Result<void> update_or_wait(const Entity& entity, bool keep_motion);
    [[nodiscard]] bool is_waiting_end(const SceneJoint& joint) const;
    Arrivals take_arrivals();

    // Connections between entities ------------------------------------------------------------------------------------

    /// Whether a joint holds the entity, or a thing is pinned to it that cannot be tied to a thing of its kind.
    [[nodiscard]] bool is_held_as_body(EntityIndex index, attributes::PhysicalKind kind) const;
    /// Before entities are made: finds those that joints and pins of the document need as one body.
    void find_bodies(const Document& document);
    /// Null where the body is no hand's.
    [[nodiscard]] const HandBall* hand(physics::BodyHandle body) const;
    /// World::cast_ray() past hands.
    [[nodiscard]] std::optional<physics::RayHit> cast_ray(Vec3 origin, Vec3 direction, double max_distance,
                                                          physics::BodyHandle ignore) const;
    /// Connects its pins to the present places on other entities.
    Result<void> fasten(const LiveEntity& entity);
    /// Updates ties to an entity that has changed, whose pins were `before`. `is_new`: it was made again.
    Result<void> fasten_to(const LiveEntity& entity, const std::vector<Pin>& before, bool is_new);
    /// Connects an entity that was added, and those whose pins waited for it; without one: all.
    Result<void> fasten_all(std::optional<EntityIndex> came);
    Result<void> add_joint(const SceneJoint& joint);
    Result<void> remove_joint(std::uint32_t index);

    // Taps and drains -------------------------------------------------------------------------------------------------

    /// Call when an entity has come or changed, and when it goes.
    void list_ports(const LiveEntity& entity);
    void unlist_ports(EntityIndex index);
    /// Before a step; and after it.
    void set_ports();
    void count_ports();
    /// Why nothing goes through a tap or drain, whether or not it is open.
    [[nodiscard]] std::optional<Error> port_fault(const LiveEntity& entity) const;

    // Effects of actions ----------------------------------------------------------------------------------------------

    void start_actions(const std::vector<Action>& list);
    /// A push lasts at least one step.
    void apply_timed_forces();
    /// The pieces of what broke in the step become entities in its place (simulation_breaks.cpp).
    void take_pieces();
    /// Null for an entity that is not in the world.
    [[nodiscard]] const Entity* definition(EntityIndex index) const;

private:
    Result<void> arrive(const Entity& before, const Entity& entity);
    void leave(const Entity& entity);
    /// Adds the joints whose ends wait no more; the errors of those that the world refuses.
    std::vector<Error> add_joints_that_waited();

    [[nodiscard]] const LiveEntity* liquid_of(const Tap& tap) const;
    [[nodiscard]] std::optional<physics::FluidSource> open_source(const LiveEntity& entity);
    void put_port(LivePort& port, const std::optional<physics::FluidPort>& wanted);

    Result<LiveEntity> describe(const Entity& entity);
    Result<physics::BodyDefinition> prepare_body(LiveEntity& entity);
    Result<void> put(LiveEntity& entity);
    Result<void> put_body(LiveEntity& entity);
    Result<void> put_points(LiveEntity& entity);
    void take_out(LiveEntity& entity);
    void list_remarkable(const LiveEntity& entity);
    [[nodiscard]] std::pair<Vec3, Vec3> motion_of(const LiveEntity& entity) const;
    Result<void> update_body(LiveEntity& before, LiveEntity& after, bool keep_motion);
    Result<void> update_points(LiveEntity& before, LiveEntity& after);
    Result<void> replace(LiveEntity& before, LiveEntity& after, bool keep_motion);

    void tie_pins(const LiveEntity& entity, std::vector<bool>& is_held, std::vector<physics::Tie>& ties) const;
    Result<physics::BodyHandle> end_of(EntityIndex index, const std::string& where);
    Result<void> make_bodies_of(const SceneJoint& joint);
    Result<void> soften_ends(const SceneJoint& joint);

    Result<void> change(EntityIndex index, const Effect& effect);
    Result<void> set_attribute(LiveEntity& entity, const SetAttribute& set);
    Result<void> check_meltable(const LiveEntity& thing) const;
    Result<Melting> melting(const LiveEntity& thing);
    Result<void> melt_into(const Melting& melting, EntityIndex into);
    Result<EntityIndex> melt_alone(const LiveEntity& thing, const Melting& melting);
    Result<void> melt(const LiveEntity& thing, const Melt& melt);
    Result<void> freeze(const LiveEntity& liquid);
    Result<void> add_pieces(const physics::BodyBreakEvent& event);
    [[nodiscard]] Result<EntityIndex> new_index() const;
    Result<EntityIndex> spawn(EntityIndex like, const Spawn& spawn);
    [[nodiscard]] std::string category(EntityIndex index) const;
    [[nodiscard]] Vec3 center_of_mass(const LiveEntity& entity) const;
    [[nodiscard]] std::vector<EntityIndex> meant(const Target& target) const;
};

/// Whether tap and drain of the entity make sense; the error's `where` is the field.
Result<void> check_ports(const Entity& entity);

/// The error with the entity's name before its field.
Error of_entity(const Entity& entity, Error error);

}  // namespace embody::scene
