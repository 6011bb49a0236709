// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_system.h"

#include <algorithm>
#include <numeric>

namespace embody::physics::deformable {

void RopeSystem::reset(std::size_t nodes) {
    band.reset(nodes);
    rhs.resize(nodes);
    couplings.clear();
    turns.clear();
    twists.clear();
    folds_.clear();
}

void RopeSystem::add(std::vector<FoldRow> folds, std::span<const Vec3> moves, std::span<const BodyMove> body_moves) {
    folds_ = std::move(folds);
    for (FoldRow& row : folds_) {
        const std::size_t count = std::min(row.by_node.size(), rhs.size() - row.first_node);
        for (std::size_t k = 0; k < count; ++k) row.residual -= dot(row.by_node[k], moves[row.first_node + k]);
        if (row.body != no_body) row.residual -= dot(row.by_turn, body_moves[row.body].turn);
        for (std::size_t r = 0; r < count && !row.is_link; ++r) {
            rhs[row.first_node + r] -= row.weight * row.residual * row.by_node[r];
            for (std::size_t c = 0; c <= r; ++c)
                band.add(row.first_node + r, row.first_node + c, row.weight * outer(row.by_node[r], row.by_node[c]));
        }
    }
}

// Springs between nodes go into the band, and beside it where these lie far from each other; the bodies that others
// touch become unknowns.
void RopeSystem::add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias) {
    constexpr std::size_t band_reach = 2;  // of BandCholesky, in nodes
    body_row_.assign(inertias.size(), none);
    moving_.clear();
    far_.clear();
    first_partner_.resize(rhs.size());
    std::iota(first_partner_.begin(), first_partner_.end(), std::size_t{0});
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
            rhs[spring.node[a]] += spring.weight[a] * spring.load;
            for (std::size_t b = 0; b <= a; ++b) {
                const auto [first, second] = std::minmax({std::size_t{spring.node[a]}, std::size_t{spring.node[b]}});
                const Mat3 stiffness = (spring.weight[a] * spring.weight[b]) * spring.matrix;
                if (second - first <= band_reach) {
                    band.add(second, first, stiffness);
                    continue;
                }
                far_.push_back({first, second, stiffness});
                first_partner_[second] = std::min(first_partner_[second], first);
            }
        }
        if (spring.body == no_body || !inertias[spring.body].moves || body_row_[spring.body] != none) continue;
        body_row_[spring.body] = 0;
        moving_.push_back(spring.body);
    }
}

// The unknowns' rows: those of a body come right behind the last node that it touches.
void RopeSystem::order_unknowns(std::span<const TouchSpring> springs, const std::vector<bool>& fixed) {
    const std::size_t nodes = rhs.size();
    first_node_.assign(body_row_.size(), none);
    last_node_.assign(body_row_.size(), 0);
    const auto touch = [&](std::uint32_t body, std::size_t node) {
        if (!moves(body) || fixed[node]) return;
        first_node_[body] = std::min(first_node_[body], node);
        last_node_[body] = std::max(last_node_[body], node);
    };
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) touch(spring.body, spring.node[a]);
    }
    for (const TurnCoupling& coupling : couplings) touch(coupling.body, coupling.node);
    angle_row_.assign(nodes, none);
    for (const FoldRow& row : folds_) {
        for (const std::size_t angle : row.angle) {
            if (angle != FoldRow::none) angle_row_[angle] = 0;
        }
        for (std::size_t k = 0; k < row.by_node.size() && row.first_node + k < nodes; ++k)
            touch(row.body, row.first_node + k);
    }

    std::ranges::stable_sort(moving_, {}, [&](std::uint32_t body) { return last_node_[body]; });
    node_row_.resize(nodes);
    first_column_.clear();
    const auto add_rows = [&](std::size_t count, std::size_t first) {
        first_column_.insert(first_column_.end(), count, first);
    };
    std::size_t next = 0;  // of moving_
    for (std::size_t node = 0; node < nodes; ++node) {
        node_row_[node] = first_column_.size();
        add_rows(3, node_row_[std::min(node < 2 ? 0 : node - 2, first_partner_[node])]);
        if (node > 0 && angle_row_[node - 1] != none) {
            angle_row_[node - 1] = first_column_.size();
            add_rows(1, node_row_[node < 2 ? 0 : node - 2]);
        }
        for (; next < moving_.size() && last_node_[moving_[next]] == node; ++next) {
            const std::uint32_t body = moving_[next];
            body_row_[body] = first_column_.size();
            add_rows(6, first_node_[body] == none ? body_row_[body] : node_row_[first_node_[body]]);
        }
    }
}

