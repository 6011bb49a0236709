// SPDX-License-Identifier: MIT
// docs/physics/coupling.md, "Liquids and what bends".
#include "physics/stages/fluid/immersed_deformables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/state/deformable_state.h"
#include "physics/state/fluid_state.h"

namespace embody::physics::stages {

namespace {

using std::numbers::pi;

// Density of the fibres of cloth, kg/m³: cotton 1520, polyester 1390, wool 1310 (W. E. Morton, J. W. S. Hearle,
// "Physical Properties of Textile Fibres", 4th edition 2008, ch. 5). Liquid fills the pores between them.
constexpr double fibre_density = 1400;

/// Makes the points of one deformable.
struct PointMaker {
    const DeformableRecord& record;
    Vec3 pull;                              // m/s²
    const std::vector<Vec3>& acceleration;  // of the nodes, with what holds them, m/s²
    Bounds near;                            // where liquid may be
    double cell;                            // m
    ImmersedDeformables& to;

    // A point between nodes: its part of the element's volume, m³, and mass, kg.
    void add(const ImmersedPlace& place, double volume, double mass, const ImmersedForm& form) {
        const Nodes& nodes = record.nodes();
        ImmersedPoint point;
        point.volume = volume;
        // What sleeps only displaces its volume: a sheet that held the liquid under it would stir it.
        if (!record.is_asleep) point.form = form;
        double moving = 0;
        Vec3 held;  // m/s²
        for (std::size_t k = 0; k < place.count; ++k) {
            const std::uint32_t node = place.node[k];
            point.position += place.weight[k] * nodes.position[node];
            if (record.is_asleep || !(nodes.inverse_mass[node] > 0)) continue;
            point.velocity += place.weight[k] * nodes.mean_velocity[node];
            point.acceleration += place.weight[k] * pull;
            held += place.weight[k] * (acceleration[node] - pull);
            moving += place.weight[k];
        }
        // What held nodes have of it does not move.
        point.inverse_mass = moving / mass;
        if (moving > 0) point.support = held * (mass / moving);
        if (!contains(near, point.position)) return;
        to.points.push_back(point);
        to.places.push_back(place);
    }

    // How many points an edge of that length has: no farther apart than a cell.
    [[nodiscard]] int points_along(double edge) const {
        return static_cast<int>(std::clamp(std::ceil(edge / cell), 1.0, 100.0));
    }
};

void add_rope(PointMaker& maker) {
    const Rope& rope = std::get<Rope>(maker.record.definition.matter);
    const std::vector<Vec3>&rest = maker.record.definition.nodes, &now = maker.record.nodes().position;
    for (std::uint32_t s = 0; s + 1 < rest.size(); ++s) {
        const double own = (1 + rope.slack) * length(rest[s + 1] - rest[s]);
        const int count = maker.points_along(own);
        const double piece = own / count;
        const ImmersedForm form{DragForm::cylinder, normalized(now[s + 1] - now[s], {1, 0, 0}), rope.diameter, piece};
        for (int k = 0; k < count; ++k) {
            const double along = (k + 0.5) / count;
            maker.add({2, {s, s + 1}, {1 - along, along}}, pi / 4 * rope.diameter * rope.diameter * piece,
                      rope.linear_density * piece, form);
        }
    }
}

void add_cloth(PointMaker& maker) {
    const Cloth& cloth = std::get<Cloth>(maker.record.definition.matter);
    const std::vector<Vec3>&rest = maker.record.definition.nodes, &now = maker.record.nodes().position;
    for (const auto& [a, b, c] : cloth.triangles) {
        const double area = length(cross(rest[b] - rest[a], rest[c] - rest[a])) / 2;
        const Vec3 normal = normalized(cross(now[b] - now[a], now[c] - now[a]), {0, 1, 0});
        const double edge = std::max({length(rest[b] - rest[a]), length(rest[c] - rest[b]), length(rest[a] - rest[c])});
        const int n = maker.points_along(edge);
        const double piece = area / (n * (n + 1) / 2.0), mass = cloth.area_density * piece;
        const double volume = std::min(cloth.thickness * piece, mass / fibre_density);
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                const double u = (i + 1.0 / 3) / n, v = (j + 1.0 / 3) / n;
                maker.add({3, {a, b, c}, {1 - u - v, u, v}}, volume, mass,
                          {DragForm::sheet, normal, cloth.thickness, piece});
            }
        }
    }
}

