// SPDX-License-Identifier: MIT
#include "scenes/structures/tablecloth.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/definitions/deformable_primitives.h"
#include "scenes/structures/box_stacks.h"

namespace embody::scenes {

namespace {

using namespace physics;

constexpr double side = 1.4, table_side = 0.9, table_height = 0.7;

std::size_t count_edges(const Cloth& cloth) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& triangle : cloth.triangles) {
        for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(triangle[k], triangle[(k + 1) % 3]));
    }
    return edges.size();
}

std::string judge(const World& world, std::span<const Vec3> before, std::span<const Vec3> now,
                  const BoxStacks& stacks) {
    const Vec3 half{table_side / 2, table_height / 2, table_side / 2};
    double drift = 0, lowest = table_height;
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (!is_finite(now[i])) return "a node is nowhere";
        const Vec3 inside = half - abs(now[i] - Vec3{0, half.y, 0});
        if (std::min({inside.x, inside.y, inside.z}) > 2e-3) return "a node is in the table";
        drift = std::max(drift, length(now[i] - before[i]));
        lowest = std::min(lowest, now[i].y);
    }
    if (drift > 0.02) return "the cloth still moved in the last second";
    // The corners hang lowest: by the border's overhang at least, by their own, √2 of it, at most.
    const double overhang = (side - table_side) / 2;
    if (lowest > table_height - overhang || lowest < table_height - 1.5 * overhang)
        return "the cloth does not hang as far over as its size says";
    return stacks.stand(world) ? "" : "a stack has fallen";
}

}  // namespace

Result<TableclothCost> time_tablecloth(const TableclothScene& scene) {
    auto made = World::create({.sleeping = false, .workers = scene.workers});
    if (!made) return made.error();
    World& world = **made;
    if (auto floor = add_body(world, PlaneShape{{0, 1, 0}, 0}, {}, BodyKind::static_body); !floor) return floor.error();
    const auto table = add_body(world, BoxShape{{table_side / 2, table_height / 2, table_side / 2}},
                                {0, table_height / 2, 0}, BodyKind::static_body);
    if (!table) return table.error();
    const auto stacks = BoxStacks::add(world, scene.boxes);
    if (!stacks) return stacks.error();
    // Three edges a node, each node's share of area √¾ edge².
    const double edge = side / std::sqrt(std::sqrt(0.75) * scene.edges / 3.0);
    auto cloth = cloth_rectangle(side, side, edge, {.area_density = 0.2, .rayleigh_damping = 0.005});
    cloth.pose = {{0, table_height + 0.05, 0}, {}};
    const auto handle = world.create_deformable(cloth);
    if (!handle) return handle.error();

    TableclothCost cost{.nodes = cloth.nodes.size(), .edges = count_edges(std::get<Cloth>(cloth.matter))};
    const double step = world.settings().time_step;
    const int steps = static_cast<int>(std::lround(scene.seconds / step));
    const int falling = std::min(steps, static_cast<int>(std::lround(2 / step))),
              last = steps - static_cast<int>(1 / step);
    std::vector<Vec3> before;
    for (int i = 0; i < steps; ++i) {
        if (i == std::max(0, last)) {
            const auto nodes = world.node_positions(*handle);
            before.assign(nodes.begin(), nodes.end());
        }
        const StepReport& report = world.step();
        (i < falling ? cost.fall_ms : cost.rest_ms) += report.milliseconds;
        cost.worst_ms = std::max(cost.worst_ms, report.milliseconds);
        cost.cloth_ms += report.stage_milliseconds[static_cast<std::size_t>(StepStage::deformables)];
    }
    cost.fall_ms /= std::max(1, falling);
    cost.rest_ms /= std::max(1, steps - falling);
    cost.cloth_ms /= std::max(1, steps);
    cost.hash = world.state_hash();
    cost.wrong = judge(world, before, world.node_positions(*handle), *stacks);
    return cost;
}

}  // namespace embody::scenes
