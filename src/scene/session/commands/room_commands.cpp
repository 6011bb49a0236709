// SPDX-License-Identifier: MIT
// Commands that build: walls in a row, whole rooms.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "attributes/physical_kind.h"
#include "scene/session/commands/commands.h"
#include "scene/session/groups.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::size_t max_corners = 1000;
constexpr double floor_rise = 0.005;      // m: a room's floor lies so much over what it was drawn on
constexpr double floor_thickness = 0.15;  // m
constexpr double shortest_wall = 0.01;    // m

/// What is built, as a client asked for it.
struct Plan {
    std::vector<Vec3> corners;
    bool is_closed = false, has_floor = false, has_ceiling = false;
    double height = 2.5, thickness = 0.12;
    std::optional<std::array<double, 3>> wall_color{{0.82, 0.8, 0.76}}, floor_color{{0.35, 0.24, 0.15}};
};

void read_corners(FieldReader& reader, Plan& plan) {
    const json* list = reader.need("points", "the corners [x, y, z] in order");
    if (!list || !read_array(*list, "points", reader.error())) return;
    if (list->size() < 2 || list->size() > max_corners)
        return reader.fail("points", "must be 2 to 1000 corners, got " + std::to_string(list->size()));
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string where = element_path("points", i);
        Vec3 corner;
        if (!read_vector((*list)[i], where, corner, reader.error())) return;
        const Vec3 along = plan.corners.empty() ? Vec3{1, 0, 0} : corner - plan.corners.back();
        if (!plan.corners.empty() && corner.y != plan.corners.front().y)
            return reader.fail(where + "[1]", "must be as high as the first corner");
        if (std::hypot(along.x, along.z) < shortest_wall)
            return reader.fail(where, "must be at least 1 cm from the corner before it");
        plan.corners.push_back(corner);
    }
}

Result<Plan> read_plan(FieldReader& reader) {
    Plan plan;
    const NumberRange size{0.01, 1000, "m"};
    read_corners(reader, plan);
    reader.truth("closed", plan.is_closed);
    reader.truth("floor", plan.has_floor);
    reader.truth("ceiling", plan.has_ceiling);
    reader.number("height", plan.height, size);
    reader.number("thickness", plan.thickness, size);
    if (reader.ok() && plan.is_closed && plan.corners.size() < 3)
        reader.fail("points", "must be at least 3 corners of what is closed");
    if (reader.ok() && !plan.is_closed && (plan.has_floor || plan.has_ceiling))
        reader.fail(plan.has_floor ? "floor" : "ceiling", "needs walls that are closed", "say closed: true");
    if (reader.ok() && plan.is_closed && distance(plan.corners.front(), plan.corners.back()) < shortest_wall)
        reader.fail(element_path("points", plan.corners.size() - 1), "is the first corner again", "leave it out");
    if (!reader.ok()) return *reader.error();
    return plan;
}

/// Adds the parts of a building to an edit.
class Builder {
public:
    Builder(SessionState& state, Edit& edit, std::string group)
        : state_(state), edit_(edit), group_(std::move(group)) {}
    ~Builder() {
        for (const std::string& name : names_) state_.lookup.names.remove(name);
    }

    Result<void> add(const char* name, const char* category, physics::ShapeDefinition shape, const Transform& pose,
                     const std::optional<std::array<double, 3>>& color) {
        if (Result<void> valid = physics::validate(shape); !valid.ok())
            return Error{"points", std::string(name) + ": " + valid.error().message()};
        Entity entity;
        entity.index = edit_.next_after++;
        entity.name = state_.lookup.names.free_name(name);
        state_.lookup.names.add(entity.name);
        names_.push_back(entity.name);
        entity.category = category;
        entity.geometry = std::move(shape);
        entity.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
        entity.pose = pose;
        entity.color = color;
        entity.locked = true;
        entity.group = group_;
        indices.push_back(entity.index);
        edit_.changes.emplace_back(EntityChange{std::nullopt, std::move(entity)});
        return {};
    }

    json indices = json::array();

private:
    SessionState& state_;
    Edit& edit_;
    std::string group_;
    std::vector<std::string> names_;  // the commit assigns them for good
};

Result<void> add_walls(Builder& builder, const Plan& plan) {
    const std::size_t count = plan.is_closed ? plan.corners.size() : plan.corners.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = plan.corners[i], along = plan.corners[(i + 1) % plan.corners.size()] - from;
        physics::WallShape wall;
        wall.length = std::hypot(along.x, along.z);
        wall.height = plan.height;
        wall.thickness = plan.thickness;
        const Transform pose{from, from_axis_angle({0, 1, 0}, std::atan2(-along.z, along.x))};
        if (auto added = builder.add("Wall", "wall", std::move(wall), pose, plan.wall_color); !added.ok()) return added;
    }
    return {};
}

Result<void> add_slab(Builder& builder, const Plan& plan, const char* name, const char* category, double height,
                      const std::optional<std::array<double, 3>>& color) {
    const Vec3 origin = plan.corners.front();
    physics::SlabShape slab;
    slab.thickness = floor_thickness;
    for (const Vec3 corner : plan.corners) slab.points.push_back({corner.x - origin.x, corner.z - origin.z});
    return builder.add(name, category, std::move(slab), {{origin.x, origin.y + height, origin.z}, {}}, color);
}

Result<json> add_room(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const Result<Plan> read = read_plan(reader);
    if (!reader.finish()) return *error;
    const Plan& plan = read.value();
    if (Result<void> room = check_room(state.document, plan.corners.size() + 2); !room.ok()) return room.error();

    const bool is_room = plan.is_closed;
    Edit edit = state.start_edit(is_room ? "Build a room" : plan.corners.size() > 2 ? "Build walls" : "Build a wall");
    json indices;
    {
        Builder builder(state, edit, is_room ? free_group(state.document, "", "Room", {}) : "");
        if (auto added = add_walls(builder, plan); !added.ok()) return added.error();
        if (plan.has_floor)
            if (auto added = add_slab(builder, plan, "Room floor", "floor", floor_rise, plan.floor_color); !added.ok())
                return added.error();
        if (plan.has_ceiling)
            if (auto added =
                    add_slab(builder, plan, "Ceiling", "ceiling", plan.height + floor_thickness, plan.wall_color);
                !added.ok())
                return added.error();
        indices = std::move(builder.indices);
    }
    if (Result<void> added = state.commit(std::move(edit)); !added.ok()) return added.error();
    return json{{"indices", std::move(indices)}};
}

}  // namespace

std::span<const Command> room_commands() {
    static constexpr Command commands[] = {{"room.add", add_room}};
    return commands;
}

}  // namespace embody::scene
