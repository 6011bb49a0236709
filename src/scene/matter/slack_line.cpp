// SPDX-License-Identifier: MIT
#include "scene/matter/slack_line.h"

#include <algorithm>
#include <cmath>

namespace embody::scene {

namespace {

// A row of parabolas between two places: one deep one, or many shallow ones.
struct Shape {
    Vec3 aside;  // unit, perpendicular to the span
    int waves = 1;
    bool changes = false;  // side from wave to wave
};

struct Span {
    Vec3 from, chord;
    double length = 0;  // wanted, m
    std::size_t parts = 1;
};

double wave(const Shape& shape, double t) {
    const double along = t * shape.waves, whole = std::min(std::floor(along), shape.waves - 1.0), part = along - whole;
    const bool is_back = shape.changes && std::fmod(whole, 2) == 1;
    return (is_back ? -4 : 4) * part * (1 - part);
}

// The arc of the wanted length; its depth is found by bisection.
std::vector<Vec3> arc_of(const Span& span, const Shape& shape) {
    constexpr int steps = 2000, halvings = 60;
    std::vector<double> along(steps + 1, 0);  // path length along the arc
    const auto place = [&](double t, double depth) {
        return span.from + t * span.chord + depth * wave(shape, t) * shape.aside;
    };
    const auto measure = [&](double depth) {
        for (int i = 1; i <= steps; ++i) {
            const double t = static_cast<double>(i) / steps;
            along[static_cast<std::size_t>(i)] =
                along[static_cast<std::size_t>(i) - 1] + length(place(t, depth) - place(t - 1.0 / steps, depth));
        }
        return along.back();
    };
    double low = 0, high = span.length;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (low + high) / 2;
        (measure(middle) < span.length ? low : high) = middle;
    }
    measure(low);
    std::vector<Vec3> arc;
    std::size_t next = 1;
    for (std::size_t k = 0; k <= span.parts; ++k) {
        const double at = along.back() * static_cast<double>(k) / static_cast<double>(span.parts);
        while (next < steps && along[next] < at) ++next;
        const double before = along[next - 1], part = (at - before) / std::max(along[next] - before, 1e-12);
        arc.push_back(place((static_cast<double>(next) - 1 + std::clamp(part, 0.0, 1.0)) / steps, low));
    }
    return arc;
}

// Candidates for the shape of an arc, in order of preference.
std::vector<Shape> shapes_of(const Span& span, Vec3 down) {
    const Vec3 ahead = normalized(span.chord, {1, 0, 0});
    const Vec3 across = std::fabs(ahead.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    const Vec3 sag = normalized(down - dot(down, ahead) * ahead, normalized(cross(ahead, across), {0, 0, 1}));
    const Vec3 side = cross(ahead, sag);
    std::vector<Shape> shapes;
    for (const Vec3 aside : {sag, side, -side, normalized(sag + side), normalized(sag - side), -sag})
        shapes.push_back({aside});
    constexpr int min_parts = 4;  // of a wave
    for (int waves = 2; waves * min_parts <= static_cast<int>(span.parts); waves *= 2) {
        shapes.push_back({side, waves, true});
        shapes.push_back({sag, waves, true});
        shapes.push_back({-sag, waves, false});
    }
    return shapes;
}

// Number of blocked places of the arc, counted up to `max_count`; its ends may touch the things that hold them.
std::size_t count_blocked(const std::vector<Vec3>& arc, std::size_t max_count,
                          const std::function<bool(Vec3)>& is_blocked) {
    std::size_t blocked = 0;
    for (std::size_t k = 1; k + 1 < arc.size() && blocked < max_count; ++k) {
        blocked += is_blocked(arc[k]) ? 1 : 0;
        if (k + 2 < arc.size()) blocked += is_blocked(0.5 * (arc[k] + arc[k + 1])) ? 1 : 0;
    }
    return blocked;
}

double length_between(const SlackRope& rope, std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first + 1; i <= last; ++i) sum += (1 + rope.slack) * length(rope.line[i] - rope.line[i - 1]);
    return sum;
}

// Moves held nodes to their places, but keeps a node on the line if the rope does not reach its place. Returns the
// nodes at which arcs begin and end.
std::vector<std::size_t> place_held(const SlackRope& rope, std::vector<Vec3>& line) {
    std::vector<std::size_t> ends{0, line.size() - 1};
    for (const HeldNode& one : rope.held) {
        ends.push_back(one.node);
        line[one.node] = one.place;
    }
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (std::size_t e = 1; e < ends.size(); ++e) {
            const std::size_t first = ends[e - 1], last = ends[e];
            if (distance(line[first], line[last]) <= length_between(rope, first, last)) continue;
            has_changed = line[first] != rope.line[first] || line[last] != rope.line[last];
            line[first] = rope.line[first];
            line[last] = rope.line[last];
            if (has_changed) break;
        }
    }
    return ends;
}

}  // namespace

std::vector<Vec3> slack_line(const SlackRope& rope, const std::function<bool(Vec3)>& is_blocked) {
    std::vector<Vec3> line = rope.line;
    if (!(rope.slack > 0) || line.size() < 2) return line;
    const std::vector<std::size_t> ends = place_held(rope, line);
    for (std::size_t e = 1; e < ends.size(); ++e) {
        const std::size_t first = ends[e - 1], last = ends[e];
        if (last == first + 1) continue;
        const Span span{line[first], line[last] - line[first], length_between(rope, first, last), last - first};
        std::vector<Vec3> best;
        std::size_t min_blocked = 2 * span.parts + 1;
        for (const Shape& shape : shapes_of(span, rope.down)) {
            const std::vector<Vec3> arc = arc_of(span, shape);
            const std::size_t blocked = count_blocked(arc, min_blocked, is_blocked);
            if (blocked >= min_blocked) continue;
            min_blocked = blocked;
            best = arc;
            if (blocked == 0) break;
        }
        std::copy(best.begin() + 1, best.end() - 1, line.begin() + static_cast<std::ptrdiff_t>(first) + 1);
    }
    return line;
}

}  // namespace embody::scene
