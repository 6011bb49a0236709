// SPDX-License-Identifier: MIT
//
// M. Bergou, M. Wardetzky, S. Robinson, B. Audoly, E. Grinspun, "Discrete elastic rods" (2008), for a round rod whose
// twist is even along it at all times: a frame is carried along the line by the smallest turn from each direction to
// the next, and the twist θ is the angle by which the second clamp is turned against the frame that arrives there.
//
//   a, b: directions before and after a corner, κ = 2 a × b / (1 + a·b): its curvature (their eq. 1),
//   δθ = ½ Σ κ·(δa + δb) + e₂·ω₂ - e₁·ω₁ with the clamps' directions e and turns ω (their eq. 9, by directions).
#include "physics/deformable/rope/rope_clamps.h"

#include <algorithm>
#include <cmath>

#include "math/arc_tangent.h"
#include "math/quat.h"
#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::deformable {

namespace {

constexpr double turn_around = 2 * 3.14159265358979323846;  // 2 π
constexpr std::uint32_t other_holder = 0xFFFFFFFEu;         // the slot of no body: the angle alone is known

double one_plus_cosine(Vec3 a, Vec3 b, double least) { return std::max(1 + dot(a, b), least); }

double nearest_turn(double angle, double to) { return angle + turn_around * std::round((to - angle) / turn_around); }

Mat3 symmetric(const Mat3& m) { return 0.5 * (m + transpose(m)); }

}  // namespace

void RopeClamps::set(const std::vector<Clamp>& clamps) {
    std::vector<Clamp> sorted = clamps;
    std::ranges::sort(sorted, {}, &Clamp::node);
    if (sorted == clamps_) return;
    const auto is_clamped = [&](std::uint32_t node) {
        return std::ranges::find(sorted, node, &Clamp::node) != sorted.end();
    };
    const auto stays = [&](std::uint32_t node) {
        const auto before = std::ranges::find(clamps_, node, &Clamp::node);
        return before != clamps_.end() && *before == *std::ranges::find(sorted, node, &Clamp::node);
    };
    std::erase_if(memory_, [&](const Memory& m) { return !is_clamped(m.from) || !is_clamped(m.to); });
    for (Memory& memory : memory_) {
        if (!stays(memory.from) || !stays(memory.to)) memory.from_slot = other_holder;
    }
    clamps_ = std::move(sorted);
    held_.clear();
    bends_.clear();
    spans_.clear();
    twists_.clear();
    elastic_energy_ = 0;
}

bool RopeClamps::holds(std::size_t node) const {
    return std::ranges::any_of(held_, [node](const Held& held) { return held.clamp.node == node; });
}

std::optional<RopeClamps::Frame> RopeClamps::frame_at(std::size_t node, std::span<const BodyMove> body_moves) const {
    const auto held = std::ranges::find(held_, node, [](const Held& h) { return h.clamp.node; });
    if (held == held_.end()) return {};
    return frame_of(*held, body_moves);
}

std::optional<RopeClamps::Frame> RopeClamps::start_frame_at(std::size_t node) const {
    const auto held = std::ranges::find(held_, node, [](const Held& h) { return h.clamp.node; });
    return held == held_.end() ? std::nullopt : std::optional(held->start);
}

std::uint32_t RopeClamps::body_at(std::size_t node) const {
    const auto held = std::ranges::find(held_, node, [](const Held& h) { return h.clamp.node; });
    return held == held_.end() ? no_body : held->body;
}

RopeClamps::Frame RopeClamps::frame_of(const Held& held, std::span<const BodyMove> body_moves) const {
    if (held.body == no_body || body_moves.empty()) return {held.axis, held.side};
    const Quat turn = cayley(body_moves[held.body].turn);
    return {rotate(turn, held.axis), rotate(turn, held.side)};
}

// Turned by the world or by a body that the node is attached to.
void RopeClamps::find_held(const Start& start, std::vector<Frame>& at_start) {
    const double begin = start.substep.time, end = begin + start.substep.h;
    held_.clear();
    for (const Clamp& clamp : clamps_) {
        Held held{clamp, no_body, no_body, clamp.direction, any_perpendicular(clamp.direction), {}};
        Frame before{held.axis, held.side};
        if (!start.fixed[clamp.node]) {
            const auto& attachments = start.springs.attachments;
            const auto at = std::ranges::find(attachments, clamp.node, &Attachment::node);
            if (at == attachments.end()) continue;
            held.body = start.springs.attachment_bodies[static_cast<std::size_t>(at - attachments.begin())];
            if (held.body == no_body) continue;
            const TouchedBody& body = start.bodies[held.body];
            held.slot = body.body;
            const Vec3 axis = rotate(body.start.rotation, held.axis), side = rotate(body.start.rotation, held.side);
            const Mat3 now = body.rotation_at(begin), then = body.rotation_at(end);
            before = {now * axis, now * side};
            held.axis = then * axis;
            held.side = then * side;
        }
        held.start = before;
        held_.push_back(held);
        at_start.push_back(before);
    }
}

