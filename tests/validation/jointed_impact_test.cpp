// SPDX-License-Identifier: MIT
// Joints pass a blow on in the same instant. References: two hinged rods struck at the end (T. Kane, D. Levinson,
// "Dynamics: theory and applications", 1985, § 5: impulsive motion), by their generalised coordinates; random trees of
// joints, by a dense solve of M Δv − Jᵀ λ = f, J Δv = 0 written for this test; Newton's cradle on hinges.
#include <gtest/gtest.h>

#include <vector>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

const Quat about_z = from_two_vectors({1, 0, 0}, {0, 0, 1});  // of a hinge's frame, whose axis is X

Material bouncing_rod(double restitution, double mu = 0) {
    return {.friction_static = mu,
            .friction_dynamic = mu,
            .restitution = restitution,
            .friction_combine = CombineRule::geometric_mean,
            .restitution_combine = CombineRule::multiply};
}

// Two rods of 1 kg and 1 m hang straight, hinged to the world and to each other; a ball strikes the lower end from the
// side after `delay` of the step. With q₁, q₂ the angles, M = m l² (4/3, 1/2; 1/2, 1/3), and the end moves with
// l (q₁' + q₂'): an impulse P there gives q' = M⁻¹ (l P, l P).
struct Struck {
    double upper = 0, lower = 0, ball = 0;  // rad/s, rad/s, m/s
};

Struck strike_theory(double ball_mass, double speed, double restitution) {
    const double a = 4.0 / 3, b = 0.5, c = 1.0 / 3, determinant = a * c - b * b;
    const double upper = (c - b) / determinant, lower = (a - b) / determinant;
    const double impulse = (1 + restitution) * speed / (1 / ball_mass + upper + lower);
    return {upper * impulse, lower * impulse, speed - impulse / ball_mass};
}

Struck strike(double ball_mass, double speed, double restitution, double delay) {
    auto world = make_world({.gravity = {}});
    const double half = 0.02, radius = 0.05;
    const auto rod = world->create_shape(BoxShape{{half, 0.5, half}}).value();
    const auto ball = world->create_shape(SphereShape{radius}).value();

    // A rod of no thickness: its moment of inertia about the ends is m l²/3.
    const double inertia = 1.0 / 12;
    const auto add_rod = [&](double height) {
        return world
            ->create_body({.shape = rod,
                           .position = {0, height, 0},
                           .mass = {.mass = 1, .inertia = Mat3::diagonal({inertia, 1e-3, inertia})},
                           .material = bouncing_rod(1),
                           .allow_sleep = false})
            .value();
    };
    const auto upper = add_rod(-0.5), lower = add_rod(-1.5);
    const Transform top{{0, 0.5, 0}, about_z}, bottom{{0, -0.5, 0}, about_z};
    EXPECT_TRUE(
        world->create_joint({.joint = HingeJoint{}, .body_b = upper, .frame_a = {{}, about_z}, .frame_b = top}));
    EXPECT_TRUE(world->create_joint(
        {.joint = HingeJoint{}, .body_a = upper, .body_b = lower, .frame_a = bottom, .frame_b = top}));
    const double gap = delay * speed;
    const auto striker = world
                             ->create_body({.shape = ball,
                                            .position = {-half - radius - gap, -2, 0},
                                            .linear_velocity = {speed, 0, 0},
                                            .mass = {.mass = ball_mass},
                                            .material = bouncing_rod(restitution),
                                            .allow_sleep = false})
                             .value();
    world->step();
    return {world->angular_velocity(upper).z, world->angular_velocity(lower).z, world->linear_velocity(striker).x};
}

TEST(JointedImpact, TwoHingedRodsAreStruckAsKaneSays) {
    for (const double mass : {0.05, 1.0, 20.0}) {
        for (const double restitution : {0.0, 0.5, 1.0}) {
            for (int phase = 0; phase < 16; ++phase) {
                const double speed = 0.5;
                const Struck expected = strike_theory(mass, speed, restitution);
                const Struck found = strike(mass, speed, restitution, phase / 16.0 / 60);
                const double tolerance = 2e-3 * (std::fabs(expected.upper) + expected.lower);
                EXPECT_NEAR(found.upper, expected.upper, tolerance) << mass << " e " << restitution << " at " << phase;
                EXPECT_NEAR(found.lower, expected.lower, tolerance) << mass << " e " << restitution << " at " << phase;
                EXPECT_NEAR(found.ball, expected.ball, 2e-3 * speed) << mass << " e " << restitution << " at " << phase;
            }
        }
    }
}

