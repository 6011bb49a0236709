// SPDX-License-Identifier: MIT
// glTF 2.0 (Khronos, 2021), KHR_mesh_quantization, EXT_meshopt_compression (Khronos glTF extension registry).
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "interchange/compact/compact_geometry.h"
#include "interchange/compact/detail_levels.h"
#include "interchange/compact/glb_container.h"
#include "interchange/compact/stored_part.h"
#include "interchange/compact/texture_reduction.h"
#include "math/bounds.h"

namespace embody::interchange {
namespace {

using nlohmann::json;

// glTF's numbers for component types and targets.
constexpr int type_byte = 5120, type_unsigned_short = 5123, type_unsigned_int = 5125, type_float = 5126;
constexpr int target_vertices = 34962, target_indices = 34963;
constexpr double grid = 65535;
constexpr int normal_bits = 8, texture_bits = 15;

Result<void> check(const RawScene& scene) {
    std::size_t triangles = 0;
    for (const RawMesh& mesh : scene.meshes) {
        const std::size_t count = mesh.positions.size();
        if ((!mesh.normals.empty() && mesh.normals.size() != count) ||
            (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != count)) {
            return Error{mesh.name, "has normals or texture coordinates for some vertices only"};
        }
        for (const Vec3f p : mesh.positions) {
            if (!is_finite(to_vec3(p))) return Error{mesh.name, "has a vertex that is not finite"};
        }
        for (const auto& uv : mesh.texture_coordinates) {
            if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
                return Error{mesh.name, "has a texture coordinate that is not finite"};
            }
        }
        for (const auto& t : mesh.triangles) {
            if (std::max({t[0], t[1], t[2]}) >= count) return Error{mesh.name, "has an index out of range"};
        }
        triangles += mesh.triangles.size();
    }
    if (triangles == 0) return Error{"scene", "holds no triangles"};
    return {};
}

Bounds bounds_of(const RawScene& scene) {
    Bounds bounds;
    for (const RawMesh& mesh : scene.meshes) {
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t) bounds.add(to_vec3(mesh.positions[i]));
        }
    }
    return bounds;
}

/// Area-weighted normals of the mesh's own vertices, for meshes that bring none.
std::vector<Vec3f> vertex_normals(const RawMesh& mesh) {
    std::vector<Vec3> sums(mesh.positions.size());
    for (const auto& t : mesh.triangles) {
        const Vec3 a = to_vec3(mesh.positions[t[0]]);
        const Vec3 n = cross(to_vec3(mesh.positions[t[1]]) - a, to_vec3(mesh.positions[t[2]]) - a);
        for (const std::uint32_t i : t) sums[i] += n;
    }
    std::vector<Vec3f> normals;
    normals.reserve(sums.size());
    for (const Vec3 n : sums) normals.push_back(to_vec3f(normalized(n, {0, 1, 0})));
    return normals;
}

/// Builds the JSON and the binary chunk side by side.
class CompactEncoder {
public:
    explicit CompactEncoder(const RawScene& scene) : scene_(scene), bounds_(bounds_of(scene)) {
        const Vec3 size = bounds_.size();
        const double largest = std::max({size.x, size.y, size.z});
        result_.position_step = largest > 0 ? largest / grid : 1;
    }

    CompactGeometry encode() {
        // Meshes of one material become one primitive: fewer draw calls, better packing.
        std::map<int, std::vector<const RawMesh*>> by_material;
        for (const RawMesh& mesh : scene_.meshes) {
            const bool known = mesh.material >= 0 && mesh.material < static_cast<int>(scene_.materials.size());
            if (!mesh.triangles.empty()) by_material[known ? mesh.material : -1].push_back(&mesh);
        }
        json primitives = json::array();
        for (const auto& [material, meshes] : by_material) add_primitive(material, meshes, primitives);
        result_.parts = static_cast<std::uint32_t>(primitives.size());
        finish(std::move(primitives));
        return std::move(result_);
    }

private:
    GridPoint on_grid(Vec3f p) const {
        const Vec3 q = (to_vec3(p) - bounds_.lower) / result_.position_step;
        const auto rounded = [](double v) { return static_cast<std::uint16_t>(std::clamp(v + 0.5, 0.0, grid)); };
        return {rounded(q.x), rounded(q.y), rounded(q.z), 0};
    }

