// SPDX-License-Identifier: MIT
#include "physics/stages/impact/impact_assembly.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

constexpr std::size_t max_flights = 16;  // maximum of remembered assemblies; analysing one again gives the same

bool is_movable(const ImpactAccess& world, std::uint32_t body) { return world.rigid.motion[body].inverse_mass > 0; }

// The active joints of each movable body.
void list_joints_of_bodies(const ImpactAccess& world) {
    ImpactMemory& memory = world.impacts;
    if (memory.has_joint_lists) return;
    memory.has_joint_lists = true;
    std::vector<std::uint32_t>& first = memory.first_joint_of_body;
    first.assign(world.rigid.motion.size() + 2, 0);
    const auto for_each_end = [&](auto visit) {
        for (std::uint32_t i = 0; i < world.joints.active.size(); ++i) {
            const Joint& joint = world.joints.active[i];
            if (!joint.a_is_world && is_movable(world, joint.a)) visit(joint.a, i);
            if (is_movable(world, joint.b)) visit(joint.b, i);
        }
    };
    for_each_end([&](std::uint32_t body, std::uint32_t) { ++first[body + 2]; });
    for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];

    // While the list is filled, an entry moves on to where the next body's begins.
    memory.joint_of_body.resize(first.back());
    for_each_end([&](std::uint32_t body, std::uint32_t joint) { memory.joint_of_body[first[body + 1]++] = joint; });
}

std::span<const std::uint32_t> joints_of(const ImpactMemory& memory, std::uint32_t body) {
    const std::uint32_t first = memory.first_joint_of_body[body], last = memory.first_joint_of_body[body + 1];
    return std::span(memory.joint_of_body).subspan(first, last - first);
}

// Calls move(h) for the whole substeps from the step's start to `time`, s, and for the rest; from there back, with
// negative h, if the time is negative.
template <class Move>
void for_each_substep(const ImpactAccess& world, double time, Move move) {
    const double substep = world.settings.time_step / world.settings.substeps, length = std::fabs(time);
    const int whole = std::min(static_cast<int>(length / substep), world.settings.substeps);
    const double rest = std::copysign(length - whole * substep, time);
    if (rest < 0) move(rest);
    for (int k = 0; k < whole; ++k) move(std::copysign(substep, time));
    if (rest > 0) move(rest);
}

// The system of the present assembly: from its last motion, or in the place of the one that was not used for the
// longest time.
JointSystem& flight_of_jointed(ImpactMemory& memory) {
    std::vector<ImpactMemory::Flight>& flights = memory.flights;
    const auto is_it = [&](const ImpactMemory::Flight& flight) {
        return flight.bodies == memory.jointed && flight.joints == memory.jointed_joints;
    };
    auto found = std::find_if(flights.begin(), flights.end(), is_it);
    if (found == flights.end()) {
        const auto is_older = [](const ImpactMemory::Flight& a, const ImpactMemory::Flight& b) {
            return a.last_use < b.last_use;
        };
        found = flights.size() < max_flights ? flights.emplace(flights.end())
                                             : std::min_element(flights.begin(), flights.end(), is_older);
        found->bodies = memory.jointed;
        found->joints = memory.jointed_joints;
    }
    found->last_use = ++memory.flight_uses;
    return found->system;
}

