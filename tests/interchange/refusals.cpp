// SPDX-License-Identifier: MIT
// Files of every format, broken in the ways in which downloads, disks and exporters break them: every refusal has a
// reason that a person can act on.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "end_child.h"
#include "interchange/read_model.h"
#include "interchange/scratch_files.h"

namespace embody::interchange {
namespace {

using test::cube_obj;
using test::ScratchFolder;

template <class Number>
std::string bytes_of(std::initializer_list<Number> numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.begin(), bytes.size());
    return bytes;
}

// A right triangle of 1 m: three corners.
std::string corners() { return bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}); }

std::string gltf(const std::string& buffer) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36)" +
           buffer + "}]}";
}

std::string glb() {
    std::string json = gltf("");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto size = static_cast<std::uint32_t>(json.size());
    return "glTF" + bytes_of<std::uint32_t>({2, 12 + 8 + size + 8 + 36, size}) + "JSON" + json +
           bytes_of<std::uint32_t>({36}) + std::string("BIN\0", 4) + corners();
}

std::string binary_stl() {
    return std::string(80, ' ') + bytes_of<std::uint32_t>({1}) + bytes_of<float>({0, 0, 1}) + corners() +
           std::string(2, '\0');
}

constexpr const char* ascii_stl =
    "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "t\n";

std::string ply(const std::string& format, const std::string& body) {
    return "ply\nformat " + format +
           " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n" +
           body;
}

constexpr const char* collada = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

constexpr const char* ac3d =
    "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\nkids 1\nOBJECT poly\n"
    "name \"t\"\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x0\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n";

constexpr const char* vrml =
    "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] }\n"
    " coordIndex [ 0, 1, 2, -1 ] } }\n";

/// A valid file, with the file that it needs.
struct Whole {
    const char* name;
    std::string content;
    const char* companion = nullptr;  ///< name of the file that it refers to and needs
    std::string companion_content = {};
};

