// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace embody::physics::deformable {

namespace {

template <int lane>
Float4 spread(Float4 v) {
    return __builtin_shufflevector(v, v, lane, lane, lane, lane);
}

Float4 operator_times(const Block& b, Float4 v) { return b.x * spread<0>(v) + b.y * spread<1>(v) + b.z * spread<2>(v); }

double product(Float4 a, Float4 b) {
    const Float4 c = a * b;
    return static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2]);
}

double product(const BodyMove& a, const BodyMove& b) { return dot(a.shift, b.shift) + dot(a.turn, b.turn); }

Vec3 at_arm(const BodyMove& move, Vec3 arm) { return move.shift + cross(move.turn, arm); }

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

}  // namespace

double energy_of(const SheetSystem& sheet, std::span<const Vec3> moves) {
    const ClothMatrix& matrix = *sheet.matrix;
    const std::size_t slices = slices_for(moves.size());
    SliceBlocks own;
    SliceVectors way, force;
    std::vector<Float4> quads(slices * slice_rows);
    own.resize(slices);
    way.resize(slices);
    force.resize(slices);
    for (std::size_t i = 0; i < moves.size(); ++i) {
        own.set(i / slice_rows, i % slice_rows, matrix.diagonal[i]);
        way.set(i, quads[i] = to_float4(moves[i]));
    }
    const ClothVectors vectors{.stride = way.stride(),
                               .direction = way.slice(0),
                               .product = force.slice(0),
                               .quads = reinterpret_cast<float*>(quads.data())};
    double unused[slice_rows] = {};
    widest_cloth_row_kernels().multiply(matrix.rows(own.slice(0)), vectors, 0, slices, unused);
    double sum = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        if (sheet.fixed[i] == 0) sum += dot(0.5 * to_vec3(force.at(i)) - sheet.rhs[i], moves[i]);
    }
    return sum;
}

ClothVectors ClothSolver::vectors_of(std::size_t sheet) {
    const std::size_t slice = sheet_slice_[sheet];
    return {.stride = direction_.stride(),
            .direction = direction_.slice(slice),
            .product = product_.slice(slice),
            .residual = residual_.slice(slice),
            .better = better_.slice(slice),
            .answer = answer_.slice(slice),
            .quads = reinterpret_cast<float*>(quads_.data() + slice * slice_rows),
            .inverse = inverse_blocks_.slice(slice)};
}

