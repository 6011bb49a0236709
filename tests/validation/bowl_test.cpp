// SPDX-License-Identifier: MIT
// A ball that rolls or slides in a bowl or half pipe trades height for motion: without friction, and where it rolls
// without slipping, its energy stays, on meshes, heightfields and boxes alike, from marbles to boulders. Each run does
// a few random cases;
//     EMBODY_BOWL_CASES=1000 test_validation --gtest_filter=RandomBowls.*
// does so many, of 60 s each (ctest --preset laws).
#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

/// A hollow: a half pipe along Z or a bowl, its lowest place in the origin, that reaches up to `reach` (rad).
struct Hollow {
    std::string kind;    // "pipe", "bowl": meshes; "field pipe", "field bowl", "box pipe"
    double radius = 1;   // m
    int facets = 100;    // over a quarter circle each side
    double reach = 1.5;  // rad
    bool is_random = false;
};

// The angle from the lowest place and around: on a pipe `around` is the place along it, m.
Vec3 place_on(const Hollow& hollow, double angle, double around) {
    const double across = hollow.radius * std::sin(angle), up = hollow.radius * (1 - std::cos(angle));
    if (hollow.kind == "pipe") return {across, up, around};
    return {across * std::cos(around), up, across * std::sin(around)};
}

// Rows of quads split along random diagonals; the rows of a random one lie unevenly.
MeshShape mesh_of(const Hollow& hollow, Random& random) {
    const bool is_pipe = hollow.kind == "pipe";
    const int rows = is_pipe ? 2 * hollow.facets : hollow.facets;
    const int columns = is_pipe ? (hollow.is_random ? 2 + static_cast<int>(random.below(30)) : 8) : 4 * hollow.facets;
    const double last = hollow.reach, first = is_pipe ? -last : 0, length = 2 * hollow.radius;
    MeshShape mesh;
    const auto uneven = [&] { return hollow.is_random ? random.between(-0.3, 0.3) : 0; };
    std::vector<double> angles, arounds;
    for (int i = 0; i <= rows; ++i) {
        const bool is_end = i == 0 || i == rows;
        angles.push_back(first + (last - first) * (i + (is_end ? 0 : uneven())) / rows);
    }
    for (int k = 0; k <= columns; ++k) {
        const double share = (k + (k == 0 || k == columns ? 0 : uneven())) / columns;
        arounds.push_back(is_pipe ? (share - 0.5) * length : 2 * pi * share);
    }
    for (const double angle : angles) {
        for (const double around : arounds) mesh.positions.push_back(to_vec3f(place_on(hollow, angle, around)));
    }
    const auto at = [&](int i, int k) {
        if (!is_pipe && i == 0) return std::uint32_t{0};
        const int column = !is_pipe && k == columns ? 0 : k;
        return static_cast<std::uint32_t>(i * (columns + 1) + column);
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == b || b == c || a == c) return;
        // Seen from the inside.
        const Vec3 pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c];
        Vec3 inwards = Vec3{0, hollow.radius, 0} - pa;
        if (is_pipe) inwards.z = 0;
        if (dot(cross(pb - pa, pc - pa), inwards) < 0) std::swap(b, c);
        mesh.triangles.push_back({a, b, c});
    };
    for (int i = 0; i < rows; ++i) {
        for (int k = 0; k < columns; ++k) {
            const bool other = hollow.is_random && random.below(2) > 0;
            add(at(i, k), at(i, k + 1), other ? at(i + 1, k) : at(i + 1, k + 1));
            add(at(i + 1, k + 1), at(i + 1, k), other ? at(i, k + 1) : at(i, k));
        }
    }
    return mesh;
}

HeightfieldShape field_of(const Hollow& hollow, double& corner) {
    const double half = hollow.radius * std::sin(hollow.reach);
    const int cells = 2 * hollow.facets;
    HeightfieldShape field{cells + 1, cells + 1, 2 * half / cells, 2 * half / cells, {}};
    corner = -half;
    for (int r = 0; r <= cells; ++r) {
        for (int c = 0; c <= cells; ++c) {
            const double x = corner + c * field.cell_x, z = hollow.kind == "field pipe" ? 0 : corner + r * field.cell_z;
            const double squared = std::min(x * x + z * z, half * half);
            field.heights.push_back(
                static_cast<float>(hollow.radius - std::sqrt(hollow.radius * hollow.radius - squared)));
        }
    }
    return field;
}