// A tree of 2 to 8 bodies without shapes, but for a ball that is fixed off the centre of mass of one of them.
struct Tree {
    struct Link {
        std::size_t a = 0, b = 0;  // bodies
        Transform frame;           // world
        int kind = 0;              // fixed, ball, hinge, slider
        bool holds_world = false;  // instead of a
    };
    std::vector<BodyDefinition> bodies;
    std::vector<Link> links;
    std::size_t struck = 0;
    Vec3 ball;  // its centre, world
};

Tree random_tree(Random& random) {
    Tree tree;
    const int count = 2 + static_cast<int>(random.below(7));
    for (int i = 0; i < count; ++i) {
        // Moments of a box that is not thinner than a tenth of its length.
        const double mass = std::pow(10, random.between(-1, 1));
        const Vec3 box{random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1)};
        const Vec3 square{box.x * box.x, box.y * box.y, box.z * box.z};
        const Vec3 inertia = Vec3{square.y + square.z, square.z + square.x, square.x + square.y} * (mass / 12);
        tree.bodies.push_back({.position = random_vector(random, 1),
                               .rotation = random_rotation(random),
                               .mass = {.mass = mass, .center_of_mass = Vec3{}, .inertia = Mat3::diagonal(inertia)},
                               .allow_sleep = false});
        const auto b = static_cast<std::size_t>(i);
        if (i == 0 && random.below(2) == 0) continue;
        const Transform frame{tree.bodies[b].position + random_vector(random, 0.5), random_rotation(random)};
        const std::size_t a = i == 0 ? 0 : random.below(static_cast<std::uint32_t>(i));
        tree.links.push_back({a, b, frame, static_cast<int>(random.below(4)), i == 0});
    }
    tree.struck = random.below(static_cast<std::uint32_t>(count));
    tree.ball = tree.bodies[tree.struck].position + random_vector(random, 0.5);
    return tree;
}

std::variant<FixedJoint, BallJoint, HingeJoint, SliderJoint> joint_of_kind(int kind) {
    if (kind == 0) return FixedJoint{};
    if (kind == 1) return BallJoint{};
    if (kind == 2) return HingeJoint{};
    return SliderJoint{};
}

