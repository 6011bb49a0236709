// SPDX-License-Identifier: MIT
// Soft primitives as a scene makes them, beside the theory of elasticity: random sizes, forms and matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "physics/definitions/mass_properties.h"
#include "physics/definitions/shape_bounds.h"
#include "physics/deformable/solid/solid_elements.h"
#include "scene/live_scene.h"
#include "scene/matter/soft_nodes.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using physics::ShapeDefinition;
using std::numbers::pi;

constexpr double tolerance = 0.05;  // of each law, with the default resolution
constexpr double gravity = 9.81;
constexpr EntityIndex bar_index = 1, plate_index = 2;

struct Matter {
    double density = 1000, youngs_modulus = 1e6, poisson_ratio = 0.3, damping = 0;
    int resolution = 0;

    [[nodiscard]] double shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
};

// A bar along y: a rod, or a box whose x is its thinner side.
struct Bar {
    bool is_round = false;
    double length = 1, width = 0.1, depth = 0.1;  // m
    Matter matter;

    [[nodiscard]] double area() const { return is_round ? pi / 4 * width * width : width * depth; }
    // For bending in the direction of x.
    [[nodiscard]] double second_moment() const {
        return is_round ? pi / 64 * std::pow(width, 4) : depth * std::pow(width, 3) / 12;
    }
    // Saint-Venant's torsion constant (S. P. Timoshenko, J. N. Goodier, "Theory of Elasticity", 1970, 109).
    [[nodiscard]] double torsion_constant() const {
        if (is_round) return pi / 32 * std::pow(width, 4);
        double sum = 0;
        for (int n = 1; n < 40; n += 2) sum += std::tanh(n * pi * depth / (2 * width)) / std::pow(n, 5);
        return depth * std::pow(width, 3) * (1.0 / 3 - 64 / std::pow(pi, 5) * width / depth * sum);
    }
    // Timoshenko's factor of the area in shear (G. R. Cowper, 1966).
    [[nodiscard]] double shear_factor() const {
        const double nu = matter.poisson_ratio;
        return is_round ? 6 * (1 + nu) / (7 + 6 * nu) : 10 * (1 + nu) / (12 + 11 * nu);
    }
    [[nodiscard]] ShapeDefinition shape() const {
        if (is_round) return physics::CylinderShape{width / 2, length / 2};
        return physics::BoxShape{{width / 2, length / 2, depth / 2}};
    }
    friend std::ostream& operator<<(std::ostream& out, const Bar& bar) {
        return out << (bar.is_round ? "rod" : "box") << " of " << bar.length << " x " << bar.width << " x " << bar.depth
                   << " m, E = " << bar.matter.youngs_modulus << ", nu = " << bar.matter.poisson_ratio;
    }
};

double between_logarithms(Random& random, double low, double high) {
    return std::exp(random.between(std::log(low), std::log(high)));
}

std::vector<Bar> random_bars(std::uint64_t seed, int count) {
    Random random(seed);
    std::vector<Bar> bars;
    for (int i = 0; i < count; ++i) {
        Bar bar;
        bar.is_round = i % 2 == 1;
        bar.width = between_logarithms(random, 0.02, 0.3);
        bar.depth = bar.is_round ? bar.width : bar.width * random.between(1, 2.5);
        bar.length = bar.width * random.between(6, 14);
        bar.matter.density = between_logarithms(random, 100, 2000);
        bar.matter.poisson_ratio = 0.49 * (i + random.unit()) / count;  // of each size
        bars.push_back(bar);
    }
    return bars;
}

void make_soft(Entity& entity, const Matter& matter) {
    entity.attributes = {{"kind", to_value(attributes::PhysicalKind::soft)},
                         {"density", matter.density},
                         {"fill_fraction", 1.0},
                         {"youngs_modulus", matter.youngs_modulus},
                         {"poisson_ratio", matter.poisson_ratio},
                         {"damping_rayleigh", matter.damping},
                         {"soft_resolution", 1.0 * matter.resolution}};
}

// Holds the end at the height ±length / 2: a ball so large that its surface is nearly the end's plane.
Pin pin_of_end(const Bar& bar, double up) {
    const double reach = std::hypot(bar.width, bar.depth), radius = 100 * reach;
    const double depth = reach * reach / (2 * radius);
    return {.position = {0, up * (bar.length / 2 + radius - depth), 0}, .radius = radius};
}

// A bar that is held at its lower end, and without gravity a light plate that holds the upper one, to be pulled or
// turned.
Document document_of(const Bar& bar, bool has_plate) {
    Document document;
    document.settings.air_density = 0;
    document.settings.sleeping = false;
    Entity& thing = samples::add(document, "Bar", bar.shape(), {});
    make_soft(thing, bar.matter);
    thing.attributes["collision_mask"] = 0.0;
    thing.pins = {pin_of_end(bar, -1)};
    if (!has_plate) return document;
    document.settings.gravity = {};
    Pin held = pin_of_end(bar, 1);
    held.to = plate_index;
    thing.pins.push_back(held);
    const double half = bar.width / 2;
    Entity& plate = samples::add(document, "Plate", physics::BoxShape{{half, half, half}}, {0, bar.length / 2, 0});
    plate.attributes = {{"kind", to_value(attributes::PhysicalKind::rigid)},
                        {"mass", 0.05 * bar.matter.density * bar.area() * bar.length},
                        {"collision_mask", 0.0},
                        {"angular_damping", 0.0}};
    return document;
}

