// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "physics/definitions/world_settings.h"
#include "scene/document/action.h"
#include "scene/document/entity.h"
#include "scene/document/scene_joint.h"

namespace embody::scene {

/// Maximum number of entities of one document: more would fill the memory before they were simulated.
inline constexpr std::size_t max_entities = 300'000;

/// Eye position and target of the camera.
struct Camera {
    Vec3 position{4, 3, 6};
    Vec3 target;
};

template <>
inline constexpr auto fields_of<Camera> = std::tuple{
    always_saved("position", &Camera::position, "where the eye is", {.unit = "m"}),
    always_saved("target", &Camera::target, "what it looks at", {.unit = "m"}),
};

/// A storey of a building. What stands below its top and not below its floor is on it.
struct Level {
    std::string name;
    double elevation = 0;  ///< of its floor, m
    double height = 2.5;   ///< from its floor to its ceiling, m
    friend bool operator==(const Level&, const Level&) = default;
};

template <>
inline constexpr auto fields_of<Level> = std::tuple{
    always_saved("name", &Level::name, "what people call it"),
    always_saved("elevation", &Level::elevation, "of its floor", {-1e4, 1e4, "m"}),
    always_saved("height", &Level::height, "from its floor to its ceiling", {0.1, 1e4, "m"}),
};
static_assert(lists_all_members<Level>(), "a member of Level is in no list, or one is there twice");

/// The physics settings of a scene. validate() has the same ranges and decides.
template <>
inline constexpr auto fields_of<physics::WorldSettings> = std::tuple{
    always_saved("gravity", &physics::WorldSettings::gravity, "acceleration of free fall", {.unit = "m/s²"}),
    always_saved("time_step", &physics::WorldSettings::time_step, "simulated time of one step", {1e-5, 0.1, "s"}),
    always_saved("substeps", &physics::WorldSettings::substeps, "parts a step is solved in", {1, 64}),
    always_saved("wind", &physics::WorldSettings::wind, "velocity of the air; it moves cloth", {.unit = "m/s"}),
    always_saved("gustiness", &physics::WorldSettings::gustiness,
                 "root mean square of the wind's changes over its speed", {0, 2}),
    always_saved("gust_time", &physics::WorldSettings::gust_time, "how long a gust lasts", {0.05, 1000, "s"}),
    always_saved("air_density", &physics::WorldSettings::air_density, "of the air", {0, 100, "kg/m³"}),
    never_saved("deformable_substeps", &physics::WorldSettings::deformable_substeps),
    always_saved("time_to_sleep", &physics::WorldSettings::time_to_sleep, "how long what falls asleep was quiet before",
                 {0.05, 60, "s"}),
    always_saved("sleeping", &physics::WorldSettings::sleeping, "whether quiet things fall asleep"),
    always_saved("shock_propagation", &physics::WorldSettings::shock_propagation, "the paper's section IV"),
    always_saved("max_linear_speed", &physics::WorldSettings::max_linear_speed,
                 "faster things are slowed to this, and you are told", {1, 1e6, "m/s"}),
    always_saved("max_angular_speed", &physics::WorldSettings::max_angular_speed, "the same for turning",
                 {1, 1e5, "rad/s"}),
    never_saved("workers", &physics::WorldSettings::workers),
    never_saved("lanes", &physics::WorldSettings::lanes),
    never_saved("solver", &physics::WorldSettings::solver),
};
static_assert(lists_all_members<physics::WorldSettings>(), "a setting is in no list, or one is there twice");

/// The fields of a document as a whole.
struct Heading {
    std::string title = "Untitled";
    std::string description;
    physics::WorldSettings settings{.workers = 0};
    std::optional<Camera> camera;
    std::vector<Level> levels;
    bool sky = false;
    double time_of_day = 14;
};

template <>
inline constexpr auto fields_of<Heading> = std::tuple{
    always_saved("title", &Heading::title, "what the scene is called"),
    saved_when_set("description", &Heading::description, "what it shows"),
    always_saved("settings", &Heading::settings, "the world"),
    saved_when_set("camera", &Heading::camera, "to open the scene with; without, the Studio's own"),
    saved_when_set("levels", &Heading::levels, "storeys of a building, for the plan; no physics"),
    saved_when_set("sky", &Heading::sky, "whether sun and sky are drawn; otherwise the Studio's plain light"),
    saved_when_set("time_of_day", &Heading::time_of_day, "for sun and sky: 6 is sunrise, 18 sunset", {0, 24, "h"}),
};
static_assert(lists_all_members<Heading>(), "a member of Heading is in no list, or one is there twice");

/// The paper's VS = {VSEle_i} (definition 1) with its joints and actions. A plain value: copy, compare, save.
struct Document : Heading {
    std::vector<Entity> entities;    ///< ascending index
    std::vector<SceneJoint> joints;  ///< ascending index
    std::vector<Action> actions;     ///< ascending id

    [[nodiscard]] const Entity* find(EntityIndex index) const;
    [[nodiscard]] Entity* find(EntityIndex index);
    [[nodiscard]] const SceneJoint* find_joint(std::uint32_t index) const;
    /// One more than the highest index ever used here.
    EntityIndex next_index = 1;
};

}  // namespace embody::scene
