// SPDX-License-Identifier: MIT
#include "physics/inter/debug_draw.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "physics/collision/shapes/outline.h"
#include "physics/inter/debug_canvas.h"
#include "physics/inter/debug_contacts.h"
#include "physics/inter/debug_motion.h"
#include "physics/inter/world.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

constexpr std::uint32_t no_island = 0xFFFFFFFFu;

std::uint16_t short_number(std::uint32_t number) { return static_cast<std::uint16_t>(number); }

// For each body the lowest slot in its island, for bodies that the last step found awake.
std::vector<std::uint32_t> islands_of_bodies(const WorldState& world) {
    std::vector<std::uint32_t> island(world.rigid.bodies.slot_count(), no_island);
    const auto add = [&](std::span<const std::uint32_t> bodies, bool is_asleep) {
        std::uint32_t lowest = no_island;
        const auto is_meant = [&](std::uint32_t body) {
            return world.rigid.bodies.used(body) && world.activity.is_asleep(body) == is_asleep;
        };
        for (const std::uint32_t body : bodies) {
            if (is_meant(body)) lowest = std::min(lowest, body);
        }
        for (const std::uint32_t body : bodies) {
            if (is_meant(body)) island[body] = lowest;
        }
    };
    for (const Island& of : world.islands.list)
        add(std::span(world.islands.bodies).subspan(of.first_body, of.body_count), false);
    for (const auto& [group, sleepers] : world.activity.sleepers) add(sleepers.bodies, true);
    return island;
}

DebugColor color_of(const WorldState& world, std::uint32_t body, std::span<const std::uint32_t> islands) {
    const BodyDefinition& definition = world.rigid.record(body).definition;
    const bool is_asleep = world.activity.is_asleep(body);
    if (!islands.empty() && islands[body] != no_island)
        return {DebugMeaning::island, short_number(islands[body]), is_asleep};
    if (definition.kind == BodyKind::static_body) return {DebugMeaning::static_shape, 0, !definition.enabled};
    if (definition.kind == BodyKind::kinematic_body) return {DebugMeaning::kinematic_shape, 0, !definition.enabled};
    if (is_asleep) return {DebugMeaning::asleep_shape, 0, true};
    const bool wants_to_sleep = world.activity.sleep[body].state == SleepState::wants_to_sleep;
    return {wants_to_sleep ? DebugMeaning::wants_to_sleep_shape : DebugMeaning::active_shape, 0, !definition.enabled};
}

// Moving bodies first: a large ground alone may exceed the number of lines.
void draw_shapes(const WorldState& world, DebugCanvas& canvas) {
    std::vector<std::uint32_t> islands;
    if (canvas.is_wanted(DebugDrawFlag::islands)) islands = islands_of_bodies(world);
    for (const bool is_static : {false, true}) {
        for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
            if (!world.rigid.bodies.used(body)) continue;
            const BodyRecord& record = world.rigid.record(body);
            if (!record.shape || (record.definition.kind == BodyKind::static_body) != is_static) continue;
            const DebugColor color = color_of(world, body, islands);
            outline(*record.shape, world.rigid.pose(body), canvas.options.plane_half_size,
                    [&](Vec3 from, Vec3 to) { canvas.line(from, to, color); });
        }
    }
}

Bounds bounds_of(const WorldState& world, std::uint32_t body) {
    const CollisionShape* shape = world.rigid.record(body).shape;
    return shape ? shape->bounds(world.rigid.pose(body)) : Bounds{};
}

void draw_bounds(const WorldState& world, DebugCanvas& canvas) {
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        // A plane has no end, and no box.
        if (!world.rigid.bodies.used(body) || !world.rigid.record(body).shape) continue;
        if (std::holds_alternative<PlaneShape>(world.rigid.record(body).shape->definition())) continue;
        canvas.box(bounds_of(world, body), {DebugMeaning::bounds, 0, world.activity.is_asleep(body)});
    }
}

void draw_islands(const WorldState& world, DebugCanvas& canvas) {
    const std::vector<std::uint32_t> islands = islands_of_bodies(world);
    std::map<std::uint32_t, Bounds> boxes;
    for (std::uint32_t body = 0; body < islands.size(); ++body) {
        if (islands[body] != no_island) boxes[islands[body]].add(bounds_of(world, body));
    }
    for (const auto& [number, box] : boxes)
        canvas.box(box, {DebugMeaning::island, short_number(number), world.activity.is_asleep(number)});
}

void draw_contacts(std::span<const DrawnContact> contacts, DebugCanvas& canvas) {
    for (const DrawnContact& contact : contacts) {
        const auto kind = static_cast<std::uint16_t>(contact.kind);
        canvas.point(contact.position, {DebugMeaning::contact, kind});
        canvas.line(contact.position, contact.position + canvas.options.mark_length * contact.normal,
                    {DebugMeaning::contact_normal, kind});
    }
}