// A solid smaller than a cell has the drag of the sphere of its volume, as a rigid body has; a larger one is met by the
// pressure.
void add_solid(PointMaker& maker) {
    const SoftSolid& solid = std::get<SoftSolid>(maker.record.definition.matter);
    const std::vector<Vec3>&rest = maker.record.definition.nodes, &now = maker.record.nodes().position;
    const auto volume_of = [](const std::vector<Vec3>& at, const std::array<std::uint32_t, 4>& t) {
        return std::fabs(dot(cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]]), at[t[3]] - at[t[0]])) / 6;
    };
    double whole = 0;
    for (const auto& corners : solid.tetrahedra) whole += volume_of(now, corners);
    const bool is_small = whole < maker.cell * maker.cell * maker.cell;
    const double diameter = std::cbrt(6 * whole / pi);
    for (const auto& corners : solid.tetrahedra) {
        double edge = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t i = 0; i < k; ++i) edge = std::max(edge, length(rest[corners[k]] - rest[corners[i]]));
        }
        const int n = maker.points_along(edge);
        const double count = n * (n + 1) * (n + 2) / 6.0;
        const double volume = volume_of(now, corners) / count, mass = solid.density * volume_of(rest, corners) / count;
        const ImmersedForm form{is_small ? DragForm::sphere : DragForm::none, {}, diameter, volume / whole};
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                for (int k = 0; i + j + k < n; ++k) {
                    const double u = (i + 0.25) / n, v = (j + 0.25) / n, w = (k + 0.25) / n;
                    maker.add({4, corners, {1 - u - v - w, u, v, w}}, volume, mass, form);
                }
            }
        }
    }
}

Vec3 no_more_than(Vec3 v, double most) {
    const double size = length(v);
    return size > most ? v * (most / size) : v;
}

Bounds liquid_reach(const FluidAccess& world, const FluidRecord& fluid) {
    const double dt = world.settings.time_step, h = fluid.definition.cell_size;
    return enlarged(fluid.bounds, 4 * h + (fluid.fastest + length(world.settings.gravity) * dt) * dt);
}

// Of the last step, with what the node's own velocity changed of it, N.
Vec3 force_of_liquids(const Nodes& nodes, std::size_t node, double dt) {
    return nodes.force_on(node) + (nodes.flow_impulse.empty() ? Vec3{} : nodes.flow_impulse[node] / dt);
}

// What gravity and the liquids do not explain of the change of each node's velocity in the last step, m/s²: as for
// rigid bodies (docs/physics/fluids.md, "With rigid bodies").
void expect_support(const FluidAccess& world, DeformableRecord& record) {
    const Nodes& nodes = record.nodes();
    LiquidMemory& memory = record.liquid;
    const Vec3 pull = record.acceleration(world.settings.gravity);
    const bool is_known = memory.step + 1 == world.report.step && memory.velocity.size() == nodes.size() &&
                          memory.force.size() == nodes.size() && nodes.force.size() == nodes.size();
    memory.acceleration.assign(nodes.size(), pull);
    if (!is_known) return;
    const double dt = world.settings.time_step, max_support = world.settings.solver.fluid.obstacles.max_support;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!(nodes.inverse_mass[i] > 0)) continue;
        const Vec3 force = force_of_liquids(nodes, i, dt);
        const Vec3 support = (nodes.mean_velocity[i] - memory.velocity[i]) / dt - pull - force * nodes.inverse_mass[i];
        const double carried = std::min(length(force), length(memory.force[i])) * nodes.inverse_mass[i];
        memory.acceleration[i] += no_more_than(support, max_support * (length(pull) + carried));
    }
}

// What sinks or rises as a whole is not quiet, however slow: liquids have the same limit.
bool is_sinking(const FluidAccess& world, const FluidRecord& fluid, const Nodes& nodes) {
    const Vec3 down = normalized(world.settings.gravity, {});
    double momentum = 0, mass = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        momentum += nodes.mass[i] * dot(down, nodes.mean_velocity[i]);
        mass += nodes.mass[i];
    }
    const double max_speed = world.settings.solver.fluid.sleep.max_sinking_speed * fluid.definition.cell_size;
    return std::fabs(momentum) > max_speed * mass;
}

template <class Visit>
void for_each_deformable(const FluidAccess& world, Visit visit) {
    for (std::uint32_t slot = 0; slot < world.immersed.records.slot_count(); ++slot) {
        if (world.immersed.records.used(slot)) visit(slot, world.immersed.records.at(slot));
    }
}

