// SPDX-License-Identifier: MIT
#include "interchange/ply/read_ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "interchange/image/image_codec.h"
#include "interchange/polygon.h"
#include "interchange/read_model.h"
#include "interchange/scratch_files.h"
#include "interchange/screen_color.h"

namespace embody::interchange {
namespace {

using test::ScratchFolder;

Result<RawScene> read(const std::string& content) {
    const ScratchFolder scratch;
    return read_model(scratch.write("model.ply", content));
}

const std::string vertex_header = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string face_header = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string triangle_header = vertex_header + face_header;

std::string ascii(const std::string& declarations, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + declarations + "end_header\n" + body;
}

/// The error message of a file that is refused, without its folder.
std::string refusal(const std::string& content) {
    const auto scene = read(content);
    if (scene) return "read";
    const std::string message = scene.error().message();
    return message.substr(message.find("model.ply") + 11);
}

/// A number's bytes, in big-endian order if `big`.
template <class T>
std::string binary(T number, bool big) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    if (big) std::ranges::reverse(bytes);
    return bytes;
}

TEST(ReadPly, NamesWhereAHeaderIsWrong) {
    EXPECT_EQ(refusal("plx\n"), "line 1: is not \"ply\", as the first line of a PLY file is");
    EXPECT_EQ(refusal("ply\nformat ascii 1.0\n"), "line 2: is the last one: end_header is missing");
    EXPECT_EQ(refusal("ply\nend_header\n"), "line 2: ends a header without a format");
    EXPECT_EQ(refusal("ply\nformat binary 1.0\n"), "line 2: names no format of PLY: binary");
    EXPECT_EQ(refusal(ascii("property float x\n", "")), "line 3: declares a property before any element");
    EXPECT_EQ(refusal(ascii("element vertex x\n", "")), "line 3: has no count of elements: x");
    EXPECT_EQ(refusal(ascii("element vertex 3\nproperty flout x\n", "")), "line 4: names no type of PLY: flout");
    EXPECT_EQ(refusal(ascii("element face 3\nproperty list float int a\n", "")), "line 4: counts a list in fractions");
    EXPECT_EQ(refusal(ascii("element vertex\n", "")), "line 3: is not understood");
    EXPECT_EQ(refusal(ascii("element vertex 3\nproperty list x\n", "")), "line 4: names no type of PLY: list");
    EXPECT_EQ(refusal(ascii("element vertex 1\nproperty float x\n", "1\n")), "element vertex: has no x, y and z");
    EXPECT_EQ(refusal(ascii(face_header, "3 0 1 2\n")), "element face: comes before the vertices, or there are none");
}

TEST(ReadPly, NamesTheElementAndTheLineOrByte) {
    EXPECT_EQ(refusal(ascii(triangle_header, "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n")),
              "element vertex 2, line 12: has a coordinate that is not a finite number");
    EXPECT_EQ(refusal(ascii(triangle_header, "0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n")),
              "element vertex 2, line 12: has no readable number for z (is the file complete?)");
    EXPECT_EQ(refusal(ascii(triangle_header, "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
              "element face 0, line 13: refers to vertex 3, which does not exist");
    EXPECT_EQ(refusal(ascii(triangle_header, "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")),
              "element face 0, line 13: refers to vertex -1, which does not exist");
    const std::string start = "ply\nformat binary_little_endian 1.0\n" + triangle_header + "end_header\n";
    const std::string vertices(36, '\0');
    const std::string last_byte = std::to_string(start.size() + 37);
    EXPECT_EQ(
        refusal(start + vertices + std::string("\3\0\0\0", 4)),
        "element face 0, byte " + last_byte + ": has no readable number for vertex_indices (is the file complete?)");
}

// Such files made assimp loop: a few bytes that declare billions of elements.
TEST(ReadPly, RefusesCountsThatTheFileCannotHold) {
    for (const char* count : {"4000000000", "18446744073709551615", "1000"}) {
        const std::string vertices =
            std::string("element vertex ") + count + "\nproperty float x\nproperty float y\nproperty float z\n";
        const std::string why = std::string("element vertex: is said to be there ") + count +
                                " times, more than the file holds (is the file complete?)";
        EXPECT_EQ(refusal(ascii(vertices + face_header, "0 0 0\n")), why);
        EXPECT_EQ(refusal("ply\nformat binary_big_endian 1.0\n" + vertices + face_header + "end_header\n0000"), why);
    }
    // An element without properties is skipped, whatever its count.
    EXPECT_TRUE(
        read(ascii("element nothing 18446744073709551615\n" + triangle_header, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
    EXPECT_EQ(refusal(ascii(vertex_header + "element face 1\nproperty list uint int vertex_indices\n",
                            "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n")),
              "element face 0, line 13: has no readable number for vertex_indices (is the file complete?)");
}

TEST(ReadPly, DamagedFilesAreRefusedOrRead) {
    std::string body;
    for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) body += binary(number, false);
    body += '\3';
    for (const std::int32_t index : {0, 1, 2}) body += binary(index, false);
    const std::vector<std::string> wholes{
        ascii(triangle_header, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        "ply\nformat binary_little_endian 1.0\n" + triangle_header + "end_header\n" + body};
    const ScratchFolder scratch;
    std::mt19937 random(11);
    for (int trial = 0; trial < 2000; ++trial) {
        std::string damaged = wholes[random() % wholes.size()];
        for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
        if (trial % 3 == 0) damaged.resize(random() % damaged.size());
        const auto scene = read_model(scratch.write("model.ply", damaged));
        if (!scene) continue;
        for (const RawMesh& mesh : scene->meshes) {
            for (const auto& t : mesh.triangles) EXPECT_LT(std::max({t[0], t[1], t[2]}), mesh.positions.size());
        }
    }
}

TEST(ReadPly, AllEncodingsAndLineEndsGiveTheSame) {
    const std::string declarations =
        "element vertex 3\nproperty double x\nproperty float y\nproperty short z\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n";
    std::vector<std::string> files{
        ascii(declarations, "0.5 0 0 255 0 0\n2.5 0 0 255 0 0\n+0.5 3e0 -4 255 0 0\n3 0 1 2")};
    files.push_back("ply\nCreated by Blender3D 247\n" + files[0].substr(4));
    std::string windows = files[0];
    for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.insert(at, 1, '\r');
    files.push_back(windows);
    for (const bool big : {false, true}) {
        std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" +
                           declarations + "end_header\n";
        const std::vector<std::array<double, 3>> positions{{0.5, 0, 0}, {2.5, 0, 0}, {0.5, 3, -4}};
        for (const auto& p : positions) {
            file += binary(p[0], big) + binary(static_cast<float>(p[1]), big) +
                    binary(static_cast<std::int16_t>(p[2]), big) + std::string("\xff\0\0", 3);
        }
        file += '\3';
        for (const std::int32_t index : {0, 1, 2}) file += binary(index, big);
        files.push_back(file);
    }
    for (const std::string& file : files) {
        const auto scene = read(file);
        ASSERT_TRUE(scene) << scene.error().message();
        ASSERT_EQ(scene->meshes.size(), 1u);
        EXPECT_EQ(scene->meshes[0].positions, (std::vector<Vec3f>{{0.5f, 0, 0}, {2.5f, 0, 0}, {0.5f, 3, -4}}));
        EXPECT_EQ(scene->meshes[0].triangles.size(), 1u);
        EXPECT_EQ(scene->materials[0].base_color, (std::array{1.0f, 0.0f, 0.0f, 1.0f}));
    }
}

// A vertex whose x has this type and value, with y and z of 0; returns the x that was read.
template <class T>
float read_as(const std::string& type, T value, bool big) {
    std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 3\nproperty " + type + " x\nproperty float y\nproperty float z\n" +
                       face_header + "end_header\n";
    for (const float height : {0.f, 1.f, 0.f}) {
        file += binary(value, big) + binary(height, big) + binary(height == 0 ? 0.f : 2.f, big);
    }
    file += '\3';
    for (const std::int32_t index : {0, 1, 2}) file += binary(index, big);
    const auto scene = read(file);
    EXPECT_TRUE(scene) << type << ": " << scene.error().message();
    return scene ? scene->meshes[0].positions[1].x : 0;
}

TEST(ReadPly, NumbersOfEveryTypeKeepTheirValueAndSign) {
    for (const bool big : {false, true}) {
        for (const char* type : {"char", "int8"}) EXPECT_EQ(read_as<std::int8_t>(type, -100, big), -100);
        for (const char* type : {"uchar", "uint8"}) EXPECT_EQ(read_as<std::uint8_t>(type, 200, big), 200);
        for (const char* type : {"short", "int16"}) EXPECT_EQ(read_as<std::int16_t>(type, -30'000, big), -30'000);
        for (const char* type : {"ushort", "uint16"}) EXPECT_EQ(read_as<std::uint16_t>(type, 60'000, big), 60'000);
        for (const char* type : {"int", "int32"}) EXPECT_EQ(read_as<std::int32_t>(type, -70'000, big), -70'000);
        for (const char* type : {"uint", "uint32"})
            EXPECT_EQ(read_as<std::uint32_t>(type, 3'000'000'000u, big), 3'000'000'000.f);
        for (const char* type : {"float", "float32"}) EXPECT_EQ(read_as<float>(type, -0.375f, big), -0.375f);
        for (const char* type : {"double", "float64"}) EXPECT_EQ(read_as<double>(type, 1e-3, big), 1e-3f);
    }
}

TEST(ReadPly, RefusesVerticesTwiceFacesWithoutAListAndStripsBeyondTheVertices) {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(refusal(ascii(vertex_header + vertex_header, vertices + vertices)), "element vertex: is there twice");
    EXPECT_EQ(refusal(ascii(vertex_header + "element face 1\nproperty int vertex_indices\n", vertices + "1\n")),
              "element face: has no list of vertex_indices");
    EXPECT_EQ(refusal(ascii(vertex_header + "element tristrips 1\nproperty list int int vertex_indices\n",
                            vertices + "4 0 1 2 3\n")),
              "element tristrips 0, line 13: refers to vertex 3, which does not exist");
    EXPECT_EQ(refusal(ascii(triangle_header, vertices + "3 0 1 1.5\n")),
              "element face 0, line 13: refers to vertex 1.5, which does not exist");
    EXPECT_EQ(refusal(ascii(vertex_header, vertices)), "holds no triangles");
}

TEST(ReadPly, ReadsNormalsTexturesAndColours) {
    const ScratchFolder scratch;
    const auto png = encode_png({1, 1, {255, 0, 0, 255}});
    scratch.write("my wall.png", {png.begin(), png.end()});
    const std::string properties =
        "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float "
        "nz\n"
        "property float s\nproperty float t\nproperty float red\nproperty float green\nproperty float blue\n";
    const std::string file =
        ascii("comment TextureFile my wall.png\nelement vertex 3\n" + properties + face_header,
              "0 0 0 0 0 2 0 0 0.5 0 0\n1 0 0 0 0 2 1 0 0.5 0 0\n0 1 0 0 0 0 0 1 0.5 0 0\n3 0 1 2\n");
    const auto scene = read_model(scratch.write("model.ply", file));
    ASSERT_TRUE(scene) << scene.error().message();
    const RawMesh& mesh = scene->meshes[0];
    EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 0, 1}, {0, 1, 0}}));
    EXPECT_EQ(mesh.texture_coordinates[2], (std::array{0.0f, 0.0f}));  // lower left to upper left
    EXPECT_EQ(scene->images.size(), 1u);
    EXPECT_EQ(scene->materials[0].base_color_image, 0);

    const auto plain = read_model(scratch.write("plain.ply", file.substr(0, 21) + file.substr(file.find("element"))));
    ASSERT_TRUE(plain) << plain.error().message();
    EXPECT_NEAR(plain->materials[0].base_color[0], linear_from_srgb(0.5f), 1e-6);
}

TEST(ReadPly, CornersOfFacesMayHaveTexturesOfTheirOwn) {
    const auto scene = read(ascii(vertex_header + "element face 2\nproperty list uchar int vertex_index\n"
                                                  "property list uchar float texcoord\n",
                                  "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n3 2 1 0 6 .5 .5 .5 .5 .5 .5\n"));
    ASSERT_TRUE(scene) << scene.error().message();
    const RawMesh& mesh = scene->meshes[0];
    ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    EXPECT_EQ(mesh.texture_coordinates[mesh.triangles[0][1]], (std::array{1.0f, 1.0f}));
    EXPECT_EQ(mesh.texture_coordinates[mesh.triangles[1][0]], (std::array{0.5f, 0.5f}));
}

TEST(ReadPly, StripsTurnTheSameWay) {
    const auto scene =
        read(ascii("element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                   "element tristrips 1\nproperty list int int vertex_indices\n",
                   "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n"));
    ASSERT_TRUE(scene) << scene.error().message();
    const RawMesh& mesh = scene->meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 3u);
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        EXPECT_GT(cross(b - a, c - a).z, 0);
    }
}

TEST(TrianglesOfPolygon, CoverConcaveOnesOnce) {
    // An L of area 3, seen from above and from below; a triangle fan from corner 0 would leave it.
    const std::vector<Vec3f> shape{{2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}, {0, 0, 1}};
    for (const bool from_below : {false, true}) {
        std::vector<Vec3f> corners = shape;
        if (from_below) std::ranges::reverse(corners);
        for (std::size_t first = 0; first < corners.size(); ++first) {
            double area = 0;
            const auto triangles = triangles_of_polygon(corners);
            EXPECT_EQ(triangles.size(), 4u);
            for (const auto& t : triangles) {
                const Vec3 a = corners[t[0]], b = corners[t[1]], c = corners[t[2]];
                const double signed_area = cross(b - a, c - a).z / 2;
                EXPECT_EQ(signed_area < 0, from_below);
                area += std::fabs(signed_area);
            }
            EXPECT_NEAR(area, 3, 1e-9);
            std::ranges::rotate(corners, corners.begin() + 1);
        }
    }
    EXPECT_TRUE(triangles_of_polygon(std::span(shape).first(2)).empty());
    EXPECT_EQ(triangles_of_polygon(std::vector<Vec3f>(7)).size(), 5u);  // no area
    EXPECT_EQ(triangles_of_polygon(std::vector<Vec3f>(2000)).size(), 1998u);
}

}  // namespace
}  // namespace embody::interchange