void draw_impulses(std::span<const DrawnContact> contacts, std::span<const FluidPush> pushes, DebugCanvas& canvas) {
    double largest = 0;
    for (const DrawnContact& contact : contacts) largest = std::max(largest, length(contact.impulse));
    for (const FluidPush& push : pushes) largest = std::max(largest, length(push.impulse));
    const auto draw = [&](Vec3 from, Vec3 impulse, TouchKind kind) {
        if (impulse == Vec3{}) return;
        canvas.arrow(from, from + canvas.options.longest_arrow / largest * impulse,
                     {DebugMeaning::impulse, static_cast<std::uint16_t>(kind)});
    };
    for (const DrawnContact& contact : contacts) draw(contact.position, contact.impulse, contact.kind);
    for (const FluidPush& push : pushes) draw(push.center, push.impulse, TouchKind::fluid);
}

// Between bodies first, then of what bends; particles are many, and come last.
void draw_touches(const WorldState& world, std::span<const ContactView> views, DebugCanvas& canvas) {
    std::vector<DrawnContact> contacts;
    const auto is_meant = [&](BodyHandle body) {
        return canvas.is_meant(world.rigid.record(body.index).definition.user_data);
    };
    for (const ContactView& view : views)
        if (is_meant(view.a) || is_meant(view.b)) contacts.push_back({view.position, view.normal, view.impulse});
    if (!canvas.options.only.empty()) {
        // What bends and flows has no body of its own.
        if (canvas.is_wanted(DebugDrawFlag::impulses)) draw_impulses(contacts, {}, canvas);
        if (canvas.is_wanted(DebugDrawFlag::contacts)) draw_contacts(contacts, canvas);
        return;
    }
    add_contacts_of_deformables(world, contacts);
    if (canvas.is_wanted(DebugDrawFlag::impulses)) draw_impulses(contacts, pushes_of_fluids(world), canvas);
    if (!canvas.is_wanted(DebugDrawFlag::contacts)) return;
    add_contacts_of_particles(world, contacts);
    draw_contacts(contacts, canvas);
}

void draw_trees(const WorldState& world, DebugCanvas& canvas) {
    world.contacts.broad_phase.visit_boxes([&](const Bounds& box, int depth) {
        canvas.box(box, {DebugMeaning::tree, short_number(static_cast<std::uint32_t>(depth))});
    });
}

// Half the edges of the homogeneous box with this inertia, along the axes that the inertia's eigenvectors are.
void draw_masses(const WorldState& world, DebugCanvas& canvas) {
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.bodies.used(body) || !world.rigid.is_dynamic(body)) continue;
        if (!canvas.is_meant(world.rigid.record(body).definition.user_data)) continue;
        const BodyConstants& constants = world.rigid.constants[body];
        const BodyState& motion = world.rigid.motion[body];
        const bool is_dim = world.activity.is_asleep(body);
        canvas.point(motion.center, {DebugMeaning::center_of_mass, 0, is_dim});
        const SymmetricEigen eigen = eigen_symmetric(constants.inertia);
        const Vec3 axes[]{eigen.vectors.x, eigen.vectors.y, eigen.vectors.z};
        const double sum = eigen.values.x + eigen.values.y + eigen.values.z;
        for (int k = 0; k < 3; ++k) {
            const double squared = 1.5 * (sum - 2 * eigen.values[k]) / constants.mass;
            const Vec3 half = std::sqrt(std::max(squared, 0.0)) * rotate(motion.rotation, axes[k]);
            canvas.line(motion.center - half, motion.center + half,
                        {DebugMeaning::inertia_axis, short_number(static_cast<std::uint32_t>(k)), is_dim});
        }
    }
}

// Angles as a sector about X, in which Y of the second frame is.
void draw_angles(const JointLimit& limit, const Transform& frame, DebugCanvas& canvas) {
    constexpr int arc_lines = 12;  // of a whole range of angles
    const double radius = canvas.options.mark_length;
    const double range = std::min(limit.upper - limit.lower, 2 * std::numbers::pi);
    const auto at = [&](int i) {
        const double angle = limit.lower + range * i / arc_lines;
        return transform_point(frame, {0, radius * std::cos(angle), radius * std::sin(angle)});
    };
    canvas.line(frame.position, at(0), {DebugMeaning::joint_limit});
    for (int i = 0; i < arc_lines; ++i) canvas.line(at(i), at(i + 1), {DebugMeaning::joint_limit});
    canvas.line(at(arc_lines), frame.position, {DebugMeaning::joint_limit});
}

// Displacements as a line along X.
void draw_limit(const JointDefinition& joint, const Transform& frame, DebugCanvas& canvas) {
    const auto draw = [&]<class Kind>(const Kind& kind) {
        if constexpr (HasCoordinate<Kind>) {
            if (!kind.limit) return;
            if constexpr (Kind::turns) return draw_angles(*kind.limit, frame, canvas);
            canvas.line(transform_point(frame, {kind.limit->lower, 0, 0}),
                        transform_point(frame, {kind.limit->upper, 0, 0}), {DebugMeaning::joint_limit});
        }
    };
    std::visit(draw, joint.joint);
}

