// SPDX-License-Identifier: MIT
//
// Bending by the turn of the direction from segment to segment, ½ EI/l |t₁ - t₀|² with l the mean length of the two:
// 2 sin(φ/2) instead of the 2 tan(φ/2) of M. Bergou, M. Wardetzky, S. Robinson, B. Audoly and E. Grinspun, "Discrete
// elastic rods" (2008), eq. 1: the same for small turns, and finite where a rope is folded back on itself. Its second
// derivative is taken as that of the turn squared, which is never negative.
#include "physics/deformable/rope_line.h"

#include <algorithm>
#include <cmath>

#include "physics/deformable/free_motion.h"

namespace embody::physics {

namespace {

constexpr double pi = 3.14159265358979323846;

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

// The move of a point at `arm` when the body's unknown c (three of its place, three of its turn) goes by one.
Vec3 unit_move(std::size_t c, Vec3 arm) {
    Vec3 axis;
    axis[static_cast<int>(c % 3)] = 1;
    return c < 3 ? axis : cross(axis, arm);
}

}  // namespace

RopeLine::RopeLine(const DeformableDefinition& definition) : rope_(std::get<Rope>(definition.matter)) {
    const std::size_t count = definition.nodes.size();
    nodes_.mass.assign(count, 0);
    Vec3 center;
    double mass = 0;
    for (std::size_t i = 0; i < count; ++i) {
        nodes_.position.push_back(transform_point(definition.pose, definition.nodes[i]));
        if (i + 1 == count) break;
        segments_.push_back({(1 + rope_.slack) * length(definition.nodes[i + 1] - definition.nodes[i])});
        nodes_.mass[i] += rope_.linear_density * segments_[i].length / 2;
        nodes_.mass[i + 1] += rope_.linear_density * segments_[i].length / 2;
    }
    for (std::size_t i = 0; i < count; ++i) {
        center += nodes_.mass[i] * nodes_.position[i];
        mass += nodes_.mass[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
        nodes_.inverse_mass.push_back(1 / nodes_.mass[i]);
        nodes_.mean_velocity.push_back(definition.linear_velocity +
                                       cross(definition.angular_velocity, nodes_.position[i] - center / mass));
    }
    fixed_.assign(count, false);
    for (const std::uint32_t node : definition.pinned) {
        nodes_.inverse_mass[node] = 0;
        nodes_.mean_velocity[node] = {};
        fixed_[node] = true;
    }
    nodes_.velocity = nodes_.mean_velocity;
    tensions_.assign(segments_.size(), 0);
    springs_.radius = definition.contact_radius;
    springs_.friction = definition.friction;
    springs_.attachments = definition.attachments;
    springs_.tolerance = 0.005;  // along a drum the errors add up in the exponent
}

RopeLine::Bend RopeLine::bend_at(std::size_t node, std::span<const Vec3> positions) const {
    Bend bend;
    if (segments_[node - 1].is_broken || segments_[node].is_broken) return bend;
    const Vec3 e0 = positions[node] - positions[node - 1], e1 = positions[node + 1] - positions[node];
    const double l0 = std::max(length(e0), 0.01 * segments_[node - 1].length);
    const double l1 = std::max(length(e1), 0.01 * segments_[node].length);
    const Vec3 t0 = e0 / l0, t1 = e1 / l1;
    bend.is_whole = true;
    bend.stiffness = rope_.bend_rigidity / ((segments_[node - 1].length + segments_[node].length) / 2);
    bend.turn = t1 - t0;
    const Mat3 before = (1 / l0) * (Mat3::identity() - outer(t0, t0));
    const Mat3 after = (1 / l1) * (Mat3::identity() - outer(t1, t1));
    bend.by_node = {before, -1.0 * (before + after), after};
    return bend;
}

// EA times the strain; pressed harder than Euler's load π² EI / l² of a piece that long, it gives way sideways between
// its nodes, and pushes with that load.
RopeLine::Tension RopeLine::tension_at(std::size_t segment, double now) const {
    const double rest = segments_[segment].length, slope = rope_.axial_stiffness / rest, longer = now - rest;
    const double buckling = pi * pi * rope_.bend_rigidity / (rest * rest);
    if (slope * longer >= -buckling) return {slope * longer, slope, slope / 2 * longer * longer};
    const double until = -buckling / slope;
    return {-buckling, 0, slope / 2 * until * until - buckling * (longer - until)};
}

// With what resists the change of its length in the substep.
RopeLine::Tension RopeLine::damped_tension_at(std::size_t segment, double now, double h) const {
    Tension tension = tension_at(segment, now);
    const double damping = rope_.rayleigh_damping / h * rope_.axial_stiffness / segments_[segment].length;
    const double longer = now - start_lengths_[segment];
    tension.force += damping * longer;
    tension.slope += damping;
    tension.energy += damping / 2 * longer * longer;
    return tension;
}

void RopeLine::add_stretch(std::size_t segment, double h) {
    if (segments_[segment].is_broken) return;
    const std::size_t a = segment, b = segment + 1;
    const Vec3 edge = places_[b] - places_[a];
    const double now = length(edge);
    const Tension tension = damped_tension_at(segment, now, h);
    const Vec3 way = normalized(edge, {1, 0, 0});
    // (EA/l₀) t tᵀ + (T/l)(1 - t tᵀ); a pressed segment buckles, which is left to the forces. T is what the last round
    // foretold, not what its nodes' places say: those it has moved by d across, which lengthens the segment by d²/2l.
    const double across = std::max(pulls_[segment], 0.0) / std::max(now, 1e-12);
    const Mat3 stiffness = (tension.slope - across) * outer(way, way) + across * Mat3::identity();
    matrix_.add(a, a, stiffness);
    matrix_.add(b, b, stiffness);
    matrix_.add(b, a, -1.0 * stiffness);
    const Vec3 force = tension.force * way + stiffness * (moves_[a] - moves_[b]);
    rhs_[a] += force;
    rhs_[b] -= force;
}

void RopeLine::add_bend(std::size_t node) {
    const Bend bend = bend_at(node, places_);
    if (!bend.is_whole) return;
    const Bend& start = bends_[node];
    Vec3 moved;
    for (std::size_t k = 0; k < 3; ++k) moved += bend.by_node[k] * moves_[node - 1 + k];
    for (std::size_t r = 0; r < 3; ++r) {
        const Mat3 turned = transpose(bend.by_node[r]), damped = transpose(start.by_node[r]) * start.damping;
        rhs_[node - 1 + r] += bend.stiffness * (turned * (moved - bend.turn));
        for (std::size_t c = 0; c <= r; ++c) {
            matrix_.add(node - 1 + r, node - 1 + c,
                        bend.stiffness * (turned * bend.by_node[c]) + damped * start.by_node[c]);
        }
    }
}

void RopeLine::begin_substep(double h) {
    const std::size_t count = nodes_.size();
    moves_.resize(count);
    for (std::size_t i = 0; i < count; ++i) moves_[i] = h * nodes_.mean_velocity[i];
    start_lengths_.resize(segments_.size());
    for (std::size_t s = 0; s < segments_.size(); ++s)
        start_lengths_[s] = length(nodes_.position[s + 1] - nodes_.position[s]);
    bends_.assign(count, {});
    for (std::size_t i = 1; i + 1 < count; ++i) {
        Bend& bend = bends_[i] = bend_at(i, nodes_.position);
        // Damping sees how the curvature grows, not how it turns with the rope.
        const double size = length_squared(bend.turn), turning = size / (size + 1e-4);
        const Vec3 axis = normalized(bend.turn);
        bend.damping = (bend.stiffness * rope_.rayleigh_damping / h) *
                       ((1 - turning) * Mat3::identity() + turning * outer(axis, axis));
    }
    pulls_ = tensions_;
}

double RopeLine::merit(const Substep& substep, std::span<const BodyInertia> inertias, std::span<const Vec3> moves,
                       std::span<const BodyMove> body_moves) const {
    const double h = substep.h;
    std::vector<Vec3> at(moves.size());
    double sum = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        at[i] = nodes_.position[i] + moves[i];
        if (fixed_[i]) continue;
        const Vec3 away = moves[i] - h * nodes_.mean_velocity[i] - h * h * substep.gravity;
        sum += nodes_.mass[i] / (2 * h * h) * length_squared(away);
    }
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        if (segments_[s].is_broken) continue;
        sum += damped_tension_at(s, length(at[s + 1] - at[s]), h).energy;
    }
    for (std::size_t i = 1; i + 1 < moves.size(); ++i) {
        const Bend& known = bends_[i];
        if (!known.is_whole) continue;
        Vec3 rate;
        for (std::size_t k = 0; k < 3; ++k) rate += known.by_node[k] * moves[i - 1 + k];
        sum += known.stiffness / 2 * length_squared(bend_at(i, at).turn) + 0.5 * dot(rate, known.damping * rate);
    }
    for (std::size_t b = 0; b < inertias.size(); ++b) {
        if (!inertias[b].moves) continue;
        sum += inertias[b].mass / 2 * length_squared(body_moves[b].shift) +
               0.5 * dot(body_moves[b].turn, inertias[b].inertia * body_moves[b].turn);
    }
    for (const TouchSpring& spring : springs_.springs()) {
        if (!spring.acts) continue;
        const Vec3 s = spring.lead(moves, body_moves);
        sum += 0.5 * dot(s, spring.matrix * s) - dot(spring.load, s);
    }
    return sum;
}

