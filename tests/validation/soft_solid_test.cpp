// SPDX-License-Identifier: MIT
// Soft solids beside the theory of elasticity, and with rigid bodies.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/solid/solid_deformable.h"
#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using namespace deformable;

constexpr double g = 9.81;

DeformableDefinition brick(Vec3 size, std::array<int, 3> cells, double density, double youngs_modulus,
                           double poisson_ratio, double damping) {
    DeformableDefinition definition = tetrahedral_brick(size, cells);
    SoftSolid& solid = std::get<SoftSolid>(definition.matter);
    solid.density = density;
    solid.youngs_modulus = youngs_modulus;
    solid.poisson_ratio = poisson_ratio;
    solid.rayleigh_damping = damping;
    return definition;
}

void pin_where(DeformableDefinition& definition, const auto& is_pinned) {
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        if (is_pinned(definition.nodes[i])) definition.pinned.push_back(i);
    }
}

// Mean way of the nodes that count along an axis.
double mean_way(const World& world, DeformableHandle handle, const auto& is_counted, int axis) {
    const DeformableDefinition& definition = *world.deformable(handle);
    const auto positions = world.node_positions(handle);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!is_counted(definition.nodes[i])) continue;
        sum += positions[i][axis] - definition.nodes[i][axis];
        ++count;
    }
    return sum / count;
}

TEST(SoftSolid, AHangingBarStretchesByItsOwnWeight) {
    const auto reference = reference_case("bar_self_weight");
    const double length_of_bar = reference["setup"]["L"];
    DeformableDefinition bar =
        brick({0.1, length_of_bar, 0.1}, {1, 10, 1}, reference["setup"]["rho"], reference["setup"]["E"], 0, 0.02);
    pin_where(bar, [&](Vec3 p) { return p.y == length_of_bar; });
    const auto world = make_world({});
    const DeformableHandle handle = world->create_deformable(bar).value();
    run(*world, 10);
    const double expected = reference["expected"]["dL"];
    const double stretch = -mean_way(
        *world, handle, [](Vec3 p) { return p.y == 0; }, 1);
    EXPECT_NEAR(stretch, expected, static_cast<double>(reference["tolerance"]["rel"]) * expected);
    EXPECT_LT(world->conserved().kinetic_energy, 1e-8);
}

DeformableDefinition cantilever(const nlohmann::json& setup, std::array<int, 3> cells, double damping) {
    const double length_of_beam = setup["L"];
    const double width = setup["section"][0], height = setup["section"][1];
    DeformableDefinition beam = brick({length_of_beam, height, width}, cells, setup["rho"], setup["E"], 0.3, damping);
    pin_where(beam, [](Vec3 p) { return p.x == 0; });
    return beam;
}

double tip_way(const World& world, DeformableHandle handle) {
    const double end = world.deformable(handle)->nodes.back().x;
    return mean_way(
        world, handle, [&](Vec3 p) { return p.x == end; }, 1);
}

TEST(SoftSolid, ACantileverBendsByItsOwnWeight) {
    const auto reference = reference_case("cantilever_gravity");
    const double expected = reference["expected"]["tip"];
    for (const std::array<int, 3> cells : {std::array<int, 3>{20, 2, 2}, std::array<int, 3>{40, 4, 4}}) {
        const auto world = make_world({});
        const DeformableHandle handle = world->create_deformable(cantilever(reference["setup"], cells, 0.01)).value();
        run(*world, 3);
        EXPECT_NEAR(-tip_way(*world, handle), expected, static_cast<double>(reference["tolerance"]["rel"]) * expected)
            << cells[1] << " across";
    }
}

TEST(SoftSolid, ACantileverSwingsAtItsFrequency) {
    const auto reference = reference_case("cantilever_freq");
    const double expected = reference["expected"]["f1"];
    WorldSettings settings;
    settings.time_step = 1.0 / 240;
    const auto world = make_world(settings);
    const DeformableHandle handle = world->create_deformable(cantilever(reference["setup"], {20, 2, 2}, 0)).value();
    // From straight: it swings about where it will hang, which it passes upwards once a period.
    std::vector<double> way;
    for (int i = 0; i < 480; ++i) {
        world->step();
        way.push_back(tip_way(*world, handle));
    }
    const auto [lowest, highest] = std::minmax_element(way.begin(), way.begin() + 80);
    const double middle = (*lowest + *highest) / 2;
    double first = 0, last = 0;
    int crossings = 0;
    for (std::size_t i = 1; i < way.size(); ++i) {
        if (!(way[i - 1] < middle && way[i] >= middle)) continue;
        last = (static_cast<double>(i) + (middle - way[i - 1]) / (way[i] - way[i - 1])) * settings.time_step;
        if (crossings++ == 0) first = last;
    }
    ASSERT_GE(crossings, 4);
    EXPECT_NEAR((crossings - 1) / (last - first), expected,
                static_cast<double>(reference["tolerance"]["rel"]) * expected);
}

