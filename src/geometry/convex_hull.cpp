// SPDX-License-Identifier: MIT
//
// The hull itself is Qhull's: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull algorithm for convex hulls",
// ACM Trans. on Mathematical Software 22(4), 1996. Its reentrant library keeps all state in a qhT of the caller, so
// several imports may run at once. Here: the tests before it (is there a solid at all?), the choice of vertices
// where there are too many, and a check of what comes back, face by face; nothing unchecked leaves this file.
#include "geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "geometry/mean_point.h"

namespace embody::geometry {
namespace {

// All tolerances are for points scaled into the cube [-1, 1]³.
constexpr double flatness_tolerance = 1e-5;   // thinner than this is no solid
constexpr double planarity_tolerance = 1e-5;  // corners of a merged face may lie this far below its plane
constexpr double convexity_tolerance = 1e-5;  // corners of a face may lie this far outside a neighbouring edge

// A face as a loop of point indices, counter-clockwise from outside.
using Polygon = std::vector<std::uint32_t>;

// ---------------------------------------------------------------------------------------- before Qhull

// Points moved and scaled into [-1, 1]³, so that one set of tolerances fits 1 mm and 10 km.
struct NormalisedPoints {
    std::vector<Vec3> points;
    Vec3 center;
    double scale = 1;  // metres per unit
};

Result<NormalisedPoints> normalise(std::span<const Vec3> points) {
    const std::string where = "convex hull";
    if (points.size() < 4) {
        return Error{where, "needs at least 4 points, got " + std::to_string(points.size())};
    }
    Bounds box;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!is_finite(points[i])) return Error{where, "point " + std::to_string(i) + " is not finite"};
        box.add(points[i]);
    }

    const Vec3 half = box.half_extents();
    const double scale = std::max({half.x, half.y, half.z});
    if (!(scale > 1e-100)) return Error{where, "all points are the same point"};
    if (!(scale < 1e100)) return Error{where, "the points are too far apart for any real object"};
    NormalisedPoints normalised{{}, box.center(), scale};
    normalised.points.reserve(points.size());
    for (const Vec3 p : points) normalised.points.push_back((p - box.center()) / scale);
    return normalised;
}

template <class Measure>
std::uint32_t index_of_largest(std::span<const Vec3> points, Measure measure) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < points.size(); ++i) {
        if (measure(points[i]) > measure(points[best])) best = i;
    }
    return best;
}

// Four points that span a solid, or why there are none.
Result<std::array<std::uint32_t, 4>> find_simplex(std::span<const Vec3> points) {
    const auto a = index_of_largest(points, [](Vec3 p) { return -(p.x + p.y + p.z); });
    const auto b = index_of_largest(points, [&](Vec3 p) { return length_squared(p - points[a]); });
    const Vec3 along = normalized(points[b] - points[a]);
    const auto c = index_of_largest(points, [&](Vec3 p) { return length_squared(cross(p - points[a], along)); });
    const Vec3 across = cross(along, points[c] - points[a]);
    if (length(across) < flatness_tolerance) {
        return Error{"convex hull", "all points lie on one line", "use a capsule, or give the model a width"};
    }
    const Vec3 normal = normalized(across);
    const auto d = index_of_largest(points, [&](Vec3 p) { return std::fabs(dot(p - points[a], normal)); });
    if (std::fabs(dot(points[d] - points[a], normal)) < flatness_tolerance) {
        return Error{"convex hull", "all points lie in one plane", "use a thin box, or give the model a thickness"};
    }
    return std::array{a, b, c, d};
}

// ---------------------------------------------------------------------------------------- Qhull

// One run of Qhull. Its messages go to memory and are dropped (a confined importer may open no file); its verdict is
// the exit code, and our own check afterwards.
class QhullRun {
public:
    QhullRun(std::span<const Vec3> points, const char* options) : coordinates_(points.size() * 3) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (int k = 0; k < 3; ++k) coordinates_[3 * i + std::size_t(k)] = points[i][k];
        }
        messages_ = open_memstream(&message_text_, &message_size_);
        if (messages_ == nullptr) return;
        qh_zero(&state_, messages_);
        started_ = true;
        std::string command = options;
        const int exit_code = qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.data(), False,
                                           command.data(), nullptr, messages_);
        succeeded_ = exit_code == qh_ERRnone;
    }
    ~QhullRun() {
        if (started_) {
            int blocks = 0, bytes = 0;
            qh_freeqhull(&state_, !qh_ALL);
            qh_memfreeshort(&state_, &blocks, &bytes);
        }
        if (messages_ != nullptr) std::fclose(messages_);
        std::free(message_text_);
    }
    QhullRun(const QhullRun&) = delete;
    QhullRun& operator=(const QhullRun&) = delete;

    [[nodiscard]] bool succeeded() const { return succeeded_; }

    // Every facet as a loop, oriented outwards; empty where a facet is not one closed loop.
    std::vector<Polygon> polygons(std::span<const Vec3> points);

    // Indices of the points that are vertices of the hull, ascending.
    std::vector<std::uint32_t> vertices() {
        std::vector<std::uint32_t> result;
        qhT* qh = &state_;
        vertexT* vertex = nullptr;
        FORALLvertices result.push_back(index_of(vertex));
        std::sort(result.begin(), result.end());
        return result;
    }