// Goes from the moves towards those that the round found, as far as it pays.
bool RopeLine::take_step(const Substep& substep, std::span<const BodyInertia> inertias) {
    const std::vector<Vec3> from = moves_, full = next_moves_;
    const std::vector<BodyMove> body_from = body_moves_, body_full = next_body_moves_;
    const double before = merit(substep, inertias, from, body_from);
    for (double share = 1; share > 1e-3; share /= 2) {
        for (std::size_t i = 0; i < from.size(); ++i) moves_[i] = from[i] + share * (full[i] - from[i]);
        for (std::size_t b = 0; b < body_from.size(); ++b) {
            body_moves_[b].shift = body_from[b].shift + share * (body_full[b].shift - body_from[b].shift);
            body_moves_[b].turn = body_from[b].turn + share * (body_full[b].turn - body_from[b].turn);
        }
        const double after = merit(substep, inertias, moves_, body_moves_);
        if (!std::isfinite(after)) continue;
        if (after <= before + 1e-9 * std::fabs(before)) {
            for (std::size_t s = 0; s < segments_.size(); ++s) {
                const Vec3 edge = places_[s + 1] - places_[s];
                const Vec3 moved = moves_[s + 1] - from[s + 1] - moves_[s] + from[s];
                pulls_[s] =
                    damped_tension_at(s, length(edge) + dot(normalized(edge, {1, 0, 0}), moved), substep.h).force;
            }
            return true;
        }
    }
    return std::isfinite(before);
}

