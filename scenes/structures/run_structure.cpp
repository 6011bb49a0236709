// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenes/structures/structure.h"

namespace embody::scenes {
namespace {

// Notes how far the pieces are from their places; false once one of them fell.
bool note_places(const Structure& structure, StructureResult& result) {
    if (structure.fallen == 0) return true;
    result.sag = result.drift = 0;
    for (const Piece& piece : structure.pieces) {
        const Vec3 away = structure.world->center_of_mass(piece.body) - piece.place;
        if (!(length(away) <= structure.fallen)) return false;
        result.sag = std::max(result.sag, -away.y);
        result.drift = std::max(result.drift, std::hypot(away.x, away.z));
    }
    return true;
}

int count_steps(const StructureGoal& goal, const physics::WorldSettings& settings) {
    return static_cast<int>(std::lround(goal.seconds / settings.time_step));
}

void run_awake(const StructureBuilder& builder, StructureResult& result) {
    const physics::WorldSettings settings{.sleeping = false};
    const Structure structure = builder.build(settings);
    const int steps = count_steps(builder.goal, settings);
    const int last_second = steps - static_cast<int>(std::lround(1 / settings.time_step));

    // A structure that begins in the air gets half of its time to come to rest.
    bool at_rest = note_places(structure, result);
    for (int i = 0; i < steps; ++i) {
        result.step_milliseconds += structure.world->step().milliseconds / steps;
        const bool in_place = note_places(structure, result);
        at_rest = at_rest || in_place;
        if (!in_place && (at_rest || i > steps / 2)) {
            result.stands = false;
            result.fell_at = (i + 1) * settings.time_step;
            return;
        }
        if (i >= last_second) result.energy = std::max(result.energy, structure.world->conserved().kinetic_energy);
    }
}

void run_sleeping(const StructureBuilder& builder, StructureResult& result) {
    const physics::WorldSettings settings{};
    const Structure structure = builder.build(settings);
    for (int i = 0; i < count_steps(builder.goal, settings); ++i) {
        const bool all_asleep = structure.world->step().bodies_asleep == structure.pieces.size();
        if (!all_asleep) result.asleep_after.reset();
        if (all_asleep && !result.asleep_after) result.asleep_after = (i + 1) * settings.time_step;
    }
}

bool exceeds(double value, const std::optional<double>& bound) { return bound && !(value <= *bound); }

}  // namespace

std::string_view StructureResult::misses(const StructureGoal& goal) const {
    if (!stands) return "fell";
    if (exceeds(sag, goal.sag)) return "sags";
    if (exceeds(drift, goal.drift)) return "drifts";
    if (exceeds(energy, goal.energy)) return "moves";
    if (goal.asleep_after && !asleep_after) return "does not sleep";
    if (goal.asleep_after && *asleep_after > *goal.asleep_after) return "sleeps late";
    return {};
}

StructureResult run_structure(const StructureBuilder& builder) {
    StructureResult result;
    run_awake(builder, result);
    if (result.stands) run_sleeping(builder, result);
    return result;
}

}  // namespace embody::scenes
