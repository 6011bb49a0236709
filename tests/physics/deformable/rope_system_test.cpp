// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_system.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "physics/linear/dense_matrix.h"

namespace embody::physics::deformable {
namespace {

using linear::DenseMatrix;

Vec3 random_vec(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }
Mat3 random_stiffness(Random& random) {
    const Mat3 g{random_vec(random), random_vec(random), random_vec(random)};
    return g * transpose(g);
}

// The same system by Gauss's elimination: nodes, then six unknowns a body, then the twists' moments.
struct DenseSystem {
    DenseMatrix matrix;
    std::vector<double> load;
    std::size_t nodes, bodies;

    DenseSystem(std::size_t node_count, std::size_t body_count, std::size_t twists)
        : matrix(3 * node_count + 6 * body_count + twists),
          load(matrix.size, 0.0),
          nodes(node_count),
          bodies(body_count) {}
    [[nodiscard]] std::size_t body_row(std::size_t body) const { return 3 * nodes + 6 * body; }
    [[nodiscard]] std::size_t twist_row(std::size_t twist) const { return 3 * nodes + 6 * bodies + twist; }

    void add(std::size_t row, std::size_t column, const Mat3& block) {
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c)
                matrix.at(row + r, column + c) += block(static_cast<int>(r), static_cast<int>(c));
        }
    }
    void add(std::size_t row, const Vec3& value) {
        for (std::size_t r = 0; r < 3; ++r) load[row + r] += value[static_cast<int>(r)];
    }
    // A spring is ½ sᵀ K s - load·s of s = Σ w x - (move + turn × arm).
    void add(const TouchSpring& spring, bool has_body) {
        std::vector<std::pair<std::size_t, Mat3>> by;  // s by each three unknowns
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a)
            by.emplace_back(3 * spring.node[a], Mat3::diagonal(Vec3{1, 1, 1} * spring.weight[a]));
        if (has_body) {
            by.emplace_back(body_row(spring.body), Mat3::diagonal({-1, -1, -1}));
            by.emplace_back(body_row(spring.body) + 3,
                            Mat3{cross(Vec3{-1, 0, 0}, spring.arm), cross(Vec3{0, -1, 0}, spring.arm),
                                 cross(Vec3{0, 0, -1}, spring.arm)});
        }
        for (const auto& [row, one] : by) {
            add(row, transpose(one) * spring.load);
            for (const auto& [column, other] : by) add(row, column, transpose(one) * spring.matrix * other);
        }
    }
    void hold(std::size_t node) {
        for (std::size_t r = 3 * node; r < 3 * node + 3; ++r) {
            load[r] = 0;
            for (std::size_t c = 0; c < matrix.size; ++c) matrix.at(r, c) = matrix.at(c, r) = r == c ? 1 : 0;
        }
    }
};