TEST(SoftSolid, AFreeOneKeepsItsMomenta) {
    const auto reference = reference_case("soft_momentum");
    DeformableDefinition block = brick({0.4, 0.2, 0.2}, {4, 2, 2}, 1000, 1e5, 0.4, 0);
    block.linear_velocity = {1, 2, 0.5};
    block.angular_velocity = {3, 1, 2};
    WorldSettings settings;
    settings.gravity = {};
    const auto world = make_world(settings);
    ASSERT_TRUE(world->create_deformable(block).ok());
    const Conserved before = world->conserved();
    const double duration = reference["setup"]["duration"];
    run(*world, duration);
    const Conserved after = world->conserved();
    EXPECT_LT(length(after.linear_momentum - before.linear_momentum),
              static_cast<double>(reference["tolerance"]["p_rel"]) * length(before.linear_momentum));
    const Vec3 center{0.2, 0.1, 0.1};
    const Vec3 center_after = center + (duration / (0.4 * 0.2 * 0.2 * 1000)) * before.linear_momentum;
    const Vec3 spin_before = before.angular_momentum - cross(center, before.linear_momentum);
    const Vec3 spin_after = after.angular_momentum - cross(center_after, after.linear_momentum);
    EXPECT_LT(length(spin_after - spin_before),
              static_cast<double>(reference["tolerance"]["L_rel"]) * length(spin_before));
    EXPECT_LE(after.kinetic_energy + after.potential_energy, 1.001 * (before.kinetic_energy + before.potential_energy));
}

TEST(SoftSolid, AFreeOneFallsExactly) {
    DeformableDefinition block = tetrahedral_brick({0.2, 0.2, 0.2}, {2, 2, 2});
    block.pose.position = {1000, 100, -1000};
    const auto world = make_world({});
    const DeformableHandle handle = world->create_deformable(block).value();
    run(*world, 2);
    for (std::size_t i = 0; i < block.nodes.size(); ++i) {
        EXPECT_NEAR(world->node_positions(handle)[i].y, 100 + block.nodes[i].y - g * 4 / 2, 1e-6);
        EXPECT_NEAR(world->node_velocities(handle)[i].y, -g * 2, 1e-6);
    }
}

BodyHandle add_box(World& world, Vec3 half, Vec3 position, double mass) {
    const ShapeHandle shape = world.create_shape(BoxShape{half}).value();
    BodyDefinition box;
    box.shape = shape;
    box.position = position;
    box.mass.mass = mass;
    box.material.restitution = 0;
    return world.create_body(box).value();
}

TEST(SoftSolid, ACushionCarriesABox) {
    DeformableDefinition cushion = brick({0.5, 0.15, 0.5}, {10, 3, 10}, 40, 2e4, 0.2, 0.02);
    cushion.pose.position = {-0.25, 0.002, -0.25};
    const auto world = make_world({});
    add_plane(*world, {});
    const BodyHandle box = add_box(*world, {0.2, 0.05, 0.2}, {0, 0.25, 0}, 10);
    const DeformableHandle handle = world->create_deformable(cushion).value();
    run(*world, 3);
    EXPECT_LT(length(world->linear_velocity(box)), 0.005);
    // It sinks in by about p L / E, a tenth of which the part around the box bears.
    const double sunk = 0.15 + 2 * cushion.contact_radius - (world->pose(box).position.y - 0.05);
    const double one_dimensional = 10 * g / (0.4 * 0.4) / 2e4 * 0.15;
    EXPECT_GT(sunk, 0.6 * one_dimensional);
    EXPECT_LT(sunk, 1.1 * one_dimensional);
    for (const Vec3 p : world->node_positions(handle)) EXPECT_GT(p.y, -1e-3);
}

