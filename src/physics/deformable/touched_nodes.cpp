// SPDX-License-Identifier: MIT
#include "physics/deformable/touched_nodes.h"

#include <algorithm>

namespace embody::physics {

namespace {

constexpr std::uint32_t none = 0xFFFFFFFF;
constexpr std::size_t widest_lanes = 16;  // rows are filled up to a multiple

}  // namespace

void TouchedNodes::begin(const SolidDeformable& solid) {
    nodes_.clear();
    number_of_.assign(solid.nodes().size(), none);
}

std::uint32_t TouchedNodes::number_of(std::uint32_t node) {
    std::uint32_t& number = number_of_[node];
    if (number == none) {
        number = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(node);
    }
    return number;
}

void TouchedNodes::fetch_compliance(SolidDeformable& solid) {
    const std::size_t count = nodes_.size();
    stride_ = (count + widest_lanes - 1) / widest_lanes * widest_lanes;
    turn_.resize(count);
    compliance_.assign(9 * count * stride_, 0.0f);
    for (auto* moves : {&moved_, &probe_}) moves->assign(3 * stride_, 0.0f);
    for (auto* forces : {&force_, &probe_force_}) forces->assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
        turn_[i] = solid.turn(nodes_[i]);
        for (std::size_t j = 0; j <= i; ++j) {
            const Mat3 block = solid.compliance(nodes_[i], nodes_[j]);
            float *to = compliance_.data() + 9 * j * stride_ + i, *back = compliance_.data() + 9 * i * stride_ + j;
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t r = 0; r < 3; ++r) {
                    const auto value = static_cast<float>(block(static_cast<int>(r), static_cast<int>(c)));
                    to[(3 * c + r) * stride_] = value;
                    back[(3 * r + c) * stride_] = value;
                }
            }
        }
    }
}

Mat3 TouchedNodes::block(std::size_t i, std::size_t j) const {
    Mat3 own;
    for (std::size_t k = 0; k < 9; ++k)
        own(static_cast<int>(k % 3), static_cast<int>(k / 3)) =
            static_cast<double>(compliance_[(9 * j + k) * stride_ + i]);
    return to_matrix(turn_[i]) * own * transpose(to_matrix(turn_[j]));
}

Vec3 TouchedNodes::move_of(std::size_t number, const std::vector<float>& moves) const {
    return rotate(turn_[number], to_vec3(Vec3f{moves[number], moves[stride_ + number], moves[2 * stride_ + number]}));
}

void TouchedNodes::add_moves(std::size_t number, Vec3 force, std::vector<float>& moves) const {
    const Vec3f own = to_vec3f(rotate_inverse(turn_[number], force));
    const float* w = compliance_.data() + 9 * number * stride_;
    float *x = moves.data(), *y = x + stride_, *z = y + stride_;
    for (std::size_t i = 0; i < stride_; ++i) {
        x[i] += w[i] * own.x + w[3 * stride_ + i] * own.y + w[6 * stride_ + i] * own.z;
        y[i] += w[stride_ + i] * own.x + w[4 * stride_ + i] * own.y + w[7 * stride_ + i] * own.z;
        z[i] += w[2 * stride_ + i] * own.x + w[5 * stride_ + i] * own.y + w[8 * stride_ + i] * own.z;
    }
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
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
        if (probe_force_[j] != Vec3{}) add_moves(j, probe_force_[j], probe_);
    }
}

}  // namespace embody::physics
