// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "physics/definitions/field_check.h"
#include "scene/document/document_field.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;
using namespace embody::physics;

namespace {

// An entity by index, or by a name that only one has.
bool read_entity(FieldReader& reader, const char* name, const json& value, const Document& document,
                 EntityIndex& index) {
    const std::string where = reader.path(name);
    if (value.is_string()) {
        const auto& wanted = value.get_ref<const std::string&>();
        std::size_t found = 0;
        for (const Entity& entity : document.entities) {
            if (entity.name != wanted) continue;
            index = entity.index;
            ++found;
        }
        if (found == 0) reader.fail(where, "there is no entity named \"" + wanted + "\"");
        if (found > 1)
            reader.fail(where, std::to_string(found) + " entities are named \"" + wanted + "\"", "name it by index");
        return found == 1;
    }
    double read = 0;
    if (!read_number(value, where, read, reader.error(), {1, 4294967295.0})) return false;
    index = static_cast<EntityIndex>(read);
    if (static_cast<double>(index) == read && document.find(index)) return true;
    reader.fail(where, "there is no entity " + value.dump());
    return false;
}

void read_limit(FieldReader& reader, std::optional<JointLimit>& limit) {
    const json* field = reader.take("limit");
    if (!field) return;
    JointLimit read;
    FieldReader inner(*field, reader.path("limit"), reader.error());
    if (const json* value = inner.need("lower", "rad or m"))
        read_number(*value, inner.path("lower"), read.lower, inner.error());
    if (const json* value = inner.need("upper", "rad or m"))
        read_number(*value, inner.path("upper"), read.upper, inner.error());
    if (inner.finish()) limit = read;
}

void read_motor(FieldReader& reader, std::optional<JointMotor>& motor) {
    const json* field = reader.take("motor");
    if (!field) return;
    JointMotor read;
    FieldReader inner(*field, reader.path("motor"), reader.error());
    inner.number("speed", read.speed);
    if (const json* value = inner.need("max_force", "N, or N m for a hinge"))
        read_number(*value, inner.path("max_force"), read.max_force, inner.error(), not_negative);
    if (inner.finish()) motor = read;
}

// The friendly form: a point and an axis in the world, where the entities stand in the document.
void read_anchor(FieldReader& reader, SceneJoint& joint, const Document& document) {
    std::optional<Vec3> anchor;
    Vec3 axis{1, 0, 0};
    const bool has_axis = reader.vector("axis", axis);
    reader.vector("anchor", anchor);
    if (has_axis && !anchor) return reader.fail(reader.path("axis"), "needs an anchor beside it");
    if (!anchor) return;
    if (length(axis) < 1e-12) return reader.fail(reader.path("axis"), "must not be zero");
    const Transform world{*anchor, from_two_vectors({1, 0, 0}, normalized(axis))};
    const Entity* a = joint.entity_a ? document.find(*joint.entity_a) : nullptr;
    joint.definition.frame_a = a ? inverse(a->pose) * world : world;
    joint.definition.frame_b = inverse(document.find(joint.entity_b)->pose) * world;

    // Checked here, since physics knows the frames alone.
    if (const Result<void> in_range = check_vector("anchor", *anchor, largest_coordinate, "m"); !in_range)
        return reader.fail(reader.path(document_field(in_range.error().where)), in_range.error().why);
    const auto is_near = [](const Transform& frame) {
        return check_vector("", frame.position, largest_coordinate).ok();
    };
    if (!is_near(joint.definition.frame_a) || !is_near(joint.definition.frame_b))
        reader.fail(reader.path("anchor"), "is more than 1e9 m away from an entity that it holds",
                    "move the anchor or the entities");
}

}  // namespace

Result<SceneJoint> joint_from_json(const json& value, const std::string& where, const Document& document) {
    SceneJoint joint;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    reader.whole("index", joint.index, 1, last_document_index);
    reader.text("name", joint.name);

    // The two ends; without a first one the joint hangs in the world.
    if (const json* field = reader.take("entity_a")) {
        EntityIndex index = 0;
        if (read_entity(reader, "entity_a", *field, document, index)) joint.entity_a = index;
    }
    if (const json* field = reader.need("entity_b", "the entity that the joint holds"))
        read_entity(reader, "entity_b", *field, document, joint.entity_b);
    if (!error && joint.entity_a && *joint.entity_a == joint.entity_b)
        reader.fail(reader.path("entity_b"), "must not be entity_a itself");

    // Frames, or one anchor for both.
    const bool framed = static_cast<int>(reader.transform("frame_a", joint.definition.frame_a)) +
                            static_cast<int>(reader.transform("frame_b", joint.definition.frame_b)) >
                        0;
    if (!error) {
        if (framed && value.contains("anchor")) reader.fail(reader.path("anchor"), "goes without frame_a and frame_b");
        read_anchor(reader, joint, document);
    }
    reader.truth("bodies_collide", joint.definition.bodies_collide);

    // What the joint leaves free.
    std::size_t type = 0;
    reader.need("type", "fixed, ball, hinge or slider");
    if (reader.choice("type", type, {"fixed", "ball", "hinge", "slider"})) {
        if (type == 1) joint.definition.joint = BallJoint{};
        std::optional<JointLimit> limit;
        std::optional<JointMotor> motor;
        if (type >= 2) {
            read_limit(reader, limit);
            read_motor(reader, motor);
        }
        if (type == 2) joint.definition.joint = HingeJoint{limit, motor};
        if (type == 3) joint.definition.joint = SliderJoint{limit, motor};
    }
    reader.finish();
    if (error) return *error;
    const auto* hinge = std::get_if<HingeJoint>(&joint.definition.joint);
    const auto* slider = std::get_if<SliderJoint>(&joint.definition.joint);
    const std::optional<JointLimit> limit = hinge ? hinge->limit : slider ? slider->limit : std::nullopt;
    if (limit && limit->lower > limit->upper) return Error{reader.path("limit"), "lower must not be above upper"};
    return joint;
}

json joint_to_json(const SceneJoint& joint) {
    static_assert(count_members<SceneJoint>() == 5, "each member is written here and read above");
    json out = {{"index", joint.index},
                {"name", joint.name},
                {"entity_b", joint.entity_b},
                {"frame_a", transform_to_json(joint.definition.frame_a)},
                {"frame_b", transform_to_json(joint.definition.frame_b)},
                {"bodies_collide", joint.definition.bodies_collide}};
    if (joint.entity_a) out["entity_a"] = *joint.entity_a;

    // Hinge and slider alike.
    const auto write_drive = [&out](const char* type, const auto& drive) {
        out["type"] = type;
        if (drive.limit) out["limit"] = {{"lower", drive.limit->lower}, {"upper", drive.limit->upper}};
        if (drive.motor) out["motor"] = {{"speed", drive.motor->speed}, {"max_force", drive.motor->max_force}};
    };
    if (std::holds_alternative<FixedJoint>(joint.definition.joint)) out["type"] = "fixed";
    if (std::holds_alternative<BallJoint>(joint.definition.joint)) out["type"] = "ball";
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.definition.joint)) write_drive("hinge", *hinge);
    if (const auto* slider = std::get_if<SliderJoint>(&joint.definition.joint)) write_drive("slider", *slider);
    return out;
}

}  // namespace embody::scene
