// SPDX-License-Identifier: MIT
#include "benches/convergence/elastic_studies.h"

#include <cmath>

#include "benches/convergence/measurements.h"
#include "physics/definitions/deformable_primitives.h"

namespace embody::convergence {

namespace {

using namespace physics;

/// A world with one deformable.
struct Bench {
    std::unique_ptr<World> world;
    DeformableHandle deformable;

    [[nodiscard]] Vec3 at(std::size_t node) const { return world->node_positions(deformable)[node]; }
};

Result<Bench> bench_of(const DeformableDefinition& definition, double rate = 60) {
    auto world = World::create({.time_step = 1 / rate, .sleeping = false});
    if (!world) return world.error();
    const auto deformable = (*world)->create_deformable(definition);
    if (!deformable) return deformable.error();
    return Bench{std::move(*world), *deformable};
}

/// Mean height, m, of the nodes that `is_counted` selects by their positions in the definition.
double mean_height(const Bench& bench, const auto& is_counted) {
    const auto& rest = bench.world->deformable(bench.deformable)->nodes;
    const auto now = bench.world->node_positions(bench.deformable);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (!is_counted(rest[i])) continue;
        sum += now[i].y - rest[i].y;
        ++count;
    }
    return sum / count;
}

void pin_where(DeformableDefinition& definition, const auto& is_pinned) {
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        if (is_pinned(definition.nodes[i])) definition.pinned.push_back(i);
    }
}

DeformableDefinition beam(int cells, double damping) {
    DeformableDefinition definition = tetrahedral_brick({beam_length, beam_side, beam_side}, {10 * cells, cells, cells},
                                                        {.density = beam_density,
                                                         .youngs_modulus = beam_youngs_modulus,
                                                         .poisson_ratio = beam_poisson_ratio,
                                                         .rayleigh_damping = damping});
    pin_where(definition, [](Vec3 p) { return p.x == 0; });
    return definition;
}

double tip_height(const Bench& bench) {
    return mean_height(bench, [](Vec3 p) { return p.x == beam_length; });
}

}  // namespace

Result<double> tip_of_beam(int cells) {
    auto bench = bench_of(beam(cells, 0.01));
    if (!bench) return bench.error();
    run(*bench->world, 3);
    return -tip_height(*bench);
}

Result<double> frequency_of_beam(int rate) {
    auto bench = bench_of(beam(2, 0), rate);
    if (!bench) return bench.error();
    // Released from the straight position it oscillates about its equilibrium.
    const double period = period_of(record(*bench->world, 1.5, [&] { return tip_height(*bench); }), 1.0 / rate);
    return period > 0 ? 1 / period : 0;
}

Result<double> tip_of_strip(int triangles) {
    // Two rows of nodes are pinned: the clamp is half way between them, and the free part is half a row longer.
    const double row = strip_length / (triangles + 0.5);
    DeformableDefinition strip = cloth_rectangle(strip_length / 2, row * (triangles + 1), row / std::sqrt(0.75),
                                                 {.area_density = strip_area_density,
                                                  .stretch_stiffness = 500,
                                                  .shear_stiffness = 200,
                                                  .bend_stiffness = strip_bend_stiffness,
                                                  .rayleigh_damping = 0.02});
    const double clamp = -row * (triangles + 1) / 2 + row, end = -clamp + row;
    pin_where(strip, [&](Vec3 p) { return p.z < clamp + 1e-9; });
    auto bench = bench_of(strip);
    if (!bench) return bench.error();
    run(*bench->world, 4);
    return -mean_height(*bench, [&](Vec3 p) { return p.z > end - 1e-9; });
}

Result<double> tip_of_rod(int segments) {
    const double segment = rod_length / (segments + 0.5);  // clamped as the strip is
    DeformableDefinition rod = rope_between({-segment, 0, 0}, {segment * segments, 0, 0}, segment,
                                            {.linear_density = rod_linear_density,
                                             .axial_stiffness = 1e5,
                                             .bend_rigidity = rod_rigidity,
                                             .rayleigh_damping = 0.02});
    rod.pinned = {0, 1};
    auto bench = bench_of(rod);
    if (!bench) return bench.error();
    run(*bench->world, 4);
    return -bench->at(rod.nodes.size() - 1).y;
}

Result<double> sag_of_rope(int segments) {
    const double half = catenary_length / 2, half_span = catenary_span / 2;
    DeformableDefinition rope =
        rope_between({-half, 0, 0}, {half, 0, 0}, catenary_length / segments,
                     {.linear_density = 1, .axial_stiffness = 1e6, .bend_rigidity = 1e-6, .rayleigh_damping = 0.02});
    rope.pinned = {0, static_cast<std::uint32_t>(segments)};
    auto bench = bench_of(rope);
    if (!bench) return bench.error();
    // The rope starts as two straight segments.
    std::vector<Vec3> nodes = rope.nodes;
    const double depth = std::sqrt(half * half - half_span * half_span);
    for (Vec3& node : nodes) node = {node.x * half_span / half, -depth * (1 - std::fabs(node.x) / half), 0};
    const std::vector<Vec3> still(nodes.size());
    if (auto placed = bench->world->set_nodes(bench->deformable, nodes, still); !placed) return placed.error();
    run(*bench->world, 20);
    return -bench->at(static_cast<std::size_t>(segments) / 2).y;
}

Result<double> period_of_rope(int rate) {
    constexpr int segments = 40;
    DeformableDefinition rope = rope_between({0, 0, 0}, {0, -hanging_length, 0}, hanging_length / segments,
                                             {.linear_density = 1, .axial_stiffness = 1e6, .bend_rigidity = 1e-6});
    rope.pinned = {0};
    auto bench = bench_of(rope, rate);
    if (!bench) return bench.error();
    // Start in the shape of the slowest mode, J0(2.4048 √(1 - s/L)) at the depth s, 2 cm at the lower end.
    std::vector<Vec3> nodes = rope.nodes;
    for (Vec3& node : nodes) {
        const double up = std::sqrt(std::max(0.0, 1 + node.y / hanging_length));
        node.x = 0.02 * std::cyl_bessel_j(0.0, 2.404825557695773 * up);
    }
    const std::vector<Vec3> still(nodes.size());
    if (auto placed = bench->world->set_nodes(bench->deformable, nodes, still); !placed) return placed.error();
    return period_of(record(*bench->world, 8, [&] { return bench->at(segments).x; }), 1.0 / rate);
}

}  // namespace embody::convergence
