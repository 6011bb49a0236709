// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"
#include "physics/deformable/cloth/cloth_row_kernels.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 to_float4(Vec3 v) {
    return Float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
}
inline Vec3 to_vec3(Float4 v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// 3 × 3 floats by columns; the fourth rows are zero.
struct Block {
    Float4 x{}, y{}, z{};
};
inline Block to_block(const Mat3& m) { return {to_float4(m.x), to_float4(m.y), to_float4(m.z)}; }
inline Mat3 to_matrix(const Block& b) { return {to_vec3(b.x), to_vec3(b.y), to_vec3(b.z)}; }
inline Block& operator+=(Block& to, const Block& added) {
    to.x += added.x;
    to.y += added.y;
    to.z += added.z;
    return to;
}

/// Of each node of a slice a number, in one cache line.
struct alignas(64) SliceFloats {
    std::array<float, slice_rows> lane{};
};
inline std::size_t slices_for(std::size_t nodes) { return (nodes + slice_rows - 1) / slice_rows; }

/// A block for each node, as the kernels have them.
class SliceBlocks {
public:
    void resize(std::size_t slices) { values_.assign(slices * (slice_block / slice_rows), {}); }
    void set(std::size_t slice, std::size_t lane, const Block& block);
    [[nodiscard]] const float* slice(std::size_t slice) const {
        return values_.empty() ? nullptr : values_.data()->lane.data() + slice * slice_block;
    }

private:
    std::vector<SliceFloats> values_;
};

/// A vector for each node, as the kernels have them: zero in lanes beyond the last node of a sheet.
class SliceVectors {
public:
    void resize(std::size_t slices) { values_.assign(3 * slices, {}); }
    [[nodiscard]] std::size_t stride() const { return values_.size() / 3 * slice_rows; }
    [[nodiscard]] float* slice(std::size_t slice) {
        return values_.empty() ? nullptr : values_.data()->lane.data() + slice * slice_rows;
    }
    /// `place`: slice_rows a slice.
    [[nodiscard]] Float4 at(std::size_t place) const {
        const float* x = values_.data()->lane.data() + place;
        return Float4{x[0], x[stride()], x[2 * stride()], 0};
    }
    void set(std::size_t place, Float4 v) {
        float* x = values_.data()->lane.data() + place;
        x[0] = v[0], x[stride()] = v[1], x[2 * stride()] = v[2];
    }
    void add(std::size_t place, Float4 v) { set(place, at(place) + v); }

private:
    std::vector<SliceFloats> values_;
};

/// A symmetric matrix over nodes: a block a node on the diagonal, blocks between neighbours, and multiples of the
/// identity between nodes farther off. Beside the diagonal it lies as ClothRows says.
class ClothMatrix {
public:
    /// Columns of each row's elements beside the diagonal, ascending; all elements zero.
    void set_pattern(std::span<const std::vector<std::uint32_t>> near, std::span<const std::vector<std::uint32_t>> far);

    /// Of the row's elements in the order of their columns.
    void set_near(std::size_t row, std::size_t which, const Block& block) {
        near_blocks_.set(near_.slot[near_.first[row] + which], row % slice_rows, block);
    }
    void set_far(std::size_t row, std::size_t which, float value) {
        far_values_[far_.slot[far_.first[row] + which]].lane[row % slice_rows] = value;
    }
    /// Where a row's near elements begin when all are counted row by row; of the row after the last, their number.
    [[nodiscard]] std::size_t near_first(std::size_t row) const { return near_.first[row]; }

    /// For the kernels, with `own` on the diagonal.
    [[nodiscard]] ClothRows rows(const float* own) const;

    std::vector<Block> diagonal;

private:
    struct Slots {
        std::vector<std::uint32_t> start, rest, column;
        std::vector<std::int32_t> offset;
        std::vector<std::uint32_t> first, slot;  // of a row's elements: where they are in `slot`, and the slot of each

        void make(std::span<const std::vector<std::uint32_t>> rows);
        [[nodiscard]] ClothSlots view(const float* value) const;
    };
    Slots near_, far_;
    SliceBlocks near_blocks_;
    std::vector<SliceFloats> far_values_;
};

}  // namespace embody::physics::deformable