// Boxes whose faces touch the circle from outside.
CompoundShape boxes_of(const Hollow& hollow) {
    CompoundShape shape;
    const int count = 2 * hollow.facets;
    for (int i = 0; i < count; ++i) {
        const double angle = hollow.reach * (2 * (i + 0.5) / count - 1), thick = hollow.radius / 4;
        const double half = (hollow.radius + thick) * std::tan(hollow.reach / count);
        const Vec3 out{std::sin(angle), -std::cos(angle), 0};
        const Vec3 middle = Vec3{0, hollow.radius, 0} + out * (hollow.radius + thick / 2);
        shape.children.push_back(
            {BoxShape{{half, thick / 2, 2 * hollow.radius}}, {middle, from_axis_angle({0, 0, 1}, angle)}});
    }
    return shape;
}

void add_hollow(World& world, const Hollow& hollow, double mu, Random& random) {
    BodyDefinition ground{.kind = BodyKind::static_body, .material = friction(mu)};
    ShapeDefinition shape;
    if (hollow.kind == "box pipe") {
        shape = boxes_of(hollow);
    } else if (hollow.kind == "field pipe" || hollow.kind == "field bowl") {
        double corner = 0;
        shape = field_of(hollow, corner);
        ground.position = {corner, 0, corner};
    } else {
        shape = mesh_of(hollow, random);
    }
    ground.shape = world.create_shape(shape).value();
    ASSERT_TRUE(world.create_body(ground));
}

/// What happens to the energy above the lowest place, in shares of the start's.
struct Outcome {
    double least = 1e300, most = 0, last = 0;
};

struct Ball {
    double radius = 0.1, angle = 0.3, mu = 0;
    Vec3 velocity, spin;
    double seconds = 60, time_step = 1.0 / 60;
    double above = 0;  ///< the smooth surface, m
};

// The ball sits on the smooth surface at first; what that is off the facets it falls, or counts as heat: told from the
// first tenth of a second.
Outcome swing(const Hollow& hollow, const Ball& ball, std::uint64_t seed = 1) {
    Random random(seed);
    auto world = make_world({.time_step = ball.time_step});
    add_hollow(*world, hollow, ball.mu, random);
    const double centre = hollow.radius - ball.radius - ball.above;
    const auto body = world
                          ->create_body({.shape = world->create_shape(SphereShape{ball.radius}).value(),
                                         .position = {centre * std::sin(ball.angle),
                                                      hollow.radius - centre * std::cos(ball.angle), 0},
                                         .linear_velocity = ball.velocity,
                                         .angular_velocity = ball.spin,
                                         .material = friction(ball.mu),
                                         .allow_sleep = false})
                          .value();
    const double lowest = world->mass(body) * gravity * ball.radius;
    Outcome outcome;
    double start = 0;
    const int steps = static_cast<int>(std::lround(ball.seconds / ball.time_step));
    for (int i = 0; i <= steps; ++i) {
        const double now = energy(*world) - lowest;
        if (i == std::lround(0.1 / ball.time_step)) start = now;
        if (start > 0) {
            outcome.last = now / start;
            outcome.least = std::min(outcome.least, outcome.last);
            outcome.most = std::max(outcome.most, outcome.last);
        }
        world->step();
    }
    return outcome;
}

constexpr double bar = 0.02;  // of the energy, in 60 s

void expect_kept(const Hollow& hollow, const Ball& ball, const std::string& what, std::uint64_t seed = 1) {
    const Outcome outcome = swing(hollow, ball, seed);
    EXPECT_GT(outcome.least, 1 - bar) << what;
    EXPECT_LT(outcome.most, 1 + bar) << what;
}

double in_degrees(double angle) { return angle * pi / 180; }

TEST(Bowls, BallKeepsItsEnergyForAMinute) {
    for (const std::string kind : {"pipe", "bowl", "field pipe", "field bowl", "box pipe"}) {
        for (const double mu : {0.0, 0.5}) {
            for (const double angle : {5.0, 30.0}) {
                const Hollow hollow{kind, 1, 60, kind.starts_with("field") ? 1.0 : 1.5};
                expect_kept(hollow, {0.1, in_degrees(angle), mu},
                            kind + " " + std::to_string(mu) + " " + std::to_string(angle));
            }
        }
    }
}

