// SPDX-License-Identifier: MIT
#include "scene/session/building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <type_traits>

#include "scene/embody/wall_joints.h"

namespace embody::scene {

namespace {

using physics::ShapeDefinition;
using physics::WallOpening;
using physics::WallShape;

// Categories of the taxonomy: what stands in a wall. Doors stand on its foot.
constexpr auto doors = std::to_array<std::string_view>({"door", "glass door", "garage door", "opening"});
constexpr auto windows = std::to_array<std::string_view>({"window"});

bool is_in(std::span<const std::string_view> list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

template <class AnyGeometry>
auto* wall_in(AnyGeometry& geometry) {
    using Shape = std::conditional_t<std::is_const_v<AnyGeometry>, const ShapeDefinition, ShapeDefinition>;
    Shape* shape = std::get_if<ShapeDefinition>(&geometry);
    return shape ? std::get_if<WallShape>(shape) : nullptr;
}

/// A door or a window, as far as its wall needs to know it.
struct Fitting {
    bool is_door = false;
    Vec3 size;    ///< m
    Vec3 middle;  ///< of its base, in its frame
};

// None where it is neither, or where its model is not there yet.
std::optional<Fitting> fitting_of(SessionState& state, const Entity& entity) {
    std::string category = entity.category, subcategory;
    Fitting fitting;
    if (const auto* shape = std::get_if<ShapeDefinition>(&entity.geometry)) {
        if (!is_in(doors, category) && !is_in(windows, category)) return std::nullopt;
        const Bounds bounds = box_around(*shape);
        if (bounds.is_empty()) return std::nullopt;
        fitting.size = bounds.size();
        fitting.middle = {bounds.center().x, bounds.lower.y, bounds.center().z};
    } else {
        const Result<const KnownModel*> model =
            state.definitions.models.find(std::get<ModelReference>(entity.geometry).key);
        if (!model.ok()) return std::nullopt;
        category = model.value()->summary.category;
        subcategory = model.value()->summary.subcategory;
        fitting.size = model.value()->facts.geometry.size * entity.scale;
    }
    fitting.is_door = is_in(doors, category) || is_in(doors, subcategory);
    const bool is_window = category == "window" && (subcategory.empty() || is_in(windows, subcategory));
    if (!fitting.is_door && !is_window) return std::nullopt;
    return fitting;
}

/// The document as an edit leaves it, with what the walls need besides.
class Completion {
public:
    Completion(SessionState& state, Edit& edit) : state_(state), edit_(edit), walls_(state.lookup.walls) {}

    void run() {
        for (const Change& change : edit_.changes) note(change);
        if (walls_.empty() && former_walls_.empty()) return;
        move_fittings();
        follow_fittings();
        join_corners();
        write();
    }

private:
    void note(const Change& change);
    void note_wall(const Entity& entity);
    // Nobody knows yet what it is: its opening stays.
    [[nodiscard]] bool waits_for_model(const Entity& entity) const {
        const auto* model = std::get_if<ModelReference>(&entity.geometry);
        return model && !state_.definitions.models.find(model->key).ok();
    }
    void move_fittings();
    void follow_fittings();
    void put_opening(EntityIndex index, const Entity& entity);
    void join_corners();
    void write();

    [[nodiscard]] const Entity* find(EntityIndex index) const {
        const auto found = now_.find(index);
        if (found == now_.end()) return state_.document.find(index);
        return found->second ? &*found->second : nullptr;
    }
    // The entity, to be changed.
    Entity& change(EntityIndex index) {
        auto [found, is_new] = now_.try_emplace(index);
        if (is_new) found->second = *state_.document.find(index);
        changed_.insert(index);
        return *found->second;
    }

    SessionState& state_;
    Edit& edit_;
    std::set<EntityIndex> walls_;                       // in the document as it will be
    std::map<EntityIndex, std::optional<Entity>> now_;  // what the edit changes, as it will be
    std::map<EntityIndex, Entity> former_walls_;        // that the edit moves, reshapes or removes, as they were
    std::set<EntityIndex> touched_;                     // by the edit
    std::set<EntityIndex> changed_;                     // by the completion
    std::vector<Vec3> corners_;                         // where ends of walls came or went
};

void Completion::note_wall(const Entity& entity) {
    if (!is_upright(entity.pose)) return;
    WallShape wall = *wall_in(entity.geometry);
    for (const bool is_end : {false, true}) corners_.push_back(point_of({&wall, entity.pose, is_end}));
}

void Completion::note(const Change& change) {
    EntityIndex index = 0;
    std::optional<Entity> after;
    if (const auto* pose = std::get_if<PoseChange>(&change)) {
        index = pose->index;
        if (const Entity* entity = find(index)) after = *entity;
        if (after) after->pose = pose->after;
    } else if (const auto* entity = std::get_if<EntityChange>(&change)) {
        index = entity->before ? entity->before->index : entity->after->index;
        if (entity->after) after = *entity->after;
        if (after && entity->same_geometry) after->geometry = find(index)->geometry;
    } else {
        return;
    }
    const Entity* before = state_.document.find(index);
    if (before && wall_in(before->geometry) && former_walls_.emplace(index, *before).second) note_wall(*before);
    walls_.erase(index);
    if (after && wall_in(after->geometry)) {
        walls_.insert(index);
        note_wall(*after);
    }
    now_[index] = std::move(after);
    touched_.insert(index);
}

// What stands in a wall goes with it, unless the edit says where it goes.
void Completion::move_fittings() {
    for (const auto& [index, before] : former_walls_) {
        const Entity* after = find(index);
        if (!after || after->pose == before.pose) continue;
        for (const WallOpening& opening : wall_in(before.geometry)->openings) {
            if (opening.owner == 0 || touched_.contains(opening.owner) || !find(opening.owner)) continue;
            Entity& fitting = change(opening.owner);
            fitting.pose = after->pose * (inverse(before.pose) * fitting.pose);
            touched_.insert(opening.owner);
        }
    }
}

void Completion::follow_fittings() {
    // Openings whose thing has gone, or may have: they are made anew where it stands.
    std::set<EntityIndex> fittings;
    for (const EntityIndex index : walls_) {
        const bool is_touched = touched_.contains(index);
        const auto& openings = wall_in(find(index)->geometry)->openings;
        const bool is_stale = std::any_of(openings.begin(), openings.end(), [&](const WallOpening& opening) {
            return opening.owner != 0 && (is_touched || touched_.contains(opening.owner));
        });
        if (!is_stale) continue;
        std::vector<WallOpening> kept;
        for (const WallOpening& opening : openings) {
            const Entity* owner = opening.owner != 0 ? find(opening.owner) : nullptr;
            const bool is_known = owner && fitting_of(state_, *owner);
            if (is_known) fittings.insert(opening.owner);
            if (opening.owner == 0 || (owner && waits_for_model(*owner))) kept.push_back(opening);
        }
        if (kept != openings) wall_in(change(index).geometry)->openings = std::move(kept);
    }
    for (const EntityIndex index : touched_)
        if (const Entity* entity = find(index); entity && fitting_of(state_, *entity)) fittings.insert(index);
    for (const EntityIndex index : fittings) put_opening(index, *find(index));
}

void Completion::put_opening(EntityIndex index, const Entity& entity) {
    const std::optional<Fitting> fitting = fitting_of(state_, entity);
    const Transform place{transform_point(entity.pose, fitting->middle), entity.pose.rotation};
    for (const EntityIndex wall_index : walls_) {
        const Entity& wall = *find(wall_index);
        auto opening = opening_of(*wall_in(wall.geometry), inverse(wall.pose) * place, fitting->size);
        if (!opening) continue;
        opening->owner = index;
        WallShape cut = *wall_in(wall.geometry);
        cut.openings.push_back(*opening);
        // What would leave nothing of the wall cuts nothing.
        if (physics::validate(cut).ok()) *wall_in(change(wall_index).geometry) = std::move(cut);
        return;
    }
}

void Completion::join_corners() {
    std::sort(corners_.begin(), corners_.end(), [](Vec3 a, Vec3 b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    });
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    for (const Vec3 corner : corners_) {
        std::vector<std::pair<EntityIndex, WallShape>> shapes;
        std::vector<std::pair<std::size_t, WallEnd>> found;
        for (const EntityIndex index : walls_) {
            const Entity& entity = *find(index);
            if (!is_upright(entity.pose)) continue;
            WallShape copy = *wall_in(entity.geometry);
            bool is_here = false;
            for (const bool is_end : {false, true}) {
                if (distance(point_of({&copy, entity.pose, is_end}), corner) > joint_reach) continue;
                found.push_back({shapes.size(), {nullptr, entity.pose, is_end}});
                is_here = true;
            }
            if (is_here) shapes.emplace_back(index, std::move(copy));
        }
        std::vector<WallEnd> ends;
        for (auto& [shape, end] : found) {
            end.wall = &shapes[shape].second;
            ends.push_back(end);
        }
        mitre(ends);
        for (const auto& [index, shape] : shapes) {
            if (shape == *wall_in(find(index)->geometry) || !physics::validate(shape).ok()) continue;
            *wall_in(change(index).geometry) = shape;
        }
    }
}

void Completion::write() {
    for (const EntityIndex index : changed_) {
        const Entity& after = *find(index);
        // Into the edit's own change of the whole entity, else as one more.
        const auto own = std::find_if(edit_.changes.rbegin(), edit_.changes.rend(), [index](const Change& change) {
            const auto* pose = std::get_if<PoseChange>(&change);
            if (pose) return pose->index == index;
            const auto* entity = std::get_if<EntityChange>(&change);
            return entity && (entity->after ? entity->after->index : entity->before->index) == index;
        });
        EntityChange* whole = own == edit_.changes.rend() ? nullptr : std::get_if<EntityChange>(&*own);
        if (whole && !whole->same_geometry) {
            whole->after = after;
            continue;
        }
        Entity before = *state_.document.find(index);
        if (own != edit_.changes.rend()) {
            const Geometry geometry = before.geometry;
            if (whole)
                before = *whole->after;
            else
                before.pose = std::get<PoseChange>(*own).after;
            before.geometry = geometry;
        }
        if (before.geometry == after.geometry)
            edit_.changes.emplace_back(PoseChange{index, before.pose, after.pose});
        else
            edit_.changes.emplace_back(EntityChange{std::move(before), after});
    }
}

}  // namespace

void complete_building(SessionState& state, Edit& edit) { Completion(state, edit).run(); }

bool are_same_wall(const Geometry& a, const Geometry& b) {
    const WallShape* one = wall_in(a);
    const WallShape* other = wall_in(b);
    if (!one || !other) return false;
    WallShape alike = *other;
    alike.openings = one->openings;
    alike.start_cut = one->start_cut;
    alike.end_cut = one->end_cut;
    return alike == *one;
}

std::optional<Placement> place_in_wall(SessionState& state, const Entity& entity, const PointerRay& ray,
                                       double nearest) {
    const std::optional<Fitting> fitting = fitting_of(state, entity);
    if (!fitting) return std::nullopt;
    constexpr double through = 0.01;  // m: the wall itself may be what the ray met
    const Vec3 direction = normalized(ray.direction);
    std::optional<Placement> placed;
    double least = nearest + through;
    for (const EntityIndex index : state.lookup.walls) {
        const Entity& wall = *state.document.find(index);
        const WallShape& shape = *wall_in(wall.geometry);
        const Vec3 from = inverse_transform_point(wall.pose, ray.origin);
        const Vec3 along = rotate(conjugate(wall.pose.rotation), direction);
        const double side = from.z > 0 ? 1 : -1;
        if (!(along.z * side < -1e-6)) continue;
        const double gone = (side * shape.thickness / 2 - from.z) / along.z;
        const Vec3 hit = from + along * gone;
        const bool is_on = gone > 0 && gone < least && hit.x > 0 && hit.x < shape.length && hit.y > 0 &&
                           hit.y < shape.height_at(hit.x);
        if (!is_on) continue;
        least = gone;

        // Within the wall, where it is large enough.
        const Vec3 size = fitting->size;
        const auto within = [](double wanted, double room) {
            return room > 0 ? std::clamp(wanted, 0.0, room) : room / 2;
        };
        const double x = within(hit.x - size.x / 2, shape.length - size.x) + size.x / 2;
        const double y = fitting->is_door ? 0 : std::max(0.0, within(hit.y - size.y / 2, shape.height - size.y));
        const Quat turn = side > 0 ? Quat{} : from_axis_angle({0, 1, 0}, std::acos(-1.0));
        const Quat rotation = normalized(wall.pose.rotation * turn);
        const Vec3 base = transform_point(wall.pose, {x, y, 0});
        placed = Placement{{base - rotate(rotation, fitting->middle), rotation}, index, Seat::wall};
    }
    return placed;
}

}  // namespace embody::scene
