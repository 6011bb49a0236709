// SPDX-License-Identifier: MIT
// The parts of a soft solid: forces are what energies lose, stiffness is symmetric, rigid motions cost nothing;
// surfaces are found as a plain search finds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "foundation/task_pool.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/gas/enclosed_gas.h"
#include "physics/deformable/solid/node_compliance.h"
#include "physics/deformable/solid/solid_contacts.h"
#include "physics/deformable/solid/solid_deformable.h"
#include "physics/deformable/solid/solid_elements.h"
#include "physics/deformable/solid/surface_pairs.h"
#include "physics/deformable/solid/touched_nodes.h"

namespace embody::physics::deformable {
namespace {

Vec3 any_vector(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
Quat any_rotation(Random& random) {
    return normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

DeformableDefinition brick() {
    SoftSolid solid;
    return tetrahedral_brick({0.3, 0.2, 0.2}, {3, 2, 2}, solid);
}

struct Elements {
    DeformableDefinition definition = brick();
    std::vector<Vec3> rest = definition.nodes;
    SolidElements elements{std::get<SoftSolid>(definition.matter), rest};
    std::vector<Vec3> shaken(Random& random, double by) const {
        std::vector<Vec3> positions = rest;
        for (Vec3& p : positions) p += any_vector(random, by);
        return positions;
    }
    std::vector<Vec3> forces(const std::vector<Vec3>& positions) {
        std::vector<Vec3> force(positions.size());
        elements.linearise(positions, positions, force);
        return force;
    }
};

TEST(SolidElements, AtRestHaveNoEnergyAndNoForce) {
    Elements brick;
    for (const Vec3 force : brick.forces(brick.rest)) EXPECT_LT(length(force), 1e-6);
    EXPECT_NEAR(brick.elements.energy(brick.rest), 0, 1e-12);
    double volume = 0;
    for (const double v : brick.elements.node_volumes()) volume += v;
    EXPECT_NEAR(volume, 0.3 * 0.2 * 0.2, 1e-12);
}

TEST(SolidElements, RigidMotionsCostNothing) {
    Random random(1);
    for (int trial = 0; trial < 10; ++trial) {
        Elements brick;
        const Quat rotation = any_rotation(random);
        const Vec3 displacement = any_vector(random, 5);
        std::vector<Vec3> positions;
        for (const Vec3 p : brick.rest) positions.push_back(displacement + rotate(rotation, p));
        brick.elements.reset_rotations(rotation);
        const double stiffest = std::get<SoftSolid>(brick.definition.matter).youngs_modulus * 0.1;
        for (const Vec3 force : brick.forces(positions)) EXPECT_LT(length(force), 1e-6 * stiffest);
        EXPECT_LT(brick.elements.energy(positions), 1e-9 * stiffest);
    }
}

TEST(SolidElements, ForcesAreMinusTheSlopeOfTheEnergy) {
    Random random(2);
    for (int trial = 0; trial < 4; ++trial) {
        Elements brick;
        std::vector<Vec3> positions = brick.shaken(random, 0.01);
        const std::vector<Vec3> force = brick.forces(positions);
        double largest = 0;
        for (const Vec3 f : force) largest = std::max(largest, length(f));
        ASSERT_GT(largest, 0);
        constexpr double step = 1e-6;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (int a = 0; a < 3; ++a) {
                const double before = positions[i][a];
                positions[i][a] = before + step;
                const double above = brick.elements.energy(positions);
                positions[i][a] = before - step;
                const double below = brick.elements.energy(positions);
                positions[i][a] = before;
                EXPECT_NEAR(force[i][a], -(above - below) / (2 * step), 1e-4 * largest);
            }
        }
    }
}

TEST(SolidElements, ForcesLeaveTheMomentaOfTheWhole) {
    Random random(3);
    Elements brick;
    const std::vector<Vec3> positions = brick.shaken(random, 0.02);
    Vec3 sum, moment;
    double all = 0;
    const std::vector<Vec3> force = brick.forces(positions);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        sum += force[i];
        moment += cross(positions[i], force[i]);
        all += length(force[i]);
    }
    EXPECT_LT(length(sum), 1e-9 * all);
    EXPECT_LT(length(moment), 1e-6 * all);
}

TEST(SolidElements, StiffnessIsSymmetricAndNeverNegative) {
    Random random(4);
    Elements brick;
    (void)brick.forces(brick.rest);
    const std::size_t nodes = brick.rest.size();
    const auto times = [&](const std::vector<Vec3f>& move) {
        std::vector<Vec3f> force(nodes);
        brick.elements.add_stiffness(1, move, force);
        return force;
    };
    const auto product = [](const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += dot(Vec3(a[i]), Vec3(b[i]));
        return sum;
    };
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Vec3f> x(nodes), y(nodes);
        for (std::size_t i = 0; i < nodes; ++i) {
            x[i] = to_vec3f(any_vector(random, 0.01));
            y[i] = to_vec3f(any_vector(random, 0.01));
        }
        const double xky = product(x, times(y)), ykx = product(y, times(x)), xkx = product(x, times(x));
        EXPECT_GT(xkx, 0);
        EXPECT_NEAR(xky, ykx, 1e-4 * xkx);
        // It is the slope of the forces: half x K x is the energy of a small move.
        std::vector<Vec3> moved = brick.rest;
        constexpr double small = 1e-3;
        for (std::size_t i = 0; i < nodes; ++i) moved[i] += Vec3(x[i]) * small;
        EXPECT_NEAR(brick.elements.energy(moved), xkx * small * small / 2, 0.02 * xkx * small * small / 2);
    }
    // The whole moved or turned.
    for (int a = 0; a < 6; ++a) {
        std::vector<Vec3f> rigid(nodes);
        for (std::size_t i = 0; i < nodes; ++i) {
            Vec3 axis;
            axis[a % 3] = 0.01;
            rigid[i] = to_vec3f(a < 3 ? axis : cross(axis, brick.rest[i]));
        }
        double largest = 0;
        for (const Vec3f f : times(rigid)) largest = std::max(largest, length(Vec3(f)));
        EXPECT_LT(largest, 1e-3 * std::get<SoftSolid>(brick.definition.matter).youngs_modulus * 0.001);
    }
}

TEST(SolidElements, EdgesAreThePairsOfCommonTetrahedra) {
    Elements brick;
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (const auto& corners : brick.elements.corners()) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                pairs.push_back({std::min(corners[i], corners[j]), std::max(corners[i], corners[j])});
            }
        }
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::vector<std::array<std::uint32_t, 2>> edges = brick.elements.edges();
    std::ranges::sort(edges);
    EXPECT_EQ(edges, pairs);
}