TEST(Bowls, MarblesAndBouldersKeepTheirEnergy) {
    for (const auto& [r, R, angle] :
         {std::array{0.01, 0.2, 30.0}, {0.005, 0.015, 30.0}, {2.0, 6.0, 60.0}, {0.01, 1.0, 60.0}, {0.5, 20.0, 20.0}}) {
        for (const std::string kind : {"pipe", "bowl"}) {
            expect_kept({kind, R, 60, 1.5}, {.radius = r, .angle = in_degrees(angle), .mu = 0.8, .seconds = 10},
                        kind + " " + std::to_string(r) + " in " + std::to_string(R));
        }
    }
}

TEST(Bowls, CoarseHalfPipeIsRoundWhereItsEdgesAreSmall) {
    for (const double mu : {0.0, 0.5}) {
        for (const int facets : {6, 12}) {
            for (const std::string kind : {"pipe", "box pipe"}) {
                const Hollow hollow{kind, 1, facets, pi / 2};
                expect_kept(hollow, {0.1, in_degrees(40), mu},
                            kind + " " + std::to_string(facets) + " " + std::to_string(mu));
            }
        }
    }
}

// A smooth bowl pushes a ball through its centre: where its moments of inertia differ it goes on turning as in free
// flight, and its angular momentum about the centre stays.
TEST(Bowls, BallOfUnequalMomentsTurnsAsInFreeFlight) {
    for (const std::string kind : {"pipe", "bowl"}) {
        Random random(1);
        auto world = make_world({});
        add_hollow(*world, {kind, 1, 60, 1.5}, 0, random);
        const double r = 0.1, angle = in_degrees(20);
        const Vec3 moments{0.002, 0.004, 0.005}, spin{3, 0.3, 2};
        const auto ball = world
                              ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                             .position = {(1 - r) * std::sin(angle), 1 - (1 - r) * std::cos(angle), 0},
                                             .angular_velocity = spin,
                                             .mass = {.mass = 1, .inertia = Mat3::diagonal(moments)},
                                             .material = friction(0),
                                             .allow_sleep = false})
                              .value();
        const Vec3 start{moments.x * spin.x, moments.y * spin.y, moments.z * spin.z};
        for (int i = 0; i < 60; ++i) {
            world->step();
            const Quat rotation = world->pose(ball).rotation;
            const Vec3 own = rotate_inverse(rotation, world->angular_velocity(ball));
            const Vec3 momentum = rotate(rotation, Vec3{moments.x * own.x, moments.y * own.y, moments.z * own.z});
            ASSERT_LT(length(momentum - start), 0.08 * length(start)) << kind << " step " << i;
        }
    }
}

// A ball with its centre of mass below the middle stands up in its place like a tumbler: it swings about the lowest
// place with T = 2 pi sqrt((I + m (r - d)^2) / (m g d)), I about the centre of mass, and rolls nowhere.
TEST(Bowls, WeightedBallSwingsAboutItsHeavySide) {
    auto world = make_world({.air_density = 0});
    const double r = 0.1, d = 0.04, inertia = 0.003, lean = 0.1;
    add_plane(*world, friction(1));
    const auto ball = world
                          ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                         .position = {0, r, 0},
                                         .rotation = from_axis_angle({0, 0, 1}, lean),
                                         .mass = {.mass = 1,
                                                  .center_of_mass = Vec3{0, -d, 0},
                                                  .inertia = Mat3::diagonal({inertia, inertia, inertia})},
                                         .material = friction(1),
                                         .allow_sleep = false})
                          .value();
    int crossings = 0;
    double time = 0, last = -1;
    for (; crossings < 5; time += 1.0 / 60) {
        ASSERT_LT(time, 20);
        world->step();
        const double now = rotate(world->pose(ball).rotation, {0, 1, 0}).x;
        if (now * last < 0) ++crossings;
        if (now != 0) last = now;
    }
    const double period = 2 * pi * std::sqrt((inertia + (r - d) * (r - d)) / (gravity * d));
    EXPECT_NEAR((time - 1.0 / 60) / 2.25, period, 0.03 * period);
}

