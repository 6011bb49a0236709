// SPDX-License-Identifier: MIT
// Sheets that tear (docs/physics/tearing.md): against published solutions, and what must hold for any.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/cloth/node_fans.h"
#include "physics/state/deformable_record.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using deformable::edge_between;
using deformable::NodeFans;
using deformable::SheetEdge;

double log_between(Random& random, double low, double high) {
    return std::exp(random.between(std::log(low), std::log(high)));
}

// Cuts the sheet along z = 0 up to x. `held`: as of NodeFans::split.
void cut_until(DeformableDefinition& sheet, double x, std::span<const std::uint8_t> held = {}) {
    std::vector<SheetEdge> cut;
    const auto is_on = [&](std::uint32_t node) {
        return std::fabs(sheet.nodes[node].z) < 1e-9 && sheet.nodes[node].x < x;
    };
    const auto& triangles = std::get<Cloth>(sheet.matter).triangles;
    for (const auto& triangle : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (is_on(triangle[k]) && is_on(triangle[(k + 1) % 3]))
                cut.push_back(edge_between(triangle[k], triangle[(k + 1) % 3]));
        }
    }
    ASSERT_TRUE(tear(sheet, NodeFans(triangles, sheet.nodes.size()).split(cut, held)).ok());
}

// By node: whether a triangle at it reaches beyond z = 0.
std::vector<bool> is_above(const DeformableDefinition& sheet) {
    std::vector<bool> above(sheet.nodes.size(), false);
    for (const auto& triangle : std::get<Cloth>(sheet.matter).triangles) {
        const bool own = std::ranges::any_of(triangle, [&](auto node) { return sheet.nodes[node].z > 1e-9; });
        for (const std::uint32_t node : triangle) above[node] = above[node] || own;
    }
    return above;
}

BodyHandle add_holder(World& world, BodyKind kind, double mass, Vec3 position) {
    BodyDefinition body;
    body.kind = kind;
    body.shape = world.create_shape(BoxShape{{0.01, 0.01, 0.01}}).value();
    body.mass.mass = mass;
    body.position = position;
    body.linear_damping = body.angular_damping = 5;
    body.collision_mask = 0;
    return world.create_body(body).value();
}

// A light thread that ends in the node.
DeformableHandle tie_thread(World& world, DeformableHandle sheet, std::uint32_t node) {
    const Vec3 end = world.node_positions(sheet)[node];
    DeformableDefinition thread = rope_between(end + Vec3{0, 0.02, 0}, end, 0.01, {.linear_density = 1e-4});
    thread.collision_mask = 0;
    thread.ties = {{static_cast<std::uint32_t>(thread.nodes.size() - 1), sheet, {node, 0, 0}, {1, 0, 0}}};
    return world.create_deformable(thread).value();
}

// A strip between two bars that draw it apart across, along Z.
struct Clamped {
    std::unique_ptr<World> world = make_world({.gravity = {}});
    DeformableHandle sheet;
    double height = 0, strain = 0;
    std::array<BodyHandle, 2> bars;

    Clamped(DeformableDefinition definition, double of_height, double start) : height(of_height), strain(start) {
        std::vector<Vec3> places = definition.nodes;
        for (Vec3& place : places) place.z *= 1 + start;
        for (std::size_t i = 0; i < 2; ++i)
            bars[i] = add_holder(*world, BodyKind::kinematic_body, 1, {0, 0, (i == 0 ? 1 : -1) * start * height / 2});
        for (std::uint32_t node = 0; node < definition.nodes.size(); ++node) {
            const Vec3 at = definition.nodes[node];
            if (std::fabs(at.z) > height / 2 - 1e-9)
                definition.attachments.push_back({node, bars[at.z > 0 ? 0 : 1], at});
        }
        sheet = world->create_deformable(definition).value();
        EXPECT_TRUE(world->set_nodes(sheet, places, std::vector<Vec3>(places.size())).ok());
        run(*world, 0.5);
    }
    // Until it has torn `times` times, by this strain a second.
    void draw(double rate, int times) {
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_TRUE(world->set_velocity(bars[i], {0, 0, (i == 0 ? 1 : -1) * rate * height / 2}, {}).ok());
        for (int torn = 0, step = 0; torn < times && step < 1200; ++step) {
            world->step();
            strain += rate * world->settings().time_step;
            torn += world->sheet_tear_events().empty() ? 0 : 1;
        }
    }
};

