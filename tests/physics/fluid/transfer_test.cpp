// SPDX-License-Identifier: MIT
// Particles to faces and back: what is linear is exact, mass and momenta are kept.
#include "physics/fluid/particles/transfer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "math/mat3.h"
#include "physics/fluid/liquid_block.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1, edge = 1;

void expect_near(Vec3 a, Vec3 b, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

Vec3 position_of(const FluidParticle& p) { return {p.position[0], p.position[1], p.position[2]}; }
Vec3 velocity_of(const FluidParticle& p) { return {p.velocity[0], p.velocity[1], p.velocity[2]}; }

/// A velocity that is linear in the place: v + G x.
struct LinearField {
    Vec3 at_origin;
    Vec3 gradient[3];

    explicit LinearField(Random& random) {
        const auto any = [&] { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; };
        at_origin = any();
        for (Vec3& row : gradient) row = any();
    }
    Vec3 operator()(Vec3 p) const {
        return at_origin + Vec3{dot(gradient[0], p), dot(gradient[1], p), dot(gradient[2], p)};
    }
};

TEST(FluidTransfer, NoParticlesMakeNoFaceKnown) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {4, 4, 4}));
    block.particles.clear();
    block.grid.sort(block.particles, LiquidBlock::particle_fraction, {}, {}, block.workers);
    block.transfer();
    EXPECT_TRUE(block.grid.tiles().empty());
}

TEST(FluidTransfer, MassAndMomentumOfTheFacesAreTheParticles) {
    Random random(1);
    for (int trial = 0; trial < 5; ++trial) {
        const LiquidBlock block(h, scatter(random, 8000, edge));
        ASSERT_EQ(block.grid.on_grid(), block.particles.size());
        Vec3 momentum;
        for (const FluidParticle& particle : block.particles) momentum += velocity_of(particle);
        expect_near(block.face_momenta().linear, momentum, 0.02);
        const double count = static_cast<double>(block.particles.size());
        double density = 0;
        Vec3 masses;
        for (const Cell& corner : block.grid.tiles()) {
            block.grid.for_cells(corner, [&](int cell, const Cell&) {
                density += block.grid.density[cell];
                for (int axis = 0; axis < 3; ++axis) {
                    masses[axis] += block.grid.mass[axis][cell];
                    EXPECT_EQ(block.grid.known[axis][cell] != 0, block.grid.mass[axis][cell] > 1e-6f);
                }
            });
        }
        EXPECT_NEAR(density, count * LiquidBlock::particle_fraction, 1e-5 * count);
        expect_near(masses, {count, count, count}, 1e-5 * count);
    }
}

TEST(FluidTransfer, FacesToParticlesToFacesKeepsBothMomenta) {
    Random random(2);
    LiquidBlock block(h, scatter(random, 8000, edge));
    // Any velocities of the faces that particles reach: what they sum to survives the way to the particles and back.
    block.set_velocity([&](Vec3) { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; });
    const auto before = block.face_momenta();
    for (FluidParticle& particle : block.particles) {
        const FieldSample sample = sample_field(block.grid, block.grid.velocity, particle.position);
        for (int a = 0; a < 3; ++a) {
            particle.velocity[a] = sample.value[a];
            std::copy_n(sample.gradient[a], 3, particle.affine[a]);
        }
    }
    Vec3 momentum;
    for (const FluidParticle& particle : block.particles) momentum += velocity_of(particle);
    expect_near(momentum, before.linear, 0.02);
    block.transfer();
    const auto after = block.face_momenta();
    expect_near(after.linear, before.linear, 0.02);
    expect_near(after.angular, before.angular, 0.02);
}

TEST(FluidTransfer, LinearFieldsGoToFacesAndBackExactly) {
    Random random(3);
    const LinearField field(random);
    std::vector<FluidParticle> particles = scatter(random, 6000, edge);
    for (FluidParticle& particle : particles) {
        const Vec3 velocity = field(position_of(particle));
        for (int a = 0; a < 3; ++a) {
            particle.velocity[a] = static_cast<float>(velocity[a]);
            for (int b = 0; b < 3; ++b) particle.affine[a][b] = static_cast<float>(field.gradient[a][b]);
        }
    }
    const LiquidBlock block(h, particles);
    for (const Cell& corner : block.grid.tiles()) {
        block.grid.for_cells(corner, [&](int cell, const Cell& c) {
            for (int axis = 0; axis < 3; ++axis) {
                // Faces that hardly any particle reaches know no more than a float of their share tells.
                if (block.grid.mass[axis][cell] < 1e-3f) continue;
                EXPECT_NEAR(block.grid.velocity[axis][cell], field(block.face_center(axis, c))[axis], 2e-4);
            }
        });
    }
    for (const FluidParticle& particle : block.particles) {
        const Vec3 p = position_of(particle);
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside = inside && p[a] > h && p[a] < edge - h;
        if (!inside) continue;
        const FieldSample sample = sample_field(block.grid, block.grid.velocity, particle.position);
        for (int a = 0; a < 3; ++a) {
            EXPECT_NEAR(sample.value[a], field(p)[a], 1e-5);
            for (int b = 0; b < 3; ++b) EXPECT_NEAR(sample.gradient[a][b], field.gradient[a][b], 1e-3);
        }
    }
}

TEST(FluidTransfer, SamplesOfALinearFieldAreExact) {
    Random random(4);
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {10, 10, 10}));
    const LinearField field(random);
    block.set_velocity(field);
    std::vector<float> centers(block.grid.row.size(), 0);
    for (const Cell& corner : block.grid.tiles()) {
        block.grid.for_cells(corner, [&](int cell, const Cell& c) {
            centers[cell] = static_cast<float>(field(block.grid.center(c)).x);
        });
    }
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 p{random.between(0, edge), random.between(0, edge), random.between(0, edge)};
        const float place[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        float value[3], slope[3];
        sample_value(block.grid, block.grid.velocity, place, value);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(value[a], field(p)[a], 5e-6);
        EXPECT_NEAR(sample_center(block.grid, centers, place, slope), field(p).x, 5e-6);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(slope[a], field.gradient[0][a] * h, 5e-6);
    }
}

TEST(FluidTransfer, WeightsSumToOneAroundThePlace) {
    Random random(5);
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {10, 10, 10}));
    block.set_velocity([&](Vec3) { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; });
    const Cell& size = block.grid.size();
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 p{random.between(0, edge), random.between(0, edge), random.between(0, edge)};
        const float place[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        float value[3];
        sample_value(block.grid, block.grid.velocity, place, value);
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0, mean = 0;
            Vec3 center;
            for (const FaceWeight& face : face_weights(block.grid, place, axis)) {
                EXPECT_GE(face.weight, 0);
                sum += face.weight;
                mean += static_cast<double>(face.weight) * block.grid.velocity[axis][face.cell];
                const Cell c{face.cell % size[0], face.cell / size[0] % size[1], face.cell / (size[0] * size[1])};
                center += static_cast<double>(face.weight) * block.face_center(axis, c);
            }
            EXPECT_NEAR(sum, 1, 1e-6);
            EXPECT_NEAR(mean, value[axis], 2e-6);
            expect_near(center, p, 2e-6);
        }
    }
}

}  // namespace
}  // namespace embody::physics::fluid
