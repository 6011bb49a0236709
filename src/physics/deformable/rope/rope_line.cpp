// SPDX-License-Identifier: MIT
//
// Bending by the turn of the direction from segment to segment, ½ EI/l |t₁ - t₀|² with l the mean length of the two:
// 2 sin(φ/2) instead of the 2 tan(φ/2) of M. Bergou, M. Wardetzky, S. Robinson, B. Audoly and E. Grinspun, "Discrete
// elastic rods" (2008), eq. 1: the same for small turns, and finite where a rope is folded back on itself. Its second
// derivative is taken as that of the turn squared, which is never negative.
#include "physics/deformable/rope/rope_line.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/deformable/contact/free_motion.h"

namespace embody::physics::deformable {

namespace {

constexpr double pi = 3.14159265358979323846;  // turns of Euler's load

}  // namespace

RopeLine::RopeLine(const DeformableDefinition& definition)
    : rope_(std::get<Rope>(definition.matter)), folds_(definition.nodes.size(), rope_.bend_rigidity, rope_.bend_yield) {
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
    springs_.material = definition.material;
    springs_.attachments = definition.attachments;
    clamps_.set(definition.clamps);
}

RopeLine::Bend RopeLine::bend_at(std::size_t node, std::span<const Vec3> positions) const {
    Bend bend;
    if (segments_[node - 1].is_broken || segments_[node].is_broken || clamps_.holds(node)) return bend;
    const Vec3 e0 = positions[node] - positions[node - 1], e1 = positions[node + 1] - positions[node];
    const SegmentDirection before = direction_of(e0, segments_[node - 1].length);
    const SegmentDirection after = direction_of(e1, segments_[node].length);
    bend.is_whole = true;
    bend.stiffness = rope_.bend_rigidity / ((segments_[node - 1].length + segments_[node].length) / 2);
    bend.turn = after.displacement - before.displacement;
    bend.by_node = {before.by_end, -1.0 * (before.by_end + after.by_end), after.by_end};
    return bend;
}

// EA times the strain; compressed beyond Euler's load π² EI / l² of a piece that long, it buckles between its nodes and
// pushes with that load.
RopeLine::Tension RopeLine::tension_at(std::size_t segment, double now) const {
    const double rest = segments_[segment].length, slope = rope_.axial_stiffness / rest, longer = now - rest;
    const double buckling = pi * pi * rope_.bend_rigidity / (rest * rest);
    if (slope * longer >= -buckling) return {slope * longer, slope, slope / 2 * longer * longer};
    const double until = -buckling / slope;
    return {-buckling, 0, slope / 2 * until * until - buckling * (longer - until)};
}

// With the damping of the change of its length in the substep.
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
    constexpr double min_length = 1e-12;  // m: keeps the quotient finite
    if (segments_[segment].is_broken) return;
    const std::size_t a = segment, b = segment + 1;
    const Vec3 edge = places_[b] - places_[a];
    const double now = length(edge);
    const Tension tension = damped_tension_at(segment, now, h);
    const Vec3 displacement = normalized(edge, {1, 0, 0});
    // (EA/l₀) t tᵀ + (T/l)(1 - t tᵀ); for a compressed segment, which buckles, the second term is left out. T is what
    // the last iteration predicted, not that of its nodes' places: these have moved by d across, which lengthens the
    // segment by d²/2l.
    const double across = std::max(pulls_[segment], 0.0) / std::max(now, min_length);
    const Mat3 stiffness = (tension.slope - across) * outer(displacement, displacement) + across * Mat3::identity();
    system_.band.add(a, a, stiffness);
    system_.band.add(b, b, stiffness);
    system_.band.add(b, a, -1.0 * stiffness);
    const Vec3 force = tension.force * displacement + stiffness * (moves_[a] - moves_[b]);
    system_.rhs[a] += force;
    system_.rhs[b] -= force;
}

