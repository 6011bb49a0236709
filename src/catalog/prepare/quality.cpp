// SPDX-License-Identifier: MIT
#include "catalog/prepare/quality.h"

#include <algorithm>
#include <array>

namespace embody::catalog {

int grade_quality(const GeometryMeasurement& measured) {
    std::array<double, 3> extents{measured.facts.size.x, measured.facts.size.y, measured.facts.size.z};
    std::sort(extents.begin(), extents.end());
    const bool is_line = extents[1] < 1e-4 * extents[2];
    if (is_line || 4 * measured.triangles_kept < measured.triangles) return 0;
    if (measured.volume_method == geometry::VolumeMethod::closed_mesh) return 3;
    const bool encloses = measured.volume_method != geometry::VolumeMethod::no_volume;
    return encloses && measured.facts.volume_relative_error <= 0.2 ? 2 : 1;
}

}  // namespace embody::catalog
