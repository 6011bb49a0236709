// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "physics/dynamic/conserved.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/dynamic/mass.h"

namespace embody::physics::dynamic {
namespace {

TEST(Motion, GyroscopicDriftKeepsEnergyAndMomentumEvenInHugeSteps) {
    BodyConstants constants;
    constants.mass = 1;
    constants.inertia = Mat3::diagonal({1, 2, 2.5});
    constants.inverse_inertia = inverse_or_zero(constants.inertia);
    BodyState state;
    state.inverse_mass = 1;
    state.angular_velocity = {3, 4, 5};
    refresh_inertia(state, constants);
    Conserved before, after;
    add_conserved(before, state, constants, {});
    for (int i = 0; i < 1000; ++i) {
        split_gyroscopic(state, constants, 0.1);
        drift(state, constants, 0.1);
    }
    add_conserved(after, state, constants, {});
    EXPECT_NEAR(after.kinetic_energy, before.kinetic_energy, 1e-9 * before.kinetic_energy);
    EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-9 * length(before.angular_momentum));
}

TEST(Mass, NeedsAShapeOrNumbers) {
    BodyConstants constants;
    EXPECT_FALSE(resolve_mass({}, {}, constants));
    EXPECT_FALSE(resolve_mass({.mass = 1}, {}, constants));
    EXPECT_TRUE(resolve_mass({.mass = 1, .inertia = Mat3::identity()}, {}, constants));
    EXPECT_TRUE(constants.is_isotropic);
}

TEST(Mass, GivenCentreShiftsTheInertiaByTheParallelAxisTheorem) {
    const geometry::MassProperties unit_cube{1, {}, Mat3::identity() * (1.0 / 6)};
    BodyConstants constants;
    ASSERT_TRUE(resolve_mass({.mass = 2, .center_of_mass = Vec3{0.5, 0, 0}}, unit_cube, constants));
    EXPECT_NEAR(constants.inertia(0, 0), 2.0 / 6, 1e-12);
    EXPECT_NEAR(constants.inertia(1, 1), 2 * (1.0 / 6 + 0.25), 1e-12);
}

}  // namespace
}  // namespace embody::physics::dynamic