    StoredPart quantize(const std::vector<const RawMesh*>& meshes, bool textured) const {
        StoredPart part;
        std::vector<std::array<float, 4>> normals;
        std::vector<std::array<float, 2>> textures;
        for (const RawMesh* mesh : meshes) {
            const auto first = static_cast<unsigned>(part.positions.size());
            for (const Vec3f p : mesh->positions) part.positions.push_back(on_grid(p));
            for (const Vec3f n : mesh->normals.empty() ? vertex_normals(*mesh) : mesh->normals) {
                const Vec3f unit = to_vec3f(normalized(to_vec3(n), {0, 1, 0}));
                normals.push_back({unit.x, unit.y, unit.z, 0});
            }
            if (textured && !mesh->texture_coordinates.empty()) {
                textures.insert(textures.end(), mesh->texture_coordinates.begin(), mesh->texture_coordinates.end());
            } else if (textured) {
                textures.resize(part.positions.size());
            }
            // Triangles that the grid collapses to a line or a point show nothing and enclose nothing.
            for (const auto& t : mesh->triangles) {
                const GridPoint &a = part.positions[first + t[0]], &b = part.positions[first + t[1]],
                                &c = part.positions[first + t[2]];
                if (a == b || b == c || c == a) continue;
                part.indices.insert(part.indices.end(), {first + t[0], first + t[1], first + t[2]});
            }
        }
        part.normals.resize(normals.size());
        meshopt_encodeFilterOct(part.normals.data(), normals.size(), sizeof(OctNormal), normal_bits, normals[0].data());
        part.textures.resize(textures.size());
        if (textured) {
            meshopt_encodeFilterExp(part.textures.data(), textures.size(), sizeof(ExpTexture), texture_bits,
                                    textures[0].data());
        }
        return part;
    }

    /// Equal vertices become one; order for the packers and the graphics card's caches.
    static void order(StoredPart& part) {
        std::vector<meshopt_Stream> streams{{part.positions.data(), sizeof(GridPoint), sizeof(GridPoint)},
                                            {part.normals.data(), sizeof(OctNormal), sizeof(OctNormal)}};
        if (!part.textures.empty()) streams.push_back({part.textures.data(), sizeof(ExpTexture), sizeof(ExpTexture)});
        std::vector<unsigned> remap(part.positions.size());
        std::size_t count = meshopt_generateVertexRemapMulti(remap.data(), part.indices.data(), part.indices.size(),
                                                             part.positions.size(), streams.data(), streams.size());
        apply(part, remap, count);
        meshopt_optimizeVertexCache(part.indices.data(), part.indices.data(), part.indices.size(), count);
        remap.resize(count);
        count = meshopt_optimizeVertexFetchRemap(remap.data(), part.indices.data(), part.indices.size(), count);
        apply(part, remap, count);
    }

    static void apply(StoredPart& part, const std::vector<unsigned>& remap, std::size_t count) {
        const auto remap_stream = [&](auto& stream) {
            if (stream.empty()) return;
            meshopt_remapVertexBuffer(stream.data(), stream.data(), remap.size(), sizeof stream[0], remap.data());
            stream.resize(count);
        };
        remap_stream(part.positions);
        remap_stream(part.normals);
        remap_stream(part.textures);
        meshopt_remapIndexBuffer(part.indices.data(), part.indices.data(), part.indices.size(), remap.data());
    }

