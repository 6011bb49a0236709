// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "foundation/task_pool.h"
#include "physics/definitions/world_settings.h"
#include "physics/fluid/obstacles/obstacle_probe.h"
#include "physics/stages/access.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

/// Places of particles so far, world, m.
struct Filling {
    std::vector<Vec3> places;
    double volume = 0;  ///< m³
    bool is_too_large = false;

    // Takes a region's particles; `is_taken` says which places earlier regions have.
    template <class IsIn, class IsTaken>
    void fill(const Vec3& first, const std::array<int, 3>& counts, Vec3 spacing, IsIn is_in, IsTaken is_taken) {
        for (int z = 0; z < counts[2]; ++z) {
            for (int y = 0; y < counts[1]; ++y) {
                for (int x = 0; x < counts[0]; ++x) {
                    const Vec3 p = first + Vec3{x * spacing.x, y * spacing.y, z * spacing.z};
                    if (!is_in(p) || is_taken(p)) continue;
                    places.push_back(p);
                    volume += spacing.x * spacing.y * spacing.z;
                }
            }
        }
    }
};

bool are_too_many(const std::array<double, 3>& counts) {
    return counts[0] * counts[1] * counts[2] > static_cast<double>(max_fluid_particles);
}

Error too_many() {
    return {"cell_size", "makes more than " + std::to_string(max_fluid_particles) + " particles",
            "use larger cells or less liquid"};
}

// A lattice that fits the box: half a cell apart, a little more or less.
Result<void> fill_boxes(const FluidDefinition& definition, Filling& filling) {
    const double step = definition.cell_size / 2;
    for (std::size_t i = 0; i < definition.boxes.size(); ++i) {
        const Bounds& box = definition.boxes[i];
        std::array<double, 3> counts{};
        for (int axis = 0; axis < 3; ++axis) counts[axis] = std::max(1.0, std::round(box.size()[axis] / step));
        if (are_too_many(counts)) return too_many();
        Vec3 spacing;
        for (int axis = 0; axis < 3; ++axis) spacing[axis] = box.size()[axis] / counts[axis];
        const auto is_taken = [&](Vec3 p) {
            return std::any_of(definition.boxes.begin(), definition.boxes.begin() + static_cast<std::ptrdiff_t>(i),
                               [&](const Bounds& other) { return contains(other, p); });
        };
        filling.fill(
            box.lower + spacing * 0.5,
            {static_cast<int>(counts[0]), static_cast<int>(counts[1]), static_cast<int>(counts[2])}, spacing,
            [](Vec3) { return true; }, is_taken);
    }
    return {};
}

// The world's lattice, as far as it lies in the hull.
Result<void> fill_hulls(const FluidDefinition& definition, const FluidObstacleSettings& settings, Filling& filling) {
    const double step = definition.cell_size / 2;
    std::vector<std::unique_ptr<CollisionShape>> shapes;
    std::vector<ObstacleProbe> probes;
    for (std::size_t i = 0; i < definition.hulls.size(); ++i) {
        auto shape = CollisionShape::create(HullShape{definition.hulls[i]});
        if (!shape) return Error{"hulls[" + std::to_string(i) + "]", shape.error().why, shape.error().remedy};
        shapes.push_back(std::move(*shape));
        probes.emplace_back(*shapes.back(), Transform{}, settings);
        probes.back().look_at(probes.back().bounds(), definition.cell_size);
        const Bounds bounds = probes.back().bounds();
        Vec3 first;
        std::array<double, 3> counts{};
        for (int axis = 0; axis < 3; ++axis) {
            first[axis] = (std::floor(bounds.lower[axis] / step) + 0.5) * step;
            counts[axis] = std::ceil((bounds.upper[axis] - first[axis]) / step) + 1;
        }
        if (are_too_many(counts)) return too_many();
        const auto is_taken = [&](Vec3 p) {
            const auto holds = [&](const Bounds& box) { return contains(box, p); };
            if (std::any_of(definition.boxes.begin(), definition.boxes.end(), holds)) return true;
            return std::any_of(probes.begin(), probes.end() - 1,
                               [&](const ObstacleProbe& other) { return other.nearest(p).distance < 0; });
        };
        filling.fill(
            first, {static_cast<int>(counts[0]), static_cast<int>(counts[1]), static_cast<int>(counts[2])},
            {step, step, step}, [&](Vec3 p) { return probes.back().nearest(p).distance < 0; }, is_taken);
    }
    return {};
}

