// SPDX-License-Identifier: MIT
// Structures that stand by friction and form: leaning cards and a masonry arch.
#include <cmath>
#include <numbers>

#include "scenes/structures/building.h"

namespace embody::scenes {

using physics::BoxShape;
using physics::HullShape;
using physics::Material;
using physics::WorldSettings;

namespace {

using std::numbers::pi;

Material with_friction(double friction) { return {.friction_static = friction, .friction_dynamic = friction}; }

// A card upright, m, and how far it leans from the vertical: those of Box3D's sample CardHouse, 2 mm thick.
constexpr Vec3 card_half{0.001, 0.2, 0.15};
constexpr double lean = 25 * pi / 180;

/// How high a leaning card reaches, and how far to the side from its centre, m.
double leaning_height() { return 2 * (card_half.y * std::cos(lean) + card_half.x * std::sin(lean)); }
double leaning_reach() { return card_half.y * std::sin(lean) + card_half.x * std::cos(lean); }

/// Two cards whose upper edges meet over (x, ·, 0), on ground at the height y.
void add_leaning_pair(Building& building, physics::ShapeHandle card, double x, double y) {
    const double middle = y + leaning_height() / 2;
    building.add(card, {x - leaning_reach(), middle, 0}, from_axis_angle({0, 0, 1}, -lean));
    building.add(card, {x + leaning_reach(), middle, 0}, from_axis_angle({0, 0, 1}, lean));
}

}  // namespace

// The cards are mitred, so that they meet face to face and stand on their faces: between two edges any normal would do,
// and the one that is chosen would decide.
Structure build_card_pair(const WorldSettings& settings, double friction) {
    Building building(settings, with_friction(friction));
    const double inner = 2 * card_half.y * std::sin(lean);  // foot's inner edge from the middle, m
    const double outer = inner + 2 * card_half.x / std::cos(lean);
    for (const double side : {-1.0, 1.0}) {
        HullShape card;
        for (const double z : {-card_half.z, card_half.z}) {
            for (const double foot : {inner, outer}) {
                card.points.push_back({side * foot, 0, z});
                card.points.push_back({0, foot / std::tan(lean), z});
            }
        }
        building.add(building.shape(card), {});
    }
    return building.take(0.05);
}

// Five levels of pairs; between two levels cards lie from top to top.
Structure build_card_house(const WorldSettings& settings) {
    Building building(settings, with_friction(0.7));
    constexpr int levels = 5;
    constexpr double pitch = 0.35;  // m; a pair is 0.34 m wide
    const auto card = building.shape(BoxShape{card_half});
    const auto floor = building.shape(BoxShape{{pitch / 2, card_half.x, card_half.z}});
    double y = 0;
    for (int level = 0; level < levels; ++level) {
        const int pairs = levels - level;
        const double first = -0.5 * pitch * (pairs - 1);
        for (int i = 0; i < pairs; ++i) add_leaning_pair(building, card, first + pitch * i, y);
        y += leaning_height();
        for (int i = 0; i + 1 < pairs; ++i) building.add(floor, {first + pitch * (i + 0.5), y + card_half.x, 0});
        y += 2 * card_half.x;
    }
    return building.take(0.05);
}

Structure build_arch(const WorldSettings& settings, double thickness, double friction) {
    Building building(settings, with_friction(friction));
    constexpr int blocks = 11;
    constexpr double half_depth = 0.25;  // m
    const auto corner = [&](int joint, double radius, double z) {
        const double angle = pi * joint / blocks;
        return Vec3{-radius * std::cos(angle), radius * std::sin(angle), z};
    };
    for (int i = 0; i < blocks; ++i) {
        // About the middle of its eight corners, which becomes the body's origin.
        HullShape block;
        Vec3 middle;
        for (const int joint : {i, i + 1}) {
            for (const double radius : {1 - thickness / 2, 1 + thickness / 2}) {
                for (const double z : {-half_depth, half_depth}) block.points.push_back(corner(joint, radius, z));
            }
        }
        for (const Vec3& point : block.points) middle += point / 8;
        for (Vec3& point : block.points) point -= middle;
        building.add(building.shape(block), middle);
    }
    return building.take(0.03);
}

}  // namespace embody::scenes
