// SPDX-License-Identifier: MIT
// What users fill in: each number out of its range is refused by its field, and nothing that is within.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "physics/definitions/body_definition.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/definitions/events.h"
#include "physics/definitions/field_check.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/handles.h"
#include "physics/definitions/joint_definition.h"
#include "physics/definitions/material.h"
#include "physics/definitions/shape_definition.h"
#include "physics/definitions/step_account.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/surface_pairs.h"
#include "physics/definitions/world_settings.h"

namespace embody::physics {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

std::string field(const Result<void>& result) { return result ? "" : result.error().where; }

/// A number of a definition with the range that its comment says.
template <class Definition>
struct Range {
    const char* name;
    double lowest, highest;
    std::function<void(Definition&, double)> set;
};

// Both ends are good; what is beyond them, and what is no number, is refused by name.
template <class Definition>
void check_ranges(const Definition& good, std::initializer_list<Range<Definition>> ranges) {
    ASSERT_EQ(field(validate(good)), "");
    for (const Range<Definition>& range : ranges) {
        const auto field_with = [&](double value) {
            Definition definition = good;
            range.set(definition, value);
            return field(validate(definition));
        };
        EXPECT_EQ(field_with(range.lowest), "") << range.name;
        EXPECT_EQ(field_with(range.highest), "") << range.name;
        const double beyond = 1e-3 * (range.highest - range.lowest);
        for (const double bad : {range.lowest - beyond, range.highest + beyond, nan, infinite, -infinite, 1e-310}) {
            EXPECT_EQ(field_with(bad), range.name) << bad;
        }
    }
}

TEST(FieldChecks, NameTheFieldAndSayWhatIsAllowed) {
    EXPECT_TRUE(check_number("mass", 0, 0, 1));
    EXPECT_TRUE(check_number("mass", -0.0, 0, 1));
    for (const double bad : {-0.1, 1.1, nan, infinite, -infinite, 5e-324}) {
        const auto refused = check_number("mass", bad, 0, 1, "kg");
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().where, "mass");
        EXPECT_FALSE(refused.error().why.empty());
    }
    EXPECT_EQ(field(check_vector("p", {0, nan, 0}, 1)), "p.y");
    EXPECT_EQ(field(check_vector("p", {0, 0, 2}, 1)), "p.z");
    EXPECT_TRUE(check_vector("p", {1, -1, 0}, 1));
    EXPECT_EQ(field(check_rotation("r", {0, 0, 0, 0})), "r");
    EXPECT_FALSE(check_rotation("r", {0, nan, 0, 1}));
    EXPECT_TRUE(check_rotation("r", {0, 3, 0, 4}));
    const Result<void> good, bad = Error{"b", "is bad"}, worse = Error{"c", "is worse"};
    EXPECT_EQ(field(first_error(good, bad, worse)), "b");
    EXPECT_TRUE(first_error(good, good));
}

TEST(MaterialDefinition, RefusesWhatIsOutOfRange) {
    Material good;
    good.friction_dynamic = 0;
    good.friction_static = 2;
    check_ranges<Material>(
        good, {{"friction_static", 0, 2, [](auto& m, double x) { m.friction_static = x; }},
               {"friction_dynamic", 0, 2, [](auto& m, double x) { m.friction_dynamic = x; }},
               {"friction_rolling", 0, 0.05, [](auto& m, double x) { m.friction_rolling = x; }},
               {"friction_rolling_on_others", 0, 0.05, [](auto& m, double x) { m.friction_rolling_on_others = x; }},
               {"friction_torsional", 0, 0.1, [](auto& m, double x) { m.friction_torsional = x; }},
               {"restitution", 0, 1, [](auto& m, double x) { m.restitution = x; }},
               {"restitution_threshold", 0, 10, [](auto& m, double x) { m.restitution_threshold = x; }}});
    good.friction_dynamic = 0.5;
    good.friction_static = 0.4;
    EXPECT_EQ(field(validate(good)), "friction_static");
}

