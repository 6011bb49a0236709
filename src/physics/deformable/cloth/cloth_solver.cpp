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

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Vec3 at_arm(const BodyMove& move, Vec3 arm) { return move.shift + cross(move.turn, arm); }

}  // namespace

double energy_of(const SheetSystem& sheet, std::span<const Vec3> moves) {
    const ClothMatrix& matrix = *sheet.matrix;
    const std::size_t slices = slices_for(moves.size());
    SliceBlocks own;
    SliceVectors move, force;
    std::vector<Float4> quads(slices * slice_rows);
    own.resize(slices);
    move.resize(slices);
    force.resize(slices);
    for (std::size_t i = 0; i < moves.size(); ++i) {
        own.set(i / slice_rows, i % slice_rows, matrix.diagonal[i]);
        move.set(i, quads[i] = to_float4(moves[i]));
    }
    const ClothVectors vectors{.stride = move.stride(),
                               .p = move.slice(0),
                               .q = force.slice(0),
                               .quads = reinterpret_cast<float*>(quads.data())};
    double unused[slice_rows] = {};
    widest_kernels<ClothRowKernels>().multiply(matrix.rows(own.slice(0)), vectors, 0, slices, unused);
    double sum = 0, pull = 0;
    for (std::size_t i = 0; i < sheet.gradient.size(); ++i) pull += dot(sheet.gradient[i], moves[i]);
    sum += sheet.stiffness / 2 * pull * pull;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        if (sheet.fixed[i] == 0) sum += dot(0.5 * to_vec3(force.at(i)) - sheet.rhs[i], moves[i]);
    }
    return sum;
}

ClothVectors ClothSolver::vectors_of(std::size_t sheet) {
    const std::size_t slice = sheet_slice_[sheet];
    return {.stride = p_.stride(),
            .p = p_.slice(slice),
            .q = q_.slice(slice),
            .r = r_.slice(slice),
            .z = z_.slice(slice),
            .x = x_.slice(slice),
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
        const Float4 added = operator_times(link.block, p_.at(place_[link.column]));
        q_.add(place_[link.row], added);
        sum += product(added, p_.at(place_[link.row]));
    }
    if (!sheets[run.sheet].gradient.empty()) sum += add_pull(sheets[run.sheet], chunk);
    curvatures_[chunk] = sum;
}

// Of the chunk's rows, whose p is known.
void ClothSolver::find_pull(std::size_t chunk) {
    const Chunk& run = chunks_[chunk];
    std::array<double, slice_rows> sums{};
    for (std::size_t slice = run.first; slice < run.last; ++slice) {
        const std::size_t at = sheet_slice_[run.sheet] + slice;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float *g = gradients_.slice(at) + axis * gradients_.stride(), *p = p_.slice(at) + axis * p_.stride();
            for (std::size_t lane = 0; lane < slice_rows; ++lane)
                sums[lane] += static_cast<double>(g[lane]) * static_cast<double>(p[lane]);
        }
    }
    pulls_[chunk] = std::accumulate(sums.begin(), sums.end(), 0.0);
}

// q += stiffness gradient (gradient · p) in the chunk, with what all chunks of the sheet pull. Returns its part of p ·
// q.
double ClothSolver::add_pull(const SheetSystem& sheet, std::size_t chunk) {
    const Chunk& run = chunks_[chunk];
    double pull = 0;
    for (std::size_t c = 0; c < chunks_.size(); ++c) pull += chunks_[c].sheet == run.sheet ? pulls_[c] : 0;
    const auto factor = static_cast<float>(sheet.stiffness * pull);
    for (std::size_t slice = run.first; slice < run.last; ++slice) {
        const std::size_t at = sheet_slice_[run.sheet] + slice;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float* g = gradients_.slice(at) + axis * gradients_.stride();
            float* q = q_.slice(at) + axis * q_.stride();
            for (std::size_t lane = 0; lane < slice_rows; ++lane) q[lane] += factor * g[lane];
        }
    }
    return sheet.stiffness * pull * pulls_[chunk];
}

Vec3 ClothSolver::p_of(std::uint32_t node) const {
    return node < nodes_ ? to_vec3(p_.at(place_[node])) : line_p_[node - nodes_];
}

