// SPDX-License-Identifier: MIT
// What users say of deformables: each number out of its range and each index that names nothing is refused by its
// field, and what is within is not.
#include "physics/definitions/deformable_definition.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "physics/definitions/deformable_primitives.h"
#include "physics/definitions/field_check.h"

namespace embody::physics {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

std::string field(const DeformableDefinition& definition) {
    const Result<void> result = validate(definition);
    return result ? "" : result.error().where;
}

/// A number of the matter with the range that its comment says.
template <class Matter>
struct Range {
    const char* name;
    double Matter::*number;
    double lowest, highest;
};

template <class Matter>
void check_ranges(const DeformableDefinition& good, const std::vector<Range<Matter>>& ranges) {
    ASSERT_EQ(field(good), "");
    for (const Range<Matter>& range : ranges) {
        const auto field_with = [&](double value) {
            DeformableDefinition definition = good;
            std::get<Matter>(definition.matter).*range.number = value;
            return field(definition);
        };
        EXPECT_EQ(field_with(range.lowest), "") << range.name;
        EXPECT_EQ(field_with(range.highest), "") << range.name;
        const double beyond = 1e-3 * (range.highest - range.lowest);
        for (const double bad : {range.lowest - beyond, range.highest + beyond, nan, infinite, -infinite}) {
            EXPECT_EQ(field_with(bad), range.name) << bad;
        }
    }
}

// Beyond such a limit something happens; infinite says that it never does.
template <class Matter>
void check_limit(const DeformableDefinition& good, const char* name, double Matter::*limit) {
    for (const auto& [value, refused] : {std::pair{infinite, ""}, {1e-9, ""}, {0.0, name}, {-1.0, name}, {nan, name}}) {
        DeformableDefinition definition = good;
        std::get<Matter>(definition.matter).*limit = value;
        EXPECT_EQ(field(definition), refused) << name << " " << value;
    }
}

DeformableDefinition good_sheet() { return cloth_rectangle(1, 0.5, 0.25); }
DeformableDefinition good_rope() { return rope_between({0, 0, 0}, {0, 0, 1}, 0.25); }
DeformableDefinition good_solid() { return tetrahedral_brick({1, 1, 1}, {2, 1, 1}); }

TEST(DeformableMatter, NumbersOutOfRangeAreRefusedByName) {
    check_ranges<SoftSolid>(good_solid(), {{"density", &SoftSolid::density, 0.1, 22600},
                                           {"youngs_modulus", &SoftSolid::youngs_modulus, 100, 1e12},
                                           {"poisson_ratio", &SoftSolid::poisson_ratio, -0.9, 0.495},
                                           {"rayleigh_damping", &SoftSolid::rayleigh_damping, 0, 100},
                                           {"internal_pressure", &SoftSolid::internal_pressure, 0, 1e8}});
    check_ranges<Cloth>(good_sheet(), {{"area_density", &Cloth::area_density, 1e-4, 1000},
                                       {"thickness", &Cloth::thickness, 1e-6, 0.1},
                                       {"stretch_stiffness", &Cloth::stretch_stiffness, 1e-3, 1e9},
                                       {"shear_stiffness", &Cloth::shear_stiffness, 1e-3, 1e9},
                                       {"bend_stiffness", &Cloth::bend_stiffness, 1e-9, 1e6},
                                       {"bend_friction", &Cloth::bend_friction, 0, 1e6},
                                       {"prestretch", &Cloth::prestretch, 1, 2},
                                       {"rayleigh_damping", &Cloth::rayleigh_damping, 0, 100},
                                       {"drag_coefficient", &Cloth::drag_coefficient, 0, 10}});
    check_ranges<Rope>(good_rope(), {{"diameter", &Rope::diameter, 1e-4, 1},
                                     {"linear_density", &Rope::linear_density, 1e-6, 1e4},
                                     {"axial_stiffness", &Rope::axial_stiffness, 1e-3, 1e12},
                                     {"bend_rigidity", &Rope::bend_rigidity, 1e-12, 1e9},
                                     {"twist_rigidity", &Rope::twist_rigidity, 1e-12, 1e9},
                                     {"rayleigh_damping", &Rope::rayleigh_damping, 0, 100},
                                     {"slack", &Rope::slack, 0, 10}});
    check_limit<SoftSolid>(good_solid(), "yield_stress", &SoftSolid::yield_stress);
    check_limit<Cloth>(good_sheet(), "bend_yield", &Cloth::bend_yield);
    check_limit<Cloth>(good_sheet(), "tear_strength", &Cloth::tear_strength);
    check_limit<Cloth>(good_sheet(), "tear_energy", &Cloth::tear_energy);
    check_limit<Rope>(good_rope(), "break_tension", &Rope::break_tension);
    check_limit<Rope>(good_rope(), "bend_yield", &Rope::bend_yield);
}

TEST(DeformableMatter, ElementsHaveNodesAndAnExtent) {
    DeformableDefinition bad = good_sheet();
    std::get<Cloth>(bad.matter).triangles.clear();
    EXPECT_EQ(field(bad), "triangles");
    bad = good_sheet();
    std::get<Cloth>(bad.matter).triangles[2] = {0, 1, 1};
    EXPECT_EQ(field(bad), "triangles[2]") << "an edge is no triangle";
    bad = good_solid();
    std::get<SoftSolid>(bad.matter).tetrahedra[1] = {0, 1, 3, 4};
    EXPECT_EQ(field(bad), "tetrahedra[1]") << "four corners of a face of the brick are flat";
    bad = good_solid();
    bad.nodes.push_back({5, 5, 5});
    EXPECT_EQ(field(bad), "nodes[" + std::to_string(bad.nodes.size() - 1) + "]") << "of no element";
    bad = good_rope();
    bad.nodes.resize(1);
    EXPECT_EQ(field(bad), "nodes");
    bad = good_rope();
    bad.nodes[2] = bad.nodes[1];
    EXPECT_EQ(field(bad), "nodes[2]") << "a segment without length";
    // A tetrahedron may be turned inside out: its corners have no order.
    DeformableDefinition turned = good_solid();
    std::swap(std::get<SoftSolid>(turned.matter).tetrahedra[0][0], std::get<SoftSolid>(turned.matter).tetrahedra[0][1]);
    EXPECT_EQ(field(turned), "");
}

TEST(DeformableHolds, NameANodeThatNothingElseHolds) {
    const BodyHandle body{1, 1};
    DeformableDefinition rope = good_rope();
    rope.pinned = {0};
    rope.attachments = {{1, body, {}}};
    EXPECT_EQ(field(rope), "");
    for (const std::uint32_t node : {0u, 1u, 99u}) {
        DeformableDefinition bad = rope;
        bad.attachments.push_back({node, body, {}});
        EXPECT_EQ(field(bad), "attachments[1]") << node;
        bad = rope;
        bad.ties = {{.node = node, .other = {1, 1}}};
        EXPECT_EQ(field(bad), "ties[0]") << node;
    }
    DeformableDefinition bad = rope;
    bad.attachments[0].anchor.y = nan;
    EXPECT_EQ(field(bad), "attachments[0].y");
    bad = rope;
    bad.ties = {{.node = 2, .other = {1, 1}}, {.node = 2, .other = {1, 1}}};
    EXPECT_EQ(field(bad), "ties[1]") << "tied twice";
}

TEST(DeformableHolds, TiesWeighTheirNodesTogetherAsOne) {
    const auto with = [](std::array<double, 3> weight) {
        DeformableDefinition rope = good_rope();
        rope.ties = {{.node = 1, .other = {1, 1}, .other_nodes = {0, 1, 2}, .weight = weight}};
        return field(rope);
    };
    EXPECT_EQ(with({1, 0, 0}), "");
    EXPECT_EQ(with({0.25, 0.25, 0.5}), "");
    for (const std::array<double, 3>& bad :
         {std::array{0.5, 0.0, 0.0}, {1.0, 1.0, 0.0}, {2.0, -1.0, 0.0}, {nan, 0.5, 0.5}, {0.0, 0.0, 0.0}}) {
        EXPECT_EQ(with(bad), "ties[0].weight") << bad[0];
    }
    DeformableDefinition solid = good_solid();
    solid.ties = {{.node = 0, .other = {1, 1}}};
    EXPECT_EQ(field(solid), "ties") << "only sheets and ropes are tied";
}

TEST(DeformableHolds, ClampsAreOfHeldNodesOfRopes) {
    DeformableDefinition rope = good_rope();
    rope.pinned = {0};
    rope.clamps = {{0, {0, 0, 1}}};
    EXPECT_EQ(field(rope), "");
    const auto with = [&](std::vector<Clamp> clamps) {
        DeformableDefinition definition = rope;
        definition.clamps = std::move(clamps);
        return field(definition);
    };
    EXPECT_EQ(with({{99, {0, 0, 1}}}), "clamps[0]");
    EXPECT_EQ(with({{1, {0, 0, 1}}}), "clamps[0]") << "nothing holds that node";
    EXPECT_EQ(with({{0, {0, 0, 1}}, {0, {0, 0, 1}}}), "clamps[1]") << "clamped twice";
    EXPECT_EQ(with({{0, {0, 0, 2}}}), "clamps[0].direction");
    EXPECT_EQ(with({{0, {0, nan, 0}}}), "clamps[0].direction");
    DeformableDefinition sheet = good_sheet();
    sheet.pinned = {0};
    sheet.clamps = {{0, {0, 0, 1}}};
    EXPECT_EQ(field(sheet), "clamps") << "a sheet has no direction to hold";
}

TEST(DeformableDefinitions, RefuseMotionAndPlaceOutOfRange) {
    const auto with = [](const std::function<void(DeformableDefinition&)>& change) {
        DeformableDefinition definition = good_solid();
        change(definition);
        return field(definition);
    };
    EXPECT_EQ(with([](auto& d) { d.pose.position.x = 2 * largest_coordinate; }), "pose.position.x");
    EXPECT_EQ(with([](auto& d) { d.pose.rotation = {0, 0, 0, 0}; }), "pose.rotation");
    EXPECT_EQ(with([](auto& d) { d.linear_velocity.y = 2 * largest_linear_speed; }), "linear_velocity.y");
    EXPECT_EQ(with([](auto& d) { d.angular_velocity.z = -2 * largest_angular_speed; }), "angular_velocity.z");
    EXPECT_EQ(with([](auto& d) { d.force.x = nan; }), "force.x");
    EXPECT_EQ(with([](auto& d) { d.pinned = {99}; }), "pinned[0]");
    EXPECT_EQ(with([](auto& d) { d.nodes.clear(); }), "nodes");
}

}  // namespace
}  // namespace embody::physics
