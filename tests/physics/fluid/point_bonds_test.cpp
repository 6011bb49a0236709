// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/point_bonds.h"

#include <gtest/gtest.h>

#include <vector>

#include "foundation/random.h"

namespace embody::physics::fluid {
namespace {

constexpr double cell = 0.03;  // m
const FluidProperties water{.density = 998, .particle_volume = 1e-6};
constexpr double particle_mass = 998e-6;  // kg

Vec3 random_vector(Random& random, double most) {
    return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

struct Cloud {
    std::vector<FluidParticle> particles;
    std::vector<PointBond> bonds;
    std::vector<Vec3> impulses;

    Cloud(Random& random, double drag) {
        for (int i = 0; i < 200; ++i) {
            FluidParticle& particle = particles.emplace_back();
            const Vec3 place = random_vector(random, 0.1), velocity = random_vector(random, 2);
            for (int axis = 0; axis < 3; ++axis) {
                particle.position[axis] = static_cast<float>(place[axis]);
                particle.velocity[axis] = static_cast<float>(velocity[axis]);
            }
        }
        for (int i = 0; i < 40; ++i) {
            const Vec3 part{random.unit(), random.unit() < 0.3 ? 0 : random.unit(), random.unit()};
            bonds.push_back({random_vector(random, 0.15), drag * part, {}, {}});
        }
        find_bonds(cell, water, particles, bonds);
    }
    [[nodiscard]] Vec3 momentum() const {
        Vec3 sum;
        for (const FluidParticle& particle : particles) sum += particle_mass * to_vec(particle.velocity);
        return sum;
    }
    [[nodiscard]] double energy() const {
        double sum = 0;
        for (const FluidParticle& particle : particles)
            sum += particle_mass / 2 * length_squared(to_vec(particle.velocity));
        return sum;
    }
    /// Brings each bond's liquid to a velocity; returns the energy that this takes of parcels of their own.
    double bring_to(Random& random, double speed) {
        double needed = 0;
        for (const PointBond& bond : bonds) {
            const Vec3 change = random_vector(random, speed) - bond.velocity;
            impulses.push_back(scale(bond.bound, change));
            needed += dot(impulses.back(), bond.velocity) + dot(impulses.back(), change) / 2;
        }
        push_bonds(cell, water, bonds, impulses, particles);
        return needed;
    }
};

TEST(PointBonds, HoldNoMoreThanTheirDragAndNothingTwice) {
    Random random(2);
    for (const double drag : {1e-6, 1e-3, 1.0, 1e6}) {
        const Cloud cloud(random, drag);
        Vec3 all;
        for (const PointBond& bond : cloud.bonds) {
            for (int axis = 0; axis < 3; ++axis) EXPECT_LE(bond.bound[axis], bond.drag[axis] * (1 + 1e-9));
            all += bond.bound;
        }
        const double most = particle_mass * static_cast<double>(cloud.particles.size());
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(all[axis], most);
        // What drag is strong holds all that is near, what is weak its drag.
        if (drag == 1e6) {
            EXPECT_GT(all.x, most / 10);
        }
    }
}

TEST(PointBonds, GiveTheirLiquidTheWholeImpulse) {
    Random random(3);
    for (const double drag : {1e-6, 1e-3, 1.0}) {
        Cloud cloud(random, drag);
        const Vec3 before = cloud.momentum();
        cloud.bring_to(random, 5);
        Vec3 given;
        double size = 0;
        for (const Vec3 impulse : cloud.impulses) {
            given += impulse;
            size += length(impulse);
        }
        EXPECT_LT(length(cloud.momentum() - before - given), 1e-5 * size + 1e-8);
    }
}

// A node and the parcel that it holds lose energy in an implicit step: the particles that stand for the parcel must not
// have more than it.
TEST(PointBonds, TakeNoMoreEnergyThanAParcelOfTheirMass) {
    Random random(4);
    for (int trial = 0; trial < 50; ++trial) {
        Cloud cloud(random, std::pow(10, random.between(-5, 3)));
        const double before = cloud.energy(), needed = cloud.bring_to(random, random.between(0, 5));
        EXPECT_LE(cloud.energy() - before, needed + 1e-6 * before);
    }
}

}  // namespace
}  // namespace embody::physics::fluid
