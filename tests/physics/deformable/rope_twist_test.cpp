// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/deformable_scene.h"

namespace embody::physics::deformable {
namespace {

constexpr double pi = 3.14159265358979323846;
using Scene = DeformableScene<RopeLine>;

// Clamps alone on a line, with a body at either end.
struct LooseClamps {
    std::vector<RopeSegment> segments;
    Nodes nodes;
    std::vector<bool> fixed;
    TouchSprings springs;
    std::vector<LooseBody> owners;
    std::vector<TouchedBody> bodies;
    Substep substep;
    RopeClamps clamps;

    explicit LooseClamps(const std::vector<Vec3>& line) {
        nodes.position = line;
        fixed.assign(line.size(), false);
        for (std::size_t i = 1; i < line.size(); ++i) segments.push_back({length(line[i] - line[i - 1])});
        const auto last = static_cast<std::uint32_t>(line.size() - 1);
        for (const std::uint32_t node : {0u, last}) {
            owners.emplace_back(SphereShape{0.01}, Transform{line[node], {}}, 0.5);
            owners.back().make_ball(1, 0.1);
            bodies.push_back(owners.back().body);
            springs.attachments.push_back({.node = node});
        }
        springs.attachment_bodies = {0, 1};
    }
    void begin(const Rope& rope) { clamps.begin({rope, segments, nodes, fixed, springs, bodies, substep}); }
};

TEST(RopeTwist, DerivativesOfTheAngleAreThoseOfItsEnergy) {
    const std::vector<Vec3> line{{0, 0, 0}, {0.1, 0.02, 0}, {0.18, 0.07, 0.05}, {0.24, 0.08, 0.13}, {0.3, 0.01, 0.2}};
    LooseClamps loose(line);
    const Rope rope{.bend_rigidity = 1e-12, .twist_rigidity = 0.4};
    loose.clamps.set({{0, normalized(Vec3{1, -0.2, 0.1})}, {4, normalized(Vec3{0.5, -0.8, 0.4})}});
    loose.begin(rope);
    std::vector<BodyMove> turns(2);
    // It was bent and turned since it began, within one substep.
    std::vector<Vec3> places = line, moves(line.size());
    places[2] += Vec3{0.01, 0.02, -0.03};
    turns[1].turn = {0.5, 0.1, 0.7};
    const auto energy = [&] { return loose.clamps.energy(places, turns); };
    const double stiffness = rope.twist_rigidity / [&] {
        double along = 0;
        for (const RopeSegment& segment : loose.segments) along += segment.length;
        return along;
    }();
    const double angle = std::sqrt(2 * energy() / stiffness), step = 1e-5;
    ASSERT_GT(angle, 0.1);
    RopeSystem system;
    const auto assemble = [&](bool with_curvature) {
        system.reset(line.size());
        std::ranges::fill(system.rhs, Vec3{});
        loose.clamps.add(places, moves, turns, with_curvature, system);
    };
    assemble(false);
    const TwistMode mode = system.twists[0];
    const double sign = mode.offset + dot(mode.by_turn[1], turns[1].turn) > 0 ? 1 : -1;
    const auto slope = [&](double& value) {
        const double before = value;
        value = before + step;
        const double more = energy();
        value = before - step;
        const double less = energy();
        value = before;
        return (more - less) / (2 * step) / (stiffness * angle * sign);
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(slope(places[i][c]), mode.by_node[i][c], 1e-5) << i << ' ' << c;
    }
    // A turn on top of none is one about the axis itself.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(slope(turns[0].turn[c]), mode.by_turn[0][c], 1e-5) << c;

    // Second derivatives: what a move adds to the right side, against how the first ones change.
    loose.clamps.predict(std::vector<double>{1.0});
    for (std::size_t i = 0; i < line.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            moves.assign(line.size(), {});
            assemble(true);
            const std::vector<Vec3> none = system.rhs;
            moves[i][c] = 1;
            assemble(true);
            const std::vector<Vec3> given = system.rhs;
            assemble(false);
            const std::vector<Vec3> bends = system.rhs;
            moves[i][c] = 0;
            places[i][c] += step;
            assemble(false);
            const std::vector<Vec3> more = system.twists[0].by_node;
            places[i][c] -= 2 * step;
            assemble(false);
            const std::vector<Vec3> less = system.twists[0].by_node;
            places[i][c] += step;
            for (std::size_t k = 0; k < line.size(); ++k) {
                const Vec3 right = (more[k] - less[k]) / (2 * step), found = given[k] - bends[k];
                EXPECT_LT(length(found - right), 1e-4 * (1 + length(right))) << i << ' ' << c << ' ' << k;
            }
        }
    }
}

// A straight rope along X between a clamp of the world and one of a body at its other end.
DeformableDefinition clamped_rope(double end, int parts, const Rope& rope) {
    DeformableDefinition definition = rope_between({}, {end, 0, 0}, end / parts * 1.000001, rope);
    definition.pinned = {0};
    definition.attachments = {{.node = static_cast<std::uint32_t>(parts)}};
    definition.clamps = {{0, {1, 0, 0}}, {static_cast<std::uint32_t>(parts), {1, 0, 0}}};
    return definition;
}

TEST(RopeTwist, TorqueIsTheTwistOverTheLength) {
    // GJ θ / L over forty turns there and back again.
    const double rigidity = 1e-3, end = 1;
    auto definition = clamped_rope(
        end, 20, {.axial_stiffness = 1e4, .bend_rigidity = 1e-3, .twist_rigidity = rigidity, .rayleigh_damping = 0});
    Scene scene(definition);
    for (Vec3& node : scene.deformable.nodes().position) node.x *= 1.01;
    LooseBody hand(SphereShape{0.01}, {{1.01, 0, 0}, {}}, 0.5);
    scene.bodies.push_back(hand.body);
    scene.attachments = {0};
    scene.substep.gravity = {};
    for (const double spin : {10.0, -20.0}) {
        scene.bodies[0].path_turn = scene.bodies[0].path_spin = {spin, 0, 0};
        const double each = 2 * std::atan(spin / 120);  // of a substep
        const double before = scene.deformable.twists().empty() ? 0 : scene.deformable.twists()[0].angle;
        for (int i = 1; i <= 1500; ++i) scene.step();
        const double right = before + 1500 * each;
        ASSERT_EQ(scene.deformable.twists().size(), 1u);
        EXPECT_NEAR(scene.deformable.twists()[0].angle, right, 1e-6 * std::fabs(right));
        EXPECT_NEAR(scene.bodies[0].angular_impulse.x * 60, -rigidity * right / end, 1e-6 * rigidity * 250);
        EXPECT_NEAR(length(scene.bodies[0].angular_impulse) * 60, rigidity * std::fabs(right) / end, 1e-6);
    }
}

TEST(RopeTwist, DiscOnAWireSwingsAsATorsionPendulum) {
    // T = 2π √(I L / GJ), whatever the wire weighs beside the disc's weight that tightens it.
    for (const double rigidity : {1e-3, 1.0}) {
        const double seconds = 2, end = 1.5, inertia = rigidity * seconds * seconds / (4 * pi * pi * end);
        auto definition = clamped_rope(end, 15, {.axial_stiffness = 1e6, .twist_rigidity = rigidity});
        definition.pose.rotation = from_two_vectors({1, 0, 0}, {0, -1, 0});
        definition.clamps[0].direction = definition.clamps[1].direction = {0, -1, 0};
        Scene scene(definition);
        LooseBody disc(SphereShape{0.01}, {{0, -end, 0}, {}}, 0.5);
        disc.body.inverse_mass = 0.5;
        disc.body.inverse_inertia = Mat3::diagonal({1 / inertia, 1 / inertia, 1 / inertia});
        disc.body.path_turn = disc.body.path_spin = {0, 1, 0};
        scene.bodies.push_back(disc.body);
        scene.attachments = {0};
        double crossed = 0, before = 0, period = 0;
        for (int i = 1; i < 300; ++i) {
            scene.step();
            const double angle = scene.deformable.twists()[0].angle, time = i * scene.substep.h;
            if (before > 0 && angle <= 0) {
                const double at = time - scene.substep.h * angle / (angle - before);
                if (crossed > 0) period = at - crossed;
                crossed = at;
            }
            before = angle;
        }
        RecordProperty("period_over_right_" + std::to_string(rigidity), std::to_string(period / seconds));
        EXPECT_NEAR(period, seconds, 0.02 * seconds);
    }
}

// A long rod under tension T, twisted with that share of Greenhill's moment, M² = 4 EI T, and then bent a little: how
// wide it is some seconds later, over how wide it was.
double growth_at(double fraction) {
    const double rigidity = 1e-3, twist_rigidity = rigidity / 1.3, tension = 1, strain = 1e-3;
    const int parts = 100;
    auto definition = clamped_rope(1, parts,
                                   {.linear_density = 0.01,
                                    .axial_stiffness = tension / strain,
                                    .bend_rigidity = rigidity,
                                    .twist_rigidity = twist_rigidity,
                                    .rayleigh_damping = 1e-3});
    Scene scene(definition);
    scene.substep.gravity = {};
    for (Vec3& node : scene.deformable.nodes().position) node.x *= 1 + strain;
    LooseBody hand(SphereShape{1e-3}, {{1 + strain, 0, 0}, {}}, 0.5);
    scene.bodies.push_back(hand.body);
    scene.attachments = {0};
    const double turn = fraction * 2 * std::sqrt(rigidity * tension) / twist_rigidity;
    scene.bodies[0].path_turn = scene.bodies[0].path_spin = {120 * std::tan(turn / 240 / 2), 0, 0};
    scene.run(4);
    scene.bodies[0].path_turn = scene.bodies[0].path_spin = {};
    const auto widest = [&] {
        double most = 0;
        for (const Vec3 p : scene.deformable.nodes().position) most = std::max(most, std::hypot(p.y, p.z));
        return most;
    };
    EXPECT_LT(widest(), 1e-9);
    for (Vec3& node : scene.deformable.nodes().position) {
        const double sine = std::sin(pi * node.x / (1 + strain)), wave = 1e-5 * sine * sine;
        node.y = wave * std::cos(32 * node.x);
        node.z = wave * std::sin(32 * node.x);
    }
    const double first = widest();
    scene.run(10);
    return widest() / first;
}

TEST(RopeTwist, TwistedRodUnderTensionBucklesAtGreenhillsMoment) {
    // Clamped ends hold a little more: between 4 EI (T + π² EI/L²) and 4 EI (T + 4 π² EI/L²), 0.5 and 2 % of M here.
    for (const double fraction : {0.5, 0.9, 0.99}) EXPECT_LT(growth_at(fraction), 0.01) << fraction;
    for (const double fraction : {1.03, 1.1, 1.3}) EXPECT_GT(growth_at(fraction), 10) << fraction;
}

// A free rope between two clamped balls.
struct Dumbbell {
    Scene scene;
    std::vector<LooseBody> balls;

