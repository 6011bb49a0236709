// SPDX-License-Identifier: MIT
#include "scenes/document_parts.h"
#include "attributes/physical_kind.h"

#include <algorithm>
#include <utility>

#include "foundation/random.h"

namespace embody::scenes {

using scene::Entity;

namespace {

/// Neighbours differ a little, so that single blocks can be told in a wall.
Color shade(Color color, scene::EntityIndex index) {
    const double factor = Random(index).between(0.75, 1.2);
    for (double& channel : color) channel = std::min(1.0, channel * factor);
    return color;
}

}  // namespace

DocumentParts::DocumentParts(const std::string& title, const std::string& description) {
    document_.title = title;
    document_.description = description;
}

Entity& DocumentParts::add(const std::string& name, physics::ShapeDefinition shape, Vec3 position, Color color,
                           Quat rotation) {
    Entity entity;
    entity.index = document_.next_index++;
    entity.name = name;
    entity.geometry = std::move(shape);
    entity.pose = {position, rotation};
    entity.color = shade(color, entity.index);
    entity.attributes = {
        {"density", 1000.0}, {"friction_static", 0.5}, {"friction_dynamic", 0.5}, {"restitution", 0.0}};
    return document_.entities.emplace_back(std::move(entity));
}

Entity& DocumentParts::add_static(const std::string& name, physics::ShapeDefinition shape, Vec3 position, Color color) {
    Entity& entity = add(name, std::move(shape), position, color);
    entity.attributes.erase("density");
    entity.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
    return entity;
}

void DocumentParts::add_ground() { add_static("ground", physics::BoxShape{{100, 1, 100}}, {0, -1, 0}, ground_color); }

void DocumentParts::add_pen(double half, double height) {
    constexpr double thickness = 0.5;
    for (const double side : {-1.0, 1.0}) {
        const double place = side * (half + thickness);
        add_static("wall", physics::BoxShape{{thickness, height / 2, half + 2 * thickness}}, {place, height / 2, 0},
                   stone_color);
        add_static("wall", physics::BoxShape{{half + 2 * thickness, height / 2, thickness}}, {0, height / 2, place},
                   stone_color);
    }
}

void DocumentParts::add_pyramid(int base, Vec3 center, Color color) {
    for (int row = 0; row < base; ++row) {
        for (int i = 0; i < base - row; ++i) {
            const double x = i - 0.5 * (base - 1 - row);
            add("cube", physics::BoxShape{}, center + Vec3{x, 0.5 + row, 0}, color);
        }
    }
}

void DocumentParts::set_restitution(double restitution) {
    for (Entity& entity : document_.entities) entity.attributes["restitution"] = restitution;
}

void DocumentParts::act_at(double time, scene::EntityIndex entity, const std::string& name, scene::Effect effect) {
    scene::Action action;
    action.id = static_cast<std::uint32_t>(document_.actions.size() + 1);
    action.name = name;
    action.receiver = {scene::Target::By::index, entity, {}};
    action.trigger = scene::AtTime{time, std::nullopt};
    action.effect = std::move(effect);
    document_.actions.push_back(std::move(action));
}

void DocumentParts::enable_at(double time, scene::EntityIndex entity) {
    act_at(time, entity, "appear", scene::SetEnabled{true});
}

void DocumentParts::push_at(double time, scene::EntityIndex entity, Vec3 linear_velocity) {
    act_at(time, entity, "push", scene::SetVelocity{linear_velocity, {}});
}

}  // namespace embody::scenes
