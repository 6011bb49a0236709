// SPDX-License-Identifier: MIT
#include "interchange/assimp/assimp_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

#include "interchange/assimp/named_materials.h"
#include "interchange/image/image_codec.h"
#include "interchange/screen_color.h"
#include "interchange/texture_reader.h"

namespace embody::interchange {
namespace {

Result<std::vector<std::uint8_t>> bytes_of(const aiTexture& texture) {
    if (texture.mHeight == 0) {
        const auto* begin = reinterpret_cast<const std::uint8_t*>(texture.pcData);
        return std::vector<std::uint8_t>(begin, begin + texture.mWidth);
    }
    const std::size_t count = std::size_t{texture.mWidth} * texture.mHeight;
    if (texture.mWidth > 32768 || texture.mHeight > 32768) return Error{"texture", "is too large"};
    Image image{static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), {}};
    image.rgba.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const aiTexel& texel = texture.pcData[i];
        image.rgba.insert(image.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
    }
    return encode_png(image);
}

/// Finds the texture in the file or beside it.
int index_of(TextureReader& textures, const aiScene& read, const std::string& reference) {
    if (const aiTexture* texture = read.GetEmbeddedTexture(reference.c_str())) {
        return textures.index_of(reference, bytes_of(*texture));
    }
    if (reference.starts_with('*')) return textures.index_of(reference, Error{reference, "is not in the file"});
    return textures.index_of(reference);
}

std::string texture_reference(const aiMaterial& material) {
    aiString path;
    if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &path) == aiReturn_SUCCESS && path.length > 0)
        return path.C_Str();
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &path) == aiReturn_SUCCESS && path.length > 0)
        return path.C_Str();
    return {};
}

void read_colors(const aiMaterial& material, const MaterialReading& reading, RawMaterial& out) {
    const auto as_linear = [&](float v) { return reading.linear_colors ? unit_range(v) : linear_from_srgb(v); };
    aiColor4D color;
    if (material.Get(AI_MATKEY_BASE_COLOR, color) == aiReturn_SUCCESS ||
        material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
        out.base_color = {as_linear(color.r), as_linear(color.g), as_linear(color.b), unit_range(color.a)};
    }
    float opacity = 1;
    if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS) {
        out.base_color[3] =
            reading.linear_colors ? std::min(out.base_color[3], unit_range(opacity)) : unit_range(opacity);
    }
    aiString alpha_mode;
    if (material.Get(AI_MATKEY_GLTF_ALPHAMODE, alpha_mode) == aiReturn_SUCCESS && alpha_mode == aiString("OPAQUE")) {
        out.base_color[3] = 1;
    }
    aiColor3D emissive;
    if (material.Get(AI_MATKEY_COLOR_EMISSIVE, emissive) == aiReturn_SUCCESS) {
        out.emissive = {as_linear(emissive.r), as_linear(emissive.g), as_linear(emissive.b)};
    }
}

void read_surface(const aiMaterial& material, const MaterialReading& reading, RawMaterial& out) {
    float value = 0;
    if (material.Get(AI_MATKEY_METALLIC_FACTOR, value) == aiReturn_SUCCESS) out.metallic = unit_range(value);
    if (material.Get(AI_MATKEY_ROUGHNESS_FACTOR, value) == aiReturn_SUCCESS) {
        out.roughness = unit_range(value);
    } else if (material.Get(AI_MATKEY_SHININESS, value) == aiReturn_SUCCESS && std::isfinite(value) && value > 0) {
        out.roughness = roughness_from_exponent(value);
    }
    int two_sided = reading.double_sided ? 1 : 0;
    if (material.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS || reading.double_sided) {
        out.double_sided = two_sided != 0;
    }
}

void read_name(const NamedMaterial& named, RawMaterial& out) {
    for (std::size_t k = 0; k < 3; ++k) out.base_color[k] = linear_from_srgb(named.color[k]);
    out.base_color[3] = named.opacity;
    out.roughness = named.exponent > 0 ? roughness_from_exponent(named.exponent) : 1.0F;
}

}  // namespace

void add_materials(const aiScene& read, const FileSource& source, const std::string& model_path,
                   const MaterialReading& reading, RawScene& scene) {
    TextureReader textures(source, model_path, scene);
    for (unsigned i = 0; i < read.mNumMaterials; ++i) {
        const aiMaterial& material = *read.mMaterials[i];
        RawMaterial out;
        out.name = material.GetName().C_Str();
        if (out.name.empty()) out.name = "material " + std::to_string(i + 1);
        read_colors(material, reading, out);
        read_surface(material, reading, out);
        if (const NamedMaterial* named = named_material(out.name);
            named != nullptr && reading.names_stand_for_materials)
            read_name(*named, out);
        if (const std::string reference = texture_reference(material); !reference.empty()) {
            out.base_color_image = index_of(textures, read, reference);
            if (out.base_color_image >= 0 && reading.texture_replaces_color) {
                out.base_color = {1, 1, 1, out.base_color[3]};
            }
        }
        scene.materials.push_back(std::move(out));
    }
}

}  // namespace embody::interchange