// Small swings: T = 2 pi sqrt((R - r) / g), of what rolls sqrt(7/5) times as long. Told by the fifth turn.
TEST(Bowls, OscillationHasTheKnownPeriod) {
    for (const std::string kind : {"pipe", "bowl", "field pipe", "box pipe"}) {
        for (const double mu : {0.0, 0.5}) {
            Random random(1);
            auto world = make_world({});
            const Hollow hollow{kind, 1, 90, 1};
            add_hollow(*world, hollow, mu, random);
            const double r = 0.1, angle = in_degrees(8);
            const auto body =
                world
                    ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                   .position = {(1 - r) * std::sin(angle), 1 - (1 - r) * std::cos(angle), 0},
                                   .material = friction(mu)})
                    .value();
            int crossings = 0;
            double time = 0, last = 1, farthest = 0;
            for (; crossings < 10; time += 1.0 / 60) {
                ASSERT_LT(time, 60);
                world->step();
                const double x = world->pose(body).position.x;
                if (x * last < 0) ++crossings;
                last = x;
                farthest = std::min(farthest, x);
            }
            const double period = 2 * pi * std::sqrt((1 - r) / gravity * (mu > 0 ? 1.4 : 1)) * (1 + angle * angle / 16);
            EXPECT_NEAR((time - 1.0 / 60) / 4.75, period, 0.01 * period) << kind << " mu " << mu;
            EXPECT_NEAR(farthest, -(1 - r) * std::sin(angle), 0.03 * std::sin(angle)) << kind << " mu " << mu;
        }
    }
}

MeshShape strip(const std::vector<std::array<double, 2>>& profile) {
    MeshShape mesh;
    for (const auto& [x, y] : profile) {
        for (const double z : {-1.0, 1.0}) mesh.positions.push_back(to_vec3f({x, y, z}));
    }
    for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
        mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
    }
    return mesh;
}

// Without friction from level ground onto a ramp: over an edge of a smooth surface all of the speed goes on, over a
// real one what points along the ramp.
TEST(Bowls, RampOfTwentyDegreesTakesTheKnownEnergyAndOneOfTenNone) {
    for (const double degrees : {10.0, 20.0}) {
        for (const double speed : {0.5, 3.0}) {
            const double angle = in_degrees(degrees), r = 0.05;
            auto world = make_world({});
            const auto shape =
                world->create_shape(strip({{-2, 0}, {0, 0}, {5 * std::cos(angle), 5 * std::sin(angle)}})).value();
            ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = shape, .material = friction(0)}));
            const auto ball = world
                                  ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                                 .position = {-0.3, r, 0},
                                                 .linear_velocity = {speed, 0, 0},
                                                 .material = friction(0)})
                                  .value();
            double highest = 0;
            for (int i = 0; i < 180; ++i) {
                world->step();
                highest = std::max(highest, world->pose(ball).position.y - r);
            }
            const double share = degrees > 16 ? std::cos(angle) * std::cos(angle) : 1;
            const double height = share * speed * speed / (2 * gravity);
            EXPECT_NEAR(highest, height, 0.02 * height + 1e-4) << degrees << " at " << speed;
        }
    }
}

// From the top of a fixed ball of radius R without friction it leaves where the centre has fallen by (R + r) / 3,
// rolling by 7/17 of it (E. Routh).
TEST(Bowls, BallLeavesAFixedBallWhereItMust) {
    for (const std::string kind : {"sphere", "mesh", "coarse mesh"}) {
        for (const double mu : {0.0, 2.0}) {
            const double R = 1, r = 0.1;
            auto world = make_world({});
            ShapeDefinition ground = SphereShape{R};
            if (kind != "sphere") {
                std::vector<std::array<double, 2>> profile;
                const int count = kind == "mesh" ? 200 : 36;
                for (int i = 0; i <= count; ++i) {
                    const double a = -pi / 2 + pi * i / count;
                    profile.push_back({R * std::sin(a), R * std::cos(a)});
                }
                ground = strip(profile);
            }
            ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                            .shape = world->create_shape(ground).value(),
                                            .material = friction(mu)}));
            const double speed = 0.2;
            const auto ball = world
                                  ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                                 .position = {0, R + r, 0},
                                                 .linear_velocity = {speed, 0, 0},
                                                 .angular_velocity = {0, 0, mu > 0 ? -speed / r : 0},
                                                 .material = friction(mu)})
                                  .value();
            const double clear = kind == "coarse mesh" ? 2e-4 : 2e-5;
            double left = 0;
            for (int i = 0; i < 240 && left == 0; ++i) {
                world->step();
                const Vec3 at = world->pose(ball).position;
                if (std::hypot(at.x, at.y) > R + r + clear) left = at.y / (R + r);
            }
            // m v² / (R + r) = m g cos, with v² = v0² + 2 g (R + r) (1 − cos) / (1 + k).
            const double k = mu > 0 ? 0.4 : 0, share = 2 / (1 + k);
            const double cosine = (share + speed * speed / (gravity * (R + r))) / (1 + share);
            // A facet of the coarse one is 5 degrees.
            EXPECT_NEAR(left, cosine, kind == "coarse mesh" ? 0.07 : 0.04) << kind << " mu " << mu;
        }
    }
}

