// SPDX-License-Identifier: MIT
//
// Ropes in the solve of sheets and ropes: the factor of a line's band A is the preconditioner of its nodes; of a body
// that lines hold by columns C it eliminates these, S = D - Cᵀ A⁻¹ C.
#include <algorithm>

#include "physics/deformable/cloth/cloth_solver.h"

namespace embody::physics::deformable {

bool ClothSolver::prepare_lines(std::span<const LineSystem> lines, std::span<const TouchSpring> springs) {
    factors_.clear();
    for (const LineSystem& line : lines) factors_.push_back(line.matrix);
    if (lines.empty()) return true;
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
            if (spring.node[a] < nodes_) continue;
            const std::size_t line = line_of_[spring.node[a] - nodes_], first = nodes_ + line_first_[line];
            for (std::size_t b = 0; b < static_cast<std::size_t>(spring.count); ++b) {
                // Each pair of nodes once, the later one as the row.
                if (spring.node[b] > spring.node[a] || !is_same_block(spring.node[a], spring.node[b])) continue;
                lines[line].matrix->add(spring.node[a] - first, spring.node[b] - first,
                                        (spring.weight[a] * spring.weight[b]) * spring.matrix);
            }
        }
    }
    for (const LineSystem& line : lines) {
        for (std::size_t i = 0; i < line.rhs.size(); ++i) {
            if ((*line.fixed)[i]) line.matrix->fix(i);
        }
        if (!line.matrix->factorize()) return false;
    }
    return true;
}

// If the preconditioner did not include how a line and a light body that hangs on it move together, the residual would
// hardly show their error.
void ClothSolver::prepare_line_holds(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies) {
    line_holds_.clear();
    for (const std::uint32_t s : coupled_) {
        const TouchSpring& spring = springs[s];
        if (!moves_body(spring, bodies)) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
            if (spring.node[k] < nodes_) continue;
            const std::size_t at = spring.node[k] - nodes_, line = line_of_[at];
            const auto is_same = [&](const LineHold& hold) { return hold.body == spring.body && hold.line == line; };
            auto hold = std::ranges::find_if(line_holds_, is_same);
            if (hold == line_holds_.end()) {
                line_holds_.push_back({spring.body, line, {}, {}});
                hold = line_holds_.end() - 1;
                for (auto& column : hold->column) column.resize(line_first_[line + 1] - line_first_[line]);
            }
            if (line_fixed_[at]) continue;
            for (std::size_t c = 0; c < 6; ++c)
                hold->column[c][at - line_first_[line]] -=
                    spring.weight[k] * (spring.matrix * unit_move(c, spring.arm));
        }
    }
    for (LineHold& hold : line_holds_) {
        hold.given = hold.column;
        for (auto& given : hold.given) factors_[hold.line]->solve(given);
    }
}

// Stiffness for the body, reduced by the line's compliance: less Cᵀ A⁻¹ C.
void ClothSolver::apply_line_hold(const LineHold& hold) {
    for (std::size_t r = 0; r < 6; ++r) {
        for (std::size_t c = 0; c < 6; ++c) {
            double sum = 0;
            for (std::size_t i = 0; i < hold.column[r].size(); ++i) sum += dot(hold.column[r][i], hold.given[c][i]);
            body_blocks_[hold.body].at(r, c) -= sum;
        }
    }
}

void ClothSolver::solve_lines(std::span<Vec3> rhs) const {
    for (std::size_t l = 0; l < factors_.size(); ++l)
        factors_[l]->solve(rhs.subspan(line_first_[l], line_first_[l + 1] - line_first_[l]));
}

void ClothSolver::precondition_lines() {
    line_az_ = line_z_ = line_r_;
    solve_lines(line_z_);
}

void ClothSolver::add_line_pulls() {
    for (const LineHold& hold : line_holds_) {
        const Vec3* z = line_z_.data() + line_first_[hold.line];
        std::array<double, 6> pull{};
        for (std::size_t c = 0; c < 6; ++c) {
            for (std::size_t i = 0; i < hold.column[c].size(); ++i) pull[c] += dot(hold.column[c][i], z[i]);
        }
        body_z_[hold.body].shift -= Vec3{pull[0], pull[1], pull[2]};
        body_z_[hold.body].turn -= Vec3{pull[3], pull[4], pull[5]};
    }
}

void ClothSolver::follow_bodies() {
    for (const LineHold& hold : line_holds_) {
        const std::size_t first = line_first_[hold.line];
        const BodyMove& move = body_z_[hold.body];
        for (std::size_t c = 0; c < 6; ++c) {
            const double by = c < 3 ? move.shift[static_cast<int>(c)] : move.turn[static_cast<int>(c) - 3];
            for (std::size_t i = 0; i < hold.column[c].size(); ++i) {
                line_z_[first + i] -= by * hold.given[c][i];
                line_az_[first + i] -= by * hold.column[c][i];
            }
        }
    }
}

}  // namespace embody::physics::deformable
