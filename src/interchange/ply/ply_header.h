// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a number in the binary encodings.
std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;         ///< of the number, or of each in the list
    std::optional<PlyType> count_type = {};  ///< a list: of how many there are
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the first property with one of these names; nothing where there is none.
    [[nodiscard]] std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::string texture;   ///< of a "comment TextureFile", as MeshLab writes it; may be empty
    std::size_t size = 0;  ///< bytes up to the first element
    std::size_t lines = 0;
};

/// The header of a PLY file; the error's `where` is "line 7". Bounds the number of elements and properties, and refuses
/// elements of which the file cannot hold as many as it says.
Result<PlyHeader> read_ply_header(std::string_view file);

}  // namespace embody::interchange