// From light to a thousand times the cushion's mass, from what dents it to what squashes it flat.
TEST(SoftSolid, ACushionBearsMassesUpToAThousandTimesItsOwn) {
    struct Case {
        double mass, youngs_modulus;
    };
    for (const auto [mass, youngs_modulus] : {Case{0.05, 2e4}, {100, 2e4}, {10, 2e6}, {1500, 5e5}, {1500, 2e4}}) {
        DeformableDefinition cushion = brick({0.5, 0.15, 0.5}, {5, 2, 5}, 40, youngs_modulus, 0.2, 0.02);
        cushion.pose.position = {-0.25, 0.002, -0.25};
        const auto world = make_world({});
        add_plane(*world, {});
        const BodyHandle box = add_box(*world, {0.2, 0.05, 0.2}, {0, 0.25, 0}, mass);
        const DeformableHandle handle = world->create_deformable(cushion).value();
        double fastest = 0;
        for (int i = 0; i < 240; ++i) {
            world->step();
            for (const Vec3 v : world->node_velocities(handle)) fastest = std::max(fastest, length(v));
        }
        // It cannot come to more speed than the box had, but where it slips out of what squashes it.
        EXPECT_LT(fastest, 15) << mass << " kg on " << youngs_modulus << " Pa";
        EXPECT_LT(length(world->linear_velocity(box)), 0.02) << mass << " kg on " << youngs_modulus << " Pa";
        EXPECT_TRUE(world->is_asleep(handle)) << mass << " kg on " << youngs_modulus << " Pa";
        // One-dimensional compression, of which the part around the box bears up to a third; no more than there is.
        const double strain = mass * g / (0.4 * 0.4) / youngs_modulus;
        const double sunk = 0.15 - (world->pose(box).position.y - 0.05 - 2 * cushion.contact_radius);
        EXPECT_GT(sunk, std::min(0.6 * 0.15 * strain, 0.14) - 0.001) << mass << " kg on " << youngs_modulus << " Pa";
        EXPECT_LT(sunk, std::min(1.1 * 0.15 * strain, 0.151) + 0.001) << mass << " kg on " << youngs_modulus << " Pa";
    }
}

// The ball is finer than the cushion's mesh: it lies between the nodes.
TEST(SoftSolid, ABallSmallerThanItsElementsStaysOn) {
    DeformableDefinition cushion = brick({0.5, 0.15, 0.5}, {5, 2, 5}, 40, 2e4, 0.2, 0.05);
    cushion.pose.position = {-0.25, 0.002, -0.25};
    const auto world = make_world({});
    add_plane(*world, {});
    BodyDefinition ball;
    ball.shape = world->create_shape(SphereShape{0.02}).value();
    ball.position = {0.03, 0.3, 0.04};
    ball.mass.mass = 0.05;
    ball.material.restitution = 0;
    ball.material.friction_rolling = 0.002;
    const BodyHandle body = world->create_body(ball).value();
    ASSERT_TRUE(world->create_deformable(cushion).ok());
    for (int i = 0; i < 240; ++i) {
        world->step();
        ASSERT_GT(world->pose(body).position.y, 0.13);
    }
    EXPECT_LT(length(world->linear_velocity(body)), 0.05);
}

// Of a bar that was stretched by this share, held so for a second and let go.
double lasting_stretch(double strain, double yield_strain) {
    constexpr double long_side = 0.4, youngs_modulus = 1e5;
    DeformableDefinition bar = brick({0.1, long_side, 0.1}, {2, 8, 2}, 1000, youngs_modulus, 0.3, 0.02);
    std::get<SoftSolid>(bar.matter).yield_stress = yield_strain * youngs_modulus;
    pin_where(bar, [](Vec3 p) { return p.y == 0 || p.y == long_side; });
    WorldSettings settings;
    settings.gravity = {};
    const auto world = make_world(settings);
    const DeformableHandle handle = world->create_deformable(bar).value();
    std::vector<Vec3> stretched = bar.nodes;
    for (Vec3& p : stretched) p.y *= 1 + strain;
    EXPECT_TRUE(world->set_nodes(handle, stretched, std::vector<Vec3>(stretched.size())).ok());
    run(*world, 1);
    bar.pinned.clear();
    pin_where(bar, [](Vec3 p) { return p.y == 0; });
    EXPECT_TRUE(world->set_deformable(handle, bar).ok());
    run(*world, 3);
    return mean_way(
               *world, handle, [](Vec3 p) { return p.y == long_side; }, 1) /
           long_side;
}

