// SPDX-License-Identifier: MIT
//
// The part of RopeLine that keeps the bends of a wire: its corners, and their energy in a substep.
#include "physics/deformable/rope/rope_line.h"

#include <algorithm>

namespace embody::physics::deformable {

std::vector<RopeCorner> RopeLine::corners(std::span<const Vec3> positions, const Frames& frames) const {
    std::vector<RopeCorner> corners;
    const auto is_whole = [&](std::size_t s) { return s < segments_.size() && !segments_[s].is_broken; };
    const auto side_of = [&](std::size_t s) {
        return RopeCorner::Side{direction_of(positions[s + 1] - positions[s], segments_[s].length), s};
    };
    bool begins_span = true, is_held = false;
    const auto add = [&](RopeCorner corner) {
        corner.begins_span = begins_span;
        corners.push_back(corner);
        begins_span = false;
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::size_t fold = RopeFolds::by_node * i;
        const bool has_before = i > 0 && is_whole(i - 1), has_after = is_whole(i);
        if (!has_before) {
            begins_span = true;
            is_held = false;
        }
        if (const auto frame = frames(i)) {
            const RopeCorner::Side side{{frame->axis, Mat3::zero()}, FoldRow::none, clamps_.body_at(i)};
            RopeCorner corner;
            corner.clamp = static_cast<std::uint32_t>(i);
            corner.normal = frame->side;
            if (has_before) {
                corner.fold = fold + RopeFolds::before_clamp;
                corner.length = segments_[i - 1].length / 2;
                corner.before = side_of(i - 1);
                corner.after = side;
                add(corner);
            }
            if (is_held) begins_span = true;
            is_held = true;
            if (has_after) {
                corner.fold = fold + RopeFolds::after_clamp;
                corner.length = segments_[i].length / 2;
                corner.before = side;
                corner.after = side_of(i);
                add(corner);
            }
        } else if (has_before && has_after) {
            RopeCorner corner;
            corner.fold = fold + RopeFolds::at_node;
            corner.length = (segments_[i - 1].length + segments_[i].length) / 2;
            corner.before = side_of(i - 1);
            corner.after = side_of(i);
            add(corner);
        }
    }
    return corners;
}

RopeLine::Frames RopeLine::start_frames() const {
    return [this](std::size_t node) { return clamps_.start_frame_at(node); };
}

RopeLine::Frames RopeLine::end_frames(std::span<const BodyMove> body_moves) const {
    return [this, body_moves](std::size_t node) { return clamps_.frame_at(node, body_moves); };
}

double RopeLine::fold_energy(std::span<const Vec3> moves, std::span<const BodyMove> body_moves) const {
    if (!folds_.is_active()) return 0;
    std::vector<Vec3> at(moves.size());
    for (std::size_t i = 0; i < moves.size(); ++i) at[i] = nodes_.position[i] + moves[i];
    return folds_.energy(corners(at, end_frames(body_moves)));
}

// By inertia, but that no segment gets longer where it turns. From the first fixed node on; without one the center of
// mass moves on.
std::vector<Vec3> RopeLine::unstretched_moves(double h) const {
    std::vector<Vec3> moves(nodes_.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = h * nodes_.mean_velocity[i];
    const auto fixed = std::ranges::find(fixed_, true);
    const auto from = fixed == fixed_.end() ? 0 : static_cast<std::size_t>(fixed - fixed_.begin());
    std::vector<Vec3> turned = moves;
    const auto follow = [&](std::size_t node, std::size_t next) {
        const Vec3 edge = nodes_.position[next] - nodes_.position[node];
        const Vec3 displacement = normalized(edge + moves[next] - moves[node], edge);
        turned[next] = turned[node] + length(edge) * displacement - edge;
    };
    for (std::size_t i = from; i + 1 < moves.size(); ++i) follow(i, i + 1);
    for (std::size_t i = from; i > 0; --i) follow(i, i - 1);
    if (fixed != fixed_.end()) return turned;
    Vec3 missing;
    double mass = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        missing += nodes_.mass[i] * (moves[i] - turned[i]);
        mass += nodes_.mass[i];
    }
    for (Vec3& move : turned) move += missing / mass;
    return turned;
}

// Bodies that clamps turn with, with the nodes at `places_`.
void RopeLine::push_by_folds(const Substep& substep, std::span<const BodyMove> body_moves,
                             std::span<TouchedBody> bodies) {
    const auto rows = folds_.rows(corners(places_, end_frames(body_moves)), substep.settings.rope.fold_limit);
    FoldGradient gradient(nodes_.size(), bodies.size());
    gradient.add_bends(rows);
    gradient.add_links(rows);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (gradient.by_turn[b] != Vec3{}) bodies[b].push_turn(-substep.h * gradient.by_turn[b], substep.h);
    }
}

}  // namespace embody::physics::deformable
