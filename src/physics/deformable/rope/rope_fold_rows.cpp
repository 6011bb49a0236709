// SPDX-License-Identifier: MIT
//
// How the bend of a corner changes along axes that turn with the wire. With directions a and b before and after it,
// m half way between them, κ as in rope_clamps.cpp, and φ the turn of the wire about itself on either side:
//   δφ_b - δφ_a + ½ κ·(δa + δb) = 0 without twist (Bergou and others 2008, eq. 9),
//   δψ = δφ_a - ½ κ_m·(δa + δm) about m, κ_m of the corner from a to m,
//   δβ₁ = d₁·(δb - δa) + β₂ δψ,  δβ₂ = d₂·(δb - δa) - β₁ δψ.
// A turn of the whole leaves all of these zero.
#include <algorithm>

#include "physics/deformable/rope/rope_folds.h"

namespace embody::physics::deformable {

namespace {

// Stiffness against twist over that of bending, a number: as good as rigid, and far above rounding.
// Test: Wire.ABentWireKeepsItsFormInFlight
constexpr double rigid = 1e4;

// Parts of a row by the two directions and by the turns about them.
struct BySides {
    Vec3 a, b;
    double turn_a = 0, turn_b = 0;
};

void add_side(FoldRow& row, const RopeCorner::Side& side, Vec3 by_direction, double by_turn, std::size_t k) {
    const Vec3 displacement = side.direction.displacement;
    if (side.segment != FoldRow::none) {
        const Vec3 by_end = transpose(side.direction.by_end) * by_direction;
        row.by_node[side.segment + 1 - row.first_node] += by_end;
        row.by_node[side.segment - row.first_node] -= by_end;
        row.angle[k] = side.segment;
        row.by_angle[k] = by_turn;
    } else if (side.body != no_body) {
        row.body = side.body;
        row.by_turn += cross(displacement, by_direction) + by_turn * displacement;
    }
}

FoldRow row_of(const RopeCorner& corner, double weight, double residual, const BySides& by) {
    FoldRow row;
    row.weight = weight;
    row.residual = residual;
    row.first_node = std::min(corner.before.segment, corner.after.segment);
    add_side(row, corner.before, by.a, by.turn_a, 0);
    add_side(row, corner.after, by.b, by.turn_b, 1);
    return row;
}

}  // namespace

std::vector<FoldRow> RopeFolds::rows(std::span<const RopeCorner> corners, double fold_limit) const {
    const std::vector<Seen> seen = see(corners, damping_);
    std::vector<FoldRow> rows;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const RopeCorner& corner = corners[i];
        const Seen& own = seen[i];
        const Vec3 a = corner.before.direction.displacement, b = corner.after.direction.displacement;
        const Vec3 half = curvature_of(a, own.middle, fold_limit);
        const Vec3 by_middle = half / std::max(length(a + b), fold_limit);
        const BySides turn{-0.5 * (half + by_middle), -0.5 * by_middle, 1, 0};
        const auto bend_row = [&](Vec3 axis, double missing, double across) {
            return row_of(corner, own.stiffness + own.damping, missing,
                          {across * turn.a - axis, across * turn.b + axis, across * turn.turn_a, 0});
        };
        const auto beyond = own.beyond(), grown = own.grown();
        const auto residual = [&](std::size_t k) {
            return (own.stiffness * beyond[k] + own.damping * grown[k]) / (own.stiffness + own.damping);
        };
        rows.push_back(bend_row(own.first, residual(0), own.bend[1]));
        rows.back().begins_span = corner.begins_span;
        rows.push_back(bend_row(own.second, residual(1), -own.bend[0]));
        // A second clamp does not turn the folds.
        if (corner.clamp != RopeCorner::no_clamp && corner.clamp != own.clamp) continue;
        const Vec3 whole = 0.5 * curvature_of(a, b, fold_limit);
        rows.push_back(row_of(corner, rigid * rigidity_ / corner.length, 0, {whole, whole, -1, 1}));
        rows.back().is_link = true;
    }
    return rows;
}

void FoldGradient::add(const FoldRow& row, double moment) {
    for (std::size_t k = 0; k < row.by_node.size() && row.first_node + k < by_node.size(); ++k)
        by_node[row.first_node + k] += moment * row.by_node[k];
    if (row.body != no_body && row.body < by_turn.size()) by_turn[row.body] += moment * row.by_turn;
}

void FoldGradient::add_bends(std::span<const FoldRow> rows) {
    for (const FoldRow& row : rows) {
        if (!row.is_link) add(row, row.weight * row.residual);
    }
}

// A link bears what bends give to the turns on its side, away from the clamp.
void FoldGradient::add_links(std::span<const FoldRow> rows) {
    std::vector<double> by_angle(by_node.size(), 0);
    for (const FoldRow& row : rows) {
        for (std::size_t k = 0; k < 2 && !row.is_link; ++k) {
            if (row.angle[k] != FoldRow::none) by_angle[row.angle[k]] += row.weight * row.residual * row.by_angle[k];
        }
    }
    for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
        std::vector<const FoldRow*> links;
        for (last = first + 1; last < rows.size() && !rows[last].begins_span; ++last) {
            if (rows[last].is_link) links.push_back(&rows[last]);
        }
        std::size_t j = 0;
        double moment = 0;
        for (; j < links.size() && links[j]->angle[0] != FoldRow::none; ++j)
            add(*links[j], moment += by_angle[links[j]->angle[0]]);
        moment = 0;
        for (std::size_t k = links.size(); k > j; --k) {
            if (links[k - 1]->angle[1] != FoldRow::none) moment -= by_angle[links[k - 1]->angle[1]];
            add(*links[k - 1], moment);
        }
    }
}

}  // namespace embody::physics::deformable
