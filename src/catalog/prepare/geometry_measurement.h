// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "attributes/model_facts.h"
#include "catalog/prepare/convex_parts.h"
#include "geometry/volume_estimate.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

struct GeometryMeasurement {
    attributes::GeometryFacts facts;
    std::vector<Vec3f> hull_points;  ///< 4 … 256, model frame
    ConvexParts convex_parts;        ///< no hulls where one is enough or none were asked for
    geometry::VolumeMethod volume_method = geometry::VolumeMethod::no_volume;
    std::size_t triangles = 0,
                triangles_kept = 0;      ///< before and after welding: the difference had no area or was a copy
    std::size_t inconsistent_edges = 0;  ///< of the welded mesh as the file orients it
};

/// Whether things that move as a rule are to be decomposed where their hull has deep hollows.
enum class Decompose : std::uint8_t { no, where_hollow };

/// Measures a scene in the model frame with triangles of finite corners. A flat model has no hull; it gets the box of
/// its bounds, 1 mm thick at least.
GeometryMeasurement measure_geometry(const interchange::RawScene& scene, Decompose decompose);

}  // namespace embody::catalog
