// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace embody::physics {

namespace {

constexpr std::size_t worth_sharing = 1000;  // nodes
constexpr std::size_t chunk_slices = 8;      // whose products are summed before the others'

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

// Whether the preconditioner holds all of it: one node, or nodes of one line, and no body that moves.
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
    needs_quads_.clear();
    place_.clear();
    std::size_t slices = 0;
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        const std::size_t count = sheets[s].rhs.size(), own_slices = slices_for(count);
        sheet_first_.push_back(nodes_);
        sheet_slice_.push_back(slices);
        needs_quads_.push_back(sheets[s].matrix->needs_quads());
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
    for (auto* vector : {&direction_, &product_, &residual_, &better_, &answer_}) vector->resize(slices);
    own_blocks_.resize(slices);
    inverse_blocks_.resize(slices);
    quads_.assign(std::ranges::count(needs_quads_, true) > 0 ? slices * slice_rows : 0, Float4{});
    for (auto* vector : {&line_direction_, &line_own_product_, &line_product_, &line_residual_, &line_better_,
                         &line_answer_, &line_own_better_})
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
        share_among(workers, count, count >= worth_sharing, [&](int, Share share) {
            for (std::size_t i = share.first; i < share.last; ++i) {
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

// What a spring between nodes of sheets adds beside the diagonal.
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
        const bool is_single = spring.count == 1 && spring.node[0] < nodes_;
        const Mat3 felt = is_single ? k - k * to_matrix(inverse_[spring.node[0]]) * k : k;
        add_at_arm(factor, felt, spring.arm);
    }
    for (const LineHold& hold : line_holds_) give_way(hold);
    for (BodyFactor& body : body_factors_) factorize(body.factor);
}

ClothVectors ClothSolver::vectors_of(std::size_t sheet) {
    const std::size_t slice = sheet_slice_[sheet];
    return {.stride = direction_.stride(),
            .direction = direction_.slice(slice),
            .product = product_.slice(slice),
            .residual = residual_.slice(slice),
            .better = better_.slice(slice),
            .answer = answer_.slice(slice),
            .quads = needs_quads_[sheet] ? reinterpret_cast<float*>(quads_.data() + slice * slice_rows) : nullptr,
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
            bodies[b].moves ? embody::physics::solve(body_factors_[b].factor, body_better_[b]) : BodyMove{};
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
            if (!quads_.empty()) quads_[place_[at]] = move;
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

}  // namespace embody::physics
