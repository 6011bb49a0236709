// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/triangle_mesh.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

/// The meshes of a scene that `is_wanted` takes, as one.
template <class IsWanted>
geometry::TriangleMesh joined(const interchange::RawScene& scene, const IsWanted& is_wanted) {
    geometry::TriangleMesh mesh;
    for (const interchange::RawMesh& part : scene.meshes) {
        if (!is_wanted(part)) continue;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
        for (const auto& t : part.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return mesh;
}

}  // namespace embody::catalog