void RopeClamps::find_bends(const Start& start, std::span<const Frame> at_start) {
    bends_.clear();
    if (std::isfinite(start.rope.bend_yield)) return;  // of a wire: RopeFolds
    for (std::size_t i = 0; i < held_.size(); ++i) {
        const std::size_t node = held_[i].clamp.node;
        for (const std::size_t next : {node, node + 1}) {
            if (next == 0 || next > start.segments.size() || start.segments[next - 1].is_broken) continue;
            const std::size_t s = next - 1;
            HalfBend bend{i, s, start.rope.bend_rigidity / (start.segments[s].length / 2)};
            const Vec3 edge = start.nodes.position[s + 1] - start.nodes.position[s];
            bend.start = direction_of(edge, start.segments[s].length).displacement - at_start[i].axis;
            bend.damping =
                damping_of_growth(bend.start, bend.stiffness * start.rope.rayleigh_damping / start.substep.h);
            bends_.push_back(bend);
        }
    }
}

void RopeClamps::find_spans(const Start& start, std::span<const Frame> at_start) {
    spans_.clear();
    for (std::size_t i = 1; i < held_.size(); ++i) {
        const Held &from = held_[i - 1], &to = held_[i];
        double along = 0;
        bool is_whole = true;
        for (std::size_t s = from.clamp.node; s < to.clamp.node; ++s) {
            along += start.segments[s].length;
            is_whole = is_whole && !start.segments[s].is_broken;
        }
        if (!is_whole) continue;
        Span span{i - 1, i, start.rope.twist_rigidity / along};
        span.damping = span.stiffness * start.rope.rayleigh_damping / start.substep.h;
        const auto same = std::ranges::find_if(
            memory_, [&](const Memory& m) { return m.from == from.clamp.node && m.to == to.clamp.node; });
        if (same != memory_.end()) span.angle = same->angle;
        if (same != memory_.end() && same->from_slot == from.slot && same->to_slot == to.slot) {
            span.straight = same->straight;
        } else {
            // Held by others now, or by other axes: it keeps its present twist.
            span.straight =
                read_angle(from.clamp.node, to.clamp.node, at_start[i - 1], at_start[i], start.nodes.position) -
                span.angle;
        }
        span.moment = span.stiffness * span.angle;
        spans_.push_back(span);
    }
}

void RopeClamps::begin(const Start& start) {
    if (clamps_.empty()) return;
    fold_limit_ = start.substep.settings.rope.fold_limit;
    lengths_.clear();
    for (const RopeSegment& segment : start.segments) lengths_.push_back(segment.length);
    std::vector<Frame> at_start;
    find_held(start, at_start);
    find_bends(start, at_start);
    find_spans(start, at_start);
}

double RopeClamps::read_angle(std::size_t from_node, std::size_t to_node, const Frame& from, const Frame& to,
                              std::span<const Vec3> places) const {
    Vec3 displacement = from.axis, side = from.side;
    for (std::size_t s = from_node; s < to_node; ++s) {
        const Vec3 next = normalized(places[s + 1] - places[s], displacement);
        side = carried(side, displacement, next);
        displacement = next;
    }
    side = carried(side, displacement, to.axis);
    return arc_tangent(dot(cross(side, to.side), to.axis), dot(side, to.side));
}

// Nearest to the last value, so full turns count.
double RopeClamps::angle_of(const Span& span, std::span<const Vec3> places,
                            std::span<const BodyMove> body_moves) const {
    const Held &from = held_[span.from], &to = held_[span.to];
    const double read =
        read_angle(from.clamp.node, to.clamp.node, frame_of(from, body_moves), frame_of(to, body_moves), places);
    return nearest_turn(read - span.straight, span.angle);
}

Vec3 RopeClamps::turn_of(const HalfBend& bend, std::span<const Vec3> places,
                         std::span<const BodyMove> body_moves) const {
    const Vec3 edge = places[bend.segment + 1] - places[bend.segment];
    return direction_of(edge, lengths_[bend.segment]).displacement - frame_of(held_[bend.held], body_moves).axis;
}

