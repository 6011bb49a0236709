// SPDX-License-Identifier: MIT
// Atwood's machine: two weights on a rope over a drum that is fixed, with and without friction, or turns with the rope.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double linear_density = 0.02, rope_radius = 4e-3, hang = 1.2;  // kg/m, m, m of rope on each side

/// Random drum, segments and weights.
struct Machine {
    double radius, segment, light, heavy, friction;  // m, m, kg, kg
    double drum_mass = 0;                            // kg; 0: it is fixed
    std::unique_ptr<World> world = make_world({.sleeping = false});
    BodyHandle drum, left, right;
    double rope_mass = 0;
    double highest = 0, first = 0, work = 0;  // energy of all, and what the weights' fall gives, J

    explicit Machine(embody::Random& random)
        : radius(random.between(0.06, 0.2)),
          segment(random.between(0.01, 0.03)),
          light(random.between(1, 3)),
          heavy(light * random.between(1.2, 2.5)),
          friction(0) {}

    void build() {
        BodyDefinition definition{.kind = drum_mass > 0 ? BodyKind::dynamic_body : BodyKind::static_body,
                                  .shape = world->create_shape(CylinderShape{radius, 0.1}).value(),
                                  .rotation = from_axis_angle({1, 0, 0}, pi / 2),
                                  .material = physics::friction(friction)};
        if (drum_mass > 0) definition.mass.mass = drum_mass;
        drum = world->create_body(definition).value();
        if (drum_mass > 0) {
            const Quat along = from_two_vectors({1, 0, 0}, {0, 0, 1});
            const JointDefinition axle{.joint = HingeJoint{},
                                       .body_b = drum,
                                       .frame_a = {{}, along},
                                       .frame_b = {{}, conjugate(definition.rotation) * along}};
            ASSERT_TRUE(world->create_joint(axle).ok());
        }
        lay_rope();
        highest = first = energy(*world);
    }

    // Half around the drum, then down on both sides to the weights. Its segments, not its nodes, touch the drum.
    void lay_rope() {
        const double side = radius + rope_radius + segment * segment / (8 * radius), half = pi * side / 2 + hang;
        auto rope = rope_between({-half, 0, 0}, {half, 0, 0}, 2 * half / std::lround(2 * half / segment),
                                 {.linear_density = linear_density, .axial_stiffness = 1e5, .rayleigh_damping = 0.01});
        for (Vec3& node : rope.nodes) {
            const double s = node.x, beyond = std::fabs(s) - pi * side / 2;
            node = beyond > 0 ? Vec3{std::copysign(side, s), -beyond, 0}
                              : Vec3{side * std::sin(s / side), side * std::cos(s / side), 0};
        }
        rope.contact_radius = rope_radius;
        rope.material = physics::friction(friction);
        const auto weight = [&](double mass, Vec3 place) {
            BodyDefinition body{.kind = BodyKind::dynamic_body,
                                .shape = world->create_shape(SphereShape{5e-3}).value(),
                                .position = place};
            body.mass.mass = mass;
            return world->create_body(body).value();
        };
        left = weight(light, rope.nodes.front());
        right = weight(heavy, rope.nodes.back());
        rope.attachments = {{0, left, {}}, {static_cast<std::uint32_t>(rope.nodes.size() - 1), right, {}}};
        ASSERT_TRUE(world->create_deformable(rope).ok());
        rope_mass = 2 * half * linear_density;
    }

    // Speed of the heavy weight after half a second, over that which the fall of the weights gives by energy.
    // `grip`: T₂/T₁ = exp(µ π) of Euler's and Eytelwein's rope, 1 without friction.
    double speed_ratio(double grip = 1) {
        const double start = world->pose(right).position.y;
        for (int i = 0; i < 30; ++i) {
            world->step();
            highest = std::max(highest, energy(*world));
        }
        const double fallen = start - world->pose(right).position.y, side = radius + rope_radius;
        const double of_drum = drum_mass / 2 * radius * radius / (side * side);
        work = gravity * ((heavy - light * grip) * fallen + (grip == 1 ? linear_density * fallen * fallen : 0));
        const double inertia = heavy + light * grip + (1 + grip) / 2 * rope_mass + of_drum;
        return -world->linear_velocity(right).y / std::sqrt(2 * work / inertia);
    }
};

TEST(Atwood, OverASlipperyDrum) {
    embody::Random random(22);
    for (int i = 0; i < 12; ++i) {
        Machine machine(random);
        machine.build();
        EXPECT_NEAR(machine.speed_ratio(), 1, 0.03) << i;
        EXPECT_LT(machine.highest - machine.first, 2e-3 * machine.work) << i;
    }
}

TEST(Atwood, OverADrumWithFriction) {
    embody::Random random(23);
    for (int i = 0; i < 12; ++i) {
        Machine machine(random);
        // Most of the weights slide all the same: up to half of what holds them.
        machine.friction = random.between(0.2, 0.5) * std::log(machine.heavy / machine.light) / pi;
        machine.build();
        EXPECT_NEAR(machine.speed_ratio(std::exp(machine.friction * pi)), 1, 0.03) << i;
        EXPECT_LT(machine.highest - machine.first, 2e-3 * machine.work) << i;
    }
}

TEST(Atwood, OverATurningDrum) {
    embody::Random random(24);
    int right = 0;
    for (int i = 0; i < 12; ++i) {
        Machine machine(random);
        machine.friction = 0.8;
        machine.drum_mass = random.between(0.5, 4);
        machine.build();
        const double ratio = machine.speed_ratio();
        EXPECT_NEAR(ratio, 1, 0.05) << i;
        right += std::fabs(ratio - 1) < 0.03;
        EXPECT_LT(machine.highest - machine.first, 0.01 * machine.work) << i;
        // The rope takes the drum along, and its hinge lets it turn about its axis alone.
        const Vec3 spin = machine.world->angular_velocity(machine.drum);
        EXPECT_NEAR(spin.z * (machine.radius + rope_radius) / machine.world->linear_velocity(machine.right).y, 1, 0.05);
        EXPECT_LT(std::hypot(spin.x, spin.y), 0.02) << i;
        EXPECT_LT(length(machine.world->pose(machine.drum).position), 1e-3) << i;
    }
    EXPECT_GE(right, 11);  // of 100 by a program 92, none of them further off than 5 %
}

}  // namespace
}  // namespace embody::physics