void RopeLine::add_curvature(std::size_t node) {
    const Bend bend = bend_at(node, places_);
    if (!bend.is_whole) return;
    const Bend& start = bends_[node];
    Vec3 moved;
    for (std::size_t k = 0; k < 3; ++k) moved += bend.by_node[k] * moves_[node - 1 + k];
    for (std::size_t r = 0; r < 3; ++r) {
        const Mat3 turned = transpose(bend.by_node[r]), damped = transpose(start.by_node[r]) * start.damping;
        system_.rhs[node - 1 + r] += bend.stiffness * (turned * (moved - bend.turn));
        for (std::size_t c = 0; c <= r; ++c) {
            system_.band.add(node - 1 + r, node - 1 + c,
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
    if (folds_.is_active()) folds_.begin(corners(nodes_.position, start_frames()), rope_.rayleigh_damping / h);
    for (std::size_t i = 1; i + 1 < count && !folds_.is_active(); ++i) {
        Bend& bend = bends_[i] = bend_at(i, nodes_.position);
        bend.damping = damping_of_growth(bend.turn, bend.stiffness * rope_.rayleigh_damping / h);
    }
    pulls_ = tensions_;
}

double RopeLine::energy(const Substep& substep, std::span<const Vec3> moves) const {
    return energy_without_folds(substep, moves) + fold_energy(moves, {});
}

double RopeLine::energy_without_folds(const Substep& substep, std::span<const Vec3> moves) const {
    const double h = substep.h;
    std::vector<Vec3> at(moves.size());
    double sum = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        at[i] = nodes_.position[i] + moves[i];
        if (fixed_[i]) continue;
        const Vec3 away = moves[i] - h * nodes_.mean_velocity[i] - h * h * substep.gravity;
        sum += nodes_.mass[i] / (2 * h * h) * length_squared(away) - dot(nodes_.force_on(i), moves[i]);
        if (!nodes_.flow.empty()) sum += flow_energy(nodes_.flow[i], moves[i], substep);
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
    return sum;
}

double RopeLine::merit_pressed(const Substep& substep, std::span<const BodyInertia> inertias) const {
    return merit(substep, inertias, moves_, body_moves_, energy_pressed);
}

double RopeLine::merit(const Substep& substep, std::span<const BodyInertia> inertias, std::span<const Vec3> moves,
                       std::span<const BodyMove> body_moves, SpringEnergy spring_energy) const {
    double sum = energy_without_folds(substep, moves) + fold_energy(moves, body_moves);
    for (std::size_t b = 0; b < inertias.size(); ++b) sum += energy_of(inertias[b], body_moves[b]);
    for (const TouchSpring& spring : springs_.springs()) sum += spring_energy(spring, moves, body_moves);
    for (const TouchSpring& spring : held_) sum += energy_of(spring, moves, body_moves);
    for (const TouchSpring& spring : supports_.springs()) sum += energy_of(spring, moves, body_moves);
    if (!clamps_.holds_any()) return sum;
    std::vector<Vec3> at(moves.size());
    for (std::size_t i = 0; i < moves.size(); ++i) at[i] = nodes_.position[i] + moves[i];
    return sum + clamps_.energy(at, body_moves);
}

void RopeLine::predict(const Substep& substep, std::span<const Vec3> from, std::span<const Vec3> to) {
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        const Vec3 edge = places_[s + 1] - places_[s], moved = to[s + 1] - from[s + 1] - to[s] + from[s];
        pulls_[s] = damped_tension_at(s, length(edge) + dot(normalized(edge, {1, 0, 0}), moved), substep.h).force;
    }
}

// Line search from the moves towards those that the iteration found.
bool RopeLine::take_step(const Substep& substep, std::span<const BodyInertia> inertias) {
    const std::vector<Vec3> from = moves_, full = next_moves_;
    const std::vector<BodyMove> body_from = body_moves_, body_full = next_body_moves_;
    const double before = merit(substep, inertias, from, body_from);
    constexpr double rounding = 1e-9;  // of the energy: sums of thousands of terms round by less
    for (double fraction = 1; fraction > substep.settings.rope.min_step_fraction; fraction /= 2) {
        for (std::size_t i = 0; i < from.size(); ++i) moves_[i] = from[i] + fraction * (full[i] - from[i]);
        for (std::size_t b = 0; b < body_from.size(); ++b) {
            body_moves_[b].shift = body_from[b].shift + fraction * (body_full[b].shift - body_from[b].shift);
            body_moves_[b].turn = body_from[b].turn + fraction * (body_full[b].turn - body_from[b].turn);
        }
        const double after = merit(substep, inertias, moves_, body_moves_);
        if (!std::isfinite(after)) continue;
        if (after <= before + rounding * std::fabs(before)) {
            predict(substep, from, moves_);
            return true;
        }
    }
    return std::isfinite(before);
}

void RopeLine::assemble(const Substep& substep, bool with_curvature) {
    const double h = substep.h;
    const std::size_t count = nodes_.size();
    system_.reset(count);
    places_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        places_[i] = nodes_.position[i] + moves_[i];
        system_.band.add_diagonal(i, nodes_.mass[i] / (h * h));
        system_.rhs[i] = nodes_.mass[i] * (nodes_.mean_velocity[i] / h + substep.gravity) + nodes_.force_on(i);
        if (nodes_.flow.empty()) continue;
        const NodeFlow& flow = nodes_.flow[i];
        system_.band.add(i, i, Mat3::diagonal(flow.drag / h));
        system_.rhs[i] += flow.force({}, substep.time + h);
    }
    for (std::size_t s = 0; s < segments_.size(); ++s) add_stretch(s, h);
    for (std::size_t i = 1; i + 1 < count && !folds_.is_active(); ++i) add_curvature(i);
    if (clamps_.holds_any()) clamps_.add(places_, moves_, body_moves_, with_curvature, system_);
    if (folds_.is_active())
        system_.add(folds_.rows(corners(places_, end_frames(body_moves_)), substep.settings.rope.fold_limit), moves_,
                    body_moves_);
}

// One linear solve with springs, touched bodies and twists. Where the moments exceed what the bent rope bears, without
// their sideways stiffness: only the forces have it.
bool RopeLine::solve_iteration(const Substep& substep, std::span<const BodyInertia> inertias) {
    next_body_moves_ = body_moves_;
    std::vector<TouchSpring> all = all_springs();
    all.insert(all.end(), held_.begin(), held_.end());
    const auto solve = [&] { return system_.solve(all, inertias, fixed_, next_moves_, next_body_moves_, moments_); };
    if (!solve()) {
        if (!clamps_.has_twist()) return false;
        assemble(substep, false);
        if (!solve()) return false;
    }
    clamps_.predict(moments_);
    return true;
}

bool RopeLine::solve_moves(const Substep& substep, std::span<const TouchedBody> bodies) {
    const int max_iterations = substep.settings.rope.max_iterations;
    const double move_tolerance = substep.settings.rope.move_tolerance * segments_[0].length;  // m
    const std::vector<BodyInertia> inertias = inertias_of(bodies, substep.h);
    TouchSprings chosen = springs_;
    chosen.choose(moves_, body_moves_, true);
    SupportSprings chosen_supports = supports_;
    chosen_supports.choose(body_moves_, true, springs_.tolerance);
    // Starts from rest or from inertia, whichever is closer to the solution: a start with no more energy than rest
    // gains none.
    const std::vector<Vec3> rest(moves_.size());
    if (merit(substep, inertias, rest, body_moves_) < merit(substep, inertias, moves_, body_moves_)) {
        moves_ = rest;
        assemble(substep);
    }
    if (folds_.is_active()) {
        const std::vector<Vec3> turned = unstretched_moves(substep.h);
        if (merit(substep, inertias, turned, body_moves_) < merit(substep, inertias, moves_, body_moves_)) {
            moves_ = turned;
            assemble(substep);
        }
    }
    // Of iterations that do not converge, the moves with the smallest residual.
    std::vector<Vec3> best_moves = moves_;
    std::vector<BodyMove> best_body_moves = body_moves_;
    double least = merit_pressed(substep, inertias);
    for (iterations_ = 1;; ++iterations_) {
        springs_ = chosen;
        supports_ = chosen_supports;
        if (iterations_ > 1) assemble(substep);
        if (!solve_iteration(substep, inertias)) return false;
        const std::vector<Vec3> before = moves_;
        if (!take_step(substep, inertias)) return false;
        double change = 0;
        for (std::size_t i = 0; i < moves_.size(); ++i) {
            if (!is_finite(moves_[i])) return false;
            change = std::max(change, length(moves_[i] - before[i]));
        }
        bool has_changed = chosen.choose(moves_, body_moves_, false);
        has_changed |= chosen_supports.choose(body_moves_, false, springs_.tolerance);
        if (!has_changed && change < move_tolerance) return true;
        if (const double left = merit_pressed(substep, inertias); left < least) {
            least = left;
            best_moves = moves_;
            best_body_moves = body_moves_;
        } else if (iterations_ == max_iterations) {
            moves_ = best_moves;
            body_moves_ = best_body_moves;
            springs_.choose(moves_, body_moves_, false);
            supports_.choose(body_moves_, false, springs_.tolerance);
        }
        if (iterations_ == max_iterations) return true;
    }
}

// At most one segment breaks a substep: that changes the load of the others.
void RopeLine::break_segments() {
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

void RopeLine::go_on_from(const RopeLine& other) {
    for (std::size_t s = 0; s < segments_.size(); ++s) segments_[s].is_broken = other.is_broken(s);
    const std::vector<Clamp> own = clamps_.clamps();
    clamps_ = other.clamps_;
    clamps_.set(own);
    nodes_.substep = other.nodes_.substep;
    springs_.go_on_from(other.springs_);
    folds_.go_on_from(other.folds_);
}

void RopeLine::begin(const Substep& substep, std::span<const NodeContact> contacts,
                     std::span<const SegmentContact> segment_contacts, std::span<const std::uint32_t> attachment_bodies,
                     std::span<const TouchedBody> bodies) {
    const std::size_t count = nodes_.size();
    springs_.tolerance = substep.settings.rope.change_tolerance;
    springs_.attachment_bodies.assign(attachment_bodies.begin(), attachment_bodies.end());
    clamps_.begin({rope_, segments_, nodes_, fixed_, springs_, bodies, substep});
    begin_substep(substep.h);
    body_moves_.assign(bodies.size(), {});
    assemble(substep);
    node_stiffness_.resize(count);
    springs_.directed_stiffness.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        node_stiffness_[i] = system_.band.diagonal_mean(i);
        springs_.directed_stiffness[i] = system_.band.diagonal_block(i);
    }
    springs_.begin(nodes_, contacts, bodies, substep, node_stiffness_);
    for (const SegmentContact& contact : segment_contacts)
        springs_.add(nodes_, contact, bodies, substep, node_stiffness_);
}

LineSystem RopeLine::linearize(const Substep& substep, std::span<const Vec3> moves) {
    moves_.assign(moves.begin(), moves.end());
    assemble(substep, false);  // without terms that may not be positive
    // Twists by the moments of the rope's last solve alone.
    for (std::size_t k = 0; k < system_.twists.size() && moments_.size() == system_.twists.size(); ++k) {
        for (std::size_t i = 0; i < system_.rhs.size(); ++i)
            system_.rhs[i] -= moments_[k] * system_.twists[k].by_node[i];
    }
    // Folds too: what turns about the rope itself is no unknown here.
    if (folds_.is_active()) {
        const auto rows = folds_.rows(corners(places_, end_frames(body_moves_)), substep.settings.rope.fold_limit);
        FoldGradient twisting(nodes_.size(), 0);
        twisting.add_links(rows);
        for (std::size_t i = 0; i < system_.rhs.size(); ++i) system_.rhs[i] -= twisting.by_node[i];
    }
    const double least = std::max(length(substep.gravity), substep.settings.thin_contact.min_gravity);  // m/s²
    small_load_.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) small_load_[i] = {0, nodes_.mass[i] * least, 0};
    return {&system_.band, system_.rhs, small_load_, &fixed_};
}

