// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/body_block.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace embody::physics::deformable {

BodyBlock::BodyBlock(const BodyInertia& body) {
    const Mat3 turning = body.moves ? body.inertia : Mat3::identity();
    for (int r = 0; r < 3; ++r) {
        const auto row = static_cast<std::size_t>(r);
        at(row, row) = body.moves ? body.mass : 1;
        for (int c = 0; c < 3; ++c) at(row + 3, static_cast<std::size_t>(c) + 3) = turning(r, c);
    }
}

// Jᵀ m J of a point at `arm`: J (shift, turn) = shift + turn × arm.
void BodyBlock::add(const Mat3& m, Vec3 arm) {
    const Mat3 s = transpose(skew(arm));  // turn × arm = s turn
    const Mat3 mixed = m * s, turned = transpose(s) * mixed;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const auto row = static_cast<std::size_t>(r), column = static_cast<std::size_t>(c);
            at(row, column) += m(r, c);
            at(row, column + 3) += mixed(r, c);
            at(column + 3, row) += mixed(r, c);
            at(row + 3, column + 3) += turned(r, c);
        }
    }
}

// Lower factor L Lᵀ in place, row by row.
void BodyBlock::factorize() {
    constexpr double min_pivot = 1e-300;  // keeps the root real and its inverse finite
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = at(i, k);
            for (std::size_t j = 0; j < k; ++j) sum -= at(i, j) * at(k, j);
            at(i, k) = i == k ? std::sqrt(std::max(sum, min_pivot)) : sum / at(k, k);
        }
    }
}

BodyMove BodyBlock::solve(const BodyMove& rhs) const {
    std::array<double, 6> v{rhs.shift.x, rhs.shift.y, rhs.shift.z, rhs.turn.x, rhs.turn.y, rhs.turn.z};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < i; ++k) v[i] -= values_[6 * i + k] * v[k];
        v[i] /= values_[7 * i];
    }
    for (std::size_t i = 6; i-- > 0;) {
        for (std::size_t k = i + 1; k < 6; ++k) v[i] -= values_[6 * k + i] * v[k];
        v[i] /= values_[7 * i];
    }
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

void balance_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies,
                    std::span<const Vec3> moves, std::span<BodyMove> body_moves) {
    std::vector<BodyBlock> blocks;
    std::vector<BodyMove> left;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        blocks.emplace_back(bodies[b]);
        left.push_back({-bodies[b].mass * body_moves[b].shift, -(bodies[b].inertia * body_moves[b].turn)});
    }
    for (const TouchSpring& spring : springs) {
        if (!spring.acts || !moves_body(spring, bodies)) continue;
        const Vec3 force = spring.force(spring.lead(moves, body_moves));
        left[spring.body].shift -= force;
        left[spring.body].turn -= cross(spring.arm, force);
        blocks[spring.body].add(spring.matrix, spring.arm);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!bodies[b].moves) continue;
        blocks[b].factorize();
        const BodyMove more = blocks[b].solve(left[b]);
        body_moves[b].shift += more.shift;
        body_moves[b].turn += more.turn;
    }
}

}  // namespace embody::physics::deformable
