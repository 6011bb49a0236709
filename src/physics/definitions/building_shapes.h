// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/flat_polygon.h"

namespace embody::physics {

struct CompoundChild;

/// What is in a wall's opening.
enum class OpeningKind : std::uint8_t {
    hole,    ///< nothing
    door,    ///< nothing but a frame, which is drawn
    window,  ///< a pane of glass, which collides
};
inline constexpr std::array<const char*, 3> opening_kinds{"hole", "door", "window"};

/// A rectangle that is cut out of a wall. What of it lies outside the wall's straight part cuts nothing.
struct WallOpening {
    double offset = 0;  ///< of its nearer side from the wall's start, m
    double width = 0.9, height = 2.1;
    double sill = 0;  ///< of its lower side over the wall's foot, m
    OpeningKind kind = OpeningKind::hole;
    std::uint32_t owner = 0;  ///< the user's: what stands in it; the physics does not read it

    friend bool operator==(const WallOpening&, const WallOpening&) = default;
};

/// An upright wall from the origin along +X, its foot at y = 0, half its thickness on either side of z = 0.
struct WallShape {
    static constexpr const char* name = "wall";
    double length = 2, height = 2.5, thickness = 0.1;  ///< m
    double rise = 0;                                   ///< so much higher is the wall at its end than at its start, m
    /// Mitred ends: how far the wall's face at -Z, and the one at +Z, is cut back at this end, m; negative: lengthened.
    /// Both 0: a square end. Between the two faces the end runs by way of the middle line's own end where that is
    /// convex, so that three and more walls that meet leave no gap.
    std::array<double, 2> start_cut{}, end_cut{};
    std::vector<WallOpening> openings;

    /// The convex pieces that are left of the wall, and the panes of its windows.
    [[nodiscard]] std::vector<CompoundChild> parts() const;
    /// The wall seen from above: corners [x, z].
    [[nodiscard]] geometry::FlatPolygon footprint() const;
    /// Between these distances from the start the wall has its full thickness; openings cut there.
    [[nodiscard]] std::array<double, 2> straight_part() const;
    [[nodiscard]] double height_at(double x) const;

    friend bool operator==(const WallShape&, const WallShape&) = default;
};
inline constexpr std::size_t max_openings = 256;  ///< of one wall; each makes up to four more parts
inline constexpr double pane_thickness = 0.02;    ///< of a window's glass, m
inline constexpr double thinnest_piece = 1e-4;    ///< m: what is left of a wall and thinner is left out

/// A floor or a ceiling: a simple polygon of corners [x, z], its upper side at y = 0.
struct SlabShape {
    static constexpr const char* name = "slab";
    geometry::FlatPolygon points;
    double thickness = 0.2;  ///< downwards, m

    /// The convex prisms that it consists of.
    [[nodiscard]] std::vector<CompoundChild> parts() const;

    friend bool operator==(const SlabShape&, const SlabShape&) = default;
};
inline constexpr std::size_t max_slab_points = 500;  ///< whether sides cross is tried pair by pair

}  // namespace embody::physics