// Terms of springs between nodes and on bodies; the products of the blocks of nodes and lines include theirs already.
void ClothSolver::add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    double sum = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        body_q_[b] = {bodies[b].mass * body_p_[b].shift, bodies[b].inertia * body_p_[b].turn};
        sum += product(body_q_[b], body_p_[b]);
    }
    line_q_ = line_ap_;
    for (const std::uint32_t index : coupled_) {
        const TouchSpring& spring = springs[index];
        const auto count = static_cast<std::size_t>(spring.count);
        const Mat3& k = spring.matrix;
        const bool has_body = moves_body(spring, bodies);
        std::array<Vec3, 4> move;
        Vec3 stretch;
        if (has_body) stretch -= at_arm(body_p_[spring.body], spring.arm);
        for (std::size_t n = 0; n < count; ++n) {
            move[n] = spring.weight[n] * p_of(spring.node[n]);
            stretch += move[n];
        }
        const Vec3 force = k * stretch;
        for (std::size_t n = 0; n < count; ++n) {
            const std::uint32_t node = spring.node[n];
            Vec3 held;
            for (std::size_t m = 0; m < count; ++m) {
                if (is_same_block(node, spring.node[m])) held += move[m];
            }
            const Vec3 added = spring.weight[n] * (force - k * held);
            if (node < nodes_) {
                q_.add(place_[node], to_float4(added));
                sum += dot(added, p_of(node));
            } else {
                line_q_[node - nodes_] += added;
            }
        }
        if (!has_body) continue;
        const BodyMove on_body{-force, -cross(spring.arm, force)};
        body_q_[spring.body].shift += on_body.shift;
        body_q_[spring.body].turn += on_body.turn;
        sum += product(on_body, body_p_[spring.body]);
    }
    for (std::size_t i = 0; i < line_q_.size(); ++i) {
        if (line_fixed_[i]) line_q_[i] = {};
        sum += dot(line_q_[i], line_p_[i]);
    }
    curvatures_.back() = sum;
}

// z = D⁻¹ r is done; now the bodies, and the effect of their moves on the nodes that they touch.
void ClothSolver::precondition_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    body_z_ = body_r_;
    const auto is_held = [&](std::uint32_t s) {
        return springs[s].count == 1 && springs[s].node[0] < nodes_ && moves_body(springs[s], bodies);
    };
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 felt = spring.matrix * to_vec3(z_.at(place_[spring.node[0]]));
        body_z_[spring.body].shift += felt;
        body_z_[spring.body].turn += cross(spring.arm, felt);
    }
    add_line_pulls();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        body_z_[b] = bodies[b].moves ? body_blocks_[b].solve(body_z_[b]) : BodyMove{};
    for (const std::uint32_t s : coupled_) {
        if (!is_held(s)) continue;
        const TouchSpring& spring = springs[s];
        const Vec3 taken = spring.matrix * at_arm(body_z_[spring.body], spring.arm);
        z_.add(place_[spring.node[0]], operator_times(inverse_[spring.node[0]], to_float4(taken)));
    }
    follow_bodies();
}

// p = z + β p of bodies and lines. The product of a line's A = L Lᵀ with p is known: A z = r less the bodies' part.
void ClothSolver::turn_others(double beta) {
    for (std::size_t b = 0; b < body_p_.size(); ++b)
        body_p_[b] = {body_z_[b].shift + beta * body_p_[b].shift, body_z_[b].turn + beta * body_p_[b].turn};
    for (std::size_t i = 0; i < line_p_.size(); ++i) {
        line_p_[i] = line_z_[i] + beta * line_p_[i];
        line_ap_[i] = line_az_[i] + beta * line_ap_[i];
    }
}

// x += α p, r −= α q of bodies and lines.
void ClothSolver::advance_others(double alpha) {
    for (std::size_t b = 0; b < body_p_.size(); ++b) {
        body_x_[b].shift += alpha * body_p_[b].shift;
        body_x_[b].turn += alpha * body_p_[b].turn;
        body_r_[b].shift -= alpha * body_q_[b].shift;
        body_r_[b].turn -= alpha * body_q_[b].turn;
    }
    for (std::size_t i = 0; i < line_x_.size(); ++i) {
        line_x_[i] += alpha * line_p_[i];
        line_r_[i] -= alpha * line_q_[i];
    }
}