private:
    using Side = std::pair<std::uint32_t, std::uint32_t>;

    std::uint32_t index_of(const vertexT* vertex) const {
        return static_cast<std::uint32_t>((vertex->point - coordinates_.data()) / 3);
    }
    std::vector<Side> sides_of(facetT* facet);

    std::vector<double> coordinates_;
    qhT state_{};
    std::FILE* messages_ = nullptr;
    char* message_text_ = nullptr;
    std::size_t message_size_ = 0;
    bool started_ = false;
    bool succeeded_ = false;
};

// Undirected edges of a facet. Merged facets list theirs as ridges; simplicial ones have three vertices.
std::vector<QhullRun::Side> QhullRun::sides_of(facetT* facet) {
    std::vector<Side> sides;
    vertexT* vertex = nullptr;
    vertexT** vertexp = nullptr;
    if (facet->simplicial) {
        std::vector<std::uint32_t> corner;
        FOREACHvertex_(facet->vertices) corner.push_back(index_of(vertex));
        for (std::size_t i = 0; i < corner.size(); ++i) sides.emplace_back(corner[i], corner[(i + 1) % corner.size()]);
        return sides;
    }
    ridgeT* ridge = nullptr;
    ridgeT** ridgep = nullptr;
    FOREACHridge_(facet->ridges) {
        std::vector<std::uint32_t> end;
        FOREACHvertex_(ridge->vertices) end.push_back(index_of(vertex));
        if (end.size() == 2) sides.emplace_back(end[0], end[1]);
    }
    return sides;
}

// Links sides end to end into one loop that uses each exactly once; empty where they do not form one.
Polygon link_loop(std::vector<std::pair<std::uint32_t, std::uint32_t>> sides) {
    Polygon loop;
    if (sides.size() < 3) return loop;
    const std::uint32_t first = sides.back().first;
    std::uint32_t next = sides.back().second;
    sides.pop_back();
    loop.push_back(first);
    while (next != first) {
        const auto found = std::find_if(sides.begin(), sides.end(),
                                        [&](const auto& s) { return s.first == next || s.second == next; });
        if (found == sides.end()) return {};
        loop.push_back(next);
        next = found->first == next ? found->second : found->first;
        sides.erase(found);
    }
    return sides.empty() ? loop : Polygon{};
}

// Twice the area times the unit normal of a polygon (Newell), exact for planar ones and a good mean for others.
Vec3 area_vector(std::span<const Vec3> points, const Polygon& polygon) {
    Vec3 sum;
    const Vec3 origin = points[polygon[0]];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += cross(points[polygon[i]] - origin, points[polygon[i + 1]] - origin);
    }
    return sum;
}

std::vector<Polygon> QhullRun::polygons(std::span<const Vec3> points) {
    std::vector<Polygon> result;
    qhT* qh = &state_;
    facetT* facet = nullptr;
    FORALLfacets {
        Polygon loop = link_loop(sides_of(facet));
        if (loop.empty()) return {};
        const Vec3 normal{facet->normal[0], facet->normal[1], facet->normal[2]};
        const bool inwards = dot(area_vector(points, loop), normal) < 0;
        if (inwards) std::reverse(loop.begin(), loop.end());
        // Begins at the smallest index, so that the same hull always has the same loop.
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        result.push_back(std::move(loop));
    }
    std::sort(result.begin(), result.end());
    return result;
}

// ---------------------------------------------------------------------------------------- after Qhull

// Corner i lies inside every side of its polygon, up to the tolerance.
bool is_convex_polygon(std::span<const Vec3> points, const Polygon& polygon, Vec3 normal) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 start = points[polygon[i]];
        const Vec3 outwards = normalized(cross(points[polygon[(i + 1) % n]] - start, normal));
        for (const std::uint32_t corner : polygon) {
            if (dot(points[corner] - start, outwards) > convexity_tolerance) return false;
        }
    }
    return true;
}

