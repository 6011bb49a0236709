// SPDX-License-Identifier: MIT
// Overhand knots (docs/physics/thin-contact.md, "Ropes with themselves"): drawn tight they hold, and a rope never
// passes through itself, however it is thrown.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

double scaled_between(Random& random, double low, double high) { return low * std::pow(high / low, random.unit()); }

/// An overhand knot with straight ends along Y, the first on top: V. Shastri's long trefoil ("Polynomial
/// representations of knots", 1992), flattened, nodes `segment` apart.
std::vector<Vec3> overhand_knot(double size, double tail, double segment) {
    constexpr double end = 2.05;
    constexpr int pieces = 4000;
    const auto at = [&](double t) {
        const double t2 = t * t;
        return size * Vec3{t * (t2 - 3), 0.35 * t * (10 - t2 * t2), t2 * (t2 - 4)};
    };
    const int count = static_cast<int>(tail / segment) + 1;
    const Vec3 first = at(-end), last = at(end), out = normalized(first - at(-end + 2 * end / pieces)),
               on = normalized(last - at(end - 2 * end / pieces));
    std::vector<Vec3> nodes;
    for (int k = count; k >= 0; --k) nodes.push_back(first + (k * segment) * out);
    double way = 0;
    for (int i = 1; i <= pieces; ++i) {
        way += length(at(-end + 2 * end * i / pieces) - at(-end + 2 * end * (i - 1) / pieces));
        if (way < segment) continue;
        nodes.push_back(at(-end + 2 * end * i / pieces));
        way = 0;
    }
    const Vec3 joint = nodes.back();
    for (int k = 1; k <= count; ++k) nodes.push_back(joint + (k * segment) * on);
    if (nodes.front().y < nodes.back().y) {
        for (Vec3& node : nodes) node.y = -node.y;
    }
    return nodes;
}

/// The determinant of the knot that a rope makes whose ends go on straight away from its middle: 1 without a knot, 3
/// with an overhand knot. From the colourings of a picture of it (R. H. Fox); both ends are one arc of it.
double knot_determinant(std::vector<Vec3> nodes) {
    constexpr Vec3 view{0.83, 0.05, 0.55};
    Vec3 middle;
    for (const Vec3 node : nodes) middle += (1.0 / static_cast<double>(nodes.size())) * node;
    nodes.insert(nodes.begin(), middle + 100 * (nodes.front() - middle));
    nodes.push_back(middle + 100 * (nodes.back() - middle));
    const Vec3 z = normalized(view), x = normalized(cross(Vec3{0, 1, 0}, z)), y = cross(z, x);
    struct Crossing {
        double under = 0, over = 0;  // segment and part of it
    };
    std::vector<Crossing> crossings;
    const auto cross2 = [&](Vec3 a, Vec3 b) { return dot(a, x) * dot(b, y) - dot(a, y) * dot(b, x); };
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        for (std::size_t k = i + 2; k + 1 < nodes.size(); ++k) {
            const Vec3 a = nodes[i + 1] - nodes[i], b = nodes[k + 1] - nodes[k], between = nodes[k] - nodes[i];
            const double area = cross2(a, b), s = cross2(between, b) / area, t = cross2(between, a) / area;
            if (!(s >= 0 && s < 1 && t >= 0 && t < 1)) continue;
            const double first = static_cast<double>(i) + s, second = static_cast<double>(k) + t;
            const bool is_above = dot(nodes[i] + s * a - nodes[k] - t * b, z) > 0;
            crossings.push_back(is_above ? Crossing{second, first} : Crossing{first, second});
        }
    }
    const std::size_t n = crossings.size();
    if (n < 3) return 1;
    std::ranges::sort(crossings, {}, &Crossing::under);
    const auto arc_of = [&](double way) {
        return static_cast<std::size_t>(
                   std::ranges::count_if(crossings, [&](const Crossing& crossing) { return crossing.under < way; })) %
               n;
    };
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n, 0));
    for (std::size_t i = 0; i < n; ++i) {
        matrix[i][arc_of(crossings[i].over)] += 2;
        matrix[i][i] -= 1;
        matrix[i][(i + 1) % n] -= 1;
    }
    double determinant = 1;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        std::size_t pivot = i;
        for (std::size_t r = i; r + 1 < n; ++r) {
            if (std::fabs(matrix[r][i]) > std::fabs(matrix[pivot][i])) pivot = r;
        }
        std::swap(matrix[i], matrix[pivot]);
        determinant *= matrix[i][i];
        if (determinant == 0) return 0;
        for (std::size_t r = i + 1; r + 1 < n; ++r) {
            const double factor = matrix[r][i] / matrix[i][i];
            for (std::size_t c = i; c + 1 < n; ++c) matrix[r][c] -= factor * matrix[i][c];
        }
    }
    return std::round(std::fabs(determinant));
}

