// SPDX-License-Identifier: MIT
#include "physics/deformable/touched_nodes.h"

#include <algorithm>

#include "physics/deformable/solid_kernels.h"

namespace embody::physics {

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
    gas_share_ = solid.gas_move().empty() ? 0 : scale_ * solid.gas_share();
    if (gas_share_ != 0) {
        gas_.assign(3 * compliance_->stride(), 0.0f);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f own = to_vec3f(transpose(turn_[i]) * solid.gas_move()[compliance_->node(i)]);
            gas_[i] = own.x;
            gas_[compliance_->stride() + i] = own.y;
            gas_[2 * compliance_->stride() + i] = own.z;
        }
    }
    for (auto* moves : {&moved_, &probe_}) moves->assign(3 * compliance_->stride(), 0.0f);
    for (auto* forces : {&force_, &probe_force_}) forces->assign(count, {});
}

Mat3 TouchedNodes::block(std::size_t i, std::size_t j) const {
    Mat3 own;
    for (std::size_t k = 0; k < 9; ++k)
        own(static_cast<int>(k % 3), static_cast<int>(k / 3)) =
            scale_ * static_cast<double>(compliance_->rows(j)[k * compliance_->stride() + i]);
    const Mat3 block = turn_[i] * own * transpose(turn_[j]);
    return gas_share_ == 0 ? block : block - gas_share_ * outer(move_of(i, gas_), move_of(j, gas_));
}

Vec3 TouchedNodes::move_of(std::size_t number, const std::vector<float>& moves) const {
    const std::size_t stride = compliance_->stride();
    return turn_[number] * to_vec3(Vec3f{moves[number], moves[stride + number], moves[2 * stride + number]});
}

void TouchedNodes::add_moves(std::size_t number, Vec3 force, std::vector<float>& moves) const {
    const Vec3f own = to_vec3f(transpose(turn_[number]) * (scale_ * force));
    widest_solid_kernels().add_moves(moves.data(), compliance_->rows(number), compliance_->stride(), own.x, own.y,
                                     own.z);
    if (gas_share_ == 0) return;
    const auto taken = static_cast<float>(gas_share_ * dot(move_of(number, gas_), force));
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] -= taken * gas_[i];
}

void TouchedNodes::push(std::size_t number, Vec3 force) {
    force_[number] += force;
    add_moves(number, force, moved_);
}

void TouchedNodes::clear_probe() {
    std::ranges::fill(probe_, 0.0f);
    std::ranges::fill(probe_force_, Vec3{});
}

void TouchedNodes::run_probe() {
    for (std::size_t j = 0; j < size(); ++j) {
        if (probe_force_[j] != Vec3{}) add_moves(j, probe_force_[j], probe_);
    }
}

}  // namespace embody::physics
