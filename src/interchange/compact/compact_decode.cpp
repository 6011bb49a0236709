// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "interchange/compact/compact_geometry.h"
#include "interchange/compact/glb_container.h"

namespace embody::interchange {
namespace {

using nlohmann::json;

constexpr std::size_t max_elements = 100'000'000;
const Error damaged{"compact geometry", "is damaged"};

/// A view that encode() wrote: what is packed where. The numbers are unchecked until unpack.
struct PackedView {
    std::span<const std::uint8_t> packed;
    std::size_t count = 0, stride = 0;
};

/// Reads out of bounds of the JSON throw json::exception, which decode_mesh catches.
Result<PackedView> packed_view_of(const json& document, const json& accessor, const GlbView& glb) {
    const json& view = document.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const json& extension = view.at("extensions").at("EXT_meshopt_compression");
    const auto offset = extension.at("byteOffset").get<std::size_t>();
    const auto length = extension.at("byteLength").get<std::size_t>();
    if (offset > glb.binary.size() || length > glb.binary.size() - offset) return damaged;
    PackedView packed{glb.binary.subspan(offset, length), extension.at("count").get<std::size_t>(),
                      extension.at("byteStride").get<std::size_t>()};
    if (packed.count > max_elements || packed.count != accessor.at("count").get<std::size_t>()) return damaged;
    return packed;
}

Result<std::vector<std::array<std::uint16_t, 4>>> unpack_positions(const PackedView& view) {
    std::vector<std::array<std::uint16_t, 4>> grid_points;
    // A byte of the packed form stands for 8 vertices at most; a longer count is a bomb.
    if (view.stride != sizeof grid_points[0] || view.count > view.packed.size() * 8) return damaged;
    grid_points.resize(view.count);
    if (meshopt_decodeVertexBuffer(grid_points.data(), view.count, view.stride, view.packed.data(),
                                   view.packed.size()) != 0) {
        return damaged;
    }
    return grid_points;
}

Result<std::vector<std::uint32_t>> unpack_indices(const PackedView& view) {
    // At least one byte a triangle.
    if (view.count % 3 != 0 || (view.stride != 2 && view.stride != 4) || view.count / 3 > view.packed.size())
        return damaged;
    std::vector<std::uint32_t> indices(view.count);
    if (meshopt_decodeIndexBuffer(indices.data(), view.count, sizeof indices[0], view.packed.data(),
                                  view.packed.size()) != 0) {
        return damaged;
    }
    return indices;
}

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
        const json& accessors = document.at("accessors");
        const auto position_view =
            packed_view_of(document, accessors.at(primitive.at("attributes").at("POSITION").get<std::size_t>()), glb);
        const auto index_view = packed_view_of(document, accessors.at(primitive.at("indices").get<std::size_t>()), glb);
        if (!position_view || !index_view) return damaged;
        const auto positions = unpack_positions(*position_view);
        const auto indices = unpack_indices(*index_view);
        if (!positions || !indices || mesh.positions.size() + positions->size() > max_elements) return damaged;

        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const auto& q : *positions) {
            mesh.positions.push_back(
                to_vec3f({lower[0] + step * q[0], lower[1] + step * q[1], lower[2] + step * q[2]}));
        }
        for (std::size_t i = 0; i < indices->size(); i += 3) {
            // Checked here against this part; validate() below would let an index reach into the next part.
            for (std::size_t k = i; k < i + 3; ++k) {
                if ((*indices)[k] >= positions->size()) return damaged;
            }
            mesh.triangles.push_back({first + (*indices)[i], first + (*indices)[i + 1], first + (*indices)[i + 2]});
        }
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
