// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "physics/inter/world.h"
#include "scene/document/document.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

struct FormCache;
struct EntityMoment;
struct EntityMotion;
struct Moment;

/// An action that was carried out in the last step.
struct ActionFired {
    std::uint32_t id = 0;
    std::string name;
    EntityIndex sender = 0, receiver = 0;  ///< 0: none
};

/// A thing that broke in the last step: it is not in the world any more, its pieces are spawned.
struct ThingBroke {
    EntityIndex entity = 0;
    std::string name;
    Vec3 position;                   ///< of the blow, m
    double impulse = 0, energy = 0;  ///< of the blow, N s and J
    std::size_t pieces = 0;
};

/// A thing that melted in the last step: it is not in the world any more.
struct ThingMelted {
    EntityIndex entity = 0, liquid = 0;
};

/// Number of entities by state, of all that can move and are enabled: an entity counts once, whether it is one body, a
/// pile of grains, a liquid, or a deformable.
struct Activity {
    std::size_t things = 0, active = 0, wants_to_sleep = 0, asleep = 0;
    std::size_t points = 0;  ///< grains, particles and nodes of the entities that are no single body
};

/// What becomes of entities whose model is not in the catalogue: an error, or they wait outside of the world.
enum class MissingModels : std::uint8_t { refuse, wait };

/// Entities whose models have come.
struct Arrivals {
    std::vector<EntityIndex> came;
    std::vector<Error> refused;  ///< what could not be put into the world, and why; it waits no more
};

/// Why nothing goes through an entity's tap or drain; the error's `where` is the field.
struct PortFault {
    EntityIndex entity = 0;
    Error error;
};

/// A running document: each entity a body or points, each joint a joint, the actions active.
class Simulation {
public:
    /// `catalog` may be null for documents without models. `forms` holds meshes of earlier simulations, and gets those
    /// of this one. The error names the entity and field, and all models that are missing.
    static Result<std::unique_ptr<Simulation>> create(const Document& document, catalog::Catalog* catalog,
                                                      std::shared_ptr<FormCache> forms = nullptr,
                                                      MissingModels missing = MissingModels::refuse);
    ~Simulation();

    /// One time step: actions that are due, physics, then actions that its events trigger.
    const physics::StepReport& step();
    /// Entities that actions added to the world and removed from it in the last step; pieces, and what broke into them.
    [[nodiscard]] const std::vector<EntityIndex>& spawned() const;
    [[nodiscard]] const std::vector<EntityIndex>& despawned() const;
    /// Effects of the last step that could not be carried out, and why.
    [[nodiscard]] const std::vector<Error>& problems() const;
    /// Whether an action requested a pause in the last step.
    [[nodiscard]] bool pause_requested() const;
    [[nodiscard]] const std::vector<ActionFired>& fired() const;
    /// Ropes that broke in the last step; their user_data is the entity.
    [[nodiscard]] std::span<const physics::RopeBreakEvent> rope_breaks() const;
    [[nodiscard]] std::span<const physics::SheetTearEvent> sheet_tears() const;
    [[nodiscard]] const std::vector<ThingBroke>& broke() const;
    [[nodiscard]] const std::vector<ThingMelted>& melted() const;
    /// A key or button (OnSignal); returns the number of actions it starts at the next step.
    std::size_t signal(const std::string& key, const std::string& button);
    /// Carries out an action at the next step, whatever sets it off, as `sender` does it; 0: an entity that the
    /// action's own sender names. An error where that is not known but needed.
    Result<void> run_action(std::uint32_t action, EntityIndex sender);

