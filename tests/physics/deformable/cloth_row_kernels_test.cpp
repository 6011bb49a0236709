// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_row_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "foundation/random.h"
#include "math/kernel_width.h"
#include "physics/deformable/cloth/cloth_matrix.h"

namespace embody::physics::deformable {
namespace {

struct Element {
    std::size_t row, column;
    Mat3 block;
};

Float4 random_vector(Random& random) {
    return to_float4({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

Mat3 random_matrix(Random& random) {
    const auto column = [&] { return to_vec3(random_vector(random)); };
    return {column(), column(), column()};
}

struct SheetCase {
    int width, height;
    bool in_order, has_near, has_far;
};

/// A grid of nodes, row by row or in any order, each with its neighbours and those two steps off.
struct Sheet {
    std::size_t count, slices;
    ClothMatrix matrix;
    SliceBlocks own, inverse;
    SliceVectors p, q, r, z, x;
    std::vector<Float4> quads;
    std::vector<Element> elements;

    explicit Sheet(const SheetCase& of)
        : count(static_cast<std::size_t>(of.width * of.height)), slices(slices_for(count)), quads(slices * slice_rows) {
        Random random(5);
        std::vector<std::uint32_t> number(count);
        for (std::size_t i = 0; i < count; ++i) number[i] = static_cast<std::uint32_t>(i);
        for (std::size_t i = count; !of.in_order && i-- > 1;)
            std::swap(number[i], number[static_cast<std::size_t>(random.between(0, static_cast<double>(i)))]);
        std::vector<std::vector<std::uint32_t>> near(count), far(count);
        const auto join = [&](auto& rows, int column, int line, int u, int v) {
            if (column + u >= of.width || line + v >= of.height) return;
            const std::uint32_t a = number[static_cast<std::size_t>(line * of.width + column)],
                                b = number[static_cast<std::size_t>((line + v) * of.width + column + u)];
            rows[a].push_back(b);
            rows[b].push_back(a);
        };
        for (int line = 0; line < of.height; ++line) {
            for (int column = 0; column < of.width; ++column) {
                for (const auto& [u, v] : {std::array{0, 1}, {1, 0}, {1, 1}}) {
                    if (of.has_near) join(near, column, line, u, v);
                }
                for (const auto& [u, v] : {std::array{0, 2}, {2, 0}, {1, 2}}) {
                    if (of.has_far) join(far, column, line, u, v);
                }
            }
        }
        for (auto* rows : {&near, &far}) {
            for (auto& row : *rows) std::ranges::sort(row);
        }
        matrix.set_pattern(near, far);
        for (auto* blocks : {&own, &inverse}) blocks->resize(slices);
        for (auto* vector : {&p, &q, &r, &z, &x}) vector->resize(slices);
        for (std::size_t row = 0; row < count; ++row) {
            for (std::size_t k = 0; k < near[row].size(); ++k) {
                const Mat3 block = random_matrix(random);
                matrix.set_near(row, k, to_block(block));
                elements.push_back({row, near[row][k], block});
            }
            for (std::size_t k = 0; k < far[row].size(); ++k) {
                const auto value = static_cast<float>(random.between(-1, 1));
                matrix.set_far(row, k, value);
                elements.push_back({row, far[row][k], static_cast<double>(value) * Mat3::identity()});
            }
            const Mat3 block = random_matrix(random);
            elements.push_back({row, row, block});
            own.set(row / slice_rows, row % slice_rows, to_block(block));
            inverse.set(row / slice_rows, row % slice_rows, to_block(random_matrix(random)));
            for (auto* vector : {&p, &r, &z, &x}) vector->set(row, random_vector(random));
        }
    }
    ClothVectors vectors() {
        return {.stride = p.stride(),
                .p = p.slice(0),
                .q = q.slice(0),
                .r = r.slice(0),
                .z = z.slice(0),
                .x = x.slice(0),
                .quads = reinterpret_cast<float*>(quads.data()),
                .inverse = inverse.slice(0)};
    }
    /// A round, in two pieces; all that comes of it.
    std::vector<double> round(const ClothRowKernels& kernels) {
        std::array<double, slice_rows> bend{}, size{}, again{};
        const ClothVectors all = vectors();
        const ClothRows rows = matrix.rows(own.slice(0));
        const std::size_t middle = slices / 2;
        for (const auto& [first, last] : {std::array{std::size_t{0}, middle}, {middle, slices}})
            kernels.turn(all, 0.7f, first, last);
        for (const auto& [first, last] : {std::array{std::size_t{0}, middle}, {middle, slices}}) {
            kernels.multiply(rows, all, first, last, bend.data());
            kernels.advance(all, 0.3f, first, last, size.data());
            kernels.dot(all, first, last, again.data());
        }
        std::vector<double> result;
        for (const auto* sums : {&bend, &size, &again}) result.insert(result.end(), sums->begin(), sums->end());
        for (const auto* vector : {&p, &q, &r, &z, &x}) {
            for (std::size_t i = 0; i < slices * slice_rows; ++i) {
                const Vec3 v = to_vec3(vector->at(i));
                if (i >= count) {
                    EXPECT_EQ(v, Vec3{}) << i;
                }
                result.insert(result.end(), {v.x, v.y, v.z});
            }
        }
        return result;
    }
};

class ClothRowKernelTest : public testing::TestWithParam<SheetCase> {};

TEST_P(ClothRowKernelTest, MultipliesAsTheMatrixDoes) {
    Sheet sheet(GetParam());
    std::vector<Vec3> direction(sheet.count), expected(sheet.count);
    for (std::size_t i = 0; i < sheet.count; ++i) direction[i] = to_vec3(sheet.z.at(i)) + 0.7 * to_vec3(sheet.p.at(i));
    double bend = 0, size = 0;
    for (const Element& element : sheet.elements) expected[element.row] += element.block * direction[element.column];
    for (std::size_t i = 0; i < sheet.count; ++i) {
        bend += dot(expected[i], direction[i]);
        size += length(expected[i]) * length(direction[i]);
    }
    const std::vector<double> result = sheet.round(widest_kernels<ClothRowKernels>());
    double sum = 0;
    for (std::size_t lane = 0; lane < slice_rows; ++lane) sum += result[lane];
    EXPECT_NEAR(sum, bend, 1e-5 * size);
    for (std::size_t i = 0; i < sheet.count; ++i)
        EXPECT_LT(length(to_vec3(sheet.q.at(i)) - expected[i]), 1e-5 * (1 + length(expected[i])));
}

TEST_P(ClothRowKernelTest, AnyNumberOfLanesGivesTheSameBits) {
    const std::vector<double> expected = Sheet(GetParam()).round(*kernels_of<ClothRowKernels>(4));
    int compared = 0;
    for (const int lanes : {8, 16}) {
        const ClothRowKernels* kernels = kernels_of<ClothRowKernels>(lanes);
        if (!kernels) continue;
        EXPECT_EQ(Sheet(GetParam()).round(*kernels), expected) << lanes;
        ++compared;
    }
    if (compared == 0) GTEST_SKIP() << "this processor has no wider registers";
}

INSTANTIATE_TEST_SUITE_P(Sheets, ClothRowKernelTest,
                         testing::Values(SheetCase{21, 21, true, true, true}, SheetCase{21, 21, false, true, true},
                                         SheetCase{1, 1, true, true, true}, SheetCase{2, 1, true, true, true},
                                         SheetCase{5, 3, true, true, true}, SheetCase{4, 4, true, true, true},
                                         SheetCase{17, 1, true, true, true}, SheetCase{31, 1, false, true, true},
                                         SheetCase{11, 3, true, true, true}, SheetCase{9, 9, true, false, true},
                                         SheetCase{9, 9, true, true, false}));

}  // namespace
}  // namespace embody::physics::deformable
