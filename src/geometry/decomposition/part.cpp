// SPDX-License-Identifier: MIT
#include "geometry/decomposition/part.h"

#include <algorithm>
#include <cmath>

namespace embody::geometry {

void complete(Part& part, std::span<const Void> candidates, const DecompositionSearch& search) {
    part.hull = build_search_hull(part.points, search.tolerance, search.thickness);
    part.voids.clear();
    part.concavity = 0;
    for (const Void& place : candidates) {
        if (!contains(part.hull.box, to_vec3(place.center)) || !part.hull.contains(to_vec3(place.center))) continue;
        part.voids.push_back(place);
        part.concavity = std::max(part.concavity, static_cast<double>(place.depth));
    }
}

namespace {

// Copies points of a part as they are needed.
class Side {
public:
    explicit Side(const Part& from) : from_(from), index_(from.points.size(), none) {}

    std::uint32_t keep(std::uint32_t point) {
        if (index_[point] == none) {
            index_[point] = static_cast<std::uint32_t>(part.points.size());
            part.points.push_back(from_.points[point]);
        }
        return index_[point];
    }
    std::uint32_t add(Vec3 p) {
        part.points.push_back(p);
        return static_cast<std::uint32_t>(part.points.size() - 1);
    }
    void add_polygon(std::span<const std::uint32_t> corner) {
        for (std::size_t i = 1; i + 1 < corner.size(); ++i)
            part.triangles.push_back({corner[0], corner[i], corner[i + 1]});
    }

    Part part;

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    const Part& from_;
    std::vector<std::uint32_t> index_;
};

}  // namespace

std::optional<std::pair<Part, Part>> cut(const Part& part, const CutPlane& plane, const DecompositionSearch& search) {
    std::vector<double> height(part.points.size());
    for (std::size_t i = 0; i < height.size(); ++i) height[i] = plane.height(part.points[i]);

    Side below(part), above(part);
    for (const auto& t : part.triangles) {
        const double least = std::min({height[t[0]], height[t[1]], height[t[2]]});
        const double most = std::max({height[t[0]], height[t[1]], height[t[2]]});
        if (most <= 0 || least >= 0) {
            Side& side = most <= 0 ? below : above;
            side.part.triangles.push_back({side.keep(t[0]), side.keep(t[1]), side.keep(t[2])});
            continue;
        }
        std::array<std::uint32_t, 4> low{}, high{};
        std::size_t low_count = 0, high_count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            if (height[a] <= 0) low[low_count++] = below.keep(a);
            if (height[a] >= 0) high[high_count++] = above.keep(a);
            if ((height[a] < 0 && height[b] > 0) || (height[a] > 0 && height[b] < 0)) {
                const Vec3 p =
                    part.points[a] + (height[a] / (height[a] - height[b])) * (part.points[b] - part.points[a]);
                low[low_count++] = below.add(p);
                high[high_count++] = above.add(p);
            }
        }
        below.add_polygon(std::span(low).first(low_count));
        above.add_polygon(std::span(high).first(high_count));
    }
    if (below.part.triangles.empty() || above.part.triangles.empty()) return std::nullopt;
    complete(below.part, part.voids, search);
    complete(above.part, part.voids, search);
    return std::pair{std::move(below.part), std::move(above.part)};
}

}  // namespace embody::geometry