void RopeLine::assemble(const Substep& substep) {
    const double h = substep.h;
    const std::size_t count = nodes_.size();
    matrix_.reset(count);
    rhs_.resize(count);
    places_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        places_[i] = nodes_.position[i] + moves_[i];
        matrix_.add_diagonal(i, nodes_.mass[i] / (h * h));
        rhs_[i] = nodes_.mass[i] * (nodes_.mean_velocity[i] / h + substep.gravity);
    }
    for (std::size_t s = 0; s < segments_.size(); ++s) add_stretch(s, h);
    for (std::size_t i = 1; i + 1 < count; ++i) add_bend(i);
}

// One linear solve with springs and touched bodies: the band first, then the bodies by what it gives way to them.
bool RopeLine::solve_round(std::span<const BodyInertia> inertias) {
    std::vector<Vec3>& next = next_moves_;
    next_body_moves_ = body_moves_;
    std::vector<std::size_t> place(inertias.size(), 0);
    std::vector<std::uint32_t> moving;
    for (const TouchSpring& spring : springs_.springs()) {
        if (!spring.acts) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
            rhs_[spring.node[a]] += spring.weight[a] * spring.load;
            for (std::size_t b = 0; b <= a; ++b)
                matrix_.add(spring.node[a], spring.node[b], (spring.weight[a] * spring.weight[b]) * spring.matrix);
        }
        if (spring.body == no_body || !inertias[spring.body].moves || place[spring.body] != 0) continue;
        moving.push_back(spring.body);
        place[spring.body] = moving.size();
    }
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        if (!fixed_[i]) continue;
        matrix_.fix(i);
        rhs_[i] = {};
    }
    if (!matrix_.factorize()) return false;
    next = rhs_;
    matrix_.solve(next);
    if (moving.empty()) return true;

    // Columns of the springs between nodes and bodies, and what the band makes of them.
    const std::size_t n = 6 * moving.size();
    std::vector<std::vector<Vec3>> columns(n, std::vector<Vec3>(nodes_.size()));
    std::vector<double> system(n * n, 0), load(n, 0);
    for (std::size_t m = 0; m < moving.size(); ++m) {
        const BodyInertia& inertia = inertias[moving[m]];
        for (std::size_t r = 0; r < 3; ++r) {
            system[(6 * m + r) * n + 6 * m + r] = inertia.mass;
            for (std::size_t c = 0; c < 3; ++c)
                system[(6 * m + r + 3) * n + 6 * m + c + 3] = inertia.inertia(static_cast<int>(r), static_cast<int>(c));
        }
    }
    for (const TouchSpring& spring : springs_.springs()) {
        if (!spring.acts || spring.body == no_body || !inertias[spring.body].moves) continue;
        const std::size_t first = 6 * (place[spring.body] - 1);
        for (std::size_t c = 0; c < 6; ++c) {
            const Vec3 force = spring.matrix * unit_move(c, spring.arm);
            for (std::size_t a = 0; a < static_cast<std::size_t>(spring.count); ++a) {
                if (!fixed_[spring.node[a]]) columns[first + c][spring.node[a]] -= spring.weight[a] * force;
            }
            load[first + c] -= dot(unit_move(c, spring.arm), spring.load);
            for (std::size_t r = 0; r < 6; ++r)
                system[(first + r) * n + first + c] += dot(unit_move(r, spring.arm), force);
        }
    }
    const auto product = [&](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
        return sum;
    };
    std::vector<std::vector<Vec3>> given = columns;
    for (std::size_t c = 0; c < n; ++c) {
        matrix_.solve(given[c]);
        load[c] -= product(columns[c], next);
        for (std::size_t r = 0; r < n; ++r) system[r * n + c] -= product(columns[r], given[c]);
    }
    if (!factorize_dense(system, n)) return false;
    solve_dense(system, n, load);
    for (std::size_t c = 0; c < n; ++c) {
        for (std::size_t i = 0; i < next.size(); ++i) next[i] -= load[c] * given[c][i];
    }
    for (std::size_t m = 0; m < moving.size(); ++m) {
        const double* v = &load[6 * m];
        next_body_moves_[moving[m]] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }
    return true;
}

