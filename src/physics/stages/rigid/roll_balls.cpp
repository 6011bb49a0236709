// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/roll_balls.h"

#include <algorithm>
#include <cmath>

#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/optimization/islands.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/rigid/ball_cluster.h"
#include "physics/stages/rigid/ball_ground.h"
#include "physics/stages/rigid/roll.h"
#include "physics/state/activity_state.h"
#include "physics/state/ball_memory.h"
#include "physics/state/contact_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/ledger.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

bool is_still(const BodyState& state) {
    return state.inverse_mass == 0 && state.linear_velocity == Vec3{} && state.angular_velocity == Vec3{};
}

bool may_roll(const RollAccess& world, std::uint32_t body) {
    const TouchBody& touch = world.contacts.touch.bodies[body];
    if (!touch.is_ball || !touch.yields) return false;
    const BodyConstants& constants = world.rigid.constants[body];
    return constants.is_isotropic && constants.torque == Vec3{} && constants.linear_damping == 0 &&
           constants.angular_damping == 0;
}

// A contact that touches already and does not bounce is no impact.
void leave_to_rolling(ContactSummary& summary) {
    summary.was_touching = true;
    summary.bounces = false;
}

void list_candidates(const RollAccess& world, BallMemory& memory) {
    // Of one ball with the ground. Reserved, as a ball may first touch so many long after the start. Test:
    // SteadyAllocation.
    constexpr std::size_t usual_contacts = 8;
    memory.count = 0;
    for (const std::uint32_t body : world.activity.awake) {
        if (!may_roll(world, body)) continue;
        if (memory.count == 0) memory.of_body.assign(world.rigid.motion.size(), 0);
        if (memory.count == memory.candidates.size()) memory.candidates.emplace_back();
        BallMemory::Candidate& candidate = memory.candidates[memory.count];
        candidate.body = body;
        candidate.is_free = true;
        candidate.has_rolled = candidate.has_company = false;
        candidate.contacts.clear();
        candidate.contacts.reserve(usual_contacts);
        candidate.parent = static_cast<std::uint32_t>(memory.count++);
        memory.of_body[body] = static_cast<std::uint32_t>(memory.count);
    }
}

// Union-find with path halving; the smallest is the root.
std::uint32_t root_of(BallMemory& memory, std::uint32_t ball) {
    std::vector<BallMemory::Candidate>& list = memory.candidates;
    while (list[ball].parent != ball) ball = list[ball].parent = list[list[ball].parent].parent;
    return ball;
}

// What each ball touches: still ground, other balls, or bodies beside which it cannot be followed.
void list_neighbours(const RollAccess& world, BallMemory& memory) {
    memory.pairs.clear();
    const auto add_ground = [&](std::uint32_t body, std::uint32_t other, std::uint32_t contact) {
        BallMemory::Candidate& candidate = memory.candidates[memory.of_body[body] - 1];
        candidate.is_free = candidate.is_free && is_still(world.rigid.motion[other]);
        if (candidate.is_free) candidate.contacts.push_back(contact);
    };
    for (std::uint32_t i = 0; i < world.contacts.summaries.size(); ++i) {
        const ContactSummary& summary = world.contacts.summaries[i];
        const std::uint32_t a = memory.of_body[summary.a], b = memory.of_body[summary.b];
        if (a > 0 && b > 0) {
            memory.pairs.push_back({i, a - 1, b - 1, {}, 0});
            const std::uint32_t first = root_of(memory, a - 1), second = root_of(memory, b - 1);
            memory.candidates[std::max(first, second)].parent = std::min(first, second);
        } else if (a > 0) {
            add_ground(summary.a, summary.b, i);
        } else if (b > 0) {
            add_ground(summary.b, summary.a, i);
        }
    }
    const auto leave_out = [&](std::uint32_t body) {
        if (memory.of_body[body] > 0) memory.candidates[memory.of_body[body] - 1].is_free = false;
    };
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        const JointDefinition& joint = world.joints.records.at(slot).definition;
        leave_out(joint.body_b.index);
        if (!joint.body_a.is_null()) leave_out(joint.body_a.index);
    }
}

bool is_followed(const BallMemory::Candidate& candidate) { return candidate.is_free && !candidate.contacts.empty(); }

// Balls without other balls within reach.
void roll_single_balls(const RollAccess& world, BallMemory& memory) {
    constexpr std::size_t min_parallel_count = 64;  // balls: below, waking the workers costs more
    for (const BallMemory::Pair& pair : memory.pairs) {
        memory.candidates[pair.a].has_company = memory.candidates[pair.b].has_company = true;
    }
    parallel_for(world.workers, memory.count, memory.count >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            BallMemory::Candidate& candidate = memory.candidates[i];
            if (candidate.has_company || !is_followed(candidate)) continue;
            candidate.rolled.candidate = static_cast<std::uint32_t>(i);
            candidate.has_rolled =
                path_of_ball(world, candidate.body, candidate.contacts, candidate.surroundings).roll(candidate.rolled);
        }
    });
}

