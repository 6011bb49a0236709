// SPDX-License-Identifier: MIT
#include <algorithm>
#include <tuple>

#include "attributes/physical_kind.h"
#include "physics/definitions/grain_material.h"
#include "scene/document/document_field.h"
#include "scene/embody/entity_body.h"
#include "scene/matter/fluid_body.h"
#include "scene/matter/liquid_notes.h"
#include "scene/matter/soft_nodes.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

using attributes::AttributeSet;
using physics::BodyHandle;
using physics::ShapeHandle;

Error of_entity(const Entity& entity, Error error) {
    std::string who = "entity " + std::to_string(entity.index);
    if (!entity.name.empty()) who += " (" + entity.name + ")";
    // An inner function may have named the entity already.
    if (error.where.starts_with(who)) return error;
    error.where = entity_field(error.where);
    return in_place(who, std::move(error));
}

const LiveEntity* Simulation::State::find(EntityIndex index) const {
    const auto found = live.find(index);
    return found == live.end() ? nullptr : &found->second;
}

LiveEntity* Simulation::State::find(EntityIndex index) {
    return const_cast<LiveEntity*>(std::as_const(*this).find(index));
}

// Definition of the entity; nothing of it is in the world yet.
Result<LiveEntity> Simulation::State::describe(const Entity& entity) {
    LiveEntity described;
    described.definition = entity;
    if (Result<void> valid = check_ports(entity); !valid.ok()) return valid.error();
    Result<SharedAttributes> set = definitions.attributes.shared(entity);
    if (!set.ok()) return set.error();
    described.attributes = std::move(set).value();
    const AttributeSet& attributes = *described.attributes;
    described.frame = entity.pose;
    described.form = definitions.points.form(entity, attributes, is_held_as_body(entity.index, kind_of(attributes)));
    if (described.form.has_points && entity.torque != Vec3{})
        described.form.note = "is not turned by its torque, because it is not one rigid body";
    if (described.form.has_points && entity.kept) {
        if (const Result<void> fits = check_kept(*entity.kept, described.form.kept_fit); !fits.ok()) {
            described.definition.kept.reset();
            described.form.note = "begins as modelled, because " + fits.error().where + " " + fits.error().why;
        }
    }
    if (!described.form.has_points) described.shape_key = scene::shape_key(entity, attributes);
    return described;
}

// Makes the shape, which completes the body's definition.
Result<physics::BodyDefinition> Simulation::State::prepare_body(LiveEntity& entity) {
    Result<physics::BodyDefinition> made =
        body_of(entity.definition, *entity.attributes, definitions.models.taxonomy());
    if (!made.ok()) return made.error();
    const auto shape = shapes.take(entity.shape_key,
                                   [&] { return shape_of(entity.definition, *entity.attributes, definitions.models); });
    if (!shape.ok()) return shape.error();
    made.value().shape = entity.shape = shape.value();
    return made;
}

Result<void> Simulation::State::put_body(LiveEntity& entity) {
    const Result<physics::BodyDefinition> body = prepare_body(entity);
    if (!body.ok()) return body.error();
    const Result<BodyHandle> handle = world->create_body(body.value());
    if (!handle.ok()) {
        shapes.release(entity.shape_key, entity.shape);
        return handle.error();
    }
    entity.body = handle.value();
    return {};
}

Result<void> Simulation::State::put_points(LiveEntity& entity) {
    const Result<PointsDefinition> definition = definitions.points.definition(entity.definition, *entity.attributes);
    if (!definition.ok()) return definition.error();
    Result<std::unique_ptr<MovingPoints>> points = make_points(*world, liquids, definition.value());
    if (!points.ok()) return points.error();
    entity.points = std::move(points).value();
    SoftNodes* soft = as_soft(entity.points.get());
    if (soft != nullptr && entity.definition.kept) {
        std::vector<Vec3> places = places_of(*entity.definition.kept);
        for (Vec3& place : places) place = transform_point(entity.definition.pose, place);
        if (Result<void> put = soft->begin_as(places, lasting_of(*entity.definition.kept)); !put.ok()) return put;
    }
    if (const auto* grains = std::get_if<GrainDefinition>(&definition.value()))
        finest_grain = std::min(finest_grain, grains->diameter);
    const auto* liquid = std::get_if<LiquidDefinition>(&definition.value());
    if (liquid != nullptr && entity.form.note.empty())
        entity.form.note = note_of(*liquid, *as_liquid(entity.points.get()));
    return apply_settings();
}