TEST(EnclosedGas, SlopeIsThatOfTheVolumeAndPressureThatOfTheEnergy) {
    Random random(5);
    const SolidDeformable solid(brick());
    std::vector<Vec3> positions = solid.nodes().position;
    EnclosedGas gas(2e4, solid.surface(), positions);
    gas.measure(solid.surface(), positions);
    EXPECT_NEAR(gas.excess(), 0, 1e-6);
    EXPECT_NEAR(gas.energy(), 0, 1e-9);
    for (Vec3& p : positions) p += any_vector(random, 0.01);
    const auto volume_of = [&] {
        double volume = 0;
        for (const auto& t : solid.surface()) {
            volume += dot(positions[t[0]], cross(positions[t[1]], positions[t[2]])) / 6;
        }
        return volume;
    };
    gas.measure(solid.surface(), positions);
    const std::vector<Vec3> slope = gas.slope();
    const double excess = gas.excess(), stiffness = gas.stiffness();
    const double scale = 1e5;
    // A closed surface is not pushed as a whole, and what a sheet feels is 2e4 Pa more.
    Vec3 sum, turning;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        sum += slope[i];
        turning += cross(positions[i], slope[i]);
    }
    EXPECT_LT(length(sum), 1e-15);
    EXPECT_LT(length(turning), 1e-15);
    EXPECT_NEAR(gas.gauge(), 2e4 + excess, 1e-9);
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        for (int a = 0; a < 3; ++a) {
            constexpr double step = 1e-5;
            const double before = positions[i][a];
            positions[i][a] = before + step;
            const double more = volume_of();
            gas.measure(solid.surface(), positions);
            const double energy_more = gas.energy(), excess_more = gas.excess(), gauge_more = gas.gauge_energy();
            positions[i][a] = before - step;
            const double less = volume_of();
            gas.measure(solid.surface(), positions);
            const double energy_less = gas.energy(), excess_less = gas.excess();
            positions[i][a] = before;
            EXPECT_NEAR(slope[i][a], (more - less) / (2 * step), 1e-8);
            EXPECT_NEAR(energy_more - energy_less, -excess * (more - less), 1e-6 * scale * step);
            EXPECT_NEAR(gauge_more - gas.gauge_energy(), -(2e4 + excess) * (more - less), 1e-6 * scale * step);
            EXPECT_NEAR(excess_more - excess_less, -stiffness * (more - less), 1e-3 * scale * step);
        }
    }
}