    [[nodiscard]] physics::World& world();
    [[nodiscard]] const physics::World& world() const;
    /// Entities that are in the world now, spawned ones too, ascending.
    [[nodiscard]] const std::vector<EntityIndex>& entities() const;
    [[nodiscard]] bool contains(EntityIndex entity) const;
    /// Null for an entity that is not (any more) in the world, and for one with points.
    [[nodiscard]] physics::BodyHandle body(EntityIndex entity) const;
    /// A body for one more hand to pull it at, at or near a place in the world: its own, that of one of its points, or
    /// one that holds some of these until let_go(). An error where no hand can hold it.
    [[nodiscard]] Result<physics::BodyHandle> hold(EntityIndex entity, Vec3 position);
    /// Ends one hold(); nothing where the body is gone.
    void let_go(EntityIndex entity, physics::BodyHandle held);
    /// A ball with the weightless mass of a forearm that pushes things; it is no entity, and no ray meets it. Radius in
    /// m.
    Result<physics::BodyHandle> add_hand(Vec3 position, double radius);
    void remove_hand(physics::BodyHandle hand);
    /// Whether a ball at the place would touch the entity; of points that are no bodies, whether it is near one.
    [[nodiscard]] bool is_touched(EntityIndex entity, Vec3 place, double radius) const;
    /// Entities that are not simulated as their kind, and why: "Towel is simulated as rigid, because …".
    [[nodiscard]] std::vector<std::string> notes() const;
    [[nodiscard]] std::vector<PortFault> port_faults() const;
    /// Taps that gave less than their flow in the last step: their liquid has as many drops as its budget allows.
    [[nodiscard]] std::vector<EntityIndex> waiting_taps() const;
    /// Drops that came from the entity's tap, and that went into its drain, since the start.
    struct PassedDrops {
        std::uint64_t poured = 0, drained = 0;
    };
    [[nodiscard]] PassedDrops passed_drops(EntityIndex entity) const;
    /// The points of an entity that is not one body. Null for others; valid until an edit.
    [[nodiscard]] const MovingPoints* points(EntityIndex entity) const;
    /// Pose of the entity's frame: its body's, or for points the pose that was set last.
    [[nodiscard]] Transform pose(EntityIndex entity) const;
    /// World bounds of the collision shape; empty where there is none.
    [[nodiscard]] Bounds bounds(EntityIndex entity) const;
    /// How far it can move down until it touches another entity, m; empty if it touches none within `max_distance`.
    [[nodiscard]] std::optional<double> drop_distance(EntityIndex entity, double max_distance) const;
    /// The first hit of a ray (unit direction) within `max_distance`, m.
    struct RayHit {
        EntityIndex entity = 0;
        Vec3 position, normal;
        double distance = 0;
    };
    [[nodiscard]] std::optional<RayHit> cast_ray(Vec3 origin, Vec3 direction, double max_distance,
                                                 EntityIndex ignore = 0) const;
    /// The shape of an entity, in the world or not, as one solid: to look where there is room for it. Valid until the
    /// next call or edit.
    Result<physics::ShapeHandle> solid_shape(const Entity& entity);
    [[nodiscard]] bool is_movable(EntityIndex entity) const;
    /// For points the state of the most awake one.
    [[nodiscard]] physics::SleepState sleep_state(EntityIndex entity) const;
    [[nodiscard]] Activity activity() const;
    [[nodiscard]] EntityIndex entity(physics::BodyHandle body) const;  ///< 0 if none
    /// The entity as it is now, without pose and velocities; null for one that is not in the world.
    [[nodiscard]] const Entity* definition(EntityIndex entity) const;
    /// Null for a joint that is not in the world.
    [[nodiscard]] physics::JointHandle joint(std::uint32_t joint) const;
    /// Whether a joint is in the world, or waits with an entity at its end.
    [[nodiscard]] bool contains_joint(std::uint32_t joint) const;
    /// Entities that wait for their models, ascending; contains() is false for them.
    [[nodiscard]] std::vector<EntityIndex> waiting() const;
    [[nodiscard]] bool is_waiting(EntityIndex entity) const;
    /// Puts waiting entities whose models are there now into the world, with their joints and pins.
    Arrivals take_arrivals();
    /// The attributes in effect: the model's, the entity's manual ones, values that actions set.
    [[nodiscard]] Result<attributes::AttributeSet> attributes(EntityIndex entity) const;

    /// Edits while running; with the same checks as create().
    Result<void> add(const Entity& entity);
    /// With `keep_motion` pose and velocities stay unchanged, else they become the entity's.
    Result<void> update(const Entity& entity, bool keep_motion);
    /// Call when the catalogue's models of these keys have new attributes: their entities get these at once. All are
    /// tried; the error is the first.
    Result<void> renew_models(const std::set<std::string>& keys, bool keep_motion);
    Result<void> remove(EntityIndex entity);  ///< its joints go with it
    /// Removes many at once; entities that are not (any more) in the world are no error.
    void remove_all(const std::vector<EntityIndex>& entities);
    /// Sets the pose of its frame; points move along and are at rest then.
    Result<void> set_pose(EntityIndex entity, const Transform& pose);
    Result<void> set_velocity(EntityIndex entity, Vec3 linear, Vec3 angular);
    /// With small grains the substeps are shorter than in these settings.
    Result<void> set_settings(const physics::WorldSettings& settings);
    Result<void> add_joint(const SceneJoint& joint);
    Result<void> remove_joint(std::uint32_t joint);
    /// Actions that exist already keep their state; new ones start.
    void set_actions(const std::vector<Action>& actions);

    /// The form of an entity's points as they are now, with which a document can begin: null where it is one body, is
    /// disabled, or is as modelled. The one that it began with where it still has that.
    [[nodiscard]] SharedOptional<KeptForm> kept_form(EntityIndex entity) const;
    /// The same as the points were at a moment of a take, with the segments that were broken then; without plastic
    /// strain, which a take has not.
    [[nodiscard]] SharedOptional<KeptForm> kept_form(const EntityMoment& was, std::vector<std::uint32_t> broken) const;
    /// Calls with every entity that is in the world, ascending.
    void visit(const std::function<void(const EntityMotion&)>& look) const;
    /// What actions had done in a run until a moment of it.
    struct ActionsDone {
        std::map<EntityIndex, Entity> spawned;
        std::set<EntityIndex> removed;
        std::set<std::uint32_t> fired;  ///< ids of actions
        std::map<EntityIndex, std::vector<physics::TornCorner>> torn;
    };
    /// Puts a world that has just been made as it was at a recorded moment, with what actions had added and without
    /// what they had removed by then. What cannot be restored: docs/time.md. The place for World::restore() once there
    /// is one.
    Result<void> restore_moment(const Moment& moment, const ActionsDone& actions);

private:
    Simulation();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
