// SPDX-License-Identifier: MIT
// Which islands are solved directly, and how penetration is taken out from the ground up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/optimization/direct_islands.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/shock_propagation.h"

namespace embody::physics::optimization {
namespace {

/// Cubes of an edge of 1 m on each other over an immovable floor (slot 0), each in the one below by so much.
struct Tower {
    Tower(std::size_t cubes, double depth, double top_mass = 1) {
        bodies.resize(cubes + 1);
        bodies[0].center = bodies[0].start_center = {0, -0.5, 0};
        for (std::size_t i = 1; i <= cubes; ++i) {
            BodyState& body = bodies[i];
            const double mass = i == cubes ? top_mass : 1;
            body.center = body.start_center = {0, (static_cast<double>(i) - 0.5) - static_cast<double>(i) * depth, 0};
            body.inverse_mass = 1 / mass;
            body.inverse_inertia = Mat3::identity() * (6 / mass);
            collision::Manifold manifold;
            manifold.normal = {0, 1, 0};
            manifold.count = 4;
            for (int k = 0; k < 4; ++k) {
                const double top = body.center.y - 0.5 + depth / 2;
                manifold.points[static_cast<std::size_t>(k)] = {
                    .position = {k & 1 ? 0.5 : -0.5, top, k & 2 ? 0.5 : -0.5}, .separation = -depth, .feature = 1u + k};
            }
            contacts.push_back(constraint::make_contact(static_cast<std::uint32_t>(i - 1),
                                                        static_cast<std::uint32_t>(i), manifold, bodies));
            awake.push_back(static_cast<std::uint32_t>(i));
        }
        for (const Contact& contact : contacts) summaries.push_back(constraint::summary_of(contact, 0.05F));
        build_islands(awake, bodies, summaries, {}, islands);
    }
    std::vector<BodyState> bodies;
    std::vector<Contact> contacts;
    std::vector<ContactSummary> summaries;
    std::vector<std::uint32_t> awake;
    Islands islands;
};

TEST(DirectIslands, AreTallOnesAndHeavyOnesOnLight) {
    const auto use = [](const Tower& tower) {
        EXPECT_EQ(tower.islands.list.size(), 1u);
        return direct_use_of(tower.islands.list[0], tower.islands, tower.contacts, tower.bodies, {});
    };
    EXPECT_NE(use(Tower(2, 0)), DirectUse::always);
    EXPECT_EQ(use(Tower(12, 0)), DirectUse::always);       // tall and thin
    EXPECT_EQ(use(Tower(2, 0, 1000)), DirectUse::always);  // a thousandfold on one
    EXPECT_NE(use(Tower(2, 0, 2)), DirectUse::always);
}

TEST(ShockPropagation, TakesDepthOutFromTheGroundUpAndChangesNoVelocity) {
    for (const std::size_t cubes : {1u, 3u, 8u}) {
        Tower tower(cubes, 0.01);
        for (BodyState& body : tower.bodies) body.linear_velocity = {0.1, -0.2, 0.3};
        const auto before = tower.bodies;
        constraint::ContactSoftness rigid;
        rigid.substep = 1.0 / 240;
        propagate_shock(tower.islands.list[0], tower.islands, tower.contacts, {{}, rigid}, tower.bodies);
        EXPECT_EQ(tower.bodies[0].center, before[0].center);
        for (std::size_t i = 1; i <= cubes; ++i) {
            EXPECT_EQ(tower.bodies[i].linear_velocity, before[i].linear_velocity);
            EXPECT_EQ(tower.bodies[i].angular_velocity, before[i].angular_velocity);
            EXPECT_NEAR(tower.bodies[i].center.x, 0, 1e-6);
            EXPECT_GE(tower.bodies[i].center.y, before[i].center.y - 1e-12);
        }
        // The lowest level is never pushed into the floor, and ends nearer to standing on it.
        const auto depth = [&](std::size_t i) {
            double deepest = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                deepest = std::min(deepest, constraint::current_separation(tower.contacts[i],
                                                                           tower.contacts[i].points[k], tower.bodies));
            }
            return -deepest;
        };
        for (std::size_t i = 0; i < cubes; ++i) EXPECT_LE(depth(i), 0.01 + 1e-6);
        EXPECT_LT(depth(0), 0.01);
    }
}

TEST(ShockPropagation, LeavesWhatIsNotDeepWhereItIs) {
    Tower tower(3, 0);
    const auto before = tower.bodies;
    propagate_shock(tower.islands.list[0], tower.islands, tower.contacts, {{}, {.substep = 1.0 / 240}}, tower.bodies);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(tower.bodies[i].center, before[i].center);
}

}  // namespace
}  // namespace embody::physics::optimization
