// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A corner of a wire: at an inner node, or between a clamp and the segment before or after it.
struct RopeCorner {
    static constexpr std::uint32_t no_clamp = ~std::uint32_t{0};
    std::size_t fold = 0;      ///< number of its fold, see RopeFolds
    double stiffness = 0;      ///< EI / length, N m
    double length = 0;         ///< of the wire that bends here, m
    Vec3 before, after;        ///< directions along the wire, unit
    bool begins_span = false;  ///< the wire is broken before it, or this is the first
    /// The node that the clamp here holds, and a vector that goes with the clamp, at a right angle to the wire there.
    std::uint32_t clamp = no_clamp;
    Vec3 side;
};

/// Bends of a wire that stay (docs/physics/ropes.md, "Wires"). A corner bends by the change of direction b and keeps a
/// fold p of it, so its moment is stiffness (b - p); where |b - p| is above yield times length, p follows. A fold is a
/// part along each of two axes across the wire, which go along the line without twist: a wire does not twist between
/// its folds, so one angle about itself tells where all of a span point. The first clamp of a span gives that angle;
/// without one it is the angle with the least energy.
class RopeFolds {
public:
    /// Folds of a node: at the node, and where it is clamped between the clamp and the segment before it, after it.
    static constexpr std::size_t at_node = 0, before_clamp = 1, after_clamp = 2, by_node = 3;

    /// `yield`: curvature, 1/m, > 0.
    RopeFolds(std::size_t nodes, double yield) : yield_(yield), folds_(by_node * nodes) {}

    /// Whether bends stay at all; without that nothing else here is asked.
    [[nodiscard]] bool is_active() const { return yield_ < std::numeric_limits<double>::infinity(); }

    /// The folds p that the corners have where they are, by the order of `corners`: with what yields there.
    [[nodiscard]] std::vector<Vec3> at(std::span<const RopeCorner> corners) const;
    /// Keeps what has yielded at these corners.
    void keep(std::span<const RopeCorner> corners);

    /// Takes over the folds of another wire of as many nodes.
    void go_on_from(const RopeFolds& other) { folds_ = other.folds_; }
    /// As in LastingDeformation: two numbers of each of the node's folds; empty where all are zero.
    [[nodiscard]] std::vector<std::array<double, 6>> state() const;
    /// One a node, or empty: none.
    void set_state(std::span<const std::array<double, 6>> states);

private:
    /// A part along each of the two axes, as a complex number.
    using Part = std::array<double, 2>;
    struct Fold {
        Part part{};
        std::uint32_t clamp = RopeCorner::no_clamp;  // that its axes went by when it was kept
    };
    /// A corner now: its axes, the clamp that they go by, and bend and fold along them.
    struct Seen {
        Vec3 first, second;
        std::uint32_t clamp = RopeCorner::no_clamp;
        Part bend{}, fold{};
    };
    [[nodiscard]] std::vector<Seen> see(std::span<const RopeCorner> corners) const;
    static void find_axes(std::span<const RopeCorner> corners, std::span<Seen> seen);
    void find_folds(std::span<const RopeCorner> corners, std::span<Seen> seen) const;

    double yield_;
    std::vector<Fold> folds_;
};

}  // namespace embody::physics::deformable
