// SPDX-License-Identifier: MIT
#include "benches/simbenchmark/simbenchmark.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "foundation/random.h"
#include "physics/inter/world.h"

namespace embody::simbenchmark {

using physics::BodyHandle;
using physics::CombineRule;
using physics::Material;
using physics::World;

struct Scene {
    std::unique_ptr<World> world;
    std::vector<BodyHandle> bodies;  ///< movable bodies, in the order of their creation
    double start_energy = 0;         ///< kinetic and potential, J
};

namespace {

constexpr double gravity = 9.81;  // m/s²

Material make_material(double friction, double restitution) {
    return {.friction_static = friction,
            .friction_dynamic = friction,
            .restitution = restitution,
            .friction_combine = CombineRule::multiply};
}

Result<Scene> make_world(double time_step, const Material& ground) {
    auto world = World::create({.gravity = {0, -gravity, 0}, .time_step = time_step, .sleeping = false});
    if (!world) return world.error();
    Scene scene{.world = std::move(*world), .bodies = {}};
    const auto plane = scene.world->create_shape(physics::PlaneShape{});
    if (!plane) return plane.error();
    const auto body =
        scene.world->create_body({.kind = physics::BodyKind::static_body, .shape = *plane, .material = ground});
    if (!body) return body.error();
    return scene;
}

struct Balls {
    double radius, mass;  ///< m, kg
    Material material;
};

Result<void> add_balls(Scene& scene, const Balls& balls, std::span<const Vec3> places) {
    const auto shape = scene.world->create_shape(physics::SphereShape{balls.radius});
    if (!shape) return shape.error();
    for (const Vec3 place : places) {
        const auto body = scene.world->create_body(
            {.shape = *shape, .position = place, .mass = {.mass = balls.mass}, .material = balls.material});
        if (!body) return body.error();
        scene.bodies.push_back(*body);
    }
    return {};
}

// Rolling: 25 balls on a box that is pushed so hard that it slides; friction accelerates the balls, which roll.
constexpr double box_mass = 10, ball_mass = 1, push = 150;     // kg, kg, N
constexpr double friction_ground = 0.4, friction_balls = 0.8;  // between ground and box, between box and balls
constexpr int balls_a_side = 5;
constexpr Vec3 push_direction{0.5, 0, 0.866025403784439};

Result<Scene> make_rolling(double time_step) {
    // A pair's friction is the product of the two coefficients: 0.5 · 0.8 and 1 · 0.8.
    constexpr double initial_penetration = 2e-5;  // m
    auto scene = make_world(time_step, make_material(0.5, 0));
    if (!scene) return scene;
    const auto shape = scene->world->create_shape(physics::BoxShape{{10, 0.5, 10}});
    if (!shape) return shape.error();
    const auto box = scene->world->create_body({.shape = *shape,
                                                .position = {0, 0.5 - initial_penetration, 0},
                                                .mass = {.mass = box_mass},
                                                .material = make_material(0.8, 0),
                                                .force = push * push_direction});
    if (!box) return box.error();
    scene->bodies.push_back(*box);

    std::vector<Vec3> places;
    for (int i = 0; i < balls_a_side; ++i)
        for (int j = 0; j < balls_a_side; ++j)
            places.push_back({i * 2.0 - 4, 1.5 - 3 * initial_penetration, j * 2.0 - 4});
    if (auto added = add_balls(*scene, {0.5, ball_mass, make_material(1, 0)}, places); !added) return added.error();
    return scene;
}

/// Squared difference of the velocities from the analytic solution, of the box and of the first ball.
double rolling_error(const Scene& scene, double time) {
    constexpr int balls = balls_a_side * balls_a_side;
    constexpr double ground = friction_ground * (box_mass + balls * ball_mass) * gravity;
    // A solid ball that rolls on an accelerated floor has 2/7 of the floor's acceleration.
    constexpr double each_ball = (push - ground) / box_mass / (3.5 / ball_mass + balls / box_mass);
    constexpr double box_acceleration = (push - ground - balls * each_ball) / box_mass;
    const Vec3 box = time * box_acceleration * push_direction;
    const Vec3 ball = time * (each_ball / ball_mass) * push_direction;
    return length_squared(scene.world->linear_velocity(scene.bodies[0]) - box) +
           length_squared(scene.world->linear_velocity(scene.bodies[1]) - ball);
}

Result<Scene> make_bouncing(double time_step) {
    auto scene = make_world(time_step, make_material(0, 1));
    if (!scene) return scene;
    std::vector<Vec3> places;
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j) places.push_back({i * 2.0, 5, j * 2.0});
    if (auto added = add_balls(*scene, {0.1, 10, make_material(0, 1)}, places); !added) return added.error();
    return scene;
}

double energy(const Scene& scene) {
    const physics::Conserved sums = scene.world->conserved();
    return sums.kinetic_energy + sums.potential_energy;
}

double energy_error(const Scene& scene, double) {
    const double difference = energy(scene) - scene.start_energy;
    return difference * difference;
}

// 666: a cube of 6 × 6 × 6 balls. SimBenchmark perturbs them by another random generator, so the errors differ by
// chance, too.
constexpr double small_radius = 0.1;  // m

Result<Scene> make_666(double time_step, double lowest, double restitution) {
    auto scene = make_world(time_step, make_material(0, restitution));
    if (!scene) return scene;
    Random random(42);
    std::vector<Vec3> places;
    const auto place = [&](int index) { return index * 0.21 + random.between(0, 0.001); };
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            for (int k = 0; k < 6; ++k) {
                const double x = place(i), z = place(j), y = place(k);
                places.push_back({x, lowest + y, z});
            }
        }
    }
    if (auto added = add_balls(*scene, {small_radius, 10, make_material(0, restitution)}, places); !added)
        return added.error();
    return scene;
}
Result<Scene> make_inelastic_666(double time_step) { return make_666(time_step, 0.101, 0); }
Result<Scene> make_elastic_666(double time_step) { return make_666(time_step, 1.101, 1); }