// A long strip of the height H between bars, with a long slit (R. Rivlin, A. Thomas, "Rupture of rubber", 1953): each
// metre of tear releases what a metre of the strip ahead holds, ½ k ε² H.
TEST(Tearing, GoesOnByTheEnergyOfPureShear) {
    Random random(3);
    for (int i = 0; i < 6; ++i) {
        const double height = random.between(0.1, 0.5), stiffness = log_between(random, 5e3, 2e5);
        const double strain = random.between(0.02, 0.08);
        const double edge = height / (4 + 2 * static_cast<double>(random.below(5))) * 2 / std::sqrt(3);
        DeformableDefinition sheet = cloth_rectangle(4 * height, height, edge,
                                                     {.stretch_stiffness = stiffness,
                                                      .shear_stiffness = stiffness / 2,
                                                      .rayleigh_damping = 0.01,
                                                      .tear_energy = stiffness * strain * strain * height / 2});
        cut_until(sheet, -0.4 * height);
        Clamped clamped(sheet, height, 0.6 * strain);
        clamped.draw(0.1 * strain, 1);
        EXPECT_NEAR(clamped.strain / strain, 1.01, 0.03) << i << ": its first edge";
        clamped.draw(0.1 * strain, 6);
        EXPECT_NEAR(clamped.strain / strain, 1.03, 0.03) << i << ": six edges further";
    }
}

// A strip without a slit, drawn along its rows or across them: it holds until its strength.
TEST(Tearing, StartsAtItsStrength) {
    Random random(4);
    for (int i = 0; i < 6; ++i) {
        const double height = random.between(0.1, 0.3), stiffness = log_between(random, 5e3, 2e5);
        const double strain = random.between(0.02, 0.2);
        DeformableDefinition sheet = cloth_rectangle(height, height, height / random.between(5, 9),
                                                     {.stretch_stiffness = stiffness,
                                                      .shear_stiffness = 0.3 * stiffness,
                                                      .rayleigh_damping = 0.01,
                                                      .tear_strength = strain * stiffness});
        if (i % 2 == 0) {
            for (Vec3& node : sheet.nodes) node = {node.z, 0, -node.x};
        }
        Clamped clamped(sheet, height, 0.8 * strain);
        EXPECT_TRUE(clamped.world->lasting_deformation(clamped.sheet).torn_corners.empty()) << i;
        clamped.draw(0.1 * strain, 1);
        EXPECT_NEAR(clamped.strain / strain, 1, 0.02) << i;
    }
}

