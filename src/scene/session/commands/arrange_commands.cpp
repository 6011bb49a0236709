// SPDX-License-Identifier: MIT
// Commands that move several things by a rule: along, about, in rows, as in a mirror.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "scene/session/commands/commands.h"
#include "scene/session/groups.h"

namespace embody::scene {

using nlohmann::json;

namespace {

bool need_axis(FieldReader& reader, int& axis) {
    std::string name;
    if (!need_text(reader, "axis", "\"x\", \"y\" or \"z\"", name)) return false;
    if (name != "x" && name != "y" && name != "z") return reader.fail(reader.path("axis"), "must be x, y or z"), false;
    axis = name[0] - 'x';
    return true;
}

Transform present_pose(const SessionState& state, EntityIndex index) {
    return state.simulation->contains(index) ? state.simulation->pose(index) : state.document.find(index)->pose;
}

void put_pose(const SessionState& state, Edit& edit, EntityIndex index, const Transform& pose) {
    edit.changes.emplace_back(PoseChange{index, state.document.find(index)->pose, pose});
}

/// Things that stay as they are to each other: one, or the chosen ones of a group.
struct Unit {
    std::vector<EntityIndex> members;
    Bounds bounds;
};

Result<Bounds> bounds_of(const SessionState& state, EntityIndex index) {
    const Bounds bounds = state.simulation->bounds(index);
    if (!bounds.is_empty() && is_finite(bounds.size())) return bounds;
    return Error{"indices", state.called({index}) + " has no bounds to align", "leave it out of the selection"};
}

Result<std::vector<Unit>> units_of(const SessionState& state, const std::vector<EntityIndex>& indices) {
    std::map<std::string, std::size_t> groups;
    std::vector<Unit> units;
    for (const EntityIndex index : indices) {
        const Result<Bounds> bounds = bounds_of(state, index);
        if (!bounds.ok()) return bounds.error();
        const std::string group = outermost_group(state.document.find(index)->group);
        const auto [place, is_new] = groups.emplace(group.empty() ? "/" + std::to_string(index) : group, units.size());
        if (is_new) units.emplace_back();
        units[place->second].members.push_back(index);
        units[place->second].bounds.add(bounds.value());
    }
    return units;
}

void move_unit(const SessionState& state, Edit& edit, const Unit& unit, int axis, double by) {
    for (const EntityIndex index : unit.members) {
        Transform pose = present_pose(state, index);
        pose.position[axis] += by;
        put_pose(state, edit, index, pose);
    }
}

Result<json> align(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    int axis = 0;
    std::string at;
    need_indices(reader, state, indices);
    need_axis(reader, axis);
    if (need_text(reader, "at", "\"low\", \"center\" or \"high\"", at) && at != "low" && at != "center" && at != "high")
        reader.fail("at", "must be low, center or high");
    if (!reader.finish()) return *error;
    const auto units = units_of(state, indices);
    if (!units.ok()) return units.error();
    if (units.value().size() < 2) return Error{"indices", "are one thing, or one group", "select at least two"};
    Bounds all;
    for (const Unit& unit : units.value()) all.add(unit.bounds);
    const auto place = [&](const Bounds& bounds) {
        return at == "low" ? bounds.lower[axis] : at == "high" ? bounds.upper[axis] : bounds.center()[axis];
    };
    Edit edit = state.start_edit("Align " + state.called(indices));
    for (const Unit& unit : units.value()) move_unit(state, edit, unit, axis, place(all) - place(unit.bounds));
    return done(state.commit(std::move(edit)));
}

// The outer two stay; the gaps between all become equal.
Result<json> distribute(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    int axis = 0;
    need_indices(reader, state, indices);
    need_axis(reader, axis);
    if (!reader.finish()) return *error;
    auto units = units_of(state, indices);
    if (!units.ok()) return units.error();
    std::vector<Unit>& row = units.value();
    if (row.size() < 3) return Error{"indices", "are fewer than three things or groups", "select at least three"};
    std::stable_sort(row.begin(), row.end(), [axis](const Unit& a, const Unit& b) {
        return a.bounds.center()[axis] < b.bounds.center()[axis];
    });
    double taken = 0;
    for (const Unit& unit : row) taken += unit.bounds.size()[axis];
    const double from = row.front().bounds.lower[axis], to = row.back().bounds.upper[axis];
    const double gap = (to - from - taken) / static_cast<double>(row.size() - 1);
    Edit edit = state.start_edit("Distribute " + state.called(indices));
    double place = from;
    for (const Unit& unit : row) {
        move_unit(state, edit, unit, axis, place - unit.bounds.lower[axis]);
        place += unit.bounds.size()[axis] + gap;
    }
    return done(state.commit(std::move(edit)));
}

Result<Bounds> bounds_of_all(const SessionState& state, const std::vector<EntityIndex>& indices) {
    Bounds all;
    for (const EntityIndex index : indices) {
        const Bounds bounds = state.simulation->bounds(index);
        if (!bounds.is_empty() && is_finite(bounds.size()))
            all.add(bounds);
        else
            all.add(present_pose(state, index).position);
    }
    return all;
}

// Reflections across a plane make left hands of right hands; a thing itself is taken as symmetric between its left and
// its right (its local X), so that it is only turned.
Quat mirrored(Quat q, int axis) {
    if (axis == 0) return {q.x, -q.y, -q.z, q.w};
    if (axis == 1) return {-q.x, q.y, -q.z, q.w};
    return normalized(Quat{-q.x, -q.y, q.z, q.w} * from_axis_angle({0, 1, 0}, std::numbers::pi));
}

Result<json> mirror(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    int axis = 0;
    need_indices(reader, state, indices);
    need_axis(reader, axis);
    if (!reader.finish()) return *error;
    const Result<Bounds> all = bounds_of_all(state, indices);
    const double middle = all.value().center()[axis];
    Edit edit = state.start_edit("Mirror " + state.called(indices));
    for (const EntityIndex index : indices) {
        Transform pose = present_pose(state, index);
        pose.position[axis] = 2 * middle - pose.position[axis];
        pose.rotation = mirrored(pose.rotation, axis);
        put_pose(state, edit, index, pose);
    }
    return done(state.commit(std::move(edit)));
}

// About the vertical through the middle of all.
Result<json> turn(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    double angle = 0;
    need_indices(reader, state, indices);
    if (reader.need("angle", "rad, counter-clockwise seen from above")) reader.number("angle", angle);
    Edit edit = state.start_edit({});
    reader.text("merge", edit.merge);
    if (!reader.finish()) return *error;
    Vec3 pivot = bounds_of_all(state, indices).value().center();
    if (indices.size() == 1) pivot = present_pose(state, indices.front()).position;
    const Quat by = from_axis_angle({0, 1, 0}, angle);
    for (const EntityIndex index : indices) {
        Transform pose = present_pose(state, index);
        pose = {pivot + rotate(by, pose.position - pivot), normalized(by * pose.rotation)};
        put_pose(state, edit, index, pose);
    }
    edit.label = "Turn " + state.called(indices);
    return done(state.commit(std::move(edit)));
}

Result<json> move(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    Vec3 offset;
    need_indices(reader, state, indices);
    need_vector(reader, "offset", "how far, [x, y, z], m", offset);
    Edit edit = state.start_edit({});
    reader.text("merge", edit.merge);
    if (!reader.finish()) return *error;
    for (const EntityIndex index : indices) {
        Transform pose = present_pose(state, index);
        pose.position += offset;
        put_pose(state, edit, index, pose);
    }
    edit.label = "Move " + state.called(indices);
    return done(state.commit(std::move(edit)));
}

}  // namespace

std::span<const Command> arrange_commands() {
    static constexpr Command commands[] = {{"entity.align", align},
                                           {"entity.distribute", distribute},
                                           {"entity.mirror", mirror},
                                           {"entity.turn", turn},
                                           {"entity.move", move}};
    return commands;
}

}  // namespace embody::scene