Result<void> Simulation::State::put(LiveEntity& entity) {
    return entity.form.has_points ? put_points(entity) : put_body(entity);
}

void Simulation::State::take_out(LiveEntity& entity) {
    entity.points.reset();
    if (entity.body.is_null()) return;
    // The body is in the world, so that the world does not refuse.
    (void)world->destroy_body(entity.body).ok();
    shapes.release(entity.shape_key, entity.shape);
}

Result<void> Simulation::State::apply_settings() {
    physics::WorldSettings finer = settings;
    if (finest_grain < 1e300) finer.substeps = physics::substeps_for_grains(finest_grain, settings);
    return finer.substeps == world->settings().substeps ? Result<void>{} : world->set_settings(finer);
}

Result<void> Simulation::State::add(const Entity& entity) {
    if (live.contains(entity.index)) return of_entity(entity, {"index", "is in the world already"});
    Result<LiveEntity> described = describe(entity);
    if (!described.ok()) return of_entity(entity, described.error());
    if (const Result<void> placed = put(described.value()); !placed.ok()) return of_entity(entity, placed.error());
    const LiveEntity& added = live.emplace(entity.index, std::move(described).value()).first->second;
    holds.add_pins(entity.index, entity.pins);
    list_remarkable(added);
    list_ports(added);
    indices.insert(std::lower_bound(indices.begin(), indices.end(), entity.index), entity.index);
    return {};
}

Transform Simulation::State::pose_of(const LiveEntity& entity) const {
    if (const SoftNodes* soft = as_soft(entity.points.get())) return soft->pose();
    return entity.points ? entity.frame : world->pose(entity.body);
}

// Velocity of its centre of mass, and angular velocity.
std::pair<Vec3, Vec3> Simulation::State::motion_of(const LiveEntity& entity) const {
    if (entity.points) return {entity.points->linear_velocity(), entity.points->angular_velocity()};
    return {world->linear_velocity(entity.body), world->angular_velocity(entity.body)};
}

// The body stays and gets the new definition.
Result<void> Simulation::State::update_body(LiveEntity& before, LiveEntity& after, bool keep_motion) {
    Result<physics::BodyDefinition> body = prepare_body(after);
    if (!body.ok()) return body.error();
    after.body = before.body;
    if (keep_motion) {
        const Transform pose = world->pose(before.body);
        body.value().position = pose.position;
        body.value().rotation = pose.rotation;
        std::tie(body.value().linear_velocity, body.value().angular_velocity) = motion_of(before);
        body.value().start_asleep = false;
    }
    if (const Result<void> changed = world->set_body(before.body, body.value()); !changed.ok()) {
        shapes.release(after.shape_key, after.shape);
        return changed.error();
    }
    shapes.release(before.shape_key, before.shape);
    return {};
}

// The points stay and get other matter; nodes that its pins hold to others stay held where they are.
Result<void> Simulation::State::update_points(LiveEntity& before, LiveEntity& after) {
    Result<PointsDefinition> definition = definitions.points.definition(after.definition, *after.attributes);
    if (!definition.ok()) return definition.error();
    const bool same_pins = before.definition.pins == after.definition.pins;
    auto* deformable = std::get_if<physics::DeformableDefinition>(&definition.value());
    if (deformable && same_pins) {
        Holds held = as_soft(before.points.get())->holds();
        deformable->attachments = std::move(held.attachments);
        deformable->clamps = std::move(held.clamps);
        deformable->ties = std::move(held.ties);
    }
    if (Result<void> set = before.points->set_definition(definition.value()); !set.ok()) return set;
    after.points = std::move(before.points);
    after.frame = before.frame;
    return same_pins ? Result<void>{} : fasten(after);
}

