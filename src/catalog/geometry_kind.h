// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace embody::catalog {

/// The paper's four kinds of model geometry.
enum class GeometryKind : std::uint8_t { mesh, point_cloud, voxel, analytical };

/// "mesh", "point_cloud", "voxel" or "analytical": in the database and in every JSON.
constexpr const char* name_of(GeometryKind kind) {
    constexpr const char* names[] = {"mesh", "point_cloud", "voxel", "analytical"};
    return names[static_cast<int>(kind)];
}

/// The kind of that name; a mesh where there is none.
constexpr GeometryKind kind_from_name(std::string_view name) {
    for (const auto kind : {GeometryKind::point_cloud, GeometryKind::voxel, GeometryKind::analytical})
        if (name == name_of(kind)) return kind;
    return GeometryKind::mesh;
}

}  // namespace embody::catalog
