// SPDX-License-Identifier: MIT
#include "interchange/vrml/read_vrml.h"

#include <gtest/gtest.h>

#include "interchange/image/image_codec.h"
#include "interchange/read_model.h"
#include "interchange/scratch_files.h"
#include "math/bounds.h"

namespace embody::interchange {
namespace {

class ReadVrml : public testing::Test {
protected:
    void SetUp() override {
        if (!can_read_vrml()) GTEST_SKIP() << can_read_vrml().error().message();
    }
    [[nodiscard]] Result<RawScene> read(const std::string& nodes) const {
        return read_model(scratch_.write("model.wrl", "#VRML V2.0 utf8\n" + nodes));
    }
    test::ScratchFolder scratch_;
};

const std::string box = "Shape { geometry Box { size 2 4 6 } }\n";

Bounds bounds_of(const RawScene& scene) {
    Bounds bounds;
    for (const RawMesh& mesh : scene.meshes) {
        for (const Vec3f p : mesh.positions) bounds.add(to_vec3(p));
    }
    return bounds;
}

std::size_t triangles_of(const RawScene& scene) {
    std::size_t count = 0;
    for (const RawMesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
}

TEST(ReadVrmlWithoutCoin, ARefusalNamesThePackage) {
    if (can_read_vrml()) GTEST_SKIP() << "this build reads VRML";
    const test::ScratchFolder scratch;
    const auto read = read_model(scratch.write("model.wrl", "#VRML V2.0 utf8\n" + box));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message().find("libcoin-dev"), std::string::npos);
}

TEST_F(ReadVrml, RefusesOtherVersionsAndWhatEndsEarly) {
    for (const char* text : {"#VRML V1.0 ascii\nCube {}\n", "#Inventor V2.1 ascii\nCube {}\n", "\x1f\x8b\x08"}) {
        const auto read = read_model(scratch_.write("other.wrl", text));
        ASSERT_FALSE(read);
        EXPECT_NE(read.error().message().find("VRML 2.0"), std::string::npos);
    }
    for (const char* nodes :
         {"Shape { geometry Box {", "Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0",
          "Shape { geometry Nothing { } }", "}", "Group { }"}) {
        const auto cut = read(nodes);
        ASSERT_FALSE(cut) << nodes;
        EXPECT_EQ(cut.error().message().find('\n'), std::string::npos);
    }
}

TEST_F(ReadVrml, PlacesShapesAndNamesTheirMaterials) {
    const auto scene = read(
        "Transform { translation 10 0 0 rotation 0 0 1 1.5707963 scale 2 1 1 children [\n"
        "  Shape { appearance Appearance { material DEF PIN-01 Material { diffuseColor 1 0 0.5 transparency 0.25 } }\n"
        "          geometry Box { size 1 3 5 } } ] }\n"
        "Shape { appearance Appearance { material USE PIN-01 } geometry Box { size 1 1 1 } }\n"
        "Shape { appearance Appearance { material Material { diffuseColor 0 1 0 } } geometry Box { size 1 1 1 } }\n");
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(triangles_of(*scene), 36u);
    ASSERT_EQ(scene->materials.size(), 2u);  // shapes with the same material become one part
    EXPECT_EQ(scene->materials[0].name, "PIN-01");
    EXPECT_EQ(scene->materials[0].base_color[0], 1);
    EXPECT_NEAR(scene->materials[0].base_color[2], 0.2140f, 1e-3f);  // IEC 61966-2-1 at 0.5
    EXPECT_NEAR(scene->materials[0].base_color[3], 0.75f, 1e-6f);
    // Scaled first, then rotated from X to Y, then translated.
    const Bounds bounds = bounds_of(*scene);
    EXPECT_NEAR(bounds.upper.x, 11.5, 1e-5);
    EXPECT_NEAR(bounds.upper.y, 1, 1e-5);
    EXPECT_NEAR(bounds.upper.z, 2.5, 1e-5);
}

TEST_F(ReadVrml, FacesLookOutwardsWhateverTheirOrder) {
    const std::string face = "coord Coordinate { point [0 0 0, 1 0 0, 1 1 0, 0 1 0] } coordIndex [";
    const auto counter = read("Shape { geometry IndexedFaceSet { " + face + "0 1 2 3 -1] } }");
    const auto clockwise = read("Shape { geometry IndexedFaceSet { ccw FALSE " + face + "3 2 1 0 -1] } }");
    const auto mirrored =
        read("Transform { scale 1 -1 1 children Shape { geometry IndexedFaceSet { " + face + "0 1 2 3 -1] } } }");
    const std::string grid =
        "rotation 1 0 0 1.5707963 children Shape { geometry ElevationGrid { xDimension 2 zDimension 2 "
        "height [0 0 0 0] ";
    const auto raised = read("Transform { " + grid + "} } }");
    const auto sunk = read("Transform { scale 1 -1 1 " + grid + "ccw FALSE } } }");
    for (const auto* scene : {&counter, &clockwise, &mirrored, &raised, &sunk}) {
        ASSERT_TRUE(*scene) << scene->error().message();
        const RawMesh& mesh = (*scene)->meshes.at(0);
        EXPECT_EQ(mesh.triangles.size(), 2u);
        for (const auto& t : mesh.triangles) {
            const Vec3 a = to_vec3(mesh.positions[t[0]]), b = to_vec3(mesh.positions[t[1]]);
            EXPECT_GT(cross(b - a, to_vec3(mesh.positions[t[2]]) - a).z, 0);
        }
    }
}

TEST_F(ReadVrml, TakesTexturesBesideTheModelOnly) {
    const auto png = encode_png({2, 1, {255, 0, 0, 255, 0, 255, 0, 255}});
    scratch_.write("wall.png", {png.begin(), png.end()});
    const auto textured = [](const std::string& url) {
        return "Shape { appearance Appearance { material Material { } texture ImageTexture { url \"" + url +
               "\" } } geometry Box { } }";
    };
    const auto beside = read(textured("wall.png"));
    ASSERT_TRUE(beside) << beside.error().message();
    EXPECT_EQ(beside->images.size(), 1u);
    EXPECT_EQ(beside->meshes[0].texture_coordinates.size(), beside->meshes[0].positions.size());
    const auto outside = read(textured("../../etc/hostname"));
    ASSERT_TRUE(outside) << outside.error().message();
    EXPECT_TRUE(outside->images.empty());
    EXPECT_EQ(outside->warnings.size(), 1u);
}

TEST_F(ReadVrml, FollowsNoOtherFiles) {
    const auto other = scratch_.write("other.wrl", "#VRML V2.0 utf8\nShape { geometry Box { size 100 100 100 } }\n");
    for (const std::string& url : {std::string("other.wrl"), other.string(), "file://" + other.string()}) {
        const auto scene = read(box + "Inline { url \"" + url + "\" }");
        ASSERT_TRUE(scene) << scene.error().message();
        EXPECT_EQ(bounds_of(*scene).size().x, 2);
        EXPECT_EQ(scene->warnings.size(), 1u);
        for (const char* node : {"File { name \"", "SoFile { name \"", "EXTERNPROTO Thing [] [\""}) {
            const std::string end = node[0] == 'E' ? "\"]\nThing { }" : "\" }";
            const auto followed = read(box + node + url + end);
            EXPECT_TRUE(!followed || bounds_of(*followed).size().x < 3) << node << url;
        }
    }
}

TEST_F(ReadVrml, SurfacesThatAreTooManyShareOneWithTextureOrWithout) {
    const auto png = encode_png({1, 1, {255, 0, 0, 255}});
    scratch_.write("wall.png", {png.begin(), png.end()});
    for (const int remainder : {0, 1}) {
        std::string nodes;
        for (int i = 0; i < 1005; ++i) {
            const char* texture = i % 2 == remainder ? " texture ImageTexture { url \"wall.png\" }" : "";
            nodes += "Shape { appearance Appearance { material Material { diffuseColor 0 0 " +
                     std::to_string(i / 2000.0) + " }" + texture + " } geometry Box { } }\n";
        }
        const auto scene = read(nodes);
        ASSERT_TRUE(scene) << scene.error().message();
        EXPECT_EQ(triangles_of(*scene), 1005u * 12);
    }
}

TEST_F(ReadVrml, RefusesRecursionAndExponentialReuse) {
    // A node inside of itself; deeply nested nodes; one node used 2^40 times.
    EXPECT_FALSE(read("DEF A Group { children [ " + box + " USE A ] }"));
    std::string deep;
    for (int i = 0; i < 100'000; ++i) deep += "Group { children [ ";
    EXPECT_FALSE(read(deep));
    std::string many = "DEF G0 " + box;
    for (int i = 1; i <= 40; ++i) {
        const std::string before = "USE G" + std::to_string(i - 1) + " ";
        many += "DEF G" + std::to_string(i) + " Group { children [ " + before + before + "] }\n";
    }
    EXPECT_FALSE(read(many));
}

TEST_F(ReadVrml, SurvivesInvalidIndicesAndNumbers) {
    const std::string points = "Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } ";
    for (const char* index :
         {"0 1 1000000000 -1", "0 1 3 -1", "-5 -6 -7 -1", "0 -1 1 -1 2", "99999999999999999999 1 2 -1"}) {
        const auto scene = read(points + "coordIndex [" + index + "] } }");
        EXPECT_TRUE(!scene || triangles_of(*scene) <= 1) << index;
    }
    for (const char* number : {"nan", "inf", "1e300", "0x"}) {
        const auto scene = read("Shape { geometry Box { size 1 1 " + std::string(number) + " } }");
        EXPECT_TRUE(!scene || is_finite(bounds_of(*scene).size())) << number;
    }
}

}  // namespace
}  // namespace embody::interchange
