// SPDX-License-Identifier: MIT
// Coulomb's law is one for all that touches: what bends lies and slides by the same pair of coefficients as a rigid
// body, whatever rules and table make them (eq. 4 of the paper; static and sliding friction as measured by Amontons and
// Coulomb).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr SurfaceId ice = 1, rubber = 2;

SurfacePairs pair_table() {
    SurfacePairs pairs;
    EXPECT_TRUE(pairs.set(ice, rubber, {.friction_static = 0.45, .friction_dynamic = 0.3}).ok());
    return pairs;
}

/// A flat thing that lies on the ground.
struct Thing {
    const char* name;
    std::function<std::function<Vec3()>(World&, const Material&)> put;  ///< returns where its centre of mass is

    friend std::ostream& operator<<(std::ostream& out, const Thing& thing) { return out << thing.name; }
};

std::function<Vec3()> put_deformable(World& world, DeformableDefinition definition, const Material& material) {
    definition.contact_radius = 2e-3;
    definition.material = material;
    definition.pose.position.y += 2e-3;
    const DeformableHandle handle = world.create_deformable(definition).value();
    return [&world, handle] { return world.center_of_mass(handle); };
}

const std::array<Thing, 4> things{
    Thing{"rigid box",
          [](World& world, const Material& material) {
              const BodyHandle box = world
                                         .create_body({.kind = BodyKind::dynamic_body,
                                                       .shape = world.create_shape(BoxShape{{0.2, 0.02, 0.2}}).value(),
                                                       .position = {0, 0.02, 0},
                                                       .material = material})
                                         .value();
              return std::function<Vec3()>([&world, box] { return world.pose(box).position; });
          }},
    Thing{"soft slab",
          [](World& world, const Material& material) {
              auto slab = tetrahedral_brick({0.4, 0.05, 0.4}, {4, 1, 4},
                                            {.density = 500, .youngs_modulus = 1e5, .rayleigh_damping = 0.02});
              slab.pose.position.y += 0.025;
              return put_deformable(world, slab, material);
          }},
    Thing{"cloth",
          [](World& world, const Material& material) {
              return put_deformable(
                  world, cloth_rectangle(0.3, 0.3, 0.05, {.area_density = 0.3, .rayleigh_damping = 0.02}), material);
          }},
    Thing{"rope",
          [](World& world, const Material& material) {
              return put_deformable(world, rope_between({-0.25, 0, 0}, {0.25, 0, 0}, 0.05), material);
          }},
};

Material random_material(Random& random) {
    Material material;
    material.friction_dynamic = random.between(0.15, 0.6);
    material.friction_static = material.friction_dynamic * random.between(1, 1.8);
    constexpr std::array rules{CombineRule::pair_table,     CombineRule::own,     CombineRule::average,
                               CombineRule::geometric_mean, CombineRule::minimum, CombineRule::maximum};
    material.friction_combine = rules[random.below(rules.size())];
    material.surface = static_cast<SurfaceId>(random.below(3));
    return material;
}

// Gravity as on a slope of that tangent, which falls towards +X. Slowly: what bends would swing beyond its limit.
void tilt(World& world, double tangent) {
    constexpr int steps = 30;
    WorldSettings settings = world.settings();
    const double from = std::atan2(settings.gravity.x, -settings.gravity.y), to = std::atan(tangent);
    for (int i = 1; i <= steps; ++i) {
        const double angle = from + (to - from) * i / steps;
        settings.gravity = gravity * Vec3{std::sin(angle), -std::cos(angle), 0};
        ASSERT_TRUE(world.set_settings(settings).ok());
        world.step();
    }
}

// Mean acceleration along X over a while, m/s².
double acceleration(World& world, const std::function<Vec3()>& center, double seconds) {
    const double dt = world.settings().time_step;
    const auto speed = [&] {
        const double before = center().x;
        world.step();
        return (center().x - before) / dt;
    };
    const double first = speed();
    run(world, seconds - dt);
    return (speed() - first) / seconds;
}

class FrictionOfAllKinds : public testing::TestWithParam<Thing> {};

TEST_P(FrictionOfAllKinds, LiesAndSlidesByThePairsCoefficients) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        Random random(seed);
        const Material ground = random_material(random), own = random_material(random);
        const PairFriction pair = friction_between(ground, own, pair_table());
        SCOPED_TRACE(testing::Message() << GetParam().name << ", case " << seed << ": " << pair.at_rest << ", "
                                        << pair.sliding);
        const auto world = make_world({.air_density = 0, .sleeping = false});
        ASSERT_TRUE(world->set_surface_pairs(pair_table()).ok());
        add_plane(*world, ground);
        const std::function<Vec3()> center = GetParam().put(*world, own);
        run(*world, 0.5);

        // Below the static limit it lies, also where it would slide on if it slid.
        tilt(*world, std::min(0.9 * pair.at_rest, (pair.at_rest + pair.sliding) / 2));
        run(*world, 0.2);
        const double lies_at = center().x;
        run(*world, 0.5);
        EXPECT_LT(std::fabs(center().x - lies_at), 1e-3);

        // Above it it slides, and goes on sliding where it would lie had it stopped.
        const auto expected = [&](double tangent) {
            return gravity * (tangent - pair.sliding) / std::sqrt(1 + tangent * tangent);
        };
        for (const double tangent : {1.05 * pair.at_rest, 1.3 * pair.at_rest, (pair.at_rest + pair.sliding) / 2}) {
            tilt(*world, tangent);
            run(*world, 0.1);
            EXPECT_NEAR(acceleration(*world, center, 0.3), expected(tangent), 0.05 * gravity * pair.sliding) << tangent;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Things, FrictionOfAllKinds, testing::ValuesIn(things), [](const auto& info) {
    std::string name = info.param.name;
    std::erase(name, ' ');
    return name;
});

}  // namespace
}  // namespace embody::physics
