// SPDX-License-Identifier: MIT
// The paper's definition 6: an action triggers a change of entities or of their attributes.
#include "scene/simulation/action_runner.h"

#include <algorithm>
#include <cmath>

namespace embody::scene {

using physics::ContactEvent;
using physics::SleepEvent;

namespace {

constexpr double clock_error = 5e-10;  // s, half a nanosecond: the clock is a sum of steps
constexpr double min_period = 1e-5;    // s

}  // namespace

ActionRunner::ActionRunner(std::vector<Action> actions, World world) : world_(std::move(world)) {
    set_actions(std::move(actions));
}

void ActionRunner::set_actions(std::vector<Action> actions) {
    std::sort(actions.begin(), actions.end(), [](const Action& a, const Action& b) { return a.id < b.id; });
    actions_ = std::move(actions);
    std::map<std::uint32_t, Progress> progress;
    for (const Action& action : actions_) {
        const auto before = progress_.find(action.id);
        if (before != progress_.end()) {
            progress[action.id] = before->second;
            continue;
        }
        Progress fresh;
        if (const auto* at = std::get_if<AtTime>(&action.trigger)) fresh.next_time = at->time;
        progress[action.id] = fresh;
    }
    progress_ = std::move(progress);
}

bool ActionRunner::matches(const Target& target, EntityIndex entity) const {
    switch (target.by) {
        case Target::By::any:
            return true;
        case Target::By::index:
            return target.index == entity;
        case Target::By::name: {
            const Entity* definition = world_.definition(entity);
            return definition && definition->name == target.word;
        }
        case Target::By::category:
            return world_.category(entity) == target.word;
    }
    return false;
}

// Entities that the effect changes: "any" means the sender, or everything where there is none.
void ActionRunner::run(const Action& action, EntityIndex sender, EntityIndex other) {
    progress_[action.id].has_fired = true;
    if (std::holds_alternative<Pause>(action.effect)) {
        pause_requested = true;
        fired.push_back({action.id, action.name, sender, other});
        return;
    }
    const bool by_sender = action.receiver.by == Target::By::any && sender != 0;
    if (std::holds_alternative<Spawn>(action.effect)) {
        const std::vector<EntityIndex> like =
            by_sender ? std::vector<EntityIndex>{sender} : world_.templates(action.receiver);
        // One copy each time the action fires, also where a name or category means several entities.
        if (!like.empty()) return run_on(action, sender, like.front());
        problems.push_back(
            {"action \"" + action.name + "\"", "there is nothing to spawn: the receiver names no entity"});
        return;
    }
    if (by_sender) return run_on(action, sender, sender);

    // The list changes while effects run.
    const std::vector<EntityIndex> entities = world_.entities();
    for (const EntityIndex entity : entities)
        if (matches(action.receiver, entity)) run_on(action, sender, entity);
}

void ActionRunner::run_on(const Action& action, EntityIndex sender, EntityIndex receiver) {
    std::optional<Error> error;
    if (const auto* spawn = std::get_if<Spawn>(&action.effect)) {
        const Result<EntityIndex> born = world_.spawn(receiver, *spawn);
        if (!born.ok()) error = born.error();
    } else {
        const Result<void> changed = world_.change(receiver, action.effect);
        if (!changed.ok()) error = changed.error();
    }
    if (error) {
        problems.push_back({"action \"" + action.name + "\"", error->message(), {}});
    } else {
        fired.push_back({action.id, action.name, sender, receiver});
    }
}

void ActionRunner::run_timed(const Action& action, const AtTime& at, double time) {
    Progress& progress = progress_[action.id];
    if (progress.next_time > time + clock_error || (!at.repeat_every && progress.has_fired)) return;
    run(action, 0, 0);
    // At most once a step, however short the period and however long the action has been due.
    if (!at.repeat_every) return;
    const double period = std::max(*at.repeat_every, min_period);
    const double missed = std::floor((time + clock_error - progress.next_time) / period);
    progress.next_time += (missed + 1) * period;
}

void ActionRunner::resume(double time, const std::set<std::uint32_t>& done) {
    for (const Action& action : actions_) {
        Progress& progress = progress_[action.id];
        progress.has_fired = done.contains(action.id);
        const auto* at = std::get_if<AtTime>(&action.trigger);
        // What is due at this very time is not done yet: the step from here does it.
        if (!at || progress.next_time >= time - clock_error) continue;
        progress.has_fired = true;
        if (!at->repeat_every) continue;
        const double period = std::max(*at->repeat_every, min_period);
        progress.next_time += std::ceil((time - clock_error - progress.next_time) / period) * period;
    }
}

Result<void> ActionRunner::request(std::uint32_t id, EntityIndex sender) {
    const auto action = std::ranges::find(actions_, id, &Action::id);
    if (action == actions_.end()) return Error{"index", "there is no action " + std::to_string(id)};
    const std::vector<EntityIndex>& entities = world_.entities();
    if (sender != 0 && std::ranges::find(entities, sender) == entities.end())
        return Error{"sender", "there is no entity " + std::to_string(sender) + " in the world"};
    const bool by_nobody =
        std::holds_alternative<AtTime>(action->trigger) || std::holds_alternative<OnSignal>(action->trigger);
    if (sender == 0 && !by_nobody && action->receiver.by == Target::By::any) {
        const auto found =
            std::ranges::find_if(entities, [&](EntityIndex entity) { return matches(action->sender, entity); });
        if (action->sender.by == Target::By::any || found == entities.end())
            return Error{"sender", "the action changes who sets it off, and nobody does now", "name an entity"};
        sender = *found;
    }
    requests_.emplace_back(id, sender);
    return {};
}

void ActionRunner::before_step(double time) {
    for (const auto& [id, sender] : std::exchange(requests_, {})) {
        const auto action = std::ranges::find(actions_, id, &Action::id);
        if (action != actions_.end()) run(*action, sender, 0);
    }
    const auto signals = std::exchange(signals_, {});
    for (const Action& action : actions_) {
        if (const auto* at = std::get_if<AtTime>(&action.trigger)) {
            if (!is_done(action)) run_timed(action, *at, time);
        }
        const auto* awaited = std::get_if<OnSignal>(&action.trigger);
        if (!awaited) continue;
        for (const auto& [key, button] : signals) {
            if (is_done(action)) break;
            const bool is_key = !key.empty() && key == awaited->key;
            const bool is_button = !button.empty() && button == awaited->button;
            if (is_key || is_button) run(action, 0, 0);
        }
    }
}

std::size_t ActionRunner::signal(const std::string& key, const std::string& button) {
    std::size_t started = 0;
    for (const Action& action : actions_) {
        const auto* awaited = std::get_if<OnSignal>(&action.trigger);
        if (!awaited || is_done(action)) continue;
        if ((!key.empty() && key == awaited->key) || (!button.empty() && button == awaited->button)) ++started;
    }
    if (started > 0) signals_.emplace_back(key, button);
    return started;
}

void ActionRunner::run_contacts(const Action& action, const Target& other, ContactEvent::Kind kind, double min_speed,
                                const std::vector<ContactEvent>& contacts) {
    for (const ContactEvent& contact : contacts) {
        if (is_done(action)) return;
        if (contact.kind != kind || contact.approach_speed < min_speed) continue;
        const auto a = static_cast<EntityIndex>(contact.user_data_a);
        const auto b = static_cast<EntityIndex>(contact.user_data_b);
        if (matches(action.sender, a) && matches(other, b)) {
            run(action, a, b);
        } else if (matches(action.sender, b) && matches(other, a)) {
            run(action, b, a);
        }
    }
}

// An entity enters only after it was seen outside: an entity that starts inside has not entered.
void ActionRunner::run_volume(const Action& action, const OnEnterVolume& enter) {
    const std::vector<EntityIndex> entities = world_.entities();
    for (const EntityIndex entity : entities) {
        if (!matches(action.sender, entity)) continue;
        Progress& progress = progress_[action.id];
        const bool is_inside = contains(enter.volume, world_.center_of_mass(entity));
        const bool is_new = progress.known.insert(entity).second;
        const bool was_inside = progress.inside.contains(entity);
        if (is_inside) progress.inside.insert(entity);
        if (!is_inside) progress.inside.erase(entity);
        if (is_inside && !was_inside && !is_new && !is_done(action)) run(action, entity, 0);
    }
}

void ActionRunner::after_step(const std::vector<ContactEvent>& contacts, const std::vector<SleepEvent>& sleeps) {
    for (const Action& action : actions_) {
        if (is_done(action)) continue;
        if (const auto* begin = std::get_if<OnContactBegin>(&action.trigger))
            run_contacts(action, begin->other, ContactEvent::Kind::begin, begin->least_approach_speed, contacts);
        if (const auto* end = std::get_if<OnContactEnd>(&action.trigger))
            run_contacts(action, end->other, ContactEvent::Kind::end, 0, contacts);
        if (const auto* enter = std::get_if<OnEnterVolume>(&action.trigger)) run_volume(action, *enter);
        if (!std::holds_alternative<OnFallAsleep>(action.trigger)) continue;
        for (const SleepEvent& sleep : sleeps) {
            const auto entity = static_cast<EntityIndex>(sleep.user_data);
            if (sleep.kind == SleepEvent::Kind::fell_asleep && !is_done(action) && matches(action.sender, entity))
                run(action, entity, 0);
        }
    }
}

}  // namespace embody::scene
