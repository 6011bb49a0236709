// SPDX-License-Identifier: MIT
#include "physics/state/validate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "physics/state/world_state.h"

namespace embody::physics::state {

namespace {

std::string element(const char* list, std::size_t index, const char* field = "") {
    return std::string(list) + "[" + std::to_string(index) + "]" + field;
}

bool is_finite(const Mat3& m) { return embody::is_finite(m.x) && embody::is_finite(m.y) && embody::is_finite(m.z); }

bool is_unit(Quat q) {
    constexpr double tolerance = 1e-6;  // of a length that has to be 1
    return std::fabs(dot(q, q) - 1) < tolerance;
}

bool is_enabled(const RigidState& rigid, std::uint32_t body) {
    return rigid.is_used(body) && rigid.record(body).definition.enabled;
}

Result<void> validate_motion(const WorldState& world, std::uint32_t body) {
    const BodyState& state = world.rigid.motion[body];
    const BodyConstants& constants = world.rigid.constants[body];
    const auto broken = [&](const char* field, const char* why) { return Error{element("bodies", body, field), why}; };
    if (!embody::is_finite(state.center)) return broken(".center", "is not finite");
    if (!embody::is_finite(state.rotation) || !is_unit(state.rotation)) {
        return broken(".rotation", "is no quaternion of length one");
    }
    if (!embody::is_finite(state.linear_velocity)) return broken(".linear_velocity", "is not finite");
    if (!embody::is_finite(state.angular_velocity)) return broken(".angular_velocity", "is not finite");
    if (!(state.inverse_mass >= 0) || !std::isfinite(state.inverse_mass)) {
        return broken(".inverse_mass", "is negative or not finite");
    }
    if (!is_finite(state.inverse_inertia)) return broken(".inverse_inertia", "is not finite");
    if (!(constants.mass >= 0) || !std::isfinite(constants.mass)) return broken(".mass", "is negative or not finite");
    if ((state.inverse_mass > 0) != world.rigid.is_dynamic(body)) {
        return broken(".inverse_mass", "is not what its kind says");
    }
    return {};
}

// The pose at which a body's contacts were looked for: for a body that moved, the pose at the step's start.
Transform pose_in_broad_phase(const WorldState& world, std::uint32_t body) {
    const bool moves = world.rigid.record(body).definition.kind != BodyKind::static_body;
    if (!moves || world.activity.is_asleep(body)) return world.rigid.pose(body);
    BodyState start = world.rigid.motion[body];
    start.center = start.start_center;
    start.rotation = start.start_rotation;
    return body_pose(start, world.rigid.constants[body].local_center);
}

Result<void> validate_bodies(const WorldState& world) {
    const std::size_t slots = world.rigid.bodies.slot_count();
    if (world.rigid.motion.size() < slots || world.rigid.constants.size() < slots ||
        world.activity.sleep.size() < slots) {
        return Error{"bodies", "have slots without a state"};
    }
    for (std::uint32_t body = 0; body < slots; ++body) {
        if (!world.rigid.is_used(body)) continue;
        if (auto result = validate_motion(world, body); !result) return result;
        const BodyRecord& record = world.rigid.record(body);
        const ShapeRecord* shape = world.rigid.shapes.find(record.definition.shape);
        if (record.shape != (shape == nullptr ? nullptr : shape->shape.get())) {
            return Error{element("bodies", body, ".shape"), "is not the one of its definition"};
        }
        if (record.shape == nullptr || !record.definition.enabled) continue;
        const Bounds bounds = record.shape->bounds(pose_in_broad_phase(world, body));
        if (!world.contacts.broad_phase.covers(body, bounds)) {
            return Error{element("bodies", body, ".shape"), "is not within its bounds in the broad phase"};
        }
    }
    return {};
}

Result<void> validate_awake(const WorldState& world) {
    const std::vector<std::uint32_t>& awake = world.activity.awake;
    if (std::adjacent_find(awake.begin(), awake.end(), std::greater_equal<>()) != awake.end()) {
        return Error{"awake", "is not ascending"};
    }
    // Where the list is due to be made anew, bodies have fallen asleep or were frozen since it was made.
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        const bool is_listed = std::binary_search(awake.begin(), awake.end(), body);
        const bool moves =
            is_enabled(world.rigid, body) && world.rigid.record(body).definition.kind != BodyKind::static_body;
        const bool is_awake = moves && !world.activity.is_asleep(body);
        if (is_awake && !is_listed) return Error{element("bodies", body), "is awake, but not listed so"};
        if (!is_listed || is_awake || world.activity.awake_changed) continue;
        return Error{element("bodies", body), moves ? "sleeps, but is listed as awake" : "is listed, but never moves"};
    }
    return {};
}

// A contact as a step or a group of sleepers keeps it.
Result<void> validate_contact(const WorldState& world, const Contact& contact, const std::string& where) {
    const RigidState& rigid = world.rigid;
    if (contact.a >= contact.b) return Error{where, "is not between a body and one of a higher slot"};
    if (!rigid.is_used(contact.a) || !rigid.is_used(contact.b)) return Error{where, "is of a body that is not there"};
    if (!is_enabled(rigid, contact.a) || !is_enabled(rigid, contact.b)) {
        // A body that was frozen in this step loses its contacts in the next step.
        constexpr auto frozen = static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen);
        if ((world.report.limits & frozen) != 0) return {};
        return Error{where, "is of a disabled body"};
    }
    if (contact.count == 0 || contact.count > contact.points.size()) return Error{where, "has no points, or too many"};
    if (!embody::is_finite(Vec3(contact.normal)) || std::fabs(length_squared(Vec3(contact.normal)) - 1) > 1e-4) {
        return Error{where + ".normal", "has not length one"};
    }
    for (std::size_t i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[i];
        const bool is_good = embody::is_finite(Vec3(point.arm_a)) && embody::is_finite(Vec3(point.arm_b)) &&
                             std::isfinite(point.separation) && std::isfinite(point.impulse);
        if (!is_good) return Error{where + ".points", "are not finite"};
        if (point.impulse < 0) return Error{where + ".points", "are pulled"};
    }
    return {};
}

