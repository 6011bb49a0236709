// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "attributes/physical_kind.h"
#include "scene/file/json/parts.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr double max_ray_length = 1e4;  // m, of a pointer's ray
constexpr double clearance = 1e-4;      // m, between a thing and the surface that it is placed on
constexpr double wall_gap = 0.005;      // m, before a wall: closer, it would count as touching on the way down
constexpr double steepest_floor = 0.5;  // cosine: a surface up to 60° steep counts as a floor

// An entity that is in the running world only while it is measured.
class Probe {
public:
    static Result<void> put(SessionState& state, const Entity& entity, std::optional<Probe>& probe) {
        Entity still = entity;
        still.enabled = true;
        // A liquid, granular or deformable thing is placed as the solid thing that it would be.
        const Result<attributes::AttributeSet> set = state.definitions.attributes.acting(entity);
        if (set.ok() && changes_form(kind_of(set.value())))
            still.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
        if (Result<void> added = state.simulation->add(still); !added.ok()) return added;
        probe.emplace(state, entity.index);
        return {};
    }
    Probe(SessionState& state, EntityIndex index) : state_(state), index_(index) {
        state.simulation_is_pristine = false;
    }
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;
    ~Probe() { (void)state_.simulation->remove(index_).ok(); }

    [[nodiscard]] physics::BodyHandle body() const { return state_.simulation->body(index_); }
    [[nodiscard]] Bounds bounds() const { return state_.simulation->world().bounds(body()); }
    void move_to(const Transform& pose) { (void)state_.simulation->world().set_pose(body(), pose).ok(); }

private:
    SessionState& state_;
    EntityIndex index_;
};

// The surface that the ray hits; without a hit the ground at height 0, or a place in front of the viewer.
struct Surface {
    Vec3 position;
    Vec3 normal{0, 1, 0};
};

Surface find_surface(const Simulation& simulation, Vec3 origin, Vec3 direction) {
    if (const auto hit = simulation.cast_ray(origin, direction, max_ray_length)) return {hit->position, hit->normal};
    const double to_ground = direction.y < -1e-3 ? -origin.y / direction.y : -1;
    if (to_ground > 0 && to_ground < 100) return {origin + direction * to_ground};
    return {origin + direction * 5};
}

// Lowers the probe until it touches something; if it overlaps something at first, from slightly higher.
Transform lower_until_touching(SessionState& state, Probe& probe, Transform pose) {
    const physics::World& world = state.simulation->world();
    for (const double lift : {0.002, 0.02, 0.1, 0.3, 1.0, 3.0}) {
        Transform lifted = pose;
        lifted.position.y += lift;
        probe.move_to(lifted);
        const std::optional<double> drop = world.drop_distance(probe.body(), lift + 0.05);
        if (!drop) {
            // Nothing below: the ray hit only the rim of the surface.
            return pose;
        }
        if (*drop <= 1e-6) continue;
        lifted.position.y -= std::max(0.0, *drop - clearance);
        return lifted;
    }
    return pose;
}

}  // namespace

Result<Transform> place_on_ray(SessionState& state, const Entity& entity, Vec3 origin, Vec3 direction) {
    if (length(direction) < 1e-9) return Error{"drop.direction", "must not be zero"};
    const Surface surface = find_surface(*state.simulation, origin, normalized(direction));
    std::optional<Probe> probe;
    if (Result<void> put = Probe::put(state, entity, probe); !put.ok()) return put.error();
    Transform pose = entity.pose;
    pose.position = surface.position;
    probe->move_to(pose);
    const Bounds bounds = probe->bounds();
    if (bounds.is_empty() || !is_finite(bounds.size())) return pose;

    // Floor: the lowest point goes on the surface.
    if (surface.normal.y > steepest_floor) {
        pose.position.y += surface.position.y - bounds.lower.y;
        return lower_until_touching(state, *probe, pose);
    }

    // Ceiling or wall: moved along the normal, by the part of the bounds that would be behind the surface.
    const Vec3 half = bounds.half_extents();
    const Vec3 n = surface.normal;
    const double reach = std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z;
    pose.position = surface.position + n * (reach + wall_gap) + (surface.position - bounds.center());
    const Result<attributes::AttributeSet> set = state.simulation->attributes(entity.index);
    const std::string usual_place = set.ok() ? set.value().word("placement", "floor") : "floor";
    if (n.y < -steepest_floor || usual_place == "wall" || usual_place == "ceiling") return pose;

    // A thing whose placement is the floor stands in front of the wall.
    probe->move_to(pose);
    const std::optional<double> drop = state.simulation->world().drop_distance(probe->body(), max_ray_length);
    if (drop && *drop > 1e-6) pose.position.y -= std::max(0.0, *drop - clearance);
    return pose;
}

namespace {

Result<json> drop_to_floor(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    need_indices(reader, state, indices);
    if (!reader.finish()) return *error;
    if (Result<void> free = state.check_unlocked(indices); !free.ok()) return free.error();

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
    static constexpr Command commands[] = {{"entity.drop_to_floor", drop_to_floor}, {"scene.pick", pick}};
    return commands;
}

}  // namespace embody::scene
