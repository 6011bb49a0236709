// SPDX-License-Identifier: MIT
#include "interchange/read_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "interchange/image/image_codec.h"
#include "interchange/scratch_files.h"
#include "math/bounds.h"

namespace embody::interchange {
namespace {

using test::cube_obj;
using test::ScratchFolder;

Vec3 size_of(const RawScene& scene) {
    Bounds bounds;
    for (const RawMesh& mesh : scene.meshes) {
        for (const Vec3f p : mesh.positions) bounds.add(to_vec3(p));
    }
    return bounds.size();
}

std::size_t triangles_of(const RawScene& scene) {
    std::size_t count = 0;
    for (const RawMesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
}

void expect_close(Vec3 a, Vec3 b) { EXPECT_LT(distance(a, b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z; }

std::string tiny_png() {
    const auto bytes = encode_png({2, 1, {255, 0, 0, 255, 0, 255, 0, 255}});
    return {bytes.begin(), bytes.end()};
}

TEST(ReadModel, RefusesEmptyAndForeignFilesOfEveryFormat) {
    const ScratchFolder scratch;
    for (const std::string& extension : model_extensions()) {
        for (const std::string& content :
             {std::string(), std::string("hello"), std::string(1000, '\0'), std::string(1000, '\xff')}) {
            const auto read = read_model(scratch.write("model" + extension, content));
            ASSERT_FALSE(read) << extension;
            EXPECT_NE(read.error().where.find("model" + extension), std::string::npos);
            EXPECT_FALSE(read.error().why.empty());
        }
    }
}

TEST(ReadModel, RefusesMissingFilesAndUnknownFormats) {
    const ScratchFolder scratch;
    EXPECT_FALSE(read_model(scratch.path() / "missing.obj"));
    const auto unknown = read_model(scratch.write("model.xyz", cube_obj()));
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message().find("glTF, OBJ, STL, PLY, COLLADA, AC3D or VRML 2.0"), std::string::npos);
}

TEST(ReadModel, RefusesNonFiniteAndHugePositions) {
    const ScratchFolder scratch;
    for (const char* number : {"nan", "inf", "-inf", "1e300"}) {
        const std::string obj = std::string("v 0 0 0\nv 1 0 0\nv 0 ") + number + " 0\nf 1 2 3\n";
        EXPECT_FALSE(read_model(scratch.write("model.obj", obj))) << number;
    }
}

TEST(ReadModel, RefusesIndicesThatReachNowhere) {
    const ScratchFolder scratch;
    for (const char* index : {"1000000000", "-1000000000", "99999999999999999999", "4", "0"}) {
        const std::string obj = std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ") + index + "\n";
        EXPECT_FALSE(read_model(scratch.write("model.obj", obj))) << index;
    }
}

TEST(ReadModel, RefusesAnStlThatPromisesMoreThanItHolds) {
    const ScratchFolder scratch;
    std::string stl(80, ' ');
    stl += std::string("\xff\xff\xff\x7f", 4) + std::string(50, '\0');
    EXPECT_FALSE(read_model(scratch.write("model.stl", stl)));
}

TEST(ReadModel, RefusesPointsWithoutTriangles) {
    const ScratchFolder scratch;
    EXPECT_FALSE(read_model(scratch.write("points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n")));
    EXPECT_FALSE(read_model(scratch.write("points.ply",
                                          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                                          "y\nproperty float z\nend_header\n0 0 0\n")));
}

TEST(ReadModel, RefusesAGltfWhoseBufferLiesOutside) {
    const ScratchFolder scratch;
    scratch.write("outside.bin", std::string(36, '\0'));
    const auto gltf = [](const std::string& uri) {
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" +
               uri + "\"}]}";
    };
    EXPECT_FALSE(read_model(scratch.write("in/model.gltf", gltf("../outside.bin"))));
    EXPECT_FALSE(read_model(scratch.write("in/model.gltf", gltf((scratch.path() / "outside.bin").string()))));
    EXPECT_FALSE(read_model(scratch.write("in/model.gltf", gltf("/etc/passwd"))));
    // The same inside of the folder is allowed.
    scratch.write("in/inside.bin", std::string(36, '\0'));
    EXPECT_TRUE(read_model(scratch.write("in/model.gltf", gltf("inside.bin"))));
}

TEST(ReadModel, SurvivesDamagedFiles) {
    const ScratchFolder scratch;
    const std::string whole = cube_obj("mtllib cube.mtl\nusemtl red\n");
    std::mt19937 random(3);
    for (int trial = 0; trial < 300; ++trial) {
        std::string damaged = whole.substr(0, random() % whole.size());
        for (int k = 0; k < 5 && !damaged.empty(); ++k)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        const auto read = read_model(scratch.write("model.obj", damaged));
        if (read) {
            EXPECT_GT(triangles_of(*read), 0u);
        }
    }
}

// assimp drops vertices whose numbers begin with a decimal point; all numbers of cube_obj() do.
TEST(ReadModel, ReadsACubeFromObjAsItIs) {
    const ScratchFolder scratch;
    const auto read = read_model(scratch.write("cube.obj", cube_obj()));
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(triangles_of(*read), 12u);
    expect_close(size_of(*read), {1, 1, 1});
}

TEST(ReadModel, ReadsMaterialsWithTexturesBesideTheModel) {
    const ScratchFolder scratch;
    scratch.write("textures/t.png", tiny_png());
    scratch.write("cube.mtl",
                  "newmtl red\nKd 1 0 0\nd 0.5\nnewmtl picture\nKd 0.1 0.1 0.1\nmap_Kd textures/t.png\n"
                  "newmtl lost\nKd 0 1 0\nmap_Kd nowhere.png\nnewmtl elsewhere\nmap_Kd C:\\home\\me\\t2.png\n");
    scratch.write("t2.png", tiny_png());
    const std::string face =
        "vt 0 0\nusemtl red\nf 1/1 2/1 3/1\nusemtl picture\nf 1/1 2/1 3/1\nusemtl lost\nf 1/1 2/1 3/1\nusemtl "
        "elsewhere\nf 1/1 2/1 3/1\n";
    const auto read = read_model(scratch.write("cube.obj", cube_obj("mtllib cube.mtl\n" + face)));
    ASSERT_TRUE(read) << read.error().message();
    const auto named = [&](const std::string& name) {
        for (const RawMaterial& material : read->materials) {
            if (material.name == name) return material;
        }
        ADD_FAILURE() << "no material " << name;
        return RawMaterial{};
    };
    EXPECT_EQ(named("red").base_color, (std::array{1.0f, 0.0f, 0.0f, 0.5f}));
    EXPECT_EQ(named("red").base_color_image, -1);
    EXPECT_GE(named("picture").base_color_image, 0);
    EXPECT_EQ(named("picture").base_color, (std::array{1.0f, 1.0f, 1.0f, 1.0f}));
    EXPECT_EQ(named("lost").base_color_image, -1);
    EXPECT_GE(named("elsewhere").base_color_image, 0);
    ASSERT_EQ(read->warnings.size(), 1u);
    EXPECT_NE(read->warnings[0].find("nowhere.png"), std::string::npos);
}

TEST(ReadModel, TakesScreenColoursOfOldFormatsToLinear) {
    const ScratchFolder scratch;
    scratch.write("cube.mtl", "newmtl gray\nKd 0.5 0.5 0.5\n");
    const auto read = read_model(scratch.write("cube.obj", cube_obj("mtllib cube.mtl\nusemtl gray\n")));
    ASSERT_TRUE(read);
    float gray = 0;
    for (const RawMaterial& material : read->materials) {
        if (material.name == "gray") gray = material.base_color[0];
    }
    EXPECT_NEAR(gray, 0.2140f, 1e-3f);  // IEC 61966-2-1 at 0.5
}

TEST(ReadModel, ScalesAndTurnsColladaAsItsAssetSays) {
    const ScratchFolder scratch;
    // A triangle of 100 × 200 cm, Z up: 1 m wide and 2 m high with Y up.
    const std::string dae =
        R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 100 0 0 0 0 200</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
    const auto read = read_model(scratch.write("triangle.dae", dae));
    ASSERT_TRUE(read) << read.error().message();
    expect_close(size_of(*read), {1, 2, 0});
}

// Java 3D's names: "amber" is (0.576, 0.268, 0) on the screen. With a library of its own a file means its own.
TEST(ReadModel, NamesOfMaterialsStandForThemWithoutALibrary) {
    const ScratchFolder scratch;
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl amber\nf 1 2 3\n";
    const auto bare = read_model(scratch.write("bare.obj", triangle));
    ASSERT_TRUE(bare.ok()) << bare.error().message();
    const auto color_of = [](const RawScene& scene) {
        return scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).material)).base_color;
    };
    EXPECT_NEAR(color_of(*bare)[0], std::pow((0.576 + 0.055) / 1.055, 2.4), 1e-4);
    EXPECT_NEAR(color_of(*bare)[2], 0, 1e-6);
    scratch.write("own.mtl", "newmtl amber\nKd 0 0 1\n");
    const auto own = read_model(scratch.write("own.obj", "mtllib own.mtl\n" + triangle));
    ASSERT_TRUE(own.ok());
    EXPECT_NEAR(color_of(*own)[2], 1, 1e-6);
}

TEST(ReadModel, FindsTexturesThatWereNamedOnAnotherMachine) {
    const ScratchFolder scratch;
    scratch.write("rug.png", tiny_png());
    const auto images_of = [&](const std::string& reference) {
        scratch.write("m.mtl", "newmtl rug\nmap_Kd " + reference + "\n");
        const auto read = read_model(scratch.write(
            "m.obj", "mtllib m.mtl\nusemtl rug\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"));
        return read ? read->images.size() : 99;
    };
    EXPECT_EQ(images_of("rug.png"), 1u);
    EXPECT_EQ(images_of("C:\\Users\\me\\rug.png"), 1u);
    EXPECT_EQ(images_of("/home/me/3D/ TEXTURES/Living room rug.png"), 1u);
    EXPECT_EQ(images_of("/home/me/3D/ TEXTURES/Living room chair.png"), 0u);
}

/// A square of 2 m with a material, by AC3D's text form; `texture` may be empty.
std::string square_ac(const std::string& texture) {
    return "AC3Db\nMATERIAL \"red paint\" rgb 1 0 0 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 10 trans 0.25\n"
           "OBJECT world\nkids 1\nOBJECT poly\nname \"square\"\nloc 0 1 0\n" +
           (texture.empty() ? std::string() : "texture \"" + texture + "\"\n") +
           "numvert 4\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 4\n"
           "0 0 0\n1 1 0\n2 1 1\n3 0 1\nkids 0\n";
}

TEST(ReadModel, ReadsAc3dInMetresWithMaterialsAndTextures) {
    const ScratchFolder scratch;
    const auto plain = read_model(scratch.write("plain.ac", square_ac("")));
    ASSERT_TRUE(plain) << plain.error().message();
    expect_close(size_of(*plain), {2, 2, 0});
    EXPECT_EQ(triangles_of(*plain), 2u);
    ASSERT_EQ(plain->materials.size(), 1u);
    EXPECT_EQ(plain->materials[0].name, "red paint");
    EXPECT_EQ(plain->materials[0].base_color, (std::array{1.0f, 0.0f, 0.0f, 0.75f}));

    scratch.write("wall.png", tiny_png());
    const auto textured = read_model(scratch.write("textured.ac", square_ac("wall.png")));
    ASSERT_TRUE(textured) << textured.error().message();
    EXPECT_EQ(textured->images.size(), 1u);
}

TEST(ReadModel, RefusesAnAc3dThatPromisesMoreThanItHolds) {
    const ScratchFolder scratch;
    for (const char* broken :
         {"numvert 4000000000\n0 0 0\n", "numvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 4000000000\n",
          "numvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n9 0 0\n",
          "kids 4000000000\n"}) {
        const auto read = read_model(scratch.write("model.ac", std::string("AC3Db\nOBJECT poly\n") + broken));
        EXPECT_FALSE(read && triangles_of(*read) > 1) << broken;
        EXPECT_TRUE(read || read.error().message().find('\n') == std::string::npos) << broken;
    }
}

TEST(ReadModel, ReadsBinaryAndTextStl) {
    const ScratchFolder scratch;
    const auto text = read_model(scratch.write("t.stl",
                                               "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 "
                                               "0\nvertex 0 3 0\nendloop\nendfacet\nendsolid t\n"));
    ASSERT_TRUE(text) << text.error().message();
    expect_close(size_of(*text), {2, 3, 0});
    std::string stl(80, ' ');
    stl += std::string("\1\0\0\0", 4);
    const float numbers[12] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0};
    stl.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    stl += std::string(2, '\0');
    const auto binary = read_model(scratch.write("b.stl", stl));
    ASSERT_TRUE(binary) << binary.error().message();
    expect_close(size_of(*binary), {2, 3, 0});
}