// Another kind, or other points: the entity is made again at its present pose.
Result<void> Simulation::State::replace(LiveEntity& before, LiveEntity& after, bool keep_motion) {
    if (after.form.has_points && is_held_as_body(before.definition.index, kind_of(*after.attributes)))
        return Error{"attributes.kind", "grains cannot be held by a joint or a pin", "remove that first"};
    const Entity document = after.definition;
    if (keep_motion) {
        after.definition.pose = after.frame = pose_of(before);
        std::tie(after.definition.linear_velocity, after.definition.angular_velocity) = motion_of(before);
    }
    // Liquid fills only free space and joins existing liquid, so that the old points are disabled meanwhile.
    const bool hides =
        before.definition.enabled && (!before.points || matter_of(*before.attributes) == attributes::Matter::liquid);
    const auto show = [&](bool shown) {
        return before.points ? before.points->set_enabled(shown) : world->set_enabled(before.body, shown);
    };
    if (hides) {
        if (Result<void> hidden = show(false); !hidden.ok()) return hidden;
    }
    Result<void> placed = put(after);
    if (placed.ok()) placed = fasten(after);
    after.definition = document;
    if (!placed.ok()) {
        take_out(after);
        if (Result<void> shown = hides ? show(true) : Result<void>{}; !shown.ok()) return shown;
        return placed;
    }
    take_out(before);
    return {};
}

Result<void> Simulation::State::update(const Entity& entity, bool keep_motion) {
    LiveEntity* before = find(entity.index);
    if (!before) return of_entity(entity, {"index", "is not in the world"});
    Result<LiveEntity> described = describe(entity);
    if (!described.ok()) return of_entity(entity, described.error());
    LiveEntity& after = described.value();
    const bool both_bodies = !before->points && !after.form.has_points;
    const bool same_points = before->points && after.form.has_points && after.form.points_key.is_shared() &&
                             after.form.points_key == before->form.points_key && keep_motion;
    const Result<void> updated = both_bodies   ? update_body(*before, after, keep_motion)
                                 : same_points ? update_points(*before, after)
                                               : replace(*before, after, keep_motion);
    if (!updated.ok()) return of_entity(entity, updated.error());
    const bool is_new = !both_bodies && !same_points;
    const std::vector<Pin> pins_before = before->definition.pins;
    holds.remove_pins(entity.index, pins_before);
    *before = std::move(after);
    holds.add_pins(entity.index, entity.pins);
    list_remarkable(*before);
    list_ports(*before);
    return fasten_to(*before, pins_before, is_new);
}

void Simulation::State::remove_all(const std::vector<EntityIndex>& gone) {
    std::vector<BodyHandle> handles;
    for (const EntityIndex index : gone) {
        LiveEntity& entity = live.at(index);
        // The world removes joints together with their bodies.
        for (const std::uint32_t joint : std::set(holds.joints_of(index))) {
            holds.remove_joint(joints.at(joint).definition);
            joints.erase(joint);
        }
        entity.points.reset();
        if (!entity.body.is_null()) handles.push_back(entity.body);
    }
    // They are in the world, so that the world does not refuse.
    (void)world->destroy_bodies(handles).ok();
    for (const EntityIndex index : gone) {
        const auto found = live.find(index);
        if (!found->second.body.is_null()) shapes.release(found->second.shape_key, found->second.shape);
        holds.remove_pins(index, found->second.definition.pins);
        remarkable.erase(index);
        liquid_entities.erase(index);
        unlist_ports(index);
        live.erase(found);
    }
    const auto is_gone = [this](EntityIndex index) { return !live.contains(index); };
    if (gone.size() == 1)
        indices.erase(std::lower_bound(indices.begin(), indices.end(), gone.front()));
    else
        std::erase_if(indices, is_gone);
    std::erase_if(timed_forces, [&](const TimedForce& push) { return is_gone(push.entity); });
}

void Simulation::State::list_remarkable(const LiveEntity& entity) {
    const FluidBody* liquid = as_liquid(entity.points.get());
    if ((liquid && !liquid->fluid().is_null()) || !entity.form.note.empty())
        remarkable.insert(entity.definition.index);
    else
        remarkable.erase(entity.definition.index);
}

Result<void> Simulation::State::place(LiveEntity& entity, const Transform& pose) {
    if (!entity.points) return world->set_pose(entity.body, pose);
    if (Result<void> moved = entity.points->move(pose * inverse(pose_of(entity))); !moved.ok()) return moved;
    entity.frame = pose;
    return {};
}

Result<void> Simulation::State::set_velocity(LiveEntity& entity, Vec3 linear, Vec3 angular) {
    return entity.points ? entity.points->set_velocity(linear, angular)
                         : world->set_velocity(entity.body, linear, angular);
}

}  // namespace embody::scene
