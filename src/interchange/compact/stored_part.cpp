// SPDX-License-Identifier: MIT
#include "interchange/compact/stored_part.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace embody::interchange {
namespace {

using nlohmann::json;

constexpr std::size_t max_elements = 100'000'000;
const Error damaged_part{"compact geometry", "is damaged"};

/// A view that encode() wrote: what is packed where. The numbers are unchecked until unpack.
struct PackedView {
    std::span<const std::uint8_t> packed;
    std::size_t count = 0, stride = 0;
};

Result<PackedView> packed_view_of(const json& document, const json& number, const GlbView& glb) {
    const json& accessor = document.at("accessors").at(number.get<std::size_t>());
    const json& view = document.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const json& extension = view.at("extensions").at("EXT_meshopt_compression");
    const auto offset = extension.at("byteOffset").get<std::size_t>();
    const auto length = extension.at("byteLength").get<std::size_t>();
    if (offset > glb.binary.size() || length > glb.binary.size() - offset) return damaged_part;
    PackedView packed{glb.binary.subspan(offset, length), extension.at("count").get<std::size_t>(),
                      extension.at("byteStride").get<std::size_t>()};
    if (packed.count > max_elements || packed.count != accessor.at("count").get<std::size_t>()) return damaged_part;
    return packed;
}

template <class Vertex>
Result<std::vector<Vertex>> unpack_vertices(const PackedView& view) {
    std::vector<Vertex> vertices;
    // A byte of the packed form stands for 64 bytes of vertices at most; a longer count is a bomb.
    if (view.stride != sizeof(Vertex) || view.count > view.packed.size() * 64 / sizeof(Vertex)) return damaged_part;
    vertices.resize(view.count);
    if (meshopt_decodeVertexBuffer(vertices.data(), view.count, view.stride, view.packed.data(), view.packed.size()) !=
        0) {
        return damaged_part;
    }
    return vertices;
}

Result<std::vector<std::uint32_t>> unpack_indices(const PackedView& view, std::size_t vertices) {
    // At least one byte a triangle.
    if (view.count % 3 != 0 || (view.stride != 2 && view.stride != 4) || view.count / 3 > view.packed.size())
        return damaged_part;
    std::vector<std::uint32_t> indices(view.count);
    if (meshopt_decodeIndexBuffer(indices.data(), view.count, sizeof indices[0], view.packed.data(),
                                  view.packed.size()) != 0 ||
        std::ranges::any_of(indices, [vertices](std::uint32_t index) { return index >= vertices; })) {
        return damaged_part;
    }
    return indices;
}

}  // namespace

Result<StoredPart> unpack_part(const json& document, const json& primitive, const GlbView& glb, PartContent content) {
    const json& attributes = primitive.at("attributes");
    const auto position_view = packed_view_of(document, attributes.at("POSITION"), glb);
    const auto index_view = packed_view_of(document, primitive.at("indices"), glb);
    if (!position_view || !index_view) return damaged_part;
    auto positions = unpack_vertices<GridPoint>(*position_view);
    if (!positions) return damaged_part;
    auto indices = unpack_indices(*index_view, positions->size());
    if (!indices) return damaged_part;
    StoredPart part{.positions = std::move(*positions), .normals = {}, .textures = {}, .indices = std::move(*indices)};
    if (content == PartContent::surface) return part;

    const auto normal_view = packed_view_of(document, attributes.at("NORMAL"), glb);
    if (!normal_view) return damaged_part;
    auto normals = unpack_vertices<OctNormal>(*normal_view);
    if (!normals || normals->size() != part.positions.size()) return damaged_part;
    meshopt_decodeFilterOct(normals->data(), normals->size(), sizeof(OctNormal));
    part.normals = std::move(*normals);
    if (!attributes.contains("TEXCOORD_0")) return part;
    const auto texture_view = packed_view_of(document, attributes.at("TEXCOORD_0"), glb);
    if (!texture_view) return damaged_part;
    auto textures = unpack_vertices<ExpTexture>(*texture_view);
    if (!textures || textures->size() != part.positions.size()) return damaged_part;
    part.textures = std::move(*textures);
    return part;
}

}  // namespace embody::interchange
