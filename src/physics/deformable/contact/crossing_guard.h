// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/cloth/cloth_layers.h"
#include "physics/deformable/contact/pair_springs.h"
#include "physics/deformable/contact/time_of_impact.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Keeps sheets and ropes from passing through each other and themselves in a substep, whatever they do
/// (docs/physics/thin-contact.md): what has no edge in a triangle before it has none afterwards.
class CrossingGuard {
public:
    /// Two members, by index, that may meet; or one with itself, a sheet with its layers.
    struct Pair {
        std::uint32_t a = 0, b = 0;
        ClothLayers* layers = nullptr;
        HeldNodes held;  ///< features with these may meet
    };
    /// As its substep begins; these outlive it.
    CrossingGuard(std::span<const ThinMember> members, std::span<const Pair> pairs, TaskPool& workers)
        : members_(members), pairs_(pairs), workers_(&workers) {}

    /// Features that would meet by these moves of the nodes of all members, m, in a fixed order.
    [[nodiscard]] std::vector<ThinMeeting> find(std::span<const Vec3> moves) const;
    /// Changes the moves so that none meet: those that would move together (X. Provot, "Collision and self-collision
    /// handling in cloth model dedicated to design garments", 1997). Momentum is kept. `compliance`: of the nodes,
    /// 1/kg; 0: those stay where they are, and what they would meet.
    void hold(std::span<const double> compliance, std::span<Vec3> moves);

private:
    [[nodiscard]] std::vector<ThinCandidate> candidates_of(const Pair& pair, std::span<const Vec3> moves) const;
    [[nodiscard]] std::span<const Vec3> part(std::span<const Vec3> moves, std::uint32_t member) const {
        return moves.subspan(members_[member].first, members_[member].surface.nodes->size());
    }
    [[nodiscard]] bool is_tangled(std::uint32_t first, std::span<const std::uint32_t> of_first, std::uint32_t second,
                                  std::span<const std::uint32_t> of_second) const;

    std::span<const ThinMember> members_;
    std::span<const Pair> pairs_;
    TaskPool* workers_;
};

}  // namespace embody::physics::deformable