// Keeps only the points that faces use, renumbered in their given order.
void take_vertices(std::span<const Vec3> points, const std::vector<Polygon>& polygons, ConvexHull& hull) {
    constexpr auto unused = ~std::uint32_t{0};
    std::vector<std::uint32_t> new_index(points.size(), unused);
    for (const Polygon& polygon : polygons) {
        for (const std::uint32_t corner : polygon) new_index[corner] = 0;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (new_index[i] == unused) continue;
        new_index[i] = static_cast<std::uint32_t>(hull.vertices.size());
        hull.vertices.push_back(points[i]);
    }
    for (const Polygon& polygon : polygons) {
        hull.faces.push_back(
            {static_cast<std::uint32_t>(hull.face_vertices.size()), static_cast<std::uint32_t>(polygon.size()), {}, 0});
        for (const std::uint32_t corner : polygon) hull.face_vertices.push_back(new_index[corner]);
    }
}

// Pairs each side of a face with its twin; false unless every edge has exactly two faces that run it in opposite
// directions and the whole is one sphere (V - E + F = 2).
bool link_edges(ConvexHull& hull) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> open;
    hull.face_edges.resize(hull.face_vertices.size());
    for (std::uint32_t f = 0; f < hull.faces.size(); ++f) {
        const auto& face = hull.faces[f];
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const std::uint32_t start = hull.face_vertices[face.first + i];
            const std::uint32_t end = hull.face_vertices[face.first + (i + 1) % face.count];
            const auto twin = open.find({end, start});
            if (twin != open.end()) {
                hull.edges[twin->second].right = f;
                hull.face_edges[face.first + i] = twin->second;
                open.erase(twin);
                continue;
            }
            const auto edge = static_cast<std::uint32_t>(hull.edges.size());
            if (!open.emplace(std::pair{start, end}, edge).second) return false;
            hull.edges.push_back({start, end, f, f});
            hull.face_edges[face.first + i] = edge;
        }
    }
    return open.empty() && hull.vertices.size() + hull.faces.size() == hull.edges.size() + 2;
}

// Pushes every plane out along its normal until no vertex is outside, and notes how far corners are below.
void set_offsets(ConvexHull& hull) {
    hull.planarity = 0;
    for (auto& face : hull.faces) {
        double lowest = dot(face.normal, hull.vertices[hull.corners(face)[0]]);
        face.offset = lowest;
        for (const std::uint32_t corner : hull.corners(face)) {
            lowest = std::min(lowest, dot(face.normal, hull.vertices[corner]));
        }
        for (const Vec3 v : hull.vertices) face.offset = std::max(face.offset, dot(face.normal, v));
        hull.planarity = std::max(hull.planarity, face.offset - lowest);
    }
}

// Planes of the faces; false where a face is not convex or not planar enough, or a vertex sticks out too far.
bool set_planes(ConvexHull& hull) {
    for (auto& face : hull.faces) {
        const Polygon polygon(hull.corners(face).begin(), hull.corners(face).end());
        face.normal = normalized(area_vector(hull.vertices, polygon));
        if (face.normal == Vec3{} || !is_convex_polygon(hull.vertices, polygon, face.normal)) return false;
    }
    set_offsets(hull);
    return hull.planarity <= planarity_tolerance;
}

// The checked hull of normalised points. Merging coplanar facets comes first; where the merged faces fail the check
// (dense, nearly flat caps can), less merging is tried, down to bare triangles, which are always planar and convex.
std::optional<ConvexHull> hull_of(std::span<const Vec3> points) {
    for (const char* options : {"qhull C-0 C1e-6 Pp", "qhull C-0 C1e-8 Pp", "qhull C-0 Pp", "qhull Qt Pp"}) {
        QhullRun run(points, options);
        if (!run.succeeded()) continue;
        const std::vector<Polygon> polygons = run.polygons(points);
        if (polygons.size() < 4) continue;
        ConvexHull hull;
        take_vertices(points, polygons, hull);
        if (link_edges(hull) && set_planes(hull)) return hull;
    }
    return std::nullopt;
}

// ---------------------------------------------------------------------------------------- too many vertices

// For each face the point farthest outside it; the farthest first.
std::vector<std::pair<double, std::uint32_t>> farthest_outside(std::span<const Vec3> points, const ConvexHull& hull) {
    std::vector<std::pair<double, std::uint32_t>> farthest(hull.faces.size(), {0, 0});
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        // A point counts for the one face that it is farthest outside of.
        double height = 0;
        std::size_t owner = 0;
        for (std::size_t f = 0; f < hull.faces.size(); ++f) {
            const double h = dot(hull.faces[f].normal, points[i]) - hull.faces[f].offset;
            if (h > height) {
                height = h;
                owner = f;
            }
        }
        if (height > farthest[owner].first) farthest[owner] = {height, i};
    }
    std::sort(farthest.begin(), farthest.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    return farthest;
}