TEST(SoftSolid, WhatIsStressedBeyondItsYieldStressStaysDeformed) {
    EXPECT_NEAR(lasting_stretch(0.03, 0.04), 0, 1e-4);
    // What the yield stress bears is elastic, the rest has flowed.
    EXPECT_NEAR(lasting_stretch(0.10, 0.04), 0.06, 0.004);
    EXPECT_NEAR(lasting_stretch(0.10, 0.02), 0.08, 0.004);
}

TEST(SoftSolid, GasInsideResistsAChangeOfVolume) {
    constexpr double youngs_modulus = 1e5, poisson_ratio = 0.3, pressure = 5e4, outside = 2e3, air = 101'325;
    DeformableDefinition block = brick({0.2, 0.2, 0.2}, {3, 3, 3}, 100, youngs_modulus, poisson_ratio, 0.05);
    std::get<SoftSolid>(block.matter).internal_pressure = pressure;
    SolidDeformable solid(block);
    EnclosedGas gas(pressure, solid.surface(), block.nodes);
    TaskPool workers(1);
    for (int i = 0; i < 500; ++i) {
        // Along the surface as it has gone on: a push that lags would turn the block ever faster.
        solid.begin_substep(1.0 / 120, {});
        gas.measure(solid.surface(), solid.nodes().position);
        for (const std::uint32_t node : solid.surface_nodes()) solid.push(node, -outside * gas.slope()[node]);
        solid.solve(workers);
        solid.finish();
    }
    // Bulk moduli add: of the matter, with what its tension does, and by Boyle's law the pressure of the gas
    // itself.
    const double bulk = youngs_modulus / (3 * (1 - 2 * poisson_ratio)) + pressure / 3 + pressure + air;
    const double shrinking = gas.excess() / (pressure + air);
    EXPECT_NEAR(shrinking, outside / bulk, 0.02 * outside / bulk);
}

TEST(SoftSolid, AnInflatedCushionCarriesMoreThanAnEmptyOne) {
    const auto height_of_box = [](double pressure) {
        DeformableDefinition cushion = brick({0.4, 0.1, 0.4}, {6, 2, 6}, 30, 1e4, 0.3, 0.02);
        std::get<SoftSolid>(cushion.matter).internal_pressure = pressure;
        cushion.pose.position = {-0.2, 0.002, -0.2};
        const auto world = make_world({});
        add_plane(*world, {});
        EXPECT_TRUE(world->create_deformable(cushion).ok());
        const BodyHandle box = add_box(*world, {0.1, 0.1, 0.1}, {0, 0.21, 0}, 20);
        run(*world, 6);
        EXPECT_NE(world->sleep_state(box), SleepState::active);
        return world->pose(box).position.y - 0.1;
    };
    const double empty = height_of_box(0), filled = height_of_box(2e3), hard = height_of_box(2e4);
    EXPECT_GT(filled, empty + 0.005);
    EXPECT_GT(hard, filled + 0.005);
    EXPECT_LT(hard, 0.103);
}

TEST(SoftSolid, CushionsLieOnEachOther) {
    const auto world = make_world({});
    add_plane(*world, {});
    std::vector<DeformableHandle> cushions;
    for (int i = 0; i < 3; ++i) {
        DeformableDefinition cushion = brick({0.4, 0.12, 0.4}, {5, 2, 5}, 60, 3e4, 0.2, 0.03);
        cushion.pose.position = {-0.2 + 0.03 * i, 0.01 + 0.16 * i, -0.2 - 0.02 * i};
        cushions.push_back(world->create_deformable(cushion).value());
    }
    run(*world, 4);
    for (std::size_t i = 0; i < cushions.size(); ++i) {
        EXPECT_TRUE(world->is_asleep(cushions[i])) << i;
        const double middle = world->center_of_mass(cushions[i]).y;
        // Their weight of 11 N presses those below by less than a tenth of a millimetre each.
        EXPECT_NEAR(middle, 0.001 + 0.06 + 0.122 * static_cast<double>(i), 0.002) << i;
    }
    // Friction holds them where they are.
    EXPECT_NEAR(world->center_of_mass(cushions[2]).x, 0.06, 0.01);
}