void RopeSystem::fill_matrix(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                             const std::vector<bool>& fixed) {
    matrix_.reset(first_column_);
    values_.assign(first_column_.size(), 0);
    // Nodes.
    for (std::size_t node = 0; node < rhs.size(); ++node) {
        for (std::size_t r = 0; r < 3; ++r) {
            const std::size_t i = 3 * node + r;
            values_[node_row_[node] + r] = rhs[node][static_cast<int>(r)];
            for (std::size_t k = BandCholesky::first_column(i); k <= i; ++k)
                matrix_.at(node_row_[node] + r, node_row_[k / 3] + k % 3) = band.element(i, k);
        }
    }
    for (const FarCoupling& coupling : far_) {
        if (fixed[coupling.first] || fixed[coupling.second]) continue;
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c)
                matrix_.at(node_row_[coupling.second] + r, node_row_[coupling.first] + c) +=
                    coupling.stiffness(static_cast<int>(r), static_cast<int>(c));
        }
    }
    // Bodies.
    const auto add_own = [&](std::size_t first, const Mat3& block) {
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c <= r; ++c)
                matrix_.at(first + r, first + c) += block(static_cast<int>(r), static_cast<int>(c));
        }
    };
    for (const std::uint32_t body : moving_) {
        const std::size_t first = body_row_[body];
        for (std::size_t r = 0; r < 3; ++r) matrix_.at(first + r, first + r) = inertias[body].mass;
        add_own(first + 3, inertias[body].inertia);
    }
    // What couples them.
    const auto add_coupling = [&](std::size_t row, std::size_t node, const Vec3& by_node) {
        for (std::size_t c = 0; c < 3; ++c) matrix_.at(row, node_row_[node] + c) += by_node[static_cast<int>(c)];
    };
    for (const TouchSpring& spring : springs) {
        if (!spring.acts || !moves(spring.body)) continue;
        const std::size_t first = body_row_[spring.body];
        for (std::size_t r = 0; r < 6; ++r) {
            const Vec3 force = spring.matrix * unit_move(r, spring.arm);
            for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
                if (!fixed[spring.node[a]]) add_coupling(first + r, spring.node[a], -spring.weight[a] * force);
            }
            values_[first + r] -= dot(unit_move(r, spring.arm), spring.load);
            for (std::size_t c = 0; c <= r; ++c)
                matrix_.at(first + r, first + c) += dot(unit_move(c, spring.arm), force);
        }
    }
    for (const TurnCoupling& coupling : couplings) {
        if (!moves(coupling.body) || fixed[coupling.node]) continue;
        const std::size_t first = body_row_[coupling.body] + 3;
        for (std::size_t r = 0; r < 3; ++r)
            add_coupling(first + r, coupling.node, coupling.by_node_and_turn.column(static_cast<int>(r)));
    }
    for (const TurnStiffness& turn : turns) {
        if (!moves(turn.body)) continue;
        const std::size_t first = body_row_[turn.body] + 3;
        for (std::size_t r = 0; r < 3; ++r) values_[first + r] += turn.load[static_cast<int>(r)];
        add_own(first, turn.stiffness);
    }
}

