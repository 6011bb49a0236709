// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/touched_nodes.h"

#include <algorithm>
#include <cmath>

#include "math/kernel_width.h"
#include "physics/linear/column_kernels.h"

namespace embody::physics::deformable {

void TouchedNodes::begin(SolidDeformable& solid) {
    compliance_ = &solid.compliance();
    compliance_->begin();
}

void TouchedNodes::complete(SolidDeformable& solid, TaskPool& workers) {
    solid.complete_compliance(workers);
    scale_ = 1 / solid.stretch();
    const std::size_t count = compliance_->size();
    turn_.resize(count);
    for (std::size_t i = 0; i < count; ++i) turn_[i] = to_matrix(solid.turn(compliance_->node(i)));
    gas_fraction_ = solid.gas_move().empty() ? 0 : scale_ * solid.gas_fraction();
    if (gas_fraction_ != 0) {
        gas_.assign(3 * compliance_->stride(), 0.0f);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f own = to_vec3f(transpose(turn_[i]) * solid.gas_move()[compliance_->node(i)]);
            gas_[i] = own.x;
            gas_[compliance_->stride() + i] = own.y;
            gas_[2 * compliance_->stride() + i] = own.z;
        }
    }
    moved_.assign(3 * compliance_->stride(), 0.0f);
    for (auto* vectors : {&force_, &probe_force_, &probe_moves_}) vectors->assign(count, {});
    probe_own_force_.assign(3 * compliance_->stride(), 0.0f);
    // The number of parts does not depend on the number of workers: the parts determine the order of sums. Parts of a
    // probe for workers; number of nodes from which on these pay.
    constexpr std::size_t max_parts = 4, min_parted_count = 8 * column_multiple;
    probe_part_moves_.resize(count < min_parted_count ? 1 : max_parts);
}

Mat3 TouchedNodes::block(std::size_t i, std::size_t j) const {
    Mat3 own;
    for (std::size_t k = 0; k < 9; ++k)
        own(static_cast<int>(k % 3), static_cast<int>(k / 3)) =
            scale_ * static_cast<double>(compliance_->rows(j)[k * compliance_->stride() + i]);
    const Mat3 block = turn_[i] * own * transpose(turn_[j]);
    return gas_fraction_ == 0 ? block : block - gas_fraction_ * outer(move_of(i, gas_), move_of(j, gas_));
}

Vec3 TouchedNodes::move_of(std::size_t number, const std::vector<float>& moves) const {
    const std::size_t stride = compliance_->stride();
    return turn_[number] * to_vec3(Vec3f{moves[number], moves[stride + number], moves[2 * stride + number]});
}

void TouchedNodes::push(std::size_t number, Vec3 force) {
    force_[number] += force;
    const Vec3f own = to_vec3f(transpose(turn_[number]) * (scale_ * force));
    widest_kernels<ColumnKernels>().add_moves(moved_.data(), compliance_->rows(number), compliance_->stride(), own.x,
                                              own.y, own.z);
    if (gas_fraction_ == 0) return;
    const auto taken = static_cast<float>(gas_fraction_ * dot(move_of(number, gas_), force));
    for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] -= taken * gas_[i];
}

void TouchedNodes::clear_probe() { std::ranges::fill(probe_force_, Vec3{}); }

void TouchedNodes::begin_probe() {
    const std::size_t stride = compliance_->stride();
    for (std::size_t j = 0; j < size(); ++j) {
        const Vec3f own = to_vec3f(transpose(turn_[j]) * (scale_ * probe_force_[j]));
        probe_own_force_[j] = own.x;
        probe_own_force_[stride + j] = own.y;
        probe_own_force_[2 * stride + j] = own.z;
    }
}

// Parts have about as many pairs of nodes each: those up to tile t grow with its square.
void TouchedNodes::run_probe(std::size_t part) {
    const std::size_t stride = compliance_->stride();
    const auto tiles = static_cast<double>((size() + column_multiple - 1) / column_multiple);
    const auto tile_of = [&](std::size_t k) {
        const double fraction = static_cast<double>(k) / static_cast<double>(probe_parts());
        return static_cast<std::size_t>(std::lround(tiles * std::sqrt(fraction)));
    };
    std::vector<float>& moves = probe_part_moves_[part];
    moves.assign(3 * stride, 0.0f);
    widest_kernels<ColumnKernels>().add_all_moves(moves.data(), compliance_->rows(0), probe_own_force_.data(), stride,
                                                  tile_of(part), tile_of(part + 1));
}

void TouchedNodes::end_probe() {
    double taken = 0;
    if (gas_fraction_ != 0) {
        for (std::size_t i = 0; i < size(); ++i) taken += dot(move_of(i, gas_), probe_force_[i]);
        taken *= gas_fraction_;
    }
    for (std::size_t i = 0; i < size(); ++i) {
        Vec3 sum;
        for (const std::vector<float>& moves : probe_part_moves_) sum += move_of(i, moves);
        probe_moves_[i] = gas_fraction_ == 0 ? sum : sum - taken * move_of(i, gas_);
    }
}

}  // namespace embody::physics::deformable
