// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_matrix.h"

#include <algorithm>
#include <map>

namespace embody::physics::deformable {

void SliceBlocks::set(std::size_t slice, std::size_t lane, const Block& block) {
    SliceFloats* to = &values_[slice * (slice_block / slice_rows)];
    for (const Float4& column : {block.x, block.y, block.z}) {
        for (int r = 0; r < 3; ++r) to++->lane[lane] = column[r];
    }
}

// Elements of a slice that lie on one diagonal have a common slot where they fill enough of it: one load of neighbours
// instead of one a row. Sheets that are meshed row by row have nearly no others.
void ClothMatrix::Slots::make(std::span<const std::vector<std::uint32_t>> rows) {
    constexpr int min_band_rows = 6;  // of slice_rows: fewer cost more as a band than one by one
    const auto places = static_cast<std::int64_t>(slices_for(rows.size()) * slice_rows);
    *this = {};
    start = first = {0};
    for (std::size_t begin = 0; begin < rows.size(); begin += slice_rows) {
        const auto slice = rows.subspan(begin, std::min(slice_rows, rows.size() - begin));
        const auto offset_of = [&](std::size_t lane, std::uint32_t other) {
            return static_cast<std::int32_t>(other) - static_cast<std::int32_t>(begin + lane);
        };
        std::map<std::int32_t, int> counts;
        for (std::size_t lane = 0; lane < slice.size(); ++lane) {
            for (const std::uint32_t other : slice[lane]) ++counts[offset_of(lane, other)];
        }
        // All rows of the slice read along a band: each place must exist.
        std::map<std::int32_t, std::uint32_t> slot_of;
        for (const auto& [along, count] : counts) {
            const std::int64_t from = static_cast<std::int64_t>(begin) + along;
            if (count < min_band_rows || from < 0 || from + static_cast<std::int64_t>(slice_rows) > places) continue;
            slot_of[along] = static_cast<std::uint32_t>(offset.size());
            offset.push_back(along);
        }
        const std::size_t bands = offset.size();
        rest.push_back(static_cast<std::uint32_t>(bands));
        std::size_t end = bands;
        for (std::size_t lane = 0; lane < slice.size(); ++lane) {
            std::size_t next = bands;
            for (const std::uint32_t other : slice[lane]) {
                const auto band = slot_of.find(offset_of(lane, other));
                slot.push_back(band != slot_of.end() ? band->second : static_cast<std::uint32_t>(next++));
            }
            first.push_back(static_cast<std::uint32_t>(slot.size()));
            end = std::max(end, next);
        }
        offset.resize(end, 0);
        start.push_back(static_cast<std::uint32_t>(end));
        column.resize(end * slice_rows, static_cast<std::uint32_t>(begin));
        for (std::size_t lane = 0; lane < slice.size(); ++lane) {
            for (std::size_t k = 0; k < slice[lane].size(); ++k)
                column[slot[first[begin + lane] + k] * slice_rows + lane] = slice[lane][k];
        }
    }
}

ClothSlots ClothMatrix::Slots::view(const float* value) const {
    return {start.data(), rest.data(), offset.data(), column.data(), value};
}

void ClothMatrix::set_pattern(std::span<const std::vector<std::uint32_t>> near,
                              std::span<const std::vector<std::uint32_t>> far) {
    diagonal.assign(near.size(), {});
    near_.make(near);
    far_.make(far);
    near_blocks_.resize(near_.offset.size());
    far_values_.assign(far_.offset.size(), {});
}

ClothRows ClothMatrix::rows(const float* own) const {
    return {near_.view(near_blocks_.slice(0)),
            far_.view(far_values_.empty() ? nullptr : far_values_.front().lane.data()), own};
}

}  // namespace embody::physics::deformable