// Hills, hollows and saddles, y = A cos(kx) cos(kz): a ball that is too slow to leave the ground keeps its energy.
TEST(Bowls, BallKeepsItsEnergyOverHillsAndSaddles) {
    constexpr int cells = 200;
    constexpr double pitch = 0.1, height = 0.1, wave = 2, r = 0.1;
    HeightfieldShape field{cells + 1, cells + 1, pitch, pitch, {}};
    for (int row = 0; row <= cells; ++row) {
        for (int c = 0; c <= cells; ++c) {
            field.heights.push_back(
                static_cast<float>(height * std::cos(wave * (c - 100) * pitch) * std::cos(wave * (row - 100) * pitch)));
        }
    }
    for (const double mu : {0.0, 0.8}) {
        for (int seed = 1; seed <= 10; ++seed) {
            Random random(static_cast<std::uint64_t>(seed));
            auto world = make_world({});
            ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                            .shape = world->create_shape(field).value(),
                                            .position = {-10, 0, -10},
                                            .material = friction(mu)}));
            const double course = random.between(0, 2 * pi), speed = random.between(0.2, 1);
            const Vec3 velocity{speed * std::cos(course), 0, speed * std::sin(course)};
            const auto ball =
                world
                    ->create_body({.shape = world->create_shape(SphereShape{r}).value(),
                                   .position = {0, height + r, 0},
                                   .linear_velocity = velocity,
                                   .angular_velocity = mu > 0 ? cross(Vec3{0, 1, 0}, velocity) / r : Vec3{},
                                   .material = friction(mu),
                                   .allow_sleep = false})
                    .value();
            const double lowest = world->mass(ball) * gravity * (r - height), start = energy(*world) - lowest;
            double least = 1e300, most = 0;
            for (int i = 0; i < 1200; ++i) {
                world->step();
                const Vec3 at = world->pose(ball).position;
                if (std::max(std::fabs(at.x), std::fabs(at.z)) > 9.5) break;
                least = std::min(least, (energy(*world) - lowest) / start);
                most = std::max(most, (energy(*world) - lowest) / start);
            }
            EXPECT_GT(least, 1 - bar) << "seed " << seed << " mu " << mu;
            EXPECT_LT(most, 1 + bar / 10) << "seed " << seed << " mu " << mu;
        }
    }
}

// Marbles on one ring of the hollow, each with a place of its own; the ground has no bounce, they have among
// themselves.
Outcome swing_together(const Hollow& hollow, int count, double restitution, double mu, std::uint64_t seed,
                       double seconds) {
    Random random(seed);
    auto world = make_world({.air_density = 0});
    add_hollow(*world, hollow, mu, random);
    const double r = 0.05, centre = hollow.radius - r;
    const auto shape = world->create_shape(SphereShape{r}).value();
    const Material glass{.friction_static = mu,
                         .friction_dynamic = mu,
                         .restitution = restitution,
                         .friction_combine = CombineRule::geometric_mean,
                         .restitution_combine = CombineRule::multiply};
    double lowest = 0;
    for (int i = 0; i < count; ++i) {
        // In a pipe one beside the other across it, in a bowl around its middle.
        const bool is_bowl = hollow.kind.ends_with("bowl");
        const double angle = is_bowl ? random.between(0.3, 0.7) : -0.6 + 1.2 * (i + 0.5) / count;
        const double around = is_bowl ? 2 * pi * (i + random.between(-0.2, 0.2)) / count : random.between(-0.02, 0.02);
        Vec3 place{centre * std::sin(angle), hollow.radius - centre * std::cos(angle), around};
        if (is_bowl) {
            place = {centre * std::sin(angle) * std::cos(around), place.y, centre * std::sin(angle) * std::sin(around)};
        }
        const auto body =
            world->create_body({.shape = shape, .position = place, .material = glass, .allow_sleep = false}).value();
        lowest += world->mass(body) * gravity * r;
    }
    Outcome outcome;
    double start = 0;
    for (int i = 0; i < std::lround(seconds * 60); ++i) {
        const double now = energy(*world) - lowest;
        if (i == 6) start = now;
        if (start > 0) {
            outcome.last = now / start;
            outcome.least = std::min(outcome.least, outcome.last);
            outcome.most = std::max(outcome.most, outcome.last);
        }
        world->step();
    }
    return outcome;
}