// Nodes of a solid that move by forces on each other, by its response to single forces.
TEST(NodeCompliance, IsTheResponseToSingleForces) {
    TaskPool workers(1);
    DeformableDefinition definition = brick();
    definition.pinned = {0};
    SolidDeformable solid(definition);
    solid.begin_substep(0.01, {});
    solid.solve(workers);
    TouchedNodes touched;
    touched.begin(solid);
    const std::uint32_t nodes[] = {5, 11, 20};
    for (const std::uint32_t node : nodes) (void)touched.number_of(node);
    EXPECT_EQ(touched.number_of(11), 1u);  // known already
    touched.complete(solid, workers);
    ASSERT_EQ(touched.size(), 3u);
    EXPECT_EQ(solid.compliance().size(), 3u);
    EXPECT_GE(solid.compliance().stride(), 3u);
    const std::size_t count = solid.nodes().size();
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_EQ(touched.node(j), nodes[j]);
        for (int a = 0; a < 3; ++a) {
            std::vector<Vec3> force(count), move(count);
            force[nodes[j]][a] = 1;
            solid.find_response(force, move, workers);
            EXPECT_EQ(move[0], Vec3{});
            Vec3 unit;
            unit[a] = 1;
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3 by_block = touched.block(i, j) * unit;
                EXPECT_LT(length(by_block - move[nodes[i]]), 1e-3 * length(touched.block(j, j) * unit));
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Mat3 there = touched.block(i, j), back = transpose(touched.block(j, i));
            for (int c = 0; c < 3; ++c) {
                EXPECT_LT(length(there.column(c) - back.column(c)), 1e-4 * length(touched.block(j, j).x));
            }
        }
    }
    EXPECT_FALSE(touched.is_pushed());
    touched.push(1, {0, 3, 0});
    EXPECT_TRUE(touched.is_pushed());
    EXPECT_EQ(touched.force(1), (Vec3{0, 3, 0}));
    EXPECT_LT(length(touched.moved(2) - touched.block(2, 1) * Vec3{0, 3, 0}), 1e-4 * length(touched.moved(1)));
    touched.clear_probe();
    touched.add_to_probe(0, {1, 0, 0});
    touched.begin_probe();
    for (std::size_t part = 0; part < touched.probe_parts(); ++part) touched.run_probe(part);
    touched.end_probe();
    EXPECT_LT(length(touched.probe_move(2) - touched.block(2, 0) * Vec3{1, 0, 0}),
              1e-4 * length(touched.block(0, 0).x));
    EXPECT_EQ(touched.force(0), Vec3{});
}

// Nearest point of a triangle by trying many.
double distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    double best = 1e300;
    constexpr int parts = 60;
    for (int i = 0; i <= parts; ++i) {
        for (int j = 0; j <= parts - i; ++j) {
            const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
            best = std::min(best, length(p - (a + (b - a) * u + (c - a) * v)));
        }
    }
    return best;
}

TEST(PlacedSurface, FindsTheNearestPointAndWhatIsInside) {
    Random random(6);
    const SolidDeformable solid(brick());
    const PlacedSurface surface(solid);
    const std::vector<Vec3>& nodes = solid.nodes().position;
    EXPECT_GT(surface.deepest(), 0);
    const Bounds box{{0, 0, 0}, {0.3, 0.2, 0.2}};
    int inside = 0;
    for (int trial = 0; trial < 150; ++trial) {
        const Vec3 p{random.between(-0.1, 0.4), random.between(-0.1, 0.3), random.between(-0.1, 0.3)};
        const bool is_inside = p.x > box.lower.x && p.x < box.upper.x && p.y > box.lower.y && p.y < box.upper.y &&
                               p.z > box.lower.z && p.z < box.upper.z;
        EXPECT_EQ(surface.encloses(p), is_inside);
        inside += is_inside;
        double nearest = 1e300;
        for (const auto& t : solid.surface()) {
            nearest = std::min(nearest, distance_to_triangle(p, nodes[t[0]], nodes[t[1]], nodes[t[2]]));
        }
        const auto place = surface.find(p, 1);
        ASSERT_TRUE(place);
        EXPECT_NEAR(std::fabs(place->distance), nearest, 2e-3);
        EXPECT_EQ(place->distance < 0, is_inside);
        EXPECT_NEAR(place->weight[0] + place->weight[1] + place->weight[2], 1, 1e-9);
        Vec3 foot;
        for (std::size_t k = 0; k < 3; ++k) foot += nodes[place->triangle[k]] * place->weight[k];
        EXPECT_NEAR(length(p - foot), std::fabs(place->distance), 1e-9);
        EXPECT_FALSE(surface.find(p, 0.9 * nearest - 2e-3));
        const auto exit = surface.find_exit(p, 0, 1);
        if (is_inside) {
            ASSERT_TRUE(exit);
            EXPECT_NEAR(exit->distance, -(0.3 - p.x), 1e-9);
        }
    }
    EXPECT_GT(inside, 20);
}