// The liquid that a node holds goes along with it: another velocity than its own costs its momentum.
void set_flow(const FluidAccess& world, DeformableRecord& record) {
    const double dt = world.settings.time_step;
    const LiquidMemory& memory = record.liquid;
    const Nodes& nodes = record.nodes();
    if (record.solid() || nodes.force.empty()) return;
    std::vector<NodeFlow> flow(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        flow[i].drag = memory.bound[i] / dt;
        flow[i].velocity = nodes.mean_velocity[i];
        for (int axis = 0; axis < 3; ++axis) {
            if (!(memory.bound[i][axis] > 0)) continue;
            const double end = memory.bound_momentum[i][axis] / memory.bound[i][axis];
            flow[i].acceleration[axis] = (end - flow[i].velocity[axis]) / dt;
        }
    }
    record.set_flow(std::move(flow));
}

// The liquid that the points of sheets and ropes hold.
void bind_liquid(const FluidAccess& world, FluidRecord& fluid, const ImmersedDeformables& immersed) {
    std::vector<PointBond> bonds;
    std::vector<Vec3> slips;
    for (const ImmersedDeformables::Part& part : immersed.parts) {
        SeenDeformable& seen = fluid.immersed[static_cast<std::size_t>(&part - immersed.parts.data())];
        if (world.immersed.records.at(part.slot).solid()) continue;
        for (std::size_t i = part.first; i < part.last; ++i) {
            const ImmersedPoint& point = immersed.points[i];
            if (point.drag == Vec3{}) continue;
            bonds.push_back({point.end - fluid.solver->origin(), point.drag, {}, {}});
            Vec3& slip = slips.emplace_back();
            for (int axis = 0; axis < 3; ++axis) {
                if (point.drag[axis] > 0) slip[axis] = point.dragged[axis] / point.drag[axis];
            }
            seen.places.push_back(immersed.places[i]);
        }
    }
    fluid.solver->find_bonds(bonds);
    std::size_t next = 0;
    for (SeenDeformable& seen : fluid.immersed) {
        for (const ImmersedPlace& place : seen.places) {
            const PointBond& bond = seen.bonds.emplace_back(bonds[next]);
            const Vec3 momentum = scale(bond.bound, bond.velocity - slips[next++]);
            for (std::size_t k = 0; k < place.count; ++k) {
                seen.bound[place.node[k]] += place.weight[k] * bond.bound;
                seen.bound_momentum[place.node[k]] += place.weight[k] * momentum;
            }
        }
    }
}

}  // namespace

std::vector<std::uint32_t> deformables_near(const FluidAccess& world, const FluidRecord& fluid) {
    std::vector<std::uint32_t> slots;
    const Bounds reach = liquid_reach(world, fluid);
    for_each_deformable(world, [&](std::uint32_t slot, const DeformableRecord& record) {
        if (record.definition.enabled && overlaps(reach, record.bounds())) slots.push_back(slot);
    });
    return slots;
}

bool have_deformables_changed(const FluidAccess& world, const FluidRecord& fluid,
                              const std::vector<std::uint32_t>& slots) {
    const auto is_same = [&](std::uint32_t slot, const SeenDeformable& seen) {
        return seen.deformable == world.immersed.records.handle_at(slot) && world.immersed.records.at(slot).is_asleep;
    };
    return !std::ranges::equal(slots, fluid.immersed, is_same);
}

ImmersedDeformables immerse(const FluidAccess& world, const FluidRecord& fluid,
                            const std::vector<std::uint32_t>& slots) {
    ImmersedDeformables immersed;
    const Bounds near = liquid_reach(world, fluid);
    for (const std::uint32_t slot : slots) {
        DeformableRecord& record = world.immersed.records.at(slot);
        PointMaker maker{record,
                         record.acceleration(world.settings.gravity),
                         record.liquid.acceleration,
                         near,
                         fluid.definition.cell_size,
                         immersed};
        const std::size_t first = immersed.points.size();
        if (record.rope()) {
            add_rope(maker);
        } else if (record.cloth()) {
            add_cloth(maker);
        } else {
            add_solid(maker);
        }
        immersed.parts.push_back({slot, first, immersed.points.size()});
    }
    return immersed;
}

void note_forces(const FluidAccess& world, FluidRecord& fluid, const ImmersedDeformables& immersed) {
    const double dt = world.settings.time_step;
    fluid.immersed.clear();
    for (const ImmersedDeformables::Part& part : immersed.parts) {
        SeenDeformable& seen = fluid.immersed.emplace_back();
        seen.deformable = world.immersed.records.handle_at(part.slot);
        DeformableRecord& record = world.immersed.records.at(part.slot);
        if (part.last > part.first && is_sinking(world, fluid, record.nodes())) record.quiet_time = 0;
        const std::size_t count = record.nodes().size();
        for (auto* vector : {&seen.force, &seen.bound, &seen.bound_momentum}) vector->assign(count, {});
        for (std::size_t i = part.first; i < part.last; ++i) {
            const ImmersedPlace& place = immersed.places[i];
            const ImmersedPoint& point = immersed.points[i];
            for (std::size_t k = 0; k < place.count; ++k) {
                const std::uint32_t node = place.node[k];
                seen.force[node] += point.impulse * (place.weight[k] / dt);
            }
        }
    }
    bind_liquid(world, fluid, immersed);
}

