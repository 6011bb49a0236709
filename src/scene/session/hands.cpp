// SPDX-License-Identifier: MIT
#include "scene/session/hands.h"

#include <algorithm>
#include <utility>

namespace embody::scene {

using physics::BodyHandle;

namespace {

constexpr std::size_t max_hands = 16;  // of one client: two, their fingers, and a pointer
/// A ball that is so far from its hand is put there: it hangs behind something, or the hand was put elsewhere, m.
constexpr double max_lag = 1;
/// The ball's spring: ω, rad/s, and how fast it comes back to its hand, m/s. Its 1.65 kg then push with 100 N where the
/// hand is 3 cm within a thing, and with all its strength from 11 cm on (60 steps a second).
constexpr double touch_frequency = 200, touch_speed = 20;
constexpr double touch_strength = 400;  // N, as a hand that holds something
/// A weaker touch is not told, N s: that of 1 g at 1 m/s is hardly felt.
constexpr double felt_impulse = 1e-3;

double now(const Simulation& simulation) { return simulation.world().last_report().time; }

}  // namespace

Hands::Hand* Hands::find(const HandName& hand) {
    const auto found = hands_.find(hand);
    return found == hands_.end() ? nullptr : &found->second;
}

Result<Hands::Hand*> Hands::take(const HandName& hand) {
    if (Hand* found = find(hand)) return found;
    const auto first = hands_.lower_bound({hand.client, ""}), end = hands_.lower_bound({hand.client + 1, ""});
    if (static_cast<std::size_t>(std::distance(first, end)) >= max_hands)
        return Error{"hand", "is one too many: a client has at most " + std::to_string(max_hands) + " hands",
                     "release one, or use a name again"};
    return &hands_[hand];
}

void Hands::remove_if_idle(const HandName& hand) {
    const Hand* found = find(hand);
    if (found && !found->held && !found->touching) hands_.erase(hand);
}

Result<void> Hands::grab(Simulation& simulation, const HandName& hand, EntityIndex entity, Vec3 point,
                         double strength) {
    const Result<Hand*> taken = take(hand);
    if (!taken.ok()) return taken.error();
    let_go(simulation, *taken.value());
    const Result<BodyHandle> body = simulation.hold(entity, point);
    if (!body.ok()) {
        remove_if_idle(hand);
        return body.error();
    }
    Held held;
    held.entity = entity;
    held.grab.body = body.value();
    held.grab.local_point = inverse_transform_point(simulation.world().pose(body.value()), point);
    held.grab.strength = strength;
    held.path.report(now(simulation), point, {});
    taken.value()->held = std::move(held);
    return {};
}

Result<void> Hands::move(Simulation& simulation, const HandName& hand, const HandPlace& place) {
    Hand* found = find(hand);
    if (!found || !found->held || !simulation.world().contains(found->held->grab.body))
        return Error{"hand", "\"" + hand.name + "\" holds nothing: nothing is held, or it was removed",
                     "simulation.grab first"};
    Held& held = *found->held;
    if (place.rotation) {
        if (!held.hand_rotation) {
            held.offset = conjugate(*place.rotation) * simulation.world().pose(held.grab.body).rotation;
            held.path = {};  // how it turned until now is not known
        }
        held.hand_rotation = place.rotation;
    }
    held.path.report(now(simulation), place.position, held.hand_rotation.value_or(Quat{}));
    return {};
}

void Hands::let_go(Simulation& simulation, Hand& hand) {
    if (!hand.held) return;
    simulation.let_go(hand.held->entity, hand.held->grab.body);
    hand.left = hand.held->entity;
    hand.held.reset();
    hand.strike.reset();
}

void Hands::release(Simulation& simulation, const HandName& hand) {
    Hand* found = find(hand);
    if (!found) return;
    let_go(simulation, *found);
    remove_if_idle(hand);
}

Result<void> Hands::touch(Simulation& simulation, const HandName& hand, const Ball& ball) {
    const Result<Hand*> taken = take(hand);
    if (!taken.ok()) return taken.error();
    std::optional<Touching>& touching = taken.value()->touching;
    if (!touching) touching.emplace();
    // A ball of another size is made anew.
    if (touching->radius != ball.radius) simulation.remove_hand(std::exchange(touching->body, {}));
    touching->radius = ball.radius;
    touching->path.report(now(simulation), ball.place.position, ball.place.rotation.value_or(Quat{}));
    return {};
}

void Hands::stop_touching(Simulation& simulation, const HandName& hand) {
    Hand* found = find(hand);
    if (!found || !found->touching) return;
    simulation.remove_hand(found->touching->body);
    found->touching.reset();
    remove_if_idle(hand);
}

void Hands::forget(Simulation& simulation, std::uint64_t client) {
    for (auto at = hands_.lower_bound({client, ""}); at != hands_.end() && at->first.client == client;) {
        let_go(simulation, at->second);
        if (at->second.touching) simulation.remove_hand(at->second.touching->body);
        at = hands_.erase(at);
    }
}

void Hands::rest() {
    for (auto& [name, hand] : hands_) {
        if (hand.held) hand.held->path.rest();
        if (hand.touching) hand.touching->path.rest();
    }
}

// What was removed, or became another kind, is held by nobody.
void Hands::forget_gone(Simulation& simulation) {
    for (auto& [name, hand] : hands_)
        if (hand.held && !simulation.world().contains(hand.held->grab.body)) let_go(simulation, hand);
    std::erase_if(hands_, [](const auto& entry) { return !entry.second.held && !entry.second.touching; });
}

int Hands::hands_at(BodyHandle body) const {
    return static_cast<int>(std::ranges::count_if(
        hands_, [body](const auto& entry) { return entry.second.held && entry.second.held->grab.body == body; }));
}

void Hands::before_step(Simulation& simulation) {
    if (hands_.empty()) return;
    forget_gone(simulation);
    for (auto& [name, hand] : hands_) {
        if (hand.touching) steer(simulation, hand);
        if (!hand.held) continue;
        Held& held = *hand.held;
        const HandPath::Motion motion = held.path.at(now(simulation));
        held.grab.target = motion.position;
        if (held.hand_rotation) held.grab.rotation = normalized(motion.rotation * held.offset);
        held.grab.velocity = motion.velocity;
        held.grab.spin = motion.spin;
        pull(simulation.world(), held.grab, hands_at(held.grab.body));
    }
}

// The ball is pulled by the hand's spring as what a hand holds is: it gives way where strength is not enough, whatever
// it meets. A kinematic ball would be infinitely strong, and its impulses on cloth and liquids are not known in time.
void Hands::steer(Simulation& simulation, Hand& hand) {
    Touching& touching = *hand.touching;
    physics::World& world = simulation.world();
    HandPath::Motion motion = touching.path.at(now(simulation));
    const Vec3 target = motion.position;
    if (hand.left != 0 && !hand.held && !simulation.is_touched(hand.left, target, touching.radius)) hand.left = 0;
    if (hand.held || hand.left != 0) {
        simulation.remove_hand(std::exchange(touching.body, {}));
        return;
    }
    if (!world.contains(touching.body)) {
        const Result<BodyHandle> ball = simulation.add_hand(target, touching.radius);
        if (!ball.ok()) return;
        touching.body = ball.value();
    } else if (length(world.pose(touching.body).position - target) > max_lag) {
        // The numbers are finite and the body is there: the world does not refuse.
        (void)world.set_pose(touching.body, {target, motion.rotation}).ok();
        (void)world.set_velocity(touching.body, {}, {}).ok();
        touching.path.rest();
        motion.velocity = motion.spin = {};
    }
    pull(world,
         {.body = touching.body,
          .local_point = {},
          .target = target,
          .rotation = motion.rotation,
          .velocity = motion.velocity,
          .spin = motion.spin,
          .strength = touch_strength,
          .closing_speed = touch_speed,
          .frequency = touch_frequency},
         1);
}

std::vector<Strike> Hands::after_step(const Simulation& simulation) {
    std::vector<Strike> told;
    if (hands_.empty()) return told;
    const auto body_of = [](const Hand& hand) {
        return hand.held ? hand.held->grab.body : hand.touching ? hand.touching->body : BodyHandle{};
    };
    std::vector<BodyHandle> bodies;
    for (const auto& [name, hand] : hands_) bodies.push_back(body_of(hand));
    const auto is_hand = [&](BodyHandle body) { return std::ranges::find(bodies, body) != bodies.end(); };
    const std::vector<Impact> impacts = new_impacts(
        simulation, [&](const physics::ContactEvent& event) { return is_hand(event.a) || is_hand(event.b); });
    for (auto& [name, hand] : hands_) {
        const BodyHandle body = body_of(hand);
        for (const Impact& impact : impacts) {
            if ((impact.a != body && impact.b != body) || impact.impulse < felt_impulse) continue;
            if (hand.strike && hand.strike->impulse >= impact.impulse) continue;
            const EntityIndex other = simulation.entity(impact.a == body ? impact.b : impact.a);
            hand.strike = Strike{name, hand.held ? hand.held->entity : 0, other, impact.position, impact.impulse};
        }
        if (!hand.strike || !hand.pace.is_due(now(simulation))) continue;
        told.push_back(*hand.strike);
        hand.strike.reset();
    }
    return told;
}

}  // namespace embody::scene