/// Sum of the squared penetration depths between balls and with the ground, m².
double penetration_error(const Scene& scene, double) {
    std::vector<Vec3> centers;
    for (const BodyHandle body : scene.bodies) centers.push_back(scene.world->center_of_mass(body));
    double sum = 0;
    const auto add = [&](double depth) { sum += depth > 0 ? depth * depth : 0; };
    for (std::size_t i = 0; i < centers.size(); ++i) {
        add(small_radius - centers[i].y);
        for (std::size_t j = i + 1; j < centers.size(); ++j) add(2 * small_radius - distance(centers[i], centers[j]));
    }
    return sum;
}

}  // namespace

const Published* AccuracyTest::published(double time_step) const {
    const auto found =
        std::find_if(best.begin(), best.end(), [&](const Published& one) { return one.time_step == time_step; });
    return found == best.end() ? nullptr : &*found;
}

std::span<const AccuracyTest> accuracy_tests() {
    // Rolling: each engine's own settings; Bullet with iterations until convergence has an error of 7e-28.
    static const std::vector<AccuracyTest> tests = {
        {.name = "rolling",
         .what = "25 balls on a box of 20 m that is pushed with 150 N",
         .error = "mean square of the box's and a ball's velocity error",
         .unit = "m²/s²",
         .seconds = 4,
         .best = {{0.001, 4.93e-9, "Bullet"}},
         .make = make_rolling,
         .measure = rolling_error},
        {.name = "bouncing",
         .what = "49 balls that fall 4.9 m, e = 1",
         .error = "mean square of the change of energy",
         .unit = "J²",
         .seconds = 20,
         .best = {{0.01, 185.953, "RaiSim"}, {0.001, 0.0186204, "RaiSim"}},
         .make = make_bouncing,
         .measure = energy_error},
        {.name = "666",
         .what = "6 x 6 x 6 balls above each other fall apart, e = 0",
         .error = "mean of the sum of squared penetrations",
         .unit = "m²",
         .seconds = 10,
         .best = {{0.01, 0.0152745, "RaiSim"}, {0.001, 1.3534e-4, "RaiSim"}},
         .make = make_inelastic_666,
         .measure = penetration_error},
        {.name = "elastic_666",
         .what = "6 x 6 x 6 balls fall 1 m and bounce, e = 1",
         .error = "mean square of the change of energy",
         .unit = "J²",
         .seconds = 10,
         .best = {{0.01, 5.18417e6, "RaiSim"}, {0.001, 8.36835, "RaiSim"}},
         .make = make_elastic_666,
         .measure = energy_error},
    };
    return tests;
}

const AccuracyTest* find_accuracy_test(std::string_view name) {
    const auto tests = accuracy_tests();
    const auto found = std::find_if(tests.begin(), tests.end(), [&](const AccuracyTest& t) { return t.name == name; });
    return found == tests.end() ? nullptr : &*found;
}

Result<Accuracy> run_accuracy_test(const AccuracyTest& test, double time_step, std::optional<double> seconds) {
    auto scene = test.make(time_step);
    if (!scene) return scene.error();
    scene->start_energy = energy(*scene);

    // As in SimBenchmark the error is measured before each step, including the first.
    Accuracy result{.steps = static_cast<int>(std::lround(seconds.value_or(test.seconds) / time_step))};
    for (int i = 0; i < result.steps; ++i) {
        result.error += test.measure(*scene, i * time_step) / result.steps;
        result.step_milliseconds += scene->world->step().milliseconds / result.steps;
    }
    return result;
}

}  // namespace embody::simbenchmark
