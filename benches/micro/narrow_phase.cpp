// SPDX-License-Identifier: MIT
// Nanoseconds per pair of the narrow phase, on one thread: each pair of shapes stacked, overlapping by a millimetre in
// random orientations, and separated; without and with the pair's cache. Both must find the same contacts: the sums are
// compared.
//
// Usage: embody-bench-narrow-phase [PART OF A PAIR'S NAME]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "foundation/random.h"
#include "physics/collision/shapes/collision_shape.h"

namespace {

using namespace embody;
using namespace embody::physics;
using namespace embody::physics::collision;

constexpr double margin = 0.01;
constexpr std::size_t poses_a_pair = 256;

using ShapePointer = std::unique_ptr<CollisionShape>;

struct PosedPair {
    Transform a, b;
};

struct NamedPair {
    std::string name;
    const CollisionShape* a;
    const CollisionShape* b;
    bool b_is_ground;  ///< the pair is only stacked, a above b
    bool b_is_rough = false;
};

Quat random_rotation(Random& random) {
    for (;;) {
        const Quat q{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const double l = dot(q, q);
        if (l > 0.01 && l < 1) return normalized(q);
    }
}

// Moves b along `way` until the gap between the two is `gap` (within a micrometre), by bisection.
void set_gap(const NamedPair& pair, PosedPair& pose, Vec3 way, double gap) {
    double near = 0, far = 8;
    while (far - near > 1e-6) {
        const double middle = 0.5 * (near + far);
        pose.b.position = pose.a.position + way * middle;
        const double now = separation(*pair.a, pose.a, *pair.b, pose.b, 100);
        (now > 0 ? far : near) = middle;
    }
    pose.b.position = pose.a.position + way * (far + gap);
}

// Tilted by a small angle and rotated about Y, a above b: faces touch.
std::vector<PosedPair> stacked_poses(const NamedPair& pair) {
    Random random(11);
    std::vector<PosedPair> poses;
    const double height = pair.b->local_bounds().upper.y - pair.a->local_bounds().lower.y - 0.0005;
    const double top = pair.b_is_ground && pair.b->local_bounds().upper.y > 1e6 ? 0.5 - 0.0005 : height;
    for (std::size_t i = 0; i < poses_a_pair; ++i) {
        const Quat tilt = normalized(Quat{random.between(-2e-4, 2e-4), random.between(-0.5, 0.5), 0, 1});
        PosedPair pose{{{random.between(-0.3, 0.3), top, random.between(-0.3, 0.3)}, tilt}, {}};
        if (pair.b_is_rough) {
            pose.a = {{}, random_rotation(random)};
            set_gap(pair, pose, {0, -1, 0}, -0.0005);
        }
        poses.push_back(pose);
    }
    return poses;
}

std::vector<PosedPair> tumbled_poses(const NamedPair& pair, double gap) {
    Random random(12);
    std::vector<PosedPair> poses;
    for (std::size_t i = 0; i < poses_a_pair; ++i) {
        PosedPair pose{{{}, random_rotation(random)}, {{}, random_rotation(random)}};
        set_gap(pair, pose, rotate(random_rotation(random), {1, 0, 0}), gap);
        poses.push_back(pose);
    }
    return poses;
}

struct Timing {
    double cold = 1e300, warm = 1e300;  ///< ns per pair
    double sum_cold = 0, sum_warm = 0;  ///< sums of all separations
    double points = 0;                  ///< mean number per pair
};

double add_up(const std::vector<Manifold>& manifolds, double& points) {
    double sum = 0;
    for (const Manifold& m : manifolds) {
        points += m.count;
        for (int i = 0; i < m.count; ++i) sum += m.points[static_cast<std::size_t>(i)].separation;
    }
    return sum;
}

// The minimum time of several runs over all poses.
Timing time_pair(const NamedPair& pair, const std::vector<PosedPair>& poses) {
    using Clock = std::chrono::steady_clock;
    constexpr int rounds = 12;
    Timing timing;
    std::vector<Manifold> manifolds;
    manifolds.reserve(64);
    std::vector<PairMemory> memories(poses.size());
    const auto nanoseconds = [&](Clock::time_point start) {
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count() /
               static_cast<double>(poses.size());
    };
    for (int round = 0; round < rounds; ++round) {
        double points = 0;
        timing.sum_cold = timing.sum_warm = 0;
        const auto cold = Clock::now();
        for (const PosedPair& pose : poses) {
            manifolds.clear();
            collide(*pair.a, pose.a, *pair.b, pose.b, margin, manifolds);
            timing.sum_cold += add_up(manifolds, points);
        }
        timing.cold = std::min(timing.cold, nanoseconds(cold));
        timing.points = points / static_cast<double>(poses.size());

        const auto warm = Clock::now();
        for (std::size_t i = 0; i < poses.size(); ++i) {
            manifolds.clear();
            collide(*pair.a, poses[i].a, *pair.b, poses[i].b, margin, memories[i], manifolds);
            timing.sum_warm += add_up(manifolds, points);
        }
        timing.warm = std::min(timing.warm, nanoseconds(warm));
    }
    return timing;
}

// True if the results with and without the cache are equal.
bool report(const NamedPair& pair, const char* how, const std::vector<PosedPair>& poses) {
    const Timing t = time_pair(pair, poses);
    const bool same = std::fabs(t.sum_cold - t.sum_warm) <= 1e-9 * (1 + std::fabs(t.sum_cold));
    std::printf("%-22s %-8s %9.0f %9.0f %7.2f  %.9f%s\n", pair.name.c_str(), how, t.cold, t.warm, t.points, t.sum_cold,
                same ? "" : "  DIFFERENT WITH MEMORY");
    return same;
}

ShapePointer make(const ShapeDefinition& definition) { return *CollisionShape::create(definition); }

ShapePointer make_ball_hull(int points, double radius, std::uint64_t seed) {
    Random random(seed);
    HullShape hull;
    for (int i = 0; i < points; ++i) hull.points.push_back(rotate(random_rotation(random), {radius, 0, 0}));
    return make(hull);
}

ShapePointer make_hills() {
    MeshShape mesh;
    Random random(5);
    constexpr int cells = 40;
    for (int r = 0; r <= cells; ++r) {
        for (int c = 0; c <= cells; ++c) {
            mesh.positions.push_back(to_vec3f({0.5 * (c - 20), random.between(-0.05, 0.05), 0.5 * (r - 20)}));
        }
    }
    const auto at = [](int c, int r) { return static_cast<std::uint32_t>(r * (cells + 1) + c); };
    for (int r = 0; r < cells; ++r) {
        for (int c = 0; c < cells; ++c) {
            mesh.triangles.push_back({at(c, r), at(c, r + 1), at(c + 1, r + 1)});
            mesh.triangles.push_back({at(c, r), at(c + 1, r + 1), at(c + 1, r)});
        }
    }
    return make(mesh);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string wanted = argc > 1 ? argv[1] : "";
    const auto sphere = make(SphereShape{0.5}), box = make(BoxShape{{0.5, 0.5, 0.5}}),
               capsule = make(CapsuleShape{0.25, 0.25}), cylinder = make(CylinderShape{0.5, 0.5}),
               cone = make(ConeShape{0.5, 0.5}), hull16 = make_ball_hull(16, 0.5, 1),
               hull32 = make_ball_hull(32, 0.5, 2), hull256 = make_ball_hull(256, 0.5, 3), plane = make(PlaneShape{}),
               hills = make_hills();
    const NamedPair pairs[] = {{"sphere-sphere", sphere.get(), sphere.get(), false},
                               {"sphere-box", sphere.get(), box.get(), false},
                               {"sphere-capsule", sphere.get(), capsule.get(), false},
                               {"sphere-cylinder", sphere.get(), cylinder.get(), false},
                               {"sphere-cone", sphere.get(), cone.get(), false},
                               {"sphere-hull16", sphere.get(), hull16.get(), false},
                               {"sphere-plane", sphere.get(), plane.get(), true},
                               {"sphere-mesh", sphere.get(), hills.get(), true, true},
                               {"box-box", box.get(), box.get(), false},
                               {"box-plane", box.get(), plane.get(), true},
                               {"box-mesh", box.get(), hills.get(), true, true},
                               {"box-hull16", box.get(), hull16.get(), false},
                               {"box-capsule", box.get(), capsule.get(), false},
                               {"box-cylinder", box.get(), cylinder.get(), false},
                               {"box-cone", box.get(), cone.get(), false},
                               {"capsule-capsule", capsule.get(), capsule.get(), false},
                               {"capsule-plane", capsule.get(), plane.get(), true},
                               {"capsule-mesh", capsule.get(), hills.get(), true, true},
                               {"capsule-cylinder", capsule.get(), cylinder.get(), false},
                               {"capsule-cone", capsule.get(), cone.get(), false},
                               {"cylinder-cylinder", cylinder.get(), cylinder.get(), false},
                               {"cylinder-plane", cylinder.get(), plane.get(), true},
                               {"cylinder-mesh", cylinder.get(), hills.get(), true, true},
                               {"cylinder-cone", cylinder.get(), cone.get(), false},
                               {"cone-cone", cone.get(), cone.get(), false},
                               {"hull16-hull16", hull16.get(), hull16.get(), false},
                               {"hull16-plane", hull16.get(), plane.get(), true},
                               {"hull16-mesh", hull16.get(), hills.get(), true, true},
                               {"hull16-cylinder", hull16.get(), cylinder.get(), false},
                               {"hull32-hull32", hull32.get(), hull32.get(), false},
                               {"hull32-mesh", hull32.get(), hills.get(), true, true},
                               {"hull256-hull256", hull256.get(), hull256.get(), false},
                               {"hull256-box", hull256.get(), box.get(), false}};
    std::printf("%-22s %-8s %9s %9s %7s  %s\n", "pair", "poses", "cold, ns", "warm, ns", "points",
                "sum of separations");
    bool same = true;
    for (const NamedPair& pair : pairs) {
        if (pair.name.find(wanted) == std::string::npos) continue;
        same = report(pair, "stacked", stacked_poses(pair)) && same;
        if (pair.b_is_ground) continue;
        same = report(pair, "tumbled", tumbled_poses(pair, -0.001)) && same;
        same = report(pair, "margin", tumbled_poses(pair, 0.005)) && same;
        same = report(pair, "apart", tumbled_poses(pair, 0.02)) && same;
    }
    return same ? 0 : 1;
}