TEST(SurfacePairs, TheShortestWayOutIsWhereBoxesOverlapLeast) {
    const Bounds box{{0, 0, 0}, {1, 1, 1}};
    const ExitDirection up = min_travel({{0.2, 0.9, 0.2}, {1.2, 1.9, 1.2}}, box, true);
    EXPECT_EQ(up.axis, 1);
    EXPECT_EQ(up.sign, 1);
    const ExitDirection aside = min_travel({{-0.95, 0.2, 0.2}, {0.05, 1.2, 1.2}}, box, true);
    EXPECT_EQ(aside.axis, 0);
    EXPECT_EQ(aside.sign, -1);
}

TEST(SurfacePairs, TwoBricksMeetWhereTheyFaceEachOther) {
    const SolidDeformable below(brick());
    DeformableDefinition definition = brick();
    definition.pose.position = {0.02, 0.205, 0.01};
    const SolidDeformable above(definition);
    std::vector<SolidContact> contacts;
    const SurfaceSearch search{.reach = 0.01, .radius = 1e-3, .friction = {0.5, 0.4}};
    find_surface_contacts({above, 3}, {below, 7}, search, contacts);
    EXPECT_GE(contacts.size(), 6u);
    for (const SolidContact& contact : contacts) {
        EXPECT_FALSE(contact.has_body());
        EXPECT_EQ(contact.point.solid, 3u);
        EXPECT_EQ(contact.other.solid, 7u);
        EXPECT_EQ(contact.friction.sliding, 0.4);
        // Nodes of its lower side.
        EXPECT_NEAR(above.nodes().position[contact.point.node[0]].y, 0.205, 1e-9);
        EXPECT_GT(contact.normal.y, 0.4);  // nodes' normals at edges lean
    }
    // Far apart there is none.
    definition.pose.position.y = 0.5;
    contacts.clear();
    find_surface_contacts({SolidDeformable(definition), 3}, {below, 7}, search, contacts);
    EXPECT_TRUE(contacts.empty());
}

// A brick pressed on a floor by its weight: the forces of the contacts carry it, push only, and stay within friction.
TEST(SolidContacts, CarryTheWeight) {
    TaskPool workers(1);
    const auto shape = CollisionShape::create(BoxShape{{1, 0.5, 1}}).value();
    DeformableDefinition definition = brick();
    std::get<SoftSolid>(definition.matter).rayleigh_damping = 0.003;  // else it swings about its weight
    SolidDeformable solid(definition);
    std::vector<TouchedBody> bodies(1);
    bodies[0].shape = shape.get();
    bodies[0].is_dynamic = false;
    bodies[0].start_center = bodies[0].start.position = {0.15, -0.5, 0.1};
    std::vector<SolidContact> contacts;
    for (const std::uint32_t node : solid.surface_nodes()) {
        if (solid.nodes().position[node].y > 1e-9) continue;
        SolidContact contact;
        contact.point = {.solid = 0, .count = 1, .node = {node}, .weight = {1}};
        contact.anchor =
            Vec3{solid.nodes().position[node].x, 0, solid.nodes().position[node].z} - bodies[0].start_center;
        contact.normal = {0, 1, 0};
        contact.friction = {0.5, 0.5};
        contacts.push_back(contact);
    }
    SolidDeformable* solids[] = {&solid};
    SolidContacts solver;
    constexpr double h = 1.0 / 240;
    const Vec3 gravity{0, -9.81, 0};
    Vec3 carried;
    for (int i = 0; i < 200; ++i) {
        solid.begin_substep(h, gravity);
        SolidContacts::begin(contacts, solids, bodies, h, h);
        solid.solve(workers);
        solver.solve(contacts, solids, bodies, {h, h}, workers);
        solid.finish();
        carried = {};
        for (const SolidContact& contact : contacts) {
            EXPECT_GE(contact.force.y, -1e-6);
            EXPECT_LE(std::hypot(contact.force.x, contact.force.z), 0.5 * contact.force.y + 1e-3);
            carried += contact.force;
        }
    }
    double mass = 0;
    for (const double m : solid.nodes().mass) mass += m;
    EXPECT_NEAR(carried.y, 9.81 * mass, 0.1 * 9.81 * mass);
    for (const Vec3 p : solid.nodes().position) EXPECT_GT(p.y, -1e-3);
}

}  // namespace
}  // namespace embody::physics::deformable
