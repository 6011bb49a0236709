// SPDX-License-Identifier: MIT
// Every number that the face takes, with every bad value: refused with its field's name, and nothing changed.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "foundation/state_hash.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double bad_numbers[] = {nan, inf, -inf, 1e38, -1e38, 1e-310, -5e-324};

/// Two balls above a plane, one hung on a joint, one asleep group; all that setters can reach.
struct Scene {
    std::unique_ptr<World> world = make_world();
    ShapeHandle ball = world->create_shape(SphereShape{0.5}).value();
    ShapeHandle plane = world->create_shape(PlaneShape{}).value();
    BodyHandle ground = world->create_body({.kind = BodyKind::static_body, .shape = plane}).value();
    BodyHandle body = world->create_body({.shape = ball, .position = {0, 3, 0}}).value();
    BodyHandle other = world->create_body({.shape = ball, .position = {5, 0.5, 0}}).value();
    JointHandle joint = world
                            ->create_joint({.joint = HingeJoint{.limit = JointLimit{-1, 1}, .motor = JointMotor{1, 2}},
                                            .body_b = body,
                                            .frame_a = {{0, 4, 0}, {}},
                                            .frame_b = {{0, 1, 0}, {}}})
                            .value();
    Scene() {
        for (int i = 0; i < 60; ++i) world->step();
    }
};

void add(StateHash& hash, Vec3 v) {
    for (int k = 0; k < 3; ++k) hash.add(v[k]);
}
void add(StateHash& hash, const Transform& t) {
    add(hash, t.position);
    for (const double q : {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w}) hash.add(q);
}

/// Bits of all that the world tells of itself: states, definitions, settings.
std::uint64_t all_bits(const World& world) {
    StateHash hash;
    hash.add(world.state_hash());
    for (const BodyHandle body : world.bodies()) {
        const BodyDefinition d = world.body(body).value();
        add(hash, Transform{d.position, d.rotation});
        for (const Vec3 v : {d.linear_velocity, d.angular_velocity, d.force, d.torque, world.center_of_mass(body)}) {
            add(hash, v);
        }
        const Material& m = d.material;
        for (const double x :
             {d.mass.mass.value_or(-1), d.mass.density, d.linear_damping, d.angular_damping, d.gravity_factor,
              d.sleep_energy_per_mass, world.mass(body), m.friction_static, m.friction_dynamic, m.friction_rolling,
              m.friction_rolling_on_others, m.friction_torsional, m.restitution, m.restitution_threshold}) {
            hash.add(x);
        }
        for (int k = 0; k < 3; ++k) add(hash, world.inertia(body).column(k));
        hash.add(std::uint64_t{d.enabled} + 2u * d.allow_sleep + 4u * d.start_asleep);
    }
    for (const JointHandle handle : world.joints()) {
        const JointDefinition d = world.joint(handle).value();
        add(hash, d.frame_a);
        add(hash, d.frame_b);
        const auto& hinge = std::get<HingeJoint>(d.joint);
        for (const double x : {hinge.limit->lower, hinge.limit->upper, hinge.motor->speed, hinge.motor->max_force}) {
            hash.add(x);
        }
    }
    const WorldSettings& s = world.settings();
    add(hash, s.gravity);
    for (const double x : {s.time_step, s.time_to_sleep, s.max_linear_speed, s.max_angular_speed}) hash.add(x);
    return hash.value();
}

/// A field, and how to set it to a number through the face.
struct Field {
    std::string name;  ///< that the error must contain
    std::function<Result<void>(Scene&, double)> set;
};

// Makes of one number of a definition a way to set it.
Field body_field(const std::string& name, std::function<double&(BodyDefinition&)> of) {
    return {name, [of](Scene& scene, double value) {
                BodyDefinition definition = scene.world->body(scene.body).value();
                of(definition) = value;
                const auto made = scene.world->create_body(definition);
                const auto set = scene.world->set_body(scene.body, definition);
                EXPECT_EQ(made.ok(), set.ok());
                return set;
            }};
}
Field settings_field(const std::string& name, std::function<double&(WorldSettings&)> of) {
    return {name, [of](Scene& scene, double value) {
                WorldSettings settings = scene.world->settings();
                of(settings) = value;
                const bool made = World::create(settings).ok();
                const auto set = scene.world->set_settings(settings);
                EXPECT_EQ(made, set.ok());
                return set;
            }};
}
Field joint_field(const std::string& name, std::function<double&(JointDefinition&)> of) {
    return {name, [of](Scene& scene, double value) {
                JointDefinition definition = scene.world->joint(scene.joint).value();
                of(definition) = value;
                const auto made = scene.world->create_joint(definition);
                const auto set = scene.world->set_joint(scene.joint, definition);
                EXPECT_EQ(made.ok(), set.ok());
                return set;
            }};
}