// Particles in obstacles are left out.
void leave_out_obstacles(const ObstacleAccess& world, double cell_size, std::vector<Vec3>& places) {
    const FluidObstacleSettings& settings = world.settings.solver.fluid.obstacles;
    Bounds bounds;
    for (const Vec3 p : places) bounds.add(p);
    world.contacts.broad_phase.query(bounds, [&](std::uint32_t slot) {
        const BodyRecord& record = world.rigid.record(slot);
        if (!record.shape || !record.definition.enabled) return;
        ObstacleProbe probe(*record.shape, world.rigid.pose(slot), settings);
        if (!probe.look_at(bounds, cell_size)) return;
        std::erase_if(places, [&](Vec3 p) {
            if (!contains(enlarged(probe.bounds(), cell_size), p)) return false;
            return probe.nearest(p).distance < 0 || probe.encloses(p);
        });
    });
}

// Origin of the frame in which the particles' places are floats.
Vec3 origin_amid(const std::vector<Vec3>& places) {
    Bounds bounds;
    for (const Vec3 p : places) bounds.add(p);
    Vec3 origin;
    for (int axis = 0; axis < 3 && !bounds.is_empty(); ++axis) origin[axis] = std::round(bounds.center()[axis]);
    return origin;
}

}  // namespace

void read_particles(FluidRecord& record, TaskPool& workers) {
    const std::vector<FluidParticle>& particles = record.solver->particles();
    const std::size_t count = particles.size();
    record.positions.resize(count);
    record.velocities.resize(count);
    record.ids.resize(count);
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            const float *x = particles[i].position, *v = particles[i].velocity;
            record.positions[i] = {x[0], x[1], x[2]};
            record.velocities[i] = {v[0], v[1], v[2]};
            record.ids[i] = particles[i].id;
        }
    });
    ++record.version;
    const FluidProperties& first = record.solver->properties();
    record.definition.density = first.density;
    record.definition.viscosity = first.viscosity;
    record.definition.yield_stress = first.yield_stress;
    record.definition.surface_tension = first.surface_tension;
    const ParticleReach reach = reach_of(particles, workers);
    record.fastest = std::sqrt(static_cast<double>(reach.fastest_squared));
    record.bounds = {};
    if (particles.empty()) return;
    const Vec3 origin = record.solver->origin();
    record.bounds.add(origin + Vec3{reach.lower[0], reach.lower[1], reach.lower[2]});
    record.bounds.add(origin + Vec3{reach.upper[0], reach.upper[1], reach.upper[2]});
}

Result<void> check_room(const FluidRecord& fluid, std::size_t count) {
    if (fluid.positions.size() + count > max_fluid_particles) return too_many();
    if (count > std::numeric_limits<std::uint32_t>::max() - fluid.solver->next_id())
        return Error{"ids", "of this fluid are used up", "destroy it and create another one"};
    return {};
}

Result<FluidIds> add_particles(const ObstacleAccess& world, FluidRecord& fluid, std::span<const Vec3> places) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!is_finite(places[i])) return Error{"places[" + std::to_string(i) + "]", "must be finite"};
    }
    if (Result<void> room = check_room(fluid, places.size()); !room) return room.error();
    std::vector<Vec3> free(places.begin(), places.end());
    leave_out_obstacles(world, fluid.definition.cell_size, free);
    if (free.empty()) return Error{"places", "hold no particle", "place the liquid outside of obstacles"};
    std::vector<Vec3f> positions;
    positions.reserve(free.size());
    for (const Vec3 p : free) positions.push_back(to_vec3f(p - fluid.solver->origin()));
    const FluidIds ids = fluid.solver->add_particles(positions);
    read_particles(fluid, world.workers);
    return ids;
}

