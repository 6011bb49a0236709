// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "interchange/compact/compact_geometry.h"
#include "interchange/compact/detail_levels.h"

namespace embody::interchange {
namespace {

using nlohmann::json;

constexpr int unsigned_short = 5123, unsigned_int = 5125, element_array = 34963;
const Error unreadable{"compact geometry", "is damaged"};

/// Appends packed index buffers to a document and its binary chunk.
class LevelWriter {
public:
    LevelWriter(json& document, std::vector<std::uint8_t>& binary) : document_(document), binary_(binary) {
        fallback_size_ = document_.at("buffers").at(1).at("byteLength").get<std::size_t>();
    }

    /// The number of the new accessor.
    std::size_t add(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
        std::vector<std::uint8_t> packed(meshopt_encodeIndexBufferBound(indices.size(), vertices));
        packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size()));
        const std::size_t size = vertices <= 65535 ? 2 : 4;
        binary_.resize((binary_.size() + 3) / 4 * 4);
        const json extension{{"buffer", 0},        {"byteOffset", binary_.size()}, {"byteLength", packed.size()},
                             {"byteStride", size}, {"mode", "TRIANGLES"},          {"count", indices.size()}};
        binary_.insert(binary_.end(), packed.begin(), packed.end());
        json& views = document_.at("bufferViews");
        views.push_back({{"buffer", 1},
                         {"byteOffset", fallback_size_},
                         {"byteLength", indices.size() * size},
                         {"target", element_array},
                         {"extensions", {{"EXT_meshopt_compression", extension}}}});
        fallback_size_ += (indices.size() * size + 3) / 4 * 4;
        json& accessors = document_.at("accessors");
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", size == 2 ? unsigned_short : unsigned_int},
                             {"count", indices.size()},
                             {"type", "SCALAR"}});
        return accessors.size() - 1;
    }

    void finish() {
        document_.at("buffers").at(0).at("byteLength") = (binary_.size() + 3) / 4 * 4;
        document_.at("buffers").at(1).at("byteLength") = fallback_size_;
        document_.at("asset").at("extras").at("embody")["levels"] = level_errors.size();
    }

private:
    json& document_;
    std::vector<std::uint8_t>& binary_;
    std::size_t fallback_size_;
};

Result<json> levels_of(const json& primitive, const json& document, const GlbView& glb, LevelWriter& writer) {
    const auto part = unpack_part(document, primitive, glb, PartContent::all);
    if (!part) return part.error();
    const double step = document.at("nodes").at(0).at("scale").at(0).get<double>();
    if (!std::isfinite(step)) return unreadable;
    json levels = json::array();
    json accessor = primitive.at("indices");
    const std::vector<std::uint32_t>* written = &part->indices;
    const std::vector<DetailLevel> made = detail_levels(*part);
    for (const DetailLevel& level : made) {
        json entry{{"error", level.error * step}};
        if (!level.indices.empty()) {
            if (level.indices != *written) accessor = writer.add(level.indices, part->positions.size());
            written = &level.indices;
            entry["indices"] = accessor;
        }
        levels.push_back(std::move(entry));
    }
    return levels;
}

Result<std::vector<std::uint8_t>> add_levels(json& document, const GlbView& glb) {
    std::vector<std::uint8_t> binary(glb.binary.begin(), glb.binary.end());
    LevelWriter writer(document, binary);
    for (json& primitive : document.at("meshes").at(0).at("primitives")) {
        auto levels = levels_of(primitive, document, glb, writer);
        if (!levels) return levels.error();
        primitive["extras"]["embody"]["levels"] = std::move(*levels);
    }
    writer.finish();
    return join_glb(document, binary);
}

}  // namespace

Result<std::vector<std::uint8_t>> with_detail_levels(std::span<const std::uint8_t> bytes) {
    const auto glb = split_glb(bytes);
    if (!glb) return glb.error();
    json document = json::parse(glb->json.begin(), glb->json.end(), nullptr, false);
    if (document.is_discarded()) return unreadable;
    try {
        if (document.at("asset").at("extras").at("embody").contains("levels"))
            return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
        return add_levels(document, *glb);
    } catch (const json::exception&) {
        return unreadable;
    }
}

Result<std::vector<std::uint8_t>> to_glb(std::span<const std::uint8_t> bytes) {
    if (const auto view = split_glb(bytes); !view) return view.error();
    // Where no levels can be made the viewer draws what it can read, in full detail.
    auto with_levels = with_detail_levels(bytes);
    return with_levels ? std::move(*with_levels) : std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

}  // namespace embody::interchange
