// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "physics/inter/world.h"

namespace embody::physics {

enum class MatterKind { rigid, jointed, cloth, rope, solid, liquid, grains };
std::string name_of(MatterKind kind);

/// A world without air, wind and motors, in which things of these kinds are thrown over a floor or into a tub, whose
/// ground is at y = 0.
struct MatterScene {
    std::unique_ptr<World> world;
    std::vector<MatterKind> kinds;  ///< of its things, from the lowest up

    /// The kinds that it has, each once, joined by "+".
    [[nodiscard]] std::string kinds_together() const;
};

/// Up to four things of 0.1 to 50 kg, one over the other and apart, each of its own seed: of them only those are
/// there whose bit is set in `kept`, where they would be among the others.
MatterScene random_matter(std::uint64_t seed, std::uint32_t kept = ~0u);

}  // namespace embody::physics