FluidIds add_drops(FluidRecord& fluid, std::span<const FluidDrop> drops, TaskPool& workers) {
    std::vector<FluidParticle> particles(drops.size());
    for (std::size_t i = 0; i < drops.size(); ++i) {
        const Vec3 at = drops[i].position - fluid.solver->origin();
        for (int axis = 0; axis < 3; ++axis) {
            particles[i].position[axis] = static_cast<float>(at[axis]);
            particles[i].velocity[axis] = static_cast<float>(drops[i].velocity[axis]);
        }
    }
    const FluidIds ids = fluid.solver->add_particles(std::move(particles), fluid.solver->origin());
    read_particles(fluid, workers);
    return ids;
}

Result<FluidRecord> set_up_fluid(const ObstacleAccess& world, const FluidDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    Filling filling;
    if (auto result = fill_boxes(definition, filling); !result) return result.error();
    const FluidObstacleSettings& settings = world.settings.solver.fluid.obstacles;
    if (auto result = fill_hulls(definition, settings, filling); !result) return result.error();
    const double step = definition.cell_size / 2;
    filling.places.insert(filling.places.end(), definition.points.begin(), definition.points.end());
    filling.volume += static_cast<double>(definition.points.size()) * step * step * step;
    if (filling.places.size() > max_fluid_particles) return too_many();
    const double particle_volume =
        filling.volume / static_cast<double>(std::max<std::size_t>(filling.places.size(), 1));
    if (!definition.starts_empty) leave_out_obstacles(world, definition.cell_size, filling.places);
    if (filling.places.empty()) {
        return Error{"boxes", "hold no particle",
                     "place the liquid outside of obstacles, in regions larger than cell_size / 2"};
    }

    const Vec3 origin = origin_amid(filling.places);
    if (definition.starts_empty) filling.places.clear();
    std::vector<Vec3f> positions;
    positions.reserve(filling.places.size());
    for (const Vec3 p : filling.places) positions.push_back(to_vec3f(p - origin));
    const FluidProperties properties{definition.density, definition.viscosity, definition.yield_stress, particle_volume,
                                     definition.surface_tension};
    FluidRecord record;
    record.definition = definition;
    record.solver =
        std::make_unique<FluidSolver>(origin, definition.cell_size, properties, positions, definition.velocity);
    read_particles(record, world.workers);
    return record;
}

FluidRecord fluid_around(const FluidRecord& other, FluidIds ids) {
    FluidRecord record;
    record.definition = other.definition;
    record.definition.boxes.clear();
    record.definition.hulls.clear();
    record.definition.points.clear();
    for (std::size_t i = 0; i < other.ids.size(); ++i) {
        if (ids.contains(other.ids[i]))
            record.definition.points.push_back(other.solver->origin() + to_vec3(other.positions[i]));
    }
    record.solver = std::make_unique<FluidSolver>(origin_amid(record.definition.points), other.definition.cell_size,
                                                  other.solver->properties(), std::span<const Vec3f>{}, Vec3{});
    return record;
}

FluidIds move_particles(FluidRecord& from, FluidIds ids, FluidRecord& to) {
    FluidIds moved{};
    for (const auto& [run, liquid] : from.solver->liquids().runs(ids)) {
        // Copies: the list of liquids changes as they leave.
        const FluidProperties matter = from.solver->liquids().of(run.first);
        const FluidIds added = to.solver->add_particles(from.solver->take_particles(run), from.solver->origin());
        to.solver->set_matter(added, matter);
        moved = {moved.last == 0 ? added.first : moved.first, added.last};
    }
    return moved;
}

}  // namespace embody::physics::stages
