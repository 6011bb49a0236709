// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/node_compliance.h"

#include <algorithm>

#include "physics/linear/column_kernels.h"

namespace embody::physics::deformable {

void NodeCompliance::forget(std::size_t nodes) {
    number_.assign(nodes, none);
    nodes_.clear();
    is_asked_for_.clear();
    columns_.clear();
}

void NodeCompliance::begin() {
    constexpr std::size_t max_idle_count = 32;  // nodes whose columns cost less to keep than to find again
    const auto asked_for = static_cast<std::size_t>(std::ranges::count(is_asked_for_, std::uint8_t{1}));
    if (size() > 2 * asked_for + max_idle_count) keep_only_asked_for();
    std::ranges::fill(is_asked_for_, std::uint8_t{0});
}

std::uint32_t NodeCompliance::number_of(std::uint32_t node) {
    std::uint32_t& number = number_[node];
    if (number == none) {
        number = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(node);
        is_asked_for_.push_back(1);
    }
    is_asked_for_[number] = 1;
    return number;
}

void NodeCompliance::keep_only_asked_for() {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        number_[nodes_[i]] = none;
        if (is_asked_for_[i] != 0) kept.push_back(i);
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const std::uint32_t from = kept[i];
        nodes_[i] = nodes_[from];
        number_[nodes_[i]] = static_cast<std::uint32_t>(i);
        if (from != i) columns_[i] = std::move(columns_[from]);  // moving a vector onto itself may empty it
        for (std::size_t row = 0; row < 9; ++row) {
            // Writes never reach what is read next: i <= from, also within a row.
            float* to = value_.data() + (9 * i + row) * stride_;
            const float* read = value_.data() + (9 * from + row) * stride_;
            for (std::size_t k = 0; k < kept.size(); ++k) to[k] = read[kept[k]];
            std::fill(to + kept.size(), to + stride_, 0.0f);
        }
    }
    nodes_.resize(kept.size());
    columns_.resize(kept.size());
    is_asked_for_.assign(kept.size(), 1);
}

void NodeCompliance::make_room(std::size_t count) {
    if (count <= stride_ && 9 * count * stride_ <= value_.size()) return;
    const std::size_t wanted = std::max(count, columns_.size() + columns_.size() / 4);
    const std::size_t stride = (wanted + column_multiple - 1) / column_multiple * column_multiple;
    std::vector<float> value(9 * stride * stride, 0.0f);
    for (std::size_t row = 0; row < 9 * columns_.size(); ++row) {
        const auto from = value_.begin() + static_cast<std::ptrdiff_t>(row * stride_);
        std::copy(from, from + static_cast<std::ptrdiff_t>(columns_.size()),
                  value.begin() + static_cast<std::ptrdiff_t>(row * stride));
    }
    value_ = std::move(value);
    stride_ = stride;
}

void NodeCompliance::set_block(std::size_t i, std::size_t j, const Mat3& block) {
    float *to = value_.data() + 9 * j * stride_ + i, *back = value_.data() + 9 * i * stride_ + j;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t r = 0; r < 3; ++r) {
            const auto value = static_cast<float>(block(static_cast<int>(r), static_cast<int>(c)));
            to[(3 * c + r) * stride_] = value;
            back[(3 * r + c) * stride_] = value;
        }
    }
}

void NodeCompliance::complete(const DissectedCholesky& factor, std::span<const std::uint8_t> is_pinned,
                              TaskPool& workers) {
    constexpr std::size_t min_parallel_count = 16;  // new nodes
    const std::size_t known = columns_.size(), added = size() - known;
    if (added == 0) return;
    make_room(size());
    columns_.resize(size());
    parallel_for(workers, added, added >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t k = range.first; k < range.last; ++k) columns_[known + k] = factor.columns(nodes_[known + k]);
    });
    parallel_for(workers, added, added >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t i = known + range.first; i < known + range.last; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                const bool is_held = is_pinned[nodes_[i]] != 0 || is_pinned[nodes_[j]] != 0;
                set_block(i, j, is_held ? Mat3::zero() : factor.inverse_block(columns_[i], columns_[j]));
            }
        }
    });
}

}  // namespace embody::physics::deformable
