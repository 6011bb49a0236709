// SPDX-License-Identifier: MIT
// Grains that flow: what runs through the opening of a silo, and how far a column runs out whose wall vanishes. Laws
// and sources: docs/physics/grains.md, "Flow".
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/definitions/grain_material.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

constexpr double gravity = 9.81, density = 2650, full_circle = 2 * std::numbers::pi;

/// A round vessel of grains on a floor; lengths in diameters of a grain.
struct Vessel {
    double diameter = 0.01;  ///< of a grain, m
    double friction_angle = 30;
    double radius = 9, height = 18;
    double opening = 0;  ///< diameter
    std::uint64_t seed = 1;
};

class Flow {
public:
    explicit Flow(const Vessel& vessel) : vessel_(vessel), settings_(settings_of(vessel)) {
        world = make_world(settings_);
    }

    void fill() {
        const double d = vessel_.diameter, a = 1.1 * d;
        BodyDefinition grain{.shape = world->create_shape(SphereShape{d / 2}).value()};
        grain.material = grain_material(vessel_.friction_angle, d);
        grain.mass.density = density;
        Random random(vessel_.seed);
        const int across = static_cast<int>(vessel_.radius) + 1;
        for (int y = 0; (y * 0.9 + 1.1) * d < vessel_.height * d; ++y) {
            for (int z = -across; z <= across; ++z) {
                for (int x = -across; x <= across; ++x) {
                    const auto shake = [&] { return random.between(-0.028, 0.028) * d; };
                    const double shift = 0.5 * ((z + y % 3 + 2 * across) % 2), back = (y % 3) / 3.0;
                    grain.position = {(x + shift) * a + shake(), 0.55 * d + y * std::sqrt(2.0 / 3) * a + shake(),
                                      (z + back) * std::sqrt(0.75) * a + shake()};
                    if (std::hypot(grain.position.x, grain.position.z) > (vessel_.radius - 0.55) * d) continue;
                    grains.push_back(world->create_body(grain).value());
                }
            }
        }
    }

    BodyHandle add_static(const ShapeDefinition& shape, Vec3 position = {}, double friction = 0.5) {
        BodyDefinition body{.kind = BodyKind::static_body, .shape = world->create_shape(shape).value()};
        body.position = position;
        body.material.friction_static = body.material.friction_dynamic = friction;
        return world->create_body(body).value();
    }

    void run(double seconds) {
        for (double time = 0; time < seconds; time += settings_.time_step) world->step();
    }

    // Deepest of two grains in each other, in diameters.
    [[nodiscard]] double overlap() const {
        double deepest = 0;
        for (const ContactView& contact : world->contacts()) deepest = std::max(deepest, -contact.separation);
        return deepest / vessel_.diameter;
    }

    // Removes the grains that have fallen below; how many.
    std::size_t remove_below(double height) {
        std::vector<BodyHandle> gone;
        std::erase_if(grains, [&](BodyHandle grain) {
            if (world->center_of_mass(grain).y >= height) return false;
            gone.push_back(grain);
            return true;
        });
        EXPECT_TRUE(gone.empty() || world->destroy_bodies(gone).ok());
        return gone.size();
    }

    [[nodiscard]] double time_step() const { return settings_.time_step; }

    std::unique_ptr<World> world;
    std::vector<BodyHandle> grains;

private:
    static WorldSettings settings_of(const Vessel& vessel) {
        WorldSettings settings;
        settings.substeps = substeps_for_grains(vessel.diameter, settings);
        return settings;
    }

    Vessel vessel_;
    WorldSettings settings_;
};

// A wall of 48 flat sides and a floor with a round opening.
MeshShape silo_mesh(const Vessel& vessel) {
    constexpr std::uint32_t sides = 48;
    const double d = vessel.diameter;
    MeshShape mesh;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double c = std::cos(full_circle * i / sides), s = std::sin(full_circle * i / sides);
        const auto add = [&](double radius, double height) {
            mesh.positions.push_back(to_vec3f(Vec3{radius * c, height, radius * s} * d));
        };
        add(vessel.opening / 2, 0);
        add(vessel.radius, 0);
        add(vessel.radius, 2 * vessel.height);
        const std::uint32_t here = 3 * i, next = 3 * ((i + 1) % sides);
        for (const std::uint32_t k : {0u, 1u}) {
            mesh.triangles.push_back({here + k, next + k, next + k + 1});
            mesh.triangles.push_back({here + k, next + k + 1, here + k + 1});
        }
    }
    return mesh;
}

