// SPDX-License-Identifier: MIT
// Preparation of a solve: the places of all elements, and the preconditioner.
#include <algorithm>
#include <cmath>

#include "physics/deformable/cloth/cloth_solver.h"

namespace embody::physics::deformable {

namespace {

constexpr std::size_t chunk_slices = 8;  // whose products are summed before the others'

}  // namespace

// Whether the preconditioner includes all of a spring: one node, or nodes of one line, and no body that moves.
bool ClothSolver::is_contained(const TouchSpring& spring, std::span<const BodyInertia> bodies) const {
    if (moves_body(spring, bodies)) return false;
    for (std::size_t k = 1; k < static_cast<std::size_t>(spring.count); ++k) {
        if (!is_same_block(spring.node[0], spring.node[k])) return false;
    }
    return true;
}

void ClothSolver::lay_out(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines) {
    nodes_ = 0;
    chunks_.clear();
    sheet_first_.clear();
    sheet_slice_.clear();
    place_.clear();
    std::size_t slices = 0;
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        const std::size_t count = sheets[s].rhs.size(), own_slices = slices_for(count);
        sheet_first_.push_back(nodes_);
        sheet_slice_.push_back(slices);
        for (std::size_t i = 0; i < count; ++i) place_.push_back(static_cast<std::uint32_t>(slices * slice_rows + i));
        for (std::size_t first = 0; first < own_slices; first += chunk_slices)
            chunks_.push_back({s, first, std::min(own_slices, first + chunk_slices)});
        nodes_ += count;
        slices += own_slices;
    }
    line_of_.clear();
    line_fixed_.clear();
    line_first_ = {0};
    for (std::uint32_t l = 0; l < lines.size(); ++l) {
        line_of_.insert(line_of_.end(), lines[l].rhs.size(), l);
        line_fixed_.insert(line_fixed_.end(), lines[l].fixed->begin(), lines[l].fixed->end());
        line_first_.push_back(line_of_.size());
    }
    for (auto* vector : {&p_, &q_, &r_, &z_, &x_}) vector->resize(slices);
    const bool has_gradients =
        std::ranges::any_of(sheets, [](const SheetSystem& sheet) { return !sheet.gradient.empty(); });
    gradients_.resize(has_gradients ? slices : 0);
    pulls_.assign(chunks_.size(), 0);
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        for (std::size_t i = 0; i < sheets[s].gradient.size(); ++i) {
            const bool is_free = sheets[s].fixed[i] == 0;
            gradients_.set(place_[sheet_first_[s] + i], is_free ? to_float4(sheets[s].gradient[i]) : Float4{});
        }
    }
    own_blocks_.resize(slices);
    inverse_blocks_.resize(slices);
    quads_.assign(slices * slice_rows, Float4{});
    for (auto* vector : {&line_p_, &line_ap_, &line_q_, &line_r_, &line_z_, &line_x_, &line_az_})
        vector->assign(line_of_.size(), {});
}

bool ClothSolver::prepare(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                          std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies,
                          TaskPool& workers) {
    own_.clear();
    for (const SheetSystem& sheet : sheets)
        own_.insert(own_.end(), sheet.matrix->diagonal.begin(), sheet.matrix->diagonal.end());
    coupled_.clear();
    std::vector<Link> links;
    for (std::uint32_t s = 0; s < springs.size(); ++s) {
        const TouchSpring& spring = springs[s];
        if (!spring.acts) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
            if (spring.node[k] >= nodes_) continue;
            own_[spring.node[k]] += to_block(spring.weight[k] * spring.weight[k] * spring.matrix);
        }
        if (is_contained(spring, bodies)) continue;
        if (is_between_sheets(spring, bodies))
            add_links(spring, links);
        else
            coupled_.push_back(s);
    }
    sort_links(links);
    inverse_.resize(nodes_);
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        const std::size_t count = sheets[s].rhs.size();
        parallel_for(workers, count, count >= min_parallel_count, [&](int, IndexRange range) {
            for (std::size_t i = range.first; i < range.last; ++i) {
                const std::size_t at = sheet_first_[s] + i, slice = place_[at] / slice_rows,
                                  lane = place_[at] % slice_rows;
                inverse_[at] = sheets[s].fixed[i] != 0 ? Block{} : to_block(inverse_or_zero(to_matrix(own_[at])));
                own_blocks_.set(slice, lane, own_[at]);
                inverse_blocks_.set(slice, lane, inverse_[at]);
            }
        });
    }
    if (!prepare_lines(lines, springs)) return false;
    prepare_line_holds(springs, bodies);
    prepare_bodies(springs, bodies);
    return true;
}

bool ClothSolver::is_between_sheets(const TouchSpring& spring, std::span<const BodyInertia> bodies) const {
    const auto nodes = std::span(spring.node).first(static_cast<std::size_t>(spring.count));
    return !moves_body(spring, bodies) && std::ranges::all_of(nodes, [&](std::uint32_t n) { return n < nodes_; });
}

// Terms of a spring between nodes of sheets beside the diagonal.
void ClothSolver::add_links(const TouchSpring& spring, std::vector<Link>& links) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
        for (std::size_t b = 0; b < static_cast<std::size_t>(spring.count); ++b) {
            if (b == a || spring.weight[a] * spring.weight[b] == 0) continue;
            links.push_back(
                {spring.node[a], spring.node[b], to_block((spring.weight[a] * spring.weight[b]) * spring.matrix)});
        }
    }
}

// By row, in each in the order of the springs; the chunks' rows follow each other.
void ClothSolver::sort_links(std::vector<Link>& links) {
    std::ranges::stable_sort(links, {}, &Link::row);
    links_.swap(links);
    std::size_t at = 0;
    for (Chunk& chunk : chunks_) {
        const std::size_t end = (sheet_slice_[chunk.sheet] + chunk.last) * slice_rows;
        chunk.first_link = at;
        while (at < links_.size() && place_[links_[at].row] < end) ++at;
        chunk.last_link = at;
    }
}

void ClothSolver::prepare_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    body_blocks_.clear();
    for (const BodyInertia& body : bodies) body_blocks_.emplace_back(body);
    for (const std::uint32_t s : coupled_) {
        const TouchSpring& spring = springs[s];
        if (!moves_body(spring, bodies)) continue;
        const Mat3& k = spring.matrix;
        // A single node is compliant: the body's stiffness by it is K - K D⁻¹ K.
        const bool is_single = spring.count == 1 && spring.node[0] < nodes_;
        const Mat3 felt = is_single ? k - k * to_matrix(inverse_[spring.node[0]]) * k : k;
        body_blocks_[spring.body].add(felt, spring.arm);
    }
    for (const LineHold& hold : line_holds_) apply_line_hold(hold);
    for (BodyBlock& block : body_blocks_) block.factorize();
}

}  // namespace embody::physics::deformable
