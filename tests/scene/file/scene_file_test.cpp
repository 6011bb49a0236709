// SPDX-License-Identifier: MIT
#include "scene/file/scene_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// A folder that is deleted after the test.
class Folder {
public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "embody_scene_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
    fs::path path;
};

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

std::string message_of(const json& scene) {
    const Result<Document> read = document_from_json(scene);
    return read.ok() ? "accepted" : read.error().message();
}

json minimal() {
    return {{"embody_scene", 1}, {"entities", {{{"shape", {{"type", "box"}, {"half_extents", {1, 1, 1}}}}}}}};
}

// A place in the minimal scene, a wrong value for it, and the text that the message must contain.
struct WrongField {
    const char* pointer;
    json value;
    const char* says;
};

TEST(SceneFileRefuses, WrongFieldsByNameWithTheNearestKnownOne) {
    const WrongField cases[] = {
        {"/gravty", 1, "gravty: is not a field here"},
        {"/entitees", json::array(), "did you mean \"entities\"?"},
        {"/settings", {{"gravty", {0, 0, 0}}}, "settings.gravty: is not a field here (did you mean \"gravity\"?)"},
        {"/settings", 3, "settings: must be an object {…}, got a number"},
        {"/settings", {{"time_step", -1}}, "settings.time_step: must be from 1e-05 to 0.1 s, got -1"},
        {"/settings", {{"substeps", 2.5}}, "settings.substeps: must be a whole number"},
        {"/settings", {{"substeps", 1000}}, "settings.substeps: must be from 1"},
        {"/settings", {{"gravity", {0, 0}}}, "settings.gravity: must be three numbers"},
        {"/settings", {{"gravity", {0, 0, "x"}}}, "settings.gravity[2]: must be a number, got text"},
        {"/settings", {{"sleeping", 1}}, "settings.sleeping: must be true or false"},
        {"/embody_scene", 2, "embody_scene: must be 1, got 2"},
        {"/embody_scene", "1", "embody_scene: must be 1, got text"},
        {"/entities", 5, "entities: must be a list"},
        {"/entities/0", "box", "entities[0]: must be an object"},
        {"/entities/0/pose", {{"positon", {0, 0, 0}}}, "entities[0].pose.positon: is not a field here"},
        {"/entities/0/pose", {{"rotation", {0, 0, 0, 0}}}, "entities[0].pose.rotation: must not be zero"},
        {"/entities/0/pose", {{"rotation", {{"axis", {0, 0, 0}}, {"degrees", 3}}}}, "rotation.axis: must not be zero"},
        {"/entities/0/pose", {{"rotation", {{"axis", {0, 1, 0}}}}}, "rotation.degrees: is missing"},
        {"/entities/0/model", "x", "entities[0].shape: goes without a model"},
        {"/entities/0/shape", {{"type", "bx"}}, "did you mean \"box\"?"},
        {"/entities/0/shape", {{"type", "sphere"}, {"radius", 0}}, "entities[0].shape.radius: must be greater than 0"},
        {"/entities/0/shape", {{"type", "sphere"}, {"radius", -1}}, "entities[0].shape.radius: must be greater than 0"},
        {"/entities/0/shape", {{"type", "sphere"}}, "entities[0].shape.radius: is missing"},
        {"/entities/0/shape", {{"type", "box"}, {"half_extents", {1, -1, 1}}}, "entities[0].shape.half_extents"},
        {"/entities/0/shape", {{"type", "hull"}, {"points", {{0, 0, 0}}}}, "entities[0].shape"},
        {"/entities/0/shape",
         {{"type", "heightfield"}, {"columns", 2}, {"rows", 2}, {"heights", {1, 2, 3}}},
         "heights: must have columns × rows = 4 numbers, has 3"},
        {"/entities/0/shape",
         {{"type", "mesh"}, {"positions", {{0, 0, 0}}}, {"triangles", {{0, 0, 1}}}},
         "triangles[0][2]: must be from"},
        {"/entities/0/shape",
         {{"type", "compound"}, {"children", {{{"type", "plane"}}}}},
         "children[0].type: \"plane\" is not one of"},
        {"/entities/0/attributes", {{"mas", 2}}, "entities[0].attributes.mas"},
        {"/entities/0/attributes", {{"mass", -2}}, "entities[0].attributes.mass"},
        {"/entities/0/attributes", {{"mass", "heavy"}}, "entities[0].attributes.mass"},
        {"/entities/0/attributes", {{"inertia", {{1, 2}, {3}}}}, "entities[0].attributes.inertia"},
        {"/entities/0/color", {0, 0, 2}, "entities[0].color[2]: must be from"},
        {"/entities/0/scale", 0, "entities[0].scale"},
        {"/entities/0/index", 0, "entities[0].index: must be from"},
        {"/entities/0/index", 4294967295u, "entities[0].index: must be from"},
        {"/joints", {{{"type", "hinge"}, {"entity_b", 9}}}, "joints[0].entity_b: there is no entity 9"},
        {"/joints", {{{"type", "hinge"}, {"entity_b", "Door"}}}, "there is no entity named \"Door\""},
        {"/joints", {{{"type", "weld"}, {"entity_b", 1}}}, "joints[0].type: \"weld\" is not one of"},
        {"/joints",
         {{{"type", "fixed"}, {"entity_b", 1}, {"limit", {{"lower", 0}}}}},
         "joints[0].limit: is not a field"},
        {"/joints",
         {{{"type", "hinge"}, {"entity_b", 1}, {"limit", {{"lower", 1}, {"upper", 0}}}}},
         "joints[0].limit: lower must not be above upper"},
        {"/joints", {{{"type", "fixed"}, {"entity_a", 1}, {"entity_b", 1}}}, "must not be entity_a itself"},
        {"/actions", {{{"effect", {{"type", "pause"}}}}}, "actions[0].trigger: is missing"},
        {"/actions", {{{"trigger", {{"type", "tim"}}}, {"effect", {{"type", "pause"}}}}}, "did you mean \"time\"?"},
        {"/actions",
         {{{"trigger", {{"type", "signal"}}}, {"effect", {{"type", "pause"}}}}},
         "say either a key or a button"},
        {"/actions",
         {{{"receiver", "all"}, {"trigger", {{"type", "fall_asleep"}}}, {"effect", {{"type", "pause"}}}}},
         "actions[0].receiver: must be \"any\""},
        {"/actions",
         {{{"trigger", {{"type", "fall_asleep"}}},
           {"effect", {{"type", "set_attribute"}, {"name", "masss"}, {"value", 1}}}}},
         "actions[0].effect.value"},
    };
    for (const WrongField& wrong : cases) {
        json scene = minimal();
        scene[json::json_pointer(wrong.pointer)] = wrong.value;
        EXPECT_NE(message_of(scene).find(wrong.says), std::string::npos)
            << wrong.pointer << " gave: " << message_of(scene) << "\nexpected: " << wrong.says;
    }
}

