// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace embody::geometry {

/// Corners of a polygon in a plane, in order, without the first one again at the end.
using FlatPoint = std::array<double, 2>;
using FlatPolygon = std::vector<FlatPoint>;

/// Positive where the corners go from the first axis to the second.
double signed_area(const FlatPolygon& polygon);

/// Two of the polygon's sides (side i goes from corner i to the next one) that cross or touch besides at a corner that
/// they share; none in a simple polygon.
std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(const FlatPolygon& polygon);

/// Convex polygons that fill a simple one without overlap, each with positive area: triangles by cutting off ears
/// (G. Meisters, "Polygons have ears", 1975), joined while they stay convex (S. Hertel, K. Mehlhorn, 1983), which makes
/// at most four times as many as needed. Empty where the polygon has no area.
std::vector<FlatPolygon> convex_pieces(const FlatPolygon& polygon);

/// The part of a convex polygon between two values of the first coordinate; empty where there is none.
FlatPolygon clipped(const FlatPolygon& polygon, double from, double to);

}  // namespace embody::geometry
