// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/document/entity.h"

namespace embody::scene {

/// Key of a thing that is made from a geometry and other values. Equal keys mean equal things.
struct GeometryKey {
    enum class Of : std::uint8_t {
        nobody_else,  ///< too large to be compared
        primitive,
        model,
    };
    Of of = Of::nobody_else;
    std::vector<std::string> words;
    std::vector<double> numbers;

    /// Whether other things may have the same key.
    [[nodiscard]] bool is_shared() const { return of != Of::nobody_else; }
    friend std::partial_ordering operator<=>(const GeometryKey&, const GeometryKey&) = default;
    friend bool operator==(const GeometryKey&, const GeometryKey&) = default;
};

/// Convex primitives: by their kind and all their numbers. Compounds, planes, heightfields and meshes are too large, or
/// occur only once.
GeometryKey key_of(const physics::ShapeDefinition& shape);
/// A model by its key, without its scale.
GeometryKey key_of_model(const std::string& key);
/// The key of an entity's geometry.
GeometryKey key_of(const Geometry& geometry);

}  // namespace embody::scene
