// SPDX-License-Identifier: MIT
// Which entities are points instead of one body, and of what they are made.
#include "scene/entity_body.h"

namespace embody::scene {

namespace {

bool is_granular(const attributes::AttributeSet& attributes) { return attributes.word("kind", "") == "granular"; }

// Equal where geometry and size of the grains are.
std::string grains_key(const Entity& entity, const attributes::AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    if (key.empty()) return {};
    return "granular\n" + key + '\n' + std::to_string(attributes.number("simulated_diameter", 0)) + '\n' +
           std::to_string(attributes.number("grain_budget", 0));
}

// Equal where the form of a soft thing is.
std::string soft_key(const Entity& entity, const attributes::AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    return key.empty() ? key : "soft\n" + key + '\n' + std::to_string(entity.scale);
}

}  // namespace

EntityForm EntityBodies::form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body) {
    if (is_granular(attributes)) return {true, grains_key(entity, attributes), {}};
    if (attributes.word("kind", "") != "soft") return {};
    if (is_held_as_body) return {false, {}, "is simulated as rigid, because a joint or a pin holds on to it"};
    const Result<const catalog::SoftMesh*> mesh = soft_mesh(entity);
    if (!mesh.ok()) return {false, {}, "is simulated as rigid, because " + mesh.error().why};
    return {true, soft_key(entity, attributes), {}};
}

Result<PointsDefinition> EntityBodies::points(const Entity& entity, const attributes::AttributeSet& attributes) {
    if (is_granular(attributes)) {
        Result<GrainDefinition> grains = this->grains(entity, attributes);
        if (!grains.ok()) return grains.error();
        return PointsDefinition(std::move(grains).value());
    }
    Result<physics::DeformableDefinition> soft = this->soft(entity, attributes);
    if (!soft.ok()) return soft.error();
    return PointsDefinition(std::move(soft).value());
}

}  // namespace embody::scene
