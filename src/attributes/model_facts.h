// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "math/mat3.h"
#include "math/transform.h"

namespace embody::attributes {

/// What is known of a model's form. Lengths in metres, in the model's frame (Y up, origin at the centre of the base of
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
    double surface_area = 0;           ///< m²

    /// Primitive that fits, or "convex_hull".
    std::string fitted_shape;  ///< box, sphere, capsule, cylinder, convex_hull
    Vec3 fitted_dimensions;    ///< box: half extents; sphere: (r,0,0); capsule, cylinder: (r, half height, 0)
    Transform fitted_pose;
    double fitted_error = 0;  ///< largest distance between primitive and hull, m
};

/// What a file or catalogue says about a model.
struct ModelFacts {
    std::string name;
    std::vector<std::string> tags;
    std::string catalogue_category;           ///< as the source names it, e.g. "Bedroom"
    std::string folder;                       ///< last folders of the file's path
    std::vector<std::string> material_names;  ///< of the parts, largest area first
    std::optional<bool> movable;              ///< where the catalogue tells
    bool door_or_window = false;
    bool size_is_stated = false;  ///< real size known from the catalogue, else the file's units are taken as metres
    GeometryFacts geometry;
};

}  // namespace embody::attributes
