// SPDX-License-Identifier: MIT
// Water that turns with its round vessel goes on turning: neither the paths of particles nor its surface take spin
// away or add to it. docs/physics/fluids.md, "Paths" and "Surface".
#include <cmath>
#include <cstdint>

#include "foundation/random.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr int staves = 24;

/// An upright round vessel that turns about its axis, the Y axis, with water in it.
struct TurningVessel {
    double radius = 0, cell = 0, depth = 0, speed = 0;  // m, m, m, rad/s

    /// Height of the water's surface that turns with it.
    [[nodiscard]] double level_at(double distance) const {
        return depth + speed * speed / (2 * gravity) * (distance * distance - radius * radius / 2);
    }
};

Vec3 at_wall(double distance, double y, int stave) {
    const double angle = 2 * pi * stave / staves;
    return {distance * std::cos(angle), y, distance * std::sin(angle)};
}

CompoundShape shape_of(const TurningVessel& vessel) {
    const double wall = 2.5 * vessel.cell, top = vessel.level_at(vessel.radius) + 3 * vessel.cell;
    CompoundShape shape;
    HullShape floor;
    for (int i = 0; i < staves; ++i) {
        for (const double y : {-wall, 0.0}) floor.points.push_back(at_wall(vessel.radius + wall, y, i));
    }
    shape.children.push_back({std::move(floor), {}});
    for (int i = 0; i < staves; ++i) {
        HullShape stave;
        for (const int corner : {i, i + 1}) {
            for (const double out : {0.0, wall}) {
                for (const double y : {0.0, top}) stave.points.push_back(at_wall(vessel.radius + out, y, corner));
            }
        }
        shape.children.push_back({std::move(stave), {}});
    }
    return shape;
}

FluidDefinition water_in(const TurningVessel& vessel) {
    FluidDefinition water{.viscosity = 0, .cell_size = vessel.cell};
    const double apart = vessel.cell / 2, inside = vessel.radius * std::cos(pi / staves);
    const int most = static_cast<int>(inside / apart);
    for (int x = -most; x < most; ++x) {
        for (int z = -most; z < most; ++z) {
            Vec3 place{(x + 0.5) * apart, apart / 2, (z + 0.5) * apart};
            const double distance = std::hypot(place.x, place.z);
            for (; distance < inside && place.y < vessel.level_at(distance); place.y += apart)
                water.points.push_back(place);
        }
    }
    return water;
}

class FluidSpin : public testing::TestWithParam<int> {};

TEST_P(FluidSpin, OfATurningVesselStaysAndGivesNoEnergy) {
    Random random(static_cast<std::uint64_t>(GetParam()) + 1);
    constexpr double seconds = 4;
    TurningVessel vessel;
    vessel.radius = random.between(0.12, 0.3);
    vessel.cell = vessel.radius / random.between(6, 9);
    vessel.depth = vessel.radius * random.between(0.7, 1.2);
    // At the wall it goes with 1 to 1.3 m/s.
    vessel.speed = random.between(1, 1.3) / vessel.radius;

    auto world = make_world({});
    const auto shape = world->create_shape(shape_of(vessel)).value();
    ASSERT_TRUE(world->create_body(
        {.kind = BodyKind::kinematic_body, .shape = shape, .angular_velocity = {0, vessel.speed, 0}}));
    const FluidHandle water = world->create_fluid(water_in(vessel)).value();
    const auto count = static_cast<std::uint32_t>(world->fluid_particles(water).positions.size());
    ASSERT_TRUE(world->change_fluid(water, {0, count}, [&](std::uint32_t, Vec3& place, Vec3& velocity) {
        velocity = cross({0, vessel.speed, 0}, place);
        return true;
    }));
    const Conserved before = world->conserved();
    run(*world, seconds);
    const Conserved after = world->conserved();
    const double spin = after.angular_momentum.y / before.angular_momentum.y;
    const double gained =
        after.kinetic_energy + after.potential_energy - before.kinetic_energy - before.potential_energy;
    RecordProperty("spin", std::to_string(spin));
    RecordProperty("gained", std::to_string(gained / before.kinetic_energy));
    EXPECT_EQ(world->fluid_particles(water).positions.size(), count);
    EXPECT_NEAR(spin, 1, 0.05);
    EXPECT_LT(gained, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FluidSpin, testing::Range(0, 6));

}  // namespace
}  // namespace embody::physics