// Twists and folds about the rope are among its forces already.
bool RopeLine::solve_linear(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                            std::vector<Vec3>& moves, std::vector<BodyMove>& body_moves) {
    std::vector<double> moments;
    system_.twists.clear();
    return system_.solve(springs, inertias, fixed_, moves, body_moves, moments);
}

void RopeLine::freeze() {
    is_frozen_ = true;
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.mean_velocity[i] = nodes_.velocity[i] = {};
}

void RopeLine::advance(const Substep& substep, std::span<const NodeContact> contacts,
                       std::span<const SegmentContact> segment_contacts,
                       std::span<const std::uint32_t> attachment_bodies, std::span<TouchedBody> bodies,
                       std::span<const TouchSpring> held) {
    new_breaks_.clear();
    if (is_frozen_) return;
    held_.assign(held.begin(), held.end());
    begin(substep, contacts, segment_contacts, attachment_bodies, bodies);
    // With a clamp it is solved after those of its group, whose solve has had the supports.
    supports_ = {};
    if (!clamps_.holds_any()) begin_supports(substep, bodies);
    if (!solve_moves(substep, bodies)) return freeze();
    std::vector<double> fractions;
    if (!clamps_.holds_any())
        fractions = fractions_of(all_springs(), moves_, body_moves_, inertias_of(bodies, substep.h), substep);
    const FreePart part{&nodes_, take_impulses(substep, moves_), moves_};
    if (is_free()) keep_momenta(std::span(&part, 1), substep.h, substep.settings.thin_contact);
    finish(substep, moves_, body_moves_, bodies, fractions);
    supports_.finish(body_moves_, substep.h, bodies, fractions);
    move_nodes(moves_, substep.h);
}

