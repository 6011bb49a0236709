// SPDX-License-Identifier: MIT
//
// Planes as K. Mamou's V-HACD (2014) and X. Wei et al., "Approximate convex decomposition for 3D meshes with
// collision-aware concavity and tree search", ACM Trans. on Graphics 41(4), 2022, try them: across the axes. Here also
// across the directions that much of the surface faces, and mostly just beside flat faces, where the best planes
// of furniture are. The score of a plane is the hollow volume that it leaves in the hulls of both sides, each place
// weighted by its depth; where scores are equal (half a ring is as hollow as the ring) halves go before slices.
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/decomposition/part.h"

namespace embody::geometry {
namespace {

constexpr std::size_t most_sampled_voids = 512;
constexpr int even_planes = 9, strong_planes = 6, most_directions = 5;
constexpr double facing = 0.996;            // cosine of 5°
constexpr double worth_a_direction = 0.15;  // fraction of the surface that faces it
constexpr double worth_a_plane = 0.01;      // fraction of the surface in it
constexpr double rough = 5;                 // times the tolerance: hulls of planes that are only tried
constexpr double halving = 0.05;            // of the hollow: the bonus of a cut in equal halves against a slice

struct Facet {
    Vec3 normal;
    double area;
    Vec3 middle;
};

class CutSearch {
public:
    CutSearch(const Part& part, const DecompositionSearch& search);
    std::optional<CutPlane> run();

private:
    void sample_voids();
    std::vector<Vec3> directions() const;
    void try_direction(Vec3 normal);
    void refine();
    double cost(const CutPlane& plane);
    double hollow(std::vector<Vec3>& points, double& volume);
    void consider(const CutPlane& plane, double span);

    const Part& part_;
    const DecompositionSearch& search_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
    std::vector<Facet> facets_;
    double area_ = 0;
    std::vector<Void> voids_;
    double hollow_before_ = 0;
    std::vector<double> height_;
    std::vector<Vec3> below_, above_;

    CutPlane best_;
    double best_cost_ = std::numeric_limits<double>::infinity(), best_span_ = 0;
};

CutSearch::CutSearch(const Part& part, const DecompositionSearch& search) : part_(part), search_(search) {
    edges_.reserve(3 * part.triangles.size());
    facets_.reserve(part.triangles.size());
    for (const auto& t : part.triangles) {
        for (std::size_t i = 0; i < 3; ++i) edges_.emplace_back(std::minmax(t[i], t[(i + 1) % 3]));
        const Vec3 a = part.points[t[0]], b = part.points[t[1]], c = part.points[t[2]];
        const Vec3 n = cross(b - a, c - a);
        const double twice = length(n);
        if (twice > 0) facets_.push_back({n / twice, 0.5 * twice, (a + b + c) / 3});
        area_ += 0.5 * twice;
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    sample_voids();
}

// Samples evenly over all voids, by the fractional parts of multiples of the golden ratio.
void CutSearch::sample_voids() {
    const std::size_t all = part_.voids.size(), count = std::min(all, most_sampled_voids);
    for (std::size_t i = 0; i < count; ++i) {
        const double at = 0.6180339887498949 * static_cast<double>(i);
        const auto chosen =
            all == count ? i : static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(all));
        voids_.push_back(part_.voids[std::min(chosen, all - 1)]);
        hollow_before_ += static_cast<double>(voids_.back().depth);
    }
}

// The model's axes, and others that much of the surface faces.
std::vector<Vec3> CutSearch::directions() const {
    std::vector<Vec3> found{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<std::pair<double, Vec3>> others;
    for (const Facet& facet : facets_) {
        bool known = false;
        for (const Vec3 axis : found) known = known || std::fabs(dot(axis, facet.normal)) > facing;
        for (auto& [area, normal] : others) {
            if (known || std::fabs(dot(normal, facet.normal)) <= facing) continue;
            area += facet.area;
            known = true;
        }
        if (!known && others.size() < 64) others.emplace_back(facet.area, facet.normal);
    }
    std::stable_sort(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [area, normal] : others) {
        if (area < worth_a_direction * area_ || found.size() == most_directions) break;
        found.push_back(normal);
    }
    return found;
}

// Sum of the depths of the sampled voids that the hull of the points contains.
double CutSearch::hollow(std::vector<Vec3>& points, double& volume) {
    SearchHull hull = build_search_hull(points, rough * search_.tolerance, search_.thickness);
    volume = hull.volume;
    double sum = 0;
    for (const Void& place : voids_) {
        const Vec3 p = to_vec3(place.center);
        if (contains(hull.box, p) && hull.contains(p)) sum += static_cast<double>(place.depth);
    }
    return sum;
}

double CutSearch::cost(const CutPlane& plane) {
    height_.resize(part_.points.size());
    below_.clear();
    above_.clear();
    for (std::size_t i = 0; i < height_.size(); ++i) {
        height_[i] = plane.height(part_.points[i]);
        if (height_[i] <= 0) below_.push_back(part_.points[i]);
        if (height_[i] >= 0) above_.push_back(part_.points[i]);
    }
    if (below_.size() == height_.size() || above_.size() == height_.size()) {
        return std::numeric_limits<double>::infinity();
    }
    for (const auto& [a, b] : edges_) {
        if (height_[a] * height_[b] >= 0) continue;
        const Vec3 p = part_.points[a] + (height_[a] / (height_[a] - height_[b])) * (part_.points[b] - part_.points[a]);
        below_.push_back(p);
        above_.push_back(p);
    }
    double volume_below = 0, volume_above = 0;
    const double left = hollow(below_, volume_below) + hollow(above_, volume_above);
    const double uneven = std::fabs(volume_below - volume_above) / std::max(volume_below + volume_above, 1e-300);
    return left / hollow_before_ + halving * uneven;
}

void CutSearch::consider(const CutPlane& plane, double span) {
    const double value = cost(plane);
    if (value >= best_cost_) return;
    best_ = plane;
    best_cost_ = value;
    best_span_ = span;
}

void CutSearch::try_direction(Vec3 normal) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3 p : part_.points) {
        low = std::min(low, dot(normal, p));
        high = std::max(high, dot(normal, p));
    }
    const double extent = high - low, beside = std::max(2 * search_.tolerance, 1e-4 * extent);
    if (extent < 4 * search_.tolerance) return;

