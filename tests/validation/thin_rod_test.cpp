// SPDX-License-Identifier: MIT
// Thin rods: an axial moment of inertia thousands of times below the others turns small errors into large spins.
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

struct Fall {
    double gain = 0;    // greatest energy above the start's, share of it
    double height = 0;  // of the centre at the end, m
};
Fall drop_rod(const ShapeDefinition& rod, double mu) {
    const auto world = make_world({.sleeping = false});
    add_plane(*world, friction(mu));
    const auto shape = world->create_shape(rod).value();
    const auto body = world
                          ->create_body({.shape = shape,
                                         .position = {0, 1.2, 0},
                                         .rotation = normalized({0.1, 0.2, 0.3, 0.9}),
                                         .material = friction(mu)})
                          .value();
    const double start = energy(*world);
    Fall fall;
    for (int i = 0; i < 300; ++i) {
        world->step();
        fall.gain = std::max(fall.gain, energy(*world) / start - 1);
    }
    fall.height = world->center_of_mass(body).y;
    return fall;
}

TEST(ThinRod, FallsAndLiesDownWithoutGainingEnergy) {
    for (const auto& [thin, mu] : {std::pair(0.1, 0.0), std::pair(0.1, 0.5), std::pair(0.01, 0.0), std::pair(0.01, 0.2),
                                   std::pair(0.01, 0.7), std::pair(0.002, 0.5)}) {
        SCOPED_TRACE("half thickness " + std::to_string(thin) + ", friction " + std::to_string(mu));
        const ShapeDefinition rods[] = {BoxShape{{thin, 1, thin}}, CylinderShape{thin, 1}};
        for (const ShapeDefinition& rod : rods) {
            const Fall fall = drop_rod(rod, mu);
            EXPECT_LE(fall.gain, 1e-3) << shape_name(rod);
            EXPECT_NEAR(fall.height, thin, 1e-3) << shape_name(rod);
        }
    }
}

}  // namespace
}  // namespace embody::physics
