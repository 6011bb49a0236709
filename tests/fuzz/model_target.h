// SPDX-License-Identifier: MIT
// One model file, alone in a folder: what a worker does with it before it measures the model.
#pragma once

#include <cmath>
#include <vector>

#include "interchange/image/image_codec.h"
#include "interchange/read_model.h"
#include "target.h"

namespace embody::fuzz {

class OneFile final : public interchange::FileSource {
public:
    OneFile(std::string name, std::span<const std::uint8_t> bytes) : name_(std::move(name)), bytes_(bytes) {}
    [[nodiscard]] std::string find(std::string_view path) const override {
        return path == name_ ? name_ : std::string();
    }
    [[nodiscard]] Result<std::vector<std::uint8_t>> read(std::string_view path) const override {
        if (path != name_) return Error{std::string(path), "no such file"};
        return std::vector<std::uint8_t>(bytes_.begin(), bytes_.end());
    }
    [[nodiscard]] std::string describe(std::string_view path) const override {
        return "one file: " + std::string(path);
    }

private:
    std::string name_;
    std::span<const std::uint8_t> bytes_;
};

inline void require_sound(const interchange::RawMesh& mesh, const interchange::RawScene& scene) {
    require(!mesh.triangles.empty(), "every mesh has triangles");
    require(mesh.material >= -1 && mesh.material < static_cast<int>(scene.materials.size()), "materials are there");
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(),
            "normals are one a position, or none");
    require(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == mesh.positions.size(),
            "texture coordinates are one a position, or none");
    for (const Vec3f& p : mesh.positions) {
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "every position is finite");
    }
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) require(corner < mesh.positions.size(), "every index is in range");
    }
}

/// Checks the promises of read_model() for a file of this name.
inline void read_model_file(const std::string& name, std::span<const std::uint8_t> bytes) {
    const auto scene = interchange::read_model(OneFile(name, bytes), name);
    if (!scene) return require_reasons(scene.error());
    require(!scene->meshes.empty(), "a model has meshes");
    for (const auto& mesh : scene->meshes) require_sound(mesh, *scene);
    for (const auto& material : scene->materials) {
        require(material.base_color_image >= -1 && material.base_color_image < static_cast<int>(scene->images.size()),
                "images are there");
    }
    for (const auto& image : scene->images) {
        const auto header = interchange::read_image_header(image.bytes);
        require(header.ok() && header->format != interchange::ImageFormat::other, "every image is PNG or JPEG");
    }
}

}  // namespace embody::fuzz