    static DeformableDefinition rope() {
        auto definition = clamped_rope(
            0.6, 12, {.linear_density = 0.05, .axial_stiffness = 1e3, .bend_rigidity = 0.01, .twist_rigidity = 0.02});
        definition.pinned = {};
        definition.attachments = {{.node = 0}, {.node = 12}};
        return definition;
    }
    explicit Dumbbell(std::array<Vec3, 2> spins) : scene(rope()) {
        scene.substep.gravity = {};
        for (const double x : {0.0, 0.6}) {
            balls.emplace_back(SphereShape{0.01}, Transform{{x, 0, 0}, {}}, 0.5);
            balls.back().make_ball(0.2, 0.1);
            TouchedBody body = balls.back().body;
            body.path_turn = body.path_spin = spins[scene.bodies.size()];
            scene.bodies.push_back(body);
        }
        scene.attachments = {0, 1};
    }
    [[nodiscard]] Vec3 linear() const {
        Vec3 sum = scene.momentum();
        for (const TouchedBody& body : scene.bodies) sum += body.path_velocity / body.inverse_mass;
        return sum;
    }
    [[nodiscard]] Vec3 angular() const {
        Vec3 sum;
        const Nodes& nodes = scene.deformable.nodes();
        for (std::size_t i = 0; i < nodes.size(); ++i)
            sum += nodes.mass[i] * cross(nodes.position[i], nodes.mean_velocity[i]);
        for (const TouchedBody& body : scene.bodies) {
            sum += cross(body.start_center, body.path_velocity) / body.inverse_mass +
                   inverse_or_zero(body.inverse_inertia) * body.path_spin;
        }
        return sum;
    }
};

TEST(RopeTwist, BodiesTwistEachOtherAndKeepTheirMomentum) {
    // Their spins swing about the mean, which stays, to the other's and back.
    Dumbbell pair({Vec3{3, 0, 0}, Vec3{-1, 0, 0}});
    pair.scene.substep.h = 1.0 / 960;
    const Vec3 before = pair.angular();
    double least = 3, most = 3;
    for (int i = 0; i < 960; ++i) {
        pair.scene.step();
        least = std::min(least, pair.scene.bodies[0].path_spin.x);
        most = std::max(most, pair.scene.bodies[0].path_spin.x);
    }
    EXPECT_LT(length(pair.angular() - before), 1e-9 * length(before));
    EXPECT_NEAR((least + most) / 2, 1, 0.02);
    EXPECT_NEAR(least, -1, 0.04);
}

TEST(RopeTwist, RopeAndBodiesKeepTheirMomenta) {
    // Backward Euler's error of the turn of what is pulled is of first order in the substep.
    const auto error_of = [](double h) {
        Dumbbell pair({Vec3{6, 0, 1}, Vec3{-2, 3, 0}});
        pair.scene.substep.h = h;
        pair.scene.bodies[0].path_velocity = {0, 0.2, 0};
        const Vec3 linear = pair.linear(), angular = pair.angular();
        pair.scene.run(5);
        EXPECT_LT(length(pair.linear() - linear), 1e-6 * length(linear));
        return length(pair.angular() - angular) / length(angular);
    };
    const double coarse = error_of(1.0 / 60), fine = error_of(1.0 / 480);
    RecordProperty("angular_error_at_60_hertz", std::to_string(coarse));
    RecordProperty("angular_error_at_480_hertz", std::to_string(fine));
    EXPECT_LT(coarse, 0.04);
    EXPECT_LT(fine, 0.4 * coarse);
}

TEST(RopeTwist, LooseRopeThatIsTwistedFoldsUpAndComesToRest) {
    // No tension holds it, and it bends easily: it buckles at once, far past what its moments could be borne straight.
    for (const double rigidity : {1e-3, 1e-7}) {
        auto definition = clamped_rope(1, 40,
                                       {.linear_density = 0.05,
                                        .axial_stiffness = 1e4,
                                        .bend_rigidity = rigidity,
                                        .twist_rigidity = 1e-3,
                                        .rayleigh_damping = 0.02});
        Scene scene(definition);
        LooseBody hand(SphereShape{1e-3}, {{0.8, 0, 0}, {}}, 0.5);
        scene.bodies.push_back(hand.body);
        scene.attachments = {0};
        scene.bodies[0].path_turn = scene.bodies[0].path_spin = {12, 0, 0};
        double fastest = 0;
        for (int i = 0; i < 600; ++i) {
            scene.step();
            fastest = std::max(fastest, scene.fastest());
        }
        scene.bodies[0].path_turn = scene.bodies[0].path_spin = {};
        scene.run(10);
        EXPECT_FALSE(scene.deformable.is_frozen());
        EXPECT_LT(scene.fastest(), 0.05) << rigidity;
        RecordProperty("fastest_" + std::to_string(rigidity), std::to_string(fastest));
        RecordProperty("rounds_" + std::to_string(rigidity), std::to_string(scene.deformable.iterations()));
        EXPECT_LT(fastest, 20) << rigidity;
    }
}

TEST(RopeTwist, ClampedBodyHangsFromARodAsItsBeam) {
    // A weight on a clamped rod: both ends keep their direction, so the end's slope is zero only where the world holds
    // it: drop W L³/3EI of a light body that is free to turn but for the rod's moment.
    const double rigidity = 2, end = 1, mass = 0.05;
    auto definition = clamped_rope(
        end, 20, {.linear_density = 1e-3, .axial_stiffness = 1e5, .bend_rigidity = rigidity, .rayleigh_damping = 0.05});
    Scene scene(definition);
    LooseBody ball(SphereShape{0.01}, {{end, 0, 0}, {}}, 0.5);
    ball.make_ball(mass, 0.05);
    scene.bodies.push_back(ball.body);
    scene.attachments = {0};
    scene.run(6);
    const double right = (mass * std::pow(end, 3) / 3 + 1e-3 * std::pow(end, 4) / 8) * gravity / rigidity;
    EXPECT_NEAR(-scene.bodies[0].start_center.y, right, 0.02 * right);
    // Turned with the rod's end: slope W L²/2EI.
    const Vec3 along = rotate(scene.bodies[0].start.rotation, {1, 0, 0});
    EXPECT_NEAR(-along.y / along.x, mass * gravity * end * end / (2 * rigidity), 0.03 * right * 1.5);
}

}  // namespace
}  // namespace embody::physics::deformable
