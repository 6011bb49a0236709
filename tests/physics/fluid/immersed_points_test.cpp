// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/immersed_points.h"

#include <gtest/gtest.h>

#include <map>

#include "physics/fluid/grid/faces.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {
namespace {

constexpr double cell = 0.1, time = 0.01, rho = 1000;  // m, s, kg/m³
constexpr double particle = rho * cell * cell * cell / 8;

ImmersedPoint random_point(Random& random) {
    ImmersedPoint point;
    point.position = {random.between(0.45, 0.95), random.between(0.45, 0.95), random.between(0.45, 0.95)};
    point.velocity = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    point.volume = random.between(0, 2e-4);
    point.inverse_mass = random.unit() < 0.2 ? 0 : 1 / random.between(1e-4, 1);
    const double form = random.unit();
    point.form.form = form < 0.3   ? DragForm::cylinder
                      : form < 0.6 ? DragForm::sheet
                      : form < 0.8 ? DragForm::sphere
                                   : DragForm::none;
    point.form.direction = normalized(Vec3{random.between(-1, 1), random.between(-1, 1), 0.1});
    point.form.size = random.between(0.005, 0.03);
    point.form.extent = random.between(0.01, 0.1);
    return point;
}

/// A cube of liquid, 1.4 m a side, with points in its middle.
struct Immersion {
    explicit Immersion(std::vector<ImmersedPoint> given)
        : points(std::move(given)), block(cell, fill_cells(cell, {0, 0, 0}, {14, 14, 14})) {
        immersed.begin(points, {});
    }
    void find_conductance() {
        immersed.measure(time, block.grid);
        immersed.find_conductance(time, FluidProperties{.density = rho, .particle_volume = particle / rho}, block.grid);
        system.build(block.grid, {}, block.workers);
    }
    // Lets a pressure with this gradient act, N s/m³.
    void press(Vec3 gradient) {
        std::vector<double> impulse;
        for (std::size_t row = 0; row < system.size(); ++row) {
            const auto at = static_cast<int>(system.cell(row)), row_y = at / block.grid.size()[0];
            const Cell c{at % block.grid.size()[0], row_y % block.grid.size()[1], row_y / block.grid.size()[1]};
            impulse.push_back(dot(gradient, block.grid.center(c)));
        }
        immersed.start(block.grid);
        immersed.predict(time, block.grid);
        subtract_gradient(block.grid, {system, impulse, {}, 1 / (rho * cell)}, block.grid.velocity, block.workers);
        immersed.find_impulses(system, impulse, block.grid);
        immersed.apply_pressure(block.grid);
    }
    std::vector<ImmersedPoint> points;
    LiquidBlock block;
    ImmersedPoints immersed;
    PressureSystem system;
};

// Momentum of both together changes by the pressure's gradient on the volume that they share, whatever drag is between
// them.
TEST(ImmersedPoints, ShareTheMomentumOfTheirFaces) {
    Random random(3);
    for (int trial = 0; trial < 10; ++trial) {
        std::vector<ImmersedPoint> points;
        for (int i = 0; i < 30; ++i) points.push_back(random_point(random));
        Immersion all(points);
        all.block.set_velocity([](Vec3 p) { return Vec3{p.y, -p.x, 0.3}; });
        all.find_conductance();
        FluidGrid& grid = all.block.grid;
        std::array<std::map<int, double>, 3> filled;  // of the faces' control volumes
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 p = all.immersed.places()[i];
            const float place[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const FaceWeight& face : face_weights(grid, place, static_cast<int>(axis)))
                    filled[axis][face.cell] += face.weight * points[i].volume / (cell * cell * cell);
            }
        }
        const auto before = grid.velocity;
        const Vec3 gradient{random.between(-300, 300), random.between(-300, 300), random.between(-300, 300)};
        all.press(gradient);
        Vec3 given;
        for (std::uint32_t i = 0; i < points.size(); ++i) given += all.immersed.given(i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<int>(axis);
            double liquid = 0, pressed = 0;
            for (const auto& [face, fraction] : filled[axis]) {
                const double mass = rho * cell * cell * cell * (1 - fraction);
                liquid += mass * (static_cast<double>(grid.velocity[axis][face]) - before[axis][face]);
                pressed -= cell * cell * cell * gradient[a];
            }
            EXPECT_NEAR(liquid + given[a], pressed, 1e-4 * (std::fabs(pressed) + std::fabs(given[a]))) << "axis " << a;
        }
    }
}