// Trousers (ISO 13937-2): one leg held, a weight hangs from the other. A metre of tear lets it down by two.
TEST(Tearing, TrousersTearAtHalfTheEnergy) {
    Random random(5);
    for (int i = 0; i < 6; ++i) {
        const bool is_heavy = i % 2 == 0;
        const double width = 0.06, energy = random.between(2, 20), stiffness = log_between(random, 1e4, 1e5);
        const double edge = width / (4 + 2 * static_cast<double>(random.below(2))) * 2 / std::sqrt(3);
        DeformableDefinition sheet = cloth_rectangle(0.3, width, edge,
                                                     {.area_density = 0.1,
                                                      .stretch_stiffness = stiffness,
                                                      .shear_stiffness = stiffness / 2,
                                                      .bend_stiffness = 1e-6,
                                                      .rayleigh_damping = 0.005});
        cut_until(sheet, 0);
        const auto world = make_world();
        const double mass = (is_heavy ? 1.08 : 0.88) * energy / 2 / gravity, end = -0.15;
        const BodyHandle weight = add_holder(*world, BodyKind::dynamic_body, mass, {end, 0, -width / 4});
        const std::vector<bool> above = is_above(sheet);
        for (std::uint32_t node = 0; node < sheet.nodes.size(); ++node) {
            if (sheet.nodes[node].x > end + 0.51 * edge) continue;
            if (above[node])
                sheet.pinned.push_back(node);
            else
                sheet.attachments.push_back(
                    {node, weight, {0, sheet.nodes[node].x - end, sheet.nodes[node].z + width / 4}});
        }
        const DeformableHandle trousers = world->create_deformable(sheet).value();
        // One leg hangs down to the tip, the other from there.
        std::vector<Vec3> places = sheet.nodes;
        for (std::uint32_t node = 0; node < places.size(); ++node) {
            Vec3& at = places[node];
            if (at.x < 0)
                at = {end, above[node] ? end - at.x : end + at.x, at.z};
            else
                at = {at.x + end, end, at.z};
        }
        ASSERT_TRUE(world->set_nodes(trousers, places, std::vector<Vec3>(places.size())).ok());
        ASSERT_TRUE(world->set_pose(weight, {{end, 2 * end, -width / 4}, {}}).ok());
        run(*world, 2);
        const std::size_t before = world->node_positions(trousers).size();
        DeformableDefinition weak = sheet;
        std::get<Cloth>(weak.matter).tear_energy = energy;
        ASSERT_TRUE(world->set_deformable(trousers, weak).ok());
        run(*world, 0.5);
        const std::size_t torn = world->node_positions(trousers).size() - before;
        if (is_heavy)
            EXPECT_GE(torn, 4u) << i;
        else
            EXPECT_EQ(torn, 0u) << i;
    }
}

