// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/structures/structure.h"

namespace embody::scenes {

/// Puts a structure together, on a floor at the height 0.
class Building {
public:
    Building(const physics::WorldSettings& settings, const physics::Material& material);

    physics::ShapeHandle shape(const physics::ShapeDefinition& definition);
    /// A piece at rest where its origin is at `position`; `mass` 0: of the material's density.
    void add(physics::ShapeHandle shape, Vec3 position, Quat rotation = {}, double mass = 0);
    /// A piece that is let go at `from` and comes to rest at `position`.
    void drop(physics::ShapeHandle shape, Vec3 from, Vec3 position);
    /// An immovable body.
    void add_static(physics::ShapeHandle shape, Vec3 position);

    void set_density(double density) { density_ = density; }
    /// Pieces farther than `fallen` (m) from their place count as fallen; 0: they have no place.
    Structure take(double fallen);

private:
    physics::BodyHandle create(const physics::BodyDefinition& definition);

    Structure structure_;
    physics::Material material_;
    double density_ = 1000;  // kg/m³
};

// The families of structures, each in a file of its own.
Structure build_column_10(const physics::WorldSettings& settings);
Structure build_column_30(const physics::WorldSettings& settings);
Structure build_mass_ratio_1000(const physics::WorldSettings& settings);
Structure build_tower_10000(const physics::WorldSettings& settings);
Structure build_restitution_stack(const physics::WorldSettings& settings);
Structure build_pyramid_10(const physics::WorldSettings& settings);
Structure build_pyramid_60(const physics::WorldSettings& settings);
Structure build_pyramid_100(const physics::WorldSettings& settings);
Structure build_wall(const physics::WorldSettings& settings);
Structure build_figure_10(const physics::WorldSettings& settings);
Structure build_jenga(const physics::WorldSettings& settings);
Structure build_large_jenga(const physics::WorldSettings& settings);
Structure build_dominoes(const physics::WorldSettings& settings);
Structure build_pen(const physics::WorldSettings& settings);

/// Two cards that lean on each other, `friction` everywhere: they stand iff it is at least tan(25°)/2.
Structure build_card_pair(const physics::WorldSettings& settings, double friction);
Structure build_card_house(const physics::WorldSettings& settings);

/// Semicircular arch of 11 blocks of mean radius 1 m, `thickness` (m) through: it stands from 0.104589 on.
Structure build_arch(const physics::WorldSettings& settings, double thickness, double friction);

}  // namespace embody::scenes