TEST(RopeSystem, SolvesAsEliminationDoes) {
    // Ropes of any length, springs with any bodies at any nodes, some of which are held, and twists between bodies.
    Random random(1);
    for (int iteration = 0; iteration < 200; ++iteration) {
        const std::size_t nodes = 2 + random.below(20), bodies = random.below(6), twists = random.below(3);
        RopeSystem system;
        system.reset(nodes);
        DenseSystem dense(nodes, bodies, twists);
        for (std::size_t i = 0; i < nodes; ++i) {
            system.band.add_diagonal(i, 40);
            dense.add(3 * i, 3 * i, Mat3::diagonal({40, 40, 40}));
            for (std::size_t k = i >= 2 ? i - 2 : 0; k < i; ++k) {
                const Mat3 block = random_stiffness(random);
                system.band.add(i, k, block);
                dense.add(3 * i, 3 * k, block);
                dense.add(3 * k, 3 * i, transpose(block));
            }
            system.rhs[i] = random_vec(random);
            dense.add(3 * i, system.rhs[i]);
        }
        std::vector<BodyInertia> inertias(bodies);
        for (std::size_t b = 0; b < bodies; ++b) inertias[b] = {random.below(4) != 0, 3, Mat3::diagonal({4, 5, 6})};

        // Springs: with a body, with none; of one node or two neighbours; some do not act.
        std::vector<TouchSpring> springs;
        std::vector<bool> is_touched(bodies, false);
        for (std::uint64_t count = random.below(12); count > 0; --count) {
            TouchSpring spring{.acts = random.below(5) != 0};
            spring.count = 1 + static_cast<int>(random.below(2));
            spring.node[0] = static_cast<std::uint32_t>(random.below(nodes - 1));
            spring.node[1] = spring.node[0] + 1;
            spring.weight = {0.3, 0.7};
            spring.body = static_cast<std::uint32_t>(random.below(bodies + 1));
            if (spring.body == bodies) spring.body = no_body;
            spring.arm = random_vec(random);
            spring.matrix = random_stiffness(random);
            spring.load = random_vec(random);
            springs.push_back(spring);
            if (!spring.acts) continue;
            const bool has_body = spring.body != no_body && inertias[spring.body].moves;
            if (has_body) is_touched[spring.body] = true;
            dense.add(spring, has_body);
        }

        // Clamps at bodies that springs hold too.
        for (std::uint32_t body = 0; body < bodies; ++body) {
            if (random.below(2) == 0) continue;
            const auto node = static_cast<std::uint32_t>(random.below(nodes));
            const Mat3 coupling = random_stiffness(random), stiffness = Mat3::diagonal({9, 9, 9});
            const Vec3 load = random_vec(random);
            system.couplings.push_back({body, node, coupling});
            system.turns.push_back({body, stiffness, load});
            if (!is_touched[body]) continue;
            const std::size_t row = dense.body_row(body) + 3;
            dense.add(3 * node, row, coupling);
            dense.add(row, 3 * node, transpose(coupling));
            dense.add(row, row, stiffness);
            dense.add(row, load);
        }
        for (std::size_t body = 0; body < bodies; ++body) {
            const std::size_t row = dense.body_row(body);
            dense.add(row, row, Mat3::diagonal({3, 3, 3}));
            dense.add(row + 3, row + 3, Mat3::diagonal({4, 5, 6}));
        }

        // Twists: y = (offset + g·x)/compliance, so g·x - compliance y = -offset, and each unknown gets + g y.
        for (std::size_t k = 0; k < twists; ++k) {
            TwistMode twist{.compliance = 0.5, .offset = random.between(-1, 1)};
            const std::size_t row = dense.twist_row(k);
            const auto add = [&](std::size_t first, const Vec3& by) {
                for (std::size_t c = 0; c < 3; ++c) {
                    dense.matrix.at(row, first + c) += by[static_cast<int>(c)];
                    dense.matrix.at(first + c, row) += by[static_cast<int>(c)];
                }
            };
            for (std::size_t i = 0; i < nodes; ++i) add(3 * i, twist.by_node.emplace_back(random_vec(random)));
            for (std::size_t end = 0; end < 2 && bodies > 0; ++end) {
                const auto body = static_cast<std::uint32_t>(random.below(bodies));
                twist.body[end] = body;
                twist.by_turn[end] = random_vec(random);
                if (is_touched[body]) add(dense.body_row(body) + 3, twist.by_turn[end]);
            }
            dense.matrix.at(row, row) = -twist.compliance;
            dense.load[row] = -twist.offset;
            system.twists.push_back(twist);
        }
        std::vector<bool> fixed(nodes, false);
        for (std::size_t i = 0; i < nodes; ++i) {
            fixed[i] = random.below(5) == 0;
            if (fixed[i]) dense.hold(i);
        }

        std::vector<Vec3> moves;
        std::vector<BodyMove> body_moves(bodies);
        std::vector<double> moments;
        ASSERT_TRUE(system.solve(springs, inertias, fixed, moves, body_moves, moments)) << iteration;
        const std::vector<double> right = dense.matrix.solve(dense.load);
        const auto expect = [&](std::size_t row, const Vec3& found) {
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(found[static_cast<int>(c)], right[row + c], 1e-10) << iteration << ", row " << row + c;
        };
        for (std::size_t i = 0; i < nodes; ++i) expect(3 * i, moves[i]);
        for (std::size_t b = 0; b < bodies; ++b) {
            if (!is_touched[b]) continue;
            expect(dense.body_row(b), body_moves[b].shift);
            expect(dense.body_row(b) + 3, body_moves[b].turn);
        }
        for (std::size_t k = 0; k < twists; ++k) ASSERT_NEAR(moments[k], right[dense.twist_row(k)], 1e-10) << iteration;
    }
}

}  // namespace
}  // namespace embody::physics::deformable
