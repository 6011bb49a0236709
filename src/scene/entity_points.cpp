// SPDX-License-Identifier: MIT
// Which entities are points instead of one body, and of what they are made.
#include <cmath>

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

bool is_liquid(const attributes::AttributeSet& attributes) { return attributes.word("kind", "") == "fluid"; }

// Equal where geometry and fineness of a liquid are.
std::string liquid_key(const Entity& entity, const attributes::AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    if (key.empty()) return {};
    return "fluid\n" + key + '\n' + std::to_string(attributes.number("fluid_cell_size", 0)) + '\n' +
           std::to_string(attributes.number("particle_budget", 0));
}

// Equal where the nodes of what changes its form are.
std::string deformable_key(const Entity& entity, const attributes::AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    if (key.empty()) return {};
    std::string own = attributes.word("kind", "") + '\n' + key + '\n' + std::to_string(entity.scale);
    for (const char* count : {"cloth_nodes", "rope_segments"})
        own += '\n' + std::to_string(attributes.number(count, 0));
    return own;
}

bool is_deformable(const std::string& kind) { return kind == "soft" || kind == "cloth" || kind == "rope"; }

}  // namespace

EntityForm EntityBodies::form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body) {
    if (is_granular(attributes)) return {true, grains_key(entity, attributes), {}};
    const std::string kind = attributes.word("kind", "");
    if (!is_deformable(kind) && !scene::is_liquid(attributes)) return {};
    if (is_held_as_body) return {false, {}, "is simulated as rigid, because a joint or a pin holds on to it"};
    if (scene::is_liquid(attributes)) return {true, liquid_key(entity, attributes), {}};
    const auto or_rigid = [&](const auto& made) {
        if (made.ok()) return EntityForm{true, deformable_key(entity, attributes), {}};
        return EntityForm{false, {}, "is simulated as rigid, because " + made.error().why};
    };
    if (kind != "soft") return or_rigid(thin_form(entity, attributes));
    const Result<const catalog::SoftMesh*> mesh = soft_mesh(entity);
    EntityForm soft = or_rigid(mesh);
    if (mesh.ok() && mesh.value()->flatness > 1)
        soft.note = "is so flat that it is computed coarsely, on cells " +
                    std::to_string(std::lround(mesh.value()->flatness)) + " times as wide as thick";
    return soft;
}

Result<PointsDefinition> EntityBodies::points(const Entity& entity, const attributes::AttributeSet& attributes) {
    if (is_granular(attributes)) {
        Result<GrainDefinition> grains = this->grains(entity, attributes);
        if (!grains.ok()) return grains.error();
        return PointsDefinition(std::move(grains).value());
    }
    if (scene::is_liquid(attributes)) {
        Result<LiquidDefinition> liquid = this->liquid(entity, attributes);
        if (!liquid.ok()) return liquid.error();
        return PointsDefinition(std::move(liquid).value());
    }
    Result<physics::DeformableDefinition> deformable = this->deformable(entity, attributes);
    if (!deformable.ok()) return deformable.error();
    return PointsDefinition(std::move(deformable).value());
}

}  // namespace embody::scene
