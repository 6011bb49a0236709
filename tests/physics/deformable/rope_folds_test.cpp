// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "math/quat.h"
#include "physics/deformable/rope/rope_folds.h"

namespace embody::physics::deformable {
namespace {

constexpr double rest = 0.02;  // m

Vec3 random_vector(Random& random, double most) {
    return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

Quat turn_by(Vec3 v) { return from_axis_angle(normalized(v), length(v)); }

/// A wire of random bends, free or with clamps on bodies 0, 1 … at some of its nodes.
struct LooseWire {
    std::vector<Vec3> places{{0, 0, 0}};
    std::vector<std::uint32_t> clamped;
    std::vector<Quat> turns;       // of the bodies
    std::vector<Vec3> directions;  // of the clamps before the bodies turned

    LooseWire(Random& random, std::vector<std::uint32_t> clamps) : clamped(std::move(clamps)), turns(clamped.size()) {
        Vec3 direction{1, 0, 0};
        for (int i = 0; i < 12; ++i) {
            if (std::ranges::find(clamped, static_cast<std::uint32_t>(i)) != clamped.end())
                directions.push_back(normalized(direction + random_vector(random, 0.3)));
            places.push_back(places.back() + rest * direction);
            direction = normalized(direction + random_vector(random, 0.5));
        }
    }
    [[nodiscard]] RopeCorner::Side side(std::size_t segment) const {
        return {direction_of(places[segment + 1] - places[segment], rest), segment};
    }
    [[nodiscard]] std::vector<RopeCorner> corners() const {
        std::vector<RopeCorner> all;
        bool is_held = false;
        for (std::uint32_t i = 0; i + 1 < places.size(); ++i) {
            RopeCorner corner;
            corner.begins_span = all.empty();
            const auto clamp = static_cast<std::size_t>(std::ranges::find(clamped, i) - clamped.begin());
            if (clamp == clamped.size()) {
                if (i == 0) continue;
                corner.fold = RopeFolds::by_node * i + RopeFolds::at_node;
                corner.length = rest;
                corner.before = side(i - 1);
                corner.after = side(i);
                all.push_back(corner);
                continue;
            }
            const auto body = static_cast<std::uint32_t>(clamp);
            const RopeCorner::Side own{{rotate(turns[clamp], directions[clamp]), Mat3::zero()}, FoldRow::none, body};
            corner.clamp = i;
            corner.normal = rotate(turns[clamp], any_perpendicular(directions[clamp]));
            corner.length = rest / 2;
            if (i > 0) {
                corner.fold = RopeFolds::by_node * i + RopeFolds::before_clamp;
                corner.before = side(i - 1);
                corner.after = own;
                all.push_back(corner);
            }
            corner.begins_span = is_held || all.empty();
            corner.fold = RopeFolds::by_node * i + RopeFolds::after_clamp;
            corner.before = own;
            corner.after = side(i);
            all.push_back(corner);
            is_held = true;
        }
        return all;
    }
    void shake(Random& random, double most) {
        for (Vec3& place : places) place += random_vector(random, most * rest);
        for (Quat& turn : turns) turn = turn_by(random_vector(random, most)) * turn;
    }
};

// Free, clamped at an end, within and twice, elastic and yielding, with damping: forces on nodes and torques on bodies
// are the derivatives of the energy, and those of all together neither push nor turn.
TEST(RopeFolds, ForcesAreTheDerivativesOfTheEnergy) {
    Random random(3);
    const std::vector<std::vector<std::uint32_t>> clamps{{}, {0}, {5}, {0, 6}, {3, 8}};
    for (int i = 0; i < 40; ++i) {
        const bool yields = i % 2 == 1;
        LooseWire wire(random, clamps[static_cast<std::size_t>(i / 2) % clamps.size()]);
        RopeFolds folds(wire.places.size(), 0.157, yields ? random.between(2, 10) : 1e6);
        std::vector<std::array<double, 6>> state(wire.places.size());
        for (auto& of_node : state) std::ranges::generate(of_node, [&] { return random.between(-0.3, 0.3); });
        folds.set_state(state);
        folds.begin(wire.corners(), i % 3);
        folds.keep(wire.corners());
        wire.shake(random, 0.2);
        const std::vector<FoldRow> rows = folds.rows(wire.corners(), 0.02);
        FoldGradient gradient(wire.places.size(), wire.turns.size());
        gradient.add_bends(rows);
        gradient.add_links(rows);
        double largest = 0;
        for (const Vec3 force : gradient.by_node) largest = std::max(largest, length(force));
        const auto energy = [&] { return folds.energy(wire.corners()); };
        const double step = 1e-6;
        for (std::size_t node = 0; node < wire.places.size(); ++node) {
            for (int c = 0; c < 3; ++c) {
                const Vec3 before = wire.places[node];
                wire.places[node][c] = before[c] + step * rest;
                const double more = energy();
                wire.places[node][c] = before[c] - step * rest;
                const double slope = (more - energy()) / (2 * step * rest);
                wire.places[node] = before;
                EXPECT_NEAR(gradient.by_node[node][c], slope, (yields ? 2e-3 : 1e-5) * largest)
                    << i << " node " << node;
            }
        }
        Vec3 force, torque;
        for (std::size_t node = 0; node < wire.places.size(); ++node) {
            force += gradient.by_node[node];
            torque += cross(wire.places[node], gradient.by_node[node]);
        }
        for (std::size_t body = 0; body < wire.turns.size(); ++body) {
            for (int c = 0; c < 3; ++c) {
                Vec3 turn;
                turn[c] = step;
                const Quat before = wire.turns[body];
                wire.turns[body] = turn_by(turn) * before;
                const double more = energy();
                wire.turns[body] = turn_by(-turn) * before;
                const double slope = (more - energy()) / (2 * step);
                wire.turns[body] = before;
                EXPECT_NEAR(gradient.by_turn[body][c], slope, 1e-5 * largest * rest) << i << " body " << body;
            }
            torque += gradient.by_turn[body];
        }
        EXPECT_LT(length(force), 1e-9 * largest) << i;
        EXPECT_LT(length(torque), (yields ? 2e-3 : 1e-6) * largest * rest) << i;
    }
}

}  // namespace
}  // namespace embody::physics::deformable