TEST(MaterialDefinition, PairsAreSymmetricAndByTheLaterRule) {
    SurfacePairs pairs;
    EXPECT_EQ(field(pairs.set(0, 1, {})), "surface");
    EXPECT_EQ(field(pairs.set(1, 2, {.friction_static = 3})), "friction_static");
    EXPECT_EQ(field(pairs.set(1, 2, {.friction_static = 0.1, .friction_dynamic = 0.2})), "friction_static");
    ASSERT_TRUE(pairs.set(3, 1, {.friction_static = 0.3, .friction_dynamic = 0.2, .restitution = 0.7}));
    ASSERT_NE(pairs.find(1, 3), nullptr);
    EXPECT_EQ(pairs.find(1, 3)->restitution, 0.7);
    EXPECT_EQ(pairs.find(3, 1), pairs.find(1, 3));
    EXPECT_EQ(pairs.find(1, 2), nullptr);
    EXPECT_EQ(pairs.find(200, 1), nullptr);
    Material a, b;
    a.friction_static = a.friction_dynamic = 0.2;
    b.friction_static = b.friction_dynamic = 0.8;
    const auto friction = [&](CombineRule rule) {
        a.friction_combine = rule;
        b.friction_combine = CombineRule::pair_table;
        const double one = combine(a, b, pairs).friction_static, other = combine(b, a, pairs).friction_static;
        EXPECT_EQ(one, other);
        return one;
    };
    EXPECT_NEAR(friction(CombineRule::geometric_mean), 0.4, 1e-12);
    EXPECT_NEAR(friction(CombineRule::average), 0.5, 1e-12);
    EXPECT_NEAR(friction(CombineRule::minimum), 0.2, 1e-12);
    EXPECT_NEAR(friction(CombineRule::maximum), 0.8, 1e-12);
    EXPECT_NEAR(friction(CombineRule::multiply), 0.16, 1e-12);
    EXPECT_NEAR(friction(CombineRule::own), 0.2, 1e-12);
    // The table, where both ask it; the later rule, where one asks another.
    a.surface = 1;
    b.surface = 3;
    EXPECT_NEAR(friction(CombineRule::pair_table), 0.3, 1e-12);
    EXPECT_NEAR(friction(CombineRule::maximum), 0.8, 1e-12);
}

TEST(BodyDefinitions, RefuseWhatIsOutOfRange) {
    check_ranges<BodyDefinition>(
        {}, {{"linear_damping", 0, 100, [](auto& d, double x) { d.linear_damping = x; }},
             {"angular_damping", 0, 100, [](auto& d, double x) { d.angular_damping = x; }},
             {"drag_area", 0, 1e8, [](auto& d, double x) { d.drag_area = x; }},
             {"gravity_factor", -10, 10, [](auto& d, double x) { d.gravity_factor = x; }},
             {"mass.mass", 1e-6, 1e9, [](auto& d, double x) { d.mass.mass = x; }},
             {"position.y", -largest_coordinate, largest_coordinate, [](auto& d, double x) { d.position.y = x; }},
             {"linear_velocity.x", -largest_linear_speed, largest_linear_speed,
              [](auto& d, double x) { d.linear_velocity.x = x; }},
             {"angular_velocity.z", -largest_angular_speed, largest_angular_speed,
              [](auto& d, double x) { d.angular_velocity.z = x; }},
             {"force.x", -largest_force, largest_force, [](auto& d, double x) { d.force.x = x; }},
             {"torque.x", -largest_force, largest_force, [](auto& d, double x) { d.torque.x = x; }}});
    BodyDefinition body;
    body.rotation = {0, 0, 0, 0};
    EXPECT_EQ(field(validate(body)), "rotation");
    body = {};
    body.material.restitution = 2;
    EXPECT_EQ(field(validate(body)), "material.restitution");
    const auto inertia = [&](const Mat3& value) {
        body = {};
        body.mass.inertia = value;
        return field(validate(body));
    };
    EXPECT_EQ(inertia(Mat3::identity()), "");
    EXPECT_EQ(inertia(Mat3::zero()), "mass.inertia");
    EXPECT_EQ(inertia({{1, 0.5, 0}, {0, 1, 0}, {0, 0, 1}}), "mass.inertia");  // not symmetric
    EXPECT_EQ(inertia({{1, 0, 0}, {0, 1, 0}, {0, 0, 3}}), "mass.inertia");    // no matter has it
}

