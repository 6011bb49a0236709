// SPDX-License-Identifier: MIT
#include "scene/matter/slack_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace embody::scene {
namespace {

double length_of(const std::vector<Vec3>& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += distance(line[i], line[i - 1]);
    return sum;
}

bool nothing(Vec3) { return false; }

// A line along X at the height of 2 m, from -1 to 1 m.
std::vector<Vec3> level_line(int parts) {
    std::vector<Vec3> line;
    for (int i = 0; i <= parts; ++i) line.push_back({-1 + 2.0 * i / parts, 2, 0});
    return line;
}

TEST(SlackLine, HasTheLengthThatTheSlackSaysAndHangsDown) {
    const std::vector<Vec3> line = level_line(200);
    for (const double slack : {0.05, 0.5, 3.0}) {
        const std::vector<Vec3> arc = slack_line({.line = line, .slack = slack}, nothing);
        EXPECT_NEAR(length_of(arc), 2 * (1 + slack), 2e-3 * (1 + slack));
        EXPECT_EQ(arc.front(), line.front());
        EXPECT_EQ(arc.back(), line.back());
        EXPECT_LT(arc[100].y, 2 - 0.1);
        for (std::size_t i = 1; i < arc.size(); ++i)
            EXPECT_NEAR(distance(arc[i], arc[i - 1]), 0.01 * (1 + slack), 2e-3 * (1 + slack)) << i;
    }
    EXPECT_EQ(slack_line({.line = line}, nothing), line);
    // A vertical line has no downward side: the arc goes sideways.
    EXPECT_GT(length_of(slack_line({.line = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, .slack = 0.5}, nothing)), 2.1);
}

TEST(SlackLine, HangsFromEachNodeThatIsHeld) {
    const std::vector<Vec3> line = level_line(200);
    const std::vector<HeldNode> held{{150, line[150]}, {0, line[0]}, {50, line[50]}, {51, line[51]}};
    const std::vector<Vec3> arc = slack_line({.line = line, .held = held, .slack = 0.2}, nothing);
    for (const std::size_t node : {0, 50, 51, 150, 200}) EXPECT_EQ(arc[node], line[node]) << node;
    for (const std::size_t node : {25, 100, 175}) EXPECT_LT(arc[node].y, 2 - 0.1) << node;
    EXPECT_NEAR(length_of({arc.begin() + 51, arc.begin() + 151}), 1.2 * 0.99, 2e-3);
}

TEST(SlackLine, IsDrawnToItsPinsAsFarAsItReaches) {
    const std::vector<Vec3> line = level_line(200);
    const Vec3 near{0, 1.6, 0.2}, far{0, 0.5, 0};
    EXPECT_EQ(slack_line({.line = line, .held = {{100, near}}, .slack = 0.2}, nothing)[100], near);
    EXPECT_EQ(slack_line({.line = line, .held = {{100, far}}, .slack = 0.2}, nothing)[100], line[100]);
}

TEST(SlackLine, GoesWhereNothingStands) {
    const std::vector<Vec3> line = level_line(100);
    const double slack = 0.2;
    const auto is_ground = [](Vec3 p) { return p.y < 1.99; };
    const auto is_slot = [](Vec3 p) { return p.y < 1.99 || std::fabs(p.z) > 0.01; };
    const auto is_shaft = [](Vec3 p) { return std::fabs(p.y - 2) > 0.1 || std::fabs(p.z) > 0.1; };
    const auto is_everywhere = [](Vec3) { return true; };
    const auto find = [&](const std::function<bool(Vec3)>& is_blocked) {
        const std::vector<Vec3> arc = slack_line({.line = line, .slack = slack}, is_blocked);
        EXPECT_NEAR(length_of(arc), 2 * (1 + slack), 0.02);
        return arc;
    };
    for (const Vec3 node : find(is_ground)) EXPECT_NEAR(node.y, 2, 1e-9) << "aside on the ground";
    const std::vector<Vec3> up = find(is_slot);
    EXPECT_GT(up[50].y, 2.3) << "upwards between walls";
    for (const Vec3 node : find(is_shaft)) {
        EXPECT_FALSE(is_shaft(node)) << "in waves";
    }
    EXPECT_LT(find(is_everywhere)[50].y, 1.9) << "as ever where nothing is free";
}

}  // namespace
}  // namespace embody::scene