bool RopeLine::solve_moves(const Substep& substep, std::span<const TouchedBody> bodies) {
    constexpr int most_rounds = 12;
    constexpr double small = 1e-4;  // of a segment's length
    const std::vector<BodyInertia> inertias = inertias_of(bodies, substep.h);
    body_moves_.assign(bodies.size(), {});
    TouchSprings chosen = springs_;
    chosen.choose(moves_, body_moves_, true);
    // From rest or from inertia, whichever is nearer to the end: what begins no higher than rest gains no energy.
    const std::vector<Vec3> rest(moves_.size());
    if (merit(substep, inertias, rest, body_moves_) < merit(substep, inertias, moves_, body_moves_)) {
        moves_ = rest;
        assemble(substep);
    }
    for (rounds_ = 1;; ++rounds_) {
        springs_ = chosen;
        if (rounds_ > 1) assemble(substep);
        if (!solve_round(inertias)) return false;
        const std::vector<Vec3> before = moves_;
        if (!take_step(substep, inertias)) return false;
        double change = 0;
        for (std::size_t i = 0; i < moves_.size(); ++i) {
            if (!is_finite(moves_[i])) return false;
            change = std::max(change, length(moves_[i] - before[i]));
        }
        const bool has_changed = chosen.choose(moves_, body_moves_, false);
        if (rounds_ == most_rounds || (!has_changed && change < small * segments_[0].length)) return true;
    }
}