RopeClamps::Bow RopeClamps::bow_of(const Span& span, std::span<const Vec3> places,
                                   std::span<const BodyMove> body_moves) const {
    const Held &from = held_[span.from], &to = held_[span.to];
    Bow bow;
    bow.directions.push_back({frame_of(from, body_moves).axis, Mat3::zero()});
    for (std::size_t s = from.clamp.node; s < to.clamp.node; ++s)
        bow.directions.push_back(direction_of(places[s + 1] - places[s], lengths_[s]));
    bow.directions.push_back({frame_of(to, body_moves).axis, Mat3::zero()});
    for (std::size_t i = 1; i < bow.directions.size(); ++i)
        bow.curvature.push_back(
            curvature_of(bow.directions[i - 1].displacement, bow.directions[i].displacement, fold_limit_));
    return bow;
}

TwistMode RopeClamps::mode_of(const Span& span, const Bow& bow) const {
    const Held &from = held_[span.from], &to = held_[span.to];
    TwistMode mode;
    mode.compliance = 1 / (span.stiffness + span.damping);
    mode.by_node.assign(lengths_.size() + 1, {});
    mode.body = {from.body, to.body};
    const std::size_t last = bow.directions.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        Vec3 by_direction;
        if (i > 0) by_direction += 0.5 * bow.curvature[i - 1];
        if (i < last) by_direction += 0.5 * bow.curvature[i];
        const Vec3 displacement = bow.directions[i].displacement;
        if (i == 0) {
            mode.by_turn[0] = cross(displacement, by_direction) - displacement;
        } else if (i == last) {
            mode.by_turn[1] = cross(displacement, by_direction) + displacement;
        } else {
            const Vec3 by_end = transpose(bow.directions[i].by_end) * by_direction;
            mode.by_node[from.clamp.node + i] += by_end;
            mode.by_node[from.clamp.node + i - 1] -= by_end;
        }
    }
    return mode;
}

// ½ m (k + damping) m with m = t - e: by the segment's nodes and by the turn of what holds e, δe = ω × e.
void RopeClamps::add_curvature(const HalfBend& bend, std::span<const Vec3> places, std::span<const Vec3> moves,
                               std::span<const BodyMove> body_moves, RopeSystem& system) const {
    const std::size_t s = bend.segment;
    const Held& held = held_[bend.held];
    const SegmentDirection direction = direction_of(places[s + 1] - places[s], lengths_[s]);
    const Vec3 axis = frame_of(held, body_moves).axis, turn = direction.displacement - axis;
    const Mat3 stiffness = bend.stiffness * Mat3::identity() + bend.damping;
    const Mat3 by_turn = skew(axis), by_end = direction.by_end;
    Vec3 moved = by_end * (moves[s + 1] - moves[s]);
    if (held.body != no_body) moved += by_turn * body_moves[held.body].turn;
    const Vec3 moment = bend.stiffness * turn + bend.damping * (turn - bend.start);
    const Vec3 missing = stiffness * moved - moment;
    const Mat3 by_both = transpose(by_end) * stiffness * by_end;
    system.rhs[s] -= transpose(by_end) * missing;
    system.rhs[s + 1] += transpose(by_end) * missing;
    system.band.add(s, s, by_both);
    system.band.add(s + 1, s + 1, by_both);
    system.band.add(s + 1, s, -1.0 * by_both);
    if (held.body == no_body) return;
    const Mat3 coupling = transpose(by_end) * stiffness * by_turn;
    system.couplings.push_back({held.body, static_cast<std::uint32_t>(s), -1.0 * coupling});
    system.couplings.push_back({held.body, static_cast<std::uint32_t>(s + 1), coupling});
    system.turns.push_back({held.body, transpose(by_turn) * stiffness * by_turn, transpose(by_turn) * missing});
}