TEST(ReadModel, ReadsThroughAnArchiveWithTexturesInIt) {
    const ScratchFolder scratch;
    const auto file =
        scratch.write_zip("models.zip", {{"a/cube.obj", cube_obj("mtllib cube.mtl\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")},
                                         {"a/cube.mtl", "newmtl m\nmap_Kd T.PNG\n"},
                                         {"a/t.png", tiny_png()}});
    const auto archive = Archive::open(file);
    ASSERT_TRUE(archive);
    const auto read = read_model(ArchiveSource(*archive, file.string()), "a/cube.obj");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->images.size(), 1u);
    const auto missing = read_model(ArchiveSource(*archive, file.string()), "a/none.obj");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().where, file.string() + ": a/none.obj");
}

TEST(ReadModel, MirroredNodesKeepTheirOutside) {
    const ScratchFolder scratch;
    // One counter-clockwise triangle facing +z, mirrored in x: still facing +z.
    const std::string gltf =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[-1,1,1]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"t.bin"}]})";
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    scratch.write("t.bin", std::string(reinterpret_cast<const char*>(positions), sizeof positions));
    const auto read = read_model(scratch.write("t.gltf", gltf));
    ASSERT_TRUE(read) << read.error().message();
    const RawMesh& mesh = read->meshes[0];
    const auto& t = mesh.triangles[0];
    const Vec3 a = to_vec3(mesh.positions[t[0]]);
    EXPECT_GT(cross(to_vec3(mesh.positions[t[1]]) - a, to_vec3(mesh.positions[t[2]]) - a).z, 0);
}

}  // namespace
}  // namespace embody::interchange