// kernel(vectors, first slice, last slice, sums) of a chunk.
template <class Kernel>
double ClothSolver::sum_of_chunk(std::size_t chunk, Kernel kernel) {
    std::array<double, slice_rows> sums{};
    kernel(vectors_of(chunks_[chunk].sheet), chunks_[chunk].first, chunks_[chunk].last, sums.data());
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

void ClothSolver::multiply_rows(std::span<const SheetSystem> sheets, std::size_t chunk) {
    const Chunk& run = chunks_[chunk];
    const ClothRows rows = sheets[run.sheet].matrix->rows(own_blocks_.slice(sheet_slice_[run.sheet]));
    double sum = sum_of_chunk(chunk, [&](const ClothVectors& vectors, std::size_t first, std::size_t last,
                                         double* sums) { kernels_->multiply(rows, vectors, first, last, sums); });
    for (const Link& link : std::span(links_).subspan(run.first_link, run.last_link - run.first_link)) {
        const Float4 added = operator_times(link.block, direction_.at(place_[link.column]));
        product_.add(place_[link.row], added);
        sum += product(added, direction_.at(place_[link.row]));
    }
    parts_[chunk] = sum;
}

Vec3 ClothSolver::direction_of(std::uint32_t node) const {
    return node < nodes_ ? to_vec3(direction_.at(place_[node])) : line_direction_[node - nodes_];
}

// What springs add between nodes and to bodies: what the blocks of nodes and lines hold is in their products already.
void ClothSolver::add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    double sum = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        body_product_[b] = {bodies[b].mass * body_direction_[b].shift, bodies[b].inertia * body_direction_[b].turn};
        sum += product(body_product_[b], body_direction_[b]);
    }
    line_product_ = line_own_product_;
    for (const std::uint32_t index : coupled_) {
        const TouchSpring& spring = springs[index];
        const auto count = static_cast<std::size_t>(spring.count);
        const Mat3& k = spring.matrix;
        const bool has_body = moves_body(spring, bodies);
        std::array<Vec3, 4> way;
        Vec3 stretch;
        if (has_body) stretch -= at_arm(body_direction_[spring.body], spring.arm);
        for (std::size_t n = 0; n < count; ++n) {
            way[n] = spring.weight[n] * direction_of(spring.node[n]);
            stretch += way[n];
        }
        const Vec3 force = k * stretch;
        for (std::size_t n = 0; n < count; ++n) {
            const std::uint32_t node = spring.node[n];
            Vec3 held;
            for (std::size_t m = 0; m < count; ++m) {
                if (is_same_block(node, spring.node[m])) held += way[m];
            }
            const Vec3 added = spring.weight[n] * (force - k * held);
            if (node < nodes_) {
                product_.add(place_[node], to_float4(added));
                sum += dot(added, direction_of(node));
            } else {
                line_product_[node - nodes_] += added;
            }
        }
        if (!has_body) continue;
        const BodyMove on_body{-force, -cross(spring.arm, force)};
        body_product_[spring.body].shift += on_body.shift;
        body_product_[spring.body].turn += on_body.turn;
        sum += product(on_body, body_direction_[spring.body]);
    }
    for (std::size_t i = 0; i < line_product_.size(); ++i) {
        if (line_fixed_[i]) line_product_[i] = {};
        sum += dot(line_product_[i], line_direction_[i]);
    }
    parts_.back() = sum;
}

// z = D⁻¹ r is done; now the bodies, and what their moves change at the nodes that they touch.
void ClothSolver::precondition_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    body_better_ = body_residual_;
    const auto is_held = [&](std::uint32_t s) {
        return springs[s].count == 1 && springs[s].node[0] < nodes_ && moves_body(springs[s], bodies);
    };
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 felt = spring.matrix * to_vec3(better_.at(place_[spring.node[0]]));
        body_better_[spring.body].shift += felt;
        body_better_[spring.body].turn += cross(spring.arm, felt);
    }
    add_line_pulls();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        body_better_[b] =
            bodies[b].moves ? embody::physics::deformable::solve(body_factors_[b].factor, body_better_[b]) : BodyMove{};
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 taken = spring.matrix * at_arm(body_better_[spring.body], spring.arm);
        better_.add(place_[spring.node[0]], operator_times(inverse_[spring.node[0]], to_float4(taken)));
    }
    follow_bodies();
}

double ClothSolver::sum_of(const std::vector<double>& parts) const {
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
}

// The next direction of bodies and lines. What a line's factor L Lᵀ = A makes of it is known: A z = r less what bodies
// take along.
void ClothSolver::go_on(std::span<const BodyInertia> bodies, double turn) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        body_direction_[b] = {body_better_[b].shift + turn * body_direction_[b].shift,
                              body_better_[b].turn + turn * body_direction_[b].turn};
    }
    for (std::size_t i = 0; i < line_direction_.size(); ++i) {
        line_direction_[i] = line_better_[i] + turn * line_direction_[i];
        line_own_product_[i] = line_own_better_[i] + turn * line_own_product_[i];
    }
}

void ClothSolver::go_along(double way, std::size_t bodies) {
    for (std::size_t b = 0; b < bodies; ++b) {
        body_answer_[b].shift += way * body_direction_[b].shift;
        body_answer_[b].turn += way * body_direction_[b].turn;
        body_residual_[b].shift -= way * body_product_[b].shift;
        body_residual_[b].turn -= way * body_product_[b].turn;
    }
    for (std::size_t i = 0; i < line_answer_.size(); ++i) {
        line_answer_[i] += way * line_direction_[i];
        line_residual_[i] -= way * line_product_[i];
    }
}

