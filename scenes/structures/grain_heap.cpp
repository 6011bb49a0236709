// SPDX-License-Identifier: MIT
#include "scenes/structures/grain_heap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "physics/definitions/grain_material.h"

namespace embody::scenes {

using physics::BodyDefinition;
using physics::BodyHandle;
using physics::BodyKind;
using physics::PlaneShape;
using physics::World;

namespace {

// A world with a plate as rough as the grains, and what is on it.
class Grains {
public:
    static Result<Grains> create(const HeapToPour& definition) {
        Grains made(definition);
        physics::WorldSettings settings{.workers = definition.workers};
        settings.substeps = physics::substeps_for_grains(definition.diameter, settings);
        Result<std::unique_ptr<World>> world = World::create(settings);
        if (!world.ok()) return world.error();
        made.world_ = std::move(world).value();
        const auto ball = made.world_->create_shape(physics::SphereShape{definition.diameter / 2});
        if (!ball.ok()) return ball.error();
        made.grain_.shape = ball.value();
        made.grain_.mass.density = 2650;
        made.grain_.material = physics::grain_material(definition.friction_angle, definition.diameter);
        if (const auto plate = made.add_plane({0, 1, 0}, 0, made.grain_.material); !plate.ok()) return plate.error();
        return made;
    }

    Result<BodyHandle> add_plane(Vec3 normal, double offset, const physics::Material& material,
                                 BodyKind kind = BodyKind::static_body) {
        const auto shape = world_->create_shape(PlaneShape{normal, offset});
        if (!shape.ok()) return shape.error();
        BodyDefinition plane{.kind = kind, .shape = shape.value()};
        plane.material = material;
        return world_->create_body(plane);
    }

    Result<void> add(Vec3 position) {
        grain_.position = position;
        const Result<BodyHandle> body = world_->create_body(grain_);
        if (!body.ok()) return body.error();
        balls.push_back(body.value());
        return {};
    }

    // Rows with a little room, of an extent along X and Z, until all grains are placed.
    Result<void> fill(double length_x, double length_z) {
        const double d = definition_.diameter, a = 1.08 * d;
        const auto across = static_cast<int>((length_x - d) / a) + 1, deep = static_cast<int>((length_z - d) / a) + 1;
        const auto shaken = [&] { return random.between(-0.03, 0.03) * d; };
        for (int i = 0; i < definition_.grains; ++i) {
            const double x = 0.5 * d + (i % across) * a, z = 0.5 * d + (i / across % deep) * a - length_z / 2;
            const double y = 0.55 * d + (i / across / deep) * a;
            if (Result<void> added = add({x + shaken(), y + shaken(), z + shaken()}); !added.ok()) return added;
        }
        return {};
    }

    // Until all but one grain in a hundred sleep; the seconds that took, or nothing.
    std::optional<double> step_to_rest(double most_seconds) {
        const double dt = world_->settings().time_step;
        for (double time = 0; time < most_seconds; time += dt) {
            world_->step();
            if (100 * (balls.size() - world_->last_report().bodies_asleep) <= balls.size()) return time;
        }
        return std::nullopt;
    }

    [[nodiscard]] std::vector<Vec3> places() const {
        std::vector<Vec3> places;
        for (const BodyHandle ball : balls) places.push_back(world_->center_of_mass(ball));
        return places;
    }

    World& world() { return *world_; }
    [[nodiscard]] const physics::Material& material() const { return grain_.material; }

    std::vector<BodyHandle> balls;
    Random random;

private:
    explicit Grains(const HeapToPour& definition) : random(definition.seed), definition_(definition) {}