// Checks that follow from the lists of fields: the path, the error, and what the field must hold.
TEST(SceneFileRefuses, FieldsOfPinsJointsAndActionsByTheirLists) {
    const struct {
        const char* list;
        const char* item;
        const char* says;
    } cases[] = {
        {"/entities/0/pins", R"({"radius": 1})", "pins[0].position: is missing: the place that is held"},
        {"/entities/0/pins", R"({"position": [0, 0, 0], "radius": -1})",
         "entities[0].pins[0].radius: must be from 0.0 to 10000.0 m, got -1"},
        {"/entities/0/pins", R"({"position": [0, 0, 0], "too": 1})",
         "entities[0].pins[0].too: is not a field here (did you mean \"to\"?)"},
        {"/joints", R"({"entity_b": 1})", "joints[0].type: is missing: fixed, ball, hinge or slider"},
        {"/joints", R"({"type": "ball"})", "joints[0].entity_b: is missing: the entity that the joint holds"},
        {"/joints", R"({"type": "ball", "entity_b": 1.5})", "joints[0].entity_b: must be a whole number, got 1.5"},
        {"/joints", R"({"type": "ball", "entity_b": 1, "axis": [1, 0, 0]})", "joints[0].axis: needs an anchor"},
        {"/joints", R"({"type": "hinge", "entity_b": 1, "motor": {"speed": 1}})",
         "joints[0].motor.max_force: is missing: N m of a hinge, N of a slider"},
        {"/joints", R"({"type": "hinge", "entity_b": 1, "motor": {"max_force": -1}})",
         "joints[0].motor.max_force: must be 0.0 or more, got -1"},
        {"/joints", R"({"type": "hinge", "entity_b": 1, "limit": {"lower": 1, "uper": 0}})",
         "joints[0].limit.upper: is missing: maximum angle or displacement"},
        {"/actions", R"({"trigger": {"type": "time", "time": -1}, "effect": {"type": "pause"}})",
         "actions[0].trigger.time: must be 0.0 s or more, got -1"},
        {"/actions", R"({"trigger": {"type": "signal", "kee": "k"}, "effect": {"type": "pause"}})",
         "actions[0].trigger.kee: is not a field here (did you mean \"key\"?)"},
        {"/actions", R"({"trigger": {"type": "enter_volume", "lower": [0, 0, 0]}, "effect": {"type": "pause"}})",
         "actions[0].trigger.upper: is missing: the corner with the greatest coordinates"},
        {"/actions", R"({"trigger": {"type": "fall_asleep"}, "effect": {"typ": "pause"}})",
         "actions[0].effect.type: is missing: set_attribute, apply_impulse"},
    };
    for (const auto& wrong : cases) {
        json scene = minimal();
        scene[json::json_pointer(wrong.list)] = json::array({json::parse(wrong.item)});
        EXPECT_NE(message_of(scene).find(wrong.says), std::string::npos)
            << wrong.item << " gave: " << message_of(scene) << "\nexpected: " << wrong.says;
    }
}