void ClothSolver::iterate(std::span<const SheetSystem> sheets, std::span<const TouchSpring> springs,
                          std::span<const BodyInertia> bodies, double enough, int worker, Barrier& barrier) {
    const Share share = share_of(chunks_.size(), worker, workers_);
    const bool has_others = !coupled_.empty() || !factors_.empty();
    // Goes along the direction and finds better = D⁻¹ residual; returns better · residual.
    const auto advance = [&](double way) {
        for (std::size_t c = share.first; c < share.last; ++c) {
            other_parts_[c] = sum_of_chunk(c, [&](const auto& vectors, auto first, auto last, double* sums) {
                kernels_->advance(vectors, static_cast<float>(way), first, last, sums);
            });
        }
        if (has_others) {
            if (worker == 0) go_along(way, bodies.size());
            barrier.wait();
            if (worker == 0) {
                precondition_lines();
                precondition_bodies(springs, bodies);
            }
            barrier.wait();
            for (std::size_t c = share.first; c < share.last; ++c) other_parts_[c] = sum_of_chunk(c, kernels_->dot);
        }
        if (worker == 0) {
            other_parts_.back() = 0;
            for (std::size_t b = 0; b < bodies.size() && has_others; ++b)
                other_parts_.back() += product(body_better_[b], body_residual_[b]);
            for (std::size_t i = 0; i < line_better_.size(); ++i)
                other_parts_.back() += dot(line_better_[i], line_residual_[i]);
        }
        barrier.wait();
        return sum_of(other_parts_);
    };
    double size = advance(0), previous = 0;
    // Floats cannot tell less.
    enough = std::max(enough, 1e-12 * size);
    int round = 0;
    bool is_finite = std::isfinite(size);
    for (; round < most_rounds && size > enough; ++round) {
        const double turn = round == 0 ? 0 : size / previous;
        for (std::size_t c = share.first; c < share.last; ++c)
            kernels_->turn(vectors_of(chunks_[c].sheet), static_cast<float>(turn), chunks_[c].first, chunks_[c].last);
        if (worker == 0 && has_others) go_on(bodies, turn);
        barrier.wait();
        for (std::size_t c = share.first; c < share.last; ++c) multiply_rows(sheets, c);
        if (has_others) {
            barrier.wait();
            if (worker == 0) add_springs(springs, bodies);
        }
        barrier.wait();
        const double bend = sum_of(parts_);
        is_finite = is_finite && std::isfinite(bend);
        if (!(bend > 0) || !is_finite) break;
        previous = size;
        size = advance(size / bend);
    }
    if (worker == 0) rounds_ = is_finite && std::isfinite(size) ? round : not_finite;
}

// Lines begin with what they would do alone. Returns the square of the small loads in the preconditioner's norm.
double ClothSolver::guess(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                          std::span<const TouchSpring> springs, std::span<const Vec3> moves) {
    double load = 0;
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        for (std::size_t i = 0; i < sheets[s].rhs.size(); ++i) {
            const std::size_t at = sheet_first_[s] + i;
            const Float4 move = sheets[s].fixed[i] != 0 ? Float4{} : to_float4(moves[at]);
            answer_.set(place_[at], move);
            direction_.set(place_[at], move);
            quads_[place_[at]] = move;
            const Float4 small = to_float4(sheets[s].small_load[i]);
            load += product(operator_times(inverse_[at], small), small);
        }
    }
    if (lines.empty()) return load;
    std::vector<Vec3> small;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        std::ranges::copy(lines[l].rhs, line_own_product_.begin() + static_cast<std::ptrdiff_t>(line_first_[l]));
        small.insert(small.end(), lines[l].small_load.begin(), lines[l].small_load.end());
    }
    for (const TouchSpring& spring : springs) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count) && spring.acts; ++k) {
            if (spring.node[k] >= nodes_) line_own_product_[spring.node[k] - nodes_] += spring.weight[k] * spring.load;
        }
    }
    for (std::size_t i = 0; i < line_of_.size(); ++i) {
        if (line_fixed_[i]) line_own_product_[i] = small[i] = {};
    }
    line_answer_ = line_own_product_;
    solve_lines(line_answer_);
    line_direction_ = line_answer_;
    std::vector<Vec3> given = small;
    solve_lines(given);
    for (std::size_t i = 0; i < small.size(); ++i) load += dot(given[i], small[i]);
    return load;
}

