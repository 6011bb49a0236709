// SPDX-License-Identifier: MIT
#include "physics/collision/broad_phase/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

Bounds cube_at(Vec3 p, double half) { return enlarged(Bounds{p, p}, half); }

TEST(BroadPhase, two_immovable_bodies_are_no_pair) {
    TaskPool one_worker(1);
    BroadPhase phase;
    phase.insert(0, cube_at({}, 1), false);
    phase.insert(1, cube_at({}, 1), false);
    EXPECT_TRUE(phase.update_pairs(one_worker).empty());
    phase.insert(2, cube_at({}, 1), true);
    EXPECT_EQ(phase.update_pairs(one_worker).size(), 2u);
}

TEST(BroadPhase, an_endless_plane_pairs_with_what_moves) {
    TaskPool one_worker(1);
    BroadPhase phase;
    const auto plane = make_shape(PlaneShape{});
    phase.insert(7, plane->bounds({}), false);
    phase.insert(3, cube_at({100, 0.5, -5000}, 0.5), true);
    phase.insert(4, cube_at({0, 50, 0}, 0.5), true);
    const auto& pairs = phase.update_pairs(one_worker);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0], (BroadPhase::Pair{3, 7}));
}

TEST(BroadPhase, removing_a_body_removes_its_pairs) {
    TaskPool one_worker(1);
    BroadPhase phase;
    phase.insert(0, cube_at({}, 1), true);
    phase.insert(1, cube_at({}, 1), true);
    ASSERT_EQ(phase.update_pairs(one_worker).size(), 1u);
    phase.remove(0);
    EXPECT_TRUE(phase.update_pairs(one_worker).empty());
    phase.insert(0, cube_at({50, 0, 0}, 1), true);
    EXPECT_TRUE(phase.update_pairs(one_worker).empty());
}

// Against all pairs by brute force, while bodies come, move and go; twice, for the same order.
TEST(BroadPhase, finds_every_overlap_in_a_crowd) {
    std::vector<BroadPhase::Pair> first_run;
    for (int run = 0; run < 2; ++run) {
        Random random(5);
        TaskPool one_worker(1);
        BroadPhase phase;
        std::map<std::uint32_t, Bounds> bodies;
        std::vector<BroadPhase::Pair> all;
        for (int step = 0; step < 60; ++step) {
            for (int change = 0; change < 40; ++change) {
                const auto body = static_cast<std::uint32_t>(random.below(200));
                const Vec3 p{random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)};
                const Bounds bounds = cube_at(p, random.between(0.01, 0.6));
                if (!bodies.contains(body)) {
                    phase.insert(body, bounds, body % 5 != 0);
                } else if (random.unit() < 0.2) {
                    phase.remove(body);
                    bodies.erase(body);
                    continue;
                } else {
                    phase.move(body, bounds, {0.1, 0, 0});
                }
                bodies[body] = bounds;
            }
            const auto& pairs = phase.update_pairs(one_worker);
            EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
            EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
            const std::set<BroadPhase::Pair> known(pairs.begin(), pairs.end());
            for (const auto& [a, bounds_a] : bodies) {
                for (const auto& [b, bounds_b] : bodies) {
                    if (a >= b || (a % 5 == 0 && b % 5 == 0)) continue;
                    EXPECT_TRUE(!overlaps(bounds_a, bounds_b) || known.contains({a, b})) << a << " " << b;
                    if (!overlaps(enlarged(bounds_a, 0.5), enlarged(bounds_b, 0.5))) {
                        EXPECT_FALSE(known.contains({a, b})) << a << " " << b;
                    }
                }
            }
            all.insert(all.end(), pairs.begin(), pairs.end());
        }
        if (run == 0) first_run = all;
        EXPECT_EQ(first_run, all);
    }
}

TEST(BroadPhase, queries_ascend_and_rays_shorten) {
    TaskPool one_worker(1);
    BroadPhase phase;
    for (std::uint32_t i = 0; i < 50; ++i)
        phase.insert(49 - i, cube_at({static_cast<double>(49 - i), 0, 0}, 0.2), true);
    std::vector<std::uint32_t> found;
    phase.query(cube_at({10, 0, 0}, 2), [&](std::uint32_t body) { found.push_back(body); });
    EXPECT_EQ(found, (std::vector<std::uint32_t>{8, 9, 10, 11, 12}));

    // The nearest hit ends the search for what lies behind.
    int visits = 0;
    double best = 1e9;
    phase.query_ray({-5, 0, 0}, {1, 0, 0}, 1e9, [&](std::uint32_t body, double limit) {
        ++visits;
        best = std::min(best, body + 5 - 0.2);
        return std::min(limit, best);
    });
    EXPECT_NEAR(best, 4.8, 1e-12);
    EXPECT_LT(visits, 50);
}

