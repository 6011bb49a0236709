// SPDX-License-Identifier: MIT
#include "physics/inter/debug_contacts.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "physics/collision/queries/ball_touch.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

void add_springs(const DeformableRecord& record, std::span<const TouchSpring> springs, double dt,
                 std::vector<DrawnContact>& contacts) {
    const std::vector<Vec3>& place = record.nodes().position;
    for (const TouchSpring& spring : springs) {
        if (!spring.acts || spring.is_attachment) continue;
        Vec3 point = -record.definition.contact_radius * spring.normal;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
            point += spring.weight[k] * place[spring.node[k]];
        contacts.push_back({point, spring.normal, dt * spring.felt, TouchKind::deformable});
    }
}

void add_solid_contacts(const DeformableRecord& record, double dt, std::vector<DrawnContact>& contacts) {
    const std::vector<Vec3>& place = record.nodes().position;
    for (const SolidContact& contact : record.contacts) {
        if (contact.holds) continue;
        Vec3 point = -contact.radius * contact.normal;
        for (std::size_t k = 0; k < contact.point.count; ++k)
            point += contact.point.weight[k] * place[contact.point.node[k]];
        contacts.push_back({point, contact.normal, dt * contact.force, TouchKind::deformable});
    }
}

void add_thin_contacts(const ThinContacts& all, double dt, std::vector<DrawnContact>& contacts) {
    for (const auto& [slots, pair] : all) {
        for (const ThinContact& contact : pair) {
            if (contact.push > 0)
                contacts.push_back({contact.place, contact.normal, dt * contact.force, TouchKind::deformable});
        }
    }
}

/// The particles of one fluid beside one body after the other.
class ParticleTouches {
public:
    ParticleTouches(const FluidRecord& fluid, const CollisionShape& ball, double radius,
                    std::vector<DrawnContact>& contacts)
        : fluid_(fluid), ball_(ball), radius_(radius), contacts_(contacts) {}

    // Each particle at the nearest place of the body, where its ball reaches that.
    void add(const CollisionShape& shape, const Transform& pose) {
        const Bounds near = enlarged(shape.bounds(pose), radius_);
        for (const Vec3f position : fluid_.positions) {
            const Vec3 center = fluid_.solver->origin() + position;
            if (!contains(near, center)) continue;
            touches_.clear();
            find_ball_touches(ball_, radius_, center, shape, pose, radius_, touches_);
            const auto nearest = std::ranges::min_element(touches_, {}, &BallTouch::gap);
            if (nearest == touches_.end() || nearest->gap > 0) continue;
            contacts_.push_back(
                {center - (radius_ + nearest->gap) * nearest->normal, nearest->normal, {}, TouchKind::fluid});
        }
    }

private:
    const FluidRecord& fluid_;
    const CollisionShape& ball_;
    double radius_;
    std::vector<DrawnContact>& contacts_;
    std::vector<BallTouch> touches_;
};

}  // namespace

void add_contacts_of_deformables(const WorldState& world, std::vector<DrawnContact>& contacts) {
    const double dt = world.settings.time_step;
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        const DeformableRecord& record = world.deformables.records.at(slot);
        if (!record.definition.enabled) continue;
        if (record.solid()) add_solid_contacts(record, dt, contacts);
        if (const ClothSheet* cloth = record.cloth()) add_springs(record, cloth->springs(), dt, contacts);
        if (const RopeLine* rope = record.rope()) add_springs(record, rope->springs(), dt, contacts);
    }
    add_thin_contacts(world.deformables.thin_contacts, dt, contacts);
}

void add_contacts_of_particles(const WorldState& world, std::vector<DrawnContact>& contacts) {
    for (std::uint32_t slot = 0; slot < world.fluids.records.slot_count(); ++slot) {
        if (!world.fluids.records.used(slot)) continue;
        const FluidRecord& fluid = world.fluids.records.at(slot);
        // As far as the next particle: those that lie in the first layer.
        const double radius = std::cbrt(fluid.solver->properties().particle_volume);
        const auto ball = CollisionShape::create(SphereShape{radius});
        if (!ball) continue;
        ParticleTouches touches(fluid, **ball, radius, contacts);
        for (const auto& [body, seen] : fluid.seen) {
            if (!world.rigid.is_used(body) || !world.rigid.record(body).shape) continue;
            touches.add(*world.rigid.record(body).shape, world.rigid.pose(body));
        }
    }
}

std::vector<FluidPush> pushes_of_fluids(const WorldState& world) {
    std::vector<FluidPush> pushes;
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.is_used(body) || !world.rigid.is_dynamic(body)) continue;
        const Vec3 force = world.rigid.record(body).fluid_force;
        if (force != Vec3{}) pushes.push_back({world.rigid.motion[body].center, world.settings.time_step * force});
    }
    return pushes;
}

}  // namespace embody::physics
