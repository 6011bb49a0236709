// SPDX-License-Identifier: MIT
#include "physics/deformable/rope/rope_system.h"

#include <cmath>

namespace embody::physics::deformable {

namespace {

// Lower factor of a dense symmetric matrix, n × n by rows, in place; false where it is not positive definite.
bool factorize_dense(std::vector<double>& m, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = m[i * n + k];
            for (std::size_t j = 0; j < k; ++j) sum -= m[i * n + j] * m[k * n + j];
            if (i == k && !(sum > 0)) return false;
            m[i * n + k] = i == k ? std::sqrt(sum) : sum / m[k * n + k];
        }
    }
    return true;
}

void solve_dense(const std::vector<double>& factor, std::size_t n, std::vector<double>& v) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) v[i] -= factor[i * n + k] * v[k];
        v[i] /= factor[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) v[i] -= factor[k * n + i] * v[k];
        v[i] /= factor[i * n + i];
    }
}

double product(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
    return sum;
}

}  // namespace

void RopeSystem::reset(std::size_t nodes) {
    band.reset(nodes);
    rhs.resize(nodes);
    couplings.clear();
    turns.clear();
    twists.clear();
}

void RopeSystem::add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias) {
    place_.assign(inertias.size(), 0);
    moving_.clear();
    for (const TouchSpring& spring : springs) {
        if (!spring.acts) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
            rhs[spring.node[a]] += spring.weight[a] * spring.load;
            for (std::size_t b = 0; b <= a; ++b)
                band.add(spring.node[a], spring.node[b], (spring.weight[a] * spring.weight[b]) * spring.matrix);
        }
        if (spring.body == no_body || !inertias[spring.body].moves || place_[spring.body] != 0) continue;
        moving_.push_back(spring.body);
        place_[spring.body] = moving_.size();
    }
}

// Columns of the coupling of nodes and bodies, the band's solutions for them, and the bodies' own block.
void RopeSystem::make_border(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                             const std::vector<bool>& fixed, std::vector<double>& load) {
    const std::size_t n = 6 * moving_.size();
    columns_.assign(n, std::vector<Vec3>(rhs.size()));
    border_.assign(n * n, 0);
    load.assign(n, 0);
    for (std::size_t m = 0; m < moving_.size(); ++m) {
        const BodyInertia& inertia = inertias[moving_[m]];
        for (std::size_t r = 0; r < 3; ++r) {
            border_[(6 * m + r) * n + 6 * m + r] = inertia.mass;
            for (std::size_t c = 0; c < 3; ++c)
                border_[(6 * m + r + 3) * n + 6 * m + c + 3] =
                    inertia.inertia(static_cast<int>(r), static_cast<int>(c));
        }
    }
    for (const TouchSpring& spring : springs) {
        if (!spring.acts || !moves(spring.body)) continue;
        const std::size_t first = first_of(spring.body);
        for (std::size_t c = 0; c < 6; ++c) {
            const Vec3 force = spring.matrix * unit_move(c, spring.arm);
            for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
                if (!fixed[spring.node[a]]) columns_[first + c][spring.node[a]] -= spring.weight[a] * force;
            }
            load[first + c] -= dot(unit_move(c, spring.arm), spring.load);
            for (std::size_t r = 0; r < 6; ++r)
                border_[(first + r) * n + first + c] += dot(unit_move(r, spring.arm), force);
        }
    }
    for (const TurnCoupling& coupling : couplings) {
        if (!moves(coupling.body) || fixed[coupling.node]) continue;
        const std::size_t first = first_of(coupling.body) + 3;
        for (std::size_t c = 0; c < 3; ++c)
            columns_[first + c][coupling.node] += coupling.by_node_and_turn.column(static_cast<int>(c));
    }
    for (const TurnStiffness& turn : turns) {
        if (!moves(turn.body)) continue;
        const std::size_t first = first_of(turn.body) + 3;
        for (std::size_t r = 0; r < 3; ++r) {
            load[first + r] += turn.load[static_cast<int>(r)];
            for (std::size_t c = 0; c < 3; ++c)
                border_[(first + r) * n + first + c] += turn.stiffness(static_cast<int>(r), static_cast<int>(c));
        }
    }
}