TEST(JointDefinitions, RefuseWhatIsOutOfRange) {
    JointDefinition good{.joint = HingeJoint{JointLimit{-1, 1}, JointMotor{2, 3}}, .body_b = {1, 1}};
    check_ranges<JointDefinition>(good,
                                  {{"joint.motor.max_force", 0, largest_force,
                                    [](auto& d, double x) { std::get<HingeJoint>(d.joint).motor->max_force = x; }},
                                   {"joint.motor.speed", -largest_angular_speed, largest_angular_speed,
                                    [](auto& d, double x) { std::get<HingeJoint>(d.joint).motor->speed = x; }},
                                   {"frame_a.position.x", -largest_coordinate, largest_coordinate,
                                    [](auto& d, double x) { d.frame_a.position.x = x; }}});
    std::get<HingeJoint>(good.joint).limit = JointLimit{1, -1};
    EXPECT_EQ(field(validate(good)), "joint.limit.lower");
    EXPECT_EQ(field(validate(JointDefinition{})), "body_b");
    JointDefinition same{.body_a = {1, 1}, .body_b = {1, 1}};
    EXPECT_EQ(field(validate(same)), "body_a");
    same.body_a = {};
    same.frame_b.rotation = {0, 0, 0, 0};
    EXPECT_EQ(field(validate(same)), "frame_b.rotation");
}

TEST(FluidDefinitions, RefuseWhatIsOutOfRange) {
    const FluidDefinition good{.boxes = {{{0, 0, 0}, {1, 1, 1}}}};
    check_ranges<FluidDefinition>(good, {{"density", 1, 25000, [](auto& d, double x) { d.density = x; }},
                                         {"viscosity", 0, 10000, [](auto& d, double x) { d.viscosity = x; }},
                                         {"yield_stress", 0, 10000, [](auto& d, double x) { d.yield_stress = x; }},
                                         {"surface_tension", 0, 10, [](auto& d, double x) { d.surface_tension = x; }},
                                         {"cell_size", 0.001, 1, [](auto& d, double x) { d.cell_size = x; }},
                                         {"gravity_factor", -10, 10, [](auto& d, double x) { d.gravity_factor = x; }}});
    EXPECT_EQ(field(validate(FluidDefinition{})), "boxes");
    EXPECT_TRUE((FluidIds{3, 5}.contains(3)));
    EXPECT_FALSE((FluidIds{3, 5}.contains(5)));
}

TEST(WorldSettingsDefinition, RefuseWhatIsOutOfRange) {
    check_ranges<WorldSettings>(
        {}, {{"time_step", 1e-5, 0.1, [](auto& s, double x) { s.time_step = x; }},
             {"gustiness", 0, 2, [](auto& s, double x) { s.gustiness = x; }},
             {"gust_time", 0.05, 1000, [](auto& s, double x) { s.gust_time = x; }},
             {"air_density", 0, 100, [](auto& s, double x) { s.air_density = x; }},
             {"time_to_sleep", 0.05, 60, [](auto& s, double x) { s.time_to_sleep = x; }},
             {"max_linear_speed", 1, largest_linear_speed, [](auto& s, double x) { s.max_linear_speed = x; }},
             {"gravity.y", -1e4, 1e4, [](auto& s, double x) { s.gravity.y = x; }}});
    const auto with = [](auto change) {
        WorldSettings settings;
        change(settings);
        return field(validate(settings));
    };
    EXPECT_EQ(with([](auto& s) { s.substeps = 0; }), "substeps");
    EXPECT_EQ(with([](auto& s) { s.deformable_substeps = 65; }), "deformable_substeps");
    EXPECT_EQ(with([](auto& s) { s.workers = -1; }), "workers");
    EXPECT_EQ(with([](auto& s) { s.lanes = 5; }), "lanes");
}