/// Rope with a knot, held at its upper end, and a ball at the other that draws it tight.
struct Knotted {
    Rope rope;
    double radius = 0, segment = 0;  // m
    double pull = 0;                 // N: the ball's weight
    double damping = 0;              // of the ball, 1/s: it sinks with g over it
};

struct Drawn {
    bool was_a_knot = true;  // in every step
    double in_knot = 0;      // rope in it at the end, in diameters
    double apart = 0;        // nearest strands at the end, in diameters
    double gain = 0;         // highest energy above that at the start, of what the ball gave
    std::vector<Vec3> nodes;
};

double distance_between(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    // Of two segments: the best of the lines' own and of each end with the other.
    const auto to_segment = [](Vec3 p, Vec3 q, Vec3 r) {
        const Vec3 along = r - q;
        const double t = std::clamp(dot(p - q, along) / dot(along, along), 0.0, 1.0);
        return length(p - q - t * along);
    };
    double least = std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
    if (det <= 0) return least;
    const double s = (uv * dot(v, w) - vv * dot(u, w)) / det, t = (uu * dot(v, w) - uv * dot(u, w)) / det;
    if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, length(w + s * u - t * v));
    return least;
}

double nearest_strands(std::span<const Vec3> nodes, std::size_t apart) {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        for (std::size_t k = i + apart; k + 1 < nodes.size(); ++k)
            least = std::min(least, distance_between(nodes[i], nodes[i + 1], nodes[k], nodes[k + 1]));
    }
    return least;
}

Drawn draw_tight(const Knotted& knotted, double seconds, int workers = 1) {
    const double diameter = 2 * knotted.radius;
    const auto world = make_world({.gravity = {0, -gravity, 0}, .air_density = 0, .workers = workers});
    DeformableDefinition definition;
    definition.nodes = overhand_knot(6 * knotted.radius, 0.15, knotted.segment);
    definition.matter = knotted.rope;
    definition.contact_radius = knotted.radius;
    definition.pinned = {0};
    const auto last = static_cast<std::uint32_t>(definition.nodes.size() - 1);
    const DeformableHandle rope = world->create_deformable(definition).value();
    // Without a shape: it touches nothing.
    const double mass = knotted.pull / gravity;
    const BodyHandle ball =
        world
            ->create_body({.position = definition.nodes.back(),
                           .mass = {.mass = mass, .center_of_mass = Vec3{}, .inertia = 4e-4 * mass * Mat3::identity()},
                           .linear_damping = knotted.damping})
            .value();
    EXPECT_TRUE(world->set_attachments(rope, {{last, ball, {}}}));
    double length_of_rope = 0;
    for (std::size_t i = 0; i < last; ++i) length_of_rope += length(definition.nodes[i + 1] - definition.nodes[i]);
    Drawn drawn;
    EXPECT_EQ(knot_determinant(definition.nodes), 3);
    const double start = energy(*world);
    double highest = start;
    const double height = definition.nodes.back().y;
    for (int step = 0; step < 60 * seconds; ++step) {
        world->step();
        highest = std::max(highest, energy(*world));
        const auto places = world->node_positions(rope);
        drawn.was_a_knot &= knot_determinant({places.begin(), places.end()}) == 3;
    }
    const auto nodes = world->node_positions(rope);
    drawn.nodes.assign(nodes.begin(), nodes.end());
    drawn.in_knot = (length_of_rope - length(nodes.front() - nodes.back())) / diameter;
    drawn.apart = nearest_strands(nodes, static_cast<std::size_t>(pi * diameter / knotted.segment) + 1) / diameter;
    drawn.gain = (highest - start) / (knotted.pull * (height - world->center_of_mass(ball).y));
    return drawn;
}