    void add_primitive(int material, const std::vector<const RawMesh*>& meshes, json& primitives) {
        const int stored_material =
            material < 0 ? -1 : add_material(scene_.materials[static_cast<std::size_t>(material)]);
        const bool textured =
            stored_material >= 0 &&
            materials_[static_cast<std::size_t>(stored_material)]["pbrMetallicRoughness"].contains("baseColorTexture");
        StoredPart part = quantize(meshes, textured);
        if (part.indices.empty()) return;
        order(part);

        GridPoint low = part.positions[0], high = low;
        for (const GridPoint& p : part.positions) {
            for (std::size_t i = 0; i < 3; ++i) {
                low[i] = std::min(low[i], p[i]);
                high[i] = std::max(high[i], p[i]);
            }
        }
        json attributes;
        const std::size_t count = part.positions.size();
        attributes["POSITION"] =
            add_accessor(add_vertices(part.positions, nullptr), type_unsigned_short, count, "VEC3");
        accessors_.back()["min"] = {low[0], low[1], low[2]};
        accessors_.back()["max"] = {high[0], high[1], high[2]};
        attributes["NORMAL"] = add_accessor(add_vertices(part.normals, "OCTAHEDRAL"), type_byte, count, "VEC3");
        accessors_.back()["normalized"] = true;
        if (textured) {
            attributes["TEXCOORD_0"] =
                add_accessor(add_vertices(part.textures, "EXPONENTIAL"), type_float, count, "VEC2");
        }
        const bool short_indices = count <= 65535;
        json primitive{{"attributes", std::move(attributes)}};
        primitive["indices"] =
            add_accessor(add_indices(part.indices, count, short_indices ? 2 : 4),
                         short_indices ? type_unsigned_short : type_unsigned_int, part.indices.size(), "SCALAR");
        if (stored_material >= 0) primitive["material"] = stored_material;
        primitives.push_back(std::move(primitive));
        result_.vertices += static_cast<std::uint32_t>(count);
        result_.triangles += static_cast<std::uint32_t>(part.indices.size() / 3);
    }

