// SPDX-License-Identifier: MIT
#include "interchange/assimp/assimp_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "interchange/image/image_codec.h"

namespace embody::interchange {
namespace {

float unit_range(float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; }

/// IEC 61966-2-1.
float linear_from_srgb(float value) {
    value = unit_range(value);
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/// Reads textures once each, wherever they are.
class TextureReader {
public:
    TextureReader(const aiScene& read, const FileSource& source, const std::string& model_path, RawScene& scene)
        : read_(read), source_(source), scene_(scene) {
        const std::size_t slash = model_path.rfind('/');
        folder_ = slash == std::string::npos ? std::string() : model_path.substr(0, slash + 1);
    }

    /// Index of the image in the scene, -1 where it could not be had.
    int index_of(const std::string& reference) {
        const auto [known, is_new] = indices_.try_emplace(reference, -1);
        if (!is_new) return known->second;
        auto bytes = embedded_or_file(reference);
        if (bytes) bytes = png_or_jpeg(std::move(*bytes));
        if (!bytes) {
            scene_.warnings.push_back("texture \"" + reference + "\" left out: " + bytes.error().why);
            return -1;
        }
        known->second = static_cast<int>(scene_.images.size());
        scene_.images.push_back({reference, std::move(*bytes)});
        return known->second;
    }

private:
    Result<std::vector<std::uint8_t>> embedded_or_file(const std::string& reference) const {
        if (const aiTexture* texture = read_.GetEmbeddedTexture(reference.c_str())) return bytes_of(*texture);
        if (reference.starts_with('*')) return Error{reference, "is not in the file"};

        // Beside the model, else by its bare name: exporters write the paths of their own machine.
        std::string found = source_.find(folder_ + reference);
        if (found.empty()) {
            const std::size_t slash = reference.find_last_of("/\\");
            if (slash != std::string::npos) found = source_.find(folder_ + reference.substr(slash + 1));
        }
        if (found.empty()) return Error{reference, "is not in the model's folder"};
        return source_.read(found);
    }

    static Result<std::vector<std::uint8_t>> bytes_of(const aiTexture& texture) {
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

    static Result<std::vector<std::uint8_t>> png_or_jpeg(std::vector<std::uint8_t> bytes) {
        const auto header = read_image_header(bytes);
        if (!header) return header.error();
        if (header->format != ImageFormat::other) return bytes;
        const auto image = decode_image(bytes);
        if (!image) return image.error();
        return encode_png(*image);
    }

    const aiScene& read_;
    const FileSource& source_;
    RawScene& scene_;
    std::string folder_;
    std::map<std::string, int> indices_;
};

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
        // Blinn-Phong exponent n to GGX's α = roughness²: α² = 2 / (n + 2). Kept off the mirror end: old exponents are
        // guesses.
        out.roughness = std::clamp(std::pow(2.0f / (value + 2.0f), 0.25f), 0.35f, 1.0f);
    }
    int two_sided = reading.double_sided ? 1 : 0;
    if (material.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS || reading.double_sided) {
        out.double_sided = two_sided != 0;
    }
}

}  // namespace

void add_materials(const aiScene& read, const FileSource& source, const std::string& model_path,
                   const MaterialReading& reading, RawScene& scene) {
    TextureReader textures(read, source, model_path, scene);
    for (unsigned i = 0; i < read.mNumMaterials; ++i) {
        const aiMaterial& material = *read.mMaterials[i];
        RawMaterial out;
        out.name = material.GetName().C_Str();
        if (out.name.empty()) out.name = "material " + std::to_string(i + 1);
        read_colors(material, reading, out);
        read_surface(material, reading, out);
        if (const std::string reference = texture_reference(material); !reference.empty()) {
            out.base_color_image = textures.index_of(reference);
            if (out.base_color_image >= 0 && reading.texture_replaces_color) {
                out.base_color = {1, 1, 1, out.base_color[3]};
            }
        }
        scene.materials.push_back(std::move(out));
    }
}

}  // namespace embody::interchange