// Mean of `value` of the nodes (at rest, and moved by so much) around the height at rest, weighted to that height.
double slope_between_quarters(const Bar& bar, const std::vector<Vec3>& rest, const std::vector<Vec3>& moved,
                              const std::function<double(Vec3, Vec3)>& value,
                              const std::function<double(Vec3)>& weight) {
    double count = 0, y = 0, yy = 0, v = 0, yv = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (std::abs(rest[i].y) > bar.length / 4) continue;
        const double w = weight(rest[i]), at = rest[i].y, what = value(rest[i], moved[i]);
        count += w, y += w * at, yy += w * at * at, v += w * what, yv += w * at * what;
    }
    return (count * yv - y * v) / (count * yy - y * y);
}

std::vector<Vec3> at_rest(Simulation& simulation, int steps) {
    samples::step(simulation, steps);
    const MovingPoints* points = simulation.points(bar_index);
    EXPECT_LT(length(points->linear_velocity()), 1e-3 * simulation.bounds(bar_index).size().y) << "it still moves";
    return samples::points_of(simulation, bar_index);
}

TEST(SoftLaws, BarsStretchByTheForceOverTheArea) {
    for (Bar bar : random_bars(1, 8)) {
        SCOPED_TRACE(testing::Message() << bar);
        const double strain = 0.02;
        bar.matter.youngs_modulus = 300 * bar.matter.density * bar.length * bar.length;  // of waves 17 lengths a second
        bar.matter.damping = 0.05;
        Document document = document_of(bar, true);
        document.entities[1].force = {0, strain * bar.matter.youngs_modulus * bar.area(), 0};
        const auto simulation = samples::make(document);
        ASSERT_TRUE(simulation && simulation->points(bar_index));
        const auto rest = samples::points_of(*simulation, bar_index), now = at_rest(*simulation, 120);
        const double found = slope_between_quarters(
            bar, rest, now, [](Vec3 from, Vec3 to) { return to.y - from.y; }, [](Vec3) { return 1; });
        EXPECT_NEAR(found / strain, 1, tolerance);
    }
}

TEST(SoftLaws, BarsTwistAsSaintVenantSays) {
    for (Bar bar : random_bars(2, 8)) {
        SCOPED_TRACE(testing::Message() << bar);
        const double rate = 0.1 / bar.length;  // rad/m
        bar.matter.youngs_modulus = 1000 * bar.matter.density * bar.length * bar.length;
        bar.matter.damping = 0.05;
        Document document = document_of(bar, true);
        document.entities[1].torque = {0, rate * bar.matter.shear_modulus() * bar.torsion_constant(), 0};
        const auto simulation = samples::make(document);
        ASSERT_TRUE(simulation && simulation->points(bar_index));
        const auto rest = samples::points_of(*simulation, bar_index), now = at_rest(*simulation, 180);
        // Nodes on the axis say nothing.
        const auto arm = [](Vec3 p) { return p.x * p.x + p.z * p.z; };
        const double found = slope_between_quarters(
            bar, rest, now,
            [&](Vec3 from, Vec3 to) {
                return std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
            },
            arm);
        EXPECT_NEAR(found / rate, 1, tolerance);
    }
}

TEST(SoftLaws, CantileversBendAsTimoshenkoSays) {
    for (Bar bar : random_bars(3, 12)) {
        SCOPED_TRACE(testing::Message() << bar);
        const double sag = 0.02 * bar.length, load = bar.matter.density * bar.area() * gravity;  // N/m
        // w L⁴/8EI + w L²/2κGA = sag
        bar.matter.youngs_modulus =
            (std::pow(bar.length, 4) / (8 * bar.second_moment()) +
             std::pow(bar.length, 2) * (1 + bar.matter.poisson_ratio) / (bar.shear_factor() * bar.area())) *
            load / sag;
        bar.matter.damping = 2 / std::sqrt(12.36 * gravity / (8 * sag));  // critical
        Document document = document_of(bar, false);
        document.settings.gravity = {-gravity, 0, 0};
        const auto simulation = samples::make(document);
        ASSERT_TRUE(simulation && simulation->points(bar_index));
        const auto rest = samples::points_of(*simulation, bar_index), now = at_rest(*simulation, 180);
        double found = 0;
        int count = 0;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            if (rest[i].y < (0.5 - 1e-9) * bar.length) continue;
            found += rest[i].x - now[i].x;
            ++count;
        }
        EXPECT_NEAR(found / count / sag, 1, tolerance);
    }
}