TEST(Bowls, MarblesThatHitEachOtherGainNothingAndLoseNoneByThat) {
    struct Case {
        const char* kind;
        int count;
        double restitution;
    };
    for (const auto& [kind, count, restitution] : {Case{"bowl", 2, 1},
                                                   {"bowl", 10, 1},
                                                   {"field bowl", 3, 1},
                                                   {"field bowl", 5, 1},
                                                   {"pipe", 2, 1},
                                                   {"pipe", 10, 1},
                                                   {"box pipe", 3, 1},
                                                   {"bowl", 3, 0.9},
                                                   {"field bowl", 10, 0.9},
                                                   {"pipe", 5, 0.9}}) {
        const Hollow hollow{kind, 1, 60, std::string(kind).starts_with("field") ? 1.0 : 1.5};
        for (const double mu : {0.0, 0.5}) {
            const Outcome outcome = swing_together(hollow, count, restitution, mu, 1, 60);
            EXPECT_LT(outcome.most, 1 + 1e-6) << count << " in a " << kind << " mu " << mu;
            // A rolling ball slips after a collision: friction acts on it.
            if (restitution < 1 || mu > 0) continue;
            EXPECT_GT(outcome.least, 1 - bar) << count << " in a " << kind;
        }
    }
}

// Two on a slope, one of which rolls into the other.
TEST(Bowls, SlowCollisionsOfBallsThatRollDoNotBounce) {
    for (const double threshold : {0.0, 5.0}) {
        auto world = make_world({.air_density = 0});
        const Material material{.friction_static = 0,
                                .friction_dynamic = 0,
                                .restitution = 1,
                                .restitution_threshold = threshold,
                                .restitution_combine = CombineRule::multiply};
        Material ground = material;
        ground.restitution = 0;
        const Vec3 n{std::sin(0.3), std::cos(0.3), 0};
        const auto sphere = world->create_shape(SphereShape{0.05}).value();
        ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                        .shape = world->create_shape(PlaneShape{n, 0}).value(),
                                        .material = ground}));
        const auto ball = [&](double z, double speed) {
            return world
                ->create_body({.shape = sphere,
                               .position = n * 0.05 + Vec3{0, 0, z},
                               .linear_velocity = {0, 0, speed},
                               .material = material,
                               .allow_sleep = false})
                .value();
        };
        const auto first = ball(0, 0.5), second = ball(0.2, 0);
        for (int i = 0; i < 30; ++i) world->step();
        EXPECT_NEAR(world->linear_velocity(first).z, threshold > 0 ? 0.25 : 0, 1e-6);
        EXPECT_NEAR(world->linear_velocity(second).z, threshold > 0 ? 0.25 : 0.5, 1e-6);
    }
}