// A vector's three components.
void add_vector(std::vector<Field>& fields, const std::string& name,
                const std::function<Result<void>(Scene&, Vec3)>& set) {
    for (int k = 0; k < 3; ++k) {
        fields.push_back({name + "." + "xyz"[k], [set, k](Scene& scene, double value) {
                              Vec3 v{0.1, 0.2, 0.3};
                              v[k] = value;
                              return set(scene, v);
                          }});
    }
}

std::vector<Field> body_fields() {
    std::vector<Field> fields;
    const auto add_body_vector = [&](const std::string& name, std::function<Vec3&(BodyDefinition&)> of) {
        for (int k = 0; k < 3; ++k) {
            fields.push_back(
                body_field(name + "." + "xyz"[k], [of, k](BodyDefinition& d) -> double& { return of(d)[k]; }));
        }
    };
    using D = BodyDefinition;
    add_body_vector("position", [](D& d) -> Vec3& { return d.position; });
    add_body_vector("linear_velocity", [](D& d) -> Vec3& { return d.linear_velocity; });
    add_body_vector("angular_velocity", [](D& d) -> Vec3& { return d.angular_velocity; });
    add_body_vector("force", [](D& d) -> Vec3& { return d.force; });
    add_body_vector("torque", [](D& d) -> Vec3& { return d.torque; });
    add_body_vector("mass.center_of_mass", [](D& d) -> Vec3& { return d.mass.center_of_mass.emplace(); });
    fields.push_back(body_field("mass.mass", [](D& d) -> double& { return d.mass.mass.emplace(); }));
    fields.push_back(body_field("mass.density", [](D& d) -> double& { return d.mass.density; }));
    for (int k = 0; k < 3; ++k) {
        fields.push_back(body_field("mass.inertia", [k](D& d) -> double& {
            Mat3& inertia = d.mass.inertia.emplace(Mat3::identity());
            return (k == 0 ? inertia.x : k == 1 ? inertia.y : inertia.z)[k];
        }));
    }
    fields.push_back(body_field("linear_damping", [](D& d) -> double& { return d.linear_damping; }));
    fields.push_back(body_field("angular_damping", [](D& d) -> double& { return d.angular_damping; }));
    fields.push_back(body_field("gravity_factor", [](D& d) -> double& { return d.gravity_factor; }));
    fields.push_back(body_field("sleep_energy_per_mass", [](D& d) -> double& { return d.sleep_energy_per_mass; }));
    fields.push_back(
        body_field("material.friction_static", [](D& d) -> double& { return d.material.friction_static; }));
    fields.push_back(
        body_field("material.friction_dynamic", [](D& d) -> double& { return d.material.friction_dynamic; }));
    fields.push_back(
        body_field("material.friction_rolling", [](D& d) -> double& { return d.material.friction_rolling; }));
    fields.push_back(body_field("material.friction_rolling_on_others",
                                [](D& d) -> double& { return d.material.friction_rolling_on_others; }));
    fields.push_back(
        body_field("material.friction_torsional", [](D& d) -> double& { return d.material.friction_torsional; }));
    fields.push_back(body_field("material.restitution", [](D& d) -> double& { return d.material.restitution; }));
    fields.push_back(
        body_field("material.restitution_threshold", [](D& d) -> double& { return d.material.restitution_threshold; }));
    return fields;
}