// At the moment of a tear nothing moves; what bending held at the cut is gone.
TEST(Tearing, ATearAddsNothing) {
    Random random(6);
    for (int i = 0; i < 40; ++i) {
        const DeformableDefinition sheet = cloth_rectangle(
            random.between(0.2, 1), random.between(0.2, 1), random.between(0.05, 0.1),
            {.stretch_stiffness = log_between(random, 100, 1e5),
             .bend_stiffness = log_between(random, 1e-6, 1e-2),
             .bend_friction = random.between(0, 40),
             .bend_yield = i % 2 == 0 ? std::numeric_limits<double>::infinity() : log_between(random, 1, 100)});
        state::DeformableRecord record = state::make_deformable_record(sheet).value();
        const Vec3 wave{random.between(-20, 20), 0, random.between(-20, 20)};
        std::vector<Vec3> places = sheet.nodes, velocities;
        for (Vec3& place : places) {
            place.y = 0.03 * std::sin(dot(wave, place)) + random.between(-0.003, 0.003);
            velocities.push_back({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
        }
        record.set_motion(places, velocities, {});
        const auto& triangles = std::get<Cloth>(sheet.matter).triangles;
        std::vector<std::array<double, 6>> bend(triangles.size());
        for (auto& own : bend) {
            for (std::size_t k = 0; k < 6; ++k) own[k] = k < 3 || i % 2 == 1 ? random.between(-20, 20) : 0;
        }
        record.cloth()->bend_memory().set_state(bend);
        std::vector<SheetEdge> cut;
        for (const auto& triangle : triangles) {
            const std::size_t k = random.below(3);
            if (random.unit() < 0.3) cut.push_back(edge_between(triangle[k], triangle[(k + 1) % 3]));
        }
        const state::DeformableRecord torn =
            state::make_torn_record(record, NodeFans(triangles, sheet.nodes.size()).split(cut, {})).value();
        const Conserved before = record.conserved({}), after = torn.conserved({});
        EXPECT_GT(torn.nodes().size(), sheet.nodes.size()) << i;
        EXPECT_NEAR(after.kinetic_energy, before.kinetic_energy, 1e-12 * before.kinetic_energy) << i;
        EXPECT_LE(length(after.linear_momentum - before.linear_momentum), 1e-12) << i;
        EXPECT_LE(length(after.angular_momentum - before.angular_momentum), 1e-12) << i;
        EXPECT_LE(after.potential_energy, before.potential_energy * (1 + 1e-9)) << i;
    }
}

// Sheets that spin themselves to pieces in free space. A sheet's own first steps gain a little: so a twin that is too
// strong to tear has the measure.
TEST(Tearing, FlyingPiecesKeepMomentum) {
    Random random(7);
    for (int i = 0; i < 8; ++i) {
        const double size = random.between(0.3, 1), density = random.between(0.1, 0.5), spin = random.between(10, 30);
        const double speed = spin * size / 2, pull = density * speed * speed;
        DeformableDefinition sheet = cloth_rectangle(size, random.between(0.6, 1) * size, size / 14,
                                                     {.area_density = density,
                                                      .stretch_stiffness = 50 * pull,
                                                      .shear_stiffness = 20 * pull,
                                                      .rayleigh_damping = 0.002,
                                                      .bend_friction = random.between(0, 40),
                                                      .tear_strength = 0.1 * pull,
                                                      .tear_energy = log_between(random, 1e-6, 1e-4) * pull * size});
        sheet.angular_velocity = spin * normalized(Vec3{random.between(-0.3, 0.3), 1, random.between(-0.3, 0.3)});
        sheet.linear_velocity = {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
        DeformableDefinition strong = sheet;
        std::get<Cloth>(strong.matter).tear_strength = std::get<Cloth>(strong.matter).tear_energy = 1e300;
        const auto world = make_world({.gravity = {}, .air_density = 0}), twin = make_world(world->settings());
        const DeformableHandle handle = world->create_deformable(sheet).value();
        const DeformableHandle whole = twin->create_deformable(strong).value();
        const Conserved first = world->conserved();
        const double mass = world->mass(handle);
        double most = 0, most_of_twin = 0;
        for (int step = 0; step < 180; ++step) {
            world->step();
            twin->step();
            most = std::max(most, energy(*world));
            most_of_twin = std::max(most_of_twin, energy(*twin));
        }
        const Conserved last = world->conserved();
        EXPECT_EQ(twin->node_positions(whole).size(), sheet.nodes.size());
        EXPECT_GT(world->node_positions(handle).size(), sheet.nodes.size() + 10) << i << " has torn";
        EXPECT_NEAR(world->mass(handle), mass, 1e-12 * mass);
        EXPECT_LE(length(last.linear_momentum - first.linear_momentum), 1e-6 * mass * speed) << i;
        EXPECT_LE(length(last.angular_momentum - first.angular_momentum), 1e-3 * length(first.angular_momentum)) << i;
        EXPECT_LE(most, most_of_twin * 1.08) << i;
    }
}

// A tear that much energy drives comes to a column of nodes that something holds, or that threads are tied to: it ends
// there. Threads do not move the nodes.
TEST(Tearing, EndsAtWhatIsHeld) {
    Random random(8);
    for (int i = 0; i < 12; ++i) {
        const bool by_threads = i % 2 == 0;
        const double height = random.between(0.1, 0.3), stiffness = log_between(random, 5e3, 1e5);
        const double strain = random.between(0.02, 0.08), wall = random.between(-0.1, 0.3) * height;
        const double edge = height / (4 + 2 * static_cast<double>(random.below(3))) * 2 / std::sqrt(3);
        DeformableDefinition sheet = cloth_rectangle(
            3 * height, height, edge,
            {.stretch_stiffness = stiffness, .shear_stiffness = stiffness / 2, .rayleigh_damping = 0.01});
        cut_until(sheet, -0.5 * height);
        Clamped clamped(sheet, height, strain);
        World& world = *clamped.world;
        DeformableDefinition weak = *world.deformable(clamped.sheet);
        const auto is_wall = [&](Vec3 place) { return std::fabs(place.x - wall) <= 0.51 * edge; };
        const BodyHandle holder = add_holder(world, BodyKind::kinematic_body, 1, {});
        for (std::uint32_t node = 0; node < weak.nodes.size(); ++node) {
            if (!is_wall(weak.nodes[node]) || std::fabs(weak.nodes[node].z) > height / 2 - 1e-9) continue;
            if (by_threads)
                tie_thread(world, clamped.sheet, node);
            else
                weak.attachments.push_back({node, holder, world.node_positions(clamped.sheet)[node]});
        }
        std::get<Cloth>(weak.matter).tear_energy =
            stiffness * strain * strain * height / 2 / log_between(random, 2, 20);
        ASSERT_TRUE(world.set_deformable(clamped.sheet, weak).ok());
        run(world, 0.5);
        double farthest = -height;
        for (const TornCorner& corner : world.lasting_deformation(clamped.sheet).torn_corners)
            farthest = std::max(farthest, weak.nodes[corner.from].x);
        EXPECT_GT(farthest, wall - 2.5 * edge) << i << ": came to the wall";
        EXPECT_LT(farthest, wall - 0.5 * edge) << i << ": did not pass it";
    }
}

// A tear all around a held node: the sides hang together by it until it is let go.
TEST(Tearing, ComesApartAtANodeThatIsLetGo) {
    Random random(9);
    for (int i = 0; i < 20; ++i) {
        const bool by_thread = i % 2 == 0;
        const double size = random.between(0.2, 0.6), edge = size / 6 * 2 / std::sqrt(3);
        const DeformableDefinition plain =
            cloth_rectangle(size * random.between(1, 2), size, edge,
                            {.tear_strength = i % 3 == 0 ? 1e300 : 2e300, .tear_energy = i % 3 == 1 ? 1e300 : 2e300});
        const double until = random.between(0, 0.5) * size;
        std::vector<std::uint32_t> line;
        for (std::uint32_t node = 0; node < plain.nodes.size(); ++node) {
            if (std::fabs(plain.nodes[node].z) < 1e-9 && plain.nodes[node].x < until - 2.5 * edge) line.push_back(node);
        }
        const std::uint32_t node = line.at(random.below(line.size()));
        std::vector<std::uint8_t> held(plain.nodes.size(), 0);
        held[node] = 1;
        DeformableDefinition cut = plain, stitched = plain;
        cut_until(cut, until);
        cut_until(stitched, until, held);
        ASSERT_EQ(stitched.nodes.size() + 1, cut.nodes.size()) << i;

        const auto world = make_world({.gravity = {}});
        if (!by_thread) stitched.pinned = {node};
        const DeformableHandle sheet = world->create_deformable(stitched).value();
        const DeformableHandle thread = by_thread ? tie_thread(*world, sheet, node) : DeformableHandle{};
        run(*world, 0.05);
        EXPECT_EQ(world->node_positions(sheet).size(), stitched.nodes.size()) << i << ": it is held";
        stitched.pinned.clear();
        if (by_thread)
            ASSERT_TRUE(world->destroy_deformable(thread).ok());
        else
            ASSERT_TRUE(world->set_deformable(sheet, stitched).ok());
        run(*world, 0.05);
        EXPECT_EQ(world->node_positions(sheet).size(), cut.nodes.size()) << i << ": it is let go";
    }
}

// Around the tip of a slit the tension has no value, so that no tear starts there, unless the tip is held: then it does
// not go on either.
TEST(Tearing, StartsBesideAHeldTip) {
    Random random(10);
    for (int i = 0; i < 20; ++i) {
        const bool is_held = i % 2 == 0;
        const double size = random.between(0.2, 0.6), edge = size / 8 * 2 / std::sqrt(3);
        const double stiffness = log_between(random, 1e3, 1e5), strength = random.between(0.01, 0.1) * stiffness;
        DeformableDefinition sheet = cloth_rectangle(size, size, edge,
                                                     {.stretch_stiffness = stiffness,
                                                      .shear_stiffness = 0.3 * stiffness,
                                                      .tear_strength = strength,
                                                      .tear_energy = 1e300});
        cut_until(sheet, random.between(-0.1, 0.1) * size);
        const NodeFans fans(std::get<Cloth>(sheet.matter).triangles, sheet.nodes.size());
        std::vector<std::uint8_t> is_free(sheet.nodes.size(), 0);
        for (std::uint32_t node = 0; node < sheet.nodes.size(); ++node) {
            const auto around = fans.around(node);
            const std::vector<std::uint32_t>& spokes = around.at(0).spokes;
            if (around[0].is_closed() || sheet.nodes[spokes.front()] != sheet.nodes[spokes.back()]) continue;
            is_free[node] = !is_held;
            for (const std::uint32_t near : spokes) is_free[near] = 1;
        }
        for (std::uint32_t node = 0; node < sheet.nodes.size(); ++node) {
            if (is_free[node] == 0) sheet.pinned.push_back(node);
        }
        const double stretch = random.between(1.5, 2) * strength / stiffness;
        std::vector<Vec3> places = sheet.nodes;
        for (Vec3& place : places) place = (1 + stretch) * place;
        const auto world = make_world({.gravity = {}});
        const DeformableHandle handle = world->create_deformable(sheet).value();
        ASSERT_TRUE(world->set_nodes(handle, places, std::vector<Vec3>(places.size())).ok());
        world->step();
        EXPECT_EQ(world->sheet_tear_events().size(), is_held ? 1u : 0u) << i;
    }
}

// What liquids know of a sheet's nodes, and what its ties pull, goes on with them.
TEST(Tearing, KeepsWhatLiquidsAndTiesKnow) {
    Random random(11);
    for (int i = 0; i < 20; ++i) {
        const DeformableDefinition sheet =
            cloth_rectangle(random.between(0.2, 1), random.between(0.2, 1), random.between(0.05, 0.1));
        state::DeformableRecord record = state::make_deformable_record(sheet).value();
        const auto any = [&](std::size_t count) {
            std::vector<Vec3> values;
            for (std::size_t k = 0; k < count; ++k)
                values.push_back({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
            return values;
        };
        const std::size_t nodes = sheet.nodes.size();
        record.liquid = {random.below(100), any(nodes), any(nodes), any(nodes),
                         any(nodes),        any(nodes), any(nodes), true};
        record.tie_pulls = any(3);
        const auto& triangles = std::get<Cloth>(sheet.matter).triangles;
        std::vector<SheetEdge> cut;
        for (const auto& triangle : triangles) {
            const std::size_t k = random.below(3);
            if (random.unit() < 0.3) cut.push_back(edge_between(triangle[k], triangle[(k + 1) % 3]));
        }
        const std::vector<TornCorner> corners = NodeFans(triangles, nodes).split(cut, {});
        const state::DeformableRecord torn = state::make_torn_record(record, corners).value();
        EXPECT_EQ(torn.tie_pulls, record.tie_pulls);
        EXPECT_EQ(torn.liquid.step, record.liquid.step);
        EXPECT_TRUE(torn.liquid.wakes);
        for (const auto shared : {&state::LiquidMemory::force, &state::LiquidMemory::bound,
                                  &state::LiquidMemory::bound_momentum, &state::LiquidMemory::force_asleep}) {
            Vec3 before, after;
            for (const Vec3 value : record.liquid.*shared) before += value;
            for (const Vec3 value : torn.liquid.*shared) after += value;
            EXPECT_LE(length(after - before), 1e-12) << i;
            EXPECT_EQ((torn.liquid.*shared).size(), torn.nodes().size());
        }
        for (const auto same : {&state::LiquidMemory::velocity, &state::LiquidMemory::acceleration}) {
            ASSERT_EQ((torn.liquid.*same).size(), torn.nodes().size());
            for (const TornCorner& corner : corners)
                EXPECT_EQ((torn.liquid.*same)[corner.node], (record.liquid.*same)[corner.from]);
        }
    }
}

// A ball that is blown up too far loses its gas with its first tear.
TEST(Tearing, ABallBursts) {
    const auto world = make_world({.gravity = {}});
    DeformableDefinition ball = cloth_ball(0.15, 0.03,
                                           {.stretch_stiffness = 2e4,
                                            .shear_stiffness = 1e4,
                                            .rayleigh_damping = 1e-3,
                                            .internal_pressure = 5e3,
                                            .tear_strength = 120,
                                            .tear_energy = 1});
    const DeformableHandle handle = world->create_deformable(ball).value();
    ASSERT_TRUE(world->gas_inside(handle).has_value());
    run(*world, 1);
    EXPECT_FALSE(world->gas_inside(handle).has_value());
    EXPECT_TRUE(std::isfinite(energy(*world)));
}

// What is torn can be put into another world, and goes on there as here.
TEST(Tearing, IsLastingAndGoesOnTheSame) {
    const auto definition = [] {
        DeformableDefinition sheet = cloth_rectangle(0.6, 0.4, 0.05,
                                                     {.stretch_stiffness = 2000,
                                                      .shear_stiffness = 500,
                                                      .rayleigh_damping = 1e-3,
                                                      .drag_coefficient = 0,
                                                      .tear_strength = 40,
                                                      .tear_energy = 0.2});
        for (std::uint32_t node = 0; node < sheet.nodes.size(); ++node) {
            if (sheet.nodes[node].z > 0.2 - 1e-9) sheet.pinned.push_back(node);
        }
        sheet.force = {1, 0, -25};
        return sheet;
    }();
    const auto first = make_world(), second = make_world();
    const DeformableHandle sheet = first->create_deformable(definition).value();
    run(*first, 0.5);
    const LastingDeformation lasting = first->lasting_deformation(sheet);
    ASSERT_FALSE(lasting.torn_corners.empty());
    const std::size_t count = first->node_positions(sheet).size();
    EXPECT_EQ(first->deformable(sheet)->nodes.size(), count);

    const DeformableHandle copy = second->create_deformable(definition).value();
    ASSERT_TRUE(second->set_lasting_deformation(copy, lasting).ok());
    EXPECT_EQ(std::get<Cloth>(second->deformable(copy)->matter).triangles,
              std::get<Cloth>(first->deformable(sheet)->matter).triangles);
    const std::vector<Vec3> still(count);
    const std::vector<Vec3> places(first->node_positions(sheet).begin(), first->node_positions(sheet).end());
    ASSERT_TRUE(second->set_nodes(copy, places, still).ok());
    ASSERT_TRUE(first->set_nodes(sheet, places, still).ok());
    first->set_clock(0, 0);
    DeformableDefinition pulled = definition;
    pulled.force = 2 * definition.force;
    ASSERT_TRUE(first->set_deformable(sheet, pulled).ok());
    ASSERT_TRUE(second->set_deformable(copy, pulled).ok());
    EXPECT_EQ(first->node_positions(sheet).size(), count) << "is as torn as it was";
    run(*first, 0.3);
    run(*second, 0.3);
    EXPECT_TRUE(std::ranges::equal(first->node_positions(sheet), second->node_positions(copy)));
    EXPECT_EQ(first->lasting_deformation(sheet).torn_corners, second->lasting_deformation(copy).torn_corners);
    EXPECT_GT(first->node_positions(sheet).size(), count) << "has torn on";

    EXPECT_FALSE(first->set_lasting_deformation(sheet, lasting).ok()) << "it is torn otherwise";
    DeformableDefinition turned = *second->deformable(copy);
    for (auto& [a, b, c] : std::get<Cloth>(turned.matter).triangles) std::tie(a, b, c) = std::tuple(b, c, a);
    ASSERT_TRUE(second->set_deformable(copy, turned).ok());
    EXPECT_TRUE(second->lasting_deformation(copy).torn_corners.empty()) << "the corners are others";
    const std::uint32_t first_node = std::get<Cloth>(definition.matter).triangles[0][0], next = first_node + 1;
    for (const TornCorner wrong :
         {TornCorner{1'000'000, 0, 0}, TornCorner{0, first_node, 1'000'000}, TornCorner{0, first_node, next},
          TornCorner{0, next, next}, TornCorner{0, first_node, first_node}}) {
        const auto whole = make_world();
        const DeformableHandle own = whole->create_deformable(definition).value();
        const Result<void> set = whole->set_lasting_deformation(own, {.torn_corners = {wrong}});
        ASSERT_FALSE(set.ok());
        EXPECT_EQ(set.error().where, "torn_corners[0]");
        EXPECT_EQ(whole->node_positions(own).size(), definition.nodes.size());
    }
}

}  // namespace
}  // namespace embody::physics
