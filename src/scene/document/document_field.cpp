// SPDX-License-Identifier: MIT
#include "scene/document/document_field.h"

#include <array>
#include <string_view>

#include "attributes/registry.h"

namespace embody::scene {

namespace {

struct Spelling {
    std::string_view physics, document;
};

constexpr std::array<Spelling, 8> of_entities = {{{"position", "pose.position"},
                                                  {"rotation", "pose.rotation"},
                                                  {"material.", "attributes."},
                                                  {"mass.", "attributes."},
                                                  {"attributes: ", "attributes."},
                                                  {"shape: ", "shape."},
                                                  {"rayleigh_damping", "attributes.damping_rayleigh"},
                                                  {"friction", "attributes.friction_dynamic"}}};
constexpr std::array<Spelling, 3> of_joints = {{{"joint.", ""}, {"body_a", "entity_a"}, {"body_b", "entity_b"}}};

/// Whether `field` is `name` or a part of it; a name that ends in '.' or ' ' is a prefix.
bool is_or_is_in(std::string_view field, std::string_view name) {
    if (!field.starts_with(name)) return false;
    const std::string_view rest = field.substr(name.size());
    return rest.empty() || name.ends_with('.') || name.ends_with(' ') || rest.front() == '.' || rest.front() == '[';
}

template <std::size_t count>
std::string respelled(const std::string& field, const std::array<Spelling, count>& spellings) {
    for (const Spelling& spelling : spellings)
        if (is_or_is_in(field, spelling.physics))
            return document_field(std::string(spelling.document) + field.substr(spelling.physics.size()));
    return document_field(field);
}

}  // namespace

std::string document_field(std::string field) {
    const std::size_t size = field.size();
    if (size < 3 || field[size - 2] != '.' || field.back() < 'x' || field.back() > 'z') return field;
    const std::string component = "[" + std::to_string(field.back() - 'x') + "]";
    return field.substr(0, size - 2) + component;
}

std::string entity_field(const std::string& field) {
    const std::string spelled = respelled(field, of_entities);
    const bool is_attribute = attributes::describe(field.substr(0, field.find_first_of(".["))) != nullptr;
    return spelled == field && is_attribute ? "attributes." + field : spelled;
}

std::string joint_field(const std::string& field) { return respelled(field, of_joints); }

Error in_place(const std::string& place, Error error) {
    if (!place.empty()) error.where = error.where.empty() ? place : place + ": " + error.where;
    return error;
}

}  // namespace embody::scene
