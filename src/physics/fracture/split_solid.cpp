// SPDX-License-Identifier: MIT
// Voronoi cells about the place of the impact as M. Müller, N. Chentanez, T.-Y. Kim, "Real Time Dynamic Fracture with
// Volumetric Approximate Convex Decompositions", 2013, have them. We cut at run time instead of aligning a stored
// pattern, and a cell's connected solids stay one rigid piece.
#include "physics/fracture/split_solid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/convex_hull.h"

namespace embody::physics::fracture {

namespace {

// Corners so near to a plane, as a fraction of the solid's size, count as on it: rounding of their places is 1e-16.
// Test: SplitSolid.ACutThroughCornersAddsNone.
constexpr double plane_tolerance = 1e-12;
// Solids of a cell closer than this fraction of the size are one piece; parts of a decomposition share faces, whose
// corners are floats. Test: SplitSolid.WhatIsNotConnectedInACellIsSeparatePieces.
constexpr double contact_tolerance = 1e-5;
// What is smaller than this fraction of the mean piece is no body of its own: dust, whose contacts would cost as much
// as those of a piece. Test: SplitSolid.DustIsNoPiece.
constexpr double dust_fraction = 1e-3;

Bounds bounds_of(std::span<const ConvexCell> solids) {
    Bounds box;
    for (const ConvexCell& solid : solids) box.add(solid.bounds());
    return box;
}

// The half space of the points that are nearer to a than to b.
HalfSpace nearer_to(Vec3 a, Vec3 b) {
    const Vec3 normal = normalized(b - a);
    return {normal, dot(normal, (a + b) * 0.5)};
}

// Whether the convex solids are closer than the tolerance: the first, cut by the moved planes of the second, remains.
bool are_connected(const ConvexCell& a, const ConvexCell& b, double tolerance) {
    if (!overlaps(enlarged(b.bounds(), tolerance), a.bounds())) return false;
    ConvexCell rest = a;
    for (const ConvexCell::Face& face : b.faces()) {
        Vec3 sum;
        for (std::size_t i = 2; i < face.corners.size(); ++i)
            sum += cross(face.corners[i - 1] - face.corners[0], face.corners[i] - face.corners[0]);
        const Vec3 normal = normalized(sum);
        if (normal == Vec3{}) continue;
        rest.cut({normal, dot(normal, face.corners[0]) + tolerance}, 0);
        if (rest.is_empty()) return false;
    }
    return true;
}

// The part of a solid in one cell, and what it weighs.
struct Fragment {
    ConvexCell cell;
    geometry::MassProperties solid;
    bool has_hull = false;  ///< thick enough to collide
    std::size_t group = 0;  ///< the first fragment that it is connected to
};

void connect(std::vector<Fragment>& fragments, double tolerance) {
    for (std::size_t i = 0; i < fragments.size(); ++i) fragments[i].group = i;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const std::size_t from = fragments[i].group, to = fragments[j].group;
            if (from == to || !are_connected(fragments[i].cell, fragments[j].cell, tolerance)) continue;
            for (Fragment& fragment : fragments)
                if (fragment.group == std::max(from, to)) fragment.group = std::min(from, to);
        }
    }
}

geometry::MassProperties sum_of(const geometry::MassProperties& a, const geometry::MassProperties& b) {
    if (a.volume <= 0) return b;
    return b.volume > 0 ? geometry::combined(a, b) : a;
}

// Adds the pieces of one cell; what has no hull, or is smaller than `min_volume` (m³), goes to `dust`.
void add_pieces(const std::vector<Fragment>& fragments, double min_volume, std::vector<Piece>& pieces,
                std::vector<geometry::MassProperties>& dust) {
    for (std::size_t group = 0; group < fragments.size(); ++group) {
        Piece piece;
        for (const Fragment& fragment : fragments) {
            if (fragment.group != group) continue;
            piece.solid = sum_of(piece.solid, fragment.solid);
            if (!fragment.has_hull) continue;
            piece.hulls.push_back(fragment.cell.corners());
            piece.bounds.add(fragment.cell.bounds());
        }
        if (!piece.hulls.empty() && piece.solid.volume >= min_volume)
            pieces.push_back(std::move(piece));
        else if (piece.solid.volume > 0)
            dust.push_back(piece.solid);
    }
}

void carry(const geometry::MassProperties& grain, std::vector<Piece>& pieces) {
    const auto nearest = std::ranges::min_element(
        pieces, {}, [&](const Piece& piece) { return length_squared(piece.solid.center - grain.center); });
    nearest->solid = sum_of(nearest->solid, grain);
}

}  // namespace

Split split_solid(std::span<const ConvexCell> solids, std::span<const Vec3> seeds, double min_piece_volume) {
    const Bounds box = bounds_of(solids);
    const double size = length(box.upper - box.lower);
    Split split;
    double volume = 0;
    for (const ConvexCell& solid : solids) volume += solid.mass_properties().volume;
    const double mean = volume / static_cast<double>(std::max<std::size_t>(seeds.size(), 1));
    const double min_volume = std::max(dust_fraction * mean, min_piece_volume);
    std::vector<geometry::MassProperties> dust;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        std::vector<Fragment> fragments;
        for (const ConvexCell& solid : solids) {
            ConvexCell cell = solid;
            for (std::size_t j = 0; j < seeds.size() && !cell.is_empty(); ++j)
                if (j != i) cell.cut(nearer_to(seeds[i], seeds[j]), size * plane_tolerance);
            if (cell.is_empty()) continue;
            split.crack_area += cell.cut_area() / 2;
            const bool has_hull = geometry::build_convex_hull(cell.corners(), max_hull_vertices).ok();
            const geometry::MassProperties own = cell.mass_properties();
            fragments.push_back({std::move(cell), own, has_hull && own.volume > 0, 0});
        }
        connect(fragments, size * contact_tolerance);
        add_pieces(fragments, min_volume, split.pieces, dust);
    }
    if (split.pieces.empty()) return split;
    for (const geometry::MassProperties& grain : dust) carry(grain, split.pieces);
    return split;
}

std::vector<Vec3> choose_seeds(std::span<const ConvexCell> solids, Vec3 impact, int count, Random& random) {
    std::vector<double> volumes;
    double volume = 0;
    for (const ConvexCell& solid : solids) volumes.push_back(volume += solid.mass_properties().volume);
    // A point of a solid: of its box, which the solid fills in part.
    const auto point = [&] {
        const double at = random.unit() * volume;
        const auto found = std::ranges::upper_bound(volumes, at);
        const auto index = std::min<std::size_t>(static_cast<std::size_t>(found - volumes.begin()), solids.size() - 1);
        const Bounds box = solids[index].bounds();
        Vec3 place;
        for (int axis = 0; axis < 3; ++axis) place[axis] = random.between(box.lower[axis], box.upper[axis]);
        return place;
    };
    std::vector<Vec3> seeds;
    for (int i = 0; i < count; ++i) {
        const Vec3 place = point();
        const double distance_fraction = i % 2 == 0 ? 1 : random.unit();
        seeds.push_back(impact + (place - impact) * distance_fraction);
    }
    return seeds;
}

}  // namespace embody::physics::fracture
