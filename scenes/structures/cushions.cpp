// SPDX-License-Identifier: MIT
#include "scenes/structures/cushions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "scenes/structures/box_stacks.h"

namespace embody::scenes {

namespace {

using namespace physics;

constexpr double g = 9.81, radius = 1e-3;
constexpr Vec3 cushion_size{0.5, 0.15, 0.5}, foam_size{0.2, 0.2, 0.2}, weight_half{0.15, 0.05, 0.15};
constexpr double cushion_weight = 10, foam_weight = 40;  // kg of the boxes on them
// Without sidewise contraction the foam is pressed as a column is, whatever friction does at its ends.
const SoftSolid foam{.density = 60, .youngs_modulus = 1e5, .poisson_ratio = 0, .rayleigh_damping = 0.02};
const SoftSolid filling{.density = 40, .youngs_modulus = 2e4, .poisson_ratio = 0.2, .rayleigh_damping = 0.02};

struct Pile {
    std::array<DeformableHandle, 2> cushions;
    DeformableHandle foam;
    BodyHandle on_cushions, on_foam;
    BoxStacks stacks;
};

Result<BodyHandle> add_weight(World& world, Vec3 position, double mass) {
    const auto shape = world.create_shape(BoxShape{weight_half});
    if (!shape) return shape.error();
    BodyDefinition box{.shape = *shape, .position = position};
    box.mass.mass = mass;
    box.material.restitution = 0;
    return world.create_body(box);
}

Result<DeformableHandle> add_brick(World& world, Vec3 size, std::array<int, 3> cells, const SoftSolid& solid,
                                   Vec3 bottom, CushionCost& cost) {
    DeformableDefinition brick = tetrahedral_brick(size, cells, solid);
    brick.pose.position = bottom - Vec3{size.x / 2, 0, size.z / 2};
    brick.contact_radius = radius;
    cost.nodes += brick.nodes.size();
    cost.tetrahedra += std::get<SoftSolid>(brick.matter).tetrahedra.size();
    return world.create_deformable(brick);
}

Result<Pile> build(World& world, const CushionScene& scene, CushionCost& cost) {
    Pile pile;
    const auto floor = add_body(world, PlaneShape{{0, 1, 0}, 0}, {}, BodyKind::static_body);
    if (!floor) return floor.error();
    const int across = scene.cells, high = std::max(1, scene.cells * 3 / 10), fine = std::max(1, scene.cells * 6 / 10);
    for (std::size_t i = 0; i < 2; ++i) {
        const double turn = static_cast<double>(i);
        const auto cushion = add_brick(world, cushion_size, {across, high, across}, filling,
                                       {0.03 * turn, 0.1 + 0.3 * turn, 0.02 * turn}, cost);
        if (!cushion) return cushion.error();
        pile.cushions[i] = *cushion;
    }
    const auto block = add_brick(world, foam_size, {fine, fine, fine}, foam, {-1, radius, 0}, cost);
    const auto weight = add_weight(world, {0, 0.8, 0}, cushion_weight);
    const auto load = add_weight(world, {-1, foam_size.y + 2 * radius + weight_half.y, 0}, foam_weight);
    auto stacks = BoxStacks::add(world, scene.boxes);
    if (!block) return block.error();
    if (!weight) return weight.error();
    if (!load) return load.error();
    if (!stacks) return stacks.error();
    pile.foam = *block;
    pile.on_cushions = *weight;
    pile.on_foam = *load;
    pile.stacks = std::move(*stacks);
    return pile;
}

double energy(const World& world) {
    const Conserved all = world.conserved();
    return all.kinetic_energy + all.potential_energy;
}

// Of the height by the load on top and half of its own weight.
double compression(const World& world, const Pile& pile) {
    const double area = foam_size.x * foam_size.z;
    const double stress = (foam_weight + world.mass(pile.foam) / 2) * g / area;
    const double expected = stress / foam.youngs_modulus * foam_size.y;
    const double bottom = world.pose(pile.on_foam).position.y - weight_half.y;
    return (foam_size.y + 2 * radius - bottom) / expected;
}

std::string judge(const World& world, const Pile& pile, const CushionCost& cost) {
    if (std::fabs(cost.compression - 1) > 0.02) return "the foam is not pressed as its weights say";
    for (const BodyHandle box : {pile.on_cushions, pile.on_foam}) {
        if (length(world.linear_velocity(box)) > 0.01) return "a box on what is soft still moves";
    }
    for (const DeformableHandle cushion : pile.cushions) {
        for (const Vec3 p : world.node_positions(cushion)) {
            if (!is_finite(p) || p.y < -radius) return "a node of a cushion is in the floor";
        }
    }
    // Both bear the box, the lower one the upper too: what is left of their heights.
    const double lower = world.center_of_mass(pile.cushions[0]).y, upper = world.center_of_mass(pile.cushions[1]).y;
    const double box = world.pose(pile.on_cushions).position.y - weight_half.y;
    if (upper - lower < 0.1 || upper - lower > 0.16) return "the cushions do not lie on each other";
    if (box < 0.22 || box > 0.3) return "the box does not lie on the cushions";
    return pile.stacks.stand(world) ? "" : "a stack has fallen";
}

}  // namespace

Result<CushionCost> time_cushions(const CushionScene& scene) {
    auto made = World::create({.sleeping = false, .workers = scene.workers});
    if (!made) return made.error();
    World& world = **made;
    CushionCost cost;
    const auto pile = build(world, scene, cost);
    if (!pile) return pile.error();

    const double at_start = energy(world);
    double most = at_start;
    const double step = world.settings().time_step;
    const int steps = static_cast<int>(std::lround(scene.seconds / step));
    const int falling = std::min(steps, static_cast<int>(std::lround(2 / step)));
    for (int i = 0; i < steps; ++i) {
        const StepReport& report = world.step();
        (i < falling ? cost.fall_ms : cost.rest_ms) += report.milliseconds;
        cost.worst_ms = std::max(cost.worst_ms, report.milliseconds);
        cost.solids_ms += report.stage_milliseconds[static_cast<std::size_t>(StepStage::deformables)];
        most = std::max(most, energy(world));
    }
    cost.fall_ms /= std::max(1, falling);
    cost.rest_ms /= std::max(1, steps - falling);
    cost.solids_ms /= std::max(1, steps);
    cost.hash = world.state_hash();
    cost.compression = compression(world, *pile);
    cost.wrong = judge(world, *pile, cost);
    if (cost.wrong.empty() && most > at_start + 1e-3 * std::fabs(at_start)) cost.wrong = "energy has come from nowhere";
    return cost;
}

}  // namespace embody::scenes
