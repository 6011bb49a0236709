// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "physics/inter/world.h"
#include "scene/document/action.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

/// Decides when actions are due and carries them out on a simulation. The order is that of the actions' ids, and for
/// one action that of the events, so that a run is bitwise reproducible.
class ActionRunner {
public:
    /// Functions by which effects change the world; the simulation provides them.
    struct World {
        std::function<const std::vector<EntityIndex>&()> entities;
        std::function<const Entity*(EntityIndex)> definition;
        std::function<std::string(EntityIndex)> category;
        std::function<Vec3(EntityIndex)> center_of_mass;
        std::function<Result<void>(EntityIndex, const Effect&)> change;
        /// A copy of the document's entity `like` at the spawn's pose; its new index.
        std::function<Result<EntityIndex>(EntityIndex like, const Spawn&)> spawn;
        /// Entities of the document that the target names, whether or not they are in the world.
        std::function<std::vector<EntityIndex>(const Target&)> templates;
    };

    ActionRunner(std::vector<Action> actions, World world);

    /// Carries out actions that are due by the clock or by signals since the last call.
    void before_step(double time);
    /// Carries out actions that the step triggered. The events are copies of the world's: effects change it.
    void after_step(const std::vector<physics::ContactEvent>& contacts, const std::vector<physics::SleepEvent>& sleeps);
    std::size_t signal(const std::string& key, const std::string& button);
    /// Carries out the action at the next step, as `sender` does it; 0: an entity that its sender names, if it needs
    /// one.
    Result<void> request(std::uint32_t id, EntityIndex sender);
    void set_actions(std::vector<Action> actions);
    /// For a run that goes on at this time: what was due by the clock is done, and so are the actions of these ids.
    void resume(double time, const std::set<std::uint32_t>& done);

    std::vector<ActionFired> fired;  ///< since the last call that cleared the list
    std::vector<Error> problems;
    bool pause_requested = false;

private:
    struct Progress {
        bool has_fired = false;
        double next_time = 0;                 ///< of a timed action
        std::set<EntityIndex> known, inside;  ///< of a volume: entities seen before, and those inside
    };

    [[nodiscard]] bool matches(const Target& target, EntityIndex entity) const;
    void run(const Action& action, EntityIndex sender, EntityIndex other);
    void run_on(const Action& action, EntityIndex sender, EntityIndex receiver);
    void run_timed(const Action& action, const AtTime& at, double time);
    void run_contacts(const Action& action, const Target& other, physics::ContactEvent::Kind kind, double min_speed,
                      const std::vector<physics::ContactEvent>& contacts);
    void run_volume(const Action& action, const OnEnterVolume& enter);
    /// Whether nothing sets it off any more.
    [[nodiscard]] bool is_done(const Action& action) {
        return !action.enabled || (action.once && progress_[action.id].has_fired);
    }

    std::vector<Action> actions_;  ///< ascending id
    World world_;
    std::map<std::uint32_t, Progress> progress_;
    std::vector<std::pair<std::string, std::string>> signals_;
    std::vector<std::pair<std::uint32_t, EntityIndex>> requests_;
};

}  // namespace embody::scene