std::vector<Field> world_and_joint_fields() {
    std::vector<Field> fields;
    using S = WorldSettings;
    using J = JointDefinition;
    for (int k = 0; k < 3; ++k) {
        fields.push_back(
            settings_field(std::string("gravity.") + "xyz"[k], [k](S& s) -> double& { return s.gravity[k]; }));
        fields.push_back(joint_field(std::string("frame_a.position.") + "xyz"[k],
                                     [k](J& j) -> double& { return j.frame_a.position[k]; }));
        fields.push_back(joint_field(std::string("frame_b.position.") + "xyz"[k],
                                     [k](J& j) -> double& { return j.frame_b.position[k]; }));
    }
    fields.push_back(settings_field("time_step", [](S& s) -> double& { return s.time_step; }));
    fields.push_back(settings_field("time_to_sleep", [](S& s) -> double& { return s.time_to_sleep; }));
    fields.push_back(settings_field("max_linear_speed", [](S& s) -> double& { return s.max_linear_speed; }));
    fields.push_back(settings_field("max_angular_speed", [](S& s) -> double& { return s.max_angular_speed; }));
    const auto hinge = [](J& j) -> HingeJoint& { return std::get<HingeJoint>(j.joint); };
    fields.push_back(joint_field("limit.lower", [hinge](J& j) -> double& { return hinge(j).limit->lower; }));
    fields.push_back(joint_field("limit.upper", [hinge](J& j) -> double& { return hinge(j).limit->upper; }));
    fields.push_back(joint_field("motor.speed", [hinge](J& j) -> double& { return hinge(j).motor->speed; }));
    fields.push_back(joint_field("motor.max_force", [hinge](J& j) -> double& { return hinge(j).motor->max_force; }));
    return fields;
}

std::vector<Field> setter_fields() {
    std::vector<Field> fields;
    add_vector(fields, "pose.position", [](Scene& s, Vec3 v) { return s.world->set_pose(s.body, {v, {}}); });
    add_vector(fields, "linear", [](Scene& s, Vec3 v) { return s.world->set_velocity(s.body, v, {}); });
    add_vector(fields, "angular", [](Scene& s, Vec3 v) { return s.world->set_velocity(s.body, {}, v); });
    add_vector(fields, "force", [](Scene& s, Vec3 v) { return s.world->set_force(s.body, v, {}); });
    add_vector(fields, "torque", [](Scene& s, Vec3 v) { return s.world->set_force(s.body, {}, v); });
    add_vector(fields, "impulse", [](Scene& s, Vec3 v) { return s.world->apply_impulse(s.body, v); });
    add_vector(fields, "at_world_point", [](Scene& s, Vec3 v) { return s.world->apply_impulse(s.body, {1, 0, 0}, v); });
    add_vector(fields, "impulse", [](Scene& s, Vec3 v) { return s.world->apply_angular_impulse(s.body, v); });
    add_vector(fields, "force", [](Scene& s, Vec3 v) { return s.world->apply_force(s.body, v); });
    add_vector(fields, "at_world_point", [](Scene& s, Vec3 v) { return s.world->apply_force(s.body, {1, 0, 0}, v); });
    return fields;
}

// Rotations are told by their length: a denormal component is harmless rounding.
std::vector<Field> rotation_fields() {
    std::vector<Field> fields;
    for (int k = 0; k < 4; ++k) {
        const auto turned = [k](double value) {
            Quat q{0.5, 0.5, 0.5, 0.5};
            (k == 0 ? q.x : k == 1 ? q.y : k == 2 ? q.z : q.w) = value;
            return q;
        };
        fields.push_back({"rotation", [turned](Scene& s, double value) {
                              BodyDefinition definition = s.world->body(s.body).value();
                              definition.rotation = turned(value);
                              const auto made = s.world->create_body(definition);
                              const auto set = s.world->set_body(s.body, definition);
                              EXPECT_EQ(made.ok(), set.ok());
                              return set;
                          }});
        fields.push_back({"pose.rotation", [turned](Scene& s, double value) {
                              return s.world->set_pose(s.body, {{}, turned(value)});
                          }});
        for (const bool first : {true, false}) {
            fields.push_back({first ? "frame_a.rotation" : "frame_b.rotation", [turned, first](Scene& s, double value) {
                                  JointDefinition definition = s.world->joint(s.joint).value();
                                  (first ? definition.frame_a : definition.frame_b).rotation = turned(value);
                                  return s.world->set_joint(s.joint, definition);
                              }});
        }
    }
    return fields;
}