Result<void> validate_contacts(const WorldState& world, const std::vector<Contact>& contacts, const std::string& list) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const std::string where = element(list.c_str(), i);
        if (auto result = validate_contact(world, contacts[i], where); !result) return result;
        if (i > 0 && !(contact_key(contacts[i - 1]) < contact_key(contacts[i]))) {
            return Error{where, "is not sorted, or there twice"};
        }
    }
    return {};
}

Result<void> validate_summaries(const WorldState& world) {
    const ContactState& contacts = world.contacts;
    if (contacts.summaries.size() != contacts.list.size()) {
        return Error{"contacts", "have not one summary each"};
    }
    for (std::size_t i = 0; i < contacts.list.size(); ++i) {
        const Contact& contact = contacts.list[i];
        const ContactSummary& summary = contacts.summaries[i];
        if (summary.a != contact.a || summary.b != contact.b || summary.count != contact.count) {
            return Error{element("contacts", i), "is not what its summary says"};
        }
    }
    return {};
}

Result<void> validate_sleepers(const WorldState& world) {
    thread_local std::vector<std::uint8_t> is_listed;  // kept, as steady steps allocate nothing
    is_listed.assign(world.rigid.bodies.slot_count(), 0);
    for (const auto& [group, sleepers] : world.activity.sleepers) {
        const std::string name = element("sleepers", group);
        if (sleepers.bodies.empty()) return Error{name, "is empty"};
        if (group >= world.activity.next_group) return Error{name, "has a number that was not given yet"};
        for (const std::uint32_t body : sleepers.bodies) {
            const std::string where = name + ".bodies: " + std::to_string(body);
            if (!is_enabled(world.rigid, body)) return Error{where, "is not there"};
            if (!world.activity.is_asleep(body)) return Error{where, "is awake"};
            if (world.activity.sleep[body].group != group) return Error{where, "is said to be in another group"};
            if (is_listed[body]) return Error{where, "is in two groups"};
            is_listed[body] = 1;
        }
        if (auto result = validate_contacts(world, sleepers.contacts, name + ".contacts"); !result) return result;
    }
    for (std::uint32_t body = 0; body < is_listed.size(); ++body) {
        if (is_enabled(world.rigid, body) && world.activity.is_asleep(body) && !is_listed[body]) {
            return Error{element("bodies", body), "sleeps in no group"};
        }
    }
    return {};
}

Result<void> validate_islands(const WorldState& world) {
    const Islands& islands = world.islands;
    thread_local std::vector<std::uint32_t> bodies;
    bodies.assign(islands.bodies.begin(), islands.bodies.end());
    std::ranges::sort(bodies);
    if (std::ranges::adjacent_find(bodies) != bodies.end()) return Error{"islands", "share a body"};
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < islands.list.size(); ++i) {
        const Island& island = islands.list[i];
        if (island.first_body != first || island.body_count == 0) {
            return Error{element("islands", i), "does not begin where the one before ends, or is empty"};
        }
        first += island.body_count;
        if (first > islands.bodies.size()) return Error{element("islands", i), "has bodies that are not listed"};
    }
    return {};
}

