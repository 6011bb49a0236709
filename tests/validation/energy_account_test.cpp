// SPDX-License-Identifier: MIT
// The account of every step of random scenes (docs/physics/energy.md): nothing gains what no cause explains, impacts,
// contacts and joints without motors do no positive work, momentum is kept. Each run does a few scenes;
//     EMBODY_ACCOUNT_SCENES=100 test_validation --gtest_filter=RandomAccounts.*
// so many of each family (ctest --preset laws).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "validation/random_scenes.h"

namespace embody::physics {
namespace {

/// What accounts are compared with: of the whole scene.
struct Scale {
    double energy = 0, linear = 0, angular = 0;  ///< J, kg m/s, kg m²/s
};

// Kinetic energy and what a fall by a metre would add; the bodies' momenta without their directions.
Scale scale_of(const World& world) {
    Scale scale{world.conserved().kinetic_energy, 1e-9, 1e-9};
    for (const BodyHandle body : world.bodies()) {
        const double mass = world.mass(body);
        if (!std::isfinite(mass)) continue;
        scale.energy += mass * length(world.settings().gravity);
        const double momentum = mass * length(world.linear_velocity(body));
        const Mat3 inertia = world.inertia(body);
        const double spin = length(world.angular_velocity(body));
        scale.linear += momentum;
        scale.angular +=
            momentum * length(world.center_of_mass(body)) + spin * std::max({inertia.x.x, inertia.y.y, inertia.z.z});
    }
    return scale;
}

/// Largest shares of the scale in one step.
struct Worst {
    double gain = 0;                 ///< unexplained energy
    double off = 0;                  ///< unexplained energy, gained or lost, of steps without contacts at work
    double impacts = 0;              ///< positive work
    double contacts = 0;             ///< positive work
    double joints = 0;               ///< positive work of joints, contacts and what bounds them, together
    double lift = 0;                 ///< energy by position correction
    double linear = 0, angular = 0;  ///< unexplained momenta