/// The system for one worker: the chunks of sheets are distributed over the workers, the first worker has bodies and
/// lines.
struct ClothSolver::WorkerSystem {
    ClothSolver& of;
    std::span<const SheetSystem> sheets;
    std::span<const TouchSpring> springs;
    std::span<const BodyInertia> bodies;
    Barrier& barrier;
    bool is_first;
    IndexRange chunks;
    bool has_others = !of.coupled_.empty() || !of.factors_.empty();

    // find_residual() has found r.
    GradientResidual begin() { return advance(0); }

    void turn(double beta) {
        for_chunks([&](std::size_t c) {
            const Chunk& chunk = of.chunks_[c];
            of.kernels_->turn(of.vectors_of(chunk.sheet), static_cast<float>(beta), chunk.first, chunk.last);
            if (!sheets[chunk.sheet].gradient.empty()) of.find_pull(c);
        });
        if (is_first && has_others) of.turn_others(beta);
        barrier.wait();
    }

    double multiply() {
        for_chunks([&](std::size_t c) { of.multiply_rows(sheets, c); });
        if (has_others) {
            barrier.wait();
            if (is_first) of.add_springs(springs, bodies);
        }
        barrier.wait();
        return sum_of(of.curvatures_);
    }

    GradientResidual advance(double alpha) {
        for_chunks([&](std::size_t c) {
            of.residuals_[c] = of.sum_of_chunk(c, [&](const auto& vectors, auto first, auto last, double* sums) {
                of.kernels_->advance(vectors, static_cast<float>(alpha), first, last, sums);
            });
        });
        if (has_others) {
            if (is_first) of.advance_others(alpha);
            barrier.wait();
            if (is_first) {
                of.precondition_lines();
                of.precondition_bodies(springs, bodies);
            }
            barrier.wait();
            for_chunks([&](std::size_t c) { of.residuals_[c] = of.sum_of_chunk(c, of.kernels_->dot); });
        }
        if (is_first) of.residuals_.back() = has_others ? of.sum_of_others() : 0;
        barrier.wait();
        const double sum = sum_of(of.residuals_);
        return {sum, sum};
    }

private:
    template <class Work>
    void for_chunks(const Work& work) {
        for (std::size_t c = chunks.first; c < chunks.last; ++c) work(c);
    }
};

// z · r of bodies and lines.
double ClothSolver::sum_of_others() const {
    double sum = 0;
    for (std::size_t b = 0; b < body_z_.size(); ++b) sum += product(body_z_[b], body_r_[b]);
    for (std::size_t i = 0; i < line_z_.size(); ++i) sum += dot(line_z_[i], line_r_[i]);
    return sum;
}

// Lines begin with their solution alone. Returns the square of the small loads in the preconditioner's norm.
double ClothSolver::guess(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                          std::span<const TouchSpring> springs, std::span<const Vec3> moves) {
    double load = 0;
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        for (std::size_t i = 0; i < sheets[s].rhs.size(); ++i) {
            const std::size_t at = sheet_first_[s] + i;
            const Float4 move = sheets[s].fixed[i] != 0 ? Float4{} : to_float4(moves[at]);
            x_.set(place_[at], move);
            p_.set(place_[at], move);
            quads_[place_[at]] = move;
            const Float4 small = to_float4(sheets[s].small_load[i]);
            load += product(operator_times(inverse_[at], small), small);
        }
    }
    if (lines.empty()) return load;
    std::vector<Vec3> small;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        std::ranges::copy(lines[l].rhs, line_ap_.begin() + static_cast<std::ptrdiff_t>(line_first_[l]));
        small.insert(small.end(), lines[l].small_load.begin(), lines[l].small_load.end());
    }
    for (const TouchSpring& spring : springs) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count) && spring.acts; ++k) {
            if (spring.node[k] >= nodes_) line_ap_[spring.node[k] - nodes_] += spring.weight[k] * spring.load;
        }
    }
    for (std::size_t i = 0; i < line_of_.size(); ++i) {
        if (line_fixed_[i]) line_ap_[i] = small[i] = {};
    }
    line_x_ = line_ap_;
    solve_lines(line_x_);
    line_p_ = line_x_;
    std::vector<Vec3> given = small;
    solve_lines(given);
    for (std::size_t i = 0; i < small.size(); ++i) load += dot(given[i], small[i]);
    return load;
}

