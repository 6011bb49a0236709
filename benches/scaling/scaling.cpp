// SPDX-License-Identifier: MIT
#include "benches/scaling/scaling.h"

#include <malloc.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "foundation/random.h"
#include "physics/inter/world.h"

namespace embody::scaling {

namespace {

using physics::BodyHandle;
using physics::ShapeHandle;
using physics::World;

/// Number of steps that bring a scene into its state, and of those that are timed.
struct Plan {
    int before = 0, timed = 0;
};

// After one second the lowest layers of the falling bodies are at rest and the upper ones still fall.
Plan plan_of(Scene scene) {
    switch (scene) {
        case Scene::columns_awake:
            return {60, 20};
        case Scene::heap_falling:
            return {60, 20};
        case Scene::columns_asleep:
        case Scene::one_awake:
            break;
    }
    return {120, 1000};
}

/// Resident memory of this process, KB; 0 where the system does not tell.
double resident_kilobytes() {
    std::FILE* file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr) return 0;
    long all = 0, resident = 0;
    const int read = std::fscanf(file, "%ld %ld", &all, &resident);
    std::fclose(file);
    return read == 2 ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024 : 0;
}

double cpu_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

Result<std::unique_ptr<World>> make_world(bool sleeping) {
    auto world = World::create({.sleeping = sleeping});
    if (!world) return world;
    const auto plane = (*world)->create_shape(physics::PlaneShape{});
    if (!plane) return plane.error();
    const auto ground = (*world)->create_body({.kind = physics::BodyKind::static_body, .shape = *plane});
    if (!ground) return ground.error();
    return world;
}

/// Positions of columns side by side on a square.
class Columns {
public:
    Columns(int bodies, int height, double pitch)
        : height_(height),
          side_(static_cast<int>(std::ceil(std::sqrt(static_cast<double>(bodies) / height)))),
          pitch_(pitch) {}
    /// Position of body `i`; `rise` is the distance between two centres above each other, `lowest` the first one's
    /// height, m.
    [[nodiscard]] Vec3 place(int i, double lowest, double rise) const {
        const int column = i / height_;
        return {(column % side_) * pitch_, lowest + (i % height_) * rise, (column / side_) * pitch_};
    }

private:
    int height_, side_;
    double pitch_;
};

Result<void> fill_columns(World& world, int bodies) {
    const auto cube = world.create_shape(physics::BoxShape{});
    if (!cube) return cube.error();
    const Columns columns(bodies, 4, 1.5);
    for (int i = 0; i < bodies; ++i) {
        const auto body = world.create_body({.shape = *cube, .position = columns.place(i, 0.5, 1)});
        if (!body) return body.error();
    }
    return {};
}

Result<void> add_rolling_ball(World& world) {
    const auto ball = world.create_shape(physics::SphereShape{});
    if (!ball) return ball.error();
    const auto body = world.create_body({.shape = *ball, .position = {-20, 0.5, -20}, .linear_velocity = {-3, 0, 0}});
    return body ? Result<void>() : body.error();
}

Result<void> fill_heap(World& world, int bodies) {
    const auto ball = world.create_shape(physics::SphereShape{0.4});
    if (!ball) return ball.error();
    const auto box = world.create_shape(physics::BoxShape{{0.4, 0.3, 0.25}});
    if (!box) return box.error();
    const Columns columns(bodies, 10, 1.2);
    Random random(1);
    const auto tilt = [&] { return random.between(-1, 1); };
    for (int i = 0; i < bodies; ++i) {
        const Vec3 axis = normalized({tilt(), tilt(), tilt()}, {0, 1, 0});
        const auto body = world.create_body({.shape = i % 2 == 0 ? *ball : *box,
                                             .position = columns.place(i, 0.7, 1.2),
                                             .rotation = from_axis_angle(axis, random.between(0, std::numbers::pi)),
                                             .linear_velocity = {tilt(), 0, tilt()}});
        if (!body) return body.error();
    }
    return {};
}

std::string check(Scene scene, const World& world, int bodies) {
    const physics::StepReport& report = world.last_report();
    double fastest = 0, lowest = 0;
    for (const BodyHandle body : world.bodies()) {
        fastest = std::max(fastest, length(world.linear_velocity(body)));
        lowest = std::min(lowest, world.center_of_mass(body).y);
    }
    if (!std::isfinite(world.conserved().kinetic_energy)) return "not finite";
    if (lowest < 0) return "fell through the ground";
    if (scene == Scene::columns_awake && fastest > 0.1) return "columns move";
    const bool must_sleep = scene == Scene::columns_asleep || scene == Scene::one_awake;
    if (must_sleep && report.bodies_asleep != static_cast<std::uint32_t>(bodies)) return "not asleep";
    if (scene == Scene::one_awake && report.bodies_active != 1) return "nothing rolls";
    return {};
}

}  // namespace

std::string_view name_of(Scene scene) {
    switch (scene) {
        case Scene::columns_awake:
            return "columns_awake";
        case Scene::heap_falling:
            return "heap_falling";
        case Scene::columns_asleep:
            return "columns_asleep";
        case Scene::one_awake:
            break;
    }
    return "one_awake";
}

std::string_view what_of(Scene scene) {
    switch (scene) {
        case Scene::columns_awake:
            return "cubes at rest in columns of four, sleep off";
        case Scene::heap_falling:
            return "balls and boxes, ten above each other, falling and tumbling";
        case Scene::columns_asleep:
            return "the columns, asleep";
        case Scene::one_awake:
            break;
    }
    return "the columns asleep, and one ball that rolls";
}

Result<Cost> measure(Scene scene, int bodies) {
    // Memory of earlier worlds is returned to the system, so that it does not count as this one's.
    malloc_trim(0);
    const double memory_before = resident_kilobytes();
    auto world = make_world(scene != Scene::columns_awake && scene != Scene::heap_falling);
    if (!world) return world.error();
    auto filled = scene == Scene::heap_falling ? fill_heap(**world, bodies) : fill_columns(**world, bodies);
    if (!filled) return filled.error();
    if (scene == Scene::one_awake)
        if (auto added = add_rolling_ball(**world); !added) return added.error();

    const Plan plan = plan_of(scene);
    for (int i = 0; i < plan.before; ++i) (*world)->step();
    const double start = cpu_milliseconds();
    for (int i = 0; i < plan.timed; ++i) (*world)->step();
    const double took = cpu_milliseconds() - start;
    return Cost{.bodies = bodies,
                .contacts = (*world)->last_report().contacts,
                .step_milliseconds = took / plan.timed,
                .memory_kilobytes = (resident_kilobytes() - memory_before) / bodies,
                .wrong = check(scene, **world, bodies)};
}

double growth(const Cost& smaller, const Cost& larger) {
    return std::log(larger.step_milliseconds / smaller.step_milliseconds) /
           std::log(static_cast<double>(larger.bodies) / smaller.bodies);
}

}  // namespace embody::scaling