    HeapToPour definition_;
    std::unique_ptr<World> world_;
    BodyDefinition grain_;
};

// Of a cone whose grains they are.
double cone_angle(std::vector<Vec3> places) {
    Vec3 middle;
    for (const Vec3 p : places) middle += p / static_cast<double>(places.size());
    const auto off_axis = [&](Vec3 p) {
        return (p.x - middle.x) * (p.x - middle.x) + (p.z - middle.z) * (p.z - middle.z);
    };
    std::ranges::sort(places, {}, off_axis);
    places.resize(places.size() * 97 / 100);
    double height = 0, spread = 0;
    for (const Vec3 p : places) {
        height += p.y / static_cast<double>(places.size());
        spread += off_axis(p) / static_cast<double>(places.size());
    }
    return std::atan(4 * height / std::sqrt(spread * 10 / 3)) * 180 / std::numbers::pi;
}

// Slope of the front flank along X, from a fifth to two thirds of the height: a line through the mean of the three
// highest grains of each column a diameter wide.
double surface_angle(const std::vector<Vec3>& places, double diameter) {
    std::vector<std::vector<double>> columns;
    for (const Vec3 p : places) {
        if (p.x < 0) continue;
        const auto column = static_cast<std::size_t>(p.x / diameter);
        if (column >= columns.size()) columns.resize(column + 1);
        columns[column].push_back(p.y);
    }
    std::vector<std::pair<double, double>> surface;
    double top = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::ranges::sort(columns[i], std::greater<>());
        columns[i].resize(std::min<std::size_t>(columns[i].size(), 3));
        if (columns[i].empty()) continue;
        double mean = 0;
        for (const double y : columns[i]) mean += y / static_cast<double>(columns[i].size());
        surface.emplace_back((static_cast<double>(i) + 0.5) * diameter, mean);
        top = std::max(top, mean);
    }
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (auto column = surface.rbegin(); column != surface.rend(); ++column) {
        const auto [x, y] = *column;
        if (y > 0.65 * top) break;
        if (y < 0.2 * top) continue;
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return -std::atan((n * sxy - sx * sy) / (n * sxx - sx * sx)) * 180 / std::numbers::pi;
}

}  // namespace

Result<Heap> pour_heap(const HeapToPour& definition) {
    Result<Grains> made = Grains::create(definition);
    if (!made.ok()) return made.error();
    Grains& grains = made.value();
    World& world = grains.world();

    // Four at a time, on a ring of four diameters, two diameters above what lies there; each four when those before
    // have left the place.
    const double d = definition.diameter, ring = 4 * d;
    const double dt = world.settings().time_step;
    const int pause = std::max(1, static_cast<int>(std::lround(4 * std::sqrt(d / 0.01) / (60 * dt))));
    for (int step = 0; std::ssize(grains.balls) < definition.grains; ++step, world.step()) {
        if (step % pause != 0) continue;
        double top = 0;
        for (const BodyHandle ball : grains.balls) {
            const Vec3 p = world.center_of_mass(ball);
            const bool lies = std::fabs(world.linear_velocity(ball).y) < 0.9 * std::sqrt(9.81 * d);
            if (lies && std::hypot(p.x, p.z) < ring + d) top = std::max(top, p.y);
        }
        for (int k = 0; k < 4 && std::ssize(grains.balls) < definition.grains; ++k) {
            const double angle = std::numbers::pi / 2 * (k + grains.random.unit());
            const double radius = ring * grains.random.between(0.35, 0.85);
            const Vec3 above{radius * std::cos(angle), top + d * (2 + 1.2 * (k % 3)), radius * std::sin(angle)};
            if (Result<void> added = grains.add(above); !added.ok()) return added.error();
        }
    }
    const std::optional<double> rest = grains.step_to_rest(10);
    Heap heap{.angle = cone_angle(grains.places()), .asleep = rest.has_value(), .rest_seconds = rest.value_or(10)};
    for (const physics::ContactView& contact : world.contacts())
        heap.overlap = std::max(heap.overlap, -contact.separation / d);
    return heap;
}

Result<double> draw_wall_away(const HeapToPour& definition) {
    Result<Grains> made = Grains::create(definition);
    if (!made.ok()) return made.error();
    Grains& grains = made.value();
    const double d = definition.diameter, length_x = 25 * d, width = 8 * d;
    physics::Material smooth;
    smooth.friction_static = smooth.friction_dynamic = 0;
    const auto in_front = grains.add_plane({0, 0, -1}, -width / 2, smooth);
    const auto behind = grains.add_plane({0, 0, 1}, -width / 2, smooth);
    const auto end = grains.add_plane({1, 0, 0}, 0, grains.material());
    if (!in_front.ok() || !behind.ok() || !end.ok()) return in_front.ok() ? end.error() : in_front.error();

    // A wall as high as the trench, which can be drawn.
    World& world = grains.world();
    const double thickness = 2 * d;
    const auto shape = world.create_shape(physics::BoxShape{{thickness, 40 * d, width}});
    if (!shape.ok()) return shape.error();
    BodyDefinition gate{.kind = BodyKind::kinematic_body, .shape = shape.value()};
    gate.position = {length_x + thickness, 40 * d, 0};
    gate.material = smooth;
    const auto wall = world.create_body(gate);
    if (!wall.ok()) return wall.error();
    if (Result<void> filled = grains.fill(length_x, width); !filled.ok()) return filled.error();
    for (int i = 0; i < 60; ++i) world.step();
    const double speed = 0.3 * std::sqrt(9.81 * d);
    if (Result<void> drawn = world.set_velocity(wall.value(), {speed, 0, 0}, {}); !drawn.ok()) return drawn.error();
    const double way = 40 * d;
    for (double gone = 0; gone < way; gone += speed * world.settings().time_step) world.step();
    if (Result<void> gone = world.destroy_body(wall.value()); !gone.ok()) return gone.error();
    grains.step_to_rest(5);
    return surface_angle(grains.places(), d);
}

Result<SlabCost> time_slab(const HeapToPour& definition) {
    Result<Grains> made = Grains::create(definition);
    if (!made.ok()) return made.error();
    Grains& grains = made.value();
    if (Result<void> filled = grains.fill(20 * definition.diameter, 20 * definition.diameter); !filled.ok())
        return filled.error();
    SlabCost cost;
    constexpr int steps = 60;
    for (int i = 0; i < steps; ++i) {
        cost.awake_ms += grains.world().step().milliseconds / steps;
        cost.contacts = std::max<std::size_t>(cost.contacts, grains.world().last_report().contacts);
    }
    grains.step_to_rest(20);
    for (int i = 0; i < steps; ++i) cost.asleep_ms += grains.world().step().milliseconds / steps;
    return cost;
}

}  // namespace embody::scenes