// Residual of the guess, with the forces of springs.
void ClothSolver::find_residual(std::span<const SheetSystem> sheets, std::span<const TouchSpring> springs,
                                std::span<const BodyInertia> bodies, TaskPool& workers) {
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
        if (!sheets[chunks_[c].sheet].gradient.empty()) find_pull(c);
    }
    parallel_for(workers, chunks_.size(), nodes_ >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t c = range.first; c < range.last; ++c) multiply_rows(sheets, c);
    });
    add_springs(springs, bodies);
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        for (std::size_t i = 0; i < sheets[s].rhs.size(); ++i) {
            const std::uint32_t place = place_[sheet_first_[s] + i];
            r_.set(place, to_float4(sheets[s].rhs[i]) - q_.at(place));
        }
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) body_r_[b] = {-body_q_[b].shift, -body_q_[b].turn};
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
            if (spring.node[k] < nodes_) r_.add(place_[spring.node[k]], to_float4(spring.weight[k] * spring.load));
        }
        if (!moves_body(spring, bodies)) continue;
        body_r_[spring.body].shift -= spring.load;
        body_r_[spring.body].turn -= cross(spring.arm, spring.load);
    }
    // A line's own equations hold, so only its couplings are left.
    for (std::size_t i = 0; i < line_of_.size(); ++i) line_r_[i] = line_fixed_[i] ? Vec3{} : line_ap_[i] - line_q_[i];
}

int ClothSolver::solve(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                       std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies, std::span<Vec3> moves,
                       std::span<BodyMove> body_moves, TaskPool& workers) {
    lay_out(sheets, lines);
    if (!prepare(sheets, lines, springs, bodies, workers)) return not_finite;
    for (auto* sums : {&curvatures_, &residuals_}) sums->assign(chunks_.size() + 1, 0);
    for (auto* vector : {&body_p_, &body_q_, &body_r_, &body_z_, &body_x_}) vector->assign(bodies.size(), {});
    const double load = guess(sheets, lines, springs, moves);
    for (std::size_t b = 0; b < bodies.size(); ++b) body_x_[b] = body_p_[b] = body_moves[b];
    find_residual(sheets, springs, bodies, workers);
    curvatures_.back() = 0;
    // The norm of the preconditioner leaves out fixed nodes: their residual is the force that holds them.
    constexpr double rounding = 1e-12;  // of the first residual: floats do not resolve less
    const double tolerance = settings_.gradient_tolerance;
    const GradientLimits limits{settings_.max_gradient_iterations, tolerance * tolerance * load, rounding};
    const int count = nodes_ >= min_parallel_count ? workers.workers() : 1;
    Barrier barrier(count);
    GradientResult result;
    const auto work = [&](int worker) {
        const IndexRange chunks = range_of(chunks_.size(), worker, count);
        WorkerSystem system{*this, sheets, springs, bodies, barrier, worker == 0, chunks};
        const GradientResult own = conjugate_gradient(system, limits);
        if (worker == 0) result = own;
    };
    if (count > 1)
        workers.run(work);
    else
        work(0);
    for (std::size_t i = 0; i < nodes_; ++i) moves[i] = to_vec3(x_.at(place_[i]));
    std::ranges::copy(line_x_, moves.begin() + static_cast<std::ptrdiff_t>(nodes_));
    for (std::size_t b = 0; b < bodies.size(); ++b) body_moves[b] = body_x_[b];
    balance_bodies(springs, bodies, moves, body_moves);
    if (result.end == GradientEnd::not_finite) return not_finite;
    const bool has_gas = std::ranges::any_of(sheets, [](const SheetSystem& sheet) { return !sheet.gradient.empty(); });
    return has_gas && result.end == GradientEnd::indefinite ? indefinite : result.iterations;
}

}  // namespace embody::physics::deformable