    int add_accessor(int view, int component_type, std::size_t count, const char* type) {
        accessors_.push_back(
            {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return static_cast<int>(accessors_.size()) - 1;
    }

    template <class Vertex>
    int add_vertices(const std::vector<Vertex>& vertices, const char* filter) {
        std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
        packed.resize(
            meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices.data(), vertices.size(), sizeof(Vertex)));
        return add_packed_view(packed, vertices.size(), sizeof(Vertex), "ATTRIBUTES", filter);
    }

    int add_indices(const std::vector<unsigned>& indices, std::size_t vertices, std::size_t size) {
        std::vector<std::uint8_t> packed(meshopt_encodeIndexBufferBound(indices.size(), vertices));
        packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size()));
        return add_packed_view(packed, indices.size(), size, "TRIANGLES", nullptr);
    }

    /// A view that stands in the fallback buffer, which does not exist, and whose content is packed in the binary
    /// chunk.
    int add_packed_view(const std::vector<std::uint8_t>& packed, std::size_t count, std::size_t stride,
                        const char* mode, const char* filter) {
        json extension{{"buffer", 0},
                       {"byteOffset", append(packed)},
                       {"byteLength", packed.size()},
                       {"byteStride", stride},
                       {"mode", mode},
                       {"count", count}};
        if (filter != nullptr) extension["filter"] = filter;
        const bool indices = std::strcmp(mode, "TRIANGLES") == 0;
        json view{{"buffer", 1},
                  {"byteOffset", fallback_size_},
                  {"byteLength", count * stride},
                  {"target", indices ? target_indices : target_vertices},
                  {"extensions", {{"EXT_meshopt_compression", std::move(extension)}}}};
        if (!indices) view["byteStride"] = stride;
        fallback_size_ += (count * stride + 3) / 4 * 4;
        views_.push_back(std::move(view));
        return static_cast<int>(views_.size()) - 1;
    }

    std::size_t append(const std::vector<std::uint8_t>& bytes) {
        binary_.resize((binary_.size() + 3) / 4 * 4);
        const std::size_t offset = binary_.size();
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        return offset;
    }

    int add_material(const RawMaterial& material) {
        json out{{"name", material.name}};
        json& surface = out["pbrMetallicRoughness"];
        surface["baseColorFactor"] = material.base_color;
        surface["metallicFactor"] = material.metallic;
        surface["roughnessFactor"] = material.roughness;
        Transparency transparency = material.base_color[3] < 1 ? Transparency::blended : Transparency::opaque;
        if (const StoredImage* image = image_of(material); image != nullptr) {
            surface["baseColorTexture"] = {{"index", image->index}};
            transparency = std::max(transparency, image->transparency);
        }
        if (material.emissive != std::array<float, 3>{0, 0, 0}) out["emissiveFactor"] = material.emissive;
        if (transparency == Transparency::cut_out) out["alphaMode"] = "MASK";
        if (transparency == Transparency::blended) out["alphaMode"] = "BLEND";
        if (material.double_sided) out["doubleSided"] = true;
        materials_.push_back(std::move(out));
        return static_cast<int>(materials_.size()) - 1;
    }

    struct StoredImage {
        int index = -1;
        Transparency transparency = Transparency::opaque;
    };

    /// The stored image of a material; null where it has none or the file's is damaged.
    const StoredImage* image_of(const RawMaterial& material) {
        const int index = material.base_color_image;
        if (index < 0 || index >= static_cast<int>(scene_.images.size())) return nullptr;
        const auto [known, is_new] = images_of_.try_emplace(index);
        if (is_new) {
            const RawImage& image = scene_.images[static_cast<std::size_t>(index)];
            if (const auto stored = reduce_texture(image, max_texture_side); stored) {
                known->second = {static_cast<int>(images_.size()), stored->transparency};
                views_.push_back(
                    {{"buffer", 0}, {"byteOffset", append(stored->bytes)}, {"byteLength", stored->bytes.size()}});
                images_.push_back({{"bufferView", views_.size() - 1}, {"mimeType", stored->mime_type}});
                textures_.push_back({{"source", images_.size() - 1}, {"sampler", 0}});
            } else {
                result_.warnings.push_back("texture \"" + image.name + "\" left out: " + stored.error().why);
            }
        }
        return known->second.index < 0 ? nullptr : &known->second;
    }

    void finish(json primitives) {
        const json used = json::array({"EXT_meshopt_compression", "KHR_mesh_quantization"});
        const double step = result_.position_step;
        json document{{"asset",
                       {{"version", "2.0"},
                        {"generator", "Embody"},
                        {"extras", {{"embody", {{"version", compact_geometry_version}}}}}}},
                      {"extensionsUsed", used},
                      {"extensionsRequired", used},
                      {"scene", 0},
                      {"scenes", json::array({{{"nodes", {0}}}})},
                      {"accessors", accessors_},
                      {"bufferViews", views_}};
        document["nodes"] = json::array({{{"mesh", 0},
                                          {"translation", {bounds_.lower.x, bounds_.lower.y, bounds_.lower.z}},
                                          {"scale", {step, step, step}}}});
        document["meshes"] = json::array({{{"primitives", std::move(primitives)}}});
        // glTF wants no empty arrays.
        if (!materials_.empty()) document["materials"] = materials_;
        if (!images_.empty()) {
            document["images"] = images_;
            document["textures"] = textures_;
            document["samplers"] = json::array({json::object()});
        }
        document["buffers"] = {
            {{"byteLength", (binary_.size() + 3) / 4 * 4}},
            {{"byteLength", fallback_size_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
        result_.materials = static_cast<std::uint32_t>(materials_.size());
        result_.images = static_cast<std::uint32_t>(images_.size());
        result_.bytes = join_glb(document, binary_);
    }

    const RawScene& scene_;
    Bounds bounds_;
    CompactGeometry result_;
    std::vector<std::uint8_t> binary_;
    std::size_t fallback_size_ = 0;
    json accessors_ = json::array(), views_ = json::array(), materials_ = json::array(), images_ = json::array(),
         textures_ = json::array();
    std::map<int, StoredImage> images_of_;
};

}  // namespace

Result<CompactGeometry> encode(const RawScene& scene) {
    if (const auto checked = check(scene); !checked) return checked.error();
    CompactGeometry result = CompactEncoder(scene).encode();
    if (result.triangles == 0) return Error{"scene", "has no triangle with an area"};
    auto with_levels = with_detail_levels(result.bytes);
    if (!with_levels) return with_levels.error();
    result.bytes = std::move(*with_levels);
    return result;
}

}  // namespace embody::interchange