Knotted random_knot(std::uint64_t seed, double lowest_turn) {
    Random random(seed);
    Knotted knotted{.radius = scaled_between(random, 0.0025, 0.008)};
    const double r = knotted.radius;
    knotted.segment = r * random.between(1.5, 2.5);
    knotted.rope = {.diameter = 2 * r,
                    .linear_density = 900 * pi * r * r,
                    .axial_stiffness = scaled_between(random, 3e3, 3e4),
                    .rayleigh_damping = 0.01};
    knotted.pull = scaled_between(random, 5, 30);
    // The ends of such a rope under a pull F turn within √(EI/F).
    const double turn = 2 * r * scaled_between(random, lowest_turn, 2);
    knotted.rope.bend_rigidity = knotted.pull * turn * turn;
    knotted.damping = random.between(5, 15);
    return knotted;
}

TEST(Knot, HoldsWhatDrawsItTight) {
    const int cases = wanted_cases("EMBODY_KNOTS", 4);
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(cases); ++seed) {
        const Knotted knotted = random_knot(seed, 0.5);
        const Drawn drawn = draw_tight(knotted, 4);
        EXPECT_TRUE(drawn.was_a_knot) << seed;
        // 10.1 in the tightest of a rope that bends freely (P. Pieranski and others, "Tight open knots", 2001).
        EXPECT_GT(drawn.in_knot, 9) << seed;
        EXPECT_LT(drawn.in_knot, 25) << seed;
        EXPECT_GT(drawn.apart, 0.5) << seed;
        EXPECT_LT(drawn.gain, 0.001) << seed;
    }
}

TEST(Knot, StaysTiedWhenItIsJerked) {
    const int cases = wanted_cases("EMBODY_JERKED_KNOTS", 3);
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(cases); ++seed) {
        Knotted knotted = random_knot(seed, 0.3);
        knotted.damping = 0;
        const Drawn drawn = draw_tight(knotted, 1);
        EXPECT_TRUE(drawn.was_a_knot) << seed;
        EXPECT_LT(drawn.gain, 0.001) << seed;
    }
}

// A rope that hangs over the floor and is let go.
TEST(Knot, ARopeLiesOnItselfInAHeap) {
    const int cases = wanted_cases("EMBODY_ROPE_HEAPS", 8);
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(cases); ++seed) {
        Random random(seed);
        const double r = scaled_between(random, 0.003, 0.01);
        const double segment = r * random.between(1.5, 3);
        const auto world = make_world({.gravity = {0, -gravity, 0}, .air_density = 0});
        add_plane(*world, friction(0.5));
        DeformableDefinition definition =
            rope_between({0, 100 * r, 0}, {random.between(-10, 10) * r, 2 * r, 0}, segment,
                         {.diameter = 2 * r,
                          .linear_density = 900 * pi * r * r,
                          .axial_stiffness = scaled_between(random, 1e3, 1e4),
                          .bend_rigidity = 900 * pi * r * r * gravity * scaled_between(random, 30, 1000) * r * r * r,
                          .rayleigh_damping = 0.01});
        definition.contact_radius = r;
        definition.material = friction(0.5);
        for (Vec3& node : definition.nodes) node += r * Vec3{random.unit(), 0, random.unit()};
        const DeformableHandle rope = world->create_deformable(definition).value();
        const double start = energy(*world);
        double highest = start;
        for (int step = 0; step < 180; ++step) {
            world->step();
            highest = std::max(highest, energy(*world));
        }
        const double apart =
            nearest_strands(world->node_positions(rope), static_cast<std::size_t>(pi * 2 * r / segment) + 2) / (2 * r);
        EXPECT_GT(apart, 0.2) << seed;
        EXPECT_LT(highest, 1.001 * start) << seed;
    }
}

TEST(Knot, HasTheSameBitsForAnyNumberOfWorkers) {
    std::vector<Vec3> first;
    for (const int workers : {1, 2, 4}) {
        const std::vector<Vec3> nodes = draw_tight(random_knot(1, 0.5), 0.5, workers).nodes;
        if (first.empty()) first = nodes;
        EXPECT_EQ(nodes, first) << workers;
    }
}

}  // namespace
}  // namespace embody::physics
