// SPDX-License-Identifier: MIT
// What is simulated otherwise than its entity says, told by name.
#include <unordered_map>
#include <utility>

#include "scene/matter/fluid_body.h"
#include "scene/matter/liquid_notes.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

std::string name_of(EntityIndex index, const LiveEntity& entity) {
    const std::string& name = entity.definition.name;
    return name.empty() ? "Entity " + std::to_string(index) : name;
}

// Adds notes of liquids of different fluids that overlap.
void add_notes_of_liquids(const std::vector<std::pair<std::string, const FluidBody*>>& liquids,
                          std::vector<std::string>& notes) {
    for (std::size_t a = 0; a < liquids.size(); ++a) {
        for (std::size_t b = a + 1; b < liquids.size(); ++b) {
            const FluidBody &one = *liquids[a].second, &other = *liquids[b].second;
            if (one.fluid() == other.fluid() || !are_overlapping(one, other)) continue;
            notes.push_back(liquids[b].first + " is in " + liquids[a].first +
                            ": liquids of other cells do not see each other.");
        }
    }
}

}  // namespace

std::vector<std::string> Simulation::notes() const {
    // Things of one name have one message, at the place of the first of them.
    std::vector<std::pair<std::string, int>> told;
    std::unordered_map<std::string, std::size_t> places;
    std::vector<std::pair<std::string, const FluidBody*>> liquids;
    for (const EntityIndex index : state_->remarkable) {
        const LiveEntity& entity = state_->live.at(index);
        const FluidBody* liquid = as_liquid(entity.points.get());
        if (liquid && !liquid->fluid().is_null()) liquids.emplace_back(name_of(index, entity), liquid);
        if (entity.form.note.empty()) continue;
        const std::string note = name_of(index, entity) + " " + entity.form.note;
        const auto [place, is_new] = places.emplace(note, told.size());
        if (is_new) told.emplace_back(note, 0);
        ++told[place->second].second;
    }
    std::vector<std::string> notes;
    for (const auto& [note, count] : told)
        notes.push_back(note + (count > 1 ? " (" + std::to_string(count) + " of this name)." : "."));
    for (const PortFault& fault : port_faults())
        notes.push_back(name_of(fault.entity, state_->live.at(fault.entity)) + ": " + fault.error.where + " " +
                        fault.error.why + ": nothing goes through it.");
    add_notes_of_liquids(liquids, notes);
    return notes;
}

}  // namespace embody::scene