TEST(ShapeDefinitions, RefuseWhatHasNoSize) {
    const auto refused = [](const ShapeDefinition& shape) { return field(validate(shape)); };
    for (const double bad : {0.0, -1.0, nan, infinite}) {
        EXPECT_EQ(refused(SphereShape{bad}), "radius");
        EXPECT_EQ(refused(BoxShape{{1, bad, 1}}), "half_extents.y");
        EXPECT_EQ(refused(CapsuleShape{1, bad}), "half_height");
        EXPECT_EQ(refused(CylinderShape{bad, 1}), "radius");
        EXPECT_EQ(refused(ConeShape{1, bad}), "half_height");
    }
    EXPECT_EQ(refused(PlaneShape{{0, 0, 0}, 0}), "normal");
    EXPECT_EQ(refused(PlaneShape{{0, 1, 0}, nan}), "offset");
    EXPECT_EQ(refused(HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}), "points");
    EXPECT_EQ(refused(HullShape{{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {0, 0, 1}}}), "points[2]");
    EXPECT_EQ(refused(HeightfieldShape{.columns = 1, .rows = 2, .heights = {0, 0}}), "columns");
    EXPECT_EQ(refused(HeightfieldShape{.columns = 2, .rows = 2, .heights = {0, 0, 0}}), "heights");
    EXPECT_EQ(refused(MeshShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}), "triangles[0]");
    EXPECT_EQ(refused(MeshShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}), "triangles");
    EXPECT_EQ(refused(CompoundShape{}), "children");
    EXPECT_STREQ(shape_name(BoxShape{}), "box");
    EXPECT_STREQ(shape_name(CompoundShape{}), "compound");
    EXPECT_TRUE(is_static_only(PlaneShape{}));
    EXPECT_FALSE(is_static_only(ConeShape{}));
}

TEST(DeformableDefinitions, RefuseNumbersAndIndicesOutOfRange) {
    const DeformableDefinition sheet = cloth_rectangle(1, 0.5, 0.1), rope = rope_between({0, 0, 0}, {0, 0, 1}, 0.1),
                               solid = tetrahedral_brick({1, 1, 1}, {2, 1, 1});
    for (const DeformableDefinition* good : {&sheet, &rope, &solid}) {
        check_ranges<DeformableDefinition>(
            *good, {{"gravity_factor", -10, 10, [](auto& d, double x) { d.gravity_factor = x; }},
                    {"friction_dynamic", 0, 2,
                     [](auto& d, double x) { d.material = {.friction_static = 2, .friction_dynamic = x}; }},
                    {"contact_radius", 1e-5, 1, [](auto& d, double x) { d.contact_radius = x; }}});
        DeformableDefinition bad = *good;
        bad.pinned = {static_cast<std::uint32_t>(bad.nodes.size())};
        EXPECT_FALSE(validate(bad));
        bad = *good;
        bad.nodes[1].x = nan;
        EXPECT_EQ(field(validate(bad)).substr(0, 8), "nodes[1]");
    }
    EXPECT_FALSE(validate(DeformableDefinition{}));
    DeformableDefinition bad = sheet;
    std::get<Cloth>(bad.matter).triangles[3][1] = 99999;
    EXPECT_FALSE(validate(bad));
    bad = solid;
    std::get<SoftSolid>(bad.matter).poisson_ratio = 0.5;
    EXPECT_FALSE(validate(bad));
    bad = rope;
    std::get<Rope>(bad.matter).diameter = 0;
    EXPECT_FALSE(validate(bad));
}