bool RopeSystem::factorize_border() {
    const std::size_t n = columns_.size();
    given_ = columns_;
    for (std::size_t c = 0; c < n; ++c) {
        band.solve(given_[c]);
        for (std::size_t r = 0; r < n; ++r) border_[r * n + c] -= product(columns_[r], given_[c]);
    }
    return factorize_dense(border_, n);
}

void RopeSystem::solve_bordered(Unknowns& values) const {
    const std::size_t n = columns_.size();
    band.solve(values.nodes);
    for (std::size_t c = 0; c < n; ++c) values.bodies[c] -= product(columns_[c], values.nodes);
    solve_dense(border_, n, values.bodies);
    for (std::size_t c = 0; c < n; ++c) {
        for (std::size_t i = 0; i < values.nodes.size(); ++i) values.nodes[i] -= values.bodies[c] * given_[c][i];
    }
}

// With F for all but the twists, G of their derivatives by the unknowns and K of their stiffnesses:
//   F x + G y = b,  y = K (offset + Gᵀ x)  →  (K⁻¹ + Gᵀ F⁻¹ G) y = offset + Gᵀ F⁻¹ b,  x = F⁻¹ (b - G y).
bool RopeSystem::solve_twists(const std::vector<bool>& fixed, Unknowns& values, std::vector<double>& moments) const {
    const std::size_t n = twists.size();
    std::vector<Unknowns> derivatives, answers;
    for (const TwistMode& twist : twists) {
        Unknowns& by = derivatives.emplace_back(Unknowns{twist.by_node, std::vector<double>(columns_.size(), 0)});
        for (std::size_t i = 0; i < fixed.size(); ++i) {
            if (fixed[i]) by.nodes[i] = {};
        }
        for (std::size_t end = 0; end < 2; ++end) {
            if (!moves(twist.body[end])) continue;
            for (std::size_t c = 0; c < 3; ++c)
                by.bodies[first_of(twist.body[end]) + 3 + c] += twist.by_turn[end][static_cast<int>(c)];
        }
        answers.push_back(by);
        solve_bordered(answers.back());
    }
    const auto along = [](const Unknowns& by, const Unknowns& x) {
        double sum = product(by.nodes, x.nodes);
        for (std::size_t c = 0; c < by.bodies.size(); ++c) sum += by.bodies[c] * x.bodies[c];
        return sum;
    };
    std::vector<double> matrix(n * n, 0);
    for (std::size_t r = 0; r < n; ++r) {
        moments[r] = twists[r].offset + along(derivatives[r], values);
        for (std::size_t c = 0; c < n; ++c) matrix[r * n + c] = along(derivatives[r], answers[c]);
        matrix[r * n + r] += twists[r].compliance;
    }
    if (!factorize_dense(matrix, n)) return false;
    solve_dense(matrix, n, moments);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = 0; i < values.nodes.size(); ++i) values.nodes[i] -= moments[k] * answers[k].nodes[i];
        for (std::size_t c = 0; c < values.bodies.size(); ++c) values.bodies[c] -= moments[k] * answers[k].bodies[c];
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
    if (!band.factorize()) return false;
    Unknowns values{rhs, {}};
    make_border(springs, inertias, fixed, values.bodies);
    if (!factorize_border()) return false;
    solve_bordered(values);
    moments.assign(twists.size(), 0);
    if (!solve_twists(fixed, values, moments)) return false;
    node_moves = std::move(values.nodes);
    for (std::size_t m = 0; m < moving_.size(); ++m) {
        const double* v = &values.bodies[6 * m];
        body_moves[moving_[m]] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }
    return true;
}

}  // namespace embody::physics::deformable