// Changes of (v, ω) of all bodies by the impulse at the point, by elimination of the whole system: rows of M, then the
// rows of the joints.
std::vector<double> dense_response(const Tree& tree, Vec3 point, Vec3 impulse) {
    std::vector<std::vector<double>> rows;
    const std::size_t bodies = 6 * tree.bodies.size();
    const auto add_row = [&](const Tree::Link& link, Vec3 linear, Vec3 about_a, Vec3 about_b) {
        std::vector<double> row(bodies, 0.0);
        for (int i = 0; i < 3; ++i) {
            const auto at = static_cast<std::size_t>(i);
            row[6 * link.b + at] += linear[i];
            row[6 * link.b + 3 + at] += about_b[i];
            if (link.holds_world) continue;
            row[6 * link.a + at] -= linear[i];
            row[6 * link.a + 3 + at] -= about_a[i];
        }
        rows.push_back(row);
    };
    for (const Tree::Link& link : tree.links) {
        const Vec3 place = link.frame.position;
        const Vec3 arm_a = place - tree.bodies[link.a].position, arm_b = place - tree.bodies[link.b].position;
        const Mat3 axes = to_matrix(link.frame.rotation);
        for (int i = 0; i < 3; ++i) {
            const Vec3 axis = axes.column(i);
            if (link.kind != 3 || i > 0) add_row(link, axis, cross(arm_a, axis), cross(arm_b, axis));
            if (link.kind == 0 || link.kind == 3 || (link.kind == 2 && i > 0)) add_row(link, {}, axis, axis);
        }
    }
    const std::size_t size = bodies + rows.size();
    std::vector<std::vector<double>> m(size, std::vector<double>(size + 1, 0.0));
    for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
        const BodyDefinition& body = tree.bodies[k];
        const Mat3 inertia = rotate_tensor(body.rotation, *body.mass.inertia);
        for (int i = 0; i < 3; ++i) {
            const auto at = 6 * k + static_cast<std::size_t>(i);
            m[at][at] = *body.mass.mass;
            for (int j = 0; j < 3; ++j) m[at + 3][6 * k + 3 + static_cast<std::size_t>(j)] = inertia(i, j);
        }
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (std::size_t i = 0; i < bodies; ++i) m[bodies + k][i] = m[i][bodies + k] = rows[k][i];
    }
    const Vec3 moment = cross(point - tree.bodies[tree.struck].position, impulse);
    for (int i = 0; i < 3; ++i) {
        m[6 * tree.struck + static_cast<std::size_t>(i)][size] = impulse[i];
        m[6 * tree.struck + 3 + static_cast<std::size_t>(i)][size] = moment[i];
    }

    // Gauss and Jordan with the largest pivot of each column.
    for (std::size_t p = 0; p < size; ++p) {
        std::size_t best = p;
        for (std::size_t r = p + 1; r < size; ++r) {
            if (std::fabs(m[r][p]) > std::fabs(m[best][p])) best = r;
        }
        std::swap(m[p], m[best]);
        for (std::size_t r = 0; r < size; ++r) {
            if (r == p || m[r][p] == 0) continue;
            const double factor = m[r][p] / m[p][p];
            for (std::size_t c = p; c <= size; ++c) m[r][c] -= factor * m[p][c];
        }
    }
    std::vector<double> solution(bodies);
    for (std::size_t i = 0; i < bodies; ++i) solution[i] = m[i][size] / m[i][i];
    return solution;
}

TEST(JointedImpact, RandomTreesAnswerAsTheWholeSystemOfEquationsSays) {
    Random random(19);
    for (int trial = 0; trial < 200; ++trial) {
        const Tree tree = random_tree(random);
        auto world = make_world({.gravity = {}, .time_step = 1e-4});
        const double radius = 0.05, speed = 1, striker_mass = std::pow(10, random.between(-1, 1));
        const double restitution = random.unit();
        const auto ball = world->create_shape(SphereShape{radius}).value();
        std::vector<BodyHandle> handles;
        for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
            BodyDefinition definition = tree.bodies[i];
            if (i == tree.struck) {
                CompoundShape shell;
                const Transform pose{definition.position, definition.rotation};
                shell.children.push_back({SphereShape{radius}, {inverse_transform_point(pose, tree.ball), {}}});
                definition.shape = world->create_shape(shell).value();
                definition.material = bouncing_rod(1);
            }
            handles.push_back(world->create_body(definition).value());
        }
        for (const Tree::Link& link : tree.links) {
            const auto frame_in = [&](std::size_t body) {
                return inverse(Transform{tree.bodies[body].position, tree.bodies[body].rotation}) * link.frame;
            };
            ASSERT_TRUE(world->create_joint({.joint = joint_of_kind(link.kind),
                                             .body_a = link.holds_world ? BodyHandle{} : handles[link.a],
                                             .body_b = handles[link.b],
                                             .frame_a = link.holds_world ? link.frame : frame_in(link.a),
                                             .frame_b = frame_in(link.b)}));
        }
        const Vec3 direction = random_direction(random);
        const auto striker = world
                                 ->create_body({.shape = ball,
                                                .position = tree.ball - direction * (2 * radius + 0.3e-4 * speed),
                                                .linear_velocity = direction * speed,
                                                .mass = {.mass = striker_mass},
                                                .material = bouncing_rod(restitution),
                                                .allow_sleep = false})
                                 .value();
        world->step();

        const Vec3 point = tree.ball - direction * radius;
        const std::vector<double> unit = dense_response(tree, point, direction);
        const auto velocity_of = [&](const std::vector<double>& v, std::size_t body) {
            return Vec3{v[6 * body], v[6 * body + 1], v[6 * body + 2]};
        };
        const auto spin_of = [&](const std::vector<double>& v, std::size_t body) {
            return Vec3{v[6 * body + 3], v[6 * body + 4], v[6 * body + 5]};
        };
        const Vec3 arm = point - tree.bodies[tree.struck].position;
        const double yielding = dot(direction, velocity_of(unit, tree.struck) + cross(spin_of(unit, tree.struck), arm));
        const double impulse = (1 + restitution) * speed / (1 / striker_mass + yielding);
        EXPECT_NEAR(dot(world->linear_velocity(striker), direction), speed - impulse / striker_mass, 1e-3 * speed)
            << trial;
        for (std::size_t i = 0; i < handles.size(); ++i) {
            const double scale = 2e-3 * (speed + length(spin_of(unit, i)) * impulse);
            EXPECT_LT(length(world->linear_velocity(handles[i]) - velocity_of(unit, i) * impulse), scale)
                << trial << " body " << i;
            EXPECT_LT(length(world->angular_velocity(handles[i]) - spin_of(unit, i) * impulse), scale)
                << trial << " body " << i;
        }
    }
}

