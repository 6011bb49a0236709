// SPDX-License-Identifier: MIT
#include "catalog/prepare/part_measurement.h"

#include <algorithm>

#include "catalog/prepare/join_meshes.h"
#include "geometry/topology.h"

namespace embody::catalog {
namespace {

constexpr double part_weld_fraction = 1e-6;  // of the part's diagonal

geometry::SolidAndShell measure(const geometry::TriangleMesh& mesh) {
    const double tolerance = part_weld_fraction * length(geometry::bounds(mesh).size());
    return geometry::integrate_solid_and_shell(geometry::oriented_outwards(geometry::weld(mesh, tolerance)));
}

}  // namespace

std::vector<attributes::PartFacts> measure_parts(const interchange::RawScene& scene) {
    std::vector<attributes::PartFacts> parts;
    for (int material = -1; material < static_cast<int>(scene.materials.size()); ++material) {
        const geometry::TriangleMesh mesh =
            joined(scene, [&](const interchange::RawMesh& m) { return m.material == material; });
        if (mesh.triangles.empty()) continue;
        const std::string name = material < 0 ? "" : scene.materials[static_cast<std::size_t>(material)].name;
        parts.push_back({name, measure(mesh)});
    }
    std::ranges::stable_sort(parts, std::greater{}, [](const auto& part) { return part.form.shell.volume; });

    // Merges the small ones.
    for (; parts.size() > max_parts; parts.pop_back()) {
        attributes::PartFacts& rest = parts[max_parts - 1];
        rest.material.clear();
        rest.form.shell = geometry::combined(rest.form.shell, parts.back().form.shell);
        rest.form.solid = geometry::combined(rest.form.solid, parts.back().form.solid);
    }
    return parts;
}

}  // namespace embody::catalog
