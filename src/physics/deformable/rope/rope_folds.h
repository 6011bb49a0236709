// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/deformable/namespace.h"
#include "physics/deformable/rope/rope_segment.h"
#include "physics/deformable/rope/rope_system.h"

namespace embody::physics::deformable {

/// A corner of a wire: at an inner node, or between a clamp and the segment before or after it.
struct RopeCorner {
    static constexpr std::uint32_t no_clamp = ~std::uint32_t{0};
    /// A direction along the wire: of a segment, or that of the clamp, which turns with a body or not at all.
    struct Side {
        SegmentDirection direction;
        std::size_t segment = FoldRow::none;
        std::uint32_t body = no_body;
    };
    std::size_t fold = 0;      ///< number of its fold, see RopeFolds
    double length = 0;         ///< of the wire that bends here, m
    bool begins_span = false;  ///< the first of those with one angle about the wire itself
    Side before, after;
    /// The node that the clamp here holds, and a vector that goes with the clamp, at a right angle to the wire there.
    std::uint32_t clamp = no_clamp;
    Vec3 normal;
};

/// Bends of a wire that stay (docs/physics/ropes.md, "Wires"). A corner bends by the change of direction b and keeps a
/// fold p of it, so its moment is stiffness (b - p); where |b - p| is above yield times length, p follows. A fold is a
/// part along each of two axes across the wire, which go along the line without twist: a wire does not twist between
/// its folds, so one angle about itself tells where all of a span point. A span's first clamp gives that angle; without
/// one it is the angle with the least energy. A span ends where the wire is broken, and at its second clamp.
class RopeFolds {
public:
    /// Folds of a node: at the node, and where it is clamped between the clamp and the segment before it, after it.
    static constexpr std::size_t at_node = 0, before_clamp = 1, after_clamp = 2, by_node = 3;

    /// `rigidity`: EI, N m². `yield`: curvature, 1/m, > 0.
    RopeFolds(std::size_t nodes, double rigidity, double yield)
        : rigidity_(rigidity), yield_(yield), folds_(is_active() ? by_node * nodes : 0) {}

    /// Whether bends stay at all; without that nothing else here is asked.
    [[nodiscard]] bool is_active() const { return yield_ < std::numeric_limits<double>::infinity(); }

    /// Begins a substep at these corners. `damping`: of the growth of a bend, over the stiffness.
    void begin(std::span<const RopeCorner> corners, double damping);
    /// What bending to these corners takes from there: what it stores, what yields and what damping takes, J.
    [[nodiscard]] double energy(std::span<const RopeCorner> corners) const;
    /// What it stores alone.
    [[nodiscard]] double elastic_energy(std::span<const RopeCorner> corners) const;
    /// energy() as sums of squares about these corners. `fold_limit` as in RopeSettings.
    [[nodiscard]] std::vector<FoldRow> rows(std::span<const RopeCorner> corners, double fold_limit) const;
    /// Keeps what has yielded at these corners.
    void keep(std::span<const RopeCorner> corners);

    /// Takes over the folds of another wire of as many nodes.
    void go_on_from(const RopeFolds& other) {
        if (other.is_active() && is_active()) folds_ = other.folds_;
    }
    /// As in LastingDeformation: two numbers of each of the node's folds; empty where all are zero.
    [[nodiscard]] std::vector<std::array<double, 6>> state() const;
    /// One a node, or empty: none. At first they take the angle with the least energy, also where a clamp holds the
    /// wire: it may be another clamp, or all of it may have been turned.
    void set_state(std::span<const std::array<double, 6>> states);

private:
    /// A part along each of the two axes, as a complex number.
    using Part = std::array<double, 2>;
    struct Fold {
        Part part{};
        std::uint32_t clamp = RopeCorner::no_clamp;  // that its axes went by when it was kept
        Part start{};                                // the bend when the substep began
    };
    /// A corner now: its axes, the clamp that they go by, along them the bend, the kept fold and the bend when the
    /// substep began, and the stiffness of what of the bend is beyond the fold: less where that yields.
    struct Seen {
        Vec3 middle, first, second;
        std::uint32_t clamp = RopeCorner::no_clamp;
        Part bend{}, fold{}, start{};
        double stiffness = 0, damping = 0;  // N m
        [[nodiscard]] Part beyond() const { return {bend[0] - fold[0], bend[1] - fold[1]}; }
        [[nodiscard]] Part grown() const { return {bend[0] - start[0], bend[1] - start[1]}; }
    };
    [[nodiscard]] std::vector<Seen> see(std::span<const RopeCorner> corners, double damping) const;
    static void find_axes(std::span<const RopeCorner> corners, std::span<Seen> seen);
    void find_folds(std::span<const RopeCorner> corners, double damping, std::span<Seen> seen) const;

    double rigidity_, yield_, damping_ = 0;
    std::vector<Fold> folds_;
};

/// Derivatives of RopeFolds::energy(): by the places of the nodes (N) and by the turns of the bodies (N m).
struct FoldGradient {
    FoldGradient(std::size_t nodes, std::size_t bodies) : by_node(nodes), by_turn(bodies) {}
    void add_bends(std::span<const FoldRow> rows);
    /// By the moments about the wire itself, which go along it as without twist.
    void add_links(std::span<const FoldRow> rows);
    void add(const FoldRow& row, double moment);

    std::vector<Vec3> by_node, by_turn;
};

}  // namespace embody::physics::deformable
