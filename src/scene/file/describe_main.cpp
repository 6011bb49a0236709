// SPDX-License-Identifier: MIT
// Prints the fields of scenes as JSON, for tools/generate_scene_texts.py: a list of types, each after the types of its
// members.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/file/json/fields_json.h"

namespace embody::scene {
namespace {

using nlohmann::json;

// Names of listed types in the Studio.
template <class Value>
constexpr const char* name_of = nullptr;
template <>
constexpr const char* name_of<physics::WorldSettings> = "SceneSettings";
template <>
constexpr const char* name_of<Camera> = "Camera";
template <>
constexpr const char* name_of<Level> = "Level";
template <>
constexpr const char* name_of<Heading> = "Heading";
template <>
constexpr const char* name_of<Pin> = "Pin";
template <>
constexpr const char* name_of<Light> = "Light";
template <>
constexpr const char* name_of<Tap> = "Tap";
template <>
constexpr const char* name_of<Drain> = "Drain";
template <>
constexpr const char* name_of<KeptForm> = "KeptForm";
template <>
constexpr const char* name_of<Entity> = "Entity";
template <>
constexpr const char* name_of<physics::JointLimit> = "JointLimit";
template <>
constexpr const char* name_of<physics::JointMotor> = "JointMotor";
template <>
constexpr const char* name_of<SceneJoint> = "Joint";
template <>
constexpr const char* name_of<Trigger> = "Trigger";
template <>
constexpr const char* name_of<Effect> = "Effect";
template <>
constexpr const char* name_of<Action> = "Action";

/// Describes a type and the types of its members.
class Describer {
public:
    template <class Value>
    std::string describe() {
        json type = {{"name", name_of<Value>}, {"fields", json::array()}};
        put_fields<Value>(type);
        if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(std::move(type));
        return name_of<Value>;
    }

    json types = json::array();

private:
    // Types of values without members.
    static std::string type_of(const bool*) { return "truth"; }
    static std::string type_of(const int*) { return "whole"; }
    static std::string type_of(const std::uint32_t*) { return "whole"; }
    static std::string type_of(const double*) { return "number"; }
    static std::string type_of(const std::string*) { return "text"; }
    static std::string type_of(const Finish*) { return "finish"; }
    static std::string type_of(const PackedNumbers*) { return "packed"; }
    static std::string type_of(const Vec3*) { return "vector"; }
    static std::string type_of(const Transform*) { return "transform"; }
    static std::string type_of(const Target*) { return "target"; }
    static std::string type_of(const attributes::AttributeValue*) { return "attribute_value"; }
    static std::string type_of(const std::map<std::string, attributes::AttributeValue>*) { return "attributes"; }
    static std::string type_of(const std::optional<std::array<double, 3>>*) { return "color"; }

    template <class Value>
    std::string type_of(const std::optional<Value>*) {
        return type_of(static_cast<const Value*>(nullptr));
    }
    template <class Value>
    std::string type_of(const SharedOptional<Value>*) {
        return type_of(static_cast<const Value*>(nullptr));
    }
    template <class Item>
    std::string type_of(const std::vector<Item>*) {
        return type_of(static_cast<const Item*>(nullptr)) + "[]";
    }
    template <class Value>
    requires Listed<Value> || ListedVariant<Value> std::string type_of(const Value*) { return describe<Value>(); }

    template <class Value>
    void put_fields(json& type) {
        if constexpr (ListedVariant<Value>) {
            put_alternatives(static_cast<const Value*>(nullptr), type);
        } else if constexpr (std::is_same_v<Value, Geometry>) {
            const auto put = [&type](const char* name, const char* kind, const char* meaning) {
                type["fields"].push_back({{"name", name}, {"type", kind}, {"meaning", meaning}, {"saved", "one_of"}});
            };
            put("model", "key", "key of a model of the database (`embody search`)");
            put("shape", "shape", "a primitive, in place of a model");
        } else {
            for_each_field<Value>([&](const auto& field) { put_field<Value>(type, field); });
        }
    }

    template <class... Alternative>
    void put_alternatives(const std::variant<Alternative...>*, json& type) {
        json list = json::array();
        const auto put = [&](json alternative) {
            alternative["word"] = alternatives_of<std::variant<Alternative...>>[list.size()];
            list.push_back(std::move(alternative));
        };
        (put(fields_alone<Alternative>()), ...);
        type["alternatives"] = std::move(list);
    }

    template <class Value>
    json fields_alone() {
        json type = {{"fields", json::array()}};
        put_fields<Value>(type);
        return type;
    }

    template <class Owner, class OneField>
    void put_field(json& type, const OneField& field) {
        using Member = typename OneField::Member;
        if constexpr (OneField::saved == Saved::beside) {
            put_fields<Member>(type);
        } else if constexpr (OneField::saved != Saved::never) {
            json plain;
            write_field(plain, field, Owner{});
            json out = {{"name", field.name},
                        {"type", type_of(static_cast<const Member*>(nullptr))},
                        {"meaning", field.meaning},
                        {"unit", field.range.unit},
                        {"default", plain[field.name]}};
            out["saved"] = OneField::saved == Saved::needed   ? "needed"
                           : OneField::saved == Saved::always ? "always"
                                                              : "when_set";
            if (field.range.low == attributes::positive.low)
                out["above"] = 0;
            else if (std::isfinite(field.range.low))
                out["low"] = field.range.low;
            if (std::isfinite(field.range.high)) out["high"] = field.range.high;
            type["fields"].push_back(std::move(out));
        }
    }
};

}  // namespace
}  // namespace embody::scene

int main() {
    embody::scene::Describer describer;
    describer.describe<embody::scene::Heading>();
    describer.describe<embody::scene::Entity>();
    describer.describe<embody::scene::SceneJoint>();
    describer.describe<embody::scene::Action>();
    std::puts(describer.types.dump(1).c_str());
    return 0;
}
