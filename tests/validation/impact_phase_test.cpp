// SPDX-License-Identifier: MIT
// A single impact obeys eq. (3) whenever in the step it happens, and however the body spins: what the world makes of it
// is compared with the micro-collision solved alone, at bodies that a fine Runge-Kutta integration leads there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "foundation/random.h"
#include "physics/constraint/impact/frictional_impact.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using namespace constraint;

constexpr double step = 1.0 / 60;
constexpr int phases = 16;

/// A free rigid body without forces, moved by Euler's equations (classical Runge-Kutta, fine).
struct FreeBody {
    double mass = 1;
    Vec3 inertia;  ///< principal moments, body axes
    Vec3 center, velocity;
    Quat rotation;
    Vec3 momentum;  ///< angular, world; constant in flight

    [[nodiscard]] Vec3 spin_at(const Quat& q) const {
        const Vec3 l = rotate_inverse(q, momentum);
        return rotate(q, {l.x / inertia.x, l.y / inertia.y, l.z / inertia.z});
    }
    [[nodiscard]] Vec3 spin() const { return spin_at(rotation); }
    void set_spin(Vec3 omega) {
        const Vec3 w = rotate_inverse(rotation, omega);
        momentum = rotate(rotation, {w.x * inertia.x, w.y * inertia.y, w.z * inertia.z});
    }
    void fly(double time) {
        constexpr int parts = 64;
        const double h = time / parts;
        center += velocity * time;
        const auto rate = [&](const Quat& q) {
            const Vec3 w = spin_at(normalized(q));
            const Quat r = Quat{w.x, w.y, w.z, 0} * q;
            return Quat{r.x / 2, r.y / 2, r.z / 2, r.w / 2};
        };
        const auto add = [](const Quat& q, const Quat& r, double s) {
            return Quat{q.x + r.x * s, q.y + r.y * s, q.z + r.z * s, q.w + r.w * s};
        };
        for (int i = 0; i < parts; ++i) {
            const Quat q = rotation, k1 = rate(q), k2 = rate(add(q, k1, h / 2)), k3 = rate(add(q, k2, h / 2)),
                       k4 = rate(add(q, k3, h));
            rotation = normalized(add(add(add(add(q, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6));
        }
    }
};

/// What eq. (3) makes of the body's impact at `arm` with a plane whose normal is Y.
void collide_with_plane(FreeBody& body, Vec3 arm, const ImpactCoefficients& coefficients) {
    const auto respond = [&](Vec3 impulse) {
        FreeBody alone = body;
        alone.momentum = cross(arm, impulse);
        return impulse / body.mass + cross(alone.spin(), arm);
    };
    // In the contact frame (t1, t2, n) = (Z, X, Y).
    const std::array<Vec3, 3> axes{Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    const auto to_frame = [&](Vec3 v) { return Vec3{dot(v, axes[0]), dot(v, axes[1]), dot(v, axes[2])}; };
    const Mat3 inverse_mass{to_frame(respond(axes[0])), to_frame(respond(axes[1])), to_frame(respond(axes[2]))};
    const ImpactOutcome outcome =
        solve_frictional_impact(inverse_mass, to_frame(body.velocity + cross(body.spin(), arm)), coefficients);
    const Vec3 impulse = axes[0] * outcome.impulse.x + axes[1] * outcome.impulse.y + axes[2] * outcome.impulse.z;
    body.velocity += impulse / body.mass;
    body.momentum += cross(arm, impulse);
}

Mat3 diagonal(Vec3 d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }

/// The body in a world above a plane, `time` before the impact.
struct Flight {
    std::unique_ptr<World> world;
    BodyHandle body;
};
Flight begin_flight(FreeBody at_impact, Vec3 local_center, const ShapeDefinition& shape, const Material& material,
                    double time) {
    at_impact.fly(-time);
    Flight flight{make_world({.gravity = {}, .time_step = step}), {}};
    add_plane(*flight.world, material);
    flight.body = flight.world
                      ->create_body({.shape = flight.world->create_shape(shape).value(),
                                     .position = at_impact.center - rotate(at_impact.rotation, local_center),
                                     .rotation = at_impact.rotation,
                                     .linear_velocity = at_impact.velocity,
                                     .angular_velocity = at_impact.spin(),
                                     .mass = {.mass = at_impact.mass,
                                              .center_of_mass = local_center,
                                              .inertia = diagonal(at_impact.inertia)},
                                     .material = material})
                      .value();
    return flight;
}

Material bouncing(double mu, double restitution) {
    return {.friction_static = mu,
            .friction_dynamic = mu,
            .restitution = restitution,
            .friction_combine = CombineRule::geometric_mean};
}

class ReferenceImpact : public testing::TestWithParam<const char*> {};

TEST_P(ReferenceImpact, HoldsAtEveryPhaseOfTheStep) {
    const auto reference = reference_case(GetParam());
    const auto& setup = reference["setup"];

    // The reference has its normal along Z; here it is Y. The moments of the eccentric sphere are those along its axes.
    const Quat turn = from_axis_angle({1, 0, 0}, -pi / 2);
    const auto up = [&](const nlohmann::json& v) { return rotate(turn, to_vec3(v)); };
    FreeBody body;
    ShapeDefinition shape;
    Vec3 touching;  // in the body's frame
    const std::string id = GetParam();
    if (id.find("box") != std::string::npos) {
        shape = BoxShape{to_vec3(setup["half_extents"])};
        body.inertia = to_vec3(setup["I_body"]);
        const auto& q = setup["quaternion_wxyz_unnormalised"];
        body.rotation = normalized(turn * normalized(Quat{q[1], q[2], q[3], q[0]}));
        touching = to_vec3(setup["contact_local"]);
    } else if (id == "impact_eccentric_sphere") {
        shape = SphereShape{0.1};
        body.inertia = to_vec3(setup["I_body"]);
        body.rotation = turn;
        touching = {0, 0, -0.1};
    } else {
        // The slender rod: a needle whose corner is where the rod's end is.
        shape = BoxShape{{0.5, 0.001, 0.001}};
        const double moment = setup["I_y"];
        body.inertia = {1e-3 * moment, moment, moment};
        const double angle = setup["angle_from_horizontal_deg"].get<double>() * pi / 180;
        body.rotation = normalized(turn * from_axis_angle({0, 1, 0}, -angle));
        touching = {-0.5, 0, -0.001};
    }
    body.mass = setup["mass"];
    const Vec3 arm = up(setup["contact_r"]);
    const Vec3 local_center = touching - rotate_inverse(body.rotation, arm);
    body.center = -arm;
    body.velocity = up(setup["v"]);
    body.set_spin(up(setup["omega"]));
    const Material material = bouncing(setup["mu"], setup["e_stronge"]);

    const auto& expected = reference["expected"];
    FreeBody after = body;
    after.velocity = up(expected["v1_after"]);
    after.set_spin(up(expected["omega1_after"]));
    const double tolerance = reference["tolerance"]["velocity_abs"];
    for (int phase = 0; phase < phases; ++phase) {
        SCOPED_TRACE("struck at " + std::to_string(phase) + "/16 of the step");
        const double time = step * (phase + 0.5) / phases;
        const Flight flight = begin_flight(body, local_center, shape, material, time);
        flight.world->step();
        FreeBody end = after;
        end.fly(step - time);
        EXPECT_LT(length(flight.world->linear_velocity(flight.body) - end.velocity), tolerance);
        EXPECT_LT(length(flight.world->angular_velocity(flight.body) - end.spin()) * length(arm), tolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(EquationThree, ReferenceImpact,
                         testing::Values("impact_box_swerve", "impact_box_stick", "impact_eccentric_sphere",
                                         "impact_rod_kane", "impact_rod_jam"));

/// A box that is about to touch the plane with one corner, spinning; false where it would have touched it before, or
/// touches it again before the next step ends.
struct CornerImpact {
    Vec3 half;
    FreeBody body;
    Vec3 arm;
    ImpactCoefficients coefficients;
    double time = 0;  ///< of the impact in the step
};

double lowest_corner(const FreeBody& body, Vec3 half, Vec3* arm = nullptr, double* second = nullptr) {
    double lowest = 1e300, next = 1e300;
    for (int i = 0; i < 8; ++i) {
        const Vec3 r =
            rotate(body.rotation, {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
        const double height = body.center.y + r.y;
        if (height < lowest) {
            next = lowest;
            lowest = height;
            if (arm != nullptr) *arm = r;
        } else {
            next = std::min(next, height);
        }
    }
    if (second != nullptr) *second = next;
    return lowest;
}

bool make_corner_impact(Random& random, double spin, CornerImpact& impact) {
    const auto direction = [&] {
        return normalized(Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
    };
    impact.half = {random.between(0.03, 0.3), random.between(0.03, 0.3), random.between(0.03, 0.3)};
    const Vec3 squares{impact.half.x * impact.half.x, impact.half.y * impact.half.y, impact.half.z * impact.half.z};
    FreeBody body;
    body.mass = random.between(0.1, 10);
    body.inertia = Vec3{squares.y + squares.z, squares.x + squares.z, squares.x + squares.y} * (body.mass / 3);
    body.rotation = from_axis_angle(direction(), random.between(0, pi));
    body.velocity = {random.between(-3, 3), random.between(-6, -0.5), random.between(-3, 3)};
    body.set_spin(direction() * (spin * random.unit()));
    double second = 0;
    lowest_corner(body, impact.half, &impact.arm, &second);
    body.center = -impact.arm;
    if (second + body.center.y < 0.02) return false;
    if ((body.velocity + cross(body.spin(), impact.arm)).y > -0.3) return false;
    const double mu = random.between(0, 1.2);
    impact.coefficients = {mu, mu, random.unit()};
    impact.time = random.unit() * step;
    impact.body = body;

    // It flies freely before, and after.
    FreeBody after = body;
    collide_with_plane(after, impact.arm, impact.coefficients);
    if (after.velocity.y < 0 && (after.velocity + cross(after.spin(), impact.arm)).y < 0.1) return false;
    constexpr int samples = 24;
    for (int i = 1; i <= samples; ++i) {
        FreeBody before = body, later = after;
        before.fly(-impact.time * i / samples);
        later.fly((2 * step - impact.time) * i / samples);
        if (lowest_corner(before, impact.half) < 0 || lowest_corner(later, impact.half) < 0) return false;
    }
    return true;
}

TEST(SpinningImpact, ObeysEquationThreeAtRandomMomentsOfTheStep) {
    struct Spin {
        double most;       // rad/s
        double tolerance;  // of the approach speed: what the parts of a substep leave of a fast rotation's path
    };
    for (const Spin spin : {Spin{5, 1e-3}, Spin{20, 2e-3}, Spin{50, 5e-3}}) {
        SCOPED_TRACE("up to " + std::to_string(spin.most) + " rad/s");
        Random random(7);
        double worst = 0;
        for (int count = 0; count < 300;) {
            CornerImpact impact;
            if (!make_corner_impact(random, spin.most, impact)) continue;
            ++count;
            const Material material = bouncing(impact.coefficients.friction_slide, impact.coefficients.restitution);
            const Flight flight = begin_flight(impact.body, {}, BoxShape{impact.half}, material, impact.time);
            int steps = 0;
            do {
                flight.world->step();
                ++steps;
            } while (flight.world->last_report().impacts == 0 && steps < 2);
            ASSERT_GT(flight.world->last_report().impacts, 0u);
            FreeBody end = impact.body;
            const double approach = length(end.velocity + cross(end.spin(), impact.arm));
            collide_with_plane(end, impact.arm, impact.coefficients);
            end.fly(steps * step - impact.time);
            const double linear = length(flight.world->linear_velocity(flight.body) - end.velocity);
            const double angular = length(flight.world->angular_velocity(flight.body) - end.spin());
            worst = std::max(worst, std::max(linear, angular * length(impact.arm)) / approach);
        }
        EXPECT_LT(worst, spin.tolerance);
        RecordProperty("worst_" + std::to_string(static_cast<int>(spin.most)), std::to_string(worst));
    }
}

}  // namespace
}  // namespace embody::physics
