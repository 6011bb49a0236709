// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/deformable/contact/substep.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// What bears the bodies that deformables push, as springs without nodes (docs/physics/coupling.md, "Supports in the
/// deformable solve"): without them a solve would take a light box on the floor for a free one and push it into there.
/// The body's path includes the forces that the rigid step found, so the solver gets what differs from these.
class SupportSprings {
public:
    /// Begins a substep for the supports of all bodies that one of `springs` may push. `mass`: of the deformables, kg.
    void begin(std::span<const TouchSpring> springs, std::span<const TouchedBody> bodies, double mass,
               const Substep& substep);
    /// The same for the bodies of these numbers.
    void begin(std::span<const std::uint32_t> numbers, std::span<const TouchedBody> bodies, double mass,
               const Substep& substep);
    /// As TouchSprings::choose().
    bool choose(std::span<const BodyMove> body_moves, bool is_predicted, double tolerance);
    /// Moves the bodies by what differs from their paths; stores forces. `fractions`: as of TouchSprings::finish().
    void finish(std::span<const BodyMove> body_moves, double h, std::span<TouchedBody> bodies,
                std::span<const double> fractions = {}) const;
    /// For a solver.
    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_; }

private:
    void add(std::uint32_t number, std::size_t support, const TouchedBody& body, double mass, const Substep& substep);

    struct Source {
        std::uint32_t body = 0;
        std::size_t support = 0;
        Vec3 given;  // N
    };
    std::vector<TouchSpring> contacts_;  // the whole force of each, and how it was chosen
    std::vector<TouchSpring> springs_;   // what differs from the path
    std::vector<Source> sources_;
};

}  // namespace embody::physics::deformable
