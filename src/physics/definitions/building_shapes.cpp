// SPDX-License-Identifier: MIT
#include "physics/definitions/building_shapes.h"

#include <algorithm>
#include <cmath>

#include "math/bounds.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics {

namespace {

using geometry::FlatPoint;
using geometry::FlatPolygon;

/// Heights between which a wall is solid; up to its top where `is_to_top`.
struct Solid {
    double from = 0, to = 0;
    bool is_to_top = false;
    friend bool operator==(const Solid&, const Solid&) = default;
};

// The opening's part within the wall; no width where there is none.
struct Cut {
    double from, to;      // along the wall
    double lower, upper;  // heights
};
Cut cut_of(const WallShape& wall, const WallOpening& opening) {
    const auto [first, last] = wall.straight_part();
    return {std::clamp(opening.offset, first, last), std::clamp(opening.offset + opening.width, first, last),
            opening.sill, opening.sill + opening.height};
}

// Where along the wall something begins or ends: openings, and the places where the sloped top crosses their edges.
std::vector<double> breaks_of(const WallShape& wall, const std::vector<Cut>& cuts, const FlatPolygon& footprint) {
    std::vector<double> breaks;
    for (const FlatPoint& corner : footprint) breaks.push_back(corner[0]);
    const auto [first, last] = std::minmax_element(breaks.begin(), breaks.end());
    breaks = {*first, *last};
    for (const Cut& cut : cuts) {
        for (const double x : {cut.from, cut.to}) breaks.push_back(x);
        if (wall.rise == 0) continue;
        for (const double y : {cut.lower, cut.upper}) {
            const double x = (y - wall.height) / wall.rise * wall.length;
            if (x > cut.from && x < cut.to) breaks.push_back(x);
        }
    }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

std::vector<Solid> solids_at(const WallShape& wall, const std::vector<Cut>& cuts, double x) {
    const double top = wall.height_at(x);
    std::vector<Cut> here;
    for (const Cut& cut : cuts)
        if (cut.from < x && x < cut.to && cut.lower < top) here.push_back(cut);
    std::sort(here.begin(), here.end(), [](const Cut& a, const Cut& b) { return a.lower < b.lower; });
    std::vector<Solid> solids;
    double from = 0;
    for (const Cut& cut : here) {
        if (cut.lower - from > thinnest_piece) solids.push_back({from, cut.lower, false});
        from = std::max(from, cut.upper);
    }
    if (top - from > thinnest_piece) solids.push_back({from, top, true});
    // The top is the wall's own, whatever it is here.
    if (!solids.empty() && solids.back().is_to_top) solids.back().to = 0;
    return solids;
}

void add_prism(const WallShape& wall, const FlatPolygon& base, const Solid& solid, std::vector<CompoundChild>& parts) {
    const auto [left, right] = std::minmax_element(base.begin(), base.end());
    const double low = (*left)[0], high = (*right)[0];
    const bool is_level = !solid.is_to_top || wall.rise == 0;
    const double upper = solid.is_to_top ? wall.height : solid.to, half = wall.thickness / 2;
    const bool is_box = is_level && base.size() == 4 && std::all_of(base.begin(), base.end(), [&](FlatPoint p) {
                            return (p[0] == low || p[0] == high) && std::fabs(p[1]) == half;
                        });
    if (is_box) {
        const Vec3 middle{(low + high) / 2, (solid.from + upper) / 2, 0};
        parts.push_back({BoxShape{{(high - low) / 2, (upper - solid.from) / 2, half}}, {middle, {}}});
        return;
    }
    HullShape hull;
    for (const FlatPoint& p : base) {
        const double top = solid.is_to_top ? std::max(solid.from, wall.height_at(p[0])) : solid.to;
        hull.points.push_back({p[0], solid.from, p[1]});
        if (top - solid.from > thinnest_piece) hull.points.push_back({p[0], top, p[1]});
    }
    parts.push_back({std::move(hull), {}});
}

void add_panes(const WallShape& wall, const std::vector<Cut>& cuts, std::vector<CompoundChild>& parts) {
    const double depth = std::min(pane_thickness, wall.thickness / 2);
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        if (wall.openings[i].kind != OpeningKind::window) continue;
        const Cut& cut = cuts[i];
        const double upper = std::min({cut.upper, wall.height_at(cut.from), wall.height_at(cut.to)});
        if (cut.to - cut.from < thinnest_piece || upper - cut.lower < thinnest_piece) continue;
        const Vec3 middle{(cut.from + cut.to) / 2, (cut.lower + upper) / 2, 0};
        parts.push_back({BoxShape{{(cut.to - cut.from) / 2, (upper - cut.lower) / 2, depth / 2}}, {middle, {}}});
    }
}

Bounds bounds_of(const FlatPolygon& polygon) {
    Bounds around;
    for (const FlatPoint& p : polygon) around.add(Vec3{p[0], 0, p[1]});
    return around;
}

}  // namespace

