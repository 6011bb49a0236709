// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "benches/race/shapes.h"
#include "math/transform.h"

namespace embody::race {

/// A movable body; its origin is its centre of mass.
struct RaceBody {
    std::size_t shape = 0;  ///< index into RaceScene::shapes
    Vec3 position;          ///< m
    Quat rotation;
    double mass = 1;  ///< kg
    Vec3 velocity;    ///< m/s
};

struct StaticBox {
    Vec3 half_extents, position;  ///< m
};

/// Ground of triangles: squares of 1 m, centred on the origin, each divided from (x+1, z) to (x, z+1).
struct Terrain {
    int cells = 0;  ///< cells per side; 0: no terrain
    std::vector<Vec3> vertices;
    std::vector<int> indices;  ///< three per triangle, counter-clockwise seen from above
};

/// A change before the step number `frame`.
struct RaceEvent {
    int frame = 0;
    std::optional<RaceBody> spawned;  ///< a new body, or else …
    std::size_t body = 0;             ///< … this one gets …
    Vec3 velocity;                    ///< … this velocity, m/s
};

/// One scene of the race, the same for every engine: friction 0.5, steps of 1/60 s, gravity 9.81 m/s², no damping.
struct RaceScene {
    std::string name;
    std::string what;  ///< description
    std::vector<RaceShape> shapes;
    std::vector<RaceBody> bodies;
    std::vector<StaticBox> statics;
    std::vector<RaceEvent> events;
    Terrain terrain;
    double friction = 0.5;
    double restitution = 0;
    int steps = 600;

    // Conditions that a correct run fulfils.
    double pen_half_width = 0;        ///< of the pen that holds all bodies, m; 0: none
    double pen_height = 0;            ///< m
    std::optional<int> stands_until;  ///< the structure stands before this frame (or to the end, if later)
    std::optional<double> true_top;   ///< height of the highest centre at rest without sinking and falling, m
};

inline constexpr double race_time_step = 1.0 / 60;  ///< s
inline constexpr double race_gravity = 9.81;        ///< m/s², downwards

/// Names of the scenes, in the order they are run.
std::span<const std::string_view> race_scene_names();

/// Builds a scene; std::nullopt for an unknown name.
std::optional<RaceScene> make_race_scene(std::string_view name);

}  // namespace embody::race