TEST(ImmersedPoints, CarryTheirDisplacedWeightInLiquidAtRest) {
    Random random(4);
    std::vector<ImmersedPoint> points;
    for (int i = 0; i < 30; ++i) points.push_back(random_point(random));
    constexpr double g = 9.81;
    for (ImmersedPoint& point : points) point.velocity = {};
    Immersion all(points);
    all.block.set_velocity([](Vec3) { return Vec3{}; });
    all.find_conductance();
    // What holds each point: its weight less that of its volume of liquid.
    for (ImmersedPoint& point : all.points) point.acceleration = {0, -rho * point.volume * g * point.inverse_mass, 0};
    all.block.set_velocity([](Vec3) { return Vec3{0, -g * time, 0}; });
    all.press({0, -rho * g * time, 0});
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const double weight = rho * points[i].volume * g * time;
        EXPECT_LT(length(all.immersed.given(i) - Vec3{0, weight, 0}), 1e-3 * weight + 1e-6) << i;
    }
    for (const auto& field : all.block.grid.velocity) {
        for (const int at : all.block.grid.immersed_cells) EXPECT_NEAR(field[at], 0, 1e-4);
    }
}

// Drag may bring a point to the liquid's velocity and not beyond, however light it is and however long the step.
TEST(ImmersedPoints, DragEndsTheSlipAndDoesNotReverseIt) {
    Random random(6);
    for (int trial = 0; trial < 200; ++trial) {
        ImmersedPoint point = random_point(random);
        point.inverse_mass = 1 / std::pow(10.0, random.between(-7, 1));
        point.volume = 0;
        const bool is_cylinder = point.form.form == DragForm::cylinder;
        Immersion all({point});
        all.block.set_velocity([](Vec3) { return Vec3{}; });
        all.find_conductance();
        all.press({});
        const Vec3 after = point.velocity + all.immersed.given(0) * point.inverse_mass;
        EXPECT_LE(length(after), length(point.velocity) * (1 + 1e-6)) << static_cast<int>(point.form.form);
        if (is_cylinder) {
            EXPECT_GE(dot(after, point.velocity), -1e-6);
        }
    }
}

// What holds a point brings it and the liquid that it holds to a velocity, at each of its faces alike: with as much as
// both have at it, m + b. By its mass alone its parts at faces with little liquid would fly off.
TEST(ImmersedPoints, AreHeldWithTheLiquidThatTheyHold) {
    Random random(7);
    for (int trial = 0; trial < 20; ++trial) {
        ImmersedPoint point = random_point(random);
        point.form.form = DragForm::sheet;
        point.form.extent = 1e-3;
        point.volume = 0;
        point.velocity = {};
        point.inverse_mass = 1 / std::pow(10.0, random.between(-5, -2));
        Immersion all({point});
        all.block.set_velocity([](Vec3) { return Vec3{}; });
        all.find_conductance();
        all.immersed.start(all.block.grid);
        const Vec3 speed{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const double mass = 1 / point.inverse_mass;
        all.points[0].acceleration = {};
        all.points[0].support = scale(Vec3{mass, mass, mass} + all.immersed.bound(0), speed) / time;
        all.press({});
        EXPECT_LT(length(all.immersed.velocity_after(0) - speed), 1e-3 * length(speed));
    }
}

TEST(ImmersedDrag, OfACylinderIsWieselsbergersAcrossAndSmallAlong) {
    // C_d of C. Wieselsberger (1921) at Re.
    constexpr double d = 0.01;
    for (const auto& [reynolds, coefficient] : {std::pair{100.0, 1.45}, {1e3, 1.0}, {1e4, 1.1}, {1e5, 1.2}}) {
        const double speed = reynolds * 1e-6 / d;
        const ImmersedForm form{DragForm::cylinder, {1, 0, 0}, d, 1};
        const ImmersedDrag across = drag_of(form, {0, speed, 0}, {1000, 0.001});
        const double expected = coefficient * 500 * d * speed * speed;
        EXPECT_NEAR(across.along.y * speed - across.less.y, expected, 0.2 * expected) << reynolds;
        const ImmersedDrag along = drag_of(form, {speed, 0, 0}, {1000, 0.001});
        const double friction = along.along.x * speed - along.less.x;
        EXPECT_GT(friction, 0);
        EXPECT_LT(friction, 0.2 * expected);
    }
}

}  // namespace
}  // namespace embody::physics::fluid