// A bead slides along a rod that turns by `rate` and bears it in its middle: a ball that strikes the bead across X
// after `delay` of the step meets a rod that has turned. Along the rod the bead yields with its mass of 1 kg, across it
// not at all.
double speed_after_strike_on_turntable(double rate, double delay, double restitution, double angle) {
    auto world = make_world({.gravity = {}});
    const double radius = 0.05, speed = 0.5, step = world->settings().time_step;
    const auto sphere = world->create_shape(SphereShape{radius}).value();
    const auto turntable =
        world->create_body({.kind = BodyKind::kinematic_body, .angular_velocity = {0, rate, 0}}).value();
    const auto bead = world
                          ->create_body({.shape = sphere,
                                         .angular_velocity = {0, rate, 0},
                                         .mass = {.mass = 1},
                                         .material = bouncing_rod(1),
                                         .allow_sleep = false})
                          .value();
    const Quat along_rod = from_axis_angle({0, 1, 0}, angle);
    EXPECT_TRUE(world->create_joint({.joint = SliderJoint{},
                                     .body_a = turntable,
                                     .body_b = bead,
                                     .frame_a = {{}, along_rod},
                                     .frame_b = {{}, along_rod}}));
    const auto striker = world
                             ->create_body({.shape = sphere,
                                            .position = {-2 * radius - delay * step * speed, 0, 0},
                                            .linear_velocity = {speed, 0, 0},
                                            .mass = {.mass = 1},
                                            .material = bouncing_rod(restitution),
                                            .allow_sleep = false})
                             .value();
    world->step();
    return world->linear_velocity(striker).x / speed;
}

TEST(JointedImpact, MovingCarrierIsWhereItIsWhenTheBlowComes) {
    const double rate = 20;
    for (const double restitution : {0.3, 0.6, 1.0}) {
        for (const double angle : {0.0, 0.7, pi / 2}) {
            for (int phase = 0; phase < 8; ++phase) {
                const double delay = (phase + 0.5) / 8, turned = angle + rate * delay / 60;
                const double yielding = std::cos(turned) * std::cos(turned);
                EXPECT_NEAR(speed_after_strike_on_turntable(rate, delay, restitution, angle),
                            1 - (1 + restitution) / (1 + yielding), 5e-3)
                    << "e " << restitution << " from " << angle << " at " << delay;
            }
        }
    }
}

