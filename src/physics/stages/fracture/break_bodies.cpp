// SPDX-License-Identifier: MIT
// Which brittle bodies the blows of a step break (docs/physics/fracture.md).
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "foundation/random.h"
#include "physics/definitions/step_report.h"
#include "physics/dynamic/conserved.h"
#include "physics/fracture/split_solid.h"
#include "physics/stages/fracture/blows.h"
#include "physics/stages/fracture/pieces.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/fracture_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// Of sums of energies.
constexpr double rounding = 1e-9;
// kg: of a piece; a little more than the least mass of a body.
constexpr double min_mass = 1.001e-6;

// What takes back the impulses of a blow: by body the sums over its contacts.
struct Reversal {
    struct Push {
        std::uint32_t body = 0;
        Vec3 linear, angular;  ///< N s, N m s about the centre of mass
    };
    std::vector<Push> pushes;
    double driven = 0;  ///< work of bodies moved by command that goes with the impulses, J
};

void add_push(const FractureAccess& world, Reversal& reversal, std::uint32_t body, Vec3 impulse, Vec3 position) {
    const BodyState& state = world.rigid.motion[body];
    if (!is_movable(state)) return;
    auto push = std::ranges::find(reversal.pushes, body, &Reversal::Push::body);
    if (push == reversal.pushes.end()) push = reversal.pushes.insert(push, {body, {}, {}});
    push->linear += impulse;
    push->angular += cross(position - state.center, impulse);
}

// Contacts with bodies that have broken in this step stay as they are: their pieces' velocities are made already.
Reversal reversal_of(const FractureAccess& world, const BlowOnBody& on, std::uint32_t body) {
    Reversal reversal;
    for (const ContactImpulse& contact : on.contacts) {
        const std::uint32_t other = contact.a == body ? contact.b : contact.a;
        if (std::ranges::find(world.fracture.planned, other, &PlannedBreak::body) != world.fracture.planned.end())
            continue;
        add_push(world, reversal, contact.a, contact.impulse, contact.position);
        add_push(world, reversal, contact.b, -contact.impulse, contact.position);
        reversal.driven += driven_work(world, contact, body);
    }
    return reversal;
}

// The change of the body's spin, by its inertia at the present rotation.
Vec3 spin_by(const FractureAccess& world, const Reversal::Push& push) {
    const Quat rotation = world.rigid.motion[push.body].rotation;
    return rotate(rotation, world.rigid.constants[push.body].inverse_inertia * rotate_inverse(rotation, push.angular));
}

// The largest fraction up to `wanted` of the reversal that costs no more than `budget` (J): the kinetic energy grows by
// r (v · P + ω · L) + ½ r² (P²/m + L · I⁻¹ L).
double affordable_fraction(const FractureAccess& world, const Reversal& reversal, double budget, double wanted) {
    double linear = reversal.driven, square = 0;
    for (const Reversal::Push& push : reversal.pushes) {
        const BodyState& state = world.rigid.motion[push.body];
        linear += dot(state.linear_velocity, push.linear) + dot(state.angular_velocity, push.angular);
        square += 0.5 * (state.inverse_mass * length_squared(push.linear) + dot(push.angular, spin_by(world, push)));
    }
    if (wanted * (linear + wanted * square) <= budget) return wanted;
    const double root = std::sqrt(std::max(0.0, linear * linear + 4 * square * budget));
    const double fraction = linear > 0 ? 2 * budget / (root + linear) : (root - linear) / (2 * square);
    return std::clamp(fraction, 0.0, wanted);
}

void take_back(const FractureAccess& world, const Reversal& reversal, double fraction) {
    for (const Reversal::Push& push : reversal.pushes) {
        BodyState& state = world.rigid.motion[push.body];
        state.linear_velocity += state.inverse_mass * fraction * push.linear;
        state.angular_velocity += spin_by(world, push) * fraction;
    }
}

