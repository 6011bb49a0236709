// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/task_pool.h"
#include "physics/deformable/namespace.h"
#include "physics/linear/dissected_cholesky.h"

namespace embody::physics::deformable {

/// How touched nodes of a solid move by forces on each other, m/N: blocks of the inverse of its matrix, each node in
/// its own axes. Kept from substep to substep, as long as the factor is, for the nodes that are touched again.
class NodeCompliance {
public:
    /// Resets for a new factor of a solid with this many nodes.
    void forget(std::size_t nodes);
    /// Begins a substep: forgets nodes that were not used in the last one, where they are many.
    void begin();
    /// Number of a node among the touched ones; a new one at the first query.
    std::uint32_t number_of(std::uint32_t node);
    /// Finds the blocks of nodes that are new. Pinned ones (`is_pinned` by node) do not move.
    void complete(const DissectedCholesky& factor, std::span<const std::uint8_t> is_pinned, TaskPool& workers);

    [[nodiscard]] std::size_t size() const { return nodes_.size(); }
    [[nodiscard]] std::uint32_t node(std::size_t number) const { return nodes_[number]; }
    /// Numbers from one row to the next, a multiple of column_multiple.
    [[nodiscard]] std::size_t stride() const { return stride_; }
    /// Of node j nine rows over all nodes i: element (r, c) of the block (i, j) in row 3 c + r.
    [[nodiscard]] const float* rows(std::size_t j) const { return value_.data() + 9 * j * stride_; }

private:
    void make_room(std::size_t count);
    void keep_only_asked_for();
    void set_block(std::size_t i, std::size_t j, const Mat3& block);

    static constexpr std::uint32_t none = 0xFFFFFFFF;
    std::vector<std::uint32_t> number_;       // by node
    std::vector<std::uint32_t> nodes_;        // by number
    std::vector<std::uint8_t> is_asked_for_;  // in this substep, by number
    std::vector<DissectedCholesky::Columns> columns_;
    std::size_t stride_ = 0;
    std::vector<float> value_;
};

}  // namespace embody::physics::deformable