double WallShape::height_at(double x) const { return std::max(0.0, height + rise * x / length); }

std::array<double, 2> WallShape::straight_part() const {
    return {std::max({start_cut[0], start_cut[1], 0.0}), length - std::max({end_cut[0], end_cut[1], 0.0})};
}

FlatPolygon WallShape::footprint() const {
    const double half = thickness / 2;
    FlatPolygon corners{{start_cut[0], -half}, {length - end_cut[0], -half}};
    if (end_cut[0] + end_cut[1] > thinnest_piece) corners.push_back({length, 0});
    corners.push_back({length - end_cut[1], half});
    corners.push_back({start_cut[1], half});
    if (start_cut[0] + start_cut[1] > thinnest_piece) corners.push_back({0, 0});
    return corners;
}

std::vector<CompoundChild> WallShape::parts() const {
    const FlatPolygon seen = footprint();
    std::vector<Cut> cuts;
    for (const WallOpening& opening : openings) cuts.push_back(cut_of(*this, opening));
    const std::vector<double> breaks = breaks_of(*this, cuts, seen);

    // Pieces side by side that are solid at the same heights are one.
    std::vector<CompoundChild> found;
    double from = breaks.front();
    std::vector<Solid> solids;
    const auto add_until = [&](double to) {
        const FlatPolygon base = geometry::clipped(seen, from, to);
        if (to - from > thinnest_piece && !base.empty())
            for (const Solid& solid : solids) add_prism(*this, base, solid, found);
        from = to;
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        if (breaks[i + 1] - breaks[i] <= thinnest_piece) continue;
        std::vector<Solid> here = solids_at(*this, cuts, (breaks[i] + breaks[i + 1]) / 2);
        if (here != solids) {
            add_until(breaks[i]);
            solids = std::move(here);
        }
    }
    add_until(breaks.back());
    add_panes(*this, cuts, found);
    return found;
}

// Whether a piece of a slab is so thin that a hull of it is flat: flatness_tolerance in geometry/convex_hull.cpp, there
// of half the largest extent.
bool is_sliver(const FlatPolygon& piece, double thickness) {
    constexpr double thinnest = 1e-5;  // of the larger extent. Test: Slabs.HaveNoPartThatIsNoSolid
    double longest = 0;
    for (const FlatPoint& a : piece)
        for (const FlatPoint& b : piece) longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
    return 2 * geometry::signed_area(piece) < thinnest * longest * std::max(longest, thickness);
}

std::vector<CompoundChild> SlabShape::parts() const {
    std::vector<CompoundChild> found;
    for (const FlatPolygon& piece : geometry::convex_pieces(points)) {
        if (is_sliver(piece, thickness)) continue;
        const Bounds around = bounds_of(piece);
        const bool is_box = piece.size() == 4 && std::all_of(piece.begin(), piece.end(), [&](FlatPoint p) {
                                return (p[0] == around.lower.x || p[0] == around.upper.x) &&
                                       (p[1] == around.lower.z || p[1] == around.upper.z);
                            });
        if (is_box) {
            Vec3 half = around.half_extents(), middle = around.center();
            half.y = thickness / 2;
            middle.y = -thickness / 2;
            found.push_back({BoxShape{half}, {middle, {}}});
            continue;
        }
        HullShape hull;
        for (const FlatPoint& p : piece)
            for (const double y : {-thickness, 0.0}) hull.points.push_back({p[0], y, p[1]});
        found.push_back({std::move(hull), {}});
    }
    return found;
}

}  // namespace embody::physics
