// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "attributes/resolver.h"
#include "folders.h"

namespace embody::attributes {

/// The taxonomy that ships.
inline const Taxonomy& shipped_taxonomy() {
    static const std::unique_ptr<Taxonomy> taxonomy = [] {
        auto loaded = Taxonomy::load(source_folder() / "data/taxonomy");
        EXPECT_TRUE(loaded.ok()) << loaded.error().message();
        return std::move(*loaded);
    }();
    return *taxonomy;
}

/// A model whose name and size alone are known.
inline ModelFacts named(std::string name, Vec3 size = {0.5, 0.5, 0.5}) {
    ModelFacts facts;
    facts.name = std::move(name);
    facts.geometry.size = size;
    facts.size_is_stated = true;
    return facts;
}

/// A closed box of the given extents standing on the origin, as the importer would describe it.
inline ModelFacts closed_box(std::string name, Vec3 size) {
    ModelFacts facts = named(std::move(name), size);
    GeometryFacts& g = facts.geometry;
    g.closed = true;
    g.volume = size.x * size.y * size.z;
    g.volume_method = "polyhedral integration (Mirtich 1996)";
    g.center_of_volume = {0, size.y / 2, 0};
    const Vec3 s = scale(size, size) * (g.volume / 12);
    g.unit_inertia = Mat3::diagonal({s.y + s.z, s.x + s.z, s.x + s.y});
    g.hull_volume = g.volume;
    g.surface_area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    g.fitted_shape = "box";
    g.fitted_dimensions = size * 0.5;
    g.fitted_pose.position = g.center_of_volume;
    return facts;
}

}  // namespace embody::attributes
