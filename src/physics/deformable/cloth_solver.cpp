// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth_solver.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr std::size_t chunk_size = 128;  // nodes whose products are summed before the others'

Float4 to_float4(Vec3 v) {
    return Float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
}
Vec3 to_vec3(Float4 v) { return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])}; }
Block to_block(const Mat3& m) { return {to_float4(m.x), to_float4(m.y), to_float4(m.z)}; }
Mat3 to_matrix(const Block& b) { return {to_vec3(b.x), to_vec3(b.y), to_vec3(b.z)}; }

template <int lane>
Float4 spread(Float4 v) {
    using Lanes = std::int32_t __attribute__((vector_size(16)));
    return __builtin_shuffle(v, Lanes{lane, lane, lane, lane});
}

Float4 operator_times(const Block& b, Float4 v) { return b.x * spread<0>(v) + b.y * spread<1>(v) + b.z * spread<2>(v); }

double product(Float4 a, Float4 b) {
    const Float4 c = a * b;
    return static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2]);
}

double product(const BodyMove& a, const BodyMove& b) { return dot(a.shift, b.shift) + dot(a.turn, b.turn); }

Vec3 at_arm(const BodyMove& move, Vec3 arm) { return move.shift + cross(move.turn, arm); }

// Lower factor L Lᵀ in place, row by row.
void factorize(std::array<double, 36>& m) {
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = m[6 * i + k];
            for (std::size_t j = 0; j < k; ++j) sum -= m[6 * i + j] * m[6 * k + j];
            m[6 * i + k] = i == k ? std::sqrt(std::max(sum, 1e-300)) : sum / m[6 * k + k];
        }
    }
}

BodyMove solve(const std::array<double, 36>& factor, const BodyMove& rhs) {
    std::array<double, 6> v{rhs.shift.x, rhs.shift.y, rhs.shift.z, rhs.turn.x, rhs.turn.y, rhs.turn.z};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < i; ++k) v[i] -= factor[6 * i + k] * v[k];
        v[i] /= factor[7 * i];
    }
    for (std::size_t i = 6; i-- > 0;) {
        for (std::size_t k = i + 1; k < 6; ++k) v[i] -= factor[6 * k + i] * v[k];
        v[i] /= factor[7 * i];
    }
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

// Jᵀ m J of a point at `arm`: J (shift, turn) = shift + turn × arm.
void add_at_arm(std::array<double, 36>& to, const Mat3& m, Vec3 arm) {
    const Mat3 s = transpose(skew(arm));  // turn × arm = s turn
    const Mat3 mixed = m * s, turned = transpose(s) * mixed;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const auto row = static_cast<std::size_t>(r), column = static_cast<std::size_t>(c);
            to[6 * row + column] += m(r, c);
            to[6 * row + column + 3] += mixed(r, c);
            to[6 * (column + 3) + row] += mixed(r, c);
            to[6 * (row + 3) + column + 3] += turned(r, c);
        }
    }
}

bool is_coupled(const TouchSpring& spring, std::span<const BodyInertia> bodies) {
    return spring.count > 1 || (spring.body != no_body && bodies[spring.body].moves);
}

bool moves_body(const TouchSpring& spring, std::span<const BodyInertia> bodies) {
    return spring.body != no_body && bodies[spring.body].moves;
}

}  // namespace

void ClothSolver::prepare(const ClothMatrix& matrix, std::span<const std::uint8_t> fixed,
                          std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    nodes_ = matrix.diagonal.size();
    own_ = matrix.diagonal;
    coupled_.clear();
    for (std::uint32_t s = 0; s < springs.size(); ++s) {
        const TouchSpring& spring = springs[s];
        if (!spring.acts) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
            const Block added = to_block(spring.weight[k] * spring.weight[k] * spring.matrix);
            Block& own = own_[spring.node[k]];
            own.x += added.x;
            own.y += added.y;
            own.z += added.z;
        }
        if (is_coupled(spring, bodies)) coupled_.push_back(s);
    }
    inverse_.resize(nodes_);
    for (std::size_t i = 0; i < nodes_; ++i)
        inverse_[i] = fixed[i] != 0 ? Block{} : to_block(inverse_or_zero(to_matrix(own_[i])));

    body_factors_.assign(bodies.size(), {});
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        auto& factor = body_factors_[b].factor;
        for (int r = 0; r < 3; ++r) {
            const auto row = static_cast<std::size_t>(r);
            factor[7 * row] = bodies[b].moves ? bodies[b].mass : 1;
            for (int c = 0; c < 3; ++c)
                factor[6 * (row + 3) + static_cast<std::size_t>(c) + 3] =
                    bodies[b].moves ? bodies[b].inertia(r, c) : (r == c ? 1.0 : 0.0);
        }
    }
    for (const std::uint32_t s : coupled_) {
        const TouchSpring& spring = springs[s];
        if (!moves_body(spring, bodies)) continue;
        const Mat3& k = spring.matrix;
        auto& factor = body_factors_[spring.body].factor;
        // A single node gives way: K - K D⁻¹ K is what the body feels of it.
        const Mat3 felt = spring.count == 1 ? k - k * to_matrix(inverse_[spring.node[0]]) * k : k;
        add_at_arm(factor, felt, spring.arm);
    }
    for (BodyFactor& body : body_factors_) factorize(body.factor);
}

