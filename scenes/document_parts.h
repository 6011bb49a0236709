// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "scene/document/document.h"

namespace embody::scenes {

/// Linear RGB.
using Color = std::array<double, 3>;
inline constexpr Color ground_color{0.32, 0.34, 0.36};
inline constexpr Color wood_color{0.55, 0.36, 0.18};
inline constexpr Color stone_color{0.45, 0.45, 0.48};
inline constexpr Color steel_color{0.35, 0.4, 0.5};
inline constexpr Color accent_color{0.75, 0.2, 0.1};

/// Builds a document entity by entity. All bodies get the race's material: friction 0.5, restitution 0, 1000 kg/m³.
class DocumentParts {
public:
    DocumentParts(const std::string& title, const std::string& description);

    /// A movable thing; the reference is good until the next one is added.
    scene::Entity& add(const std::string& name, physics::ShapeDefinition shape, Vec3 position, Color color,
                       Quat rotation = {});
    scene::Entity& add_static(const std::string& name, physics::ShapeDefinition shape, Vec3 position, Color color);
    /// A slab of 200 m whose upper side is at y = 0.
    void add_ground();
    /// Four walls around a square of 2·half m.
    void add_pen(double half, double height);
    /// 2D pyramid of 1 m cubes in the plane z = 0, `base` of them in its lowest row, in the middle of `center` (on the
    /// ground).
    void add_pyramid(int base, Vec3 center, Color color);
    /// Changes every movable entity's restitution.
    void set_restitution(double restitution);
    void set_camera(Vec3 position, Vec3 target) { document_.camera = {position, target}; }
    /// At `time`, the disabled entity joins the others.
    void enable_at(double time, scene::EntityIndex entity);
    /// At `time`, the entity gets this velocity.
    void push_at(double time, scene::EntityIndex entity, Vec3 linear_velocity);

    [[nodiscard]] scene::Document take() { return std::move(document_); }

private:
    void act_at(double time, scene::EntityIndex entity, const std::string& name, scene::Effect effect);

    scene::Document document_;
};

}  // namespace embody::scenes
