// SPDX-License-Identifier: MIT
#include "scene/session/placement.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/session/commands/commands.h"
#include "scene/session/formation.h"

namespace embody::scene {

using nlohmann::json;

namespace {

json placement_json(const Placement& placement) {
    return {{"pose", transform_to_json(placement.pose)},
            {"on", placement.on != 0 ? json(placement.on) : json(nullptr)},
            {"placement", to_text(placement.seat)}};
}

// Of a thing that is there: how it stands or hangs, and its point that a drag puts under the pointer.
Result<json> present_placement(SessionState& state, EntityIndex index) {
    Result<const Entity*> found = state.entity(index, "index");
    if (!found.ok()) return found.error();
    Entity entity = *found.value();
    if (state.simulation->contains(index)) entity.pose = state.simulation->pose(index);
    const Seat seat = present_seat(state, entity);
    const Result<Vec3> point = placing_point(state, entity, seat);
    if (!point.ok()) return point.error();
    json result = placement_json({entity.pose, 0, seat});
    result["point"] = vector_to_json(point.value());
    return result;
}

Result<json> preview(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (params.contains("index")) {
        EntityIndex index = 0;
        need_index(reader, "index", index);
        if (!reader.finish()) return *error;
        return present_placement(state, index);
    }
    const json* given = reader.need("entity", "the entity as in a scene file");
    std::optional<Drop> drop;
    read_drop(reader, drop);
    if (reader.ok() && !drop) reader.fail("drop", "is missing: the pointer's ray, {origin, direction}");
    if (!reader.finish()) return *error;
    Result<Entity> entity = entity_from_json(*given, "entity");
    if (!entity.ok()) return entity.error();
    const Result<Placement> placed = place_on_ray(state, entity.value(), drop->ray, {drop->snap, {}});
    if (!placed.ok()) return placed.error();
    return placement_json(placed.value());
}

// The first of the indices is the one under the pointer.
Result<json> drag(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::optional<Drop> drop;
    Edit edit = state.start_edit({});
    need_indices(reader, state, indices);
    read_drop(reader, drop);
    reader.text("merge", edit.merge);
    if (reader.ok() && !drop) reader.fail("drop", "is missing: the pointer's ray, {origin, direction}");
    if (!reader.finish()) return *error;
    const auto lead = params.at("indices").front().get<EntityIndex>();

    Formation formation(state, lead, indices);
    const Result<Placement> placed = formation.place(drop->ray, drop->snap);
    if (!placed.ok()) return placed.error();
    for (const Entity& entity : formation.members()) {
        const Entity& before = *state.document.find(entity.index);
        if (can_hang(state, before)) {
            Entity after = entity;
            if (entity.index == lead) (void)hold_in_place(state, after, placed.value().seat);
            edit.changes.emplace_back(change_of(before, after));
        } else {
            edit.changes.emplace_back(PoseChange{entity.index, before.pose, entity.pose});
        }
    }
    edit.label = "Move " + state.called(indices);
    if (Result<void> moved = state.commit(std::move(edit)); !moved.ok()) return moved.error();
    return placement_json(placed.value());
}

Result<json> drop_to_floor(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    need_indices(reader, state, indices);
    if (!reader.finish()) return *error;
    for (const EntityIndex index : indices)
        if (Result<void> allowed = state.check_unlocked(index); !allowed.ok()) return allowed.error();

    // The lowest first: things on it follow.
    Simulation& simulation = *state.simulation;
    const auto bottom = [&](EntityIndex index) { return simulation.bounds(index).lower.y; };
    std::stable_sort(indices.begin(), indices.end(),
                     [&](EntityIndex a, EntityIndex b) { return bottom(a) < bottom(b); });
    Edit edit = state.start_edit("Drop " + state.called(indices));
    for (const EntityIndex index : indices) {
        if (!simulation.contains(index)) continue;
        Transform pose = simulation.pose(index);
        const std::optional<double> drop = simulation.drop_distance(index, max_ray_length);
        if (!drop || *drop <= clearance) continue;
        pose.position.y -= *drop - clearance;
        if (Result<void> moved = simulation.set_pose(index, pose); !moved.ok()) return moved.error();
        edit.changes.emplace_back(PoseChange{index, state.document.find(index)->pose, pose});
    }
    return done(state.commit(std::move(edit)));
}

Result<json> pick(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Vec3 origin, direction;
    std::uint32_t ignored = 0;
    need_vector(reader, "origin", "where the ray starts, [x, y, z]", origin);
    need_vector(reader, "direction", "where it goes, [x, y, z]", direction);
    reader.whole("ignore", ignored);
    if (!reader.finish()) return *error;
    if (length(direction) < 1e-9) return Error{"direction", "must not be zero"};

    const Simulation& simulation = *state.simulation;
    const auto hit = simulation.cast_ray(origin, normalized(direction), max_ray_length, ignored);
    if (!hit) return json{{"hit", nullptr}};
    return json{{"hit",
                 {{"index", hit->entity},
                  {"position", vector_to_json(hit->position)},
                  {"normal", vector_to_json(hit->normal)},
                  {"distance", hit->distance}}}};
}

}  // namespace

std::span<const Command> placement_commands() {
    static constexpr Command commands[] = {{"entity.preview", preview, Need::look},
                                           {"entity.drag", drag},
                                           {"entity.drop_to_floor", drop_to_floor},
                                           {"scene.pick", pick, Need::look}};
    return commands;
}

}  // namespace embody::scene