TEST(SceneFileRefuses, ANumberTwice) {
    json scene = minimal();
    scene["entities"][0]["index"] = 4;
    scene["entities"].push_back(scene["entities"][0]);
    EXPECT_NE(message_of(scene).find("entities[1]: has the number 4"), std::string::npos) << message_of(scene);
}

TEST(SceneFileRefuses, WhatIsNoScene) {
    for (const json& nothing : {json(), json(3), json("x"), json::array(), json::object()})
        EXPECT_NE(message_of(nothing), "accepted") << nothing.dump();
}

// The refusal of a file with that text.
std::string refusal_of(const std::string& name, const std::string& text) {
    const Folder folder;
    write(folder.path / name, text);
    const Result<Document> read = load_document(folder.path / name);
    return read.ok() ? "accepted" : read.error().message();
}

TEST(SceneFileRefuses, BrokenFilesWithLineAndColumn) {
    const std::string said = refusal_of("broken.json", "{\n \"embody_scene\": 1,\n \"title\" 3}");
    EXPECT_NE(said.find("broken.json, line 3, column 10"), std::string::npos) << said;
}

TEST(SceneFileRefuses, NumbersThatNoComputerHoldsAndBrokenTextWithTheirField) {
    const Folder folder;
    const fs::path file = folder.path / "broken.json";
    const auto message = [&](const std::string& number) {
        write(file,
              "{\"embody_scene\": 1, \"entities\": [{\"index\": 1}, {\"index\": 2,\n  \"pose\": {\"position\": [0, " +
                  number + ", 0]}}]}");
        const Result<Document> read = load_document(file);
        return read.ok() ? "accepted" : read.error().message();
    };
    EXPECT_NE(message("1e999").find("broken.json, line 2, column "), std::string::npos) << message("1e999");
    EXPECT_NE(message("1e999").find(": entities[1].pose.position[1]: 1e999 is larger"), std::string::npos);
    EXPECT_NE(message("1,,2").find(": entities[1].pose.position[2]: is not JSON: "), std::string::npos)
        << message("1,,2");
    for (const char* number : {"1e999", "1,,2"})
        EXPECT_EQ(message(number).find("json.exception"), std::string::npos) << message(number);
}

TEST(SceneFileRefuses, AFieldTwice) {
    const std::string said = refusal_of(
        "twice.json", "{\"embody_scene\": 1,\n \"entities\": [{\"name\": \"a\", \"scale\": 1,\n  \"scale\": 2}]}");
    EXPECT_NE(said.find("twice.json, line 3, column 3: entities[0].scale: is written a second time"), std::string::npos)
        << said;
}

