// SPDX-License-Identifier: MIT
// The mass of triangles that a person makes soft, granular and so on is that of the volume that they enclose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "scene/embody/entity_definitions.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using physics::BoxShape;
using physics::MeshShape;
using physics::ShapeDefinition;
using samples::make;
using samples::thing;

/// The surface of a box; the origin is one of its lowest corners.
MeshShape box_of_triangles(Vec3 half) {
    MeshShape mesh;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner{i & 4 ? 2.0 : 0.0, i & 2 ? 2.0 : 0.0, i & 1 ? 2.0 : 0.0};
        mesh.positions.push_back(to_vec3f(scale(corner, half)));
    }
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    return mesh;
}

Document a_thing(const ShapeDefinition& shape, PhysicalKind kind) {
    Document document = samples::floor_and_box(1);
    Entity& entity = document.entities[1];
    entity.geometry = shape;
    entity.attributes = {{"kind", to_value(kind)}};
    if (kind == PhysicalKind::granular) entity.attributes["grain_budget"] = 200.0;
    if (kind == PhysicalKind::fluid) entity.attributes["particle_budget"] = 1000.0;
    return document;
}

double mass_of(const Simulation& simulation) {
    const MovingPoints* points = simulation.points(thing);
    return points ? points->mass() : simulation.world().mass(simulation.body(thing));
}

TEST(MeshPrimitive, WeighsWhatTheSameBoxDoesWhateverItIsMadeOf) {
    for (const PhysicalKind kind : {PhysicalKind::rigid, PhysicalKind::soft, PhysicalKind::granular,
                                    PhysicalKind::fluid, PhysicalKind::cloth, PhysicalKind::rope}) {
        const Vec3 half = kind == PhysicalKind::cloth  ? Vec3{0.3, 0.005, 0.3}
                          : kind == PhysicalKind::rope ? Vec3{0.5, 0.01, 0.01}
                                                       : Vec3{0.2, 0.2, 0.2};
        const MeshShape mesh = box_of_triangles(half);
        MeshShape turned = mesh;
        for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
        const Document box = a_thing(BoxShape{half}, kind);
        const auto expected = EntityDefinitions(nullptr).attributes.acting(box.entities[1]);
        const auto of_box = make(box);
        ASSERT_TRUE(expected.ok() && of_box) << to_text(kind);
        for (const MeshShape& shape : {mesh, turned}) {
            const Document document = a_thing(shape, kind);
            const auto set = EntityDefinitions(nullptr).attributes.acting(document.entities[1]);
            ASSERT_TRUE(set.ok()) << to_text(kind);
            const double mass = expected->number("mass", 0);
            EXPECT_NEAR(set->number("mass", 0), mass, 1e-5 * mass) << to_text(kind);
            const auto simulation = make(document);
            ASSERT_TRUE(simulation) << to_text(kind);
            EXPECT_NEAR(mass_of(*simulation), mass_of(*of_box), 0.01 * mass_of(*of_box)) << to_text(kind);
            if (kind != PhysicalKind::rigid) continue;
            const auto body = simulation->body(thing);
            EXPECT_LT(distance(simulation->world().center_of_mass(body), simulation->pose(thing).position + half),
                      1e-6);
        }
    }
}

// The hull of two separate boxes would be three times as heavy.
TEST(MeshPrimitive, ThatIsNotConvexWeighsLessThanItsHull) {
    MeshShape two = box_of_triangles({0.1, 0.1, 0.1});
    const MeshShape other = two;
    for (Vec3f position : other.positions) two.positions.push_back({position.x + 0.4f, position.y, position.z});
    for (auto triangle : other.triangles) two.triangles.push_back({triangle[0] + 8, triangle[1] + 8, triangle[2] + 8});
    const auto simulation = make(a_thing(two, PhysicalKind::rigid));
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(mass_of(*simulation), 1000 * 0.016, 1e-4);
    // Static meshes stay unchanged.
    Entity fixed;
    fixed.geometry = ShapeDefinition{two};
    const auto set = EntityDefinitions(nullptr).attributes.acting(fixed);
    ASSERT_TRUE(set.ok());
    EXPECT_EQ(kind_of(*set), PhysicalKind::static_body);
}

}  // namespace
}  // namespace embody::scene