// Of the guess, forces of springs with it.
void ClothSolver::find_residual(std::span<const SheetSystem> sheets, std::span<const TouchSpring> springs,
                                std::span<const BodyInertia> bodies, TaskPool& workers) {
    share_among(workers, chunks_.size(), nodes_ >= worth_sharing, [&](int, Share share) {
        for (std::size_t c = share.first; c < share.last; ++c) multiply_rows(sheets, c);
    });
    add_springs(springs, bodies);
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        for (std::size_t i = 0; i < sheets[s].rhs.size(); ++i) {
            const std::uint32_t place = place_[sheet_first_[s] + i];
            residual_.set(place, to_float4(sheets[s].rhs[i]) - product_.at(place));
        }
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
        body_residual_[b] = {-body_product_[b].shift, -body_product_[b].turn};
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
            if (spring.node[k] < nodes_)
                residual_.add(place_[spring.node[k]], to_float4(spring.weight[k] * spring.load));
        }
        if (!moves_body(spring, bodies)) continue;
        body_residual_[spring.body].shift -= spring.load;
        body_residual_[spring.body].turn -= cross(spring.arm, spring.load);
    }
    // A line's own equations hold, so what is left is what couples it.
    for (std::size_t i = 0; i < line_of_.size(); ++i)
        line_residual_[i] = line_fixed_[i] ? Vec3{} : line_own_product_[i] - line_product_[i];
}

int ClothSolver::solve(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                       std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies, std::span<Vec3> moves,
                       std::span<BodyMove> body_moves, TaskPool& workers) {
    lay_out(sheets, lines);
    if (!prepare(sheets, lines, springs, bodies, workers)) return not_finite;
    parts_.assign(chunks_.size() + 1, 0);
    other_parts_.assign(chunks_.size() + 1, 0);
    for (auto* vector : {&body_direction_, &body_product_, &body_residual_, &body_better_, &body_answer_})
        vector->assign(bodies.size(), {});
    const double load = guess(sheets, lines, springs, moves);
    for (std::size_t b = 0; b < bodies.size(); ++b) body_answer_[b] = body_direction_[b] = body_moves[b];
    find_residual(sheets, springs, bodies, workers);
    parts_.back() = 0;
    // Fixed nodes give way to nothing: their part of the residual is the force that holds them.
    const double enough = tolerance * tolerance * load;
    workers_ = nodes_ >= worth_sharing ? workers.workers() : 1;
    Barrier barrier(workers_);
    if (workers_ > 1)
        workers.run([&](int worker) { iterate(sheets, springs, bodies, enough, worker, barrier); });
    else
        iterate(sheets, springs, bodies, enough, 0, barrier);
    for (std::size_t i = 0; i < nodes_; ++i) moves[i] = to_vec3(answer_.at(place_[i]));
    std::ranges::copy(line_answer_, moves.begin() + static_cast<std::ptrdiff_t>(nodes_));
    for (std::size_t b = 0; b < bodies.size(); ++b) body_moves[b] = body_answer_[b];
    return rounds_;
}

}  // namespace embody::physics::deformable
