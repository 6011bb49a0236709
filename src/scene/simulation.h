// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "physics/inter/world.h"
#include "scene/document.h"

namespace embody::scene {

/// An action that was carried out in the last step.
struct ActionFired {
    std::uint32_t id = 0;
    std::string name;
    EntityIndex sender = 0, receiver = 0;  ///< 0: none
};

/// A document brought to life: each entity a body, each joint a joint, the actions running.
class Simulation {
public:
    /// `catalog` may be null for documents without models. The error names the entity and field.
    static Result<std::unique_ptr<Simulation>> create(const Document& document, catalog::Catalog* catalog);
    ~Simulation();

    /// One time step: due actions, physics, triggers of what happened.
    const physics::StepReport& step();
    /// An action asked for a pause in the last step.
    [[nodiscard]] bool pause_requested() const;
    [[nodiscard]] const std::vector<ActionFired>& fired() const;
    /// A key or button (OnSignal); the number of actions it starts at the next step.
    std::size_t signal(const std::string& key, const std::string& button);

    [[nodiscard]] physics::World& world();
    [[nodiscard]] const physics::World& world() const;
    /// Entities that are in the world now, spawned ones too, ascending.
    [[nodiscard]] const std::vector<EntityIndex>& entities() const;
    /// Null for an entity that is not (any more) in the world.
    [[nodiscard]] physics::BodyHandle body(EntityIndex entity) const;
    [[nodiscard]] EntityIndex entity(physics::BodyHandle body) const;  ///< 0 if none
    /// The attributes as they act: model's, entity's manual ones, what actions set.
    [[nodiscard]] Result<attributes::AttributeSet> attributes(EntityIndex entity) const;

    /// Edits while running; the same checks as create().
    Result<void> add(const Entity& entity);
    Result<void> update(const Entity& entity, bool keep_motion);
    Result<void> remove(EntityIndex entity);

private:
    Simulation();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