void ClothSolver::multiply_rows(const ClothMatrix& matrix, std::size_t chunk) {
    double sum = 0;
    const std::size_t last = std::min(nodes_, (chunk + 1) * chunk_size);
    for (std::size_t i = chunk * chunk_size; i < last; ++i) {
        Float4 row = operator_times(own_[i], direction_[i]);
        for (std::uint32_t k = matrix.start[i]; k < matrix.start[i + 1]; ++k)
            row += operator_times(matrix.block[k], direction_[matrix.column[k]]);
        for (std::uint32_t k = matrix.far_start[i]; k < matrix.far_start[i + 1]; ++k)
            row += matrix.far_value[k] * direction_[matrix.far_column[k]];
        product_[i] = row;
        sum += product(row, direction_[i]);
    }
    parts_[chunk] = sum;
}

// What springs add between nodes and to bodies: a node's own part is in its block already.
void ClothSolver::add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    double sum = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        body_product_[b] = {bodies[b].mass * body_direction_[b].shift, bodies[b].inertia * body_direction_[b].turn};
        sum += product(body_product_[b], body_direction_[b]);
    }
    for (const std::uint32_t index : coupled_) {
        const TouchSpring& spring = springs[index];
        const Mat3& k = spring.matrix;
        const bool has_body = moves_body(spring, bodies);
        Vec3 stretch;
        if (has_body) stretch -= at_arm(body_direction_[spring.body], spring.arm);
        for (std::size_t n = 0; n < static_cast<std::size_t>(spring.count); ++n)
            stretch += spring.weight[n] * to_vec3(direction_[spring.node[n]]);
        const Vec3 force = k * stretch;
        for (std::size_t n = 0; n < static_cast<std::size_t>(spring.count); ++n) {
            const double w = spring.weight[n];
            const Vec3 p = to_vec3(direction_[spring.node[n]]);
            const Vec3 added = w * (force - w * (k * p));
            product_[spring.node[n]] += to_float4(added);
            sum += dot(added, p);
        }
        if (!has_body) continue;
        const BodyMove on_body{-force, -cross(spring.arm, force)};
        body_product_[spring.body].shift += on_body.shift;
        body_product_[spring.body].turn += on_body.turn;
        sum += product(on_body, body_direction_[spring.body]);
    }
    parts_.back() = sum;
}

// z = D⁻¹ r is done; now the bodies, and what their moves change at the nodes that they touch.
void ClothSolver::precondition_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    body_better_ = body_residual_;
    const auto is_held = [&](std::uint32_t s) { return springs[s].count == 1 && moves_body(springs[s], bodies); };
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 felt = spring.matrix * to_vec3(better_[spring.node[0]]);
        body_better_[spring.body].shift += felt;
        body_better_[spring.body].turn += cross(spring.arm, felt);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
        body_better_[b] =
            bodies[b].moves ? embody::physics::solve(body_factors_[b].factor, body_better_[b]) : BodyMove{};
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 taken = spring.matrix * at_arm(body_better_[spring.body], spring.arm);
        better_[spring.node[0]] += operator_times(inverse_[spring.node[0]], to_float4(taken));
    }
}

double ClothSolver::sum_of(const std::vector<double>& parts) const {
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
}