void draw_axes(const Transform& frame, bool is_dim, DebugCanvas& canvas) {
    const double size = canvas.options.mark_length;
    const Vec3 ends[]{{size, 0, 0}, {0, size, 0}, {0, 0, size}};
    for (std::uint16_t k = 0; k < 3; ++k)
        canvas.line(frame.position, transform_point(frame, ends[k]), {DebugMeaning::joint_axis, k, is_dim});
}

void draw_joints(const WorldState& world, DebugCanvas& canvas) {
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        const JointDefinition& definition = world.joints.records.at(slot).definition;
        const auto draw_frame = [&](BodyHandle body, const Transform& local, bool is_second) {
            const Transform frame = body.is_null() ? local : world.rigid.pose(body.index) * local;
            if (!body.is_null())
                canvas.line(world.rigid.motion[body.index].center, frame.position, {DebugMeaning::joint});
            draw_axes(frame, is_second, canvas);
            return frame;
        };
        const Transform frame = draw_frame(definition.body_a, definition.frame_a, false);
        draw_frame(definition.body_b, definition.frame_b, true);
        draw_limit(definition, frame, canvas);
    }
}

void draw_edges(const DeformableRecord& record, DebugCanvas& canvas) {
    const std::vector<Vec3>& place = record.nodes().position;
    const DebugColor color{DebugMeaning::edge, 0, record.is_asleep};
    if (const ClothSheet* cloth = record.cloth()) {
        for (const auto& [a, b] : cloth->edges()) canvas.line(place[a], place[b], color);
    } else if (const RopeLine* rope = record.rope()) {
        for (std::size_t k = 0; k + 1 < place.size(); ++k) {
            if (!rope->is_broken(k)) canvas.line(place[k], place[k + 1], color);
        }
    } else {
        // The surface is closed: each edge runs both ways, and is drawn where it runs upwards.
        for (const auto& triangle : record.solid()->surface()) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
                if (a < b) canvas.line(place[a], place[b], color);
            }
        }
    }
}

void draw_deformables(const WorldState& world, DebugCanvas& canvas) {
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        const DeformableRecord& record = world.deformables.records.at(slot);
        const Nodes& nodes = record.nodes();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const std::uint16_t is_pinned = nodes.inverse_mass[i] == 0 ? 1 : 0;
            canvas.point(nodes.position[i], {DebugMeaning::node, is_pinned, record.is_asleep});
        }
        draw_edges(record, canvas);
        for (const Attachment& held : record.definition.attachments) {
            if (!world.rigid.bodies.contains(held.body)) continue;
            canvas.line(nodes.position[held.node], transform_point(world.rigid.pose(held.body.index), held.anchor),
                        {DebugMeaning::attachment});
        }
        for (const Tie& tie : record.definition.ties) {
            const DeformableRecord* other = world.deformables.records.find(tie.other);
            if (!other) continue;
            Vec3 end;
            for (std::size_t k = 0; k < 3; ++k) {
                if (tie.weight[k] > 0) end += tie.weight[k] * other->nodes().position[tie.other_nodes[k]];
            }
            canvas.line(nodes.position[tie.node], end, {DebugMeaning::attachment});
        }
    }
}

void draw_particles(const FluidParticles& fluid, DebugCanvas& canvas) {
    for (const Vec3f position : fluid.positions)
        canvas.point(fluid.origin + position, {DebugMeaning::particle, 0, fluid.is_asleep || fluid.is_frozen});
}

}  // namespace

DebugDrawCount World::debug_draw(DebugDraw& draw, const DebugDrawOptions& options) const {
    DebugCanvas canvas(draw, options);
    if (canvas.is_wanted(DebugDrawFlag::contacts) || canvas.is_wanted(DebugDrawFlag::impulses))
        draw_touches(*state_, contacts(), canvas);
    if (canvas.is_wanted(DebugDrawFlag::velocities)) draw_velocities(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::forces)) draw_forces(*state_, contacts(), canvas);
    if (canvas.is_wanted(DebugDrawFlag::joints)) draw_joints(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::masses)) draw_masses(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::islands)) draw_islands(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::bounds)) draw_bounds(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::trees)) draw_trees(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::deformables)) draw_deformables(*state_, canvas);
    if (canvas.is_wanted(DebugDrawFlag::particles)) {
        for (const FluidHandle fluid : fluids()) draw_particles(fluid_particles(fluid), canvas);
    }
    if (canvas.is_wanted(DebugDrawFlag::shapes)) draw_shapes(*state_, canvas);
    return canvas.count();
}

}  // namespace embody::physics