// What couples the folds' nodes, angles and bodies; nodes alone of links only, see add().
void RopeSystem::fill_folds(const std::vector<bool>& fixed) {
    // Stiffness of an angle that nothing bends, over that of its links, a number: keeps the matrix definite.
    // Test: Wire.AStraightWireFliesOn
    constexpr double least = 1e-9;
    struct Part {
        std::size_t row = 0;
        double value = 0;
        bool is_node = false;
    };
    std::vector<Part> parts;
    for (const FoldRow& fold : folds_) {
        parts.clear();
        const auto add = [&](std::size_t row, Vec3 value, bool is_node) {
            for (std::size_t k = 0; k < 3; ++k) parts.push_back({row + k, value[static_cast<int>(k)], is_node});
        };
        for (std::size_t k = 0; k < fold.by_node.size() && fold.first_node + k < fixed.size(); ++k) {
            if (!fixed[fold.first_node + k]) add(node_row_[fold.first_node + k], fold.by_node[k], true);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            if (fold.angle[k] == FoldRow::none) continue;
            parts.push_back({angle_row_[fold.angle[k]], fold.by_angle[k]});
            if (fold.is_link) matrix_.at(parts.back().row, parts.back().row) += least * fold.weight;
        }
        if (moves(fold.body)) add(body_row_[fold.body] + 3, fold.by_turn, false);
        for (const Part& a : parts) {
            if (!a.is_node || fold.is_link) values_[a.row] -= fold.weight * fold.residual * a.value;
            for (const Part& b : parts) {
                if (b.row > a.row || b.value == 0 || a.value == 0 || (a.is_node && b.is_node && !fold.is_link))
                    continue;
                matrix_.at(a.row, b.row) += fold.weight * a.value * b.value;
            }
        }
    }
}

// With F for all but the twists, G of their derivatives by the unknowns and K of their stiffnesses:
//   F x + G y = b,  y = K (offset + Gᵀ x)  →  (K⁻¹ + Gᵀ F⁻¹ G) y = offset + Gᵀ F⁻¹ b,  x = F⁻¹ (b - G y).
bool RopeSystem::solve_twists(const std::vector<bool>& fixed, std::vector<double>& moments) {
    const std::size_t n = twists.size();
    std::vector<std::vector<double>> derivatives, answers;
    for (const TwistMode& twist : twists) {
        std::vector<double>& by = derivatives.emplace_back(first_column_.size(), 0.0);
        const auto add = [&](std::size_t row, const Vec3& value) {
            for (std::size_t c = 0; c < 3; ++c) by[row + c] += value[static_cast<int>(c)];
        };
        for (std::size_t i = 0; i < fixed.size(); ++i) {
            if (!fixed[i]) add(node_row_[i], twist.by_node[i]);
        }
        for (std::size_t end = 0; end < 2; ++end) {
            if (moves(twist.body[end])) add(body_row_[twist.body[end]] + 3, twist.by_turn[end]);
        }
        matrix_.solve(answers.emplace_back(by));
    }
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const std::vector<std::size_t> dense(n, 0);
    EnvelopeCholesky matrix;
    matrix.reset(dense);
    for (std::size_t r = 0; r < n; ++r) {
        moments[r] = twists[r].offset + product(derivatives[r], values_);
        for (std::size_t c = 0; c <= r; ++c) matrix.at(r, c) = product(derivatives[r], answers[c]);
        matrix.at(r, r) += twists[r].compliance;
    }
    if (!matrix.factorize()) return false;
    matrix.solve(moments);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = 0; i < values_.size(); ++i) values_[i] -= moments[k] * answers[k][i];
    }
    return true;
}

bool RopeSystem::solve(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                       const std::vector<bool>& fixed, std::vector<Vec3>& node_moves, std::vector<BodyMove>& body_moves,
                       std::vector<double>& moments) {
    add_springs(springs, inertias);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        if (!fixed[i]) continue;
        band.fix(i);
        rhs[i] = {};
    }
    order_unknowns(springs, fixed);
    fill_matrix(springs, inertias, fixed);
    fill_folds(fixed);
    if (!matrix_.factorize()) return false;
    matrix_.solve(values_);
    moments.assign(twists.size(), 0);
    if (!solve_twists(fixed, moments)) return false;
    const auto vector_at = [&](std::size_t row) { return Vec3{values_[row], values_[row + 1], values_[row + 2]}; };
    node_moves.resize(rhs.size());
    for (std::size_t i = 0; i < rhs.size(); ++i) node_moves[i] = vector_at(node_row_[i]);
    for (const std::uint32_t body : moving_)
        body_moves[body] = {vector_at(body_row_[body]), vector_at(body_row_[body] + 3)};
    return true;
}

}  // namespace embody::physics::deformable
