// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "physics/inter/world.h"

namespace embody::scenes {

/// A body of a structure, and where its centre of mass is at rest if nothing sinks, leans or falls.
struct Piece {
    physics::BodyHandle body;
    Vec3 place;
};

/// Things built on one another, in a world of their own.
struct Structure {
    std::unique_ptr<physics::World> world;
    std::vector<Piece> pieces;
    double fallen = 0;  ///< a piece farther than this from its place has fallen, m; 0: pieces have no place
};

/// What a structure must be like; what is open is not judged. Sizes and energies without sleeping, so that nothing
/// looks stable only because it sleeps.
struct StructureGoal {
    double seconds = 10;                 ///< stands so long
    std::optional<double> sag;           ///< of the piece that sank most, m
    std::optional<double> drift;         ///< sideways, of the piece that moved most, m
    std::optional<double> energy;        ///< greatest kinetic energy in the last second, J
    std::optional<double> asleep_after;  ///< with sleeping, s
};

/// A structure that tests and the bench share.
struct StructureBuilder {
    std::string_view name;
    std::string_view what;  ///< for people
    StructureGoal goal;
    Structure (*build)(const physics::WorldSettings& settings) = nullptr;
    int pieces = 0;  ///< more is more work
};

/// All structures, the small ones first.
std::span<const StructureBuilder> structure_builders();
/// Null where there is none of that name.
const StructureBuilder* find_structure_builder(std::string_view name);

/// How a structure did.
struct StructureResult {
    bool stands = true;  ///< no piece fell, up to the end
    double fell_at = 0;  ///< s, where it did
    double sag = 0, drift = 0, energy = 0;
    std::optional<double> asleep_after;  ///< all pieces, and they stayed asleep
    double step_milliseconds = 0;        ///< mean without sleeping

    /// The first goal it misses, in words; empty: none.
    [[nodiscard]] std::string_view misses(const StructureGoal& goal) const;
};

/// Runs it twice for the goal's time: without sleeping, then with.
StructureResult run_structure(const StructureBuilder& builder);

}  // namespace embody::scenes