void ClothSolver::iterate(const ClothMatrix& matrix, std::span<const TouchSpring> springs,
                          std::span<const BodyInertia> bodies, double enough, int worker, Barrier& barrier) {
    const std::size_t chunks = parts_.size() - 1;
    const Share share = share_of(chunks, worker, workers_);
    const bool has_springs = !coupled_.empty();
    const auto precondition = [&] {
        for (std::size_t c = share.first; c < share.last; ++c) {
            for (std::size_t i = c * chunk_size; i < std::min(nodes_, (c + 1) * chunk_size); ++i)
                better_[i] = operator_times(inverse_[i], residual_[i]);
        }
        if (has_springs) {
            barrier.wait();
            if (worker == 0) precondition_bodies(springs, bodies);
            barrier.wait();
        }
        for (std::size_t c = share.first; c < share.last; ++c) {
            double sum = 0;
            for (std::size_t i = c * chunk_size; i < std::min(nodes_, (c + 1) * chunk_size); ++i)
                sum += product(better_[i], residual_[i]);
            other_parts_[c] = sum;
        }
        if (worker == 0) {
            other_parts_.back() = 0;
            for (std::size_t b = 0; b < bodies.size() && has_springs; ++b)
                other_parts_.back() += product(body_better_[b], body_residual_[b]);
        }
        barrier.wait();
        return sum_of(other_parts_);
    };
    double size = precondition(), previous = 0;
    // Floats cannot tell less.
    enough = std::max(enough, 1e-12 * size);
    int round = 0;
    bool is_finite = std::isfinite(size);
    for (; round < most_rounds && size > enough; ++round) {
        const auto turn = static_cast<float>(round == 0 ? 0 : size / previous);
        for (std::size_t i = share.first * chunk_size; i < std::min(nodes_, share.last * chunk_size); ++i)
            direction_[i] = better_[i] + turn * direction_[i];
        if (worker == 0 && has_springs) {
            for (std::size_t b = 0; b < bodies.size(); ++b) {
                const double t = round == 0 ? 0 : size / previous;
                body_direction_[b] = {body_better_[b].shift + t * body_direction_[b].shift,
                                      body_better_[b].turn + t * body_direction_[b].turn};
            }
        }
        barrier.wait();
        for (std::size_t c = share.first; c < share.last; ++c) multiply_rows(matrix, c);
        if (has_springs) {
            barrier.wait();
            if (worker == 0) add_springs(springs, bodies);
        }
        barrier.wait();
        const double bend = sum_of(parts_);
        is_finite = is_finite && std::isfinite(bend);
        if (!(bend > 0) || !is_finite) break;
        const double way = size / bend;
        const auto step = static_cast<float>(way);
        for (std::size_t i = share.first * chunk_size; i < std::min(nodes_, share.last * chunk_size); ++i) {
            answer_[i] += step * direction_[i];
            residual_[i] -= step * product_[i];
        }
        if (worker == 0 && has_springs) {
            for (std::size_t b = 0; b < bodies.size(); ++b) {
                body_answer_[b].shift += way * body_direction_[b].shift;
                body_answer_[b].turn += way * body_direction_[b].turn;
                body_residual_[b].shift -= way * body_product_[b].shift;
                body_residual_[b].turn -= way * body_product_[b].turn;
            }
        }
        previous = size;
        size = precondition();
    }
    if (worker == 0) rounds_ = is_finite && std::isfinite(size) ? round : not_finite;
}

int ClothSolver::solve(const ClothMatrix& matrix, std::span<const Vec3> rhs, std::span<const Vec3> small_load,
                       std::span<const std::uint8_t> fixed, std::span<const TouchSpring> springs,
                       std::span<const BodyInertia> bodies, std::span<Vec3> moves, std::span<BodyMove> body_moves,
                       TaskPool& workers) {
    prepare(matrix, fixed, springs, bodies);
    const std::size_t chunks = (nodes_ + chunk_size - 1) / chunk_size;
    parts_.assign(chunks + 1, 0);
    other_parts_.assign(chunks + 1, 0);
    for (auto* vector : {&direction_, &product_, &residual_, &better_, &answer_}) vector->assign(nodes_, Float4{});
    for (auto* vector : {&body_direction_, &body_product_, &body_residual_, &body_better_, &body_answer_})
        vector->assign(bodies.size(), {});

    // Residual of the guess, forces of springs with it.
    double load = 0;
    for (std::size_t i = 0; i < nodes_; ++i) {
        answer_[i] = direction_[i] = fixed[i] != 0 ? Float4{} : to_float4(moves[i]);
        const Float4 small = to_float4(small_load[i]);
        load += product(operator_times(inverse_[i], small), small);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) body_answer_[b] = body_direction_[b] = body_moves[b];
    share_among(workers, chunks, nodes_ >= 1000, [&](int, Share share) {
        for (std::size_t c = share.first; c < share.last; ++c) multiply_rows(matrix, c);
    });
    add_springs(springs, bodies);
    for (std::size_t i = 0; i < nodes_; ++i) residual_[i] = to_float4(rhs[i]) - product_[i];
    for (std::size_t b = 0; b < bodies.size(); ++b)
        body_residual_[b] = {-body_product_[b].shift, -body_product_[b].turn};
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
            residual_[spring.node[k]] += to_float4(spring.weight[k] * spring.load);
        if (!moves_body(spring, bodies)) continue;
        body_residual_[spring.body].shift -= spring.load;
        body_residual_[spring.body].turn -= cross(spring.arm, spring.load);
    }
    // Fixed nodes give way to nothing: their part of the residual is the force that holds them.
    const double enough = tolerance * tolerance * load;
    workers_ = nodes_ >= 1000 ? workers.workers() : 1;
    Barrier barrier(workers_);
    if (workers_ > 1)
        workers.run([&](int worker) { iterate(matrix, springs, bodies, enough, worker, barrier); });
    else
        iterate(matrix, springs, bodies, enough, 0, barrier);
    for (std::size_t i = 0; i < nodes_; ++i) moves[i] = to_vec3(answer_[i]);
    for (std::size_t b = 0; b < bodies.size(); ++b) body_moves[b] = body_answer_[b];
    return rounds_;
}

}  // namespace embody::physics
