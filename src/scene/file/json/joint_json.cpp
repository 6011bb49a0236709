// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "physics/definitions/field_check.h"
#include "scene/document/document_field.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;
using namespace embody::physics;

namespace {

// Replaces an entity's name by its index; the name must be unique.
void replace_name(FieldReader& reader, json& joint, const char* name, const Document& document) {
    const auto field = joint.find(name);
    if (field == joint.end() || !field->is_string()) return;
    const auto wanted = field->get<std::string>();
    std::size_t found = 0;
    for (const Entity& entity : document.entities) {
        if (entity.name != wanted) continue;
        *field = entity.index;
        ++found;
    }
    if (found == 0) reader.refuse(name, "there is no entity named \"" + wanted + "\"");
    if (found > 1)
        reader.refuse(name, std::to_string(found) + " entities are named \"" + wanted + "\"", "name it by index");
}

void check_ends(FieldReader& reader, const SceneJoint& joint, const Document& document) {
    const auto check = [&](const char* name, EntityIndex index) {
        if (reader.ok() && !document.find(index)) reader.refuse(name, "there is no entity " + std::to_string(index));
    };
    if (joint.entity_a) check("entity_a", *joint.entity_a);
    check("entity_b", joint.entity_b);
    if (joint.entity_a == joint.entity_b) reader.refuse("entity_b", "must not be entity_a itself");
}

// The form for people: a point and an axis in the world, with the entities at their poses in the document.
struct Anchor {
    std::optional<Vec3> point;
    std::optional<Vec3> axis;
};

Anchor read_anchor(FieldReader& reader, const json& value) {
    Anchor anchor;
    reader.vector("axis", anchor.axis);
    reader.vector("anchor", anchor.point);
    if (!reader.ok()) return anchor;
    if (anchor.point && (value.contains("frame_a") || value.contains("frame_b")))
        reader.refuse("anchor", "goes without frame_a and frame_b");
    if (anchor.axis && !anchor.point) reader.refuse("axis", "needs an anchor beside it");
    if (anchor.axis && length(*anchor.axis) < 1e-12) reader.refuse("axis", "must not be zero");
    return anchor;
}

void put_at(FieldReader& reader, const Anchor& anchor, SceneJoint& joint, const Document& document) {
    if (!anchor.point) return;
    const Vec3 axis = anchor.axis.value_or(Vec3{1, 0, 0});
    const Transform world{*anchor.point, from_two_vectors({1, 0, 0}, normalized(axis))};
    const Entity* a = joint.entity_a ? document.find(*joint.entity_a) : nullptr;
    joint.definition.frame_a = a ? inverse(a->pose) * world : world;
    joint.definition.frame_b = inverse(document.find(joint.entity_b)->pose) * world;

    // Checked here, since physics sees only the frames.
    if (const Result<void> in_range = check_vector("anchor", *anchor.point, largest_coordinate, "m"); !in_range)
        return reader.refuse(document_field(in_range.error().where), in_range.error().why);
    const auto is_in_range = [](const Transform& frame) {
        return check_vector("", frame.position, largest_coordinate).ok();
    };
    if (!is_in_range(joint.definition.frame_a) || !is_in_range(joint.definition.frame_b))
        reader.refuse("anchor", "is more than 1e9 m away from an entity that it holds",
                      "move the anchor or the entities");
}

}  // namespace

Result<SceneJoint> joint_from_json(const json& value, const std::string& where, const Document& document) {
    json named = value;
    SceneJoint joint;
    std::optional<Error> error;
    FieldReader reader(named, where, error);
    if (error) return *error;
    for (const char* end : {"entity_a", "entity_b"}) replace_name(reader, named, end, document);
    const Anchor anchor = read_anchor(reader, value);
    read_whole(reader, joint);
    if (!error) check_ends(reader, joint, document);
    if (!error) put_at(reader, anchor, joint, document);
    if (error) return *error;
    return joint;
}

json joint_to_json(const SceneJoint& joint) {
    json out = json::object();
    write_fields(out, joint);
    return out;
}

}  // namespace embody::scene