void settle_immersed(const FluidAccess& world, FluidRecord& fluid) {
    std::vector<PointBond> bonds;
    std::vector<Vec3> impulses;
    for (SeenDeformable& seen : fluid.immersed) {
        const DeformableRecord* record = world.immersed.records.find(seen.deformable);
        for (std::size_t i = 0; i < seen.bonds.size(); ++i) {
            bonds.push_back(seen.bonds[i]);
            Vec3& impulse = impulses.emplace_back();
            if (record == nullptr || record->nodes().flow_impulse.empty()) continue;
            // Each node's impulse comes of all liquid that it holds.
            const ImmersedPlace& place = seen.places[i];
            for (std::size_t k = 0; k < place.count; ++k) {
                const Vec3 had = record->nodes().flow_impulse[place.node[k]], all = record->liquid.bound[place.node[k]];
                for (int axis = 0; axis < 3; ++axis) {
                    if (all[axis] > 0)
                        impulse[axis] -= had[axis] * (place.weight[k] * bonds.back().bound[axis] / all[axis]);
                }
            }
        }
        seen.bonds.clear();
        seen.places.clear();
    }
    fluid.solver->push_bonds(bonds, impulses);
}

void keep_immersed_awake(const FluidAccess& world, const FluidRecord& fluid) {
    for (const SeenDeformable& seen : fluid.immersed) {
        DeformableRecord* record = world.immersed.records.find(seen.deformable);
        if (record == nullptr || std::ranges::all_of(seen.force, [](Vec3 force) { return force == Vec3{}; })) continue;
        record->quiet_time = 0;
        record->liquid.wakes = record->is_asleep;
    }
}

bool are_immersed_asleep(const FluidAccess& world, const FluidRecord& fluid) {
    return std::ranges::all_of(fluid.immersed, [&](const SeenDeformable& seen) {
        const DeformableRecord* record = world.immersed.records.find(seen.deformable);
        return record == nullptr || record->is_asleep;
    });
}

void begin_immersed(const FluidAccess& world) {
    const bool has_fluids = world.fluids.records.count() > 0;
    for_each_deformable(world, [&](std::uint32_t, DeformableRecord& record) {
        if (!has_fluids && record.nodes().force.empty()) return;
        expect_support(world, record);
        LiquidMemory& memory = record.liquid;
        memory.force.resize(record.nodes().size());
        for (std::size_t i = 0; i < memory.force.size(); ++i)
            memory.force[i] = force_of_liquids(record.nodes(), i, world.settings.time_step);
        for (auto* vector : {&memory.bound, &memory.bound_momentum}) vector->assign(record.nodes().size(), {});
        record.set_liquid_force({});
        if (!record.solid()) record.set_flow({});
    });
}

void push_immersed(const FluidAccess& world, const FluidRecord& fluid) {
    for (const SeenDeformable& seen : fluid.immersed) {
        DeformableRecord* record = world.immersed.records.find(seen.deformable);
        if (record == nullptr || seen.force.size() != record->nodes().size()) continue;
        std::vector<Vec3> force = seen.force;
        for (std::size_t i = 0; i < force.size(); ++i) {
            force[i] += record->nodes().force_on(i);
            record->liquid.bound[i] += seen.bound[i];
            record->liquid.bound_momentum[i] += seen.bound_momentum[i];
        }
        record->set_liquid_force(force);
    }
}

void end_immersed(const FluidAccess& world) {
    for_each_deformable(world, [&](std::uint32_t, DeformableRecord& record) {
        LiquidMemory& memory = record.liquid;
        set_flow(world, record);
        if (std::exchange(memory.wakes, false)) {
            // The force on what stood still would throw what gives way.
            record.is_asleep = false;
            record.set_liquid_force(memory.force_asleep);
            if (!record.solid()) record.set_flow({});
        }
        if (record.is_asleep) return;
        memory.velocity = record.nodes().mean_velocity;
        memory.force_asleep = record.nodes().force;
        if (!record.nodes().force.empty()) memory.step = world.report.step;
    });
}

}  // namespace embody::physics::stages
