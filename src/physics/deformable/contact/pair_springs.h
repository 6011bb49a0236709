// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <tuple>
#include <utility>

#include "physics/deformable/contact/thin_pairs.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Memory of a contact of two sheets or ropes from the last substep.
struct ThinContact {
    ThinFeature kind = ThinFeature::node_on_triangle;
    bool is_swapped = false;
    std::uint32_t first = 0, second = 0;
    Vec3 normal;      ///< from the second to the first
    double push = 0;  ///< N, without the force that separates overlapping ones
    Vec3 hold;        ///< m
    bool sticks = true;
    double stiffness = 0;  ///< N/m
    double carried = 0;    ///< what it has borne lately, as a mass, kg
    Vec3 place;            ///< on the first, when the last substep began, world, m
    Vec3 force;            ///< on the first in the last substep, friction too, N

    [[nodiscard]] auto key() const { return std::tuple(kind, is_swapped, first); }
};
/// By the slots of the two, the lower first; each sorted by key().
using ThinContacts = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<ThinContact>>;

/// A sheet or rope among those that are solved together.
struct ThinMember {
    ThinSurface surface;
    std::uint32_t slot = 0;
    std::uint32_t first = 0;            ///< number of its first node among those of all
    std::vector<double> load;           ///< kg a node: of bodies that lie on it
    std::span<const double> stiffness;  ///< N/m a node, of it alone
    std::span<const Mat3> directed;     ///< of a rope: the same by direction
};
/// Nodes of two members that are held at the other, by ties or by one body; of a sheet with itself those that ties
/// hold, in `of_a`. None: empty.
struct HeldNodes {
    std::vector<bool> of_a, of_b;
    bool are_of_one = false;  ///< of a sheet with itself
    /// Whether features with these nodes cannot be parted: one has such a node, of a sheet with itself both have.
    [[nodiscard]] bool hold(bool is_swapped, std::span<const std::uint32_t> first,
                            std::span<const std::uint32_t> second) const;
};
/// Takes out the candidates of two members that cannot be parted.
void leave_out_held(const ThinSurface& a, const ThinSurface& b, const HeldNodes& held,
                    std::vector<ThinCandidate>& candidates);
/// Two members, by index, the lower slot first, with their candidates; or one with itself.
struct ThinPair {
    std::uint32_t a = 0, b = 0;
    PairFriction friction;
    std::vector<ThinCandidate> candidates;
    HeldNodes held;
};

/// Two features that would meet within a substep.
struct ThinMeeting {
    std::uint32_t pair = 0;  ///< of those that are solved together
    ThinCandidate candidate;
    ThinPoints points;  ///< nearest when they meet; `away`: of these when the substep began
    Vec3 normal;        ///< from the second to the first when they meet, unit
};

/// Contacts between sheets and ropes, as springs of two to four nodes each, one-sided and with friction, like those
/// with bodies. Their forces are equal and opposite, so they keep the total momentum.
class PairSprings {
public:
    struct Start {
        double h = 0;        ///< length of the substep, s
        double gravity = 0;  ///< m/s²
        double mass = 0;     ///< of all that a contact may carry, kg
        ThinContactSettings settings = {};
    };
    /// Begins a substep.
    void begin(std::span<const ThinMember> members, std::span<const ThinPair> pairs, const ThinContacts& memories,
               const Start& start);
    /// Adds a contact for each of these, along its normal; one that was added before gets the force that it had in the
    /// last solve, with these moves, to begin with (the method of multipliers). `members` and `pairs` as in begin().
    void add(std::span<const ThinMember> members, std::span<const ThinPair> pairs,
             std::span<const ThinMeeting> meetings, std::span<const Vec3> moves);
    /// As TouchSprings::choose(), for moves of all nodes.
    bool choose(std::span<const Vec3> moves, bool is_predicted);
    /// Remembers all.
    void finish(std::span<const Vec3> moves, ThinContacts& memories);
    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_; }

private:
    using Slots = std::pair<std::uint32_t, std::uint32_t>;
    struct Found;
    struct Search;
    void add(const Search& search, const Found& found);

    Start start_;
    std::vector<TouchSpring> springs_;
    std::vector<ThinContact> features_;  // of the springs: only what they connect, without forces
    std::vector<std::uint32_t> pair_;    // of the springs
    std::vector<Slots> slots_;           // of the pairs
};

}  // namespace embody::physics::deformable