/// Mass flow through the opening between a twelfth and a third of all grains, kg/s; the deepest overlap before.
struct Discharge {
    double rate = 0, overlap = 0;
};
Discharge discharge(const Vessel& vessel) {
    const double d = vessel.diameter, time_scale = std::sqrt(d / 0.01);
    Flow flow(vessel);
    flow.add_static(silo_mesh(vessel));
    const BodyHandle plug = flow.add_static(CylinderShape{0.49 * vessel.opening * d, d}, {0, -d, 0});
    flow.fill();
    flow.run(0.5 * time_scale);
    Discharge result{.overlap = flow.overlap()};
    EXPECT_TRUE(flow.world->destroy_body(plug).ok());
    const std::size_t all = flow.grains.size();
    std::size_t out = 0, first_out = 0;
    double begin = 0;
    for (double time = 0; 3 * out < all && time < 5 * time_scale; time += flow.time_step()) {
        flow.world->step();
        out += flow.remove_below(-5 * d);
        if (begin == 0 && 12 * out >= all) {
            begin = time;
            first_out = out;
        }
        const double mass = density * std::numbers::pi / 6 * d * d * d;
        if (begin > 0 && time > begin) result.rate = mass * static_cast<double>(out - first_out) / (time - begin);
    }
    EXPECT_GE(3 * out, all) << "jammed";
    return result;
}

// W. Beverloo, H. Leniger, J. van de Velde, Chem. Eng. Sci. 15, 1961: 0.58 of the bulk density, k = 1.4 to 2.
double beverloo(const Vessel& vessel, double k) {
    const double bulk = 0.55 * density;
    return 0.58 * bulk * std::sqrt(gravity) * std::pow((vessel.opening - k) * vessel.diameter, 2.5);
}

constexpr double flow_tolerance = 0.15;

TEST(GrainSilo, FlowsAsBeverlooSaysAndDoesNotJam) {
    Random random(22);
    for (int i = 0; i < 4; ++i) {
        Vessel vessel{.diameter = random.between(0.006, 0.02), .friction_angle = random.between(24, 36)};
        vessel.opening = random.between(8, 10);
        vessel.radius = vessel.opening / 2 + 5;
        vessel.seed = static_cast<std::uint64_t>(i);
        const Discharge found = discharge(vessel);
        EXPECT_GT(found.rate, (1 - flow_tolerance) * beverloo(vessel, 2))
            << vessel.opening << " d of " << vessel.diameter << " m, " << vessel.friction_angle << " degrees";
        EXPECT_LT(found.rate, (1 + flow_tolerance) * beverloo(vessel, 1.4));
        EXPECT_LT(found.overlap, 0.15);
        RecordProperty("of_beverloo_k2_" + std::to_string(i), std::to_string(found.rate / beverloo(vessel, 2)));
        RecordProperty("overlap_" + std::to_string(i), std::to_string(found.overlap));
    }
}

TEST(GrainSilo, FlowDoesNotDependOnTheFillingHeight) {
    Vessel vessel{.opening = 8};
    const double low = discharge(vessel).rate;
    vessel.height = 27;
    EXPECT_NEAR(discharge(vessel).rate, low, flow_tolerance * low);
}

// G. Lube, H. Huppert, R. Sparks, M. Hallworth, J. Fluid Mech. 508, 2004: r∞/r0 of a column of height a r0.
double lube(double a) { return 1 + (a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a)); }

TEST(GrainColumn, RunsOutAsMeasuredByLube) {
    Random random(2004);
    for (int i = 0; i < 4; ++i) {
        Vessel vessel{.diameter = random.between(0.008, 0.02), .friction_angle = random.between(27, 34)};
        vessel.height = vessel.radius * (0.7 + 0.6 * i);
        vessel.seed = static_cast<std::uint64_t>(i);
        const double d = vessel.diameter, r0 = vessel.radius * d, time_scale = std::sqrt(d / 0.01);
        Flow flow(vessel);
        flow.add_static(PlaneShape{{0, 1, 0}, 0});
        std::vector<BodyHandle> walls;
        constexpr int sides = 36;
        for (int k = 0; k < sides; ++k) {
            const Vec3 inwards{-std::cos(full_circle * k / sides), 0, -std::sin(full_circle * k / sides)};
            walls.push_back(flow.add_static(PlaneShape{inwards, -r0}, {}, 0));
        }
        flow.fill();
        flow.run(0.5 * time_scale);
        double mean = 0;
        for (const BodyHandle grain : flow.grains)
            mean += flow.world->center_of_mass(grain).y / static_cast<double>(flow.grains.size());
        for (const BodyHandle wall : walls) EXPECT_TRUE(flow.world->destroy_body(wall).ok());
        flow.run(2 * time_scale);

        // But for one grain in a hundred: some roll on alone.
        std::vector<double> radii;
        for (const BodyHandle grain : flow.grains) {
            const Vec3 p = flow.world->center_of_mass(grain);
            radii.push_back(std::hypot(p.x, p.z) + d / 2);
        }
        std::ranges::sort(radii);
        const double front = radii[radii.size() * 99 / 100] / r0, a = 2 * mean / r0;
        EXPECT_NEAR(front, lube(a), 0.2 * lube(a)) << "a " << a << ", " << vessel.friction_angle << " degrees";
        RecordProperty("of_lube_" + std::to_string(i), std::to_string(front / lube(a)));
    }
}

}  // namespace
}  // namespace embody::physics