Result<void> validate_joints(const WorldState& world) {
    const auto& records = world.joints.records;
    for (std::uint32_t slot = 0; slot < records.slot_count(); ++slot) {
        if (!records.used(slot)) continue;
        const JointRecord& record = records.at(slot);
        const JointDefinition& definition = record.definition;
        const bool has_both = world.rigid.bodies.contains(definition.body_b) &&
                              (definition.body_a.is_null() || world.rigid.bodies.contains(definition.body_a));
        if (!has_both) return Error{element("joints", slot), "holds a body that is not there"};
        const Joint& joint = record.constraint;
        const bool is_same = joint.b == definition.body_b.index && joint.a_is_world == definition.body_a.is_null() &&
                             (joint.a_is_world || joint.a == definition.body_a.index);
        if (!is_same) return Error{element("joints", slot), "holds other bodies than its definition says"};
        const auto moves = [&](std::uint32_t body) {
            return is_enabled(world.rigid, body) && world.rigid.is_dynamic(body);
        };
        const bool both_move = !joint.a_is_world && moves(joint.a) && moves(joint.b);
        if (both_move && world.activity.is_asleep(joint.a) != world.activity.is_asleep(joint.b)) {
            return Error{element("joints", slot), "holds a sleeper and one that is awake"};
        }
        if (!embody::is_finite(joint.total_linear) || !embody::is_finite(joint.total_angular)) {
            return Error{element("joints", slot), "has impulses that are not finite"};
        }
    }
    if (world.joints.active.size() != world.joints.active_slots.size()) {
        return Error{"joints", "that are solved have not one slot each"};
    }
    return {};
}

Result<void> validate_deformables(const WorldState& world) {
    const auto& records = world.deformables.records;
    for (std::uint32_t slot = 0; slot < records.slot_count(); ++slot) {
        if (!records.used(slot)) continue;
        const Nodes& nodes = records.at(slot).nodes();
        const std::string where = element("deformables", slot);
        const std::size_t count = nodes.size();
        if (nodes.velocity.size() != count || nodes.mass.size() != count || nodes.inverse_mass.size() != count) {
            return Error{where, "has nodes without a velocity or mass"};
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (!embody::is_finite(nodes.position[i]) || !embody::is_finite(nodes.velocity[i])) {
                return Error{where + element(".nodes", i), "is not finite"};
            }
            if (!(nodes.inverse_mass[i] >= 0)) return Error{where + element(".nodes", i), "has no mass"};
        }
    }
    return {};
}

Result<void> validate_fluids(const WorldState& world) {
    const auto& records = world.fluids.records;
    for (std::uint32_t slot = 0; slot < records.slot_count(); ++slot) {
        if (!records.used(slot)) continue;
        const FluidRecord& fluid = records.at(slot);
        const std::string where = element("fluids", slot);
        if (fluid.velocities.size() != fluid.positions.size() || fluid.ids.size() != fluid.positions.size()) {
            return Error{where, "has particles without a velocity or id"};
        }
        for (std::size_t i = 0; i < fluid.positions.size(); ++i) {
            if (!embody::is_finite(Vec3(fluid.positions[i])) || !embody::is_finite(Vec3(fluid.velocities[i]))) {
                return Error{where + element(".particles", i), "is not finite"};
            }
        }
        std::vector<std::uint32_t> ids = fluid.ids;
        std::ranges::sort(ids);
        if (std::ranges::adjacent_find(ids) != ids.end()) return Error{where, "has two particles of one id"};
    }
    return {};
}

Result<void> validate_events(const WorldState& world) {
    const std::vector<TouchingPair>& touching = world.events.touching;
    for (std::size_t i = 0; i < touching.size(); ++i) {
        if (i > 0 && !(touching[i - 1] < touching[i])) {
            return Error{element("touching", i), "is not sorted, or there twice"};
        }
        if (!world.rigid.bodies.contains(touching[i].a) || !world.rigid.bodies.contains(touching[i].b)) {
            return Error{element("touching", i), "is of a body that is not there"};
        }
    }
    return {};
}

}  // namespace

Result<void> validate(const WorldState& world) {
    if (auto result = validate_bodies(world); !result) return result;
    if (auto result = validate_awake(world); !result) return result;
    if (auto result = validate_contacts(world, world.contacts.list, "contacts"); !result) return result;
    if (auto result = validate_summaries(world); !result) return result;
    if (auto result = validate_sleepers(world); !result) return result;
    if (auto result = validate_islands(world); !result) return result;
    if (auto result = validate_joints(world); !result) return result;
    if (auto result = validate_deformables(world); !result) return result;
    if (auto result = validate_fluids(world); !result) return result;
    return validate_events(world);
}

}  // namespace embody::physics::state