std::vector<ShapeDefinition> random_shapes(std::uint64_t seed, int count) {
    Random random(seed);
    std::vector<ShapeDefinition> shapes;
    for (int i = 0; i < count; ++i) {
        const double size = between_logarithms(random, 0.01, 1), other = size * between_logarithms(random, 0.2, 5);
        switch (i % 4) {
            case 0:
                shapes.emplace_back(physics::BoxShape{{size, other, size * random.between(0.4, 2)}});
                break;
            case 1:
                shapes.emplace_back(physics::SphereShape{size});
                break;
            case 2:
                shapes.emplace_back(physics::CylinderShape{size, other});
                break;
            default:
                shapes.emplace_back(physics::CapsuleShape{size, other});
        }
    }
    return shapes;
}

Document document_of(const ShapeDefinition& shape, const Matter& matter) {
    Document document;
    make_soft(samples::add(document, "Thing", shape, {}), matter);
    return document;
}

TEST(SoftLaws, PrimitivesHaveTheVolumeMassAndBoundsOfTheirShape) {
    for (const int resolution : {0, 2, 3, 4}) {
        for (const ShapeDefinition& shape : random_shapes(4, 24)) {
            const auto simulation = samples::make(document_of(shape, {.density = 500, .resolution = resolution}));
            ASSERT_TRUE(simulation && simulation->points(1)) << physics::shape_name(shape);
            const auto& definition = as_soft(simulation->points(1))->definition();
            geometry::TetrahedralMesh mesh;
            mesh.nodes = definition.nodes;
            mesh.tetrahedra = std::get<physics::SoftSolid>(definition.matter).tetrahedra;
            for (const geometry::Tetrahedron& t : mesh.tetrahedra) ASSERT_GT(geometry::signed_volume(mesh, t), 0);
            const double volume = physics::mass_properties(shape)->volume;
            EXPECT_NEAR(geometry::volume(mesh) / volume, 1, 1e-9) << physics::shape_name(shape);
            EXPECT_NEAR(simulation->points(1)->mass() / (500 * volume), 1, 1e-9);
            Bounds bounds;
            for (const Vec3 node : mesh.nodes) bounds.add(node);
            const Vec3 size = physics::bounds_of(shape).size();
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(bounds.size()[i] / size[i], 1, tolerance) << physics::shape_name(shape);
            EXPECT_GT(geometry::measure_dihedral_angles(mesh).least, 5) << physics::shape_name(shape);
        }
    }
}

// The patch test (B. M. Irons, 1966): where all strain is the same, stress is, too, and no inner node feels a force;
// the energy is the matter's. So bars stretch and things are compressed exactly as they should.
TEST(SoftLaws, ASameStrainEverywhereIsExact) {
    Random random(5);
    for (const ShapeDefinition& shape : random_shapes(6, 16)) {
        const Matter matter{.youngs_modulus = between_logarithms(random, 1e3, 1e9),
                            .poisson_ratio = random.between(-0.5, 0.49)};
        const auto simulation = samples::make(document_of(shape, matter));
        ASSERT_TRUE(simulation && simulation->points(1));
        const auto& definition = as_soft(simulation->points(1))->definition();
        const auto& solid = std::get<physics::SoftSolid>(definition.matter);
        physics::deformable::SolidElements elements(solid, definition.nodes);
        // A small symmetric stretch: the last one is hydrostatic compression.
        for (const bool is_hydrostatic : {false, true}) {
            const auto small = [&] { return random.between(-0.01, 0.01); };
            const double a = small(), b = small(), c = small();
            const Mat3 strain =
                is_hydrostatic ? -0.01 * Mat3::identity() : Mat3{{small(), a, b}, {a, small(), c}, {b, c, small()}};
            std::vector<Vec3> moved, force(definition.nodes.size());
            for (const Vec3 node : definition.nodes) moved.push_back(node + strain * node);
            elements.linearise(moved, moved, force);
            const double mu = matter.shear_modulus(),
                         lambda = 2 * mu * matter.poisson_ratio / (1 - 2 * matter.poisson_ratio),
                         trace_of = trace(strain);
            const double squares = length_squared(strain.x) + length_squared(strain.y) + length_squared(strain.z);
            const double density = mu * squares + lambda / 2 * trace_of * trace_of;
            const double volume = physics::mass_properties(shape)->volume;
            EXPECT_NEAR(elements.energy(moved) / (density * volume), 1, 1e-6) << physics::shape_name(shape);
            double inner = 0, outer = 0;
            std::vector<bool> is_outer(definition.nodes.size());
            for (const auto& face : geometry::find_tetrahedral_topology(solid.tetrahedra).outer_faces)
                for (const std::uint32_t node : face.corners) is_outer[node] = true;
            for (std::size_t i = 0; i < force.size(); ++i)
                (is_outer[i] ? outer : inner) = std::max(is_outer[i] ? outer : inner, length(force[i]));
            EXPECT_LT(inner, 1e-6 * outer) << physics::shape_name(shape);
        }
    }
}

}  // namespace
}  // namespace embody::scene