// Two swinging double pendulums, far apart; the second is struck in the tenth step, the first one before or never.
std::vector<Vec3> state_after_own_strike(bool other_is_struck) {
    auto world = make_world({});
    const double radius = 0.05;
    const auto sphere = world->create_shape(SphereShape{radius}).value();
    std::vector<BodyHandle> bodies;
    const auto add_ball = [&](Vec3 position, Vec3 velocity) {
        return world
            ->create_body({.shape = sphere,
                           .position = position,
                           .linear_velocity = velocity,
                           .mass = {.mass = 1},
                           .material = bouncing_rod(1),
                           .allow_sleep = false})
            .value();
    };
    for (const double x : {0.0, 100.0}) {
        const auto upper = add_ball({x, 0, 0}, {0, 0, 0.2}), lower = add_ball({x, -0.5, 0}, {0, 0, -0.1});
        const Transform hook{{0, 0.5, 0}, {}};
        EXPECT_TRUE(world->create_joint(
            {.joint = BallJoint{}, .body_b = upper, .frame_a = {{x, 0.5, 0}, {}}, .frame_b = hook}));
        EXPECT_TRUE(world->create_joint({.joint = BallJoint{}, .body_a = upper, .body_b = lower, .frame_b = hook}));
        bodies = {upper, lower};
    }
    add_ball({-0.15, -0.5, 0}, {other_is_struck ? 4.0 : -4.0, 0, 0});
    add_ball({100 - 0.1 - 9.5 / 60, -0.5 + gravity / 2 / 36, 0}, {1, 0, 0});
    std::vector<Vec3> states;
    for (int i = 0; i < 12; ++i) {
        world->step();
        for (const BodyHandle body : bodies) {
            states.push_back(world->pose(body).position);
            states.push_back(world->linear_velocity(body));
            states.push_back(world->angular_velocity(body));
        }
    }
    EXPECT_GT(std::fabs(world->linear_velocity(bodies[1]).x), 0.1);
    return states;
}

TEST(JointedImpact, BlowIsTheSameWhateverWasStruckBefore) {
    EXPECT_EQ(state_after_own_strike(true), state_after_own_strike(false));
}

// A body on a joint turned about it in the last step, fast or not at all. A pendulum that takes its slot then swings
// past a wall.
std::vector<Vec3> state_in_slot_of_turning_body(double old_rate) {
    auto world = make_world({});
    const double radius = 0.05, arm = 0.5;
    const auto sphere = world->create_shape(SphereShape{radius}).value();
    const auto wall = world->create_shape(PlaneShape{{1, 0, 0}, -radius - 2e-3}).value();
    EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = wall, .material = bouncing_rod(1)}));
    const auto add_pendulum = [&](Vec3 place, Vec3 velocity, Vec3 spin) {
        const auto body = world
                              ->create_body({.shape = sphere,
                                             .position = place,
                                             .linear_velocity = velocity,
                                             .angular_velocity = spin,
                                             .mass = {.mass = 1},
                                             .material = bouncing_rod(1),
                                             .allow_sleep = false})
                              .value();
        const Vec3 hook = Vec3{0, arm, 0};
        const auto joint = world->create_joint(
            {.joint = BallJoint{}, .body_b = body, .frame_a = {place + hook, {}}, .frame_b = {hook, {}}});
        EXPECT_TRUE(joint);
        return std::pair{body, joint.value()};
    };
    const auto [old, old_joint] = add_pendulum({50, 0, 0}, {0, 0, -arm * old_rate}, {old_rate, 0, 0});
    world->step();
    EXPECT_TRUE(world->destroy_joint(old_joint));
    EXPECT_TRUE(world->destroy_body(old));
    const auto body = add_pendulum({}, {0.05, 0, 1}, {-2, 0, 0.1}).first;
    EXPECT_EQ(body.index, old.index);
    std::vector<Vec3> states;
    for (int i = 0; i < 3; ++i) {
        world->step();
        states.push_back(world->pose(body).position);
        states.push_back(world->linear_velocity(body));
        states.push_back(world->angular_velocity(body));
    }
    return states;
}

TEST(JointedImpact, BodyInheritsNothingOfItsSlot) {
    EXPECT_EQ(state_in_slot_of_turning_body(60), state_in_slot_of_turning_body(0));
}

// Five balls on hinges, the first one lifted.
double cradle_energy_after(double seconds, double angle, double length, double radius) {
    auto world = make_world({});
    const auto shape = world->create_shape(SphereShape{radius}).value();
    const int balls = 5;
    for (int i = 0; i < balls; ++i) {
        const double x = 2 * radius * i, lift = i == 0 ? -angle : 0;
        const auto ball = world
                              ->create_body({.shape = shape,
                                             .position = {x + length * std::sin(lift), -length * std::cos(lift), 0},
                                             .rotation = from_axis_angle({0, 0, 1}, lift),
                                             .mass = {.mass = 1},
                                             .material = bouncing_rod(1),
                                             .allow_sleep = false})
                              .value();
        EXPECT_TRUE(world->create_joint({.joint = HingeJoint{},
                                         .body_b = ball,
                                         .frame_a = {{x, 0, 0}, about_z},
                                         .frame_b = {{0, length, 0}, about_z}}));
    }
    const double rest = -balls * gravity * length, start = energy(*world) - rest;
    double most = 0;
    const int steps = static_cast<int>(std::lround(seconds * 60));
    for (int i = 0; i < steps; ++i) {
        world->step();
        most = std::max(most, energy(*world) - rest);
    }
    EXPECT_LT(most, start * (1 + 1e-6)) << angle;
    return (energy(*world) - rest) / start;
}