    // The area of the surface that faces across, in bins.
    constexpr std::size_t bins = 128;
    struct Bin {
        double area = 0, lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    };
    std::array<Bin, bins> across{};
    for (const Facet& facet : facets_) {
        if (std::fabs(dot(facet.normal, normal)) < facing) continue;
        const double at = dot(facet.middle, normal);
        Bin& bin = across[std::min(bins - 1, static_cast<std::size_t>((at - low) / extent * bins))];
        bin.area += facet.area;
        bin.lowest = std::min(bin.lowest, at);
        bin.highest = std::max(bin.highest, at);
    }
    std::stable_sort(across.begin(), across.end(), [](const Bin& a, const Bin& b) { return a.area > b.area; });
    for (std::size_t i = 0; i < strong_planes && across[i].area > worth_a_plane * area_; ++i) {
        for (const double at : {across[i].lowest - beside, across[i].highest + beside}) {
            if (at > low + beside && at < high - beside) consider({normal, at}, extent / (2 * even_planes));
        }
    }
    for (int i = 1; i <= even_planes; ++i) {
        consider({normal, low + extent * i / (even_planes + 1)}, extent / (2 * even_planes));
    }
}

void CutSearch::refine() {
    for (int round = 0; round < 3; ++round) {
        const CutPlane center = best_;
        const double span = 0.5 * best_span_;
        consider({center.normal, center.offset - span}, span);
        consider({center.normal, center.offset + span}, span);
        best_span_ = span;
    }
}

std::optional<CutPlane> CutSearch::run() {
    if (!(hollow_before_ > 0)) return std::nullopt;
    for (const Vec3 normal : directions()) try_direction(normal);
    if (best_cost_ == std::numeric_limits<double>::infinity()) return std::nullopt;
    refine();
    return best_;
}

}  // namespace

std::optional<CutPlane> choose_cut(const Part& part, const DecompositionSearch& search) {
    return CutSearch(part, search).run();
}

}  // namespace embody::geometry