TEST(SceneFileRefuses, HostileFiles) {
    const Folder folder;
    const fs::path file = folder.path / "hostile.json";
    const std::string deep(1'000'000, '[');
    const std::string garbage = [] {
        std::string text(10'000'000, '\0');
        std::uint64_t word = 1;
        for (char& c : text) c = static_cast<char>((word = word * 6364136223846793005u + 1442695040888963407u) >> 56);
        return text;
    }();
    const std::string hostile[] = {"",
                                   "\0",
                                   "null",
                                   deep,
                                   garbage,
                                   "{\"embody_scene\": 1, \"settings\": {\"time_step\": 1e400}}",
                                   "{\"embody_scene\": 1, \"settings\": {\"time_step\": NaN}}",
                                   "{\"embody_scene\": 1, \"title\": \"\xff\xfe\"}",
                                   "{\"embody_scene\": 1, \"entities\": " + deep};
    for (const std::string& text : hostile) {
        write(file, text);
        const Result<Document> read = load_document(file);
        ASSERT_FALSE(read.ok()) << text.substr(0, 60);
        EXPECT_NE(read.error().where.find("hostile.json"), std::string::npos);
    }
    EXPECT_FALSE(load_document(folder.path / "missing.json").ok());
    EXPECT_FALSE(load_document(folder.path).ok());
}

TEST(SceneFile, SaysEverythingAndReadsItBackAlike) {
    const Document document = samples::everything();
    const json written = document_to_json(document);
    const Result<Document> read = document_from_json(written);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(document_to_json(read.value()).dump(), written.dump());

    // Equal to the last bit, also values that the writer might have lost.
    EXPECT_EQ(read.value().find(2)->pose, document.find(2)->pose);
    EXPECT_EQ(read.value().find(2)->torque.y, 1e-300);
    EXPECT_EQ(read.value().find(2)->attributes, document.find(2)->attributes);
    const auto heights = [](const Document& d) {
        return std::get<physics::HeightfieldShape>(std::get<physics::ShapeDefinition>(d.find(8)->geometry)).heights;
    };
    EXPECT_EQ(heights(read.value()), heights(document));
}

TEST(SceneFile, SavesAndLoadsAlike) {
    const Folder folder;
    const Document document = samples::everything();
    const fs::path file = folder.path / "sub" / "scene.json";
    ASSERT_TRUE(save_document(document, file).ok());
    const Result<Document> read = load_document(file);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(document_to_json(read.value()), document_to_json(document));
}

TEST(SceneFile, WritesShortNumbers) {
    Document document;
    physics::HeightfieldShape field;
    field.columns = field.rows = 2;
    field.heights = {0.1F, 0.2F, 0.3F, 1e-7F};
    samples::add(document, "Field", field, {0.1, 0.2, 0.3});
    const json written = document_to_json(document)["entities"][0];
    EXPECT_EQ(written["shape"]["heights"].dump(), "[0.1,0.2,0.3,1e-07]");
    EXPECT_EQ(written["pose"]["position"].dump(), "[0.1,0.2,0.3]");
}

TEST(SceneFile, NumbersWhatHasNoIndex) {
    json scene = minimal();
    scene["entities"].push_back(scene["entities"][0]);
    scene["entities"][1]["index"] = 5;
    const Result<Document> read = document_from_json(scene);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(read.value().entities[0].index, 5u);
    EXPECT_EQ(read.value().entities[1].index, 6u);
    EXPECT_EQ(read.value().next_index, 7u);
}

TEST(SceneFile, TakesRotationsAndAnchorsAsPeopleWriteThem) {
    json scene = minimal();
    scene["entities"][0]["name"] = "Door";
    scene["entities"][0]["pose"] = {{"position", {1, 0, 0}}, {"rotation", {{"axis", {0, 5, 0}}, {"degrees", 90}}}};
    scene["joints"] = {{{"type", "hinge"}, {"entity_b", "Door"}, {"anchor", {2, 0, 0}}, {"axis", {0, 1, 0}}}};
    const Result<Document> read = document_from_json(scene);
    ASSERT_TRUE(read.ok()) << read.error().message();

    // Both frames are at the same place in the world, with X along the axis.
    const Entity& door = read.value().entities[0];
    const physics::JointDefinition& joint = read.value().joints[0].definition;
    const Transform b = door.pose * joint.frame_b;
    EXPECT_LT(distance(joint.frame_a.position, {2, 0, 0}), 1e-12);
    EXPECT_LT(distance(b.position, {2, 0, 0}), 1e-12);
    EXPECT_LT(distance(rotate(b.rotation, {1, 0, 0}), {0, 1, 0}), 1e-12);
    EXPECT_LT(distance(rotate(door.pose.rotation, {1, 0, 0}), {0, 0, -1}), 1e-12);
}