    void add(const StepAccount& account, const Scale& scale) {
        const auto raise = [](double& most, double value, double unit) { most = std::max(most, value / unit); };
        const double contact_work = account.of(StepCause::contacts).work;
        raise(gain, account.unexplained_energy, scale.energy);
        if (contact_work == 0) raise(off, std::fabs(account.unexplained_energy), scale.energy);
        raise(impacts, account.of(StepCause::impacts).work, scale.energy);
        raise(contacts, contact_work, scale.energy);
        raise(joints, contact_work + account.of(StepCause::joints).work + account.of(StepCause::limits).work,
              scale.energy);
        raise(lift, account.of(StepCause::position_correction).work, scale.energy);
        raise(linear, length(account.unexplained_linear_momentum), scale.linear);
        raise(angular, length(account.unexplained_angular_momentum), scale.angular);
    }
};

Worst worst_of(World& world, int steps) {
    world.keep_account(true);
    const Scale scale = scale_of(world);
    Worst worst;
    for (int i = 0; i < steps; ++i) worst.add(*world.step().account, scale);
    return worst;
}

int scenes_wanted(int usual) { return wanted_cases("EMBODY_ACCOUNT_SCENES", usual); }

// Told where it is asked for, so that the bars can be compared with what is.
void tell(const char* family, std::uint64_t seed, const Worst& worst) {
    if (std::getenv("EMBODY_ACCOUNT_TELL") == nullptr) return;
    std::printf(
        "%s %llu: gain %.2g off %.2g impacts %.2g contacts %.2g joints %.2g lift %.2g linear %.2g angular %.2g\n",
        family, static_cast<unsigned long long>(seed), worst.gain, worst.off, worst.impacts, worst.contacts,
        worst.joints, worst.lift, worst.linear, worst.angular);
}

double median_of(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

constexpr double rounding = 1e-12;
// Contacts keep impulses as floats, each wrong by 6e-8 of itself, and do much work on what they hold.
constexpr double float_gain = 5e-6;

TEST(RandomAccounts, ImpactsInFreeSpaceAreExplained) {
    const int cases = scenes_wanted(20) * 50;
    std::vector<double> off;
    for (int seed = 1; seed <= cases; ++seed) {
        const auto [world, steps] = random_impact(static_cast<std::uint64_t>(seed));
        const Worst worst = worst_of(*world, steps);
        tell("impact", static_cast<std::uint64_t>(seed), worst);
        off.push_back(worst.off);
        EXPECT_LE(worst.gain, float_gain) << "seed " << seed;
        EXPECT_LE(worst.impacts, rounding) << "seed " << seed;
        EXPECT_LE(worst.contacts, float_gain) << "seed " << seed;
        EXPECT_LE(worst.lift, rounding) << "seed " << seed;
        // What rolls round and round notes an impulse that is not all of its change of momentum.
        EXPECT_LE(worst.linear, 0.02) << "seed " << seed;
    }
    // In most, all is told to rounding; the others turn evenly past what they do not touch.
    EXPECT_LE(median_of(off), rounding);
}

/// Without ground, momentum is kept: in impacts to rounding, where bodies lean on each other to that of floats. The
/// angular one is not where contacts turn what spins: they turn it evenly or bound its energy.
TEST(RandomAccounts, SwarmsInFreeSpaceKeepTheirMomentum) {
    const int scenes = scenes_wanted(60);
    std::vector<double> off;
    for (int seed = 1; seed <= scenes; ++seed) {
        const auto world = random_swarm(static_cast<std::uint64_t>(seed));
        world->keep_account(true);
        const Scale scale = scale_of(*world);
        Worst worst, impacts;
        for (int i = 0; i < 240; ++i) {
            const StepAccount& account = *world->step().account;
            worst.add(account, scale);
            if (account.of(StepCause::contacts).work == 0) impacts.add(account, scale);
        }
        tell("swarm", static_cast<std::uint64_t>(seed), worst);
        off.push_back(worst.off);
        tell("swarm's impacts", static_cast<std::uint64_t>(seed), impacts);
        EXPECT_LE(worst.gain, float_gain) << "seed " << seed;
        EXPECT_LE(worst.impacts, rounding) << "seed " << seed;
        EXPECT_LE(worst.contacts, float_gain) << "seed " << seed;
        EXPECT_LE(worst.linear, 1e-6) << "seed " << seed;
        // A contact's impulse below the last digit of the impact's before it is not in its total.
        EXPECT_LE(impacts.linear, 5e-9) << "seed " << seed;
        EXPECT_LE(worst.angular, 1e-2) << "seed " << seed;
    }
    EXPECT_LE(median_of(off), 1e-6);
}

/// Balls that collide; some are left to the contact solver and its floats, which also gives energy to what it parts.
TEST(RandomAccounts, BallsThatCollideKeepTheirMomentum) {
    const int scenes = scenes_wanted(60);
    for (int seed = 1; seed <= scenes; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const auto world = make_world({.gravity = {}});
        Material material = random_material(random);
        material.restitution = random.between(0.5, 1);
        for (int i = 0; i < 4; ++i) {
            const Vec3 place{1.5 * i - 2.25, random.between(-0.1, 0.1), random.between(-0.1, 0.1)};
            ASSERT_TRUE(world->create_body({.shape = world->create_shape(SphereShape{0.4}).value(),
                                            .position = place,
                                            .linear_velocity = {-place.x * random.between(0.5, 4), 0, 0},
                                            .angular_velocity = random_vector(random, 10),
                                            .mass = {.mass = random.between(0.1, 10)},
                                            .material = material}));
        }
        const Worst worst = worst_of(*world, 120);
        tell("balls", static_cast<std::uint64_t>(seed), worst);
        EXPECT_LE(worst.gain, float_gain) << "seed " << seed;
        EXPECT_LE(worst.off, 1e-7) << "seed " << seed;
        EXPECT_LE(worst.impacts, rounding) << "seed " << seed;
        EXPECT_LE(worst.contacts, 0.05) << "seed " << seed;
        EXPECT_LE(worst.linear, 1e-6) << "seed " << seed;
        EXPECT_LE(worst.angular, 1e-2) << "seed " << seed;
    }
}

TEST(RandomAccounts, ScenesOnTheGroundAreExplained) {
    const int scenes = scenes_wanted(30);
    for (int seed = 1; seed <= scenes; ++seed) {
        const Worst worst = worst_of(*random_scene(static_cast<std::uint64_t>(seed)), 400);
        tell("scene", static_cast<std::uint64_t>(seed), worst);
        EXPECT_LE(worst.gain, float_gain) << "seed " << seed;
        EXPECT_LE(worst.off, 1e-3) << "seed " << seed;
        EXPECT_LE(worst.linear, 0.02) << "seed " << seed;
        EXPECT_LE(worst.impacts, rounding) << "seed " << seed;
        // Sweeps that came to no end, and carried bodies that begin the step elsewhere after an impact.
        EXPECT_LE(worst.contacts, 5e-3) << "seed " << seed;
        EXPECT_LE(worst.lift, 0.1) << "seed " << seed;
    }
}

/// Joints take no part in an impact and are corrected in the substep after it: what acts at once there has only one
/// sum, and turns bodies farther than its mean tells. Without impacts chains are explained.
void check_chains(const char* family, bool has_floor, int scenes) {
    for (int seed = 1; seed <= scenes; ++seed) {
        const auto world = random_chain(static_cast<std::uint64_t>(seed), has_floor);
        world->keep_account(true);
        const Scale scale = scale_of(*world);
        Worst worst, calm;
        bool was_hit = false;
        for (int i = 0; i < 240; ++i) {
            const StepReport& report = world->step();
            worst.add(*report.account, scale);
            was_hit = was_hit || report.impacts > 0 || report.contacts > 0;
            if (!was_hit) calm.add(*report.account, scale);
        }
        tell(family, static_cast<std::uint64_t>(seed), worst);
        tell("calm", static_cast<std::uint64_t>(seed), calm);
        EXPECT_LE(calm.gain, 1e-2) << "seed " << seed;
        EXPECT_LE(calm.joints, 1e-2) << "seed " << seed;
        EXPECT_LE(worst.gain, 0.2) << "seed " << seed;
        EXPECT_LE(worst.impacts, rounding) << "seed " << seed;
        EXPECT_LE(worst.joints, 0.1) << "seed " << seed;
    }
}

TEST(RandomAccounts, ChainsInTheAirAreExplained) { check_chains("chain", false, scenes_wanted(30)); }

TEST(RandomAccounts, ChainsThatFallOnTheGroundAreBounded) { check_chains("fallen chain", true, scenes_wanted(15)); }

}  // namespace
}  // namespace embody::physics
