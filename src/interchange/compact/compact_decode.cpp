// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "interchange/compact/compact_geometry.h"
#include "interchange/compact/glb_container.h"
#include "interchange/compact/stored_part.h"

namespace embody::interchange {
namespace {

using nlohmann::json;

constexpr std::size_t max_vertices = 100'000'000;
const Error damaged{"compact geometry", "is damaged"};

/// Reads out of bounds of the JSON throw json::exception, which decode_mesh catches.
Result<geometry::TriangleMesh> mesh_of(const json& document, const GlbView& glb) {
    const int version = document.at("asset").at("extras").at("embody").at("version").get<int>();
    if (version != compact_geometry_version) {
        return Error{"compact geometry",
                     "is of version " + std::to_string(version) + ", this program reads version " +
                         std::to_string(compact_geometry_version),
                     "import the model again"};
    }
    const json& node = document.at("nodes").at(0);
    const auto lower = node.at("translation").get<std::array<double, 3>>();
    const double step = node.at("scale").at(0).get<double>();
    if (!(std::isfinite(step) && step > 0)) return damaged;

    geometry::TriangleMesh mesh;
    for (const json& primitive : document.at("meshes").at(0).at("primitives")) {
        const auto part = unpack_part(document, primitive, glb, PartContent::surface);
        if (!part || mesh.positions.size() + part->positions.size() > max_vertices) return damaged;

        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const GridPoint& q : part->positions) {
            mesh.positions.push_back(
                to_vec3f({lower[0] + step * q[0], lower[1] + step * q[1], lower[2] + step * q[2]}));
        }
        const auto& indices = part->indices;
        for (std::size_t i = 0; i < indices.size(); i += 3)
            mesh.triangles.push_back({first + indices[i], first + indices[i + 1], first + indices[i + 2]});
    }
    if (mesh.triangles.empty() || !geometry::validate(mesh)) return damaged;
    return mesh;
}

}  // namespace

Result<geometry::TriangleMesh> decode_mesh(std::span<const std::uint8_t> bytes) {
    const auto glb = split_glb(bytes);
    if (!glb) return glb.error();
    const json document = json::parse(glb->json.begin(), glb->json.end(), nullptr, false);
    if (document.is_discarded()) return damaged;
    try {
        return mesh_of(document, *glb);
    } catch (const json::exception&) {
        return damaged;
    }
}

}  // namespace embody::interchange