// A thousand balls of many sizes 10 km from the origin, all of them moving, on one worker and on three.
TEST(BroadPhase, finds_the_same_pairs_on_any_number_of_workers_far_from_the_origin) {
    TaskPool one_worker(1), three_workers(3);
    BroadPhase serial, parallel;
    Random random(8);
    std::vector<Bounds> bounds;
    for (std::uint32_t body = 0; body < 1000; ++body) {
        const Vec3 p{10000 + random.between(-3, 3), random.between(-3, 3), -10000 + random.between(-3, 3)};
        bounds.push_back(cube_at(p, body % 100 == 0 ? 3 : random.between(0.01, 0.3)));
        for (BroadPhase* phase : {&serial, &parallel}) phase->insert(body, bounds.back(), true);
    }
    for (int step = 0; step < 5; ++step) {
        const auto& pairs = serial.update_pairs(one_worker);
        EXPECT_EQ(pairs, parallel.update_pairs(three_workers));
        std::size_t missing = 0;
        for (std::uint32_t a = 0; a < 1000; ++a) {
            for (std::uint32_t b = a + 1; b < 1000; ++b) {
                if (!overlaps(bounds[a], bounds[b])) continue;
                missing += !std::binary_search(pairs.begin(), pairs.end(), BroadPhase::Pair{a, b});
            }
        }
        EXPECT_EQ(missing, 0u);
        for (std::uint32_t body = 0; body < 1000; ++body) {
            const Vec3 displacement{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
            bounds[body] = {bounds[body].lower + displacement, bounds[body].upper + displacement};
            for (BroadPhase* phase : {&serial, &parallel}) phase->move(body, bounds[body], {});
        }
    }
}

// Eight million pairs; what is kept must not depend on the workers, and all must come back.
TEST(BroadPhase, four_thousand_bodies_in_one_point_keep_a_bounded_number_of_pairs) {
    constexpr std::uint32_t count = 4000;
    TaskPool one_worker(1), two_workers(2);
    BroadPhase phase, other;
    for (BroadPhase* p : {&phase, &other}) {
        p->insert(count, cube_at({0, -1, 0}, 1), false);
        for (std::uint32_t body = 0; body < count; ++body) p->insert(body, cube_at({}, 0.1), true);
    }
    const auto pairs = phase.update_pairs(one_worker);
    EXPECT_TRUE(phase.has_too_many_pairs());
    EXPECT_LE(pairs.size(), count * (BroadPhase::max_partners + 1));
    EXPECT_EQ(pairs, other.update_pairs(two_workers));
    for (std::uint32_t body = 0; body < count; ++body) {
        EXPECT_TRUE(std::binary_search(pairs.begin(), pairs.end(), BroadPhase::Pair{body, count})) << body;
    }

    // Half of them far apart, then the others: nothing is missing.
    for (std::uint32_t body = 0; body < count; ++body) {
        phase.move(body, cube_at({body < count / 2 ? 10.0 * body : 0, 0, 0}, 0.1), {});
    }
    phase.update_pairs(one_worker);
    EXPECT_TRUE(phase.has_too_many_pairs());
    for (std::uint32_t body = 1; body < count; ++body) {
        phase.move(body, cube_at({10.0 * (body / 2), 0, 0}, 0.1), {});
    }
    EXPECT_GE(phase.update_pairs(one_worker).size(), count / 2);
    EXPECT_FALSE(phase.has_too_many_pairs());
}

/// A crowd of boxes in which each travels by its own way in each step, beside one that all have in common.
struct Crowd {
    std::vector<Bounds> bounds;
    std::vector<Vec3> motion;  ///< m in this step
    Random random;
    Vec3 common;
    double longest = 0;  ///< own way, m

    Crowd(std::uint64_t seed, std::uint32_t count, Vec3 origin, Vec3 common_motion, double max_own)
        : random(seed), common(common_motion), longest(max_own) {
        for (std::uint32_t i = 0; i < count; ++i) {
            bounds.push_back(cube_at(origin + shaken(2), random.between(0.01, 0.1)));
            motion.push_back(common + shaken(longest));
        }
    }
    Vec3 shaken(double most) {
        return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
    }
    [[nodiscard]] Bounds at(std::uint32_t body, double time) const {
        return {bounds[body].lower + motion[body] * time, bounds[body].upper + motion[body] * time};
    }
    // Some go on as before.
    void advance() {
        for (std::uint32_t i = 0; i < bounds.size(); ++i) {
            bounds[i] = at(i, 1);
            if (i % 3 != 0) motion[i] = common + shaken(longest);
        }
    }
    // At one of 33 moments of the step.
    [[nodiscard]] bool meet(std::uint32_t a, std::uint32_t b) const {
        for (int k = 0; k <= 32; ++k) {
            if (overlaps(at(a, k / 32.0), at(b, k / 32.0))) return true;
        }
        return false;
    }
};

// Each fifth stands; slow ones, fast ones, near the origin and 10 km from it.
TEST(BroadPhase, what_meets_on_its_way_is_a_pair) {
    Random random(21);
    for (int family = 0; family < 12; ++family) {
        SCOPED_TRACE(family);
        TaskPool one_worker(1), three_workers(3);
        BroadPhase phase, parallel;
        const double far = family % 2 == 0 ? 0 : 1e4, longest = family % 3 == 0 ? 0.01 : random.between(0.01, 1);
        Crowd crowd(static_cast<std::uint64_t>(family), 600, {far, -far, 0}, {}, longest);
        for (std::uint32_t i = 0; i < crowd.bounds.size(); ++i) {
            if (i % 5 == 0) crowd.motion[i] = {};
            for (BroadPhase* p : {&phase, &parallel}) p->insert(i, crowd.bounds[i], i % 5 != 0);
        }
        std::size_t meetings = 0, missing = 0;
        for (int step = 0; step < 6; ++step) {
            for (std::uint32_t i = 0; i < crowd.bounds.size(); ++i) {
                if (i % 5 == 0) continue;
                for (BroadPhase* p : {&phase, &parallel}) p->move(i, crowd.bounds[i], crowd.motion[i]);
                EXPECT_TRUE(phase.holds(i, crowd.bounds[i], crowd.motion[i]));
                EXPECT_TRUE(phase.covers(i, crowd.bounds[i]));
            }
            const auto& pairs = phase.update_pairs(one_worker);
            EXPECT_EQ(pairs, parallel.update_pairs(three_workers));
            for (std::uint32_t a = 0; a < crowd.bounds.size(); ++a) {
                for (std::uint32_t b = a + 1; b < crowd.bounds.size(); ++b) {
                    if ((a % 5 == 0 && b % 5 == 0) || !crowd.meet(a, b)) continue;
                    ++meetings;
                    missing += !std::binary_search(pairs.begin(), pairs.end(), BroadPhase::Pair{a, b});
                }
            }
            crowd.advance();
            for (std::uint32_t i = 0; i < crowd.bounds.size(); i += 5) crowd.motion[i] = {};
        }
        EXPECT_GT(meetings, 100u);
        EXPECT_EQ(missing, 0u);
    }
}

// Galilean invariance: what moves relative to what.
TEST(BroadPhase, pairs_do_not_depend_on_a_common_speed) {
    Random random(22);
    for (int family = 0; family < 8; ++family) {
        const double longest = random.between(0, 0.1);
        const auto count_of = [&](Vec3 common) {
            TaskPool one_worker(1);
            BroadPhase phase;
            Crowd crowd(static_cast<std::uint64_t>(family), 1500, {}, common, longest);
            for (std::uint32_t i = 0; i < crowd.bounds.size(); ++i) phase.insert(i, crowd.bounds[i], true);
            std::size_t count = 0;
            for (int step = 0; step < 4; ++step) {
                for (std::uint32_t i = 0; i < crowd.bounds.size(); ++i) phase.move(i, crowd.bounds[i], crowd.motion[i]);
                count += phase.update_pairs(one_worker).size();
                crowd.advance();
            }
            return static_cast<double>(count);
        };
        const double at_rest = count_of({});
        for (const double speed : {0.003, 0.03, 0.3, 3.0}) {
            const Vec3 common{random.between(-speed, speed), random.between(-speed, speed),
                              random.between(-speed, speed)};
            EXPECT_NEAR(count_of(common) / at_rest, 1, 0.05) << "family " << family << ", " << speed << " m a step";
        }
    }
}

}  // namespace
}  // namespace embody::physics::collision