TEST(SoftSolid, ThoseThatBeginWithinEachOtherPartGently) {
    for (const double beside : {0.0, 0.05, 0.12}) {
        const auto world = make_world({});
        add_plane(*world, {});
        std::array<DeformableHandle, 2> boxes;
        for (std::size_t i = 0; i < 2; ++i) {
            DeformableDefinition box = brick({0.2, 0.2, 0.2}, {4, 4, 4}, 1000, 1e5, 0.3, 0.03);
            box.pose.position = {beside * static_cast<double>(i), 0.01, 0};
            boxes[i] = world->create_deformable(box).value();
        }
        std::array<Vec3, 2> before;
        double fastest = 0;
        for (int k = 0; k < 6 * 60; ++k) {
            world->step();
            for (std::size_t i = 0; i < 2; ++i) {
                const Vec3 now = world->center_of_mass(boxes[i]);
                if (k > 0) fastest = std::max(fastest, 60 * length(now - before[i]));
                before[i] = now;
            }
        }
        EXPECT_LT(fastest, 1) << beside;  // m/s
        const Vec3 apart = world->center_of_mass(boxes[1]) - world->center_of_mass(boxes[0]);
        const Vec3 size = abs(apart);
        EXPECT_GT(std::max({size.x, size.y, size.z}), 0.19) << beside;
        for (const DeformableHandle box : boxes) {
            EXPECT_TRUE(world->is_asleep(box)) << beside;
            // Whole again: no corner is caught in the other.
            const std::span<const Vec3> nodes = world->node_positions(box);
            EXPECT_NEAR(length(nodes.back() - nodes.front()), std::sqrt(3.0) * 0.2, 0.01) << beside;
        }
    }
}

TEST(SoftSolid, TurnedInsideOutOrFlatItComesBack) {
    for (const bool is_flat : {false, true}) {
        DeformableDefinition block = brick({0.4, 0.2, 0.2}, {4, 2, 2}, 1000, 1e5, 0.3, 0.02);
        WorldSettings settings;
        settings.gravity = {};
        const auto world = make_world(settings);
        const DeformableHandle handle = world->create_deformable(block).value();
        std::vector<Vec3> thrown;
        for (std::size_t i = 0; i < block.nodes.size(); ++i) {
            const double k = static_cast<double>(i);
            thrown.push_back({0.2 + 0.2 * std::sin(12.9 * k), is_flat ? 0.0 : 0.1 + 0.2 * std::sin(78.2 * k),
                              0.1 + 0.2 * std::sin(37.7 * k)});
        }
        ASSERT_TRUE(world->set_nodes(handle, thrown, std::vector<Vec3>(thrown.size())).ok());
        run(*world, 4);
        const auto positions = world->node_positions(handle);
        for (const auto& corners : std::get<SoftSolid>(block.matter).tetrahedra) {
            const auto volume = [&](auto at) {
                const Vec3 origin = at(corners[0]);
                return dot(at(corners[1]) - origin, cross(at(corners[2]) - origin, at(corners[3]) - origin));
            };
            const double rest = volume([&](std::uint32_t i) { return block.nodes[i]; });
            EXPECT_GT(volume([&](std::uint32_t i) { return positions[i]; }) / rest, 0.5) << is_flat;
        }
    }
}

// A cube of 20 cm and 8 kg, E = 100 kPa.
DeformableDefinition soft_cube(double damping) { return brick({0.2, 0.2, 0.2}, {4, 4, 4}, 1000, 1e5, 0.3, damping); }

TEST(SoftSolid, AnImpactAtAnySpeedMakesNoEnergy) {
    // Up to four times its own size a substep.
    for (const double speed : {20.0, 40.0, 100.0}) {
        const auto world = make_world({});
        add_plane(*world, friction(0.5));
        DeformableDefinition cube = soft_cube(0.02);
        cube.pose.position = {0, 1, 0};
        cube.linear_velocity = {0, -speed, 0};
        const DeformableHandle handle = world->create_deformable(cube).value();
        const double start = energy(*world);
        double most = start;
        for (int i = 0; i < 240; ++i) {
            world->step();
            most = std::max(most, energy(*world));
        }
        EXPECT_LT(most, 1.05 * start) << speed;
        EXPECT_LT(world->conserved().kinetic_energy, 0.05 * start) << speed;
        const Vec3 center = world->center_of_mass(handle);
        EXPECT_GT(center.y, 0) << speed;
        EXPECT_LT(length(center), 10) << speed;
    }
}

