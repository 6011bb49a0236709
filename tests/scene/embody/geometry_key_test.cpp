// SPDX-License-Identifier: MIT
#include "scene/embody/geometry_key.h"

#include <gtest/gtest.h>

#include <set>

#include "scene/embody/form_cache.h"

namespace embody::scene {
namespace {

using namespace embody::physics;

HullShape a_tetrahedron(double height) { return {{{0, 0, 0}, {1, 0, 0}, {0, height, 0}, {0, 0, 1}}}; }

TEST(GeometryKey, IsEqualWhereKindAndEveryNumberAre) {
    const ShapeDefinition shapes[] = {
        SphereShape{1},      SphereShape{2},  BoxShape{{1, 1, 1}},     BoxShape{{1, 1, 2}}, CapsuleShape{1, 2},
        CylinderShape{1, 2}, ConeShape{1, 2}, ConeShape{1, 2 + 1e-15}, a_tetrahedron(1),    a_tetrahedron(2)};
    std::set<GeometryKey> keys;
    for (const ShapeDefinition& shape : shapes) {
        const GeometryKey key = key_of(shape);
        EXPECT_TRUE(key.is_shared());
        EXPECT_EQ(key, key_of(ShapeDefinition(shape))) << "of another one alike";
        EXPECT_TRUE(keys.insert(key).second) << shape_name(shape) << " has the key of another shape";
    }
}

TEST(GeometryKey, IsNotSharedForPlanesAndMeshes) {
    const MeshShape mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 2, 1}}};
    for (const ShapeDefinition& shape : {ShapeDefinition(PlaneShape{}), ShapeDefinition(mesh)})
        EXPECT_FALSE(key_of(shape).is_shared());
}

TEST(GeometryKey, OfAModelIsNoPrimitivesWhateverItIsCalled) {
    GeometryKey box = key_of(ShapeDefinition(BoxShape{}));
    EXPECT_NE(box, key_of_model("box"));
    box.numbers.clear();
    EXPECT_NE(box, key_of_model("box"));
    EXPECT_EQ(key_of(Geometry(ModelReference{"{\"type\": \"box\"}"})).of, GeometryKey::Of::model);
}

TEST(FormCache, KeepsPrimitivesAloneForTheNextSimulation) {
    FormCache forms;
    forms.thin_forms[key_of(ShapeDefinition(BoxShape{}))];
    forms.thin_forms[key_of_model("{curtain}")];
    forms.thin_forms[GeometryKey{}];
    forms.begin();
    ASSERT_EQ(forms.thin_forms.size(), 1u) << "models may have been imported again";
    EXPECT_EQ(forms.thin_forms.begin()->first, key_of(ShapeDefinition(BoxShape{})));
}

}  // namespace
}  // namespace embody::scene