void expect_refused(Scene& scene, const Field& field, double bad) {
    const std::uint64_t before = all_bits(*scene.world);
    const std::size_t bodies = scene.world->bodies().size(), joints = scene.world->joints().size();
    const Result<void> result = field.set(scene, bad);
    ASSERT_FALSE(result.ok()) << field.name << " took " << bad;
    EXPECT_NE(result.error().where.find(field.name), std::string::npos) << result.error().where;
    EXPECT_FALSE(result.error().why.empty());
    EXPECT_EQ(all_bits(*scene.world), before) << field.name << " with " << bad << " changed something";
    EXPECT_EQ(scene.world->bodies().size(), bodies);
    EXPECT_EQ(scene.world->joints().size(), joints);
}

TEST(BadNumbers, AreRefusedInEveryFieldAndChangeNothing) {
    Scene scene, untouched;
    for (const auto& fields : {body_fields(), world_and_joint_fields(), setter_fields()}) {
        for (const Field& field : fields) {
            for (const double bad : bad_numbers) expect_refused(scene, field, bad);
        }
    }
    for (const Field& field : rotation_fields()) {
        for (const double bad : {nan, inf, -inf, 1e38, -1e38}) expect_refused(scene, field, bad);
    }

    // What was refused left no trace: both worlds go on alike.
    for (int i = 0; i < 60; ++i) {
        scene.world->step();
        untouched.world->step();
        ASSERT_EQ(all_bits(*scene.world), all_bits(*untouched.world)) << "step " << i;
    }
}

TEST(BadNumbers, MinusZeroIsZero) {
    for (const auto& fields : {body_fields(), world_and_joint_fields(), setter_fields(), rotation_fields()}) {
        for (const Field& field : fields) {
            Scene scene, other;
            const Result<void> minus = field.set(scene, -0.0), plus = field.set(other, 0.0);
            ASSERT_EQ(minus.ok(), plus.ok()) << field.name;
            for (int i = 0; i < 5; ++i) {
                scene.world->step();
                other.world->step();
            }
            const Vec3 a = scene.world->pose(scene.body).position, b = other.world->pose(other.body).position;
            EXPECT_EQ(a, b) << field.name;
        }
    }
}

TEST(BadNumbers, MakeQueriesFindNothing) {
    Scene scene;
    for (const double bad : {nan, inf, -inf}) {
        for (int k = 0; k < 3; ++k) {
            Vec3 v{0, 10, 0};
            v[k] = bad;
            EXPECT_FALSE(scene.world->cast_ray(v, {0, -1, 0}, 100)) << bad;
            EXPECT_FALSE(scene.world->cast_ray({0, 10, 0}, v, 100)) << bad;
            const bool finds = !scene.world->overlap_box({v, {1, 11, 1}}).empty();
            EXPECT_FALSE(finds && std::isnan(bad));
        }
    }
    EXPECT_FALSE(scene.world->cast_ray({0, 10, 0}, {0, -1, 0}, nan));
    EXPECT_FALSE(scene.world->cast_ray({0, 10, 0}, {0, -1, 0}, -1));
    EXPECT_FALSE(scene.world->drop_distance(scene.body, nan));
    EXPECT_FALSE(scene.world->drop_distance(scene.body, -1));
}

TEST(BadNumbers, EnumsOutOfTheirRangeAreRefused) {
    Scene scene;
    BodyDefinition definition = scene.world->body(scene.body).value();
    definition.kind = static_cast<BodyKind>(7);
    EXPECT_EQ(scene.world->set_body(scene.body, definition).error().where, "kind");
    definition = scene.world->body(scene.body).value();
    definition.material.friction_combine = static_cast<CombineRule>(9);
    EXPECT_EQ(scene.world->set_body(scene.body, definition).error().where, "material.friction_combine");
    WorldSettings settings;
    settings.substeps = 0;
    EXPECT_EQ(scene.world->set_settings(settings).error().where, "substeps");
    settings = {.workers = -1};
    EXPECT_EQ(scene.world->set_settings(settings).error().where, "workers");
    settings = {.lanes = 5};
    EXPECT_EQ(scene.world->set_settings(settings).error().where, "lanes");
}

}  // namespace
}  // namespace embody::physics
