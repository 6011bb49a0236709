// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "geometry/solid_and_shell.h"
#include "math/mat3.h"
#include "math/transform.h"

namespace embody::attributes {

/// Standard of the attribute hull_error, m.
inline constexpr double usual_hull_error = 0.01;
/// Fraction of a thing's diagonal: a collision shape this far off the surface is not seen.
inline constexpr double unseen_fraction = 0.02;
/// A convex hull with hollows no deeper than this (m) may replace a thing of this size; below the usual error a
/// decomposition would be no better.
inline double negligible_concavity(Vec3 size) { return std::max(usual_hull_error, unseen_fraction * length(size)); }

/// Surfaces of a model that share a material.
struct PartFacts {
    std::string material;          ///< its name in the file; empty: none, or several
    geometry::SolidAndShell form;  ///< in the model's frame
};

/// Known facts of a model's form. Lengths in metres, in the model's frame (Y up, origin at the centre of the base of
/// its bounds).
struct GeometryFacts {
    Vec3 size;                  ///< extents of the bounds
    bool closed = false;        ///< every part a closed, oriented surface
    double volume = 0;          ///< enclosed, m³
    std::string volume_method;  ///< e.g. "polyhedral integration (Mirtich 1996)"
    double volume_relative_error = 0;
    Vec3 center_of_volume;
    Mat3 unit_inertia = Mat3::zero();  ///< of the enclosed volume at density 1 about its centre, kg m²
    double hull_volume = 0;            ///< of the convex hull, m³
    double hull_concavity = 0;         ///< m, largest distance from a reachable point in the hull to the surface
    double surface_area = 0;           ///< m²

    /// Primitive that fits the hull, or "convex_hull".
    std::string fitted_shape;  ///< box, sphere, capsule, cylinder, convex_hull
    Vec3 fitted_dimensions;    ///< box: half extents; sphere: (r,0,0); capsule, cylinder: (r, half height, 0)
    Transform fitted_pose;
    double fitted_error = 0;  ///< largest distance between primitive and hull, m

    /// By material, largest area first; overlapping volumes count in each. Empty: not known.
    std::vector<PartFacts> parts;
};

/// The same form `factor` times as large: lengths, areas, volumes and moments are scaled.
GeometryFacts scaled(const GeometryFacts& facts, double factor);

/// Everything that a file or catalogue says about a model.
struct ModelFacts {
    std::string name;
    std::vector<std::string> tags;
    std::string catalogue_category;           ///< as the source names it, e.g. "Bedroom"
    std::string folder;                       ///< last folders of the file's path
    std::string stated_thing;                 ///< what the collection's description says the thing is, e.g. "relay"
    std::vector<std::string> material_names;  ///< of the parts, largest area first
    std::optional<bool> movable;              ///< empty where the catalogue does not say
    bool door_or_window = false;
    bool size_is_stated = false;  ///< real size known from the catalogue; else the file's units are taken as metres
    GeometryFacts geometry;
};

/// Largest extent of its bounds, m; 0 where that is not known.
inline double largest_extent(const ModelFacts& facts) {
    const Vec3 size = facts.geometry.size;
    return is_finite(size) ? std::max({size.x, size.y, size.z}) : 0;
}

}  // namespace embody::attributes