// Every node is held to a box of an eighth of its mass and a hundredth of its inertia, which is struck as it sleeps.
TEST(SoftSolid, HeldToALightBodyItGainsNoEnergy) {
    const auto world = make_world({});
    add_plane(*world, {});
    DeformableDefinition block = brick({0.2, 0.2, 0.2}, {5, 5, 5}, 1000, 5e4, 0.3, 0.03);
    block.pose.position = {-0.1, 0.4, -0.1};
    const Vec3 at{0, 0.8, 0.1};
    const BodyHandle box = add_box(*world, {0.05, 0.05, 0.05}, at, 1);
    for (std::uint32_t i = 0; i < block.nodes.size(); ++i)
        block.attachments.push_back({i, box, block.pose.position + block.nodes[i] - at});
    const DeformableHandle soft = world->create_deformable(block).value();
    const auto energy = [&] { return world->conserved().kinetic_energy + world->conserved().potential_energy; };
    const double most = 1.001 * energy();
    for (int k = 0; k < 120; ++k) {
        world->step();
        EXPECT_LT(energy(), most) << k;
    }
    ASSERT_TRUE(world->is_asleep(soft));
    const double before = energy();
    const Vec3 strike{6, 15, 0};  // N s
    ASSERT_TRUE(world->apply_impulse(box, strike));
    const double given = length_squared(strike) / 2;  // J, to 1 kg: most is lost as the two become one
    for (int k = 0; k < 180; ++k) {
        world->step();
        EXPECT_LT(energy(), before + given) << k;
    }
}

// Its own weight would squash it to a twentieth of nothing: it lies on the floor as a puddle, no part of it below.
TEST(SoftSolid, MatterThatCannotBearItselfLiesOnTheFloor) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    DeformableDefinition cube = brick({0.2, 0.2, 0.2}, {4, 4, 4}, 1000, 100, 0.3, 0.02);
    cube.pose.position = {-0.1, 0.05, -0.1};
    const DeformableHandle soft = world->create_deformable(cube).value();
    const double most = 1.01 * energy(*world);
    for (int k = 0; k < 240; ++k) {
        world->step();
        EXPECT_LT(energy(*world), most) << k;
    }
    for (const Vec3 node : world->node_positions(soft)) EXPECT_GT(node.y, -0.002);
    EXPECT_TRUE(world->is_asleep(soft));
}

// A ton hangs by nine nodes of a cube of 8 kg, which cannot bear it and stretches far: it neither floats nor rises.
TEST(SoftSolid, WhatItCannotBearStretchesItWithoutEnergyFromNowhere) {
    const auto world = make_world({});
    DeformableDefinition cube = soft_cube(0.02);
    cube.pose.position = {-0.1, 1.9, -0.1};
    const Vec3 at{0, 1.8, 0};
    const BodyHandle weight = add_box(*world, {0.05, 0.05, 0.05}, at, 1000);
    for (std::uint32_t i = 0; i < cube.nodes.size(); ++i) {
        const Vec3 place = cube.pose.position + cube.nodes[i];
        if (length(place - Vec3{0, 2.1, 0}) < 0.08) cube.pinned.push_back(i);
        if (length(place - Vec3{0, 1.9, 0}) < 0.08) cube.attachments.push_back({i, weight, place - at});
    }
    ASSERT_TRUE(world->create_deformable(cube).ok());
    const double most = 1.01 * energy(*world);
    for (int k = 0; k < 300; ++k) {
        world->step();
        EXPECT_LT(energy(*world), most) << k;
        EXPECT_LT(world->pose(weight).position.y, 1.8 + 1e-6) << k;
    }
    EXPECT_LT(world->pose(weight).position.y, 1.6);
}

