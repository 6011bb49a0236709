// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/session/session.h"

namespace embody::scene {

/// A session of primitives with folders of its own.
class SessionTest : public testing::Test {
protected:
    SessionTest() {
        std::string name = (std::filesystem::temp_directory_path() / "embody_session_XXXXXX").string();
        folder_ = mkdtemp(name.data());
        session_ = make();
    }
    ~SessionTest() override { std::filesystem::remove_all(folder_); }

    std::unique_ptr<Session> make() {
        auto made = Session::create(nullptr, {folder_ / "saved", folder_ / "demo"});
        if (!made.ok()) {
            ADD_FAILURE() << made.error().message();
            return nullptr;
        }
        return std::move(made).value();
    }
    /// A command of a client; it must not be refused.
    nlohmann::json run(const std::string& command, const nlohmann::json& params = nlohmann::json::object(),
                       ClientId client = 0) {
        auto result = session_->execute(command, params, client);
        if (!result.ok()) {
            ADD_FAILURE() << command << " " << params.dump() << ": " << result.error().message();
            return {};
        }
        return result.value();
    }
    std::string error_of(const std::string& command, const nlohmann::json& params = nlohmann::json::object(),
                         ClientId client = 0) {
        const auto result = session_->execute(command, params, client);
        return result.ok() ? "accepted" : result.error().message();
    }
    EntityIndex add_box(Vec3 position, double half = 0.25) {
        return run("entity.add", {{"entity",
                                   {{"shape", {{"type", "box"}, {"half_extents", {half, half, half}}}},
                                    {"pose", {{"position", {position.x, position.y, position.z}}}}}}})["index"];
    }
    nlohmann::json document() { return document_to_json(session_->document()); }
    Vec3 where(EntityIndex index) {
        std::vector<EntityState> states;
        session_->read_states(states);
        for (const EntityState& state : states)
            if (state.entity == index) return state.pose.position;
        ADD_FAILURE() << "entity " << index << " is not in the world";
        return {};
    }

    std::filesystem::path folder_;
    std::unique_ptr<Session> session_;
};

/// A random command that may be refused; most are not.
inline nlohmann::json random_command(Random& random, const Document& document, std::string& name) {
    using nlohmann::json;
    const auto any_entity = [&]() -> EntityIndex {
        return document.entities.empty() ? 1 : document.entities[random.below(document.entities.size())].index;
    };
    const auto any_position = [&] { return json{random.between(-5, 5), random.between(0, 5), random.between(-5, 5)}; };
    const json box = {{"shape", {{"type", "box"}, {"half_extents", {0.2, 0.3, 0.4}}}},
                      {"pose", {{"position", any_position()}}}};
    switch (random.below(25)) {
        case 0:
        case 1:
            return name = "entity.add", json{{"entity", box}};
        case 2:
            return name = "entity.add",
                   json{{"entity", box}, {"drop", {{"origin", any_position()}, {"direction", {0.1, -1, 0.2}}}}};
        case 3:
            return name = "entity.remove", json{{"indices", {any_entity(), any_entity()}}};
        case 4:
            return name = "entity.transform",
                   json{{"poses", {{{"index", any_entity()}, {"position", any_position()}}}}};
        case 5: {
            // A drag of things that change.
            json poses = {{{"index", any_entity()}, {"position", any_position()}}};
            const EntityIndex other = any_entity();
            if (other != poses[0]["index"]) poses.push_back({{"index", other}, {"position", any_position()}});
            return name = "entity.transform", json{{"merge", "m"}, {"poses", poses}};
        }
        case 6:
            return name = "entity.update",
                   json{{"index", any_entity()},
                        {"merge", "m"},
                        {"entity", {{"name", "N"}, {"force", any_position()}, {"enabled", true}}}};
        case 7:
            return name = "entity.update",
                   json{{"index", any_entity()}, {"entity", {{"shape", {{"type", "sphere"}, {"radius", 0.3}}}}}};
        case 8:
            return name = "entity.set_attribute", json{{"indices", {any_entity(), any_entity()}},
                                                       {"merge", "m"},
                                                       {"name", "mass"},
                                                       {"value", random.between(0.1, 9)}};
        case 9:
            return name = "entity.reset_attribute", json{{"indices", {any_entity()}}, {"name", "mass"}};
        case 10:
            return name = "entity.duplicate", json{{"indices", {any_entity()}}};
        case 11:
            return name = "entity.drop_to_floor", json{{"indices", {any_entity()}}};
        case 12:
            return name = "joint.add", json{{"type", "ball"}, {"entity_b", any_entity()}, {"anchor", any_position()}};
        case 13:
            return name = "action.add",
                   json{{"trigger", {{"type", "time"}, {"time", 1}}}, {"effect", {{"type", "pause"}}}};
        case 14:
            return name = "scene.settings",
                   json{{"gravity", any_position()}, {"title", "T" + std::to_string(random.below(3))}};
        case 15:
            return name = "entity.drag", json{{"indices", {any_entity(), any_entity()}},
                                              {"drop", {{"origin", any_position()}, {"direction", {0.3, -1, 0.2}}}}};
        case 16:
            return name = "entity.group", json{{"indices", {any_entity(), any_entity()}}};
        case 17:
            return name = "entity.ungroup", json{{"group", "Group"}};
        case 18:
            return name = "entity.array", json{{"indices", {any_entity()}}, {"counts", {2, 1, 2}}};
        case 19:
            return name = "entity.mirror", json{{"indices", {any_entity(), any_entity()}}, {"axis", "z"}};
        case 20:
            return name = "entity.align",
                   json{{"indices", {any_entity(), any_entity()}}, {"axis", "x"}, {"at", "center"}};
        case 21:
            return name = "entity.turn", json{{"indices", {any_entity()}}, {"angle", 0.3}, {"merge", "turn"}};
        case 22:
            return name = "entity.set_group", json{{"indices", {any_entity()}}, {"group", "A/B"}};
        case 23:
            return name = "entity.paste", json{{"part", document_to_json(document)}, {"offset", any_position()}};
        default:
            if (!document.joints.empty()) return name = "joint.remove", json{{"index", document.joints.back().index}};
            if (!document.actions.empty()) return name = "action.remove", json{{"index", document.actions.back().id}};
            return name = "scene.settings", json{{"substeps", 1 + random.below(8)}};
    }
}

}  // namespace embody::scene