TEST(JointedImpact, NewtonsCradleOnHingesKeepsItsEnergy) {
    for (const double angle : {10.0, 20.0, 40.0}) {
        EXPECT_GT(cradle_energy_after(8, angle * pi / 180, 0.5, 0.05), 0.98) << angle;
        EXPECT_GT(cradle_energy_after(8, angle * pi / 180, 0.15, 0.01), 0.98) << angle;
    }
}

// A plate that 600 ball joints hold on to the world: more than are solved at once.
TEST(JointedImpact, MoreJointsThanADirectSolveTakesHoldAsWell) {
    auto world = make_world({});
    Random random(1);
    const auto plate = world
                           ->create_body({.shape = world->create_shape(BoxShape{{1, 0.1, 1}}).value(),
                                          .material = bouncing_rod(0.5),
                                          .allow_sleep = false})
                           .value();
    for (int i = 0; i < 600; ++i) {
        const Transform frame{random_vector(random, 1), {}};
        ASSERT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = plate, .frame_a = frame, .frame_b = frame}));
    }
    const auto ball = world
                          ->create_body({.shape = world->create_shape(SphereShape{0.1}).value(),
                                         .position = {0.3, 0.5, 0.2},
                                         .linear_velocity = {0, -3, 0},
                                         .material = bouncing_rod(0.5)})
                          .value();
    run(*world, 0.2);
    EXPECT_LT(length(world->pose(plate).position), 1e-6);
    EXPECT_GT(world->pose(ball).position.y, 0.199);
}

// A bridge of 60 planks under balls that all come down on it in one step.
TEST(JointedImpact, ManyBlowsOnOneAssemblyReachALimitAndGainNothing) {
    for (const int rows : {1, 8}) {
        auto world = make_world({});
        const int planks = 60;
        const double length = 0.5, half = 0.2, radius = 0.04, speed = 6;
        const auto plank = world->create_shape(BoxShape{{half, 0.02, 0.5}}).value();
        const auto sphere = world->create_shape(SphereShape{radius}).value();
        BodyHandle before;
        for (int i = 0; i < planks; ++i) {
            const double x = i * length;
            const auto body =
                world
                    ->create_body(
                        {.shape = plank, .position = {x, 0, 0}, .material = bouncing_rod(0.9), .allow_sleep = false})
                    .value();
            const Vec3 end = i == 0 ? Vec3{-length / 2, 0, 0} : Vec3{length / 2, 0, 0};
            ASSERT_TRUE(world->create_joint({.joint = BallJoint{},
                                             .body_a = before,
                                             .body_b = body,
                                             .frame_a = {end, {}},
                                             .frame_b = {{-length / 2, 0, 0}, {}}}));
            before = body;
        }
        for (int i = 0; i < planks; ++i) {
            for (int k = 0; k < rows; ++k) {
                const double gap = speed / 60 * (0.1 + 0.8 * ((7 * i + 3 * k) % 50) / 50.0);
                ASSERT_TRUE(
                    world->create_body({.shape = sphere,
                                        .position = {i * length, 0.02 + radius + gap, 0.1 * k - 0.05 * (rows - 1)},
                                        .linear_velocity = {0, -speed, 0},
                                        .material = bouncing_rod(0.9),
                                        .allow_sleep = false}));
            }
        }
        const double start = energy(*world);
        const StepReport& report = world->step();
        const bool is_exhausted =
            (report.limits & static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted)) != 0;
        EXPECT_EQ(is_exhausted, rows > 1) << report.impacts << " impacts";
        EXPECT_LT(energy(*world), start);
        for (int i = 0; i < 30; ++i) world->step();
        EXPECT_LT(energy(*world), start);
    }
}

}  // namespace
}  // namespace embody::physics
