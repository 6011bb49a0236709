// SPDX-License-Identifier: MIT
// Copying parts of a scene, within it and between scenes.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/session/commands/commands.h"
#include "scene/session/formation.h"
#include "scene/session/placement_probe.h"
#include "scene/session/scene_part.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr int max_copies = 10'000;  // of one command: a slip in a count must not fill the memory

Result<json> copy(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    need_indices(reader, state, indices);
    if (!reader.finish()) return *error;
    Document part = part_of(state.document, indices);
    part.title = state.called(indices);
    return json{{"part", document_to_json(part)}};
}

Bounds bounds_of(SessionState& state, const Document& part) {
    static const std::set<EntityIndex> none;
    Bounds all;
    for (const Entity& entity : part.entities) {
        const auto probe = PlacementProbe::make(state, entity, none);
        if (probe.ok() && probe.value().has_bounds(entity.pose)) all.add(probe.value().bounds(entity.pose));
    }
    return all;
}

// Whether a thing of the part would be where one is already: what is pasted into the scene that it was copied from.
bool is_taken(const SessionState& state, const Document& part) {
    constexpr double same = 0.01;  // m
    for (const Entity& entity : part.entities)
        for (const Entity& other : state.document.entities)
            if (length(entity.pose.position - other.pose.position) < same) return true;
    return false;
}

Result<Transform> motion_of(SessionState& state, const Document& part, const std::optional<Drop>& drop,
                            const std::optional<Vec3>& offset) {
    if (offset) return Transform{*offset, {}};
    if (drop) {
        Formation formation(state, part.entities);
        const Result<Placement> placed = formation.place(drop->ray, drop->snap);
        if (!placed.ok()) return placed.error();
        return placed.value().pose * inverse(part.entities.front().pose);
    }
    if (!is_taken(state, part)) return Transform{};
    const Bounds all = bounds_of(state, part);
    return Transform{{all.is_empty() ? 1 : all.size().x + 0.1, 0, 0}, {}};
}

Result<json> paste(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const json* given = reader.need("part", "what entity.copy gave, or a scene");
    std::optional<Drop> drop;
    std::optional<Vec3> offset;
    read_drop(reader, drop);
    reader.vector("offset", offset);
    if (!reader.finish()) return *error;
    const Result<Document> part = document_from_json(*given);
    if (!part.ok()) return Error{"part." + part.error().where, part.error().why, part.error().remedy};
    if (part.value().entities.empty()) return Error{"part.entities", "has no entity"};
    const Result<Transform> motion = motion_of(state, part.value(), drop, offset);
    if (!motion.ok()) return motion.error();
    Edit edit = state.start_edit("Paste " + (part.value().entities.size() == 1
                                                 ? part.value().entities.front().name
                                                 : std::to_string(part.value().entities.size()) + " entities"));
    std::vector<EntityIndex> added;
    {
        PartAdder adder(state, edit);
        Result<std::vector<EntityIndex>> made = adder.add(part.value(), motion.value());
        if (!made.ok()) return made.error();
        added = std::move(made).value();
    }
    if (Result<void> pasted = state.commit(std::move(edit)); !pasted.ok()) return pasted.error();
    return json{{"indices", added}};
}

struct Counts {
    int x = 1, y = 1, z = 1;
};

bool need_counts(FieldReader& reader, Counts& counts) {
    Vec3 given;
    if (!need_vector(reader, "counts", "how many along each axis, [x, y, z]", given)) return false;
    const auto is_whole = [](double n) { return n >= 1 && n <= max_copies && n == std::floor(n); };
    if (!is_whole(given.x) || !is_whole(given.y) || !is_whole(given.z) || given.x * given.y * given.z > max_copies) {
        reader.fail(reader.path("counts"), "must be whole numbers from 1, at most 10000 copies in all");
        return false;
    }
    counts = {static_cast<int>(given.x), static_cast<int>(given.y), static_cast<int>(given.z)};
    return true;
}

// Rows, layers and columns of copies beside the selection, which is the first of them.
Result<json> array(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    Counts counts;
    std::optional<Vec3> spacing;
    need_indices(reader, state, indices);
    need_counts(reader, counts);
    reader.vector("spacing", spacing);
    if (!reader.finish()) return *error;
    const Document part = part_of(state.document, indices);
    if (!spacing) {
        const Bounds all = bounds_of(state, part);
        spacing = (all.is_empty() ? Vec3{1, 1, 1} : all.size()) + Vec3{clearance, clearance, clearance};
    }
    Edit edit = state.start_edit("Array of " + state.called(indices));
    std::vector<EntityIndex> added;
    {
        PartAdder adder(state, edit);
        for (int i = 1; i < counts.x * counts.y * counts.z; ++i) {
            const Vec3 cell{static_cast<double>(i % counts.x), static_cast<double>(i / counts.x / counts.z),
                            static_cast<double>(i / counts.x % counts.z)};
            const auto made = adder.add(part, {scale(cell, *spacing), {}});
            if (!made.ok()) return made.error();
            added.insert(added.end(), made.value().begin(), made.value().end());
        }
    }
    if (Result<void> done = state.commit(std::move(edit)); !done.ok()) return done.error();
    return json{{"indices", added}};
}

}  // namespace

std::span<const Command> part_commands() {
    static constexpr Command commands[] = {
        {"entity.copy", copy, Need::look}, {"entity.paste", paste}, {"entity.array", array}};
    return commands;
}

}  // namespace embody::scene
