// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "geometry/triangle_mesh.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Version of the stored form, in asset.extras.embody.version. Decoding refuses any other.
inline constexpr int compact_geometry_version = 1;
/// Textures are reduced to this many pixels on their longer side.
inline constexpr int max_texture_side = 1024;

struct CompactGeometry {
    std::vector<std::uint8_t> bytes;
    std::uint32_t vertices = 0, triangles = 0;  ///< stored; triangles that became points or lines are left out
    std::uint32_t parts = 0;                    ///< draw calls: one a material
    std::uint32_t materials = 0, images = 0;    ///< in use
    double position_step = 0;                   ///< m, the grid of positions: 1/65535 of the largest extent
    std::vector<std::string> warnings;
};

/// A scene in the stored form: binary glTF 2.0 with KHR_mesh_quantization (positions 16 bit, normals 8 bit octahedral,
/// texture coordinates 15 bit mantissa) and EXT_meshopt_compression; one primitive a material; images PNG or JPEG.
/// Deterministic. Refuses a scene without triangles, not finite, or with indices out of range.
Result<CompactGeometry> encode(const RawScene& scene);

/// All triangles of the stored form, in metres. Corners that differ in normal, texture or material are vertices of
/// their own: weld where topology matters. Safe on any bytes: damaged, truncated or foreign ones are an error.
Result<geometry::TriangleMesh> decode_mesh(std::span<const std::uint8_t> bytes);

/// Converts to the form that a glTF viewer reads, with levels of detail (detail_levels.h) as data of ours, which others
/// pass over. What was stored before there were levels gets them here.
Result<std::vector<std::uint8_t>> to_glb(std::span<const std::uint8_t> bytes);

}  // namespace embody::interchange