// What a body bears may be other bodies by the rope: a drum the weights on both sides.
void RopeLine::begin_supports(const Substep& substep, std::span<const TouchedBody> bodies) {
    std::vector<std::uint32_t> pulled;
    for (const TouchSpring& spring : springs_.springs())
        if (spring.body != no_body && bodies[spring.body].inverse_mass > 0) pulled.push_back(spring.body);
    std::ranges::sort(pulled);
    pulled.erase(std::unique(pulled.begin(), pulled.end()), pulled.end());
    double mass = std::accumulate(nodes_.mass.begin(), nodes_.mass.end(), 0.0);
    for (const std::uint32_t body : pulled) mass += 1 / bodies[body].inverse_mass;
    supports_.begin(springs_.springs(), bodies, mass, substep);
}

// Of contacts, attachments and supports.
std::vector<TouchSpring> RopeLine::all_springs() const {
    std::vector<TouchSpring> all(springs_.springs().begin(), springs_.springs().end());
    all.insert(all.end(), supports_.springs().begin(), supports_.springs().end());
    return all;
}

bool RopeLine::is_free() const {
    return !is_frozen_ && std::ranges::find(fixed_, true) == fixed_.end() && held_.empty() && !springs_.any_acts() &&
           std::ranges::none_of(segments_, &RopeSegment::is_broken);
}