TEST(SoftSolid, AFastSpinKeepsItsEnergy) {
    for (const double spin : {20.0, 50.0}) {
        const auto world = make_world({.gravity = {}});
        DeformableDefinition cube = soft_cube(0);
        cube.angular_velocity = {0, spin, 0};
        ASSERT_TRUE(world->create_deformable(cube).ok());
        const double start = energy(*world);
        for (int k = 0; k < 240; ++k) {
            world->step();
            EXPECT_LT(energy(*world), 1.05 * start) << spin << " rad/s, step " << k;
        }
        EXPECT_GT(energy(*world), 0.9 * start) << spin;
    }
}

// Of which no substep can follow a quarter: what it cannot follow is lost, not won.
TEST(SoftSolid, ASpinBeyondWhatStepsCanFollowMakesNoEnergy) {
    const auto world = make_world({.gravity = {}});
    DeformableDefinition cube = soft_cube(0.02);
    cube.angular_velocity = {1000, 0, 0};
    ASSERT_TRUE(world->create_deformable(cube).ok());
    const double start = energy(*world);
    for (int k = 0; k < 120; ++k) {
        world->step();
        EXPECT_LT(energy(*world), 1.01 * start) << k;
    }
}

// About any axis, at any speed, of any stiffness. Velocities are turned back by half a substep along the tangent, which
// keeps the angular momentum and makes them longer, and a hundredth of the energy may add up.
TEST(SoftSolid, NoSpinMakesEnergy) {
    const SolidSettings settings;
    // Of the first energy; rotations that are followed in large turns add a little in each substep.
    const double rounding = 0.01;
    const double most =
        (1 + settings.max_turn_back * settings.max_turn_back) * (1 + settings.max_energy_gain) + rounding;
    Random random(7);
    for (int k = 0; k < 40; ++k) {
        const double spin = std::pow(10, random.between(1.7, 3.7)), stiffness = std::pow(10, random.between(4, 7));
        const int cells = 2 + k % 3;
        const auto world = make_world({.gravity = {}});
        DeformableDefinition cube =
            brick({0.2, 0.2, 0.2}, {cells, cells, cells}, 1000, stiffness, 0.3, k % 2 == 0 ? 0.02 : 0.0);
        cube.angular_velocity = spin * random_direction(random);
        ASSERT_TRUE(world->create_deformable(cube).ok());
        const double start = energy(*world);
        for (int i = 0; i < 120; ++i) {
            world->step();
            ASSERT_LT(energy(*world), most * start)
                << k << ": " << spin << " rad/s, " << stiffness << " Pa, step " << i;
        }
    }
}

TEST(SoftSolid, DampingDoesNotDriveAFastSpin) {
    for (const double damping : {0.02, 1.0}) {
        const auto world = make_world({.gravity = {}});
        DeformableDefinition cube = soft_cube(damping);
        cube.angular_velocity = {0, 50, 0};
        ASSERT_TRUE(world->create_deformable(cube).ok());
        const Conserved start = world->conserved();
        run(*world, 4);
        const Conserved end = world->conserved();
        EXPECT_LT(end.kinetic_energy + end.potential_energy, 1.05 * start.kinetic_energy) << damping;
        EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 0.1 * length(start.angular_momentum))
            << damping;
    }
}

TEST(SoftSolid, TheSameBitsForAnyNumberOfWorkers) {
    std::uint64_t first = 0;
    for (const int workers : {1, 2, 3, 4}) {
        WorldSettings settings;
        settings.workers = workers;
        const auto world = make_world(settings);
        add_plane(*world, {});
        add_box(*world, {0.2, 0.05, 0.2}, {0, 0.25, 0}, 10);
        // One alone is solved by all workers, several one by each.
        DeformableDefinition cushion = brick({0.5, 0.15, 0.5}, {10, 3, 10}, 40, 2e4, 0.2, 0.02);
        cushion.pose.position = {-0.25, 0.002, -0.25};
        ASSERT_TRUE(world->create_deformable(cushion).ok());
        run(*world, 0.5);
        cushion = brick({0.4, 0.1, 0.4}, {4, 2, 4}, 40, 2e4, 0.2, 0.02);
        for (const double x : {1.0, 1.02, 2.0}) {
            cushion.pose.position = {x, x == 1.02 ? 0.15 : 0.002, 0};
            ASSERT_TRUE(world->create_deformable(cushion).ok());
        }
        run(*world, 0.5);
        if (workers == 1) first = world->state_hash();
        EXPECT_EQ(world->state_hash(), first) << workers;
    }
}

}  // namespace
}  // namespace embody::physics