// Greedy choice of at most `limit` points: from a simplex, again and again those farthest outside the hull so far, a
// few at a time (about ten rebuilt hulls instead of one a vertex).
std::optional<ConvexHull> reduced_hull(std::span<const Vec3> points, std::array<std::uint32_t, 4> simplex, int limit) {
    std::vector<Vec3> chosen;
    chosen.reserve(simplex.size());
    for (const std::uint32_t index : simplex) chosen.push_back(points[index]);
    std::optional<ConvexHull> hull = hull_of(chosen);
    while (hull) {
        const auto farthest = farthest_outside(points, *hull);
        hull->left_outside = farthest.front().first;
        const std::size_t free_places = static_cast<std::size_t>(limit) - chosen.size();
        const std::size_t batch = std::min(free_places, std::max<std::size_t>(1, chosen.size() / 4));
        if (batch == 0 || farthest.front().first <= convexity_tolerance) break;

        // Points much nearer than the farthest wait: they may be inside once it is added.
        for (std::size_t i = 0; i < std::min(batch, farthest.size()); ++i) {
            if (farthest[i].first < 0.25 * farthest.front().first) break;
            chosen.push_back(points[farthest[i].second]);
        }
        std::optional<ConvexHull> larger = hull_of(chosen);
        if (!larger) break;
        hull = std::move(larger);
    }
    return hull;
}

// The vertices of the full hull; all points where Qhull cannot say.
std::vector<Vec3> extreme_points(std::vector<Vec3> points) {
    QhullRun run(points, "qhull C-0 Pp");
    if (!run.succeeded()) return points;
    std::vector<Vec3> extremes;
    for (const std::uint32_t index : run.vertices()) extremes.push_back(points[index]);
    return extremes;
}

}  // namespace

Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, int max_vertices) {
    if (max_vertices < min_hull_vertices || max_vertices > max_hull_vertices) {
        return Error{"convex hull: max_vertices", "must be from 4 to 4096, got " + std::to_string(max_vertices)};
    }
    auto normalised = normalise(points);
    if (!normalised) return normalised.error();
    if (const auto solid = find_simplex(normalised->points); !solid) return solid.error();

    // Only the vertices of the full hull matter from here, and if they are few they all stay.
    const std::vector<Vec3> extremes = extreme_points(std::move(normalised->points));
    std::optional<ConvexHull> hull;
    if (extremes.size() <= static_cast<std::size_t>(max_vertices)) hull = hull_of(extremes);
    const auto simplex = find_simplex(extremes);
    if (!hull && simplex.ok()) hull = reduced_hull(extremes, *simplex, max_vertices);
    if (!hull) return Error{"convex hull", "no convex solid could be built from these points"};

    // Back to metres. Normals stay; rounding may have put a vertex outside by a last digit, so planes are set again.
    for (Vec3& v : hull->vertices) v = normalised->center + v * normalised->scale;
    hull->left_outside *= normalised->scale;
    set_offsets(*hull);
    return *std::move(hull);
}

Result<ConvexHull> build_convex_hull(const TriangleMesh& mesh, int max_vertices) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle) used[vertex] = true;
    }
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) points.push_back(to_vec3(mesh.positions[i]));
    }
    return build_convex_hull(points, max_vertices);
}

TriangleMesh to_mesh(const ConvexHull& hull) {
    TriangleMesh mesh;
    for (const Vec3 v : hull.vertices) mesh.positions.push_back(to_vec3f(v));
    for (const auto& face : hull.faces) {
        const auto corner = hull.corners(face);
        for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
            mesh.triangles.push_back({corner[0], corner[i], corner[i + 1]});
        }
    }
    return mesh;
}

MassProperties integrate_hull(const ConvexHull& hull) {
    PolyhedronIntegral integral(mean_point(hull.vertices));
    for (const auto& face : hull.faces) {
        const auto corner = hull.corners(face);
        for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
            integral.add_triangle(hull.vertices[corner[0]], hull.vertices[corner[i]], hull.vertices[corner[i + 1]]);
        }
    }
    return integral.mass_properties();
}

Bounds bounds(const ConvexHull& hull) {
    Bounds box;
    for (const Vec3 v : hull.vertices) box.add(v);
    return box;
}

}  // namespace embody::geometry
