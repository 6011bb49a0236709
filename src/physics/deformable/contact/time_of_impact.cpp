// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/time_of_impact.h"

#include <algorithm>

#include "physics/deformable/contact/nearest_points.h"

namespace embody::physics::deformable {

namespace {

std::array<double, 4> weights_of(ThinFeature kind, const std::array<Vec3, 4>& x) {
    if (kind == ThinFeature::node_on_triangle) {
        const auto w = nearest_weights(x[0], x[1], x[2], x[3]);
        return {1, -w[0], -w[1], -w[2]};
    }
    if (kind == ThinFeature::node_on_edge) {
        const double t = nearest_along(x[0], x[1], x[2]);
        return {1, t - 1, -t, 0};
    }
    const auto [s, t] = nearest_between(x[0], x[1], x[2], x[3]);
    return {1 - s, s, t - 1, -t};
}

}  // namespace

std::optional<Impact> first_impact(const MovingFeatures& features, double distance) {
    constexpr double same_place = 0.01;  // of the distance: nearer ones began in one place and have no side
    constexpr double kept = 0.1;         // of the distance, as in the paper's section 6
    constexpr int max_tries = 100;       // each goes nine tenths of the travel that is safe
    const std::size_t first = features.kind == ThinFeature::edge_on_edge ? 2 : 1;
    const std::size_t count = features.kind == ThinFeature::node_on_edge ? 3 : 4;
    // The motion of the whole brings nothing nearer.
    Vec3 mean;
    for (std::size_t k = 0; k < count; ++k) mean += features.move[k] / static_cast<double>(count);
    std::array<double, 2> travel{};
    for (std::size_t k = 0; k < count; ++k)
        travel[k < first ? 0 : 1] = std::max(travel[k < first ? 0 : 1], length(features.move[k] - mean));
    const double fastest = travel[0] + travel[1];

    Impact impact;
    std::array<Vec3, 4> x = features.start;
    const auto find_distance = [&] {
        impact.weight = weights_of(features.kind, x);
        Vec3 away;
        for (std::size_t k = 0; k < count; ++k) away += impact.weight[k] * x[k];
        const double size = length(away);
        if (size > 0) impact.normal = away / size;
        return size;
    };
    double now = find_distance();
    if (now < same_place * distance) return std::nullopt;
    const double least = std::max(kept * std::min(distance, now), same_place * distance);
    const double enough = kept * (now - least);
    if (fastest <= now - least) return std::nullopt;
    for (int i = 0; i < max_tries; ++i) {
        const double next = impact.time + (1 - kept) * (now - least) / fastest;
        if (next >= 1) return std::nullopt;
        for (std::size_t k = 0; k < count; ++k) x[k] = features.start[k] + next * (features.move[k] - mean);
        now = find_distance();
        impact.time = next;
        if (now - least < enough) break;
    }
    return impact;
}

}  // namespace embody::physics::deformable