std::vector<Whole> whole_files() {
    std::vector<Whole> files{
        {"cube.obj", cube_obj()},
        {"text.ply", ply("ascii", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")},
        {"text.stl", ascii_stl},
        {"binary.stl", binary_stl()},
        {"scene.dae", collada},
        {"apart.gltf", gltf(R"(, "uri": "corners.bin")"), "corners.bin", corners()},
        {"one.gltf",
         gltf(R"(, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")")},
        {"binary.glb", glb()},
        {"poly.ac", ac3d},
    };
    if (can_read("model.wrl")) files.push_back({"shape.wrl", vrml});
    return files;
}

/// Words that a reason may not contain: those with which a library gives up.
constexpr const char* empty_words[] = {"Failed to open file",
                                       "No suitable reader",
                                       "unknown error",
                                       "Unknown error",
                                       "Unable to open",
                                       "of its kind",
                                       "std::",
                                       "basic_string",
                                       "vector::",
                                       "exception"};

/// Reads in a separate process with little processor time, as an import does: the libraries that read models crash on
/// some files and never end on others. Empty where the file was read.
std::optional<Error> read_apart(const std::filesystem::path& file) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
        const rlimit processor_time{1, 2};  // s; a file of a kilobyte takes a millisecond
        setrlimit(RLIMIT_CPU, &processor_time);
        const auto read = read_model(file);
        const std::string told = read ? "" : read.error().where + '\n' + read.error().why;
        test::end_child(write(ends[1], told.data(), told.size()) == static_cast<ssize_t>(told.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string told;
    std::array<char, 4096> block{};
    for (ssize_t count = 0; (count = ::read(ends[0], block.data(), block.size())) > 0;)
        told.append(block.data(), static_cast<std::size_t>(count));
    close(ends[0]);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    if (status != 0) return Error{file.string(), "made the library crash or run on"};
    if (told.empty()) return std::nullopt;
    const std::size_t end = told.find('\n');
    return Error{told.substr(0, end), told.substr(end + 1)};
}

class Refusals : public testing::Test {
protected:
    /// Reads a file with this content; a refusal names the file and a reason. Returns the reason, "" where the file was
    /// read.
    std::string reason(const std::string& name, const std::string& content) {
        const auto refused = read_apart(scratch_.write(name, content));
        if (!refused) return "";
        const std::string message = refused->message();
        EXPECT_NE(refused->where.find(name), std::string::npos) << message;
        EXPECT_GE(refused->why.size(), 8u) << message;
        for (const char* words : empty_words)
            EXPECT_EQ(message.find(words), std::string::npos) << message << "\n" << content.substr(0, 300);
        ++refused_;
        return refused->why;
    }
    void expect_reason(const std::string& name, const std::string& content, const std::string& words) {
        const std::string why = reason(name, content);
        EXPECT_NE(why.find(words), std::string::npos) << name << ": " << why;
    }

    ScratchFolder scratch_;
    std::size_t refused_ = 0;
};

TEST_F(Refusals, DoNotFollowFromValidFiles) {
    for (const Whole& whole : whole_files()) {
        if (whole.companion) scratch_.write(whole.companion, whole.companion_content);
        EXPECT_EQ(reason(whole.name, whole.content), "") << whole.name;
    }
}

TEST_F(Refusals, NameAReasonForTruncatedFiles) {
    for (const Whole& whole : whole_files()) {
        if (whole.companion) scratch_.write(whole.companion, whole.companion_content);
        for (std::size_t size = 0; size < whole.content.size(); size += whole.content.size() / 100 + 1)
            reason(whole.name, whole.content.substr(0, size));
        expect_reason(whole.name, "", "is empty");
    }
    EXPECT_GT(refused_, 500u);
}

TEST_F(Refusals, NameAReasonForWrongBytes) {
    for (const Whole& whole : whole_files()) {
        if (whole.companion) scratch_.write(whole.companion, whole.companion_content);
        for (const char wrong : {'\0', '\xff', '9', '{', '"'}) {
            for (std::size_t at = 0; at < whole.content.size(); at += whole.content.size() / 40 + 1) {
                std::string content = whole.content;
                content[at] = wrong;
                reason(whole.name, content);
            }
        }
    }
    EXPECT_GT(refused_, 200u);
}

TEST_F(Refusals, NameAReasonForFilesOfAnotherFormat) {
    const std::string picture("\x89PNG\r\n\x1a\n", 8), archive("PK\3\4", 4), page = "<!DOCTYPE html><html><body>404";
    for (const Whole& whole : whole_files()) {
        for (const std::string& other : {picture, archive, page, std::string(1000, '\0'), std::string(1000, '\xff')})
            EXPECT_NE(reason(whole.name, other), "") << whole.name;
        for (const Whole& another : whole_files()) {
            const auto extension = [](const Whole& file) { return std::filesystem::path(file.name).extension(); };
            if (extension(another) != extension(whole)) reason(whole.name, another.content);
        }
    }
    EXPECT_GT(refused_, 80u);
}

TEST_F(Refusals, NameTheMissingFile) {
    for (const Whole& whole : whole_files())
        if (whole.companion) expect_reason(whole.name, whole.content, whole.companion);
    expect_reason("out.gltf", gltf(R"(, "uri": "../../secret.bin")"), "../../secret.bin");
    EXPECT_NE(reason("out.gltf", gltf(R"(, "uri": "../../secret.bin")")).find("outside"), std::string::npos);
    scratch_.write("short.bin", "abc");
    expect_reason("short.gltf", gltf(R"(, "uri": "short.bin")"), "short.bin");
    expect_reason("none.gltf", gltf(""), "buffer");
}

TEST_F(Refusals, NameWhatIsWrongInAGltf) {
    expect_reason("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [", "JSON");
    expect_reason("a.gltf", "[1, 2]", "object");
    expect_reason("a.gltf", R"({"scenes": []})", "asset");
    expect_reason("a.gltf", R"({"asset": {"version": "7.0"}})", "version");
    expect_reason("a.glb", "glTF" + bytes_of<std::uint32_t>({7, 12}), "version");
    expect_reason("a.glb", "GLtf" + glb().substr(4), "glTF");
    expect_reason("a.glb", glb().substr(0, 100), "breaks off");
}

// Missing textures are left out with a warning that says why.
TEST_F(Refusals, DoNotFollowFromMissingTextures) {
    scratch_.write("cube.mtl", "newmtl m\nmap_Kd lost.png\n");
    const auto read = read_model(scratch_.write("cube.obj", cube_obj("mtllib cube.mtl\nusemtl m\n")));
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->warnings.size(), 1u);
    EXPECT_NE(read->warnings[0].find("lost.png"), std::string::npos) << read->warnings[0];
}

TEST_F(Refusals, NameAReasonForFoldersAndUnreadableFiles) {
    for (const Whole& whole : whole_files()) {
        std::filesystem::create_directories(scratch_.path() / "folder" / whole.name);
        const auto read = read_model(scratch_.path() / "folder" / whole.name);
        ASSERT_FALSE(read);
        EXPECT_NE(read.error().message().find(whole.name), std::string::npos);
        EXPECT_NE(read.error().why.find("folder"), std::string::npos) << read.error().message();
    }
}

}  // namespace
}  // namespace embody::interchange
