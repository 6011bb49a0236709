// SPDX-License-Identifier: MIT
#include "physics/linear/dissected_cholesky.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "math/kernel_width.h"
#include "physics/linear/column_kernels.h"

namespace embody::physics::linear {

namespace {

// Numbers from one column of a front to the next.
std::size_t stride_of(const Front& front) {
    return (3 * front.size() + column_multiple - 1) / column_multiple * column_multiple;
}

// The row at which kernels begin a column: the last multiple of column_multiple that is not below the diagonal.
std::size_t first_row(std::size_t column) { return column / column_multiple * column_multiple; }

// Right-looking elimination of the first `own` of `size` columns (lower triangle, column by column), some columns at
// a time: what they take from those behind them is read and written once.
void eliminate(double* a, std::size_t size, std::size_t own) {
    constexpr double huge = 1e30;  // a pivot of what must not move: far above any, its square is still a double
    const auto subtract_scaled = widest_kernels<ColumnKernels>().subtract_scaled;
    for (std::size_t first = 0; first < own; first += columns_at_once) {
        const std::size_t last = std::min(own, first + columns_at_once);
        for (std::size_t j = first; j < last; ++j) {
            double* column = a + j * size;
            const double pivot = column[j] > 0 ? std::sqrt(column[j]) : huge;
            column[j] = pivot;
            for (std::size_t i = j + 1; i < size; ++i) column[i] /= pivot;
            for (std::size_t k = j + 1; k < last; ++k)
                subtract_scaled(a + k * size + k, column + k, size, 1, column + k, size - k);
        }
        const double* columns = a + first * size;
        for (std::size_t k = last; k < size; ++k)
            subtract_scaled(a + k * size + k, columns + k, size, last - first, columns + k, size - k);
    }
}

}  // namespace

void DissectedCholesky::analyse(std::span<const Vec3> positions, std::span<const Edge> edges) {
    order_ = dissect(positions, edges);
    const std::size_t fronts = order_.fronts.size();
    first_value_.assign(1, 0);
    local_.resize(fronts);
    for (std::size_t f = 0; f < fronts; ++f) {
        const Front& front = order_.fronts[f];
        first_value_.push_back(first_value_.back() + 3 * front.own() * stride_of(front));
        local_[f].resize(stride_of(front));
    }
    depth_.resize(fronts);
    for (std::size_t f = fronts; f-- > 0;) {
        const Front& front = order_.fronts[f];
        depth_[f] = 3 * front.own() + (front.parent == f ? 0 : depth_[front.parent]);
    }
    value_.assign(first_value_.back(), 0.0f);  // above the diagonal and behind the last row zeros stay
    x_.resize(positions.size());
    parallel_workers_ = 0;
}

void DissectedCholesky::factor(std::span<const Mat3> diagonal, std::span<const Edge> edges,
                               std::span<const Mat3> blocks) {
    // Blocks by the front that eliminates the earlier of their two nodes.
    std::vector<std::vector<std::uint32_t>> edges_of(order_.fronts.size());
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
        const std::uint32_t earlier = std::min(order_.place[edges[e][0]], order_.place[edges[e][1]]);
        edges_of[order_.front_of[earlier]].push_back(e);
    }

    using Triangle = std::unique_ptr<double[]>;        // square, of which the lower triangle counts
    std::vector<Triangle> left(order_.fronts.size());  // what a front leaves its parent
    std::vector<double> a;
    for (std::uint32_t f = 0; f < order_.fronts.size(); ++f) {
        const Front& front = order_.fronts[f];
        const std::size_t size = 3 * front.size(), own = 3 * front.own();
        a.assign(size * size, 0.0);
        const auto local = [&](std::uint32_t place) -> std::size_t {
            if (place < front.last) return place - front.first;
            return front.own() +
                   static_cast<std::size_t>(std::ranges::lower_bound(front.rows, place) - front.rows.begin());
        };
        const auto add = [&](std::size_t row, std::size_t column, const Mat3& block) {
            for (int c = 0; c < 3; ++c) {
                for (int r = 0; r < 3; ++r)
                    a[(3 * column + static_cast<std::size_t>(c)) * size + 3 * row + static_cast<std::size_t>(r)] +=
                        block(r, c);
            }
        };
        for (std::uint32_t place = front.first; place < front.last; ++place)
            add(place - front.first, place - front.first, diagonal[order_.node[place]]);
        for (const std::uint32_t e : edges_of[f]) {
            const std::uint32_t row = order_.place[edges[e][0]], column = order_.place[edges[e][1]];
            if (row > column)
                add(local(row), local(column), blocks[e]);
            else
                add(local(column), local(row), transpose(blocks[e]));
        }
        for (const std::uint32_t child_index : front.children) {
            const Front& child = order_.fronts[child_index];
            const std::size_t rows = 3 * child.rows.size();
            const auto to = [&](std::size_t i) { return 3 * child.in_parent[i / 3] + i % 3; };
            for (std::size_t c = 0; c < rows; ++c) {
                for (std::size_t r = c; r < rows; ++r) a[to(c) * size + to(r)] += left[child_index][c * rows + r];
            }
            left[child_index].reset();
        }

        eliminate(a.data(), size, own);
        float* value = &value_[first_value_[f]];
        for (std::size_t c = 0; c < own; ++c) {
            for (std::size_t r = c; r < size; ++r)
                value[c * stride_of(front) + r] = static_cast<float>(a[c * size + r]);
        }
        const std::size_t rest = size - own;
        left[f] = std::make_unique_for_overwrite<double[]>(rest * rest);
        for (std::size_t c = 0; c < rest; ++c) {
            for (std::size_t r = c; r < rest; ++r) left[f][c * rest + r] = a[(own + c) * size + own + r];
        }
    }
}