// Writes the collisions of a cluster to the contacts and the account of the step.
void note_collision(const RollAccess& world, const BallMemory::Pair& pair) {
    if (pair.impulse == Vec3{}) return;
    Contact& contact = world.contacts.list[pair.contact];
    contact.points[0].total += static_cast<float>(dot(pair.impulse, contact.normal));
    contact.friction_total.along_1 += static_cast<float>(dot(pair.impulse, contact.tangent_1));
    contact.friction_total.along_2 += static_cast<float>(dot(pair.impulse, tangent_2(contact)));
    contact.had_impact = true;
    ++world.report.impacts;
    if (world.ledger) world.ledger->note_impact({}, pair.energy_change);
}

void roll_clusters(const RollAccess& world, BallMemory& memory) {
    const std::size_t max_members = world.settings.solver.constraint.rolling.cluster.max_members;
    for (BallMemory::Pair& pair : memory.pairs) pair.root = root_of(memory, pair.a);
    std::sort(memory.pairs.begin(), memory.pairs.end(), [](const BallMemory::Pair& p, const BallMemory::Pair& q) {
        return p.root != q.root ? p.root < q.root : p.contact < q.contact;
    });
    for (auto first = memory.pairs.begin(); first != memory.pairs.end();) {
        const auto last = std::find_if(first, memory.pairs.end(),
                                       [&](const BallMemory::Pair& pair) { return pair.root != first->root; });
        const std::span<BallMemory::Pair> pairs(first, last);
        first = last;
        std::vector<std::uint32_t>& members = memory.members;
        members.clear();
        for (const BallMemory::Pair& pair : pairs) members.insert(members.end(), {pair.a, pair.b});
        std::sort(members.begin(), members.end());
        members.erase(std::unique(members.begin(), members.end()), members.end());
        const auto can_be_followed = [&](std::uint32_t index) { return is_followed(memory.candidates[index]); };
        if (members.size() > max_members || !std::all_of(members.begin(), members.end(), can_be_followed)) continue;
        if (!roll_cluster(world, members, pairs)) continue;
        for (const std::uint32_t index : members) memory.candidates[index].has_rolled = true;
        for (const BallMemory::Pair& pair : pairs) {
            // Nothing of the last step's load is left in the contact.
            note_load(world.settings, std::span(&pair.contact, 1), {pair.contact, 0}, Vec3{}, world.contacts.list);
            note_collision(world, pair);
            leave_to_rolling(world.contacts.summaries[pair.contact]);
        }
    }
}

const RolledBall* find_rolled(const std::vector<RolledBall>& list, std::uint32_t body) {
    const auto found = std::lower_bound(list.begin(), list.end(), body,
                                        [](const RolledBall& ball, std::uint32_t slot) { return ball.body < slot; });
    return found != list.end() && found->body == body ? &*found : nullptr;
}

}  // namespace

void roll_balls(const RollAccess& world) {
    BallMemory& memory = world.balls;
    memory.rolled.clear();
    list_candidates(world, memory);
    if (memory.count == 0) return;
    list_neighbours(world, memory);
    roll_single_balls(world, memory);
    roll_clusters(world, memory);
    for (std::size_t i = 0; i < memory.count; ++i) {
        const BallMemory::Candidate& candidate = memory.candidates[i];
        if (!candidate.has_rolled) continue;
        memory.rolled.push_back(candidate.rolled);
        for (const std::uint32_t contact : candidate.contacts) leave_to_rolling(world.contacts.summaries[contact]);
    }
}

bool take_rolled_balls(const SubstepAccess& world, const Island& island) {
    const std::vector<RolledBall>& list = world.balls.rolled;
    if (list.empty() || island.joint_count > 0) return false;
    const auto bodies = std::span(world.islands.bodies).subspan(island.first_body, island.body_count);
    if (!std::all_of(bodies.begin(), bodies.end(),
                     [&](std::uint32_t body) { return find_rolled(list, body) != nullptr; }))
        return false;
    for (const std::uint32_t body : bodies) {
        const RolledBall& ball = *find_rolled(list, body);
        world.rigid.motion[body] = ball.state;
        note_load(world.settings, world.balls.candidates[ball.candidate].contacts, {ball.contact, 0}, ball.impulse,
                  world.contacts.list);
    }
    return true;
}

bool has_rolled_along(const ContinuousAccess& world, std::uint32_t body, std::uint32_t ground) {
    const RolledBall* ball = find_rolled(world.balls.rolled, body);
    if (ball == nullptr || world.rigid.motion[body].center != ball->state.center) return false;
    const std::vector<std::uint32_t>& contacts = world.balls.candidates[ball->candidate].contacts;
    return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t contact) {
        return world.contacts.list[contact].a == ground || world.contacts.list[contact].b == ground;
    });
}

}  // namespace embody::physics::stages
