// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/deformable/contact/node_stars.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Surface of a sheet or rope for contacts with another.
struct ThinSurface {
    const Nodes* nodes = nullptr;
    std::span<const std::array<std::uint32_t, 3>> triangles;  ///< none of a rope
    std::span<const std::array<std::uint32_t, 2>>
        edges;                         ///< of a rope: its segments, broken ones from a node to itself
    double radius = 0;                 ///< distance that it keeps from its middle, m
    double edge_length = 0;            ///< mean, m
    const NodeStars* stars = nullptr;  ///< of a sheet
};

enum class ThinFeature : std::uint8_t { node_on_triangle, node_on_edge, edge_on_edge };

/// Two features of different sheets or ropes that may touch.
struct ThinCandidate {
    ThinFeature kind = ThinFeature::node_on_triangle;
    bool is_swapped = false;              ///< the node is one of the second
    std::uint32_t first = 0, second = 0;  ///< node or edge of the one, triangle or edge of the other
};

/// Appends features of `a` and `b` that may come closer than their radii within `time_step` (s), while an acceleration
/// of `gravity` (m/s²) may change their velocities. In a fixed order for any number of workers.
void find_thin_candidates(const ThinSurface& a, const ThinSurface& b, double time_step, double gravity,
                          TaskPool& workers, std::vector<ThinCandidate>& candidates);

/// The same for features that may come closer than `reach` (m) by these moves of the nodes, one each, m.
void find_swept_candidates(const ThinSurface& a, std::span<const Vec3> moves_a, const ThinSurface& b,
                           std::span<const Vec3> moves_b, double reach, TaskPool& workers,
                           std::vector<ThinCandidate>& candidates);

/// Of candidates of a rope with itself, leaves each pair once, and none with less than `distance` (m) along the rope
/// between the two, or with a node in common.
void leave_out_neighbours(const ThinSurface& rope, double distance, std::vector<ThinCandidate>& candidates);

/// The nearest points of two features: Σ weight x is the vector from the second to the first.
struct ThinPoints {
    std::array<std::uint32_t, 4> node{};  ///< the first `count_first` of the first feature's surface
    std::array<double, 4> weight{};
    int count_first = 1, count = 4;
    Vec3 away;  ///< m
};

/// Of a candidate as its nodes lie `ahead` (s) later by their mean velocities; false where the nearest points of two
/// edges are at an end.
bool find_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead,
                 ThinPoints& points);

/// The same, of edges too that are nearest at an end.
ThinPoints nearest_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead);

/// Whether nothing of either sheet beside the two features is nearer to the other's point: what lies over a neighbour
/// of a triangle touches that one (the feasible directions of A. H. Chen et al., "Offset Geometric Contact", 2025).
/// `ahead`: s, as these points were found.
bool are_nearest(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead,
                 const ThinPoints& points);

/// Whether any of these is going to touch within `time_step` (s) by its velocity, or nearly does.
bool will_touch(const ThinSurface& a, const ThinSurface& b, std::span<const ThinCandidate> candidates, double time_step,
                double gravity);

}  // namespace embody::physics::deformable