// The moment times the second derivatives of the angle by the edges before and after each corner:
//   δ²θ = δa·(τ × δb) - ½ (κ·s)(τ·s) + …, τ = (a + b)/(1 + a·b), s = δa + δb, with δa, δb to second order in the edges.
void RopeClamps::add_curvature(const Span& span, const Bow& bow, std::span<const Vec3> moves,
                               RopeSystem& system) const {
    const std::size_t first = held_[span.from].clamp.node;
    for (std::size_t c = 0; c < bow.curvature.size(); ++c) {
        const SegmentDirection &a = bow.directions[c], &b = bow.directions[c + 1];
        const Vec3 bend = bow.curvature[c];
        const Vec3 middle =
            (a.displacement + b.displacement) / one_plus_cosine(a.displacement, b.displacement, fold_limit_);
        const Mat3 pair = symmetric(outer(bend, middle));
        // Edges that are directions of clamps do not move with nodes: their by_end is zero.
        const Mat3 own_a =
            a.by_end * pair * a.by_end + 2.0 * symmetric(outer(a.by_end * (a.by_end * bend), a.displacement));
        const Mat3 own_b =
            b.by_end * pair * b.by_end + 2.0 * symmetric(outer(b.by_end * (b.by_end * bend), b.displacement));
        const Mat3 mixed = a.by_end * (pair - skew(middle)) * b.by_end;
        const std::array<double, 3> by_a{-1, 1, 0}, by_b{0, -1, 1};
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Mat3 block =
                    (-0.5 * span.moment) * ((by_a[r] * by_a[k]) * own_a + (by_b[r] * by_b[k]) * own_b +
                                            (by_a[r] * by_b[k]) * mixed + (by_b[r] * by_a[k]) * transpose(mixed));
                if (block == Mat3::zero()) continue;
                const std::size_t row = first + c + r - 1, column = first + c + k - 1;
                system.rhs[row] += block * moves[column];
                if (row >= column) system.band.add(row, column, block);
            }
        }
    }
}

void RopeClamps::add(std::span<const Vec3> places, std::span<const Vec3> moves, std::span<const BodyMove> body_moves,
                     bool with_curvature, RopeSystem& system) const {
    for (const HalfBend& bend : bends_) add_curvature(bend, places, moves, body_moves, system);
    for (const Span& span : spans_) {
        const Bow bow = bow_of(span, places, body_moves);
        TwistMode mode = mode_of(span, bow);
        mode.offset = angle_of(span, places, body_moves) - span.damping * mode.compliance * span.angle;
        for (std::size_t i = 0; i < moves.size(); ++i) mode.offset -= dot(mode.by_node[i], moves[i]);
        for (std::size_t end = 0; end < 2; ++end) {
            if (mode.body[end] != no_body) mode.offset -= dot(mode.by_turn[end], body_moves[mode.body[end]].turn);
        }
        system.twists.push_back(std::move(mode));
        if (with_curvature && span.moment != 0) add_curvature(span, bow, moves, system);
    }
}

void RopeClamps::predict(std::span<const double> moments) {
    for (std::size_t i = 0; i < spans_.size(); ++i) spans_[i].moment = moments[i];
}

double RopeClamps::energy(std::span<const Vec3> places, std::span<const BodyMove> body_moves) const {
    double sum = 0;
    for (const HalfBend& bend : bends_) {
        const Vec3 turn = turn_of(bend, places, body_moves), grown = turn - bend.start;
        sum += bend.stiffness / 2 * length_squared(turn) + 0.5 * dot(grown, bend.damping * grown);
    }
    for (const Span& span : spans_) {
        const double angle = angle_of(span, places, body_moves), grown = angle - span.angle;
        sum += span.stiffness / 2 * angle * angle + span.damping / 2 * grown * grown;
    }
    return sum;
}

void RopeClamps::finish(std::span<const Vec3> places, std::span<const BodyMove> body_moves, double h,
                        std::span<TouchedBody> bodies) {
    elastic_energy_ = 0;
    memory_.clear();
    twists_.clear();
    std::vector<Vec3> torques(held_.size());
    for (const HalfBend& bend : bends_) {
        const Vec3 turn = turn_of(bend, places, body_moves);
        const Vec3 moment = bend.stiffness * turn + bend.damping * (turn - bend.start);
        torques[bend.held] += cross(frame_of(held_[bend.held], body_moves).axis, moment);
        elastic_energy_ += bend.stiffness / 2 * length_squared(turn);
    }
    for (const Span& span : spans_) {
        const TwistMode mode = mode_of(span, bow_of(span, places, body_moves));
        const double angle = angle_of(span, places, body_moves);
        const double moment = span.stiffness * angle + span.damping * (angle - span.angle);
        torques[span.from] -= moment * mode.by_turn[0];
        torques[span.to] -= moment * mode.by_turn[1];
        elastic_energy_ += span.stiffness / 2 * angle * angle;
        const Held &from = held_[span.from], &to = held_[span.to];
        memory_.push_back({from.clamp.node, to.clamp.node, from.slot, to.slot, span.straight, angle});
        twists_.push_back({from.clamp.node, to.clamp.node, angle, span.stiffness * angle});
    }
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (held_[i].body != no_body) bodies[held_[i].body].push_turn(h * torques[i], h);
    }
}

}  // namespace embody::physics::deformable