std::vector<Vec3> RopeLine::take_impulses(const Substep& substep, std::span<const Vec3> moves) {
    const std::vector<Vec3> by_flow = impulses_of_flow(nodes_, moves, substep);
    std::vector<Vec3> all(nodes_.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = substep.h * (nodes_.mass[i] * substep.gravity + nodes_.force_on(i));
    for (std::size_t i = 0; i < by_flow.size(); ++i) {
        nodes_.flow_impulse[i] += by_flow[i];
        all[i] += by_flow[i];
    }
    return all;
}

void RopeLine::finish(const Substep& substep, std::span<Vec3> moves, std::span<const BodyMove> body_moves,
                      std::span<TouchedBody> bodies, std::span<const double> fractions) {
    new_breaks_.clear();
    if (is_frozen_) return;
    held_.clear();
    springs_.finish(moves, body_moves, substep, bodies, fractions);
    if (!clamps_.holds_any()) return;
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = nodes_.position[i] + moves[i];
    if (folds_.is_active()) push_by_folds(substep, body_moves, bodies);
    clamps_.finish(places_, body_moves, substep.h, bodies);
}

void RopeLine::move_nodes(std::span<const Vec3> moves, double h) {
    if (is_frozen_) return;
    set_velocities(nodes_, moves, h);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += moves[i];
    if (folds_.is_active()) folds_.keep(corners(nodes_.position, end_frames(body_moves_)));
    break_segments();
}

double RopeLine::elastic_energy() const {
    double energy = 0;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        if (segments_[s].is_broken) continue;
        energy += tension_at(s, length(nodes_.position[s + 1] - nodes_.position[s])).energy;
    }
    for (std::size_t i = 1; i + 1 < nodes_.size() && !folds_.is_active(); ++i) {
        const Bend bend = bend_at(i, nodes_.position);
        energy += bend.stiffness / 2 * length_squared(bend.turn);
    }
    if (folds_.is_active()) energy += folds_.elastic_energy(corners(nodes_.position, end_frames(body_moves_)));
    return energy + clamps_.elastic_energy();
}

}  // namespace embody::physics::deformable
