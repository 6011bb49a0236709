// SPDX-License-Identifier: MIT
// Expanding polytope: G. van den Bergen, "Proximity queries and penetration depth computation on 3D game objects",
// 2001. The result is only a direction: callers measure the depth along it with the support functions, compare it with
// the exact normals of faces and sides, and take the best.
#include <cmath>
#include <vector>

#include "physics/collision/queries/gjk.h"

namespace embody::physics::collision {

namespace {

struct ExpandingFace {
    std::array<int, 3> corner{};
    Vec3 normal;
    double distance = 0;
    bool alive = true;
};

struct HorizonEdge {
    int from = 0, to = 0;
};

/// The polytope inside the Minkowski difference that grows towards the boundary point nearest to the origin.
struct Expansion {
    std::vector<Vec3> points;
    std::vector<ExpandingFace> faces;

    void clear() {
        points.clear();
        faces.clear();
    }
    [[nodiscard]] Vec3 at(int i) const { return points[static_cast<std::size_t>(i)]; }

    void add_face(int a, int b, int c) {
        ExpandingFace face{{a, b, c}, cross(at(b) - at(a), at(c) - at(a)), 0, true};
        const double size = length(face.normal);
        // A face without area has no direction: it can never be the nearest.
        if (!(size > 0)) {
            face.distance = 1e300;
        } else {
            face.normal = face.normal / size;
            face.distance = dot(face.normal, at(a));
        }
        faces.push_back(face);
    }

    [[nodiscard]] int nearest_face() const {
        int best = -1;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            if (best < 0 || faces[i].distance < faces[static_cast<std::size_t>(best)].distance)
                best = static_cast<int>(i);
        }
        return best;
    }

    // Removes the faces that the new point sees and closes the hole from its rim; false, with nothing changed, where
    // rounding would tear the surface.
    bool grow(Vec3 point, double clearance) {
        thread_local std::vector<HorizonEdge> horizon;
        horizon.clear();
        std::size_t removed = 0;
        for (const ExpandingFace& face : faces) {
            if (!sees(point, face, clearance)) continue;
            ++removed;
            for (std::size_t i = 0; i < 3; ++i) toggle_edge(horizon, face.corner[i], face.corner[(i + 1) % 3]);
        }
        // One connected patch of triangles has two rim edges more than faces.
        if (removed == 0 || horizon.size() != removed + 2) return false;
        for (ExpandingFace& face : faces) face.alive = face.alive && !sees(point, face, clearance);
        std::erase_if(faces, [](const ExpandingFace& face) { return !face.alive; });
        const int apex = static_cast<int>(points.size());
        points.push_back(point);
        for (const HorizonEdge& edge : horizon) add_face(edge.from, edge.to, apex);
        return true;
    }

    [[nodiscard]] bool sees(Vec3 point, const ExpandingFace& face, double clearance) const {
        return dot(face.normal, point - at(face.corner[0])) > clearance;
    }

    // An edge between two removed faces is inside the hole; one met once is its rim.
    static void toggle_edge(std::vector<HorizonEdge>& horizon, int from, int to) {
        for (std::size_t i = 0; i < horizon.size(); ++i) {
            if (horizon[i].from != to || horizon[i].to != from) continue;
            horizon[i] = horizon.back();
            horizon.pop_back();
            return;
        }
        horizon.push_back({from, to});
    }
};

// Makes the simplex a tetrahedron with volume by probing new directions; false for a flat difference.
bool widen_to_tetrahedron(const Core& a, const Core& b, std::vector<Vec3>& points) {
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto probe = [&](Vec3 direction, auto&& far_enough) {
        for (const double sign : {1.0, -1.0}) {
            const Vec3 p = difference_support(a, b, direction * sign).difference;
            if (!far_enough(p)) continue;
            points.push_back(p);
            return true;
        }
        return false;
    };
    if (points.empty()) points.push_back(difference_support(a, b, axes[0]).difference);
    if (points.size() == 1) {
        const auto apart = [&](Vec3 p) { return length(p - points[0]) > 1e-9 * (length(p) + length(points[0])); };
        if (!probe(axes[0], apart) && !probe(axes[1], apart) && !probe(axes[2], apart)) return false;
    }
    if (points.size() == 2) {
        const Vec3 along = normalized(points[1] - points[0]);
        const double size = length(points[1] - points[0]);
        const auto off_line = [&](Vec3 p) { return length(cross(p - points[0], along)) > 1e-9 * size; };
        const Vec3 u = any_perpendicular(along);
        if (!probe(u, off_line) && !probe(cross(along, u), off_line)) return false;
    }
    if (points.size() == 3) {
        const Vec3 n = normalized(cross(points[1] - points[0], points[2] - points[0]));
        const double size = length(points[1] - points[0]) + length(points[2] - points[0]);
        return probe(n, [&](Vec3 p) { return std::fabs(dot(p - points[0], n)) > 1e-9 * size; });
    }
    return true;
}

}  // namespace

bool penetration_normal(const Core& a, const Core& b, const CoreDistance& overlap, Vec3& normal) {
    constexpr int max_iterations = 96;  // new faces; the best normal so far serves then
    constexpr double converged = 1e-6;  // of the depth: a new face is no farther out
    thread_local Expansion expansion;
    expansion.clear();
    for (int i = 0; i < overlap.simplex_size; ++i) {
        expansion.points.push_back(overlap.simplex[static_cast<std::size_t>(i)].difference);
    }
    if (!widen_to_tetrahedron(a, b, expansion.points)) return false;

    // Four faces, all facing outwards.
    const Vec3 p0 = expansion.at(0);
    if (dot(cross(expansion.at(1) - p0, expansion.at(2) - p0), expansion.at(3) - p0) > 0) {
        std::swap(expansion.points[1], expansion.points[2]);
    }
    expansion.add_face(0, 1, 2);
    expansion.add_face(0, 2, 3);
    expansion.add_face(0, 3, 1);
    expansion.add_face(1, 3, 2);

    // Grows at the face nearest to the origin until that face is on the boundary.
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        const int nearest = expansion.nearest_face();
        if (nearest < 0) return false;
        const ExpandingFace face = expansion.faces[static_cast<std::size_t>(nearest)];
        if (face.distance > 1e299) return false;
        normal = -face.normal;
        const Vec3 next = difference_support(a, b, face.normal).difference;
        const double gain = dot(next, face.normal) - face.distance;
        const double size = std::fabs(face.distance) + length(next);
        if (gain <= converged * size) break;
        // Faces in whose plane the point nearly lies may count as seen or not, as long as the surface stays whole.
        bool grown = false;
        for (const double clearance : {1e-12, 0.0, -1e-12, 1e-10, 1e-8, -1e-10}) {
            grown = grown || expansion.grow(next, clearance * size);
        }
        if (!grown) break;
    }
    return length_squared(normal) > 0;
}

}  // namespace embody::physics::collision