const float* DissectedCholesky::column(const Front& front, std::size_t own_column) const {
    const auto f = static_cast<std::size_t>(&front - order_.fronts.data());
    return &value_[first_value_[f] + own_column * stride_of(front)];
}

void DissectedCholesky::gather_children(std::uint32_t index, float* local) const {
    const Front& front = order_.fronts[index];
    std::fill(local, local + 3 * front.size(), 0.0f);
    for (const std::uint32_t child_index : front.children) {
        const Front& child = order_.fronts[child_index];
        const float* given = local_[child_index].data() + 3 * child.own();
        for (std::size_t k = 0; k < child.rows.size(); ++k) {
            float* to = local + 3 * child.in_parent[k];
            for (std::size_t c = 0; c < 3; ++c) to[c] += given[3 * k + c];
        }
    }
}

// Solves L y = b for a front's own numbers, three columns at a time, and keeps what is left for its parent.
void DissectedCholesky::eliminate_down(const Front& front, float* w) const {
    const auto subtract_columns = widest_kernels<ColumnKernels>().subtract_columns;
    const std::size_t stride = stride_of(front);
    for (std::size_t j = 0; j < 3 * front.own(); j += 3) {
        const float *a = column(front, j), *b = a + stride, *c = b + stride;
        const float x = w[j] / a[j];
        const float y = (w[j + 1] - a[j + 1] * x) / b[j + 1];
        const float z = (w[j + 2] - a[j + 2] * x - b[j + 2] * y) / c[j + 2];
        const std::size_t first = first_row(j);
        subtract_columns(w + first, a + first, b + first, c + first, stride - first, x, y, z);
        w[j] = x;
        w[j + 1] = y;
        w[j + 2] = z;
    }
}

void DissectedCholesky::solve_down(std::uint32_t index) {
    const Front& front = order_.fronts[index];
    float* w = local_[index].data();
    gather_children(index, w);
    for (std::uint32_t place = front.first; place < front.last; ++place) {
        float* own = w + 3 * (place - front.first);
        own[0] += x_[place].x;
        own[1] += x_[place].y;
        own[2] += x_[place].z;
    }
    eliminate_down(front, w);
}

// Lᵀ x = y of one front.
void DissectedCholesky::solve_up(std::uint32_t index) {
    const Front& front = order_.fronts[index];
    float* w = local_[index].data();
    for (std::size_t k = 0; k < front.rows.size(); ++k) {
        float* row = w + 3 * (front.own() + k);
        const Vec3f x = x_[front.rows[k]];
        row[0] = x.x;
        row[1] = x.y;
        row[2] = x.z;
    }
    const auto dot_columns = widest_kernels<ColumnKernels>().dot_columns;
    const std::size_t stride = stride_of(front);
    for (std::size_t j = 3 * front.own(); j > 0;) {
        j -= 3;
        const float *a = column(front, j), *b = a + stride, *c = b + stride;
        const float right[3] = {w[j], w[j + 1], w[j + 2]};
        std::fill(w + j, w + j + 3, 0.0f);
        const std::size_t first = first_row(j);
        float below[3];
        dot_columns(w + first, a + first, b + first, c + first, stride - first, below);
        const float z = (right[2] - below[2]) / c[j + 2];
        const float y = (right[1] - below[1] - b[j + 2] * z) / b[j + 1];
        const float x = (right[0] - below[0] - a[j + 1] * y - a[j + 2] * z) / a[j];
        w[j] = x;
        w[j + 1] = y;
        w[j + 2] = z;
    }
    for (std::uint32_t place = front.first; place < front.last; ++place) {
        const float* own = w + 3 * (place - front.first);
        x_[place] = {own[0], own[1], own[2]};
    }
}