TEST(DeformablePrimitives, HaveTheSizeThatIsAskedFor) {
    const auto bounds = [](const DeformableDefinition& definition) {
        Bounds box;
        for (const Vec3 p : definition.nodes) box.add(p);
        return box.size();
    };
    const Vec3 sheet = bounds(cloth_rectangle(1, 0.5, 0.1)), disc = bounds(cloth_disc(0.4, 0.1));
    EXPECT_NEAR(sheet.x, 1, 1e-9);
    EXPECT_NEAR(sheet.z, 0.5, 1e-9);
    EXPECT_NEAR(sheet.y, 0, 1e-12);
    EXPECT_NEAR(disc.x, 0.8, 0.02);
    const DeformableDefinition rope = rope_between({1, 2, 3}, {1, 2, 4}, 0.3);
    EXPECT_EQ(rope.nodes.front(), (Vec3{1, 2, 3}));
    EXPECT_EQ(rope.nodes.back(), (Vec3{1, 2, 4}));
    for (std::size_t i = 1; i < rope.nodes.size(); ++i)
        EXPECT_LE(length(rope.nodes[i] - rope.nodes[i - 1]), 0.3 + 1e-12);
    const DeformableDefinition brick = tetrahedral_brick({1, 2, 3}, {2, 2, 1});
    double volume = 0;
    for (const auto& t : std::get<SoftSolid>(brick.matter).tetrahedra) {
        const Vec3 o = brick.nodes[t[0]];
        volume += std::fabs(dot(brick.nodes[t[1]] - o, cross(brick.nodes[t[2]] - o, brick.nodes[t[3]] - o))) / 6;
    }
    EXPECT_NEAR(volume, 6, 1e-9);
    EXPECT_EQ(std::get<SoftSolid>(brick.matter).tetrahedra.size(), 2u * 2 * 1 * 6);
}

TEST(DeformablePrimitives, ClosedSheetsEncloseTheirVolume) {
    const auto volume_of = [](const DeformableDefinition& sheet) {
        double volume = 0;
        for (const auto& t : std::get<Cloth>(sheet.matter).triangles)
            volume += dot(sheet.nodes[t[0]], cross(sheet.nodes[t[1]], sheet.nodes[t[2]])) / 6;
        return volume;
    };
    for (const double edge : {0.5, 0.1, 0.02}) {
        const DeformableDefinition ball = cloth_sphere(0.2, edge), box = cloth_box({0.3, 0.1, 0.2}, edge);
        const auto triangles = std::get<Cloth>(ball.matter).triangles.size();
        EXPECT_EQ(triangles, 2 * (ball.nodes.size() - 2)) << "as Euler's formula says of what is closed";
        for (const Vec3 node : ball.nodes) EXPECT_NEAR(length(node), 0.2, 1e-12);
        EXPECT_NEAR(volume_of(box), 0.006, 1e-12);
        EXPECT_EQ(std::get<Cloth>(box.matter).triangles.size(), 2 * (box.nodes.size() - 2));
    }
    EXPECT_NEAR(volume_of(cloth_sphere(0.2, 0.02)), 4.0 / 3 * std::numbers::pi * 0.008, 3e-4);
}

TEST(StepReports, BeginWithNothing) {
    const StepReport report;
    EXPECT_EQ(report.limits, static_cast<std::uint32_t>(StepLimit::none));
    EXPECT_FALSE(report.account);
    for (const double time : report.stage_milliseconds) EXPECT_EQ(time, 0);
    EXPECT_TRUE(BodyHandle{}.is_null());
    EXPECT_TRUE(SleepEvent{}.body.is_null());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < static_cast<std::size_t>(StepCause::count); ++i) {
        names.emplace_back(name_of(static_cast<StepCause>(i)));
        EXPECT_FALSE(names.back().empty());
    }
    std::ranges::sort(names);
    EXPECT_TRUE(std::ranges::adjacent_find(names) == names.end());
}

}  // namespace
}  // namespace embody::physics
