// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/vec3.h"

namespace embody::interchange {

/// An image as it was in the file: PNG or JPEG bytes.
struct RawImage {
    std::string name;
    std::vector<std::uint8_t> bytes;
};

/// Metallic-roughness surface of a part, glTF 2.0's terms.
struct RawMaterial {
    std::string name;
    std::array<float, 4> base_color{0.8f, 0.8f, 0.8f, 1};  ///< linear RGBA
    int base_color_image = -1;                             ///< index in RawScene::images, -1: none
    float metallic = 0, roughness = 0.7f;
    std::array<float, 3> emissive{0, 0, 0};
    bool double_sided = false;
};

/// A triangle list with one material. Normals and texture coordinates are empty or one a position.
struct RawMesh {
    std::string name;
    int material = -1;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<std::array<float, 2>> texture_coordinates;  ///< glTF's origin: upper left
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The result of any importer: flat (node transforms applied), Y up, right-handed, in metres as far as the file
/// says.
struct RawScene {
    std::vector<RawMesh> meshes;
    std::vector<RawMaterial> materials;
    std::vector<RawImage> images;
    std::vector<std::string> warnings;  ///< what was left out, for people
};

}  // namespace embody::interchange