// Found by tools/soak.sh: both were written in a form that could not be read again.
TEST(SceneFile, ReadsBackWhatItWroteOfTheHighestIndexAndOfHugeAngles) {
    json scene = minimal();
    scene["entities"][0]["index"] = last_document_index;
    scene["entities"][0]["pose"] = {{"rotation", {{"axis", {0, 1e300, 1e300}}, {"degrees", -1e308}}}};
    const Result<Document> read = document_from_json(scene);
    ASSERT_TRUE(read.ok()) << read.error().message();
    const Quat rotation = read.value().entities[0].pose.rotation;
    EXPECT_NEAR(length_squared(Vec3{rotation.x, rotation.y, rotation.z}) + rotation.w * rotation.w, 1, 1e-12);
    EXPECT_EQ(rotation.y, rotation.z);
    const Result<Document> again = document_from_json(document_to_json(read.value()));
    ASSERT_TRUE(again.ok()) << again.error().message();
    EXPECT_EQ(again.value().entities[0].pose.rotation, rotation);

    // An entity without index then gets none.
    scene["entities"].push_back(minimal()["entities"][0]);
    const Result<Document> one_more = document_from_json(scene);
    ASSERT_FALSE(one_more.ok());
    EXPECT_EQ(one_more.error().message(),
              "entities[1]: has no number, and none is left above the highest (give it one that is free)");
}

TEST(SceneFileSaving, KeepsTheOldFileWhereTheNewOneCannotBeWritten) {
    const Folder folder;
    const fs::path file = folder.path / "scene.json";
    ASSERT_TRUE(save_document(samples::floor_and_box(), file).ok());
    // A folder at the path of the file: the rename fails after the draft was written.
    const fs::path taken = folder.path / "taken.json";
    fs::create_directory(taken);
    EXPECT_FALSE(save_document(samples::everything(), taken).ok());
    // A file at the path of the folder.
    EXPECT_FALSE(save_document(samples::everything(), file / "below.json").ok());
    ASSERT_TRUE(load_document(file).ok());
    EXPECT_EQ(document_to_json(load_document(file).value()), document_to_json(samples::floor_and_box()));
    // No drafts are left behind.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 2);
}

TEST(SceneFileSaving, FilesObeyTheUmaskAndKeepTheirMode) {
    const Folder folder;
    const auto mode_of = [](const fs::path& file) {
        struct stat status {};
        EXPECT_EQ(stat(file.c_str(), &status), 0) << file;
        return status.st_mode & 07777;
    };
    const mode_t before = umask(0);
    for (const mode_t mask : {0022, 0077, 0002, 0027}) {
        umask(mask);
        const fs::path file = folder.path / (std::to_string(mask) + ".json");
        EXPECT_TRUE(save_document(samples::floor_and_box(), file).ok());
        EXPECT_EQ(mode_of(file), 0666 & ~mask);
    }
    // A mode that a person set stays, whatever the umask.
    umask(0022);
    const fs::path file = folder.path / "kept.json";
    EXPECT_TRUE(save_document(samples::floor_and_box(), file).ok());
    for (const mode_t mode : {0600, 0640, 0664, 0666}) {
        chmod(file.c_str(), mode);
        EXPECT_TRUE(save_document(samples::floor_and_box(), file).ok());
        EXPECT_EQ(mode_of(file), mode);
    }
    umask(before);
}

TEST(SceneFileSaving, LeavesDevicesAndFoldersWhereTheyAre) {
    const Folder folder;
    const fs::path pipe = folder.path / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const Result<void> saved = save_document(samples::floor_and_box(), pipe);
    ASSERT_FALSE(saved.ok());
    EXPECT_NE(saved.error().message().find("is a folder or a device"), std::string::npos) << saved.error().message();
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(SceneFileSaving, RefusesAFullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    // No file can be made below /dev/full: it is a device, not a folder.
    EXPECT_FALSE(save_document(samples::floor_and_box(), "/dev/full/scene.json").ok());
}

}  // namespace
}  // namespace embody::scene