// At most one breaks a substep: what is left of the others' load goes with it.
void RopeLine::break_segments() {
    new_breaks_.clear();
    std::uint32_t tightest = 0;
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
        const double now = length(nodes_.position[s + 1] - nodes_.position[s]);
        tensions_[s] = segments_[s].is_broken ? 0 : tension_at(s, now).force;
        if (tensions_[s] > tensions_[tightest]) tightest = s;
    }
    if (tensions_[tightest] <= rope_.break_tension) return;
    new_breaks_.push_back({tightest, tensions_[tightest]});
    segments_[tightest].is_broken = true;
    tensions_[tightest] = 0;
}

void RopeLine::break_as(const RopeLine& other) {
    for (std::size_t s = 0; s < segments_.size(); ++s) segments_[s].is_broken = other.is_broken(s);
}

void RopeLine::advance(const Substep& substep, std::span<const NodeContact> contacts,
                       std::span<const SegmentContact> segment_contacts,
                       std::span<const std::uint32_t> attachment_bodies, std::span<TouchedBody> bodies) {
    if (is_frozen_) return;
    const std::size_t count = nodes_.size();
    begin_substep(substep.h);
    assemble(substep);
    node_stiffness_.resize(count);
    for (std::size_t i = 0; i < count; ++i) node_stiffness_[i] = matrix_.diagonal_mean(i);
    springs_.attachment_bodies.assign(attachment_bodies.begin(), attachment_bodies.end());
    springs_.begin(nodes_, contacts, bodies, substep, node_stiffness_);
    for (const SegmentContact& contact : segment_contacts)
        springs_.add(nodes_, contact, bodies, substep, node_stiffness_);
    if (!solve_moves(substep, bodies)) {
        is_frozen_ = true;
        for (std::size_t i = 0; i < count; ++i) nodes_.mean_velocity[i] = nodes_.velocity[i] = {};
        return;
    }
    const auto acts = [](const TouchSpring& spring) { return spring.acts; };
    const bool is_whole = std::ranges::none_of(segments_, &Segment::is_broken);
    if (is_whole && std::ranges::find(fixed_, true) == fixed_.end() && std::ranges::none_of(springs_.springs(), acts)) {
        std::vector<Vec3> given(count);
        for (std::size_t i = 0; i < count; ++i) given[i] = substep.h * nodes_.mass[i] * substep.gravity;
        keep_momenta(nodes_, given, substep.h, moves_);
    }
    springs_.finish(moves_, body_moves_, substep, bodies);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 mean = moves_[i] / substep.h;
        nodes_.velocity[i] = mean + 0.5 * (mean - nodes_.mean_velocity[i]);
        nodes_.mean_velocity[i] = mean;
        nodes_.position[i] += moves_[i];
    }
    break_segments();
}

double RopeLine::elastic_energy() const {
    double energy = 0;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        if (segments_[s].is_broken) continue;
        energy += tension_at(s, length(nodes_.position[s + 1] - nodes_.position[s])).energy;
    }
    for (std::size_t i = 1; i + 1 < nodes_.size(); ++i) {
        const Bend bend = bend_at(i, nodes_.position);
        energy += bend.stiffness / 2 * length_squared(bend.turn);
    }
    return energy;
}

}  // namespace embody::physics