// What two balls do is the same whether two others, far away, are still there.
TEST(Bowls, RollingBallsAreNotAffectedByDistantBalls) {
    const auto speed_after = [](bool others_go) {
        auto world = make_world({.air_density = 0});
        const Material material{.friction_static = 0.1,
                                .friction_dynamic = 0.1,
                                .restitution = 0,
                                .restitution_combine = CombineRule::multiply};
        const auto sphere = world->create_shape(SphereShape{0.05}).value();
        const auto ball = [&](Vec3 place, Vec3 velocity) {
            return world
                ->create_body({.shape = sphere,
                               .position = place,
                               .linear_velocity = velocity,
                               .material = material,
                               .allow_sleep = false})
                .value();
        };
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                        .shape = world->create_shape(SphereShape{1}).value(),
                                        .position = {100, 0, 0},
                                        .material = material}));
        std::vector<BodyHandle> others;
        for (const double angle : {0.06, -0.0371}) {
            const Vec3 out{std::sin(angle), std::cos(angle), 0}, along{std::cos(angle), -std::sin(angle), 0};
            others.push_back(ball(Vec3{100, 0, 0} + out * 1.05, along * 1.5));
        }
        const Vec3 n{std::sin(0.7), std::cos(0.7), 0};
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                        .shape = world->create_shape(PlaneShape{n, 0}).value(),
                                        .material = material}));
        const auto first = ball(n * 0.05, {});
        ball(n * 0.05 + Vec3{0, 0, 0.102}, {});
        for (int i = 0; i < 12; ++i) {
            if (others_go && i == 2) {
                EXPECT_TRUE(world->destroy_bodies(others));
            }
            world->step();
        }
        return length(world->linear_velocity(first));
    };
    EXPECT_EQ(speed_after(true), speed_after(false));
}

TEST(RandomBowls, KeepTheEnergyOfWhatRollsOrSlidesFreely) {
    constexpr int usual = 12;
    const int cases = wanted_cases("EMBODY_BOWL_CASES", usual);
    ASSERT_GT(cases, 0);
    for (int seed = 1; seed <= cases; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const char* kinds[] = {"pipe", "bowl", "field pipe", "field bowl", "box pipe"};
        const double r = 0.005 * std::pow(400, random.unit()), ratio = 3 * std::pow(33, random.unit());
        Hollow hollow{kinds[random.below(5)], r * ratio, 8 + static_cast<int>(random.below(50)), 1.5, true};
        const bool is_field = hollow.kind.starts_with("field");
        if (is_field) hollow.reach = 1;
        const double degrees = random.between(5, is_field ? 50 : 80);
        Ball ball{r, in_degrees(degrees), 0};
        if (cases <= usual) ball.seconds = 20;
        if (random.below(2) > 0) ball.mu = std::min(random.between(0.4, 1) + 2.0 / 7 * std::tan(ball.angle), 2.0);
        if (ball.mu == 0 && random.below(2) > 0) ball.spin = random_vector(random, 1 / r);
        if (hollow.kind.ends_with("bowl")) ball.velocity = {0, 0, random.between(-0.5, 0.5) * std::sqrt(gravity * r)};
        const std::string what = "seed " + std::to_string(seed) + ": " + hollow.kind + ", r " + std::to_string(r) +
                                 ", R/r " + std::to_string(ratio) + ", facets " + std::to_string(hollow.facets) + ", " +
                                 std::to_string(degrees) + " deg, mu " + std::to_string(ball.mu);
        expect_kept(hollow, ball, what, static_cast<std::uint64_t>(seed));
    }
}

// What slips loses, and never gains.
TEST(RandomBowls, NothingThatSlipsGains) {
    constexpr int usual = 12;
    const int cases = wanted_cases("EMBODY_BOWL_CASES", usual);
    ASSERT_GT(cases, 0);
    for (int seed = 1; seed <= cases; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const char* kinds[] = {"pipe", "bowl", "field pipe", "field bowl", "box pipe"};
        const double r = 0.005 * std::pow(400, random.unit()), ratio = 3 * std::pow(33, random.unit());
        Hollow hollow{kinds[random.below(5)], r * ratio, 3 + static_cast<int>(random.below(50)), 1.5, true};
        if (hollow.kind.starts_with("field")) hollow.reach = 1;
        Ball ball{r, in_degrees(random.between(5, 50)), random.between(0.05, 0.5)};
        ball.spin = random_vector(random, 5 / r);
        // Over the middle of a facet: what begins in the ground is pushed out.
        ball.above = hollow.radius * (1 - std::cos(hollow.reach / hollow.facets));
        ball.seconds = cases <= usual ? 10 : 60;
        const Outcome outcome = swing(hollow, ball, static_cast<std::uint64_t>(seed));
        EXPECT_LT(outcome.most, 1 + bar / 10) << "seed " << seed << ": " << hollow.kind << ", r " << r << ", R/r "
                                              << ratio << ", facets " << hollow.facets << ", mu " << ball.mu;
    }
}

}  // namespace
}  // namespace embody::physics