void sort_once(std::vector<std::uint32_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

bool has_joints(const ImpactAccess& world, std::uint32_t body) { return !joints_of(world.impacts, body).empty(); }

bool can_fly_jointed(const ImpactAccess& world) {
    const ImpactMemory& memory = world.impacts;
    const std::size_t nodes = memory.jointed.size() + memory.jointed_joints.size();
    if (memory.jointed.size() > world.settings.solver.constraint.impact.budget.max_flown_bodies ||
        nodes >= BlockPattern::max_nodes)
        return false;
    const auto is_reversible = [&](std::uint32_t body) {
        return memory.has_jointed_path[body] && !memory.is_supported[body];
    };
    return std::all_of(memory.jointed.begin(), memory.jointed.end(), is_reversible);
}

void fly_jointed(const ImpactAccess& world, double time) {
    ImpactMemory& memory = world.impacts;
    memory.flown_joints.clear();
    memory.flown_list.clear();
    for (const std::uint32_t index : memory.jointed_joints) {
        memory.flown_list.push_back(static_cast<std::uint32_t>(memory.flown_joints.size()));
        memory.flown_joints.push_back(world.joints.active[index]);
    }
    const JointSystem::View view{world.rigid.motion, world.rigid.constants, memory.flown_joints,
                                 world.settings.solver.constraint.joint};
    JointSystem& system = flight_of_jointed(memory);
    system.set({memory.jointed, memory.flown_list}, view);
    system.start_cold();
    move_carriers(world, time < 0 ? -time : 0);
    for_each_substep(world, time, [&](double h) { system.advance(h, view, JointSystem::Errors::kept); });
    put_carriers_back(world);
}

void move_carriers(const ImpactAccess& world, double time) {
    ImpactMemory& memory = world.impacts;
    memory.carriers.clear();
    const auto add = [&](std::uint32_t body) {
        const BodyState& state = world.rigid.motion[body];
        const bool moves = state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{};
        const auto is_it = [body](const ImpactMemory::Carrier& carrier) { return carrier.body == body; };
        if (is_movable(world, body) || !moves) return;
        if (std::none_of(memory.carriers.begin(), memory.carriers.end(), is_it))
            memory.carriers.push_back({body, state});
    };
    for (const std::uint32_t index : memory.jointed_joints) {
        const Joint& joint = world.joints.active[index];
        if (!joint.a_is_world) add(joint.a);
        add(joint.b);
    }
    for (const ImpactMemory::Carrier& carrier : memory.carriers) {
        for_each_substep(world, time, [&](double h) { drift_kinematic(world.rigid.motion[carrier.body], h); });
    }
}

void put_carriers_back(const ImpactAccess& world) {
    for (const ImpactMemory::Carrier& carrier : world.impacts.carriers)
        world.rigid.motion[carrier.body] = carrier.start;
}

void gather_jointed(const ImpactAccess& world) {
    ImpactMemory& memory = world.impacts;
    memory.jointed.clear();
    memory.jointed_joints.clear();
    if (world.joints.active.empty()) return;
    list_joints_of_bodies(world);

    // Breadth first from what collides.
    const std::size_t max_jointed_bodies = world.settings.solver.constraint.impact.budget.max_jointed_bodies;
    std::vector<std::uint32_t>& found = memory.jointed;
    const auto is_found = [&](std::uint32_t body) {
        return std::find(found.begin(), found.end(), body) != found.end();
    };
    for (const ImpactMemory::Moved& moved : memory.bodies) {
        if (found.size() < max_jointed_bodies && !joints_of(memory, moved.body).empty()) found.push_back(moved.body);
    }
    for (std::size_t i = 0; i < found.size() && found.size() < max_jointed_bodies; ++i) {
        for (const std::uint32_t index : joints_of(memory, found[i])) {
            const Joint& joint = world.joints.active[index];
            const std::uint32_t other = joint.b == found[i] && !joint.a_is_world ? joint.a : joint.b;
            if (is_movable(world, other) && found.size() < max_jointed_bodies && !is_found(other))
                found.push_back(other);
        }
    }

    // Their joints, but those to bodies too far away.
    for (const std::uint32_t body : found) {
        for (const std::uint32_t index : joints_of(memory, body)) {
            const Joint& joint = world.joints.active[index];
            const auto takes_part = [&](std::uint32_t end) { return !is_movable(world, end) || is_found(end); };
            if (takes_part(joint.b) && (joint.a_is_world || takes_part(joint.a)))
                memory.jointed_joints.push_back(index);
        }
    }
    sort_once(memory.jointed_joints);
    const std::size_t max_joints = BlockPattern::max_nodes - found.size();
    if (memory.jointed_joints.size() > max_joints) memory.jointed_joints.resize(max_joints);
    for (const std::uint32_t body : found) {
        const auto is_it = [body](const ImpactMemory::Moved& moved) { return moved.body == body; };
        if (std::none_of(memory.bodies.begin(), memory.bodies.end(), is_it))
            memory.bodies.push_back({body, false, {}, {}, {}});
    }
    sort_once(found);
}

}  // namespace embody::physics::stages
