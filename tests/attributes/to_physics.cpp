// SPDX-License-Identifier: MIT
#include "attributes/to_physics.h"

#include <gtest/gtest.h>

#include "attributes/physical_kind.h"
#include "attributes/resolver.h"
#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

// Geometry of a unit tetrahedron, or the error that the file is gone.
class SampleGeometry : public ModelGeometry {
public:
    bool broken = false;
    Result<std::vector<Vec3>> hull_points() override {
        if (broken) return Error{"model", "is gone"};
        return std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    }
    // The box [0, 1]³ in as many slices as are allowed.
    Result<std::vector<std::vector<Vec3>>> convex_parts(int max_hulls, double hull_error) override {
        if (broken) return Error{"model", "is gone"};
        asked_error = hull_error;
        std::vector<std::vector<Vec3>> parts(static_cast<std::size_t>(max_hulls));
        for (int k = 0; k < max_hulls; ++k) {
            for (int i = 0; i < 8; ++i) {
                parts[static_cast<std::size_t>(k)].push_back(
                    {(k + (i & 1 ? 1.0 : 0.0)) / max_hulls, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
            }
        }
        return parts;
    }
    double asked_error = 0;
    Result<physics::MeshShape> mesh() override {
        if (broken) return Error{"model", "is gone"};
        return physics::MeshShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    }
};

AttributeSet with_word(const ModelFacts& facts, const char* name, const char* word) {
    AttributeSet set = resolve(shipped_taxonomy(), facts);
    set.put({name, std::string(word), {}, {}, "test", AttributeLevel::manual});
    return set;
}

TEST(ToPhysics, WhatIsOnlyDrawnHasNoBody) {
    const auto body = body_from_attributes(resolve(shipped_taxonomy(), named("White light source")));
    ASSERT_FALSE(body.ok());
    EXPECT_EQ(body.error().where, "kind");
}

TEST(ToPhysics, MovingThingsMayNotBeTriangles) {
    SampleGeometry geometry;
    const ModelFacts facts = named("Chair");
    EXPECT_FALSE(shape_from_attributes(with_word(facts, "collision_shape", "trimesh"), facts.geometry, geometry).ok());
    EXPECT_FALSE(shape_from_attributes(with_word(facts, "collision_shape", "blob"), facts.geometry, geometry).ok());
}

TEST(ToPhysics, MissingGeometryIsAnErrorNotAnEmptyShape) {
    SampleGeometry geometry;
    geometry.broken = true;
    const ModelFacts chair = named("Chair");
    EXPECT_FALSE(shape_from_attributes(resolve(shipped_taxonomy(), chair), chair.geometry, geometry).ok());
    const ModelFacts door = named("Door");
    EXPECT_FALSE(shape_from_attributes(resolve(shipped_taxonomy(), door), door.geometry, geometry).ok());
}

TEST(ToPhysics, EveryKindWithABodyPassesThePhysicsOwnCheck) {
    SampleGeometry geometry;
    for (const char* name : {"Chair", "Door", "Curtain", "Teddy bear", "Male", "Hatchback", "xyzzy", "Rug", "Rock"}) {
        const ModelFacts facts = closed_box(name, {0.5, 0.7, 0.3});
        const AttributeSet set = resolve(shipped_taxonomy(), facts);
        const auto body = body_from_attributes(set);
        ASSERT_TRUE(body.ok()) << name << ": " << body.error().message();
        const auto valid = physics::validate(*body);
        EXPECT_TRUE(valid.ok()) << name << ": " << valid.error().message();
        const auto shape = shape_from_attributes(set, facts.geometry, geometry);
        ASSERT_TRUE(shape.ok()) << name << ": " << shape.error().message();
        EXPECT_TRUE(physics::validate(*shape).ok()) << name;
        EXPECT_EQ(body->kind == physics::BodyKind::static_body, kind_of(set) == PhysicalKind::static_body) << name;
        EXPECT_DOUBLE_EQ(*body->mass.mass, set.number("mass", 0));
    }
}

TEST(ToPhysics, EmptySetGivesABodyWithDefaults) {
    const auto body = body_from_attributes({});
    ASSERT_TRUE(body.ok());
    EXPECT_EQ(body->kind, physics::BodyKind::dynamic_body);
    EXPECT_FALSE(body->mass.mass.has_value());
    EXPECT_EQ(body->material.friction_static, 0.5);
    EXPECT_EQ(body->collision_mask, 0xFFFFFFFFu);
}

TEST(ToPhysics, FittedPrimitiveStandsWhereItWasFitted) {
    SampleGeometry geometry;
    const ModelFacts facts = closed_box("Crate", {0.6, 0.4, 0.5});
    const auto shape = shape_from_attributes(resolve(shipped_taxonomy(), facts), facts.geometry, geometry);
    ASSERT_TRUE(shape.ok());
    const auto& compound = std::get<physics::CompoundShape>(*shape);
    ASSERT_EQ(compound.children.size(), 1u);
    EXPECT_EQ(compound.children[0].local.position, (Vec3{0, 0.2, 0}));
    EXPECT_EQ(std::get<physics::BoxShape>(compound.children[0].shape).half_extents, (Vec3{0.3, 0.2, 0.25}));
}

TEST(ToPhysics, PrimitiveThatWasNotFittedSurroundsTheBox) {
    SampleGeometry geometry;
    const ModelFacts facts = named("Chair", {0.4, 1.0, 0.4});
    for (const char* shape : {"sphere", "capsule", "cylinder", "box"}) {
        const auto made = shape_from_attributes(with_word(facts, "collision_shape", shape), facts.geometry, geometry);
        ASSERT_TRUE(made.ok()) << shape;
        EXPECT_TRUE(physics::validate(*made).ok()) << shape;
        EXPECT_EQ(std::get<physics::CompoundShape>(*made).children[0].local.position, (Vec3{0, 0.5, 0})) << shape;
    }
}

TEST(ToPhysics, ADecompositionIsACompoundOfHullsWithinItsLimits) {
    SampleGeometry geometry;
    const ModelFacts facts = named("Table");
    AttributeSet set = with_word(facts, "collision_shape", "decomposition");
    set.put({"max_hulls", 5.0, {}, {}, "test", AttributeLevel::manual});
    set.put({"hull_error", 0.02, {}, {}, "test", AttributeLevel::manual});
    const auto shape = shape_from_attributes(set, facts.geometry, geometry);
    ASSERT_TRUE(shape.ok()) << shape.error().message();
    const auto& compound = std::get<physics::CompoundShape>(*shape);
    ASSERT_EQ(compound.children.size(), 5u);
    EXPECT_EQ(std::get<physics::HullShape>(compound.children[4].shape).points.back(), (Vec3{1, 1, 1}));
    EXPECT_TRUE(physics::validate(*shape).ok());
    EXPECT_EQ(geometry.asked_error, 0.02);

    // With one part the hull is that of all points.
    set.put({"max_hulls", 1.0, {}, {}, "test", AttributeLevel::manual});
    const auto one = shape_from_attributes(set, facts.geometry, geometry);
    ASSERT_TRUE(one.ok());
    EXPECT_TRUE(std::holds_alternative<physics::HullShape>(*one));
    geometry.broken = true;
    EXPECT_FALSE(shape_from_attributes(set, facts.geometry, geometry).ok());
}

TEST(ToPhysics, FlatThingsBecomeThinBoxes) {
    SampleGeometry geometry;
    const ModelFacts facts = named("Calendar", {0.3, 0.4, 0});
    const auto shape = shape_from_attributes(resolve(shipped_taxonomy(), facts), facts.geometry, geometry);
    ASSERT_TRUE(shape.ok());
    const auto& compound = std::get<physics::CompoundShape>(*shape);
    EXPECT_TRUE(std::holds_alternative<physics::BoxShape>(compound.children[0].shape));
    EXPECT_TRUE(physics::validate(*shape).ok());
}

TEST(ToPhysics, CombineRulesAndFlagsArriveInThePhysics) {
    AttributeSet set = with_word(named("Chair"), "friction_combine", "minimum");
    set.put({"restitution_combine", std::string("average"), {}, {}, "", AttributeLevel::manual});
    set.put({"kinematic", true, {}, {}, "", AttributeLevel::manual});
    set.put({"continuous", true, {}, {}, "", AttributeLevel::manual});
    set.put({"gravity_factor", -1.0, {}, {}, "", AttributeLevel::manual});
    const auto body = body_from_attributes(set);
    ASSERT_TRUE(body.ok());
    EXPECT_EQ(body->material.friction_combine, physics::CombineRule::minimum);
    EXPECT_EQ(body->material.restitution_combine, physics::CombineRule::average);
    EXPECT_EQ(body->kind, physics::BodyKind::kinematic_body);
    EXPECT_TRUE(body->continuous);
    EXPECT_EQ(body->gravity_factor, -1);
}

geometry::TetrahedralMesh unit_tetrahedron() {
    geometry::TetrahedralMesh mesh;
    mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    return mesh;
}

TEST(ToPhysics, SoftThingsWeighWhatTheirMassSaysWhateverTheTetrahedraMiss) {
    for (const char* name : {"Teddy bear", "Cushion", "Air mattress"}) {
        AttributeSet set = resolve(shipped_taxonomy(), closed_box(name, {0.5, 0.7, 0.3}));
        set.put({"mass", 4.0, {}, {}, "test", AttributeLevel::manual});
        const auto soft = soft_solid_from_attributes(set, unit_tetrahedron());
        ASSERT_TRUE(soft.ok()) << name << ": " << soft.error().message();
        EXPECT_TRUE(physics::validate(*soft).ok()) << name;
        EXPECT_DOUBLE_EQ(std::get<physics::SoftSolid>(soft->matter).density, 4.0 * 6) << "in a sixth of a cubic metre";
        EXPECT_EQ(soft->material.friction_dynamic, set.number("friction_dynamic", -1));
        EXPECT_EQ(soft->material.friction_static, set.number("friction_static", -1));
    }
}

TEST(ToPhysics, SoftAttributesArriveWithinWhatTheSolverTakes) {
    AttributeSet set;
    const auto put = [&set](const char* name, double value) {
        set.put({name, value, {}, {}, "test", AttributeLevel::manual});
    };
    put("mass", 2);
    put("youngs_modulus", 3e4);
    put("damping_rayleigh", 0.02);
    put("internal_pressure", 500);
    put("gravity_factor", 0.5);
    put("collision_group", 6);
    for (const auto& [told, taken] : {std::pair{0.4999, 0.495}, {-0.99, -0.9}, {0.3, 0.3}}) {
        put("poisson_ratio", told);
        put("yield_stress", 0);
        const auto soft = soft_solid_from_attributes(set, unit_tetrahedron());
        ASSERT_TRUE(soft.ok()) << soft.error().message();
        const auto& solid = std::get<physics::SoftSolid>(soft->matter);
        EXPECT_EQ(solid.poisson_ratio, taken);
        EXPECT_EQ(solid.youngs_modulus, 3e4);
        EXPECT_EQ(solid.rayleigh_damping, 0.02);
        EXPECT_EQ(solid.internal_pressure, 500);
        EXPECT_EQ(soft->gravity_factor, 0.5);
        EXPECT_EQ(soft->collision_group, 6u);
        EXPECT_TRUE(physics::validate(*soft).ok());
    }
    put("mass", 1e7);
    const auto too_dense = soft_solid_from_attributes(set, unit_tetrahedron());
    ASSERT_FALSE(too_dense.ok());
    EXPECT_EQ(too_dense.error().where, "mass");
    // Just above the largest density of matter: the message has enough digits to show the difference.
    put("mass", 22601.0 / 6);
    EXPECT_NE(soft_solid_from_attributes(set, unit_tetrahedron()).error().message().find("22601"), std::string::npos);
}

TEST(ToPhysics, WhatNobodySetTheMassOfAndIsTooLargeOrSmallSaysWhatItWouldWeigh) {
    for (const auto& [size, would_weigh] : {std::pair{1000.0, "1.67e+11 kg"}, {1e-6, "1.67e-16 kg"}}) {
        AttributeSet set;
        set.put({"mass", 1.0, {}, {}, "default", AttributeLevel::standard});
        geometry::TetrahedralMesh mesh = unit_tetrahedron();
        for (Vec3& node : mesh.nodes) node *= size;
        const auto soft = soft_solid_from_attributes(set, mesh);
        ASSERT_FALSE(soft.ok());
        EXPECT_EQ(soft.error().where, "mass");
        EXPECT_NE(soft.error().message().find(would_weigh), std::string::npos) << soft.error().message();
    }
}

TEST(ToPhysics, ClothWeighsWhatItsMassSaysOnAnySheet) {
    SheetMesh sheet;
    sheet.nodes = {{0, 0, 0}, {2, 0, 0}, {2, 0, 3}, {0, 0, 3}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    AttributeSet set = resolve(shipped_taxonomy(), closed_box("Curtain", {2, 3, 0.01}));
    ASSERT_EQ(kind_of(set), PhysicalKind::cloth);
    set.put({"mass", 1.5, {}, {}, "test", AttributeLevel::manual});
    auto made = cloth_from_attributes(set, sheet);
    ASSERT_TRUE(made.ok()) << made.error().message();
    EXPECT_TRUE(physics::validate(*made).ok());
    const auto& cloth = std::get<physics::Cloth>(made->matter);
    EXPECT_DOUBLE_EQ(cloth.area_density, 1.5 / 6);
    EXPECT_EQ(cloth.stretch_stiffness, set.number("stretch_stiffness", -1));
    EXPECT_EQ(cloth.bend_stiffness, set.number("bend_stiffness", -1));
    EXPECT_EQ(cloth.bend_friction, set.number("bend_friction", 40));
    EXPECT_EQ(cloth.bend_yield, set.number("bend_yield", std::numeric_limits<double>::infinity()));
    EXPECT_EQ(cloth.thickness, set.number("thickness", -1));
    EXPECT_EQ(cloth.drag_coefficient, set.number("drag_coefficient", -1));
    set.put({"mass", 1e4, {}, {}, "test", AttributeLevel::manual});
    made = cloth_from_attributes(set, sheet);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().where, "mass");
}

TEST(ToPhysics, RopesWeighWhatTheirMassSaysAndBreakWhereTheyAreTold) {
    AttributeSet set = resolve(shipped_taxonomy(), closed_box("Rope", {0.02, 0.02, 4}));
    ASSERT_EQ(kind_of(set), PhysicalKind::rope);
    set.put({"mass", 0.8, {}, {}, "test", AttributeLevel::manual});
    set.put({"break_tension", 0.0, {}, {}, "test", AttributeLevel::manual});
    EXPECT_FALSE(std::isfinite(set.number("bend_yield", std::numeric_limits<double>::infinity()))) << "no wire";
    set.put({"bend_yield", 2.5, {}, {}, "test", AttributeLevel::manual});
    auto made = rope_from_attributes(set, {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}}, 0.02);
    ASSERT_TRUE(made.ok()) << made.error().message();
    EXPECT_TRUE(physics::validate(*made).ok());
    const auto& rope = std::get<physics::Rope>(made->matter);
    EXPECT_DOUBLE_EQ(rope.linear_density, 0.2);
    EXPECT_EQ(rope.diameter, 0.02);
    EXPECT_EQ(rope.axial_stiffness, set.number("axial_stiffness", -1));
    EXPECT_LT(rope.break_tension, 1e-3) << "by the slightest pull";
    EXPECT_EQ(rope.bend_yield, 2.5);
    set.put({"mass", 1e-6, {}, {}, "test", AttributeLevel::manual});
    made = rope_from_attributes(set, {{0, 0, 0}, {3, 0, 0}}, 0.02);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().where, "mass");
}

TEST(ToPhysics, AnAreaDensityOfAPersonMakesTheMass) {
    const ModelFacts facts = closed_box("Curtain", {2, 3, 0.01});
    const AttributeSet automatic = resolve(shipped_taxonomy(), facts);
    AttributeSet set = with_manual(automatic, {{"area_density", 0.5, {}, {}, "", AttributeLevel::manual}}, facts);
    EXPECT_DOUBLE_EQ(set.number("mass", 0), 3);
    set = with_manual(automatic, {{"kind", to_value(PhysicalKind::rope), {}, {}, "", AttributeLevel::manual}}, facts);
    EXPECT_DOUBLE_EQ(set.number("linear_density", 0), automatic.number("mass", 0) / 3) << "of the kind that it is now";
}

}  // namespace
}  // namespace embody::attributes