// The solid cut into as many pieces as the blow makes and the budget (J) pays; what hangs together in a cell is one.
Split split_by(const FractureAccess& world, std::uint32_t body, const Blow& blow, double budget) {
    if (!(budget > 0)) return {};
    const BodyRecord& record = world.rigid.record(body);
    const auto cells = cells_of(record.shape->definition());
    if (!cells) return {};
    Bounds box;
    double volume = 0;
    for (const ConvexCell& cell : *cells) {
        box.add(cell.bounds());
        volume += cell.mass_properties().volume;
    }
    const Brittleness& brittleness = *record.definition.brittleness;
    const Transform pose = world.rigid.pose(body);
    const Vec3 place = rotate_inverse(pose.rotation, blow.position - pose.position);
    const double min_piece_volume = min_mass * volume / world.rigid.constants[body].mass;
    const auto most = static_cast<std::size_t>(brittleness.max_pieces);
    for (int count = piece_count({box.size(), volume}, blow.energy, brittleness); count >= 2; count = count * 2 / 3) {
        // Seeded by the body and the step: equal runs break alike.
        Random random((static_cast<std::uint64_t>(body) << 32) ^ world.report.step);
        Split split = split_solid(*cells, choose_seeds(*cells, place, count, random), min_piece_volume);
        const bool is_affordable = split.crack_area * brittleness.fracture_energy <= budget;
        if (split.pieces.size() >= 2 && split.pieces.size() <= most && is_affordable) return split;
    }
    return {};
}

// What the losses of the step still pay: what earlier breaks of connected bodies took is spent.
double unspent(const FractureAccess& world, const StepLosses& losses, std::uint32_t body) {
    double left = losses.of(body);
    for (const PlannedBreak& other : world.fracture.planned)
        if (losses.are_connected(body, other.body)) left -= other.paid;
    return left;
}

std::optional<PlannedBreak> plan_break(const FractureAccess& world, const StepLosses& losses, std::uint32_t body,
                                       const BlowOnBody& on) {
    const BodyDefinition& definition = world.rigid.record(body).definition;
    const std::optional<double> excess = excess_of(on.blow, *definition.brittleness);
    if (!excess) return std::nullopt;
    const double budget = unspent(world, losses, body);
    const Split split = split_by(world, body, on.blow, budget);
    if (split.pieces.empty()) return std::nullopt;

    PlannedBreak planned{.body = body, .event = {}, .paid = 0, .pieces = {}};
    planned.event = {{}, definition.user_data, on.blow.position, on.blow.impulse, on.blow.energy, split.crack_area, {}};
    const double cracks = split.crack_area * definition.brittleness->fracture_energy;
    const Reversal reversal = reversal_of(world, on, body);
    std::vector<BodyState> before;
    for (const Reversal::Push& push : reversal.pushes) before.push_back(world.rigid.motion[push.body]);
    // The excess of the blow is taken back as far as the losses pay, or not at all.
    for (const double fraction : {affordable_fraction(world, reversal, budget - cracks, *excess), 0.0}) {
        take_back(world, reversal, fraction);
        auto pieces = make_pieces(world, body, split);
        planned.paid = cracks + fraction * reversal.driven + (pieces ? pieces->energy_growth : 0);
        if (pieces && planned.paid <= unspent(world, losses, body) * (1 + rounding)) {
            planned.pieces = std::move(pieces->pieces);
            return planned;
        }
        for (std::size_t i = 0; i < before.size(); ++i) world.rigid.motion[reversal.pushes[i].body] = before[i];
    }
    return std::nullopt;
}

}  // namespace

void note_motion(const FractureAccess& world) {
    if (world.rigid.brittle.empty())
        world.fracture.before.clear();
    else
        world.fracture.before = world.rigid.motion;
}

void plan_breaks(const FractureAccess& world) {
    world.fracture.planned.clear();
    if (world.rigid.brittle.empty()) return;
    const auto blows = find_blows(world);
    const auto is_hard = [&](const auto& blow) {
        return excess_of(blow.second.blow, *world.rigid.record(blow.first).definition.brittleness).has_value();
    };
    if (std::ranges::none_of(blows, is_hard)) return;
    const StepLosses losses(world);
    for (const auto& [body, on] : blows) {
        if (world.activity.is_asleep(body)) continue;
        if (auto planned = plan_break(world, losses, body, on)) world.fracture.planned.push_back(std::move(*planned));
    }
}

}  // namespace embody::physics::stages