// Subtrees of about equal work, the largest first, each to the worker that has the least work so far.
void DissectedCholesky::find_parallel_subtrees(int workers) {
    if (parallel_workers_ == workers) return;
    parallel_workers_ = workers;
    subtrees_ = {};
    subtrees_.of_worker.resize(static_cast<std::size_t>(workers));
    const std::size_t fronts = order_.fronts.size();
    std::vector<std::size_t> work(fronts, 0);
    std::size_t all = 0;
    for (std::size_t f = 0; f < fronts; ++f) {
        const Front& front = order_.fronts[f];
        work[f] += front.own() * front.size();
        all += front.own() * front.size();
        if (front.parent != f) work[front.parent] += work[f];
    }

    // Roots of subtrees: the largest fronts whose work is no more than this fraction of the whole.
    const std::size_t most = workers == 1 ? all : all / (static_cast<std::size_t>(workers) * 2) + 1;
    std::vector<std::uint32_t> root_of(fronts), roots;
    constexpr std::uint32_t none = 0xFFFFFFFF;
    for (std::size_t f = fronts; f-- > 0;) {
        const std::uint32_t parent = order_.fronts[f].parent;
        const std::uint32_t above = parent == f ? none : root_of[parent];
        root_of[f] = above != none ? above : work[f] <= most ? static_cast<std::uint32_t>(f) : none;
        if (root_of[f] == f) roots.push_back(static_cast<std::uint32_t>(f));
    }
    std::ranges::stable_sort(roots, std::greater{}, [&](std::uint32_t f) { return work[f]; });
    std::vector<std::size_t> load(static_cast<std::size_t>(workers), 0), worker_of(fronts, 0);
    for (const std::uint32_t root : roots) {
        const auto least = static_cast<std::size_t>(std::ranges::min_element(load) - load.begin());
        load[least] += work[root];
        worker_of[root] = least;
    }
    for (std::uint32_t f = 0; f < fronts; ++f) {
        if (root_of[f] == none)
            subtrees_.rest.push_back(f);
        else
            subtrees_.of_worker[worker_of[root_of[f]]].push_back(f);
    }
}

void DissectedCholesky::solve(std::span<Vec3f> x, TaskPool& workers) {
    constexpr std::size_t min_parallel_count = 100000;  // numbers: below, waking the workers costs more
    const int count = value_.size() < min_parallel_count ? 1 : workers.workers();
    find_parallel_subtrees(count);
    for (std::size_t place = 0; place < x_.size(); ++place) x_[place] = x[order_.node[place]];
    const auto fraction = [&](const auto& work) {
        if (count == 1) return work(0);
        workers.run(work);
    };
    fraction([&](int worker) {
        for (const std::uint32_t f : subtrees_.of_worker[static_cast<std::size_t>(worker)]) solve_down(f);
    });
    for (const std::uint32_t f : subtrees_.rest) solve_down(f);
    for (std::size_t k = subtrees_.rest.size(); k-- > 0;) solve_up(subtrees_.rest[k]);
    fraction([&](int worker) {
        const auto& fronts = subtrees_.of_worker[static_cast<std::size_t>(worker)];
        for (std::size_t k = fronts.size(); k-- > 0;) solve_up(fronts[k]);
    });
    for (std::size_t place = 0; place < x_.size(); ++place) x[order_.node[place]] = x_[place];
}

DissectedCholesky::Columns DissectedCholesky::columns(std::uint32_t node) const {
    const std::uint32_t place = order_.place[node];
    Columns result;
    result.front = order_.front_of[place];
    result.length = depth_[result.front];
    result.value.assign(3 * result.length, 0.0f);
    for (std::size_t unit = 0; unit < 3; ++unit) {
        std::uint32_t f = result.front;
        std::vector<float> w(stride_of(order_.fronts[f]), 0.0f);
        w[3 * (place - order_.fronts[f].first) + unit] = 1;
        while (true) {
            const Front& front = order_.fronts[f];
            const std::size_t own = 3 * front.own();
            eliminate_down(front, w.data());
            std::copy(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(own),
                      result.value.begin() + static_cast<std::ptrdiff_t>(unit * result.length + depth_[f] - own));
            if (front.parent == f) break;
            std::vector<float> above(stride_of(order_.fronts[front.parent]), 0.0f);
            for (std::size_t k = 0; k < front.rows.size(); ++k) {
                for (std::size_t c = 0; c < 3; ++c) above[3 * front.in_parent[k] + c] = w[own + 3 * k + c];
            }
            w = std::move(above);
            f = front.parent;
        }
    }
    return result;
}

Mat3 DissectedCholesky::inverse_block(const Columns& i, const Columns& j) const {
    // Both columns have numbers from the first front that they have in common to the last.
    std::uint32_t f = i.front, g = j.front;
    while (f != g) {
        std::uint32_t& earlier = f < g ? f : g;
        if (order_.fronts[earlier].parent == earlier) return Mat3::zero();
        earlier = order_.fronts[earlier].parent;
    }
    float product[9];
    widest_kernels<ColumnKernels>().dot_blocks(i.value.data(), i.length, j.value.data(), j.length, depth_[f], product);
    Mat3 block;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) block(r, c) = static_cast<double>(product[3 * r + c]);
    }
    return block;
}

}  // namespace embody::physics::linear
