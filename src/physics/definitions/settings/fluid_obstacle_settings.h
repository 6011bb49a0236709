// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Bodies as obstacles of a fluid (src/physics/fluid/obstacles, stages/fluid/fluids.cpp).
struct FluidObstacleSettings {
    /// Open fraction of a face below which the face is shut: seams between obstacles that touch do not leak. Test:
    /// Settings.AreNoticed.
    float min_open = 0.02f;
    /// Maximum distance by which a body may be placed elsewhere from outside and still count as moved through the
    /// fluid, m. Test: Settings.AreNoticed.
    double max_jump = 0.5;
    /// Thickness added to the hulls of a compound, over its longest side; it closes the gaps between them. Source:
    /// those of catalogue models lie up to 0.8 mm (a mug of 12 cm) inside of the surface that they stand for. Test:
    /// Settings.AreNoticed.
    double seal_fraction = 0.01;
    /// Maximum of that thickness, m. Source: 1.3 mm for a bathtub of 1.7 m. Test: Settings.AreNoticed.
    double max_seal = 0.0015;
    /// Maximum force of contacts and joints that is expected to go on from the last step, over the weight of the body
    /// and of its volume of the fluid, or over that of what it carries. Source: 1 holds what stands still. Test:
    /// Settings.AreNoticed.
    double max_support = 1.5;
    /// Maximum solves of the pressure in a part of a step while sheets answer to it. Source: docs/physics/coupling.md,
    /// "Liquids and what bends": evenly pressed cloth takes two, weave that water falls on four. Test:
    /// Settings.AreNoticed.
    int max_sheet_solves = 5;
    /// Difference of the velocities of sheet and liquid at which these end, of what gravity changes them by in the
    /// part. Source: at 60 Hz 16 mm/s, which Darcy's law lets through dense cotton below 0.1 m of water. Test:
    /// Settings.AreNoticed.
    double sheet_tolerance = 0.1;

    bool operator==(const FluidObstacleSettings&) const = default;
};

template <>
inline constexpr auto settings_of<FluidObstacleSettings> = std::tuple{
    Setting{"min_open", &FluidObstacleSettings::min_open, 1e-4, 0.5},
    Setting{"max_jump", &FluidObstacleSettings::max_jump, 0, 1e6, "m"},
    Setting{"seal_fraction", &FluidObstacleSettings::seal_fraction, 0, 1},
    Setting{"max_seal", &FluidObstacleSettings::max_seal, 0, 1, "m"},
    Setting{"max_support", &FluidObstacleSettings::max_support, 0, 1e3},
    Setting{"max_sheet_solves", &FluidObstacleSettings::max_sheet_solves, 1, 1000},
    Setting{"sheet_tolerance", &FluidObstacleSettings::sheet_tolerance, 0, 1e3},
};
static_assert(setting_count<FluidObstacleSettings> == member_count<FluidObstacleSettings>(), "a setting is in no list");

/// How particles are kept out of obstacles (src/physics/fluid/particles/collide_particles.cpp, catch_up.cpp).
struct FluidCollisionSettings {
    /// Distance that particles keep from obstacles, cells. Test: Settings.AreNoticed.
    float wall_gap = 0.02f;
    /// Depth in an obstacle, cells, beyond which a particle that was pushed out of another obstacle goes back to where
    /// it came from: it is at the seam of the two. Test: Settings.AreNoticed.
    float seam_depth = 0.1f;
    /// Maximum number of walls that a particle slides along in one move. Source: in a corner there are three. Test:
    /// Settings.AreNoticed.
    int max_slides = 3;
    /// Number of passes over all obstacles for a move beside thin walls: one obstacle may have pushed the particle into
    /// another. Test: Settings.AreNoticed.
    int max_sweeps = 2;
    /// Distance of an obstacle from where it was expected, cells, up to which particles are not checked again. Test:
    /// Settings.AreNoticed.
    double min_catch_up = 0.005;
    /// The same distance up to which particles are pushed out one by one; beyond it the liquid is moved as a whole.
    /// Test: Settings.AreNoticed.
    double max_single_catch_up = 0.25;
};

template <>
inline constexpr auto settings_of<FluidCollisionSettings> = std::tuple{
    Setting{"wall_gap", &FluidCollisionSettings::wall_gap, 1e-4, 0.5, "cells"},
    Setting{"seam_depth", &FluidCollisionSettings::seam_depth, 0, 2, "cells"},
    Setting{"max_slides", &FluidCollisionSettings::max_slides, 1, 100},
    Setting{"max_sweeps", &FluidCollisionSettings::max_sweeps, 1, 100},
    Setting{"min_catch_up", &FluidCollisionSettings::min_catch_up, 0, 100, "cells"},
    Setting{"max_single_catch_up", &FluidCollisionSettings::max_single_catch_up, 0, 100, "cells"},
};
static_assert(setting_count<FluidCollisionSettings> == member_count<FluidCollisionSettings>(),
              "a setting is in no list");

/// Drops at walls (src/physics/fluid/particles/drops.cpp).
struct FluidDropSettings {
    /// Distance from a wall, cells, up to which a drop lies on it. Source: half of a particle's edge, which is half a
    /// cell. Test: Settings.AreNoticed.
    float wall_distance = 0.25f;
    /// Cosine of the receding contact angle less that of the advancing one: what holds a drop's rim. Source of the law:
    /// C. Furmidge, "Studies at phase interfaces. I", 1962. The value is assumed for water on glass, glaze and paint:
    /// angles of 30 to 35° and 60 to 75° make 0.3 to 0.6. Test:
    /// Drops.StayWhereTheirRimOrTheirYieldStressHoldsThem,
    /// FluidSpill.DropsClingToAnInclineUntilTheirWeightIsMoreThanTheirRimHolds.
    double angle_hysteresis = 0.4;
};

template <>
inline constexpr auto settings_of<FluidDropSettings> = std::tuple{
    Setting{"wall_distance", &FluidDropSettings::wall_distance, 0, 2, "cells"},
    Setting{"angle_hysteresis", &FluidDropSettings::angle_hysteresis, 0, 2},
};
static_assert(setting_count<FluidDropSettings> == member_count<FluidDropSettings>(), "a setting is in no list");

/// Connected components of liquid that nothing holds (src/physics/fluid/particles/free_components.cpp).
struct FluidComponentSettings {
    /// Distance from a body, cells, up to which a drop belongs to the body's component. Test: Settings.AreNoticed.
    float body_distance = 1.5f;
    /// Number of particles of a component from which on its angular momentum is corrected: the cells do not resolve the
    /// rotation of fewer. Source: eight cells of liquid. Test: Settings.AreNoticed.
    double min_turned_particles = 64;
};

template <>
inline constexpr auto settings_of<FluidComponentSettings> = std::tuple{
    Setting{"body_distance", &FluidComponentSettings::body_distance, 0, 2, "cells"},
    Setting{"min_turned_particles", &FluidComponentSettings::min_turned_particles, 4, 1e9},
};
static_assert(setting_count<FluidComponentSettings> == member_count<FluidComponentSettings>(),
              "a setting is in no list");

}  // namespace embody::physics
